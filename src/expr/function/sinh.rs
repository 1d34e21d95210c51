//! The hyperbolic sine.

use super::series::chain;
use super::{Function, FunctionId, Rule};
use crate::num::{DoubleDouble, ExtendedRange, Real, Recurrence, math};

/// y = sinh u, w = cosh u: y′ = w u′, w′ = y u′.
fn rule<R: Real>(k: usize, u: &[&[R]], y: &mut [R], w: &mut [R]) {
    if k == 0 {
        (y[0], w[0]) = u[0][0].sinh_cosh();
    } else {
        y[k] = chain(k, u[0], w) / k as f64;
        w[k] = chain(k, u[0], y) / k as f64;
    }
}

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Sinh,
    name: "sinh",
    unicode: "sinh",
    latex: "\\sinh",
    arity: 1,
    value: |u| math::sinh(u[0]),
    fold: |pool, u| pool.fold_odd(FunctionId::Sinh, u[0]),
    derivative: |pool, u, _| pool.call(FunctionId::Cosh, u),
    rule: Rule::Series(Recurrence {
        single: rule::<f64>,
        double: rule::<DoubleDouble>,
        wide: rule::<ExtendedRange>,
    }),
};
