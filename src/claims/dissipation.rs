//! Rayleigh functions that feed energy where they should take it.
//!
//! In: a model. Out: a warning. Never here: what is dissipated along a motion.

use std::collections::HashMap;

use crate::diagnostic::Diagnostic;
use crate::expr::{Expr, Zero};
use crate::model::Model;

/// Warns of a dissipation function F that changes its sign with the velocities. So does its power, −Σ q̇ ∂F/∂q̇, which
/// then takes energy from a motion and feeds it to the reverse one.
pub(super) fn odd(model: &Model) -> Option<Diagnostic> {
    let function = model.mechanics.dissipation();
    let velocities: Vec<_> = model.coordinates.iter().map(|c| c.velocity).collect();
    if function == Expr::ZERO || !model.pool.depends_on_any(function, &velocities) {
        return None;
    }
    let mut pool = model.pool.clone();
    let reversed: HashMap<_, _> = velocities
        .into_iter()
        .map(|velocity| {
            let forward = pool.variable(velocity);
            (velocity, pool.neg(forward))
        })
        .collect();
    let backward = pool.substitute(function, &reversed);
    let sum = pool.add(function, backward);
    if !matches!(pool.is_zero(sum), Zero::Proved) {
        return None;
    }
    let message = "the dissipation function is odd in the velocities: it feeds energy to motions in one direction";
    let warning = Diagnostic::warning(model.law_place.clone(), message.to_owned());
    Some(warning.with_help("friction −c |v| v has F = c |v|³/3, which is even"))
}
