//! The inverse sine.

use super::recurrence::{
    BilinearEquation, COMPANION, Convolution, Divisor, FIRST, Recurrence, VALUE,
};
use super::{Function, FunctionId, Rule};
use crate::expr::{Expr, Pool};
use crate::num::{Analytic, Number, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    (u[0].asin(), cosine_of(u[0]))
}

/// `1/√(1 − u²)`.
pub(super) fn slope(pool: &mut Pool, u: Expr) -> Expr {
    let square = pool.powi(u, 2);
    let under = pool.linear(Number::ONE, &[(Number::MINUS_ONE, square)]);
    pool.monomial(Number::ONE, &[(under, -Number::HALF)])
}

/// `√(1 − u²)`.
pub(super) fn cosine_of<R: Analytic>(u: R) -> R {
    ((R::ONE - u) * (R::ONE + u)).sqrt()
}

/// w = √(1 − u²): w² = 1 − u².
pub(super) const COSINE: BilinearEquation = BilinearEquation {
    sums: &[Convolution::of(-1.0, FIRST, FIRST), Convolution::of(-1.0, COMPANION, COMPANION)],
    divisor: Divisor::Twice(COMPANION),
    ..BilinearEquation::NONE
};

/// y = arcsin u, w = √(1 − u²): y′ w = u′.
const RECURRENCE: Recurrence = Recurrence {
    companion_first: false,
    value: BilinearEquation::slope(
        1.0,
        FIRST,
        &[Convolution::of_slope(-1.0, VALUE, COMPANION)],
        COMPANION,
    ),
    companion: Some(COSINE),
};

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Asin,
    name: "asin",
    unicode: "arcsin",
    latex: "\\arcsin",
    arity: 1,
    value: |u| math::asin(u[0]),
    fold: |pool, u| pool.fold_odd(FunctionId::Asin, u[0]),
    derivative: |pool, u, _| slope(pool, u[0]),
    rule: Rule::Series(RECURRENCE),
};
