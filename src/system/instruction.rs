//! The instructions of straight lists: operations on a file of registers, and sums that move numbers of a state.
//!
//! In and out: nothing. Never here: which operations a program needs, numbers.

use super::program::Register;

/// The number of registers: an index of eight bits needs no check.
pub(super) const REGISTERS: usize = 256;

/// As many numbers are moved side by side. Those that are moved together begin at a multiple of it.
pub(super) const CHUNK: usize = 4;

/// One instruction. It writes the register `to`, or moves numbers of the state.
#[derive(Clone, Copy, Debug)]
pub(super) enum Instruction {
    /// A sum of one, two or three terms, from the table.
    Sum1 {
        sum: u8,
        to: u8,
    },
    Sum2 {
        sum: u8,
        to: u8,
    },
    Sum3 {
        sum: u8,
        to: u8,
    },
    /// The same where a term is a product.
    Products1 {
        sum: u8,
        to: u8,
    },
    Products2 {
        sum: u8,
        to: u8,
    },
    Products3 {
        sum: u8,
        to: u8,
    },
    Sum {
        sum: u8,
        to: u8,
    },
    Multiply {
        a: u8,
        b: u8,
        to: u8,
    },
    Divide {
        a: u8,
        b: u8,
        to: u8,
    },
    Root {
        a: u8,
        to: u8,
    },
    Copy {
        a: u8,
        to: u8,
    },
    /// Any other operation of a program, with its companion in the next register.
    Other {
        program: u8,
        operation: Register,
        to: u8,
    },
    /// Solves a block of equations; the unknowns are in the registers from `to` on.
    Solve {
        block: u8,
        to: u8,
    },
    /// Adds `factor · rate` to some numbers.
    Move {
        factor: u8,
        moved: Moved,
    },
    /// Adds two multiples of the rates, one after the other.
    MoveTwice {
        factors: [u8; 2],
        moved: Moved,
    },
}

/// Numbers that move together: the first of them, of their rates, and how many there are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved {
    pub(super) number: u8,
    pub(super) rate: u8,
    pub(super) count: u8,
}

impl Moved {
    /// Whether they fill no more than one [`CHUNK`].
    #[inline(always)]
    pub(super) fn is_short(self) -> bool {
        usize::from(self.count) <= CHUNK
    }
}

/// `constant + Σ coefficient · (register · register)`; the second register of a term that is no
/// product holds a one.
#[derive(Clone, Debug)]
pub(super) struct InstructionSum {
    pub(super) constant: f64,
    /// The first terms.
    pub(super) coefficients: [f64; 3],
    pub(super) registers: [[u8; 2]; 3],
    /// The terms after these.
    pub(super) further: Vec<(f64, [u8; 2])>,
}

/// Where the matrix, row by row, and the right-hand side of a block of equations are.
#[derive(Clone, Debug)]
pub(super) struct BlockPlaces {
    pub(super) matrix: Vec<u8>,
    pub(super) right: Vec<u8>,
}
