//! Runs the instructions of a [`StageList`] on the numbers of one orbit, or of several at once.
//!
//! In: instructions, registers. Out: registers after many steps, with the bits that single steps
//! give. Never here: which steps, numbers that leave the range of `f64`.

use super::program::Register;
use super::stage_list::{CHUNK, Half, Instruction, Moved, REGISTERS, StageList, Sum};
use super::value::value_of;
use crate::num::{Analytic, Batch, Kernel};

/// A number that is moved with compensated sums.
pub(super) trait StageNumber: Analytic {
    /// Whether a whole [`CHUNK`] of numbers costs as much as one of them.
    const BY_CHUNKS: bool;

    /// `moved`, or `unmoved` where a rate is zero, so that the sign of a zero stays.
    fn where_moving(self, moved: Self, unmoved: Self) -> Self;
}

impl StageNumber for f64 {
    const BY_CHUNKS: bool = true;

    #[inline(always)]
    fn where_moving(self, moved: f64, unmoved: f64) -> f64 {
        if self == 0.0 { unmoved } else { moved }
    }
}

impl StageNumber for Batch {
    const BY_CHUNKS: bool = false;

    #[inline(always)]
    fn where_moving(self, moved: Batch, unmoved: Batch) -> Batch {
        self.where_equal(0.0, unmoved, moved)
    }
}

/// The registers of a list: numbers of the state, rates, results of operations.
#[derive(Clone, Debug)]
pub(super) struct Registers<R> {
    pub(super) values: Box<[R; REGISTERS]>,
    /// What rounding cut off from the numbers of the state.
    pub(super) carries: Box<[R; REGISTERS]>,
    /// The factors of the sums.
    pub(super) factors: Box<[R; REGISTERS]>,
}

impl<R: StageNumber> Registers<R> {
    pub(super) fn new() -> Registers<R> {
        let zeros = || Box::new([R::ZERO; REGISTERS]);
        Registers { values: zeros(), carries: zeros(), factors: zeros() }
    }

    #[inline(always)]
    fn run(&mut self, stages: &StageList, list: &[Instruction]) {
        let at = usize::from;
        for instruction in list {
            match *instruction {
                Instruction::Sum1 { sum, to } => {
                    self.values[at(to)] = self.first_terms::<1>(&stages.sums[at(sum)]);
                }
                Instruction::Sum2 { sum, to } => {
                    self.values[at(to)] = self.first_terms::<2>(&stages.sums[at(sum)]);
                }
                Instruction::Sum3 { sum, to } => {
                    self.values[at(to)] = self.first_terms::<3>(&stages.sums[at(sum)]);
                }
                Instruction::Sum { sum, to } => {
                    let terms = &stages.sums[at(sum)];
                    let mut sum = self.first_terms::<3>(terms);
                    for &(coefficient, r) in &terms.further {
                        sum = sum + self.values[at(r)] * coefficient;
                    }
                    self.values[at(to)] = sum;
                }
                Instruction::Multiply { a, b, to } => {
                    self.values[at(to)] = self.values[at(a)] * self.values[at(b)];
                }
                Instruction::Divide { a, b, to } => {
                    self.values[at(to)] = self.values[at(a)] / self.values[at(b)];
                }
                Instruction::Root { a, to } => self.values[at(to)] = self.values[at(a)].sqrt(),
                Instruction::Copy { a, to } => self.values[at(to)] = self.values[at(a)],
                Instruction::Other { half, operation, to } => {
                    self.other(stages, half, operation, to);
                }
                Instruction::Move { factor, moved } => self.add(self.factors[at(factor)], moved),
                Instruction::MoveTwice { factors: [last, first], moved } => {
                    self.add(self.factors[at(last)], moved);
                    self.add(self.factors[at(first)], moved);
                }
            }
        }
    }

    #[inline(always)]
    fn first_terms<const COUNT: usize>(&self, sum: &Sum) -> R {
        let mut value = R::of(sum.constant.into());
        for k in 0..COUNT {
            value = value + self.values[usize::from(sum.registers[k])] * sum.coefficients[k];
        }
        value
    }

    /// Adds multiples of rates to numbers, with compensated sums: what
    /// [`accumulate`](crate::num::accumulate) does with each.
    #[inline(always)]
    fn add(&mut self, factor: R, Moved { number, rate, count }: Moved) {
        let (number, rate, count) = (usize::from(number), usize::from(rate), usize::from(count));
        if !R::BY_CHUNKS {
            for k in 0..count {
                let (n, r) = ((number + k) % REGISTERS, (rate + k) % REGISTERS);
                let (value, carry) = (self.values[n], self.carries[n]);
                (self.values[n], self.carries[n]) =
                    accumulated(value, carry, factor, self.values[r]);
            }
            return;
        }
        for k in 0..count.div_ceil(CHUNK) {
            const CHUNKS: usize = REGISTERS / CHUNK;
            let (n, r) = ((number / CHUNK + k) % CHUNKS, (rate / CHUNK + k) % CHUNKS);
            let (values, _) = self.values.as_chunks_mut::<CHUNK>();
            let (carries, _) = self.carries.as_chunks_mut::<CHUNK>();
            let rates = values[r];
            let (mut moved, mut left) = (values[n], carries[n]);
            for i in 0..CHUNK {
                (moved[i], left[i]) = accumulated(moved[i], left[i], factor, rates[i]);
            }
            (values[n], carries[n]) = (moved, left);
        }
    }

    #[inline(never)]
    fn other(&mut self, stages: &StageList, half: Half, operation: Register, to: u8) {
        let (program, places) = stages.half(half);
        let get = |r: Register| self.values[usize::from(places[r as usize])];
        let op = program.ops[operation as usize];
        if let Some((value, companion)) = value_of(program, op, get) {
            self.values[usize::from(to)] = value;
            if let Some(companion) = companion {
                self.values[usize::from(to) + 1] = companion;
            }
        }
    }
}

/// `factor · rate` added to a number of two parts.
#[inline(always)]
fn accumulated<R: StageNumber>(value: R, carry: R, factor: R, rate: R) -> (R, R) {
    let by = factor * rate;
    let sum = value + by;
    let part = sum - value;
    let error = (value - (sum - part)) + (by - part);
    let low = error + carry;
    let moved = sum + low;
    (rate.where_moving(moved, value), rate.where_moving(low - (moved - sum), carry))
}

/// Many steps. `seen` is handed the count of steps so far and the registers at the end of each step
/// from `from` on.
pub(super) struct Steps<'a, R, F> {
    pub(super) registers: &'a mut Registers<R>,
    pub(super) stages: &'a StageList,
    pub(super) count: u64,
    pub(super) from: u64,
    pub(super) seen: F,
}

impl<R: StageNumber, F: FnMut(u64, &Registers<R>)> Kernel for Steps<'_, R, F> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(mut self) {
        let (stages, from) = (self.stages, self.from.min(self.count));
        let (mut done, mut list, mut ends) = (0, &stages.open, false);
        loop {
            self.registers.run(stages, list);
            if ends {
                (self.seen)(done, self.registers);
                if done == self.count {
                    return;
                }
                (list, ends) = (&stages.lead, false);
                continue;
            }
            done += 1;
            ends = done >= from;
            list = if ends { &stages.end } else { &stages.step };
        }
    }
}
