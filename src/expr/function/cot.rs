//! The cotangent.

use super::recurrence::{BilinearEquation, COMPANION, Convolution, FIRST, Recurrence, VALUE};
use super::{Function, FunctionId, Rule};
use crate::expr::Expr;
use crate::num::{Analytic, Number, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    let y = R::ONE / u[0].tan();
    (y, R::ONE + y * y)
}

/// y = cot u, w = 1 + y²: y′ = −w u′.
const RECURRENCE: Recurrence = Recurrence {
    companion_first: false,
    value: BilinearEquation::over_order(&[Convolution::of_slope(-1.0, FIRST, COMPANION)]),
    companion: Some(BilinearEquation::sum(&[Convolution::of(1.0, VALUE, VALUE)])),
};

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Cot,
    name: "cot",
    unicode: "cot",
    latex: "\\cot",
    arity: 1,
    value: |u| 1.0 / math::tan(u[0]),
    fold: |pool, u| {
        if u[0] == Expr::ZERO { None } else { pool.fold_odd(FunctionId::Cot, u[0]) }
    },
    derivative: |pool, u, _| {
        let cotangent = pool.call(FunctionId::Cot, u);
        let square = pool.powi(cotangent, 2);
        pool.linear(Number::MINUS_ONE, &[(Number::MINUS_ONE, square)])
    },
    rule: Rule::Series(RECURRENCE),
};
