//! The hyperbolic sine.

use super::recurrence::{BilinearEquation, COMPANION, Convolution, FIRST, Recurrence, VALUE};
use super::{Function, FunctionId, Rule};
use crate::num::{Analytic, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    u[0].sinh_cosh()
}

/// y = sinh u, w = cosh u: y′ = w u′, w′ = y u′. The same with both exchanged.
pub(super) const RECURRENCE: Recurrence = Recurrence {
    companion_first: false,
    value: BilinearEquation::over_order(&[Convolution::of_slope(1.0, FIRST, COMPANION)]),
    companion: Some(BilinearEquation::over_order(&[Convolution::of_slope(1.0, FIRST, VALUE)])),
};

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Sinh,
    name: "sinh",
    unicode: "sinh",
    latex: "\\sinh",
    arity: 1,
    value: |u| math::sinh(u[0]),
    fold: |pool, u| pool.fold_odd(FunctionId::Sinh, u[0]),
    derivative: |pool, u, _| pool.call(FunctionId::Cosh, u),
    rule: Rule::Series(RECURRENCE),
};
