//! The arithmetic of one precision as instructions.
//!
//! In: numbers of a precision. Out: instructions whose results have the bits of [`Analytic`](crate::num::Analytic) in that
//! precision. Never here: which numbers.

use super::basic_block::{BasicBlock, Operand, Operation, Value, Width};
use super::layout::{Address, Layout, SIDE};
use crate::num::{Analytic, DoubleDouble};

/// The code so far, and where its numbers lie.
#[derive(Debug)]
pub(super) struct Code {
    pub(super) block: BasicBlock,
    pub(super) layout: Layout,
}

impl Code {
    fn binary(&mut self, operation: Operation, width: Width, a: Operand, b: Operand) -> Operand {
        self.block.binary(operation, width, a, b).into()
    }

    fn constant(&mut self, number: f64) -> Operand {
        Operand::At(self.layout.constant(&[number]))
    }

    /// Stores four numbers side by side.
    fn side_by_side(&mut self, [a, b, c, d]: [Operand; SIDE], to: Address) {
        let low = self.binary(Operation::Pair, Width::Two, a, b);
        let high =
            if (a, b) == (c, d) { low } else { self.binary(Operation::Pair, Width::Two, c, d) };
        let four = self.binary(Operation::Join, Width::Four, low, high);
        self.block.store(Width::Four, four, to, true);
    }

    fn four(&mut self, at: Address) -> Value {
        self.block.load(Width::Four, at)
    }
}

/// A precision. Its quotients assume finite divisors.
pub(super) trait Arithmetic {
    /// A number.
    type Number: Copy;
    /// The number of `f64` of a number in memory.
    const SIZE: usize;

    /// What lies in memory.
    fn at(address: Address) -> Self::Number;
    /// A constant.
    fn constant(code: &mut Code, number: DoubleDouble) -> Self::Number;
    /// The sum.
    fn sum(code: &mut Code, a: Self::Number, b: Self::Number) -> Self::Number;
    /// The difference.
    fn difference(code: &mut Code, a: Self::Number, b: Self::Number) -> Self::Number;
    /// The product.
    fn product(code: &mut Code, a: Self::Number, b: Self::Number) -> Self::Number;
    /// The product with an `f64`.
    fn multiple(code: &mut Code, a: Self::Number, factor: Operand) -> Self::Number;
    /// The product with a power of two.
    fn scaled(code: &mut Code, a: Self::Number, power_of_two: Operand) -> Self::Number;
    /// The quotient.
    fn quotient(code: &mut Code, a: Self::Number, b: Self::Number) -> Self::Number;
    /// The quotient by an integer.
    fn over(code: &mut Code, a: Self::Number, n: usize) -> Self::Number;
    /// The opposite.
    fn opposite(code: &mut Code, a: Self::Number) -> Self::Number;
    /// Keeps a number at hand that is read more than once.
    fn held(code: &mut Code, a: Self::Number) -> Self::Number;
    /// Stores a number where nothing else is written.
    fn store(code: &mut Code, a: Self::Number, to: Address);
    /// The same where it is overwritten later.
    fn store_for_now(code: &mut Code, a: Self::Number, to: Address);
    /// Stores four numbers side by side.
    fn side_by_side(code: &mut Code, numbers: [Self::Number; SIDE], to: Address);
    /// The nearest `f64`.
    fn nearest(a: Self::Number) -> Operand;
    /// Stores four inner products `Σ a_j b_j` of so many terms, whose operands lie side by side.
    fn inner_products(code: &mut Code, operands: (Address, Address), terms: usize, to: Address);
    /// One of four inner products that were stored.
    fn inner_product(stored: Address, lane: usize) -> Self::Number;
    /// The number so many bytes behind an address as the integer at `offset` says.
    fn behind(code: &mut Code, from: Address, offset: Address) -> Self::Number;
}

/// `f64`.
#[derive(Debug)]
pub(super) struct Plain;

impl Arithmetic for Plain {
    type Number = Operand;
    const SIZE: usize = 1;

    fn at(address: Address) -> Operand {
        Operand::At(address)
    }

    fn constant(code: &mut Code, number: DoubleDouble) -> Operand {
        code.constant(number.high)
    }

    fn sum(code: &mut Code, a: Operand, b: Operand) -> Operand {
        code.binary(Operation::Add, Width::One, a, b)
    }

    fn difference(code: &mut Code, a: Operand, b: Operand) -> Operand {
        code.binary(Operation::Subtract, Width::One, a, b)
    }

    fn product(code: &mut Code, a: Operand, b: Operand) -> Operand {
        code.binary(Operation::Multiply, Width::One, a, b)
    }

    fn multiple(code: &mut Code, a: Operand, factor: Operand) -> Operand {
        Plain::product(code, a, factor)
    }

    fn scaled(code: &mut Code, a: Operand, power_of_two: Operand) -> Operand {
        Plain::product(code, a, power_of_two)
    }

    fn quotient(code: &mut Code, a: Operand, b: Operand) -> Operand {
        code.binary(Operation::Divide, Width::One, a, b)
    }

    fn over(code: &mut Code, a: Operand, n: usize) -> Operand {
        if n == 1 {
            return a;
        }
        let n = code.constant(n as f64);
        Plain::quotient(code, a, n)
    }

    fn opposite(code: &mut Code, a: Operand) -> Operand {
        let sign = Operand::At(code.layout.constant(&[-0.0; 2]));
        code.binary(Operation::Xor, Width::Two, a, sign)
    }

    fn held(code: &mut Code, a: Operand) -> Operand {
        code.block.made(Width::One, a).into()
    }

    fn store(code: &mut Code, a: Operand, to: Address) {
        code.block.store(Width::One, a, to, true);
    }

    fn store_for_now(code: &mut Code, a: Operand, to: Address) {
        code.block.store(Width::One, a, to, false);
    }

    fn side_by_side(code: &mut Code, numbers: [Operand; SIDE], to: Address) {
        code.side_by_side(numbers, to);
    }

    fn nearest(a: Operand) -> Operand {
        a
    }

    /// Four sums are kept apart, as in [`InnerProducts`](crate::num::Analytic::inner_products).
    fn inner_products(
        code: &mut Code,
        (left, right): (Address, Address),
        terms: usize,
        to: Address,
    ) {
        const APART: usize = 4;
        let product = |code: &mut Code, j: usize| {
            let a = code.four(left.plus(j * SIDE));
            let b = Operand::At(right.plus(j * SIDE));
            code.binary(Operation::Multiply, Width::Four, a.into(), b)
        };
        let add = |code: &mut Code, a, b| code.binary(Operation::Add, Width::Four, a, b);
        // the first and the last term come at the end
        let inner = 1..terms.max(2) - 1;
        let whole = inner.len() / APART * APART;
        let mut sums: [Option<Operand>; APART] = [None; APART];
        // is never −0, so that the whole is not
        let mut sum: Operand = code.block.zero().into();
        for (i, j) in inner.enumerate() {
            let product = product(code, j);
            if i < whole {
                let sum = &mut sums[i % APART];
                *sum = Some(sum.map_or(product, |sum| add(code, sum, product)));
            } else {
                sum = add(code, sum, product);
            }
        }
        if let [Some(a), Some(b), Some(c), Some(d)] = sums {
            let (even, odd) = (add(code, a, c), add(code, b, d));
            let apart = add(code, even, odd);
            sum = add(code, apart, sum);
        }
        if terms > 0 {
            let mut ends = product(code, 0);
            if terms > 1 {
                let last = product(code, terms - 1);
                ends = add(code, ends, last);
            }
            sum = add(code, sum, ends);
        }
        code.block.store(Width::Four, sum, to, false);
    }

    fn inner_product(stored: Address, lane: usize) -> Operand {
        Operand::At(stored.plus(lane))
    }

    fn behind(code: &mut Code, from: Address, offset: Address) -> Operand {
        code.block.load_behind(from, offset).into()
    }
}

/// Double-double: its high and its low part.
#[derive(Debug)]
pub(super) struct Double;

/// The two parts of a number, or of four side by side.
type Parts = (Operand, Operand);

impl Code {
    /// [`DoubleDouble::sum`].
    fn exact_sum(&mut self, width: Width, a: Operand, b: Operand) -> Parts {
        let high = self.binary(Operation::Add, width, a, b);
        let part = self.binary(Operation::Subtract, width, high, a);
        let a_part = self.binary(Operation::Subtract, width, high, part);
        let a_error = self.binary(Operation::Subtract, width, a, a_part);
        let b_error = self.binary(Operation::Subtract, width, b, part);
        (high, self.binary(Operation::Add, width, a_error, b_error))
    }

    /// The same for a difference.
    fn exact_difference(&mut self, a: Operand, b: Operand) -> Parts {
        let width = Width::One;
        let high = self.binary(Operation::Subtract, width, a, b);
        let part = self.binary(Operation::Subtract, width, high, a);
        let a_part = self.binary(Operation::Subtract, width, high, part);
        let a_error = self.binary(Operation::Subtract, width, a, a_part);
        let b_error = self.binary(Operation::Add, width, b, part);
        (high, self.binary(Operation::Subtract, width, a_error, b_error))
    }

    /// The same where the first is not smaller.
    fn ordered_sum(&mut self, a: Operand, b: Operand) -> Parts {
        let high = self.binary(Operation::Add, Width::One, a, b);
        let part = self.binary(Operation::Subtract, Width::One, high, a);
        (high, self.binary(Operation::Subtract, Width::One, b, part))
    }

    /// The product and its rounding error.
    fn exact_product(&mut self, width: Width, a: Operand, b: Operand) -> Parts {
        let (a, b) = (self.block.made(width, a), self.block.made(width, b));
        let high = self.block.binary(Operation::Multiply, width, a.into(), b.into());
        let low = self.block.product_error(width, (a, b), high);
        (high.into(), low.into())
    }

    /// The sum of two numbers from the sums of their parts.
    fn renormalized(&mut self, highs: Parts, lows: Parts) -> Parts {
        let low = Plain::sum(self, highs.1, lows.0);
        let (high, low) = self.ordered_sum(highs.0, low);
        let low = Plain::sum(self, lows.1, low);
        self.ordered_sum(high, low)
    }
}

impl Arithmetic for Double {
    type Number = Parts;
    const SIZE: usize = 2;

    fn at(address: Address) -> Parts {
        (Operand::At(address), Operand::At(address.plus(1)))
    }

    fn constant(code: &mut Code, number: DoubleDouble) -> Parts {
        Double::at(code.layout.constant(&[number.high, number.low]))
    }

    fn sum(code: &mut Code, a: Parts, b: Parts) -> Parts {
        let (a, b) = (Double::held(code, a), Double::held(code, b));
        let highs = code.exact_sum(Width::One, a.0, b.0);
        let lows = code.exact_sum(Width::One, a.1, b.1);
        code.renormalized(highs, lows)
    }

    fn difference(code: &mut Code, a: Parts, b: Parts) -> Parts {
        let (a, b) = (Double::held(code, a), Double::held(code, b));
        let highs = code.exact_difference(a.0, b.0);
        let lows = code.exact_difference(a.1, b.1);
        code.renormalized(highs, lows)
    }

    fn product(code: &mut Code, a: Parts, b: Parts) -> Parts {
        let (a, b) = (Double::held(code, a), Double::held(code, b));
        let (high, low) = code.exact_product(Width::One, a.0, b.0);
        let (first, second) = (Plain::product(code, a.0, b.1), Plain::product(code, a.1, b.0));
        let mixed = Plain::sum(code, first, second);
        let low = Plain::sum(code, low, mixed);
        code.ordered_sum(high, low)
    }

    fn multiple(code: &mut Code, a: Parts, factor: Operand) -> Parts {
        let (high, low) = code.exact_product(Width::One, a.0, factor);
        let mixed = Plain::product(code, a.1, factor);
        let low = Plain::sum(code, low, mixed);
        code.ordered_sum(high, low)
    }

    fn scaled(code: &mut Code, a: Parts, power_of_two: Operand) -> Parts {
        (Plain::product(code, a.0, power_of_two), Plain::product(code, a.1, power_of_two))
    }

    fn quotient(code: &mut Code, a: Parts, b: Parts) -> Parts {
        let (a, b) = (Double::held(code, a), Double::held(code, b));
        let first = Plain::quotient(code, a.0, b.0);
        let part = Double::multiple(code, b, first);
        let rest = Double::difference(code, a, part);
        let second = Plain::quotient(code, rest.0, b.0);
        let part = Double::multiple(code, b, second);
        let rest = Double::difference(code, rest, part);
        let third = Plain::quotient(code, rest.0, b.0);
        let (high, low) = code.ordered_sum(first, second);
        let low = Plain::sum(code, low, third);
        code.ordered_sum(high, low)
    }

    fn over(code: &mut Code, a: Parts, n: usize) -> Parts {
        let inverse = Double::constant(code, DoubleDouble::ONE.over::<false>(n));
        Double::product(code, a, inverse)
    }

    fn opposite(code: &mut Code, a: Parts) -> Parts {
        (Plain::opposite(code, a.0), Plain::opposite(code, a.1))
    }

    fn held(code: &mut Code, a: Parts) -> Parts {
        (Plain::held(code, a.0), Plain::held(code, a.1))
    }

    fn store(code: &mut Code, a: Parts, to: Address) {
        Plain::store(code, a.0, to);
        Plain::store(code, a.1, to.plus(1));
    }

    fn store_for_now(code: &mut Code, a: Parts, to: Address) {
        Plain::store_for_now(code, a.0, to);
        Plain::store_for_now(code, a.1, to.plus(1));
    }

    fn side_by_side(code: &mut Code, numbers: [Parts; SIDE], to: Address) {
        code.side_by_side(numbers.map(|parts| parts.0), to);
        code.side_by_side(numbers.map(|parts| parts.1), to.plus(SIDE));
    }

    fn nearest(a: Parts) -> Operand {
        a.0
    }

    fn inner_products(
        code: &mut Code,
        (left, right): (Address, Address),
        terms: usize,
        to: Address,
    ) {
        let four = Width::Four;
        let mut sum: Operand = code.block.zero().into();
        let mut errors = sum;
        let ends = (0..terms.min(1)).chain(terms.max(2) - 1..terms);
        for j in (1..terms.max(2) - 1).chain(ends) {
            let [a_high, a_low, b_high, b_low] = [(left, 0), (left, 1), (right, 0), (right, 1)]
                .map(|(series, part)| code.four(series.plus((2 * j + part) * SIDE)).into());
            let (product, error) = code.exact_product(four, a_high, b_high);
            let (next, lost) = code.exact_sum(four, sum, product);
            let first = code.binary(Operation::Multiply, four, a_high, b_low);
            let second = code.binary(Operation::Multiply, four, a_low, b_high);
            let mixed = code.binary(Operation::Add, four, first, second);
            let low = code.binary(Operation::Add, four, error, mixed);
            let low = code.binary(Operation::Add, four, lost, low);
            errors = code.binary(Operation::Add, four, errors, low);
            sum = next;
        }
        let (high, low) = code.exact_sum(four, sum, errors);
        code.block.store(four, high, to, false);
        code.block.store(four, low, to.plus(SIDE), false);
    }

    fn inner_product(stored: Address, lane: usize) -> Parts {
        (Operand::At(stored.plus(lane)), Operand::At(stored.plus(SIDE + lane)))
    }

    fn behind(code: &mut Code, from: Address, offset: Address) -> Parts {
        (
            code.block.load_behind(from, offset).into(),
            code.block.load_behind(from.plus(1), offset).into(),
        )
    }
}
