//! Many steps of a splitting method at once.
//!
//! In: the rates of both halves, the weights of the composition, a state. Out: the state after many
//! steps and that before the last of them, with the bits that single steps give; if asked for, the
//! numbers at the end of each. Never here: a number that is not finite, time, which steps to take; for
//! these the motion is evaluated operation by operation.

use super::State;
use super::rates::Rates;
use super::registers::Registers;
use super::stage_list::{Composition, StageList};
use super::stage_machine::StageSteps;
use crate::num::{BATCH, Batch, vectorized};

/// Many steps of one splitting method.
#[derive(Clone, Debug)]
pub struct SplitStep {
    halves: [Rates; 2],
    stages: StageList,
    registers: Registers<f64>,
    /// Whether the list gives what single steps give at these parameters.
    suits: bool,
}

impl SplitStep {
    /// The steps of the rates under T alone and under V alone. Returns `None` where they cannot be written as a list.
    pub fn new(drift: &Rates, kick: &Rates, composition: &Composition) -> Option<SplitStep> {
        let stages = StageList::new(drift, kick, composition)?;
        let registers = Registers::of(&stages.map);
        let halves = [drift.clone(), kick.clone()];
        Some(SplitStep { halves, stages, registers, suits: false })
    }

    /// Sets the parameters. Must be called before the first step.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        for half in &mut self.halves {
            half.set_parameters(parameters);
        }
        self.suits = self.halves.iter().all(|half| half.values.is_ordinary());
        for &(half, operation, to) in &self.stages.map.fixed {
            self.registers.values[usize::from(to)] =
                self.halves[usize::from(half)].values.register(operation);
        }
    }

    /// Moves the numbers of a state by `count` steps, at least one, and writes those before the last
    /// of them into `before`. Returns false, with the state unchanged, where a number is or may be not
    /// what single steps give.
    #[must_use]
    pub fn advance(
        &mut self,
        step: f64,
        count: u64,
        state: &mut State,
        before: &mut State,
    ) -> bool {
        before.copy_from(state);
        self.run(step, [count, count.saturating_sub(1)], state, |done, registers, places| {
            if done < count {
                copy_out(registers, places, before);
            }
        })
    }

    /// Moves the numbers of a state by at most [`BATCH`] steps, and writes the numbers at the end of each into its lane
    /// of `seen`. Returns false as [`SplitStep::advance`] does.
    #[must_use]
    pub fn advance_seen(
        &mut self,
        step: f64,
        count: u64,
        state: &mut State,
        before: &mut State,
        seen: &mut [Batch],
    ) -> bool {
        debug_assert!(count <= BATCH as u64, "a lane for each step");
        before.copy_from(state);
        self.run(step, [count, 1], state, |done, registers, places| {
            let lane = (done - 1) as usize % BATCH;
            for (seen, &place) in seen.iter_mut().zip(places) {
                seen.0[lane] = registers.values[usize::from(place)];
            }
            if done + 1 == count {
                copy_out(registers, places, before);
            }
        })
    }

    /// Takes `count` steps, and shows the registers at the end of each `from` one on, with the places
    /// of the numbers in them.
    fn run(
        &mut self,
        step: f64,
        [count, from]: [u64; 2],
        state: &mut State,
        mut seen: impl FnMut(u64, &Registers<f64>, &[u8]),
    ) -> bool {
        if !self.suits || count == 0 {
            return false;
        }
        let SplitStep { stages, registers, .. } = self;
        let numbers = state.values.iter().zip(&state.carry);
        for (&place, (&value, &carry)) in stages.map.numbers.iter().zip(numbers) {
            registers.values[usize::from(place)] = value;
            registers.carries[usize::from(place)] = carry;
        }
        for (factor, x) in registers.factors.iter_mut().zip(stages.factors(step)) {
            *factor = x;
        }
        let seen = |done, registers: &_| seen(done, registers, &stages.map.numbers);
        vectorized(StageSteps { registers, stages, count, from, seen });
        // what is not finite stays so
        let finite = |&place: &u8| {
            let place = usize::from(place);
            registers.values[place].is_finite() && registers.carries[place].is_finite()
        };
        let is_finite = stages.map.numbers.iter().all(finite);
        if is_finite {
            copy_out(registers, &stages.map.numbers, state);
        }
        is_finite
    }
}

fn copy_out(registers: &Registers<f64>, places: &[u8], out: &mut State) {
    let numbers = out.values.iter_mut().zip(&mut out.carry);
    for (&place, (value, carry)) in places.iter().zip(numbers) {
        (*value, *carry) =
            (registers.values[usize::from(place)], registers.carries[usize::from(place)]);
    }
}
