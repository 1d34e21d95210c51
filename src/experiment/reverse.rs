//! Time reversed: from the current state on, the same law runs the other way, by the same method.
//!
//! The system run backwards ([`System::reversed`]) has −t for its time and the opposite rates of change; all that carries a
//! motion on, events and constraints among it, is the same. What was recorded stays as the run before (`echo`), and the
//! motion that goes back is held against it.
//!
//! In: a command. Out: an experiment whose time runs the other way, or a sentence why there is no way back. Never here: the
//! past as it was recorded (`scrub`, `rewind`).

use std::sync::Arc;

use super::advance::HORIZON;
use super::companion_commands::canonical;
use super::companions::MOST_COMPANIONS;
use super::echo::Echo;
use super::gauges::Gauges;
use super::observed_motion::ObservedMotion;
use super::{AdvanceOutcome, Companion, Experiment};
use crate::analysis::DistanceHistory;
use crate::expr::Expr;
use crate::integrate::Stepping;
use crate::model::EventAction;
use crate::num::short;

impl Experiment {
    pub(super) fn reverse(&mut self) {
        if let Some(why) = self.no_way_back() {
            return self.notify(why);
        }
        let run = match self.turn() {
            Ok(run) => run,
            Err(why) => return self.notify(why),
        };
        let variables = self.variables();
        let mut echo = Echo::of(run, self.recorder.trail(), &variables);
        let parameters = &self.setup.parameters;
        if let (Some(echo), Ok(back)) = (&mut echo, self.motion.another(parameters)) {
            let periods = self.periods(&variables);
            echo.measure_step(back, HORIZON * self.setup.spacing, (&variables, &periods));
        }
        self.reversal.echo = echo.map(Box::new);
        self.run.ended = None;
        self.log.clear();
        self.reversal.began = self.clock();
        self.recorder.turn(self.clock(), self.is_backwards());
        self.gauge(Gauges::refer);
        self.record();
        let way = if self.is_backwards() { "backwards" } else { "forwards" };
        self.notify(format!("from t = {} time runs {way}", short(self.time())));
    }

    /// Why time cannot be reversed, in a sentence.
    fn no_way_back(&self) -> Option<String> {
        if !self.motion.has_begun() || self.run.error.is_some() {
            return Some("there is no motion to reverse".to_owned());
        }
        let happens = self.system().discontinuities();
        let acts = |action: Option<EventAction>| {
            matches!(action, Some(EventAction::Impulse(_) | EventAction::Release(_)))
        };
        let event = happens.events.iter().find(|event| acts(event.action.written()));
        let impulse = happens.impulses.iter().find(|impulse| impulse.scheduled);
        if let Some(name) =
            event.map(|event| &event.name).or_else(|| impulse.map(|impulse| &impulse.name))
        {
            return Some(format!(
                "time is not reversed here: {name} makes the motion jump, and backwards the jump would have to be undone \
                 before it is known; the past that was recorded can be looked at"
            ));
        }
        if self.system().has_kinks() && self.equations.energy_rate != Expr::ZERO {
            return Some(
                "time is not reversed here: a force that jumps takes energy, as dry friction does, and what it has \
                 brought to rest could have come from anywhere; the past that was recorded can be looked at"
                    .to_owned(),
            );
        }
        None
    }

    /// Lets the motion run the other way from where it is. Returns the one until now.
    ///
    /// Equal steps are taken to their end first, so that the way back takes the same ones.
    pub(super) fn turn(&mut self) -> Result<ObservedMotion, String> {
        if self.motion.method().stepping == Stepping::Fixed {
            self.motion.reach_end().map_err(|error| self.motion.dated(error).to_string())?;
        }
        let system = match self.reversal.other_way.take() {
            Some(system) => system,
            None => {
                let whole = self.motion.whole();
                let other = whole.reversed(&self.model, &self.equations);
                other.map_err(|why| why.to_string())?
            }
        };
        let parameters = &self.setup.parameters;
        let (method, settings) = (self.motion.method(), self.motion.settings());
        let mut motion = ObservedMotion::new(&system, method, settings, parameters)
            .map_err(|why| why.to_string())?;
        let mut state = self.motion.dated_state();
        let sign = motion.sign();
        (state.time, state.time_carry) = (sign * state.time, sign * state.time_carry);
        let step = self.motion.step_size().abs();
        let begun = motion.begin_turned(&state, step, &self.motion.released());
        if let Err(error) = begun {
            let error = motion.dated(error);
            self.reversal.other_way = Some(system);
            return Err(error.to_string());
        }
        motion.set_steps(self.motion.steps());
        self.reversal.other_way = Some(self.motion.whole().clone());
        Ok(std::mem::replace(&mut self.motion, motion))
    }

    /// Continues backwards from a state that was restored, without a run before it.
    pub(super) fn continue_backwards(&mut self) {
        match self.turn() {
            Ok(_) => {
                self.reversal.began = self.clock();
                self.recorder.turn(self.clock(), true);
                self.record();
            }
            Err(why) => self.notify(why),
        }
    }

    /// Lets time run forwards again, for a motion that is about to begin.
    pub(super) fn face_forwards(&mut self) {
        self.reversal.echo = None;
        if !self.is_backwards() {
            return;
        }
        let Some(system) = self.reversal.other_way.take() else { return };
        let (method, settings) = (self.motion.method(), self.motion.settings());
        match ObservedMotion::new(&system, method, settings, &self.setup.parameters) {
            Ok(motion) => {
                self.reversal.other_way = Some(self.motion.whole().clone());
                self.motion = motion;
                self.recorder.turn(self.setup.start, false);
            }
            // the method fitted this system before
            Err(why) => self.notify(why.to_string()),
        }
    }

    /// The time from which impulses at intervals are counted.
    pub(super) fn schedule_start(&self) -> f64 {
        if self.is_backwards() { self.reversal.began } else { self.setup.start }
    }

    /// The channels of the canonical variables.
    fn variables(&self) -> Vec<usize> {
        canonical(self.system())
    }

    fn periods(&self, variables: &[usize]) -> Vec<Option<f64>> {
        let (system, parameters) = (self.motion.system(), &self.setup.parameters);
        variables.iter().map(|&i| system.period(i, parameters)).collect()
    }

    /// Compares the motion with the run before at a time, where that has been.
    pub(super) fn compare_with_echo(&mut self, time: f64) {
        if self.reversal.echo.is_none() {
            return;
        }
        let variables = self.variables();
        let periods = self.periods(&variables);
        let Some(echo) = &mut self.reversal.echo else { return };
        let now = (time, self.motion.values());
        echo.compare(now, HORIZON * self.setup.spacing, (&variables, &periods));
    }

    /// Where on the clock the run before began, if the motion has not yet been there.
    pub(super) fn return_clock(&self) -> Option<f64> {
        let home = self.motion.sign() * self.reversal.echo.as_ref()?.start;
        (home > self.clock()).then_some(home)
    }

    /// The motion is back where the run before began, and pauses.
    pub(super) fn finish_return(&mut self) -> AdvanceOutcome {
        self.run.running = false;
        // beside a step in time the state may be dated otherwise
        if let Some(start) =
            self.reversal.echo.as_ref().filter(|echo| !echo.is_complete()).map(|echo| echo.start)
        {
            self.compare_with_echo(start);
        }
        let Some(echo) = &self.reversal.echo else { return AdvanceOutcome::Arrived };
        let returned = echo.returned();
        let start = short(returned.start);
        match returned.error {
            Some(0.0) => {
                self.notify(format!("back at t = {start}: where it began, to the last bit"));
            }
            Some(error) => self.notify(format!(
                "back at t = {start}: {} from where it began; a step errs by {} {}",
                short(error),
                // what was not measured is the tolerance
                if returned.step.is_some() { "ε ≈" } else { "at most ε ≈" },
                short(returned.step_error),
            )),
            None => self.notify(format!("back at t = {start}")),
        }
        AdvanceOutcome::Ended
    }

    /// The motions beside this one, and their distances; while time is reversed, the run before and the distance from it.
    pub(super) fn shown_beside(
        &self,
        time: f64,
    ) -> (Arc<[Companion]>, Arc<[(usize, Arc<DistanceHistory>)]>) {
        let companions = self.companions.shown(time);
        let Some(echo) = &self.reversal.echo else {
            return (companions, self.companions.separations());
        };
        let number = self.companions.number().unwrap_or(MOST_COMPANIONS + 1);
        let surfaces = self.model.sections.len();
        let before = echo.shown(number, &self.setup.parameters, surfaces);
        let all = companions.iter().cloned().chain([before]).collect();
        (all, Arc::new([(number, echo.separation())]))
    }
}
