//! The hyperbolic tangent.

use super::series::{chain, product};
use super::{Function, FunctionId, Rule};
use crate::num::{DoubleDouble, ExtendedRange, Number, Real, Recurrence, math};

/// y = tanh u, w = 1 − y² = 1/cosh² u: y′ = w u′.
fn rule<R: Real>(k: usize, u: &[&[R]], y: &mut [R], w: &mut [R]) {
    if k == 0 {
        y[0] = u[0][0].tanh();
        let inverse = R::ONE / u[0][0].sinh_cosh().1;
        w[0] = inverse * inverse;
    } else {
        y[k] = chain(k, u[0], w) / k as f64;
        w[k] = -product(k, y, y);
    }
}

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Tanh,
    name: "tanh",
    unicode: "tanh",
    latex: "\\tanh",
    arity: 1,
    value: |u| math::tanh(u[0]),
    fold: |pool, u| pool.fold_odd(FunctionId::Tanh, u[0]),
    derivative: |pool, u, _| {
        let tangent = pool.call(FunctionId::Tanh, u);
        let square = pool.powi(tangent, 2);
        pool.linear(Number::ONE, &[(Number::MINUS_ONE, square)])
    },
    rule: Rule::Series(Recurrence {
        single: rule::<f64>,
        double: rule::<DoubleDouble>,
        wide: rule::<ExtendedRange>,
    }),
};
