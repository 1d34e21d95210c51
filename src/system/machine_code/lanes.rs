//! The arithmetic of several orbits side by side as instructions.
//!
//! In: numbers of several orbits. Out: instructions whose results have in each lane the bits of `f64`. Never here: which
//! numbers, how many calls serve all orbits.

use super::arithmetic::{Arithmetic, Code};
use super::basic_block::{Operand, Operation};
use super::layout::Address;
use crate::num::{BATCH, DoubleDouble};

/// A number of each of several orbits, as many as [`Code::lanes`] says.
#[derive(Debug)]
pub(super) struct Lanes;

impl Code {
    fn on_lanes(&mut self, operation: Operation, a: Operand, b: Operand) -> Operand {
        self.binary(operation, self.lanes, a, b)
    }

    /// The same number in all lanes.
    fn splat(&mut self, number: f64) -> Operand {
        Operand::At(self.layout.constant(&[number; BATCH]))
    }
}

impl Arithmetic for Lanes {
    type Number = Operand;
    const SIZE: usize = BATCH;
    const SIDE: usize = 1;

    fn at(address: Address) -> Operand {
        Operand::At(address)
    }

    fn constant(code: &mut Code, number: DoubleDouble) -> Operand {
        code.splat(number.high)
    }

    fn sum(code: &mut Code, a: Operand, b: Operand) -> Operand {
        code.on_lanes(Operation::Add, a, b)
    }

    fn difference(code: &mut Code, a: Operand, b: Operand) -> Operand {
        code.on_lanes(Operation::Subtract, a, b)
    }

    fn product(code: &mut Code, a: Operand, b: Operand) -> Operand {
        code.on_lanes(Operation::Multiply, a, b)
    }

    fn multiple(code: &mut Code, a: Operand, n: usize) -> Operand {
        let n = code.splat(n as f64);
        Lanes::product(code, a, n)
    }

    fn scaled(code: &mut Code, a: Operand, power_of_two: Operand) -> Operand {
        Lanes::product(code, a, power_of_two)
    }

    fn shared(_: &mut Code, divisor: Operand) -> Operand {
        divisor
    }

    fn over_shared(code: &mut Code, a: Operand, shared: Operand) -> Operand {
        code.on_lanes(Operation::Divide, a, shared)
    }

    fn over(code: &mut Code, a: Operand, n: usize) -> Operand {
        if n == 1 {
            return a;
        }
        let n = code.splat(n as f64);
        Lanes::over_shared(code, a, n)
    }

    fn opposite(code: &mut Code, a: Operand) -> Operand {
        let sign = code.splat(-0.0);
        code.on_lanes(Operation::Xor, a, sign)
    }

    fn held(code: &mut Code, a: Operand) -> Operand {
        code.block.made(code.lanes, a).into()
    }

    fn store(code: &mut Code, a: Operand, to: Address) {
        code.block.store(code.lanes, a, to, true);
    }

    fn store_for_now(code: &mut Code, a: Operand, to: Address) {
        code.block.store(code.lanes, a, to, false);
    }

    fn side_by_side(code: &mut Code, numbers: &[Operand], to: Address) {
        code.block.store(code.lanes, numbers[0], to, true);
    }

    fn nearest(a: Operand) -> Operand {
        a
    }

    fn inner_products(code: &mut Code, operands: (Address, Address), terms: usize, to: Address) {
        code.inner_products((code.lanes, BATCH), operands, terms, to);
    }

    fn inner_product(stored: Address, _: usize) -> Operand {
        Operand::At(stored)
    }

    fn behind(_: &mut Code, _: Address, _: Address) -> Option<Operand> {
        None
    }
}
