//! The tangent.

use super::recurrence::{BilinearEquation, COMPANION, Convolution, FIRST, Recurrence, VALUE};
use super::{Function, FunctionId, Rule};
use crate::num::{Analytic, Number, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    let y = u[0].tan();
    (y, R::ONE + y * y)
}

/// y = tan u, w = 1 + y²: y′ = w u′.
const RECURRENCE: Recurrence = Recurrence {
    companion_first: false,
    value: BilinearEquation::over_order(&[Convolution::of_slope(1.0, FIRST, COMPANION)]),
    companion: Some(BilinearEquation::sum(&[Convolution::of(1.0, VALUE, VALUE)])),
};

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Tan,
    name: "tan",
    unicode: "tan",
    latex: "\\tan",
    arity: 1,
    value: |u| math::tan(u[0]),
    fold: |pool, u| pool.fold_odd(FunctionId::Tan, u[0]),
    derivative: |pool, u, _| {
        let tangent = pool.call(FunctionId::Tan, u);
        let square = pool.powi(tangent, 2);
        pool.linear(Number::ONE, &[(Number::ONE, square)])
    },
    rule: Rule::Series(RECURRENCE),
};
