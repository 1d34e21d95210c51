//! The arithmetic of one precision as instructions.
//!
//! In: numbers of a precision. Out: instructions whose results have the bits of [`Analytic`](crate::num::Analytic) in that
//! precision. Never here: which numbers.

use super::basic_block::{
    BasicBlock, InnerProductOperands, Operand, Operation, VirtualRegister, Width,
};
use super::layout::{Address, MemoryLayout};
use super::reciprocal::Reciprocal;
use crate::num::DoubleDouble;

/// The code so far, and where its numbers lie.
#[derive(Debug)]
pub(super) struct Code {
    pub(super) block: BasicBlock,
    pub(super) layout: MemoryLayout,
    /// The width of the numbers of several orbits.
    pub(super) lanes: Width,
    /// The unit of time over the last order.
    unit_over_order: Option<(usize, ReciprocalOperands)>,
}

/// What a number is multiplied by for a quotient by an integer: a [`Reciprocal`], whose low part has the other sign.
#[derive(Clone, Copy, Debug)]
struct ReciprocalOperands {
    high: Operand,
    less: Option<Operand>,
}

impl Code {
    /// None yet.
    pub(super) fn new(lanes: Width) -> Code {
        Code {
            block: BasicBlock::default(),
            layout: MemoryLayout::new(),
            lanes,
            unit_over_order: None,
        }
    }

    /// The quotient of `f64` by an integer. The constants are those of one orbit or of several.
    pub(super) fn quotient(
        &mut self,
        a: Operand,
        n: usize,
        constant: impl Fn(&mut Code, f64) -> Operand,
    ) -> Operand {
        let Reciprocal { high, low } = Reciprocal::of(n);
        let high = constant(self, high);
        let less = low.map(|low| constant(self, -low));
        self.times(a, ReciprocalOperands { high, less })
    }

    /// The quotient of `f64` by an order over the unit of time, a power of two.
    pub(super) fn integral(
        &mut self,
        a: Operand,
        n: usize,
        constant: impl Fn(&mut Code, f64) -> Operand,
    ) -> Operand {
        let factor = match self.unit_over_order {
            Some((order, factor)) if order == n => factor,
            _ => {
                let Reciprocal { high, low } = Reciprocal::of(n);
                let mut part = |part| {
                    let (unit, part) = (Operand::At(self.layout.scale), constant(self, part));
                    self.binary(Operation::Multiply, self.lanes, unit, part)
                };
                let high = part(high);
                ReciprocalOperands { high, less: low.map(|low| part(-low)) }
            }
        };
        self.unit_over_order = Some((n, factor));
        self.times(a, factor)
    }

    fn times(
        &mut self,
        a: Operand,
        ReciprocalOperands { high, less }: ReciprocalOperands,
    ) -> Operand {
        let Some(less) = less else {
            return self.binary(Operation::Multiply, self.lanes, a, high);
        };
        let a = self.block.made(self.lanes, a);
        let less = self.binary(Operation::Multiply, self.lanes, a.into(), less);
        let (high, less) = (self.block.made(self.lanes, high), self.block.made(self.lanes, less));
        self.block.product_error(self.lanes, (a, high), less).into()
    }

    pub(super) fn binary(
        &mut self,
        operation: Operation,
        width: Width,
        a: Operand,
        b: Operand,
    ) -> Operand {
        self.block.binary(operation, width, a, b).into()
    }

    pub(super) fn constant(&mut self, number: f64) -> Operand {
        Operand::At(self.layout.constant(&[number]))
    }

    /// Stores four numbers side by side.
    pub(super) fn side_by_side(&mut self, numbers: [Operand; SIDE], to: Address) {
        let [a, b, c, d] = numbers;
        let low = self.binary(Operation::Pair, Width::Two, a, b);
        let high =
            if (a, b) == (c, d) { low } else { self.binary(Operation::Pair, Width::Two, c, d) };
        let four = self.binary(Operation::Join, Width::Four, low, high);
        self.block.store(Width::Four, four, to, true);
    }

    pub(super) fn four(&mut self, at: Address) -> VirtualRegister {
        self.block.load(Width::Four, at)
    }

    /// Inner products `Σ a_j b_j` of several lanes, whose operands lie side by side with so many `f64` from one to the
    /// next. Four sums are kept apart, as in [`Analytic::inner_products`](crate::num::Analytic::inner_products).
    pub(super) fn inner_products(
        &mut self,
        (width, distance): (Width, usize),
        (left, right): (Address, Address),
        terms: usize,
    ) -> Operand {
        if terms >= LOOPED {
            let products = InnerProductOperands { width, left, right, distance, terms };
            return self.block.inner_products(products).into();
        }
        let product = |code: &mut Code, j: usize| {
            let a = code.block.load(width, left.plus(j * distance));
            let b = Operand::At(right.plus(j * distance));
            code.binary(Operation::Multiply, width, a.into(), b)
        };
        let add = |code: &mut Code, a, b| code.binary(Operation::Add, width, a, b);
        let whole = terms / APART * APART;
        let mut sums: [Option<Operand>; APART] = [None; APART];
        // is never −0, so that the whole is not
        let mut sum: Operand = self.block.zero(width).into();
        for j in 0..terms {
            let product = product(self, j);
            if j < whole {
                let sum = &mut sums[j % APART];
                *sum = Some(sum.map_or(product, |sum| add(self, sum, product)));
            } else {
                sum = add(self, sum, product);
            }
        }
        if let [Some(a), Some(b), Some(c), Some(d)] = sums {
            let (even, odd) = (add(self, a, c), add(self, b, d));
            let apart = add(self, even, odd);
            sum = add(self, apart, sum);
        }
        sum
    }

    /// One of four numbers side by side.
    pub(super) fn lane(&mut self, four: Operand, lane: usize) -> Operand {
        let half =
            if lane < 2 { four } else { self.binary(Operation::Upper, Width::Four, four, four) };
        if lane.is_multiple_of(2) {
            half
        } else {
            self.binary(Operation::Odd, Width::Two, half, half)
        }
    }
}

/// From so many terms on inner products are a loop. Written out, they would be most of the code, which is read from memory at
/// every step where it is more than a core's first-level cache holds.
const LOOPED: usize = 12;

/// The number of sums of an inner product that are kept apart.
pub(super) const APART: usize = 4;

/// The number of inner products of one orbit side by side.
pub(super) const SIDE: usize = 4;

pub(super) fn four_of<T: Copy>(numbers: &[T]) -> [T; SIDE] {
    std::array::from_fn(|lane| numbers[lane])
}

/// A precision. Its quotients assume divisors that have reciprocals.
pub(super) trait Arithmetic {
    type Number: Copy;
    /// The number of `f64` of a number in memory.
    const SIZE: usize;
    /// The number of inner products side by side.
    const SIDE: usize;

    /// What lies in memory.
    fn at(address: Address) -> Self::Number;
    fn constant(code: &mut Code, number: DoubleDouble) -> Self::Number;
    /// A sum that is not [renormalized](crate::num::Analytic::renormalized), as differences, products and multiples are not either.
    fn sum(code: &mut Code, a: Self::Number, b: Self::Number) -> Self::Number;
    fn difference(code: &mut Code, a: Self::Number, b: Self::Number) -> Self::Number;
    fn product(code: &mut Code, a: Self::Number, b: Self::Number) -> Self::Number;
    /// [`Analytic::renormalized`](crate::num::Analytic::renormalized).
    fn renormalized(code: &mut Code, a: Self::Number) -> Self::Number;
    /// An integer multiple.
    fn multiple(code: &mut Code, a: Self::Number, n: usize) -> Self::Number;
    /// The product with a unit of time, a power of two.
    fn scaled(code: &mut Code, a: Self::Number, power_of_two: Operand) -> Self::Number;
    /// What [`Arithmetic::over_shared`] is given for a divisor: its reciprocal where that is multiplied by.
    fn shared(code: &mut Code, divisor: Self::Number) -> Self::Number;
    /// [`Analytic::divided_by_shared`](crate::num::Analytic::divided_by_shared).
    fn over_shared(code: &mut Code, a: Self::Number, shared: Self::Number) -> Self::Number;
    fn times(code: &mut Code, a: Self::Number, factor: DoubleDouble) -> Self::Number {
        let factor = Self::constant(code, factor);
        Self::product(code, a, factor)
    }
    fn twice(code: &mut Code, a: Self::Number) -> Self::Number {
        Self::sum(code, a, a)
    }
    /// [`Analytic::integrated`](crate::num::Analytic::integrated).
    fn integrated(code: &mut Code, a: Self::Number, n: usize) -> Self::Number {
        let unit = Operand::At(code.layout.scale);
        let scaled = Self::scaled(code, a, unit);
        let integrated = Self::over(code, scaled, n);
        Self::renormalized(code, integrated)
    }
    /// The quotient by an integer.
    fn over(code: &mut Code, a: Self::Number, n: usize) -> Self::Number;
    fn opposite(code: &mut Code, a: Self::Number) -> Self::Number;
    /// Keeps a number at hand that is read more than once.
    fn in_register(code: &mut Code, a: Self::Number) -> Self::Number;
    /// Stores a number where nothing else is written.
    fn store(code: &mut Code, a: Self::Number, to: Address);
    /// The same where it is overwritten later.
    fn store_for_now(code: &mut Code, a: Self::Number, to: Address);
    /// Stores [`Arithmetic::SIDE`] numbers side by side.
    fn side_by_side(code: &mut Code, numbers: &[Self::Number], to: Address);
    /// The nearest `f64`.
    fn nearest(a: Self::Number) -> Operand;
    /// [`Arithmetic::SIDE`] inner products `Σ a_j b_j` of so many terms, whose operands lie side by side.
    fn inner_products(code: &mut Code, operands: (Address, Address), terms: usize) -> Self::Number;
    /// Stores such inner products where they are overwritten later.
    fn store_inner_products(code: &mut Code, products: Self::Number, to: Address);
    fn inner_product(stored: Address, lane: usize) -> Self::Number;
    /// One of those that were not.
    fn lane(code: &mut Code, products: Self::Number, lane: usize) -> Self::Number;
    /// The number of one orbit so many bytes behind an address as the integer at `offset` says.
    fn behind(code: &mut Code, from: Address, offset: Address) -> Self::Number;
}
