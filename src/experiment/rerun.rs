//! The past of a motion that is resumed in another session, computed once more.
//!
//! A session stores the state of a motion and not its past, which is far longer and follows from the start, or from where the law was
//! changed last. If it has come to the stored state again, to the last bit, the motion continues from there with all that was
//! recorded, a run whose time was reversed included. If it comes close, as after a session that was itself resumed, what was
//! recorded stands before the stored state.
//!
//! In: a checkpoint without a past. Out: an experiment that has run until then. Never here: how a state is restored (`checkpoint`).

use std::sync::Arc;

use super::checkpoint::{Checkpoint, MotionState};
use super::gauges::Gauges;
use super::run_log::RunLog;
use super::{AdvanceOutcome, Experiment, Trail};
use crate::system::State;

/// The most steps and rows, and the number of them times the square of the number of variables.
const STEPS: u64 = 20_000;
const WORK: u64 = 5_000_000;

/// The end of a rerun within this part of the size of the motion is that of the same motion.
const SAME: f64 = 1e-6;

pub(super) enum Rerun {
    /// The stored state, to the last bit: the experiment is in it, with its past.
    Exact,
    Near(RerunPast),
    /// Another state, or none: the past is not known.
    Lost,
}

/// What was recorded on the way.
pub(super) struct RerunPast {
    pub(super) trail: Trail,
    pub(super) log: RunLog,
}

impl Experiment {
    /// Runs from the start, where the experiment is, or from the last change of its law to where a checkpoint is.
    pub(super) fn rerun(&mut self, checkpoint: &Checkpoint, present: &MotionState) -> Rerun {
        if self.run.error.is_some() || !self.begin_after_change(present) {
            return Rerun::Lost;
        }
        let variables = self.system().state_len() as u64;
        let mut budget = (WORK / (variables * variables).max(1)).min(STEPS);
        let mut reaches = |this: &mut Experiment, clock: f64| {
            if clock <= this.clock() {
                return clock == this.clock();
            }
            let before = this.computed().1;
            let outcome = this.advance_main(clock, budget);
            budget = budget.saturating_sub(this.computed().1.saturating_sub(before));
            matches!(outcome, AdvanceOutcome::Arrived | AdvanceOutcome::Ended)
                && clock == this.clock()
        };
        if checkpoint.backwards {
            let Some(turned) = checkpoint.turned else { return Rerun::Lost };
            if !reaches(self, turned) {
                return Rerun::Lost;
            }
            self.reverse();
            if !self.is_backwards() || !reaches(self, -present.time) {
                return Rerun::Lost;
            }
        } else if !reaches(self, present.time) {
            return Rerun::Lost;
        }
        let (here, there) = (self.motion.dated_state(), present.exact());
        if is_same(&here, &there) && self.run.ended == present.ended {
            return Rerun::Exact;
        }
        if checkpoint.backwards || !self.is_near(&here, &there) {
            return Rerun::Lost;
        }
        Rerun::Near(RerunPast { trail: self.recorder.trail(), log: self.log.clone() })
    }

    /// Begins where the law was changed last, if it was. Returns whether the motion is known from there.
    fn begin_after_change(&mut self, present: &MotionState) -> bool {
        let Some(saved) = &present.changed else { return true };
        let Some(change) = saved.of_system(self.system()).filter(|_| present.released.is_empty())
        else {
            return false;
        };
        let (state, start) = (Arc::clone(&change.state), self.setup.start);
        if self.motion.restore((&state, None), &self.setup.parameters, (start, &[])).is_err() {
            return false;
        }
        self.changes.last = Some(Arc::new(change));
        self.recorder.restart(state.time);
        self.gauge(Gauges::refer);
        self.record();
        true
    }

    /// Whether two states of the same motion differ by little beside what it has moved through.
    fn is_near(&self, here: &State, there: &State) -> bool {
        let bounds = self.recorder.bounds();
        let largest = |i: usize| {
            let moved = bounds.get(i).map_or(0.0, |(low, high)| high - low);
            moved.max(there.values[i].abs())
        };
        let moving = self.system().moving();
        let size = (0..moving).map(largest).fold(0.0, f64::max);
        let pairs = here.values.iter().zip(&there.values).take(moving);
        here.time == there.time
            && here.form == there.form
            && pairs.into_iter().all(|(a, b)| is_within(a - b, size))
    }
}

/// Whether a difference is small beside the size of the motion.
fn is_within(difference: f64, size: f64) -> bool {
    difference.abs() <= SAME * size
}

/// Whether two states are the same to the last bit.
fn is_same(one: &State, other: &State) -> bool {
    let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let all = |state: &State| {
        let time = [state.time, state.time_carry];
        (bits(&time), state.form, bits(&state.values), bits(&state.carry))
    };
    all(one) == all(other)
}

#[cfg(test)]
mod tests {
    use super::is_within;

    #[test]
    fn a_rerun_ends_within_a_millionth_of_the_size_of_the_motion() {
        assert!(is_within(-1.9e-6, 2.0) && !is_within(-2.1e-6, 2.0));
        assert!(!is_within(f64::NAN, 2.0));
    }
}
