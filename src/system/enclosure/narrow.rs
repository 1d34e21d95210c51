//! What may be narrow in a law: high powers, what is divided by, the arguments of functions.
//!
//! In: a program, the intervals of its registers. Out: whether one of them changes by more than its function shows. Never here: the
//! intervals, and what a change matters to the rates.

use crate::expr::FunctionId;
use crate::num::Interval;
use crate::system::program::{Op, Program, Register};

/// A product of this degree may have its first term beyond the last order of a series.
const STEEP: f64 = 6.0;

/// The ratio of the bounds of what is resolved, e².
const RATIO: f64 = 7.389;

/// The width of the argument of a function that is resolved.
const WIDE: f64 = 2.0;

/// Beyond this argument exponentials leave the range of `f64`, and functions that saturate with them no longer change.
const SATURATED: f64 = 750.0;

/// Numbers are at the ends of the range of `f64` below the first of these, and above the second.
const RANGE: (f64, f64) = (1e-290, 1e290);

/// What may be narrow.
#[derive(Clone, Copy, Debug)]
pub(super) enum Narrow {
    /// A number whose order of magnitude counts: a high power, or what is divided by.
    Size(Register),
    /// A power whose exponent depends on parameters.
    ParametricPower(Register, Register),
    /// The function with an argument.
    Function(FunctionId, Register, Register),
}

impl Narrow {
    /// Whether what may be narrow changes by no more than its function shows.
    pub(super) fn is_resolved(self, registers: &[Interval]) -> bool {
        let at = |r: Register| registers[r as usize];
        match self {
            Narrow::Size(r) => has_one_size(at(r)),
            Narrow::ParametricPower(r, exponent) => {
                (0.0..STEEP).contains(&at(exponent).low) || has_one_size(at(r))
            }
            Narrow::Function(function, value, argument) => {
                let (u, value) = (at(argument), at(value));
                match function {
                    FunctionId::Exp | FunctionId::Sinh | FunctionId::Cosh | FunctionId::Tanh => {
                        u.low.clamp(-SATURATED, SATURATED) + WIDE
                            >= u.high.clamp(-SATURATED, SATURATED)
                    }
                    FunctionId::Ln => has_one_size(u),
                    FunctionId::Atan => u.width() <= WIDE || has_one_size(u),
                    FunctionId::Tan | FunctionId::Cot => {
                        value.width() <= WIDE || has_one_size(value)
                    }
                    _ => u.width() <= WIDE,
                }
            }
        }
    }
}

/// Whether numbers are of one order of magnitude, or at an end of the range.
fn has_one_size(x: Interval) -> bool {
    let (least, most) = (x.mignitude(), x.magnitude());
    most <= RATIO * least || most <= RANGE.0 || least >= RANGE.1
}

/// What may be narrow in a program.
pub(super) fn narrow(program: &Program) -> Vec<Narrow> {
    let mut degrees = vec![0.0_f64; program.ops.len()];
    let mut narrow = Vec::new();
    for &r in program.inputs.iter().chain(&program.body) {
        let of = |r: Register| degrees[r as usize];
        let is_fixed = |r: Register| program.fixed[r as usize];
        let op = program.ops[r as usize];
        let degree = match op {
            Op::Linear { first, count, .. } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                terms.iter().map(|term| of(term.register)).fold(0.0, f64::max)
            }
            Op::Scale(_, a) => of(a),
            Op::Multiply(a, b) => of(a) + of(b),
            Op::Square(a) => 2.0 * of(a),
            _ => 1.0,
        };
        degrees[r as usize] = degree;
        match op {
            // a companion and the unknowns of equations are in the registers behind
            Op::Call(..) => degrees[r as usize + 1] = 1.0,
            Op::Solve(block) => {
                degrees[r as usize..][..program.blocks[block as usize].size()].fill(1.0);
            }
            _ => {}
        }
        match op {
            Op::Multiply(..) | Op::Square(_) if degree >= STEEP => narrow.push(Narrow::Size(r)),
            Op::Divide(_, b) if !is_fixed(b) => narrow.push(Narrow::Size(b)),
            Op::Power(a, exponent) => {
                let exponent = program.constants[exponent as usize].high;
                if exponent < 0.0 {
                    narrow.push(Narrow::Size(a));
                } else if exponent >= STEEP {
                    narrow.push(Narrow::Size(r));
                }
            }
            Op::ParametricPower(_, exponent) => narrow.push(Narrow::ParametricPower(r, exponent)),
            Op::Call(function, [a, b]) => {
                narrow.push(Narrow::Function(function, r, a));
                if function == FunctionId::Atan2 {
                    narrow.push(Narrow::Function(function, r, b));
                }
            }
            _ => {}
        }
    }
    narrow
}
