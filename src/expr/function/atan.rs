//! The inverse tangent.

use super::series::{known, product};
use super::{Function, FunctionId, Rule};
use crate::num::{DoubleDouble, ExtendedRange, Number, Real, Recurrence, math};

/// y = arctan u, w = 1 + u²: y′ w = u′.
fn rule<R: Real>(k: usize, u: &[&[R]], y: &mut [R], w: &mut [R]) {
    let u = u[0];
    if k == 0 {
        y[0] = u[0].atan2(R::ONE);
        w[0] = R::ONE + u[0] * u[0];
    } else {
        w[k] = product(k, u, u);
        y[k] = (u[k] * k as f64 - known(k, y, w)) / (w[0] * k as f64);
    }
}

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Atan,
    name: "atan",
    unicode: "arctan",
    latex: "\\arctan",
    arity: 1,
    value: |u| math::atan(u[0]),
    fold: |pool, u| pool.fold_odd(FunctionId::Atan, u[0]),
    derivative: |pool, u, _| {
        let square = pool.powi(u[0], 2);
        let under = pool.linear(Number::ONE, &[(Number::ONE, square)]);
        pool.powi(under, -1)
    },
    rule: Rule::Series(Recurrence {
        single: rule::<f64>,
        double: rule::<DoubleDouble>,
        wide: rule::<ExtendedRange>,
    }),
};
