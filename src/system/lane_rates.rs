//! The rates of a motion at several states at once, a state in each lane: the stages of one step, or several orbits.
//!
//! In: times, numbers of the states, parameters. Out: their rates, with the bits that each state has by itself. Never here: which
//! states, programs that cannot be written as a list.

use super::program::Op;
use super::rates::Rates;
use super::rates_list::RatesList;
use crate::num::{Analytic, BATCH, Batch};

/// The largest number of stages.
pub const STAGES: usize = 4;

/// A number at each stage.
pub type Stages = Batch<STAGES>;

/// The rates at the stages of a step.
pub type StageRates = LaneRates<STAGES>;

/// The rates of several orbits.
pub type OrbitRates = LaneRates<BATCH>;

/// The rates at N states. It owns its registers.
#[derive(Clone, Debug)]
pub struct LaneRates<const N: usize> {
    list: RatesList<Batch<N>>,
    /// The index in a state of each number that moves.
    places: Vec<usize>,
    reads_time: bool,
}

impl Rates {
    /// These rates at so many stages side by side; lanes without a stage must repeat the first. `None` where
    /// velocities have to be solved for, where the program cannot be written as a list, and for more than [`STAGES`].
    pub fn of_stages(&self, count: usize) -> Option<StageRates> {
        let mut rates = self.in_lanes().filter(|_| (1..=STAGES).contains(&count))?;
        rates.list.use_lanes(count);
        Some(rates)
    }

    /// These rates of several orbits side by side. `None` where velocities have to be solved for, where the program
    /// cannot be written as a list, and where an orbit may take another course than its neighbours.
    pub fn of_orbits(&self) -> Option<OrbitRates> {
        let parts = |op: &Op| matches!(op, Op::Select { .. } | Op::ParametricPower(..));
        let system = self.system();
        let alike = system.is_undisturbed() && !system.has_branches() && !system.has_logarithms();
        let smooth = !self.program.ops.iter().any(parts);
        self.in_lanes().filter(|_| alike && smooth)
    }

    fn in_lanes<const N: usize>(&self) -> Option<LaneRates<N>> {
        let list = RatesList::new(self.outputs(), self.system().state_len());
        let list = list.filter(|_| self.is_direct())?;
        let reads_time = self.program.ops.contains(&Op::Time);
        Some(LaneRates { list, places: self.places.clone(), reads_time })
    }
}

impl<const N: usize> LaneRates<N> {
    /// Sets the parameters of all lanes to those of `rates`. Returns false if numbers may leave the range of `f64`, so that
    /// the states must be evaluated one by one.
    #[must_use]
    pub fn set_parameters(&mut self, rates: &Rates) -> bool {
        self.list.set_parameters(&rates.values);
        self.list.suits()
    }

    /// Sets the parameters of one lane to those of `rates`. Returns false as [`LaneRates::set_parameters`] does.
    #[must_use]
    pub fn set_parameters_of(&mut self, lane: usize, rates: &Rates) -> bool {
        self.list.set_parameters_of(lane, &rates.values)
    }

    /// The index in a state of each number that moves.
    pub fn places(&self) -> &[usize] {
        &self.places
    }

    /// Whether the rates may depend on time.
    pub fn reads_time(&self) -> bool {
        self.reads_time
    }

    /// Sets the times of the states.
    #[inline(always)]
    pub fn set_times(&mut self, times: Batch<N>) {
        self.list.set_time(times);
    }

    /// Sets a number of all states.
    #[inline(always)]
    pub fn set_number(&mut self, i: usize, x: Batch<N>) {
        *self.list.number(i) = x;
    }

    /// Evaluates the rates. Must be inlined into a kernel to have vector instructions.
    #[inline(always)]
    pub fn evaluate(&mut self) {
        self.list.evaluate();
    }

    /// The numbers that move, and their rates at the last evaluation, in the order of [`places`](LaneRates::places).
    #[inline(always)]
    pub fn moving(&mut self) -> (&mut [Batch<N>], &[Batch<N>]) {
        self.list.moving()
    }

    /// Whether all numbers that move, and their rates, are finite.
    #[inline(always)]
    pub fn are_finite(&mut self) -> bool {
        let (numbers, rates) = self.list.moving();
        let mut sum = Batch::ZERO;
        for k in 0..numbers.len() {
            // zero times anything that is not finite is NaN
            sum = sum + numbers[k] * 0.0 + rates[k] * 0.0;
        }
        sum == Batch::ZERO
    }
}
