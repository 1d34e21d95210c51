//! The past of a motion: steps taken again from the states that were logged between them.
//!
//! In: times on the way. Out: the motion there. Never here: which time is shown.

use super::observed_motion::{EQUAL_STEPS, ObservedMotion};
use super::run_token::RunToken;
use super::step_log::LoggedState;
use crate::integrate::{OccurrenceKind, Reached};
use crate::system::{MotionError, State};

/// The step before a time in the past of a motion, from which it is taken again.
pub(super) struct KnownStep {
    state: State,
    steps: u64,
    step: f64,
    released: Vec<usize>,
    start: f64,
}

impl ObservedMotion {
    /// Takes the motion back to a time on the way. If that is no longer known, it stays where it is, and the result is
    /// the first time that is, or NaN.
    pub(super) fn back_to(
        &mut self,
        (time, limit): (f64, f64),
        start: f64,
    ) -> Result<Option<f64>, MotionError> {
        let first = self.log.first().unwrap_or(f64::NAN);
        let Some(known) = self.log.back_to(time) else { return Ok(Some(first)) };
        let released = self.released();
        self.inner.restore_with_step(&known.state, known.step, (start, &released))?;
        self.watch.pending = false;
        self.inner.set_steps(known.steps);
        self.take_observer();
        // what was seen of each step counts only once
        let mut budget = EQUAL_STEPS * 1000;
        while let Reached::Occurred(occurrence) = self.inner.reach(time, limit, &mut budget)? {
            if matches!(occurrence.kind, OccurrenceKind::Impulse { .. }) {
                self.log.note_impulse();
            }
        }
        self.observe()?;
        Ok(None)
    }

    /// Resumes a run at a time on its way, where the motion now is. Returns whether the run is still known;
    /// otherwise the motion stays as it is.
    pub(super) fn resume(
        &mut self,
        run: &RunToken,
        times: (f64, f64),
        start: f64,
    ) -> Result<bool, MotionError> {
        let here = self.inner.state().clone();
        if !self.log.resume(run) {
            return Ok(false);
        }
        let (steps, step) = (self.inner.steps(), self.inner.step_size().abs());
        let taken = matches!(self.back_to(times, start), Ok(None));
        if !taken {
            let released = self.released();
            self.log.clear();
            self.inner.restore_with_step(&here, step, (start, &released))?;
            self.inner.set_steps(steps);
            self.log_state();
        }
        Ok(taken)
    }

    /// The indices of the released constraints.
    pub(super) fn released(&self) -> Vec<usize> {
        let system = self.inner.system();
        (0..system.constraints()).filter(|&k| system.is_released(k)).collect()
    }

    /// The first reading of its clock that can be shown again.
    pub(super) fn known_from(&self) -> Option<f64> {
        self.log.first()
    }

    /// Looks at a time in the past of a motion that began at `start` of its clock, and forgets nothing: what is known of
    /// later times can be shown again. No new step reaches further than `horizon` beyond that time. Returns whether
    /// that time is known.
    pub(super) fn go_back_to(&mut self, time: f64, horizon: f64, start: f64) -> bool {
        let clock = self.sign * time;
        let (begin, end) = self.inner.undisturbed();
        if !(begin <= clock && clock <= end && begin < end) {
            let Some(known) = self.known_at(time, start) else { return false };
            if self.begin_at(&known).is_err() {
                return false;
            }
        }
        self.continue_to(clock, horizon)
    }

    /// What is needed to show a time in the past of a motion that began at `start` of its clock.
    pub(super) fn known_at(&self, time: f64, start: f64) -> Option<KnownStep> {
        let LoggedState { state, steps, step, .. } = self.log.at(self.sign * time)?.clone();
        let released = self.released();
        Some(KnownStep { state, steps, step, released, start })
    }

    /// Goes to where another motion of the same system was at a time. Returns whether it came there.
    pub(super) fn go_to(&mut self, time: f64, known: &KnownStep, horizon: f64) -> bool {
        self.begin_at(known).is_ok() && self.continue_to(self.sign * time, horizon)
    }

    /// Goes from a state of the run the other way to a time before it, by the same fixed step. Returns whether it came there.
    pub(super) fn go_to_before(
        &mut self,
        (state, step): (&State, f64),
        time: f64,
        horizon: f64,
    ) -> bool {
        let mut state = state.clone();
        (state.time, state.time_carry) = (-state.time, -state.time_carry);
        let start = state.time;
        let known = KnownStep { state, steps: 0, step, released: Vec::new(), start };
        self.go_to(time, &known, horizon)
    }

    /// The value of every channel at a state of this motion.
    pub(super) fn values_at(&mut self, state: &State) -> Option<Vec<f64>> {
        let known = KnownStep {
            state: state.clone(),
            steps: 0,
            step: self.inner.step_size().abs(),
            released: self.released(),
            start: state.time,
        };
        (self.begin_at(&known).is_ok() && self.observe().is_ok()).then(|| self.values().to_vec())
    }

    fn begin_at(&mut self, known: &KnownStep) -> Result<(), MotionError> {
        let KnownStep { state, steps, step, released, start } = known;
        self.inner.restore_with_step(state, *step, (*start, released))?;
        self.inner.set_steps(*steps);
        self.watch.pending = false;
        self.take_observer();
        Ok(())
    }

    /// Goes on to a reading of the clock. Returns whether it came there.
    fn continue_to(&mut self, clock: f64, horizon: f64) -> bool {
        let mut budget = EQUAL_STEPS * 1000;
        loop {
            match self.inner.reach(clock, clock + horizon, &mut budget) {
                Ok(Reached::Occurred(_)) => {}
                Ok(Reached::Arrived) => return self.observe().is_ok(),
                Ok(Reached::OutOfBudget | Reached::Ended) | Err(_) => return false,
            }
        }
    }
}
