//! The exponential.

use super::recurrence::{BilinearEquation, Convolution, FIRST, Recurrence, VALUE};
use super::{Function, FunctionId, Rule};
use crate::expr::Expr;
use crate::num::{Analytic, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    (u[0].exp(), R::ZERO)
}

/// y = exp u: y′ = y u′.
const RECURRENCE: Recurrence = Recurrence {
    companion_first: false,
    value: BilinearEquation::over_order(&[Convolution::of_slope(1.0, FIRST, VALUE)]),
    companion: None,
};

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Exp,
    name: "exp",
    unicode: "exp",
    latex: "\\exp",
    arity: 1,
    value: |u| math::exp(u[0]),
    fold: |_, u| (u[0] == Expr::ZERO).then_some(Expr::ONE),
    derivative: |pool, u, _| pool.call(FunctionId::Exp, u),
    rule: Rule::Series(RECURRENCE),
};
