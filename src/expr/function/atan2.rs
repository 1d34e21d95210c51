//! The angle of a point: `atan2(y, x)`, in (−π, π].

use super::series::{chain, known, product};
use super::{Function, FunctionId, Rule};
use crate::num::{DoubleDouble, ExtendedRange, Number, Real, Recurrence, math};

/// θ = atan2(y, x), w = x² + y²: θ′ w = x y′ − y x′.
fn rule<R: Real>(k: usize, u: &[&[R]], y: &mut [R], w: &mut [R]) {
    let (ordinate, abscissa) = (u[0], u[1]);
    w[k] = product(k, abscissa, abscissa) + product(k, ordinate, ordinate);
    y[k] = if k == 0 {
        ordinate[0].atan2(abscissa[0])
    } else {
        let torque = chain(k, ordinate, abscissa) - chain(k, abscissa, ordinate);
        (torque - known(k, y, w)) / (w[0] * k as f64)
    };
}

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
    rule: Rule::Series(Recurrence {
        single: rule::<f64>,
        double: rule::<DoubleDouble>,
        wide: rule::<ExtendedRange>,
    }),
};
