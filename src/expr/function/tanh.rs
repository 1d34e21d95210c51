//! The hyperbolic tangent.

use super::recurrence::{BilinearEquation, COMPANION, Convolution, FIRST, Recurrence, VALUE};
use super::{Function, FunctionId, Rule};
use crate::num::{Analytic, Number, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    let inverse = R::ONE / u[0].sinh_cosh().1;
    (u[0].tanh(), inverse * inverse)
}

/// y = tanh u, w = 1 − y² = 1/cosh² u: y′ = w u′.
const RECURRENCE: Recurrence = Recurrence {
    companion_first: false,
    value: BilinearEquation::over_order(&[Convolution::of_slope(1.0, FIRST, COMPANION)]),
    companion: Some(BilinearEquation::sum(&[Convolution::of(-1.0, VALUE, VALUE)])),
};

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Tanh,
    name: "tanh",
    unicode: "tanh",
    latex: "\\tanh",
    arity: 1,
    value: |u| math::tanh(u[0]),
    fold: |pool, u| pool.fold_odd(FunctionId::Tanh, u[0]),
    derivative: |pool, u, _| {
        let tangent = pool.call(FunctionId::Tanh, u);
        let square = pool.powi(tangent, 2);
        pool.linear(Number::ONE, &[(Number::MINUS_ONE, square)])
    },
    rule: Rule::Series(RECURRENCE),
};
