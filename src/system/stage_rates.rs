//! The rates of a motion at all stages of a step at once, a stage in each lane.
//!
//! In: times and numbers of the stages. Out: their rates, with the bits that each stage has by itself. Never here: which
//! stages, programs that cannot be written as a list.

use super::rates::Rates;
use super::rates_list::RatesList;
use crate::num::{Analytic, Batch};

/// The largest number of stages.
pub const STAGES: usize = 4;

/// A number at each stage.
pub type Stages = Batch<STAGES>;

/// The rates at the stages. It owns its registers.
#[derive(Clone, Debug)]
pub struct StageRates {
    list: RatesList<Stages>,
    /// The index in a state of each number that moves.
    places: Vec<usize>,
}

impl Rates {
    /// The same rates for so many stages side by side; lanes without a stage must repeat the first. There are none where
    /// velocities have to be solved for, where the program cannot be written as a list, and for more than [`STAGES`].
    pub fn of_stages(&self, count: usize) -> Option<StageRates> {
        let possible = self.is_direct() && (1..=STAGES).contains(&count);
        let mut list =
            RatesList::new(self.outputs(), self.system().state_len()).filter(|_| possible)?;
        list.use_lanes(count);
        Some(StageRates { list, places: self.places.clone() })
    }
}

impl StageRates {
    /// Sets the parameters to those of `rates`. Returns false if numbers may leave the range of `f64`, so that the stages
    /// must be evaluated one by one.
    #[must_use]
    pub fn set_parameters(&mut self, rates: &Rates) -> bool {
        self.list.set_parameters(&rates.values);
        self.list.suits()
    }

    /// The index in a state of each number that moves.
    pub fn places(&self) -> &[usize] {
        &self.places
    }

    /// Sets the times of the stages.
    #[inline(always)]
    pub fn set_times(&mut self, times: Stages) {
        self.list.set_time(times);
    }

    /// Sets a number of the state at all stages.
    #[inline(always)]
    pub fn set_number(&mut self, i: usize, x: Stages) {
        *self.list.number(i) = x;
    }

    /// Evaluates the rates. Must be inlined into a kernel to have vector instructions.
    #[inline(always)]
    pub fn evaluate(&mut self) {
        self.list.evaluate();
    }

    /// The numbers that move, and their rates at the last evaluation, in the order of [`places`](StageRates::places).
    #[inline(always)]
    pub fn moving(&mut self) -> (&mut [Stages], &[Stages]) {
        self.list.moving()
    }

    /// Whether all numbers that move, and their rates, are finite.
    #[inline(always)]
    pub fn are_finite(&mut self) -> bool {
        let (numbers, rates) = self.list.moving();
        let mut sum = Stages::ZERO;
        for k in 0..numbers.len() {
            // zero times anything that is not finite is NaN
            sum = sum + numbers[k] * 0.0 + rates[k] * 0.0;
        }
        sum == Stages::ZERO
    }
}
