//! Several steps in a row, seen at the end of each.
//!
//! In: the numbers and times that a stepper writes. Out: these, a step in each lane. Never here: which
//! steps, what is made of them.

use crate::num::Batch;
use crate::system::{Form, State};

/// The ends of several steps in a row.
#[derive(Clone, Debug)]
pub struct StepBlock {
    /// The time at which the first step began.
    pub begin: f64,
    /// The number of steps.
    pub count: usize,
    /// The time at the end of each.
    pub times: Batch,
    /// The numbers of the state at the end of each.
    pub numbers: Vec<Batch>,
}

impl Default for StepBlock {
    fn default() -> StepBlock {
        StepBlock { begin: 0.0, count: 0, times: Batch::splat(0.0), numbers: Vec::new() }
    }
}

impl StepBlock {
    /// The times at which a step begins and ends.
    pub fn interval(&self, step: usize) -> (f64, f64) {
        let begin = if step == 0 { self.begin } else { self.times.0[step - 1] };
        (begin, self.times.0[step])
    }

    /// The state at the end of a step, without what rounding cut off.
    pub fn state(&self, step: usize, form: Form) -> State {
        let numbers = self.numbers.iter().map(|number| number.0[step]);
        State::new(self.times.0[step], form, numbers.collect())
    }
}
