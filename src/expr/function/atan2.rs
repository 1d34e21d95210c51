//! The angle of a point: `atan2(y, x)`, in (−π, π].

use super::recurrence::{
    BilinearEquation, COMPANION, Convolution, Divisor, FIRST, Recurrence, SECOND, VALUE,
};
use super::{Function, FunctionId, Rule};
use crate::num::{Analytic, Number, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    (u[0].atan2(u[1]), u[1] * u[1] + u[0] * u[0])
}

/// θ = atan2(y, x), w = x² + y²: θ′ w = x y′ − y x′.
const RECURRENCE: Recurrence = Recurrence {
    companion_first: true,
    value: BilinearEquation {
        sums: &[
            Convolution::of_slope(1.0, FIRST, SECOND),
            Convolution::of_slope(-1.0, SECOND, FIRST),
            Convolution::of_slope(-1.0, VALUE, COMPANION),
        ],
        divisor: Divisor::OrderTimes(COMPANION),
        ..BilinearEquation::NONE
    },
    companion: Some(BilinearEquation::sum(&[
        Convolution::of(1.0, SECOND, SECOND),
        Convolution::of(1.0, FIRST, FIRST),
    ])),
};

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Atan2,
    name: "atan2",
    unicode: "atan2",
    latex: "\\operatorname{atan2}",
    arity: 2,
    value: |u| math::atan2(u[0], u[1]),
    fold: |_, _| None,
    // ∂/∂y = x/(x² + y²), ∂/∂x = −y/(x² + y²)
    derivative: |pool, u, i| {
        let squares = [pool.powi(u[0], 2), pool.powi(u[1], 2)];
        let radius = pool.sum(&squares);
        let sign = if i == 0 { Number::ONE } else { Number::MINUS_ONE };
        pool.monomial(sign, &[(u[1 - i], Number::ONE), (radius, Number::MINUS_ONE)])
    },
    rule: Rule::Series(RECURRENCE),
};
