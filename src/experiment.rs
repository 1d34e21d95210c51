//! The running experiment: a system, a method and a recorder, synchronous and deterministic.
//!
//! In: a compiled [`System`], a [`Setup`] and [`Command`]s. Out: [`Snapshot`]s, cheap to clone.
//! Never here: threads, clocks, terminals.

mod attitude;
mod checkpoint;
mod command;
mod deviation;
mod event_log;
mod execute;
mod export;
mod gauges;
mod law;
mod observed_motion;
mod prepared;
mod recorder;
mod residual;
mod setup;
mod snapshot;
mod trail;

use std::sync::Arc;

use crate::cancel::Cancel;
use crate::integrate::Stepping;
use crate::mechanics::Equations;
use crate::model::Model;
use crate::num::math;
use crate::system::{self, State, System};

pub use crate::analysis::{Growth, Verdict};
pub use checkpoint::{Changed, Checkpoint, MotionState, Named, Past, Reference};
pub use command::Command;
pub use event_log::{EventCount, EventLog};
pub use export::Export;
pub use prepared::{PrepareError, Prepared};
pub use setup::{MethodNotFound, Setup, choose_method, with_override};
pub use snapshot::{Failure, Gauge, MethodFact, Snapshot, Status};
pub use trail::Trail;

use crate::integrate::{Occurrence, OccurrenceKind, Reached};
use execute::short;
use gauges::{Gauges, Present};
use observed_motion::ObservedMotion;
use recorder::Recorder;

/// A system in motion, with its gauges and its recorded past.
pub struct Experiment {
    model: Arc<Model>,
    /// What a restart would begin with.
    setup: Setup,
    /// The same as numbers: coordinates, then velocities or momenta.
    initial: Arc<[f64]>,
    motion: ObservedMotion,
    recorder: Recorder,
    gauges: Gauges,
    running: bool,
    fault: Option<Failure>,
    epoch: u64,
    notices: Vec<String>,
    /// What happened since the last restart.
    occurrences: EventLog,
    /// The names of those that were reported of.
    told: Vec<String>,
    /// The event that ended the motion.
    ended: Option<String>,
    /// Whether a motion left elsewhere was taken up.
    taken_up: bool,
}

/// How far an experiment came.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Progress {
    /// To the time asked for.
    Arrived,
    /// Not so far: the steps allowed were taken.
    Underway,
    /// Not so far: a fault stands in the way.
    Stuck,
    /// Not so far: an event has ended the motion.
    Ended,
}

impl Experiment {
    /// An experiment at its initial values, running. What is wrong with the initial values is a
    /// fault of the experiment, not of this call.
    ///
    /// # Errors
    /// Where the method is unknown or does not fit the system.
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
            initial: Arc::default(),
            motion,
            recorder: Recorder::new(system.channels().len(), setup.spacing),
            gauges: Gauges::new(model, equations, system),
            running: true,
            fault: None,
            epoch: 0,
            notices: Vec::new(),
            occurrences: EventLog::default(),
            told: Vec::new(),
            ended: None,
            taken_up: false,
            setup,
        };
        experiment.restart();
        Ok(experiment)
    }

    /// The token that stops what it computes, also in the middle of a step.
    pub fn cancel(&self) -> &Cancel {
        self.motion.system().cancel()
    }

    /// Gives all snapshots this epoch.
    pub fn set_epoch(&mut self, epoch: u64) {
        self.epoch = epoch;
    }

    /// The model it runs.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// The compiled system it runs.
    pub fn system(&self) -> &System {
        self.motion.system()
    }

    /// The present time.
    pub fn time(&self) -> f64 {
        self.motion.time()
    }

    /// Simulated seconds per second of the wall clock; infinite means flat out.
    pub fn speed(&self) -> f64 {
        self.setup.speed
    }

    /// Whether time runs, is held, or cannot go on.
    pub fn status(&self) -> Status {
        match (&self.fault, self.running) {
            (Some(fault), _) => Status::Failed(fault.clone()),
            _ if self.ended.is_some() => Status::Ended(self.ended.clone().unwrap_or_default()),
            (None, true) => Status::Running,
            (None, false) => Status::Paused,
        }
    }

    /// Every channel's present value, in the order of the system's channels.
    pub fn values(&self) -> &[f64] {
        self.motion.values()
    }

    /// Carries the motion on to `time`, recording and gauging on the way; after `budget` steps and
    /// rows it stops short. It does so also while paused: whether time runs is for the caller to
    /// look at.
    pub fn advance(&mut self, time: f64, mut budget: u64) -> Progress {
        if self.fault.is_some() {
            return Progress::Stuck;
        }
        if self.ended.is_some() {
            return Progress::Ended;
        }
        while self.recorder.due() <= time {
            match self.reach(self.recorder.due(), &mut budget) {
                Progress::Arrived => self.record(),
                other => return other,
            }
            if budget == 0 {
                return Progress::Underway;
            }
            budget -= 1;
        }
        if time <= self.time() {
            return Progress::Arrived;
        }
        let progress = self.reach(time, &mut budget);
        if progress == Progress::Arrived {
            self.recorder.widen(self.motion.values());
            self.gauge(Gauges::look);
        }
        progress
    }

    /// What happened since the last restart, in time.
    pub fn occurrences(&self) -> &EventLog {
        &self.occurrences
    }

    /// From now on what happens is counted only, and not kept: for who does not list it.
    pub fn only_count_occurrences(&mut self) {
        self.occurrences.only_count();
    }

    /// A sentence on the singular configurations of the constraints that the motion has passed.
    pub fn singular_passages(&self) -> Option<String> {
        let (count, first) = self.motion.singular_passages();
        let time = short(first?);
        let again = if count > 1 { format!(" and {} more", count - 1) } else { String::new() };
        Some(format!(
            "passed a singular configuration of the constraints at t = {time}{again}: motions branch \
             there, and this one went on smoothly"
        ))
    }

    /// A sentence where the method's fixed step lies beyond what is stable.
    pub fn unstable(&self) -> Option<String> {
        let found = self.motion.unstable()?;
        Some(format!(
            "{} is not stable with the step {} where the motion is at t = {}: steps below {} are",
            self.motion.method().name,
            short(found.step),
            short(found.time),
            short(found.limit)
        ))
    }

    /// What can be seen of it now.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            epoch: self.epoch,
            time: self.time(),
            status: self.status(),
            speed: self.setup.speed,
            parameters: self.setup.parameters.as_slice().into(),
            initial: Arc::clone(&self.initial),
            setup: Arc::new(self.setup.clone()),
            state: Arc::new(self.motion.state().clone()),
            values: self.motion.values().into(),
            bounds: self.recorder.bounds(),
            trail: self.recorder.trail(),
            gauges: self.show_gauges(),
            method: self.method_fact(),
            notices: self.notices.as_slice().into(),
            occurrences: self.occurrences.clone(),
            released: (0..self.system().constraints())
                .filter(|&k| self.system().is_released(k))
                .collect(),
            taken_up: self.taken_up,
        }
    }
}

/// How it moves.
impl Experiment {
    /// Begins anew at the initial values.
    fn restart(&mut self) {
        self.fault = None;
        self.ended = None;
        self.occurrences.clear();
        self.told.clear();
        self.notices.clear();
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
            Err(fault) => self.fault = Some(fault.into()),
        }
    }

    fn initial_state(&self) -> Result<State, system::MotionError> {
        let Setup { start, parameters, given, .. } = &self.setup;
        self.motion.whole().initial(*start, parameters, given)
    }

    /// Keeps the initial values to be shown: those of the state they lead to, where they do.
    fn show_initial(&mut self, state: Option<&State>) {
        let system = self.system();
        self.initial = match state {
            Some(state) => state.values[..system.moving()].into(),
            None => system.initial_values(&self.setup.parameters).into(),
        };
    }

    /// Moves the present on, or meets a fault.
    fn reach(&mut self, time: f64, budget: &mut u64) -> Progress {
        // a motion that is a polynomial would be over in one step; any other is not cut short
        let ahead = (HORIZON * self.setup.spacing).max(GROWTH * self.motion.step_size().abs());
        let limit = self.setup.end.unwrap_or(self.time() + ahead).max(time);
        let reached = loop {
            let gauges = (&mut self.gauges, self.recorder.spacing());
            match self.motion.reach(time, limit, budget, gauges) {
                Ok(Reached::Happened(occurrence)) => {
                    let name = occurrence.name.clone();
                    match self.note(occurrence) {
                        Ok(sentence) => self.report_once(name, sentence),
                        Err(fault) => break Err(fault),
                    }
                }
                other => break other,
            }
        };
        if let Some(sentence) = self.singular_passages() {
            self.report_once("singular configuration".to_owned(), sentence);
        }
        if let Some(sentence) = self.unstable() {
            self.report_once(sentence.clone(), sentence);
        }
        match reached {
            Ok(Reached::There | Reached::Happened(_)) => Progress::Arrived,
            Ok(Reached::Underway) => Progress::Underway,
            Ok(Reached::Ended) => Progress::Ended,
            Err(fault) => {
                // what was computed before the fault is still shown, as far as it can be
                let _ = self.motion.reach_end();
                self.fault = Some(fault.into());
                Progress::Stuck
            }
        }
    }

    /// Takes note of what happened: rows of the trail before and after it, and gauges that go on
    /// from what an impulse left. Returns a sentence on it.
    fn note(&mut self, occurrence: Occurrence) -> Result<String, system::MotionError> {
        let lead = format!("{} at t = {}", occurrence.name, short(occurrence.time));
        let sentence = match &occurrence.kind {
            OccurrenceKind::Mark => lead,
            OccurrenceKind::Stop => {
                self.ended = Some(occurrence.name.clone());
                format!("{lead}: the motion ends")
            }
            OccurrenceKind::Release(constraint) => {
                let name = &self.model.constraints[*constraint].name;
                format!("{lead}: the constraint {name} holds no longer")
            }
            OccurrenceKind::Impulse { .. } => {
                let before = self.motion.values_before()?;
                self.recorder.insert(occurrence.time, &before);
                let after = self.motion.values();
                self.gauges.shift(&before, after);
                let given = self.energy_of(after) - self.energy_of(&before);
                let sign = if given < 0.0 { '−' } else { '+' };
                format!("{lead}: energy {sign}{}", short(given.abs()))
            }
        };
        self.recorder.insert(occurrence.time, self.motion.values());
        self.occurrences.push(occurrence);
        Ok(sentence)
    }

    /// Tells of what happens by itself: of what happens again and again only the first time.
    fn report_once(&mut self, name: String, sentence: String) {
        if !self.told.contains(&name) {
            self.told.push(name);
            self.tell(sentence);
        }
    }

    /// Records the present as the row that is due.
    fn record(&mut self) {
        self.recorder.record(self.motion.time(), self.motion.values());
        self.recorder.set_spacing(self.spacing());
        let dense = self.recorder.spacing() <= self.motion.step_size().abs();
        self.gauge(|gauges, now| gauges.sample(now, dense));
    }

    /// The time to the next row: so short that the curve through the rows is smooth, which a step
    /// of the method tells; not shorter than the setup's; and not so long that the trail lags
    /// behind at the present speed.
    fn spacing(&self) -> f64 {
        let least = self.setup.spacing;
        let per_step = match self.motion.method().stepping {
            Stepping::Adaptive => ROWS_PER_LONG_STEP,
            Stepping::Fixed => 1.0,
        };
        let smooth = self.motion.step_size().abs() / per_step;
        let most = least.max(self.setup.speed * LONGEST_LAG);
        if smooth <= least {
            return least;
        }
        // in powers of two, so that it does not change with every step
        (least * math::exp2(math::log2(smooth / least).floor())).min(most)
    }

    /// Has the gauges look at the present.
    fn gauge(&mut self, look: impl FnOnce(&mut Gauges, &Present<'_>)) {
        self.motion.look_at_terms();
        let body = self.motion.system().body_values(&self.setup.parameters);
        let parameter = |symbol| self.setup.constant(&self.model, &body, symbol);
        look(&mut self.gauges, &self.motion.present(&parameter));
    }

    fn show_gauges(&self) -> Arc<[Gauge]> {
        let body = self.motion.system().body_values(&self.setup.parameters);
        let parameter = |symbol| self.setup.constant(&self.model, &body, symbol);
        self.gauges.show(&self.motion.present(&parameter))
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

/// How many of the closest rows a step may reach ahead.
const HORIZON: f64 = 4096.0;

/// How many times as long as the last one a step may be.
const GROWTH: f64 = 8.0;

/// A step of high order covers about a sixth of an oscillation.
const ROWS_PER_LONG_STEP: f64 = 32.0;

/// The longest time between two rows, in seconds of the wall clock: a frame.
const LONGEST_LAG: f64 = 1.0 / 60.0;
