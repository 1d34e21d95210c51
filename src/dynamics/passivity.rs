//! Whether a law of motion ever adds energy.
//!
//! In: equations, the values of the parameters. Out: whether the form of dE/dt shows that it is positive nowhere. Never here: a motion.

use std::collections::HashMap;

use crate::expr::is_never_negative;
use crate::mechanics::Equations;
use crate::model::Model;
use crate::num::Number;

/// Whether the form of dE/dt at these parameters shows that the energy grows at no state; `false` where it does not show it.
pub(super) fn never_adds_energy(model: &Model, equations: &Equations, parameters: &[f64]) -> bool {
    let mut pool = equations.pool.clone();
    let values: HashMap<_, _> = model
        .parameters
        .iter()
        .zip(parameters)
        .map(|(parameter, &value)| (parameter.symbol, pool.number(Number::Real(value).canonical())))
        .collect();
    let rate = pool.substitute(equations.energy_rate, &values);
    let loss = pool.neg(rate);
    is_never_negative(&pool, loss)
}
