//! The arithmetic of `f64` as instructions, for one orbit or for several side by side.
//!
//! In: numbers. Out: instructions whose results have the bits of `f64`, in each lane. Never here: which numbers, how many
//! calls serve all orbits.

use super::arithmetic::{Arithmetic, Code, SIDE, four_of};
use super::basic_block::{Operand, Operation, Width};
use super::layout::Address;
use crate::num::{BATCH, DoubleDouble};

/// `f64`, of so many orbits in memory. One instruction takes as many as [`Code::lanes`] says.
#[derive(Debug)]
pub(super) struct Floats<const ORBITS: usize>;

pub(super) type Plain = Floats<1>;

pub(super) type Lanes = Floats<BATCH>;

impl<const ORBITS: usize> Floats<ORBITS> {
    /// The same number for all orbits.
    fn splat(code: &mut Code, number: f64) -> Operand {
        Operand::At(code.layout.constant(&[number; ORBITS]))
    }
}

impl<const ORBITS: usize> Arithmetic for Floats<ORBITS> {
    type Number = Operand;
    const SIZE: usize = ORBITS;
    const SIDE: usize = if ORBITS == 1 { SIDE } else { 1 };

    fn at(address: Address) -> Operand {
        Operand::At(address)
    }

    fn constant(code: &mut Code, number: DoubleDouble) -> Operand {
        Self::splat(code, number.high)
    }

    fn sum(code: &mut Code, a: Operand, b: Operand) -> Operand {
        code.binary(Operation::Add, code.lanes, a, b)
    }

    fn difference(code: &mut Code, a: Operand, b: Operand) -> Operand {
        code.binary(Operation::Subtract, code.lanes, a, b)
    }

    fn product(code: &mut Code, a: Operand, b: Operand) -> Operand {
        code.binary(Operation::Multiply, code.lanes, a, b)
    }

    fn renormalized(_: &mut Code, a: Operand) -> Operand {
        a
    }

    fn multiple(code: &mut Code, a: Operand, n: usize) -> Operand {
        let n = Self::splat(code, n as f64);
        Self::product(code, a, n)
    }

    fn scaled(code: &mut Code, a: Operand, power_of_two: Operand) -> Operand {
        Self::product(code, a, power_of_two)
    }

    fn shared(_: &mut Code, divisor: Operand) -> Operand {
        divisor
    }

    fn over_shared(code: &mut Code, a: Operand, shared: Operand) -> Operand {
        code.binary(Operation::Divide, code.lanes, a, shared)
    }

    fn over(code: &mut Code, a: Operand, n: usize) -> Operand {
        if n == 1 {
            return a;
        }
        code.quotient(a, n, Self::splat)
    }

    fn integrated(code: &mut Code, a: Operand, n: usize) -> Operand {
        code.integral(a, n, Self::splat)
    }

    fn opposite(code: &mut Code, a: Operand) -> Operand {
        let a = Self::in_register(code, a);
        // there is no exclusive or of one number
        let (width, sign) = if ORBITS == 1 {
            (Width::Two, code.layout.constant(&[-0.0; 2]))
        } else {
            (code.lanes, code.layout.constant(&[-0.0; BATCH]))
        };
        code.binary(Operation::Xor, width, a, Operand::At(sign))
    }

    fn in_register(code: &mut Code, a: Operand) -> Operand {
        code.block.made(code.lanes, a).into()
    }

    fn store(code: &mut Code, a: Operand, to: Address) {
        code.block.store(code.lanes, a, to, true);
    }

    fn store_for_now(code: &mut Code, a: Operand, to: Address) {
        code.block.store(code.lanes, a, to, false);
    }

    fn side_by_side(code: &mut Code, numbers: &[Operand], to: Address) {
        if ORBITS == 1 {
            code.side_by_side(four_of(numbers), to);
        } else {
            Self::store(code, numbers[0], to);
        }
    }

    fn nearest(a: Operand) -> Operand {
        a
    }

    fn inner_products(code: &mut Code, operands: (Address, Address), terms: usize) -> Operand {
        let of_one = ORBITS == 1;
        let size = if of_one { (Width::Four, SIDE) } else { (code.lanes, BATCH) };
        code.inner_products(size, operands, terms)
    }

    fn store_inner_products(code: &mut Code, products: Operand, to: Address) {
        let width = if ORBITS == 1 { Width::Four } else { code.lanes };
        code.block.store(width, products, to, false);
    }

    fn inner_product(stored: Address, lane: usize) -> Operand {
        Operand::At(stored.plus(lane))
    }

    fn lane(code: &mut Code, products: Operand, lane: usize) -> Operand {
        if ORBITS == 1 { code.lane(products, lane) } else { products }
    }

    fn behind(code: &mut Code, from: Address, offset: Address) -> Operand {
        code.block.load_behind(from, offset).into()
    }
}
