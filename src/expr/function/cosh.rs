//! The hyperbolic cosine.

use super::series::chain;
use super::{Function, FunctionId, Rule};
use crate::expr::Expr;
use crate::num::{DoubleDouble, ExtendedRange, Real, Recurrence, math};

/// y = cosh u, w = sinh u: y′ = w u′, w′ = y u′.
fn rule<R: Real>(k: usize, u: &[&[R]], y: &mut [R], w: &mut [R]) {
    if k == 0 {
        (w[0], y[0]) = u[0][0].sinh_cosh();
    } else {
        y[k] = chain(k, u[0], w) / k as f64;
        w[k] = chain(k, u[0], y) / k as f64;
    }
}

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Cosh,
    name: "cosh",
    unicode: "cosh",
    latex: "\\cosh",
    arity: 1,
    value: |u| math::cosh(u[0]),
    fold: |pool, u| {
        if u[0] == Expr::ZERO {
            return Some(Expr::ONE);
        }
        pool.fold_even(FunctionId::Cosh, u[0])
    },
    derivative: |pool, u, _| pool.call(FunctionId::Sinh, u),
    rule: Rule::Series(Recurrence {
        single: rule::<f64>,
        double: rule::<DoubleDouble>,
        wide: rule::<ExtendedRange>,
    }),
};
