//! The cosine.

use super::series::chain;
use super::{Function, FunctionId, Rule, exact_sine};
use crate::num::{DoubleDouble, ExtendedRange, Number, Real, Recurrence, math};

/// y = cos u, w = sin u: y′ = −w u′, w′ = y u′.
fn rule<R: Real>(k: usize, u: &[&[R]], y: &mut [R], w: &mut [R]) {
    if k == 0 {
        (w[0], y[0]) = u[0][0].sin_cos();
    } else {
        y[k] = -chain(k, u[0], w) / k as f64;
        w[k] = chain(k, u[0], y) / k as f64;
    }
}

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Cos,
    name: "cos",
    unicode: "cos",
    latex: "\\cos",
    arity: 1,
    value: |u| math::cos(u[0]),
    fold: |pool, u| {
        if let Some(exact) = pool.turns(u[0]).and_then(|r| exact_sine(r + Number::HALF)) {
            return Some(pool.number(exact));
        }
        pool.fold_even(FunctionId::Cos, u[0])
    },
    derivative: |pool, u, _| {
        let sine = pool.call(FunctionId::Sin, u);
        pool.neg(sine)
    },
    rule: Rule::Series(Recurrence {
        single: rule::<f64>,
        double: rule::<DoubleDouble>,
        wide: rule::<ExtendedRange>,
    }),
};
