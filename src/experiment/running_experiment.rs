//! A running experiment: its motion, and what is recorded and monitored along the way.
//!
//! In: a system and a setup. Out: an [`Experiment`] and its snapshots. Never here: how it advances (`advance`), commands
//! (`execute`).

use std::sync::Arc;

use super::companions::Companions;
use super::event_log::EventLog;
use super::gauges::{GaugeInputs, Gauges};
use super::hull::Hulls;
use super::law_changes::LawChanges;
use super::notices::Notices;
use super::observed_motion::ObservedMotion;
use super::recorder::Recorder;
use super::reversal::Reversal;
use super::row_spacing::RowSpacing;
use super::run_log::RunLog;
use super::run_state::RunState;
use super::setup::{MethodNotFound, Setup, choose_method};
use super::snapshot::{Gauge, MethodFact, Recorded, Snapshot, Status};
use crate::analysis::CrossingLog;
use crate::cancel::Cancel;
use crate::integrate::NarrowPlace;
use crate::mechanics::{Equations, Valuation};
use crate::model::Model;
use crate::num::short;
use crate::printable;
use crate::system::{self, State, System};

/// A system in motion, with its gauges and its recorded past.
pub struct Experiment {
    pub(super) model: Arc<Model>,
    pub(super) equations: Arc<Equations>,
    /// The setup that a restart begins with.
    pub(super) setup: Setup,
    /// The initial values as numbers: coordinates, then velocities or momenta.
    initial: Arc<[f64]>,
    pub(super) motion: ObservedMotion,
    pub(super) reversal: Reversal,
    /// Where the law was changed since the restart.
    pub(super) changes: LawChanges,
    /// The time in the past that is shown.
    pub(super) scrubbed: Option<Box<ObservedMotion>>,
    pub(super) recorder: Recorder,
    pub(super) gauges: Gauges,
    /// What the gauges were last given as constants, and the parameters that these follow from.
    constants: Option<(Vec<f64>, Valuation)>,
    pub(super) run: RunState,
    epoch: u64,
    pub(super) notices: Notices,
    /// What has happened since the last restart.
    pub(super) log: RunLog,
    /// The motions beside this one.
    pub(super) companions: Companions,
    pub(super) row_spacing: RowSpacing,
    /// Whether the gauges are evaluated at the ends of steps only.
    pub(super) only_ends: bool,
}

impl Experiment {
    /// Creates an experiment at its initial values, with time running. Invalid initial values put the experiment into
    /// a failed state; they are not an error of this call.
    ///
    /// # Errors
    /// Returns an error if the method is unknown or does not suit the system.
    pub fn new(
        model: &Arc<Model>,
        equations: &Arc<Equations>,
        system: &System,
        setup: Setup,
    ) -> Result<Experiment, MethodNotFound> {
        let method = choose_method(system, &setup.method)?;
        let motion = ObservedMotion::new(system, method, setup.settings, &setup.parameters)?;
        let mut experiment = Experiment {
            model: Arc::clone(model),
            equations: Arc::clone(equations),
            reversal: Reversal::none(setup.start),
            changes: LawChanges::default(),
            scrubbed: None,
            initial: Arc::default(),
            motion,
            recorder: Recorder::new(system.channels().len(), setup.spacing)
                .with_hulls(Hulls::of(model, system)),
            gauges: Gauges::new(model, equations, system),
            constants: None,
            run: RunState { running: true, error: None, ended: None, restored: false },
            epoch: 0,
            notices: Notices::default(),
            log: RunLog::new(model.sections.len()),
            companions: Companions::default(),
            row_spacing: RowSpacing::default(),
            only_ends: false,
            setup,
        };
        experiment.restart();
        Ok(experiment)
    }

    /// The token that cancels its computations, even within a step.
    pub fn cancel(&self) -> &Cancel {
        self.motion.system().cancel()
    }

    /// Sets the epoch of all further snapshots.
    pub fn set_epoch(&mut self, epoch: u64) {
        self.epoch = epoch;
    }

    /// The checked file that the motion is of.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// The compiled system.
    pub fn system(&self) -> &System {
        self.motion.system()
    }

    /// The current time.
    pub fn time(&self) -> f64 {
        self.motion.time()
    }

    /// What [`Experiment::advance`] counts in: the time, or −t while time runs backwards. It never decreases along the way.
    pub fn clock(&self) -> f64 {
        self.motion.clock()
    }

    /// The clock up to which the motion is computed, and the number of steps that it took so far.
    pub fn computed(&self) -> (f64, u64) {
        (self.motion.computed(), self.motion.steps())
    }

    /// Whether time runs backwards.
    pub fn is_backwards(&self) -> bool {
        self.motion.sign() < 0.0
    }

    /// Simulated seconds per second of wall time; infinite for as fast as possible.
    pub fn speed(&self) -> f64 {
        self.setup.speed
    }

    /// Whether time is running, paused or unable to continue.
    pub fn status(&self) -> Status {
        self.run.status()
    }

    /// The current value of every channel, in the order of the system's channels.
    pub fn values(&self) -> &[f64] {
        self.motion.values()
    }

    /// The events and impulses since the last restart, in order of time.
    pub fn occurrences(&self) -> &EventLog {
        &self.log.occurrences
    }

    /// The crossings of the surfaces of section since the last restart, in order of time.
    pub fn crossings(&self) -> &CrossingLog {
        &self.log.crossings
    }

    /// Only counts occurrences from now on, without storing them.
    pub fn only_count_occurrences(&mut self) {
        self.log.only_count();
    }

    /// The gauges are evaluated at the ends of steps only from now on, and where a row is recorded or the motion is advanced to.
    pub fn observe_ends_only(&mut self) {
        self.only_ends = true;
    }

    /// Only the gauges see the recorded rows from now on, of which there are then fewer, and no picture is fitted to them.
    pub fn record_for_gauges_only(&mut self) {
        self.row_spacing.see_gauges_only();
        self.recorder.forget_hulls();
    }

    /// Remembers no states between steps from now on: the motion cannot be carried back.
    pub fn forget_past(&mut self) {
        self.motion.forget_past();
    }

    /// A sentence about the singular configurations of the constraints that the motion has passed.
    pub fn singular_passages(&self) -> Option<String> {
        let (count, first) = self.motion.singular_passages();
        let time = short(self.motion.sign() * first?);
        let again = if count > 1 { format!(" and {} more", count - 1) } else { String::new() };
        Some(format!(
            "passed a singular configuration of the constraints at t = {time}{again}: motions branch \
             there, and this one continued smoothly"
        ))
    }

    /// A sentence about the first singular configuration that the comparison motion has passed.
    pub fn comparison_passage(&self) -> Option<String> {
        let (time, place) = self.motion.comparison_passage()?;
        let place: Vec<String> =
            place.iter().map(|(name, x)| format!(", {name} = {}", short(*x))).collect();
        Some(format!(
            "the motion of [comparison] passed a singular configuration of its constraints at t = {}{}: its numbers are uncertain \
             from there on",
            short(self.motion.sign() * time),
            place.concat()
        ))
    }

    /// A sentence about the first event whose impulse slows the motion and lets it continue to the other side.
    pub fn passed_event(&self) -> Option<String> {
        let (name, time) = self.motion.passed_event()?;
        Some(format!(
            "the impulse of `{}` at t = {} does not turn the motion back, which goes on through where it happens",
            printable::quoted(name),
            short(self.motion.sign() * time)
        ))
    }

    /// A sentence for each event whose function is zero all along the motion but for rounding: whether it happens cannot be known.
    pub fn vanishing_events(&self) -> Vec<String> {
        let sentence = |(name, since): (&str, f64)| {
            format!(
                "the function of `{}` is zero all along but for rounding from t = {} on: an event is where it changes its sign",
                printable::quoted(name),
                short(self.motion.sign() * since)
            )
        };
        self.motion.vanishing_events().map(sentence).collect()
    }

    /// A sentence about the first step that has passed a narrow place of the law without having been there.
    pub fn narrow_passage(&self) -> Option<String> {
        let found = self.motion.narrow_passage()?;
        let (what, why) = match found.place {
            NarrowPlace::Exponential => {
                ("narrow feature", "an exponential function changes by more than")
            }
            NarrowPlace::Pole => ("pole", "a force grows by more than"),
        };
        Some(format!(
            "{} steps over a {what} of the law before t = {}, where {why} a step of {} can resolve: try a shorter one, or the default \
             method",
            self.motion.method().name,
            short(self.motion.sign() * found.time),
            short(found.step)
        ))
    }

    /// A sentence for a fixed step beyond the method's stability limit.
    pub fn unstable(&self) -> Option<String> {
        let found = self.motion.unstable()?;
        Some(format!(
            "{} is not stable with the step {} where the motion is at t = {}: steps below {} are",
            self.motion.method().name,
            short(found.step),
            short(self.motion.sign() * found.time),
            short(found.limit)
        ))
    }

    /// A frame has shown what was recorded. At an unlimited speed the next rows are so far apart that a frame receives
    /// no more of them than it can show.
    pub fn shown(&mut self) {
        self.row_spacing.frame_shown(self.setup.speed);
    }

    /// Takes a snapshot of the current state.
    pub fn snapshot(&self) -> Snapshot {
        let seen = self.seen();
        let trail = self.recorder.trail();
        let (companions, separations) = self.shown_beside(seen.time());
        Snapshot {
            epoch: self.epoch,
            time: seen.time(),
            backwards: self.is_backwards(),
            returned: self.reversal.echo.as_ref().map(|echo| echo.returned()),
            recorded: self.recorded(),
            status: self.status(),
            speed: self.setup.speed,
            parameters: self.setup.parameters.as_slice().into(),
            initial: Arc::clone(&self.initial),
            setup: Arc::new(self.setup.clone()),
            state: Arc::new(seen.dated_state()),
            values: seen.values().into(),
            bounds: self.recorder.bounds(),
            hulls: self.recorder.hulls(),
            trail: if self.scrubbed.is_some() { trail.until(seen.time()) } else { trail },
            gauges: self.show_gauges(),
            method: self.method_fact(),
            notices: self.notices.sentences.as_slice().into(),
            occurrences: self.log.occurrences.clone(),
            crossings: self.crossings_seen(),
            companions,
            separations,
            released: (0..self.system().constraints())
                .filter(|&k| self.system().is_released(k))
                .collect(),
            restored: self.run.restored,
        }
    }
}

impl Experiment {
    pub(super) fn seen(&self) -> &ObservedMotion {
        self.scrubbed.as_deref().unwrap_or(&self.motion)
    }

    /// Its crossings of the surfaces of section up to there.
    fn crossings_seen(&self) -> CrossingLog {
        let mut crossings = self.log.crossings.clone();
        if self.scrubbed.is_some() {
            let channels = self.system().channels().len();
            crossings.rewind(self.seen().time(), self.motion.sign(), channels);
        }
        crossings
    }

    /// The part of the motion that can be shown again.
    pub(super) fn recorded(&self) -> Recorded {
        let from = self.motion.known_from().unwrap_or(self.clock());
        let from = self.motion.sign() * from.max(self.reversal.began);
        let (scrubbed, changed) = (self.scrubbed.is_some(), self.changes.last.clone());
        Recorded { from, to: self.time(), scrubbed, changed, run: self.motion.log.run() }
    }

    /// Restarts from the initial values.
    pub(super) fn restart(&mut self) {
        self.face_forwards();
        self.scrubbed = None;
        self.reversal.began = self.setup.start;
        self.changes = LawChanges::default();
        self.run.error = None;
        self.run.ended = None;
        self.log.clear();
        self.notices = Notices::default();
        self.motion.forget(self.setup.start);
        self.recorder.restart(self.setup.start);
        let state = self.initial_state();
        self.show_initial(state.as_ref().ok());
        let begun = state.and_then(|state| self.motion.begin(&state, &self.setup.parameters));
        match begun {
            Ok(()) => {
                self.gauge(Gauges::refer);
                self.record();
            }
            Err(error) => self.run.error = Some(error.into()),
        }
        self.restart_companions();
    }

    pub(super) fn initial_state(&self) -> Result<State, system::MotionError> {
        let Setup { start, parameters, overrides: given, .. } = &self.setup;
        self.motion.whole().initial(*start, parameters, given)
    }

    /// Stores the initial values for display, taken from the resulting state if there is one.
    pub(super) fn show_initial(&mut self, state: Option<&State>) {
        let system = self.system();
        self.initial = match state {
            Some(state) => state.values[..system.moving()].into(),
            None => system.initial_values(&self.setup.parameters).into(),
        };
    }

    /// Passes the current values to the gauges.
    pub(super) fn gauge(&mut self, sample: impl FnOnce(&mut Gauges, &GaugeInputs<'_>)) {
        self.motion.observe_terms();
        let parameters = &self.setup.parameters;
        // NaN is never the same
        let known = self.constants.take().filter(|(known, _)| known == parameters);
        let (_, constants) = self.constants.insert(known.unwrap_or_else(|| {
            let constants = Experiment::constants(&self.model, self.motion.system(), parameters);
            (parameters.clone(), constants)
        }));
        sample(&mut self.gauges, &self.motion.present(constants));
    }

    /// The parameters, and the constants that follow from a body.
    fn constants(model: &Model, system: &System, parameters: &[f64]) -> Valuation {
        Valuation::of_parameters(model, parameters).with(system.body_values(parameters))
    }

    fn show_gauges(&self) -> Arc<[Gauge]> {
        let parameters = &self.setup.parameters;
        let constants = Experiment::constants(&self.model, self.motion.system(), parameters);
        self.gauges.show(&self.seen().present(&constants))
    }

    fn method_fact(&self) -> MethodFact {
        MethodFact {
            name: self.motion.method().name,
            step: self.motion.step_size(),
            steps: self.motion.steps(),
            tolerance: self.motion.settings().tolerance,
        }
    }
}
