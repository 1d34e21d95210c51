//! The inverse tangent.

use super::recurrence::{BilinearEquation, COMPANION, Convolution, FIRST, Recurrence, VALUE};
use super::{Function, FunctionId, Rule};
use crate::num::{Analytic, Number, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    (u[0].atan2(R::ONE), R::ONE + u[0] * u[0])
}

/// y = arctan u, w = 1 + u²: y′ w = u′.
const RECURRENCE: Recurrence = Recurrence {
    companion_first: true,
    value: BilinearEquation::slope(
        1.0,
        FIRST,
        &[Convolution::of_slope(-1.0, VALUE, COMPANION)],
        COMPANION,
    ),
    companion: Some(BilinearEquation::sum(&[Convolution::of(1.0, FIRST, FIRST)])),
};

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Atan,
    name: "atan",
    unicode: "arctan",
    latex: "\\arctan",
    arity: 1,
    value: |u| math::atan(u[0]),
    fold: |pool, u| pool.fold_odd(FunctionId::Atan, u[0]),
    derivative: |pool, u, _| {
        let square = pool.powi(u[0], 2);
        let under = pool.linear(Number::ONE, &[(Number::ONE, square)]);
        pool.powi(under, -1)
    },
    rule: Rule::Series(RECURRENCE),
};
