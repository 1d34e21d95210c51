//! The loops of long inner products, which the code calls.
//!
//! In: which operands, how many. Out: calls, and behind the code the loops that they call. Never here: which inner products are
//! loops.
//!
//! ```text
//!   code    … point to a_1 and b_{k−1}, count, call ─┐  the sums in the first register …
//!                                                    ▼
//!   loop    four sums apart: four or eight terms, then eight at a time; what is left over; the sums together; back
//! ```

use super::arithmetic::APART;
use super::basic_block::{InnerProductOperands, Operation, Width};
use super::encoding::{Bytes, Call, General, Place, Source, VectorRegister};

/// A loop computes with the first registers: the sums apart, that of what is left over, a product.
pub(super) const REGISTERS: usize = APART + 2;

const REST: VectorRegister = VectorRegister(APART as u8);
const PRODUCT: VectorRegister = VectorRegister(APART as u8 + 1);

/// Where a loop finds its operands, and how often it goes on.
const LEFT: General = General::RAX;
const RIGHT: General = General::R10;
const COUNT: General = General::R11;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Kind {
    width: Width,
    distance: usize,
    /// How often four terms come before the loop: once or twice.
    before: usize,
    /// The number of terms that are left over.
    rest: usize,
}

#[derive(Debug, Default)]
pub(super) struct ProductLoops {
    calls: Vec<(Kind, Call)>,
}

impl ProductLoops {
    /// Writes a call, and returns the register that the sums are in.
    pub(super) fn call(
        &mut self,
        bytes: &mut Bytes,
        products: InnerProductOperands,
    ) -> VectorRegister {
        let InnerProductOperands { width, left, right, distance, terms } = products;
        bytes.point(LEFT, left);
        bytes.point(RIGHT, right);
        let whole = terms / APART;
        let before = 2 - whole % 2;
        debug_assert!(whole > before, "{terms}");
        bytes.count(COUNT, ((whole - before) / 2) as u32);
        self.calls.push((Kind { width, distance, before, rest: terms % APART }, bytes.call()));
        VectorRegister(0)
    }

    /// Writes the loops behind the code.
    pub(super) fn write(self, bytes: &mut Bytes) {
        let mut known: Vec<(Kind, usize)> = Vec::new();
        for (kind, call) in self.calls {
            let place = known.iter().find(|(other, _)| *other == kind).map(|(_, place)| *place);
            let place = place.unwrap_or_else(|| {
                let place = bytes.0.len();
                kind.write(bytes);
                known.push((kind, place));
                place
            });
            bytes.begins(call, place);
        }
    }
}

impl Kind {
    /// Writes the loop, which has at least twelve terms.
    fn write(self, bytes: &mut Bytes) {
        let sum = |i: usize| VectorRegister(i as u8);
        bytes.zero(REST);
        (0..APART).for_each(|i| self.multiply(bytes, i, sum(i)));
        let first = APART * self.before;
        (APART..first).for_each(|i| self.add(bytes, i, sum(i % APART)));
        let from = bytes.0.len();
        (0..2 * APART).for_each(|i| self.add(bytes, first + i, sum(i % APART)));
        bytes.move_on(LEFT, 2 * APART * self.distance);
        bytes.move_on(RIGHT, 2 * APART * self.distance);
        bytes.repeat(COUNT, from);
        (0..self.rest).for_each(|i| self.add(bytes, first + i, REST));
        for (to, other) in [(0, 2), (1, 3), (0, 1)] {
            self.plus(bytes, sum(to), sum(other));
        }
        self.plus(bytes, sum(0), REST);
        bytes.back();
    }

    /// Adds the product of the operands at a place from where the registers point.
    fn add(self, bytes: &mut Bytes, place: usize, to: VectorRegister) {
        self.multiply(bytes, place, PRODUCT);
        self.plus(bytes, to, PRODUCT);
    }

    fn multiply(self, bytes: &mut Bytes, place: usize, to: VectorRegister) {
        let at = |base| Place::behind(base, place * self.distance);
        bytes.load(self.width, to, at(LEFT));
        let right = Source::Memory(at(RIGHT));
        bytes.binary(Operation::Multiply, self.width, to, to, right);
    }

    fn plus(self, bytes: &mut Bytes, to: VectorRegister, other: VectorRegister) {
        bytes.binary(Operation::Add, self.width, to, to, Source::Register(other));
    }
}
