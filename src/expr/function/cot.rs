//! The cotangent.

use super::series::{chain, product};
use super::{Function, FunctionId, Rule};
use crate::expr::Expr;
use crate::num::{DoubleDouble, ExtendedRange, Number, Real, Recurrence, math};

/// y = cot u, w = 1 + y²: y′ = −w u′.
fn rule<R: Real>(k: usize, u: &[&[R]], y: &mut [R], w: &mut [R]) {
    if k == 0 {
        y[0] = R::ONE / u[0][0].tan();
        w[0] = R::ONE + y[0] * y[0];
    } else {
        y[k] = -chain(k, u[0], w) / k as f64;
        w[k] = product(k, y, y);
    }
}

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
    rule: Rule::Series(Recurrence {
        single: rule::<f64>,
        double: rule::<DoubleDouble>,
        wide: rule::<ExtendedRange>,
    }),
};
