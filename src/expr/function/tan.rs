//! The tangent.

use super::series::{chain, product};
use super::{Function, FunctionId, Rule};
use crate::num::{DoubleDouble, ExtendedRange, Number, Real, Recurrence, math};

/// y = tan u, w = 1 + y²: y′ = w u′.
fn rule<R: Real>(k: usize, u: &[&[R]], y: &mut [R], w: &mut [R]) {
    if k == 0 {
        y[0] = u[0][0].tan();
        w[0] = R::ONE + y[0] * y[0];
    } else {
        y[k] = chain(k, u[0], w) / k as f64;
        w[k] = product(k, y, y);
    }
}

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Tan,
    name: "tan",
    unicode: "tan",
    latex: "\\tan",
    arity: 1,
    value: |u| math::tan(u[0]),
    fold: |pool, u| pool.fold_odd(FunctionId::Tan, u[0]),
    derivative: |pool, u, _| {
        let tangent = pool.call(FunctionId::Tan, u);
        let square = pool.powi(tangent, 2);
        pool.linear(Number::ONE, &[(Number::ONE, square)])
    },
    rule: Rule::Series(Recurrence {
        single: rule::<f64>,
        double: rule::<DoubleDouble>,
        wide: rule::<ExtendedRange>,
    }),
};
