//! The inverse cosine.

use super::asin::{advance, slope};
use super::{Function, FunctionId, Rule};
use crate::expr::Expr;
use crate::num::{DoubleDouble, ExtendedRange, Real, Recurrence, math};

/// y = arccos u, w = √(1 − u²): y′ w = −u′.
fn rule<R: Real>(k: usize, u: &[&[R]], y: &mut [R], w: &mut [R]) {
    if k == 0 {
        y[0] = u[0][0].acos();
    }
    advance(k, u[0], y, w, -1.0);
}

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Acos,
    name: "acos",
    unicode: "arccos",
    latex: "\\arccos",
    arity: 1,
    value: |u| math::acos(u[0]),
    fold: |_, u| (u[0] == Expr::ONE).then_some(Expr::ZERO),
    derivative: |pool, u, _| {
        let slope = slope(pool, u[0]);
        pool.neg(slope)
    },
    rule: Rule::Series(Recurrence {
        single: rule::<f64>,
        double: rule::<DoubleDouble>,
        wide: rule::<ExtendedRange>,
    }),
};
