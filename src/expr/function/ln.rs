//! The natural logarithm.

use super::series::known;
use super::{Function, FunctionId, Rule};
use crate::expr::{Expr, Node};
use crate::num::{DoubleDouble, ExtendedRange, Real, Recurrence, math};

/// y = ln u: y′ u = u′.
fn rule<R: Real>(k: usize, u: &[&[R]], y: &mut [R], _: &mut [R]) {
    let u = u[0];
    y[k] = if k == 0 { u[0].ln() } else { (u[k] * k as f64 - known(k, y, u)) / (u[0] * k as f64) };
}

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
    rule: Rule::Series(Recurrence {
        single: rule::<f64>,
        double: rule::<DoubleDouble>,
        wide: rule::<ExtendedRange>,
    }),
};
