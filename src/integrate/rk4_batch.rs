//! The classic Runge–Kutta method for several orbits at once.
//!
//! In: a state, a step and parameters for each lane. Out: the states that [the method](super::rk4) gives for each orbit alone, to
//! the last bit; numbers that are not finite where it gives none. Never here: systems whose orbits part from each other.

use super::rk4::STAGES;
use crate::num::{Analytic, BATCH, Batch, Kernel, vectorized};
use crate::system::{BatchSteps, OrbitRates, Rates, State, System};

pub(super) struct RungeKuttaBatch {
    rates: OrbitRates,
    /// What depends on the parameters of one lane alone is computed here.
    single: Rates,
    steps: Batch,
    numbers: Vec<MovingNumber>,
    /// The index in a state of each number that does not move.
    others: Vec<usize>,
    /// Six times the mean slope of each number that moves.
    sums: Vec<Batch>,
}

#[derive(Clone, Copy)]
struct MovingNumber {
    value: Batch,
    /// What rounding cut off from it.
    carry: Batch,
    /// Both before the last step.
    before: [Batch; 2],
}

impl RungeKuttaBatch {
    /// Room for orbits of a system; `None` where they have to be followed one by one.
    pub(super) fn new(system: &System) -> Option<RungeKuttaBatch> {
        let single = system.native_rates();
        let rates = single.of_orbits()?;
        let zero = Batch::ZERO;
        let number = MovingNumber { value: zero, carry: zero, before: [zero; 2] };
        let count = system.state_len();
        Some(RungeKuttaBatch {
            others: (0..count).filter(|i| !rates.places().contains(i)).collect(),
            sums: vec![zero; rates.places().len()],
            numbers: vec![number; count],
            steps: zero,
            rates,
            single,
        })
    }

    #[inline(always)]
    fn step(&mut self, times: Batch) {
        let RungeKuttaBatch { rates, steps, numbers, others, sums, .. } = self;
        for number in numbers.iter_mut() {
            number.before = [number.value, number.carry];
        }
        for &i in others.iter() {
            rates.set_number(i, numbers[i].value + numbers[i].carry);
        }
        sums.fill(Batch::ZERO);
        for (stage, (part, weight)) in STAGES.into_iter().enumerate() {
            let size = *steps * part;
            for k in 0..sums.len() {
                let i = rates.places()[k];
                let MovingNumber { value, carry, .. } = numbers[i];
                let slope = if stage == 0 { Batch::ZERO } else { rates.moving().1[k] };
                rates.moving().0[k] = value + (carry + size * slope);
            }
            rates.set_times(times + size);
            rates.evaluate();
            let (_, slopes) = rates.moving();
            for k in 0..sums.len() {
                sums[k] = sums[k] + slopes[k] * weight;
            }
        }
        for k in 0..sums.len() {
            let number = &mut numbers[rates.places()[k]];
            let mean = sums[k] / 6.0;
            // as num::accumulate does
            let (sum, lost) = number.value.sum_with_error(*steps * mean);
            let low = lost + number.carry;
            let value = sum + low;
            number.carry = mean.where_equal(0.0, number.carry, low - (value - sum));
            number.value = mean.where_equal(0.0, number.value, value);
        }
    }
}

impl BatchSteps for RungeKuttaBatch {
    fn set_parameters(&mut self, lane: usize, parameters: &[f64]) -> bool {
        self.single.set_parameters(parameters);
        self.rates.set_parameters_of(lane, &self.single)
    }

    fn set_step(&mut self, lane: usize, step: f64) {
        self.steps.0[lane] = step;
    }

    fn set_state(&mut self, lane: usize, state: &State) {
        for (i, number) in self.numbers.iter_mut().enumerate() {
            number.value.0[lane] = state.values[i];
            number.carry.0[lane] = state.carry[i];
        }
    }

    fn advance(&mut self, count: u64, times: impl Fn(u64) -> Batch) {
        vectorized(RungeKuttaSteps { orbits: self, count, times });
    }

    fn are_finite(&self) -> [bool; BATCH] {
        // zero times anything that is not finite is NaN
        let parts = self.numbers.iter().map(|number| (number.value + number.carry) * 0.0);
        parts.fold(Batch::ZERO, |sum, part| sum + part).0.map(|sum| sum == 0.0)
    }

    fn write(&self, lane: usize, out: &mut State, before: &mut State) {
        for (i, number) in self.numbers.iter().enumerate() {
            (out.values[i], out.carry[i]) = (number.value.0[lane], number.carry.0[lane]);
            let [value, carry] = number.before;
            (before.values[i], before.carry[i]) = (value.0[lane], carry.0[lane]);
        }
    }
}

struct RungeKuttaSteps<'a, T> {
    orbits: &'a mut RungeKuttaBatch,
    count: u64,
    times: T,
}

impl<T: Fn(u64) -> Batch> Kernel for RungeKuttaSteps<'_, T> {
    type Output = ();
    const OF_SEVERAL: bool = true;

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let RungeKuttaSteps { orbits, count, times } = self;
        for step in 0..count {
            let now = if orbits.rates.reads_time() { times(step) } else { Batch::ZERO };
            orbits.step(now);
        }
    }
}
