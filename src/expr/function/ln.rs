//! The natural logarithm.

use super::recurrence::{BilinearEquation, Convolution, FIRST, Recurrence, VALUE};
use super::{Function, FunctionId, Rule};
use crate::expr::{Expr, Node};
use crate::num::{Analytic, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    (u[0].ln(), R::ZERO)
}

/// y = ln u: y′ u = u′.
const RECURRENCE: Recurrence = Recurrence {
    companion_first: false,
    value: BilinearEquation::slope(1.0, FIRST, &[Convolution::of_slope(-1.0, VALUE, FIRST)], FIRST),
    companion: None,
};

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Ln,
    name: "ln",
    unicode: "ln",
    latex: "\\ln",
    arity: 1,
    value: |u| math::ln(u[0]),
    fold: |pool, u| match pool.node(u[0]) {
        Node::Call(FunctionId::Exp, inner) => Some(inner[0]),
        _ => (u[0] == Expr::ONE).then_some(Expr::ZERO),
    },
    derivative: |pool, u, _| pool.powi(u[0], -1),
    rule: Rule::Series(RECURRENCE),
};
