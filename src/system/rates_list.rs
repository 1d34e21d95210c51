//! The rates of a motion as one straight list of instructions, for the numbers of one state or of several side by side.
//!
//! In: a time and the numbers of a state. Out: the rates that an [`Evaluator`] computes operation by operation, to the last bit.
//! Never here: matrices that are singular and numbers that leave the range of `f64`: its rates are then not finite.

use std::sync::Arc;

use super::instruction::Instruction;
use super::program::Program;
use super::register_map::RegisterMap;
use super::registers::{Registers, StageNumber};
use super::value::Evaluator;

#[derive(Clone, Debug)]
pub(super) struct RatesList<R> {
    map: RegisterMap,
    list: Vec<Instruction>,
    registers: Registers<R>,
    /// The register of the first rate; the others follow it in the order of the program's outputs.
    first: usize,
    count: usize,
    /// Whether numbers that are finite are right at these parameters.
    suits: bool,
}

impl<R: StageNumber> RatesList<R> {
    /// The list of a program, whose outputs are the rates of the numbers with these indices in a state of `count`. Returns
    /// `None` where the program cannot be written as a list. The parameters must be set before the first evaluation.
    pub(super) fn new(
        (program, places): (&Arc<Program>, &[usize]),
        count: usize,
    ) -> Option<RatesList<R>> {
        let others: Vec<usize> = (0..count).filter(|i| !places.contains(i)).collect();
        let mut map = RegisterMap::new([places, &others], true)?;
        let (list, moved) = map.lower((program, places), [places])?;
        let &[moved] = moved.as_slice() else { return None };
        let registers = Registers::of(&map);
        let (first, count) = (usize::from(moved.rate), usize::from(moved.count));
        Some(RatesList { map, list, registers, first, count, suits: false })
    }

    /// Says that only the first lanes differ from each other; the others are copies of the first.
    pub(super) fn use_lanes(&mut self, count: usize) {
        self.registers.used = count;
    }

    /// Takes over what depends on parameters alone.
    pub(super) fn set_parameters(&mut self, values: &Evaluator<f64>) {
        self.suits = values.is_ordinary();
        for &(_, operation, to) in &self.map.fixed {
            self.registers.values[usize::from(to)] = R::of(values.register(operation).into());
        }
    }

    /// The same in one lane. Returns whether numbers that are finite are right there.
    pub(super) fn set_parameters_of(&mut self, lane: usize, values: &Evaluator<f64>) -> bool {
        for &(_, operation, to) in &self.map.fixed {
            self.registers.values[usize::from(to)].lanes()[lane] = values.register(operation);
        }
        values.is_ordinary()
    }

    /// Whether its rates are those of the program, where they are finite.
    pub(super) fn suits(&self) -> bool {
        self.suits
    }

    #[inline(always)]
    pub(super) fn set_time(&mut self, time: R) {
        if let Some(place) = self.map.time {
            self.registers.values[usize::from(place)] = time;
        }
    }

    /// The time of the last evaluation; zero where nothing depends on it.
    pub(super) fn time(&self) -> R {
        self.map.time.map_or(R::ZERO, |place| self.registers.values[usize::from(place)])
    }

    #[inline(always)]
    pub(super) fn number(&mut self, i: usize) -> &mut R {
        &mut self.registers.values[usize::from(self.map.numbers[i])]
    }

    /// Evaluates the rates. Must be inlined into a kernel to have vector instructions.
    #[inline(always)]
    pub(super) fn evaluate(&mut self) {
        self.registers.run(&self.map, &self.list);
    }

    /// The numbers that move, and their rates at the last evaluation, in the order of the program's outputs.
    #[inline(always)]
    pub(super) fn moving(&mut self) -> (&mut [R], &[R]) {
        // the group that moves has the first registers
        let (numbers, others) = self.registers.values.split_at_mut(self.first);
        (&mut numbers[..self.count], &others[..self.count])
    }

    /// The rates of the last evaluation, in the order of the program's outputs.
    #[inline(always)]
    pub(super) fn rates(&self) -> &[R] {
        &self.registers.values[self.first..self.first + self.count]
    }
}
