//! The exponential.

use super::series::chain;
use super::{Function, FunctionId, Rule};
use crate::expr::Expr;
use crate::num::{DoubleDouble, ExtendedRange, Real, Recurrence, math};

/// y = exp u: y′ = y u′.
fn rule<R: Real>(k: usize, u: &[&[R]], y: &mut [R], _: &mut [R]) {
    y[k] = if k == 0 { u[0][0].exp() } else { chain(k, u[0], y) / k as f64 };
}

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Exp,
    name: "exp",
    unicode: "exp",
    latex: "\\exp",
    arity: 1,
    value: |u| math::exp(u[0]),
    fold: |_, u| (u[0] == Expr::ZERO).then_some(Expr::ONE),
    derivative: |pool, u, _| pool.call(FunctionId::Exp, u),
    rule: Rule::Series(Recurrence {
        single: rule::<f64>,
        double: rule::<DoubleDouble>,
        wide: rule::<ExtendedRange>,
    }),
};
