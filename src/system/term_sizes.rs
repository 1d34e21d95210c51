//! The sizes of the terms that the values of a program are sums of, to which their rounding errors are proportional: a value
//! that is zero but for rounding shows nothing of them.
//!
//! In: a program, the values of its registers. Out: a size for each register, at least that of its value. Never here: what is
//! concluded from them.
//! Source: N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., § 3.3.

use super::operation::value_of;
use super::program::{Op, Program, Register};

/// The part of the size of an operand by which it is moved, to see how much of it reaches the value.
const PART: f64 = 1.0 / (1 << 20) as f64;

pub(super) fn of(program: &Program, value: impl Fn(Register) -> f64, sizes: &mut Vec<f64>) {
    sizes.clear();
    sizes.resize(program.ops.len(), 0.0);
    for r in 0..program.ops.len() {
        let (register, op) = (r as Register, program.ops[r]);
        let own = value(register).abs();
        let size = |a: Register| sizes[a as usize];
        let reached = match op {
            Op::Constant(_) | Op::Parameter(_) | Op::Time | Op::Input(_) | Op::Solve(_) => 0.0,
            // with its function
            Op::Written => sizes[r],
            Op::Linear { constant, first, count } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                let parts = terms.iter().map(|t| t.coefficient.high.abs() * size(t.register));
                program.constants[constant as usize].high.abs() + parts.sum::<f64>()
            }
            Op::Scale(a, b) | Op::Multiply(a, b) => {
                f64::max(size(a) * value(b).abs(), value(a).abs() * size(b))
            }
            Op::Square(a) => size(a) * value(a).abs(),
            _ => {
                let mut operands = Vec::new();
                program.each_operand(register, &mut |operand| operands.push(operand));
                let at = |moved: Option<Register>| {
                    let get = |a: Register| {
                        value(a) + if moved == Some(a) { PART * size(a) } else { 0.0 }
                    };
                    value_of::<_, false>(program, op, get)
                        .map_or([0.0; 2], |(x, companion)| [x, companion.unwrap_or_default()])
                };
                let here = at(None);
                let mut most = [0.0_f64; 2];
                for operand in operands {
                    for (most, (x, here)) in most.iter_mut().zip(at(Some(operand)).iter().zip(here))
                    {
                        *most = most.max((x - here).abs() / PART);
                    }
                }
                if matches!(op, Op::Call(..)) {
                    sizes[r + 1] = most[1];
                }
                most[0]
            }
        };
        sizes[r] = if reached.is_finite() { own.max(reached) } else { own };
    }
}
