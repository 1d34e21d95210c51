//! The hyperbolic cosine.

use super::sinh::RECURRENCE;
use super::{Function, FunctionId, Rule};
use crate::expr::Expr;
use crate::num::{Analytic, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    let (sinh, cosh) = u[0].sinh_cosh();
    (cosh, sinh)
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
    rule: Rule::Series(RECURRENCE),
};
