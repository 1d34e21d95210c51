//! Steps of a splitting method of several orbits at once, each from its own state, in its own step and
//! with its own parameters.
//!
//! In: a state, a step and parameters for each lane. Out: the states that a
//! [`SplitStep`](super::SplitStep) of that orbit alone gives, to the last bit; numbers that are not
//! finite where it gives none. Never here: systems whose orbits part from each other, time.

use super::batch_steps::BatchSteps;
use super::compiled::System;
use super::program::Op;
use super::rates::Rates;
use super::registers::Registers;
use super::stage_list::{Composition, StageList};
use super::stage_machine::StageSteps;
use super::state::State;
use crate::num::{Analytic, BATCH, Batch, vectorized};

/// Steps of several orbits.
#[derive(Clone, Debug)]
pub struct BatchSplitStep {
    halves: [Rates; 2],
    stages: StageList,
    registers: Registers<Batch>,
    /// The numbers before the last step, with what rounding cut off.
    before: Vec<[Batch; 2]>,
}

impl System {
    /// The steps of a composition, of several orbits. There are none where steps of one orbit cannot be written as a
    /// list, and where an orbit may take another course than its neighbours.
    pub fn batch_split_step(&self, composition: &Composition) -> Option<BatchSplitStep> {
        let (drift, kick) = self.split_rates()?;
        let parts = |rates: &Rates| {
            let part = |op: &Op| matches!(op, Op::Select { .. } | Op::ParametricPower(..));
            rates.program.ops.iter().any(part)
        };
        if parts(&drift)
            || parts(&kick)
            || !self.is_undisturbed()
            || self.has_branches()
            || self.has_logarithms()
        {
            return None;
        }
        let stages = StageList::new(&drift, &kick, composition)?;
        Some(BatchSplitStep {
            registers: Registers::of(&stages.map),
            stages,
            halves: [drift, kick],
            before: vec![[Batch::ZERO; 2]; self.state_len()],
        })
    }
}

impl BatchSteps for BatchSplitStep {
    fn set_parameters(&mut self, lane: usize, parameters: &[f64]) -> bool {
        for half in &mut self.halves {
            half.set_parameters(parameters);
        }
        for &(half, operation, to) in &self.stages.map.fixed {
            self.registers.values[usize::from(to)].0[lane] =
                self.halves[usize::from(half)].values.register(operation);
        }
        self.halves.iter().all(|half| half.values.is_ordinary())
    }

    fn set_step(&mut self, lane: usize, step: f64) {
        for (factor, x) in self.registers.factors.iter_mut().zip(self.stages.factors(step)) {
            factor.0[lane] = x;
        }
    }

    fn set_state(&mut self, lane: usize, state: &State) {
        let numbers = state.values.iter().zip(&state.carry);
        for (&place, (&value, &carry)) in self.stages.map.numbers.iter().zip(numbers) {
            self.registers.values[usize::from(place)].0[lane] = value;
            self.registers.carries[usize::from(place)].0[lane] = carry;
        }
    }

    /// None of the rates depends on time.
    fn advance(&mut self, count: u64, _times: impl Fn(u64) -> Batch) {
        let BatchSplitStep { stages, registers, before, .. } = self;
        let mut keep = |registers: &Registers<Batch>| {
            for (before, &place) in before.iter_mut().zip(&stages.map.numbers) {
                let place = usize::from(place);
                *before = [registers.values[place], registers.carries[place]];
            }
        };
        if count == 1 {
            keep(registers);
        }
        let seen = |done: u64, registers: &Registers<Batch>| {
            if done + 1 == count {
                keep(registers);
            }
        };
        vectorized(StageSteps { registers, stages, count, from: count - 1, seen });
    }

    fn are_finite(&self) -> [bool; BATCH] {
        let mut sum = Batch::ZERO;
        for &place in &self.stages.map.numbers {
            let place = usize::from(place);
            // zero times anything that is not finite is NaN
            sum = sum + (self.registers.values[place] + self.registers.carries[place]) * 0.0;
        }
        sum.0.map(|sum| sum == 0.0)
    }

    fn write(&self, lane: usize, out: &mut State, before: &mut State) {
        let lane = lane % BATCH;
        let numbers = out.values.iter_mut().zip(&mut out.carry);
        for (&place, (value, carry)) in self.stages.map.numbers.iter().zip(numbers) {
            *value = self.registers.values[usize::from(place)].0[lane];
            *carry = self.registers.carries[usize::from(place)].0[lane];
        }
        let numbers = before.values.iter_mut().zip(&mut before.carry);
        for ([values, carries], (value, carry)) in self.before.iter().zip(numbers) {
            (*value, *carry) = (values.0[lane], carries.0[lane]);
        }
    }
}
