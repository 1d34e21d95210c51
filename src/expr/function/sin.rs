//! The sine.

use super::series::chain;
use super::{Function, FunctionId, Rule, exact_sine};
use crate::num::{DoubleDouble, ExtendedRange, Real, Recurrence, math};

/// y = sin u, w = cos u: y′ = w u′, w′ = −y u′.
fn rule<R: Real>(k: usize, u: &[&[R]], y: &mut [R], w: &mut [R]) {
    if k == 0 {
        (y[0], w[0]) = u[0][0].sin_cos();
    } else {
        y[k] = chain(k, u[0], w) / k as f64;
        w[k] = -chain(k, u[0], y) / k as f64;
    }
}

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Sin,
    name: "sin",
    unicode: "sin",
    latex: "\\sin",
    arity: 1,
    value: |u| math::sin(u[0]),
    fold: |pool, u| {
        if let Some(exact) = pool.turns(u[0]).and_then(exact_sine) {
            return Some(pool.number(exact));
        }
        pool.fold_odd(FunctionId::Sin, u[0])
    },
    derivative: |pool, u, _| pool.call(FunctionId::Cos, u),
    rule: Rule::Series(Recurrence {
        single: rule::<f64>,
        double: rule::<DoubleDouble>,
        wide: rule::<ExtendedRange>,
    }),
};
