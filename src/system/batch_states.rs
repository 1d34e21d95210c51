//! The states of several orbits side by side, all of one form.
//!
//! In: states, one for each lane. Out: the same number of all of them, or the state of one. Never here: how they move.

use super::state::{Form, State};
use crate::num::{Analytic, BATCH, Batch, DoubleDouble};

/// A state in each lane. Numbers and times are sums of two, as those of a [`State`].
#[derive(Clone, Debug)]
pub struct BatchStates {
    form: Form,
    pub(super) times: [DoubleDouble; BATCH],
    pub(super) high: Vec<Batch>,
    pub(super) low: Vec<Batch>,
}

impl BatchStates {
    /// States of this form with so many numbers, all zero.
    pub fn new(form: Form, len: usize) -> BatchStates {
        let zeros = vec![Batch::ZERO; len];
        BatchStates { form, times: [DoubleDouble::ZERO; BATCH], high: zeros.clone(), low: zeros }
    }

    /// Puts a state into a lane.
    pub fn set(&mut self, lane: usize, state: &State) {
        self.times[lane] = state.exact_time();
        let numbers = self.high.iter_mut().zip(&mut self.low);
        for ((high, low), (&value, &carry)) in numbers.zip(state.values.iter().zip(&state.carry)) {
            (high.0[lane], low.0[lane]) = (value, carry);
        }
    }

    /// Writes the state of a lane.
    pub fn write(&self, lane: usize, out: &mut State) {
        out.form = self.form;
        out.set_time(self.times[lane]);
        out.values.clear();
        out.values.extend(self.high.iter().map(|x| x.0[lane]));
        out.carry.clear();
        out.carry.extend(self.low.iter().map(|x| x.0[lane]));
    }

    /// The time of a lane.
    #[inline]
    pub fn time(&self, lane: usize) -> DoubleDouble {
        self.times[lane]
    }

    /// Sets the time of a lane.
    #[inline]
    pub fn set_time(&mut self, lane: usize, time: DoubleDouble) {
        self.times[lane] = time;
    }

    /// All times, in `f64`.
    #[inline]
    pub fn times(&self) -> Batch {
        let mut times = Batch::ZERO;
        for lane in 0..BATCH {
            times.0[lane] = self.times[lane].high;
        }
        times
    }

    /// All numbers, in `f64`.
    #[inline]
    pub fn numbers(&self) -> &[Batch] {
        &self.high
    }

    /// Zero in the lanes whose numbers are all finite, else NaN.
    #[inline]
    pub fn finite(&self) -> Batch {
        let mut finite = self.times() * 0.0;
        for &x in &self.high {
            finite = finite + x * 0.0;
        }
        finite
    }
}
