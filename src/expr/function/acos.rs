//! The inverse cosine.

use super::asin::{COSINE, cosine_of, slope};
use super::recurrence::{BilinearEquation, COMPANION, Convolution, FIRST, Recurrence, VALUE};
use super::{Function, FunctionId, Rule};
use crate::expr::Expr;
use crate::num::{Analytic, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    (u[0].acos(), cosine_of(u[0]))
}

/// y = arccos u, w = √(1 − u²): y′ w = −u′.
const RECURRENCE: Recurrence = Recurrence {
    companion_first: false,
    value: BilinearEquation::slope(
        -1.0,
        FIRST,
        &[Convolution::of_slope(-1.0, VALUE, COMPANION)],
        COMPANION,
    ),
    companion: Some(COSINE),
};

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Acos,
    name: "acos",
    unicode: "arccos",
    latex: "\\arccos",
    arity: 1,
    value: |u| math::acos(u[0]),
    fold: |_, u| (u[0] == Expr::ONE).then_some(Expr::ZERO),
    derivative: |pool, u, _| {
        let slope = slope(pool, u[0]);
        pool.neg(slope)
    },
    rule: Rule::Series(RECURRENCE),
};
