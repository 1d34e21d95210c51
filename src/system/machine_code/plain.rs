//! The arithmetic of `f64` as instructions.
//!
//! In: numbers. Out: instructions whose results have the bits of `f64`. Never here: which numbers.

use super::arithmetic::{Arithmetic, Code, SIDE, four_of};
use super::basic_block::{Operand, Operation, Width};
use super::layout::Address;
use crate::num::DoubleDouble;

/// `f64`.
#[derive(Debug)]
pub(super) struct Plain;

impl Arithmetic for Plain {
    type Number = Operand;
    const SIZE: usize = 1;
    const SIDE: usize = SIDE;

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

    fn multiple(code: &mut Code, a: Operand, n: usize) -> Operand {
        let n = code.constant(n as f64);
        Plain::product(code, a, n)
    }

    fn scaled(code: &mut Code, a: Operand, power_of_two: Operand) -> Operand {
        Plain::product(code, a, power_of_two)
    }

    fn shared(_: &mut Code, divisor: Operand) -> Operand {
        divisor
    }

    fn over_shared(code: &mut Code, a: Operand, shared: Operand) -> Operand {
        code.binary(Operation::Divide, Width::One, a, shared)
    }

    fn over(code: &mut Code, a: Operand, n: usize) -> Operand {
        if n == 1 {
            return a;
        }
        let n = code.constant(n as f64);
        Plain::over_shared(code, a, n)
    }

    fn opposite(code: &mut Code, a: Operand) -> Operand {
        let a = Plain::held(code, a);
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

    fn side_by_side(code: &mut Code, numbers: &[Operand], to: Address) {
        code.side_by_side(four_of(numbers), to);
    }

    fn nearest(a: Operand) -> Operand {
        a
    }

    fn inner_products(code: &mut Code, operands: (Address, Address), terms: usize, to: Address) {
        code.inner_products((Width::Four, SIDE), operands, terms, to);
    }

    fn inner_product(stored: Address, lane: usize) -> Operand {
        Operand::At(stored.plus(lane))
    }

    fn behind(code: &mut Code, from: Address, offset: Address) -> Option<Operand> {
        Some(code.block.load_behind(from, offset).into())
    }
}
