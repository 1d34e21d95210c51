//! The sine.

use super::recurrence::{BilinearEquation, COMPANION, Convolution, FIRST, Recurrence, VALUE};
use super::{Function, FunctionId, Rule, exact_sine};
use crate::num::{Analytic, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    u[0].sin_cos()
}

/// y = sin u, w = cos u: y′ = w u′, w′ = −y u′.
const RECURRENCE: Recurrence = Recurrence {
    companion_first: false,
    value: BilinearEquation::over_order(&[Convolution::of_slope(1.0, FIRST, COMPANION)]),
    companion: Some(BilinearEquation::over_order(&[Convolution::of_slope(-1.0, FIRST, VALUE)])),
};

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Sin,
    name: "sin",
    unicode: "sin",
    latex: "\\sin",
    arity: 1,
    value: |u| math::sin(u[0]),
    fold: |pool, u| {
        if let Some(exact) = pool.turns(u[0]).and_then(exact_sine) {
            return Some(pool.number(exact));
        }
        pool.fold_odd(FunctionId::Sin, u[0])
    },
    derivative: |pool, u, _| pool.call(FunctionId::Cos, u),
    rule: Rule::Series(RECURRENCE),
};
