//! The inverse sine.

use super::series::{known, product};
use super::{Function, FunctionId, Rule};
use crate::expr::{Expr, Pool};
use crate::num::{DoubleDouble, ExtendedRange, Number, Real, Recurrence, math};

/// `1/√(1 − u²)`.
pub(super) fn slope(pool: &mut Pool, u: Expr) -> Expr {
    let square = pool.powi(u, 2);
    let under = pool.linear(Number::ONE, &[(Number::MINUS_ONE, square)]);
    pool.monomial(Number::ONE, &[(under, -Number::HALF)])
}

/// Sets `y[k]`, `w[k]` for w = √(1 − u²) and y′ w = ±u′, once `y[0]` is set.
pub(super) fn advance<R: Real>(k: usize, u: &[R], y: &mut [R], w: &mut [R], sign: f64) {
    if k == 0 {
        w[0] = ((R::ONE - u[0]) * (R::ONE + u[0])).sqrt();
        return;
    }
    y[k] = (u[k] * (sign * k as f64) - known(k, y, w)) / (w[0] * k as f64);
    let inner = (1..k).fold(R::ZERO, |sum, j| sum + w[j] * w[k - j]);
    w[k] = -(product(k, u, u) + inner) / (w[0] * 2.0);
}

/// y = arcsin u, w = √(1 − u²): y′ w = u′.
fn rule<R: Real>(k: usize, u: &[&[R]], y: &mut [R], w: &mut [R]) {
    if k == 0 {
        y[0] = u[0][0].asin();
    }
    advance(k, u[0], y, w, 1.0);
}

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Asin,
    name: "asin",
    unicode: "arcsin",
    latex: "\\arcsin",
    arity: 1,
    value: |u| math::asin(u[0]),
    fold: |pool, u| pool.fold_odd(FunctionId::Asin, u[0]),
    derivative: |pool, u, _| slope(pool, u[0]),
    rule: Rule::Series(Recurrence {
        single: rule::<f64>,
        double: rule::<DoubleDouble>,
        wide: rule::<ExtendedRange>,
    }),
};
