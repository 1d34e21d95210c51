//! The arithmetic of double-double as instructions.
//!
//! In: numbers of two parts. Out: instructions whose results have the bits of [`DoubleDouble`], but for the sign of a low part
//! that is zero. Never here: which numbers.

use super::arithmetic::{Arithmetic, Code, SIDE, four_of};
use super::basic_block::{Operand, Operation, Width};
use super::layout::Address;
use super::plain::Plain;
use crate::num::{Analytic, DoubleDouble};

/// Double-double: its high and its low part.
#[derive(Debug)]
pub(super) struct Double;

/// The two parts of a number, or of four side by side.
type DoubleOperand = (Operand, Operand);

impl Code {
    /// [`DoubleDouble::sum`].
    fn exact_sum(&mut self, width: Width, a: Operand, b: Operand) -> DoubleOperand {
        let high = self.binary(Operation::Add, width, a, b);
        let part = self.binary(Operation::Subtract, width, high, a);
        let a_part = self.binary(Operation::Subtract, width, high, part);
        let a_error = self.binary(Operation::Subtract, width, a, a_part);
        let b_error = self.binary(Operation::Subtract, width, b, part);
        (high, self.binary(Operation::Add, width, a_error, b_error))
    }

    fn exact_difference(&mut self, a: Operand, b: Operand) -> DoubleOperand {
        let width = Width::One;
        let high = self.binary(Operation::Subtract, width, a, b);
        let part = self.binary(Operation::Subtract, width, high, a);
        let a_part = self.binary(Operation::Subtract, width, high, part);
        let a_error = self.binary(Operation::Subtract, width, a, a_part);
        let b_error = self.binary(Operation::Add, width, b, part);
        (high, self.binary(Operation::Subtract, width, a_error, b_error))
    }

    /// The same where the first is not smaller.
    fn ordered_sum(&mut self, a: Operand, b: Operand) -> DoubleOperand {
        let high = self.binary(Operation::Add, Width::One, a, b);
        let part = self.binary(Operation::Subtract, Width::One, high, a);
        (high, self.binary(Operation::Subtract, Width::One, b, part))
    }

    /// The product and its rounding error.
    fn exact_product(&mut self, width: Width, a: Operand, b: Operand) -> DoubleOperand {
        let (a, b) = (self.block.made(width, a), self.block.made(width, b));
        let high = self.block.binary(Operation::Multiply, width, a.into(), b.into());
        let low = self.block.product_error(width, (a, b), high);
        (high.into(), low.into())
    }

    /// The product with an `f64`, not renormalized.
    fn multiple(&mut self, a: DoubleOperand, factor: Operand) -> DoubleOperand {
        let a = Double::in_register(self, a);
        let mixed = Plain::product(self, a.1, factor);
        let (high, low) = self.exact_product(Width::One, a.0, factor);
        (high, Plain::sum(self, low, mixed))
    }

    fn exact_multiple(&mut self, a: DoubleOperand, factor: Operand) -> DoubleOperand {
        let (high, low) = self.multiple(a, factor);
        self.ordered_sum(high, low)
    }

    /// The difference of two numbers, with no error but that of its last digits.
    fn accurate_difference(&mut self, a: DoubleOperand, b: DoubleOperand) -> DoubleOperand {
        let (a, b) = (Double::in_register(self, a), Double::in_register(self, b));
        let highs = self.exact_difference(a.0, b.0);
        let lows = self.exact_difference(a.1, b.1);
        let low = Plain::sum(self, highs.1, lows.0);
        let (high, low) = self.ordered_sum(highs.0, low);
        let low = Plain::sum(self, lows.1, low);
        self.ordered_sum(high, low)
    }

    fn exact_quotient(&mut self, a: DoubleOperand, b: DoubleOperand) -> DoubleOperand {
        let (a, b) = (Double::in_register(self, a), Double::in_register(self, b));
        let first = Plain::over_shared(self, a.0, b.0);
        let part = self.exact_multiple(b, first);
        let rest = self.accurate_difference(a, part);
        let second = Plain::over_shared(self, rest.0, b.0);
        let part = self.exact_multiple(b, second);
        let rest = self.accurate_difference(rest, part);
        let third = Plain::over_shared(self, rest.0, b.0);
        let (high, low) = self.ordered_sum(first, second);
        let low = Plain::sum(self, low, third);
        self.ordered_sum(high, low)
    }

    /// The product with a power of two, which is exact. The high part of a product is never −0.
    fn by_power_of_two(&mut self, a: DoubleOperand, factor: f64) -> DoubleOperand {
        let factor = self.constant(factor);
        let (high, low) = Double::scaled(self, a, factor);
        let zero = self.constant(0.0);
        (Plain::sum(self, high, zero), low)
    }
}

/// Whether a factor changes no digit.
fn is_power_of_two(factor: DoubleDouble) -> bool {
    factor.low == 0.0 && factor.high.is_normal() && factor.high.to_bits().trailing_zeros() >= 52
}

impl Arithmetic for Double {
    type Number = DoubleOperand;
    const SIZE: usize = 2;
    const SIDE: usize = SIDE;

    fn at(address: Address) -> DoubleOperand {
        (Operand::At(address), Operand::At(address.plus(1)))
    }

    fn constant(code: &mut Code, number: DoubleDouble) -> DoubleOperand {
        Double::at(code.layout.constant(&[number.high, number.low]))
    }

    fn sum(code: &mut Code, a: DoubleOperand, b: DoubleOperand) -> DoubleOperand {
        let (a, b) = (Double::in_register(code, a), Double::in_register(code, b));
        let (high, low) = code.exact_sum(Width::One, a.0, b.0);
        let lows = Plain::sum(code, a.1, b.1);
        (high, Plain::sum(code, lows, low))
    }

    fn difference(code: &mut Code, a: DoubleOperand, b: DoubleOperand) -> DoubleOperand {
        let (a, b) = (Double::in_register(code, a), Double::in_register(code, b));
        let (high, low) = code.exact_difference(a.0, b.0);
        let lows = Plain::difference(code, a.1, b.1);
        (high, Plain::sum(code, lows, low))
    }

    fn renormalized(code: &mut Code, (high, low): DoubleOperand) -> DoubleOperand {
        code.ordered_sum(high, low)
    }

    fn product(code: &mut Code, a: DoubleOperand, b: DoubleOperand) -> DoubleOperand {
        let (a, b) = (Double::in_register(code, a), Double::in_register(code, b));
        let (first, second) = (Plain::product(code, a.0, b.1), Plain::product(code, a.1, b.0));
        let mixed = Plain::sum(code, first, second);
        // last, when its register may be one of theirs
        let (high, low) = code.exact_product(Width::One, a.0, b.0);
        (high, Plain::sum(code, low, mixed))
    }

    fn multiple(code: &mut Code, a: DoubleOperand, n: usize) -> DoubleOperand {
        if n.is_power_of_two() {
            return code.by_power_of_two(a, n as f64);
        }
        let factor = code.constant(n as f64);
        code.multiple(a, factor)
    }

    fn scaled(code: &mut Code, a: DoubleOperand, power_of_two: Operand) -> DoubleOperand {
        (Plain::product(code, a.0, power_of_two), Plain::product(code, a.1, power_of_two))
    }

    fn shared(code: &mut Code, divisor: DoubleOperand) -> DoubleOperand {
        let one = Double::constant(code, DoubleDouble::ONE);
        let reciprocal = code.exact_quotient(one, divisor);
        Double::in_register(code, reciprocal)
    }

    fn over_shared(code: &mut Code, a: DoubleOperand, reciprocal: DoubleOperand) -> DoubleOperand {
        Double::product(code, a, reciprocal)
    }

    fn times(code: &mut Code, a: DoubleOperand, factor: DoubleDouble) -> DoubleOperand {
        if is_power_of_two(factor) {
            return code.by_power_of_two(a, factor.high);
        }
        let factor = Double::constant(code, factor);
        Double::product(code, a, factor)
    }

    fn twice(code: &mut Code, a: DoubleOperand) -> DoubleOperand {
        code.by_power_of_two(a, 2.0)
    }

    fn over(code: &mut Code, a: DoubleOperand, n: usize) -> DoubleOperand {
        Double::times(code, a, DoubleDouble::ONE.over::<false>(n))
    }

    fn opposite(code: &mut Code, a: DoubleOperand) -> DoubleOperand {
        (Plain::opposite(code, a.0), Plain::opposite(code, a.1))
    }

    fn in_register(code: &mut Code, a: DoubleOperand) -> DoubleOperand {
        (Plain::in_register(code, a.0), Plain::in_register(code, a.1))
    }

    fn store(code: &mut Code, a: DoubleOperand, to: Address) {
        Plain::store(code, a.0, to);
        Plain::store(code, a.1, to.plus(1));
    }

    fn store_for_now(code: &mut Code, a: DoubleOperand, to: Address) {
        Plain::store_for_now(code, a.0, to);
        Plain::store_for_now(code, a.1, to.plus(1));
    }

    fn side_by_side(code: &mut Code, numbers: &[DoubleOperand], to: Address) {
        let numbers = four_of(numbers);
        code.side_by_side(numbers.map(|parts| parts.0), to);
        code.side_by_side(numbers.map(|parts| parts.1), to.plus(SIDE));
    }

    fn nearest(a: DoubleOperand) -> Operand {
        a.0
    }

    fn inner_products(
        code: &mut Code,
        (left, right): (Address, Address),
        terms: usize,
    ) -> DoubleOperand {
        let four = Width::Four;
        let mut sum: Operand = code.block.zero(four).into();
        let mut errors = sum;
        for j in 0..terms {
            let [a_high, a_low, b_high, b_low] = [(left, 0), (left, 1), (right, 0), (right, 1)]
                .map(|(series, part)| code.four(series.plus((2 * j + part) * SIDE)).into());
            let first = code.binary(Operation::Multiply, four, a_high, b_low);
            let second = code.binary(Operation::Multiply, four, a_low, b_high);
            let mixed = code.binary(Operation::Add, four, first, second);
            let (product, error) = code.exact_product(four, a_high, b_high);
            let (next, lost) = code.exact_sum(four, sum, product);
            let low = code.binary(Operation::Add, four, error, mixed);
            let low = code.binary(Operation::Add, four, lost, low);
            errors = code.binary(Operation::Add, four, errors, low);
            sum = next;
        }
        (sum, errors)
    }

    fn store_inner_products(code: &mut Code, (high, low): DoubleOperand, to: Address) {
        code.block.store(Width::Four, high, to, false);
        code.block.store(Width::Four, low, to.plus(SIDE), false);
    }

    fn inner_product(stored: Address, lane: usize) -> DoubleOperand {
        (Operand::At(stored.plus(lane)), Operand::At(stored.plus(SIDE + lane)))
    }

    fn lane(code: &mut Code, products: DoubleOperand, lane: usize) -> DoubleOperand {
        (code.lane(products.0, lane), code.lane(products.1, lane))
    }

    fn behind(code: &mut Code, from: Address, offset: Address) -> DoubleOperand {
        let mut part = |from| code.block.load_behind(from, offset).into();
        (part(from), part(from.plus(1)))
    }
}
