//! The states between which the steps of a motion were taken, so that it can be carried back to any time in between.
//!
//! A method that begins again at such a state takes the same step as before, whose dense output then gives the state
//! inside: what is seen when time goes back is what was there. (`dop853` remembers the size of the step before, so
//! that its states agree within its tolerance.)
//!
//! In: states at the ends of steps. Out: the last of them before a time. Never here: how the motion begins again.

use std::collections::VecDeque;

use super::run_token::{ReleasedToken, RunToken};
use crate::system::State;

/// The most numbers that are stored (32 MB), and the most states.
const NUMBERS: usize = 4_000_000;
const STATES: usize = 65_536;

/// A state at the end of a step.
#[derive(Clone, Debug)]
pub(super) struct LoggedState {
    pub(super) state: State,
    /// The steps taken, and the impulses applied up to it.
    pub(super) steps: u64,
    pub(super) impulses: u64,
    /// The size of the next step, if steps are equal: a step that was not set is chosen anew at each impulse.
    pub(super) step: f64,
}

fn size(logged: &LoggedState) -> usize {
    2 * logged.state.values.len()
}

/// The states so far, the oldest first.
#[derive(Default)]
pub(super) struct StepLog {
    known: VecDeque<LoggedState>,
    /// The most numbers that are stored, if others than of the main motion.
    numbers: Option<usize>,
    /// Whether nobody will take the motion back.
    off: bool,
    impulses: u64,
    run: RunToken,
    /// The states of runs before that may be resumed, the oldest first.
    earlier: VecDeque<(ReleasedToken, VecDeque<LoggedState>)>,
}

impl StepLog {
    /// An empty log that stores at most so many numbers.
    pub(super) fn bounded(numbers: usize) -> StepLog {
        StepLog { numbers: Some(numbers), ..StepLog::default() }
    }

    /// Begins anew: what comes has another law or other constraints. The states so far are kept while somebody holds
    /// the token of their run.
    pub(super) fn clear(&mut self) {
        let known = std::mem::take(&mut self.known);
        let run = std::mem::take(&mut self.run).release();
        if !known.is_empty() {
            self.earlier.push_back((run, known));
        }
        self.earlier.retain(|(run, _)| run.upgrade().is_some());
        let mut numbers = 0;
        let sizes =
            self.earlier.iter().rev().map(|(_, known)| known.iter().map(size).sum::<usize>());
        let fitting = sizes.take_while(|size| {
            numbers += size;
            numbers <= NUMBERS
        });
        let excess = self.earlier.len() - fitting.count();
        self.earlier.drain(..excess);
    }

    pub(super) fn run(&self) -> RunToken {
        self.run.clone()
    }

    /// Resumes an earlier run. Returns whether it is still known.
    pub(super) fn resume(&mut self, run: &RunToken) -> bool {
        let is_wanted = |released: &ReleasedToken| released.upgrade().as_ref() == Some(run);
        let Some(at) = self.earlier.iter().position(|(released, _)| is_wanted(released)) else {
            return false;
        };
        let Some((_, known)) = self.earlier.remove(at) else { return false };
        self.clear();
        (self.known, self.run) = (known, run.clone());
        true
    }

    /// Forgets everything, and what comes as well.
    pub(super) fn turn_off(&mut self) {
        self.known = VecDeque::new();
        self.off = true;
    }

    /// Whether nothing is logged.
    pub(super) fn is_off(&self) -> bool {
        self.off
    }

    /// The number of steps before the next that is logged, if one of so many is.
    pub(super) fn steps_to_next(&self, steps: u64, apart: u64) -> u64 {
        if self.off { u64::MAX } else { apart - steps % apart }
    }

    /// Adds the state at the end of a step, from which steps of this size lead on if they are equal. The end of a step that an
    /// impulse or a step in time has cut short is no state of the motion.
    pub(super) fn push(&mut self, state: &State, steps: u64, step: f64) {
        if state.values.is_empty() || self.off {
            return;
        }
        let later = |known: &LoggedState| known.state.exact_time() - state.exact_time();
        while self.known.back().is_some_and(|known| later(known).high > 0.0) {
            self.known.pop_back();
        }
        let impulses = self.impulses;
        let numbers = self.numbers.unwrap_or(NUMBERS);
        let most = (numbers / (2 * state.values.len())).clamp(64, STATES);
        let oldest = if self.known.len() >= most { self.known.pop_front() } else { None };
        let logged = match oldest {
            // the oldest gives way to the newest
            Some(mut oldest) => {
                oldest.state.copy_from(state);
                LoggedState { steps, impulses, step, ..oldest }
            }
            None => LoggedState { state: state.clone(), steps, impulses, step },
        };
        self.known.push_back(logged);
    }

    pub(super) fn note_impulse(&mut self) {
        self.impulses += 1;
    }

    pub(super) fn impulses(&self) -> u64 {
        self.impulses
    }

    pub(super) fn first(&self) -> Option<f64> {
        self.known.front().map(|known| known.state.time)
    }

    /// The mean size of the steps that are known.
    pub(super) fn mean_step(&self) -> Option<f64> {
        let (first, last) = (self.known.front()?, self.known.back()?);
        let steps = last.steps.checked_sub(first.steps).filter(|steps| *steps > 0)?;
        Some((last.state.time - first.state.time).abs() / steps as f64)
    }

    /// Pairs of neighbouring states between which no impulse acted, spread over all that is known, up to so many.
    pub(super) fn sample(&self, most: usize) -> Vec<[LoggedState; 2]> {
        let pairs = self.known.len().saturating_sub(1);
        let count = pairs.min(most);
        let pair = |k: usize| {
            let first = k * pairs / count;
            [self.known[first].clone(), self.known[first + 1].clone()]
        };
        let even = |[from, to]: &[LoggedState; 2]| {
            from.impulses == to.impulses && to.steps > from.steps && to.state.time > from.state.time
        };
        (0..count).map(pair).filter(even).collect()
    }

    /// The last state at or before a time. Nothing is forgotten.
    pub(super) fn at(&self, time: f64) -> Option<&LoggedState> {
        let after = self.known.partition_point(|known| known.state.time <= time);
        self.known.get(after.checked_sub(1)?)
    }

    /// The last state at or before a time. Later ones are forgotten.
    pub(super) fn back_to(&mut self, time: f64) -> Option<LoggedState> {
        if self.first()? > time {
            return None;
        }
        while self.known.back().is_some_and(|known| known.state.time > time) {
            self.known.pop_back();
        }
        let found = self.known.back().cloned()?;
        self.impulses = found.impulses;
        Some(found)
    }
}
