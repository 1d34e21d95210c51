//! The cosine.

use super::recurrence::{BilinearEquation, COMPANION, Convolution, FIRST, Recurrence, VALUE};
use super::{Function, FunctionId, Rule, exact_sine};
use crate::num::{Analytic, Number, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    let (sine, cosine) = u[0].sin_cos();
    (cosine, sine)
}

/// y = cos u, w = sin u: y′ = −w u′, w′ = y u′.
const RECURRENCE: Recurrence = Recurrence {
    companion_first: false,
    value: BilinearEquation::over_order(&[Convolution::of_slope(-1.0, FIRST, COMPANION)]),
    companion: Some(BilinearEquation::over_order(&[Convolution::of_slope(1.0, FIRST, VALUE)])),
};

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Cos,
    name: "cos",
    unicode: "cos",
    latex: "\\cos",
    arity: 1,
    value: |u| math::cos(u[0]),
    fold: |pool, u| {
        if let Some(exact) = pool.turns(u[0]).and_then(|r| exact_sine(r + Number::HALF)) {
            return Some(pool.number(exact));
        }
        pool.fold_even(FunctionId::Cos, u[0])
    },
    derivative: |pool, u, _| {
        let sine = pool.call(FunctionId::Sin, u);
        pool.neg(sine)
    },
    rule: Rule::Series(RECURRENCE),
};
