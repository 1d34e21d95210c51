//! The registers of a list of instructions, for the numbers of one orbit or of several at once.
//!
//! In: instructions, registers. Out: registers after many steps, with the bits that single steps
//! give. Never here: which steps, numbers that leave the range of `f64`.

use super::instruction::{CHUNK, Instruction, Moved, REGISTERS};
use super::operation::value_of;
use super::program::Register;
use super::register_map::RegisterMap;
use super::solve::Factored;
use crate::num::{Analytic, Batch};

/// A number that is moved with compensated sums.
pub(super) trait StageNumber: Analytic {
    /// Whether a whole [`CHUNK`] of numbers costs as much as one of them.
    const BY_CHUNKS: bool;

    /// The numbers side by side.
    fn lanes(&mut self) -> &mut [f64];

    /// `moved`, or `unmoved` where a rate is zero, so that the sign of a zero stays.
    fn where_moving(self, moved: Self, unmoved: Self) -> Self;
}

impl StageNumber for f64 {
    const BY_CHUNKS: bool = true;

    #[inline(always)]
    fn lanes(&mut self) -> &mut [f64] {
        std::slice::from_mut(self)
    }

    #[inline(always)]
    fn where_moving(self, moved: f64, unmoved: f64) -> f64 {
        if self == 0.0 { unmoved } else { moved }
    }
}

impl<const N: usize> StageNumber for Batch<N> {
    const BY_CHUNKS: bool = false;

    #[inline(always)]
    fn lanes(&mut self) -> &mut [f64] {
        &mut self.0
    }

    #[inline(always)]
    fn where_moving(self, moved: Batch<N>, unmoved: Batch<N>) -> Batch<N> {
        self.where_equal(0.0, unmoved, moved)
    }
}

/// The registers of a list: numbers of the state, rates, results of operations.
#[derive(Clone, Debug)]
pub(super) struct Registers<R> {
    pub(super) values: Box<[R; REGISTERS]>,
    /// What rounding cut off from the numbers of the state.
    pub(super) carries: Box<[R; REGISTERS]>,
    pub(super) factors: Box<[R; REGISTERS]>,
    /// The blocks of equations, and room for the unknowns of one.
    factored: Vec<Factored<f64>>,
    unknowns: Vec<f64>,
    /// The number of lanes that differ; the others are copies of the first.
    pub(super) used: usize,
}

impl<R: StageNumber> Registers<R> {
    pub(super) fn of(map: &RegisterMap) -> Registers<R> {
        let zeros = || Box::new([R::ZERO; REGISTERS]);
        let mut zero = R::ZERO;
        let sizes = || map.blocks.iter().map(|block| block.right.len());
        let mut registers = Registers {
            values: zeros(),
            carries: zeros(),
            factors: zeros(),
            factored: sizes().map(Factored::new).collect(),
            unknowns: vec![0.0; sizes().max().unwrap_or(0)],
            used: zero.lanes().len(),
        };
        registers.values[usize::from(map.one)] = R::ONE;
        registers
    }

    #[inline(always)]
    pub(super) fn run(&mut self, map: &RegisterMap, list: &[Instruction]) {
        let at = usize::from;
        for instruction in list {
            match *instruction {
                Instruction::Sum1 { sum, to } => self.sum::<1, false>(map, sum, to),
                Instruction::Sum2 { sum, to } => self.sum::<2, false>(map, sum, to),
                Instruction::Sum3 { sum, to } => self.sum::<3, false>(map, sum, to),
                Instruction::Products1 { sum, to } => self.sum::<1, true>(map, sum, to),
                Instruction::Products2 { sum, to } => self.sum::<2, true>(map, sum, to),
                Instruction::Products3 { sum, to } => self.sum::<3, true>(map, sum, to),
                Instruction::Sum { sum, to } => {
                    self.sum::<3, true>(map, sum, to);
                    let mut value = self.values[at(to)];
                    for &(coefficient, [a, b]) in &map.sums[at(sum)].further {
                        value = value + self.values[at(a)] * self.values[at(b)] * coefficient;
                    }
                    self.values[at(to)] = value;
                }
                Instruction::Multiply { a, b, to } => {
                    self.values[at(to)] = self.values[at(a)] * self.values[at(b)];
                }
                Instruction::Divide { a, b, to } => {
                    self.values[at(to)] = self.values[at(a)] / self.values[at(b)];
                }
                Instruction::Solve { block, to } => self.solve(map, block, to),
                Instruction::Root { a, to } => self.values[at(to)] = self.values[at(a)].sqrt(),
                Instruction::Copy { a, to } => self.values[at(to)] = self.values[at(a)],
                Instruction::Other { program, operation, to } => {
                    self.other(map, program, operation, to);
                }
                Instruction::Move { factor, moved } => {
                    self.add([self.factors[at(factor)]], moved);
                }
                Instruction::MoveTwice { factors, moved } => {
                    self.add(factors.map(|factor| self.factors[at(factor)]), moved);
                }
            }
        }
    }

    /// Sets a register to the first terms of a sum.
    #[inline(always)]
    fn sum<const COUNT: usize, const PRODUCTS: bool>(
        &mut self,
        map: &RegisterMap,
        sum: u8,
        to: u8,
    ) {
        let sum = &map.sums[usize::from(sum)];
        let mut value = R::of(sum.constant.into());
        for k in 0..COUNT {
            // a combinator of arrays may not be inlined
            let [a, b] = sum.registers[k];
            let (a, b) = (usize::from(a), usize::from(b));
            let term = if PRODUCTS { self.values[a] * self.values[b] } else { self.values[a] };
            value = value + term * sum.coefficients[k];
        }
        self.values[usize::from(to)] = value;
    }

    /// Adds multiples of rates to numbers, one after the other, with compensated sums: what
    /// [`accumulate`](crate::num::accumulate) does with each.
    #[inline(always)]
    fn add<const TIMES: usize>(&mut self, factors: [R; TIMES], moved: Moved) {
        let Moved { number, rate, count } = moved;
        let (number, rate, count) = (usize::from(number), usize::from(rate), usize::from(count));
        if !R::BY_CHUNKS {
            for k in 0..count {
                let (n, r) = ((number + k) % REGISTERS, (rate + k) % REGISTERS);
                let (mut value, mut carry, rate) =
                    (self.values[n], self.carries[n], self.values[r]);
                for factor in factors {
                    (value, carry) = accumulated(value, carry, factor, rate);
                }
                (self.values[n], self.carries[n]) = (value, carry);
            }
        } else if moved.is_short() {
            self.add_chunk(factors, number / CHUNK, rate / CHUNK);
        } else {
            for k in 0..count.div_ceil(CHUNK) {
                self.add_chunk(factors, number / CHUNK + k, rate / CHUNK + k);
            }
        }
    }

    #[inline(always)]
    fn add_chunk<const TIMES: usize>(&mut self, factors: [R; TIMES], number: usize, rate: usize) {
        const CHUNKS: usize = REGISTERS / CHUNK;
        let (n, r) = (number % CHUNKS, rate % CHUNKS);
        let (values, _) = self.values.as_chunks_mut::<CHUNK>();
        let (carries, _) = self.carries.as_chunks_mut::<CHUNK>();
        let (rates, mut moved, mut left) = (values[r], values[n], carries[n]);
        for factor in factors {
            for i in 0..CHUNK {
                (moved[i], left[i]) = accumulated(moved[i], left[i], factor, rates[i]);
            }
        }
        (values[n], carries[n]) = (moved, left);
    }

    /// Solves a block of equations in each lane; the unknowns are NaN where it is singular.
    #[inline(never)]
    fn solve(&mut self, map: &RegisterMap, block: u8, to: u8) {
        let at = usize::from;
        let Registers { values, factored, unknowns, used, .. } = self;
        let (places, factored) = (&map.blocks[at(block)], &mut factored[at(block)]);
        let n = places.right.len();
        for lane in 0..*used {
            let mut get = |place: u8| values[at(place)].lanes()[lane];
            if factored.factor(|i, j| get(places.matrix[i * n + j])) {
                for (x, &place) in unknowns.iter_mut().zip(&places.right) {
                    *x = get(place);
                }
                factored.solve(&mut unknowns[..n]);
            } else {
                unknowns.fill(f64::NAN);
            }
            for (x, unknown) in values[at(to)..].iter_mut().zip(&unknowns[..n]) {
                let lanes = x.lanes();
                lanes[lane] = *unknown;
                if lane == 0 {
                    lanes[*used..].fill(*unknown);
                }
            }
        }
    }

    #[inline(never)]
    fn other(&mut self, map: &RegisterMap, program: u8, operation: Register, to: u8) {
        let (program, places) = map.program(program);
        let get = |r: Register| self.values[usize::from(places[r as usize])];
        let op = program.ops[operation as usize];
        if let Some((value, companion)) = value_of::<_, false>(program, op, get) {
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
