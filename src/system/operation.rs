//! The value of one operation of a program.
//!
//! In: an operation, the values of what it reads. Out: its value. Never here: what needs more than numbers: inputs, the time, the
//! solution of linear equations.

use super::program::{Op, Program, Register};
use crate::num::Analytic;

/// The value of an operation on registers with these values and, of a function, that of its
/// companion in the next register. `None` for what is set elsewhere. `FUSED` is that of a [`Kernel`](crate::num::Kernel).
#[inline(always)]
pub(super) fn value_of<R: Analytic, const FUSED: bool>(
    program: &Program,
    op: Op,
    get: impl Fn(Register) -> R,
) -> Option<(R, Option<R>)> {
    let value = match op {
        Op::Constant(c) => R::of(program.constants[c as usize]),
        Op::Linear { constant, first, count } => {
            let terms = &program.terms[first as usize..(first + count) as usize];
            let mut sum = R::of(program.constants[constant as usize]);
            for term in terms {
                sum = sum + get(term.register).times::<FUSED>(R::of(term.coefficient));
            }
            sum
        }
        Op::Scale(a, b) | Op::Multiply(a, b) => get(a).times::<FUSED>(get(b)),
        Op::Square(a) => get(a).times::<FUSED>(get(a)),
        Op::Divide(a, b) => get(a).divided_by::<FUSED>(get(b)),
        Op::Root(a) => get(a).sqrt(),
        Op::Power(a, exponent) => get(a).power(program.constants[exponent as usize]),
        Op::ParametricPower(a, exponent) => get(a).raised(get(exponent)),
        Op::Call(function, [a, b]) => {
            let (value, companion) = function.with_companion([get(a), get(b)]);
            return Some((value, Some(companion)));
        }
        Op::Select { switch, positive, negative, .. } => {
            let (side, positive, negative) = (get(switch), get(positive), get(negative));
            // on the surface; NaN if the switch is NaN
            let between = (positive + negative) * 0.5 * (side + R::ONE);
            side.where_positive(positive, (-side).where_positive(negative, between))
        }
        Op::Parameter(_) | Op::Time | Op::Input(_) | Op::Solve(_) | Op::Written => return None,
    };
    Some((value, None))
}
