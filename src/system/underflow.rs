//! Underflow: whether a product fell below the numbers that keep all their digits, in a program with numbers so
//! large or small that the loss may count, as in `1e298*x^20` at 1e-17.
//!
//! In: a program, its parameters, the values of its registers. Out: whether to evaluate once more in a wider
//! range. Never here: that evaluation.

use super::program::{Op, Program, Register};
use crate::num::DoubleDouble;

/// 2^−916: the second part of a smaller double-double has lost digits.
const LEAST: f64 = 1.8e-276;

/// Numbers of a program up to this size, or its inverse, cannot make what is below [`LEAST`] count.
const ORDINARY: f64 = 1e100;

/// Below this the last coefficients of a series lose digits whose largest one this is: those of low
/// order have twice the digits of `f64`, and the others are up to 1e-30 of it.
pub(super) const LEAST_LEADING: f64 = 1e-246;

/// Whether a number of a state is so small that the law's products may underflow.
#[inline]
pub(super) fn is_small(number: f64) -> bool {
    number != 0.0 && number.abs() < 1.0 / ORDINARY
}

/// Whether underflow may count in a program with these parameters, from which the values of what
/// depends on them alone follow: powers of ordinary parameters may be as large or small as numbers
/// get.
pub(super) fn may_count(
    program: &Program,
    parameters: &[DoubleDouble],
    value: impl Fn(Register) -> f64,
) -> bool {
    let extreme = |size: f64| size > ORDINARY || (size != 0.0 && size < 1.0 / ORDINARY);
    let coefficients = program.terms.iter().map(|term| &term.coefficient);
    let numbers = program.constants.iter().chain(coefficients).chain(parameters);
    numbers.map(|x| x.high.abs()).any(extreme)
        || program.prologue.iter().any(|&r| extreme(value(r).abs()))
        || occurred_in(&program.prologue, program, &value)
}

/// Whether an operation on numbers other than zero has a value below [`LEAST`].
pub(super) fn occurred(program: &Program, value: impl Fn(Register) -> f64) -> bool {
    occurred_in(&program.prologue, program, &value) || occurred_in(&program.body, program, &value)
}

fn occurred_in(
    operations: &[Register],
    program: &Program,
    value: &impl Fn(Register) -> f64,
) -> bool {
    let is_small = |r: Register| value(r).abs() < LEAST;
    let is_zero = |r: &Register| value(*r) == 0.0;
    operations.iter().any(|&r| match program.ops[r as usize] {
        Op::Scale(a, b) | Op::Multiply(a, b) => is_small(r) && ![a, b].iter().any(is_zero),
        Op::Divide(a, _) | Op::Square(a) | Op::Power(a, _) | Op::ParametricPower(a, _) => {
            is_small(r) && !is_zero(&a)
        }
        // of functions only exponentials are so small far from zero
        Op::Call(_, [a, _]) => is_small(r) && value(a).abs() > 1.0,
        Op::Linear { first, count: 1, .. } => {
            is_small(r) && !is_zero(&program.terms[first as usize].register)
        }
        _ => false,
    })
}
