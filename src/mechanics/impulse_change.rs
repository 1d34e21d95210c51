//! Which quantities an impulse may change.
//!
//! In: a model with impulses, a quantity. Out: whether it may jump. Never here: by how much.

use super::equations::Equations;
use crate::expr::{Expr, Symbol};
use crate::model::Model;

/// Returns whether an impulse of the file may change a quantity. An impulse on one momentum changes every velocity that
/// the kinetic energy couples to it, and under constraints, whose reactions are impulses too, all of them.
pub fn is_changed_by_impulse(equations: &mut Equations, model: &Model, quantity: Expr) -> bool {
    let n = equations.coordinates.len();
    let changed: Vec<bool> = (0..n)
        .map(|i| model.impulses.iter().any(|impulse| impulse.change[i] != Expr::ZERO))
        .collect();
    if !changed.contains(&true) {
        return false;
    }
    let energy = equations.symbols.energy;
    if model.is_poisson() {
        let variables = equations.coordinates.iter().map(|c| c.position);
        let moved: Vec<Symbol> =
            variables.zip(&changed).filter(|(_, changed)| **changed).map(|(s, _)| s).collect();
        return equations.pool.depends_on_any(quantity, &moved)
            || equations.pool.depends(quantity, energy);
    }
    let constrained = !model.constraints.is_empty();
    let quantity = if equations.is_lagrangian() { quantity } else { equations.open(quantity) };
    if !constrained && (0..n).any(|i| !changed[i] && equations.momenta[i] == quantity) {
        return false;
    }
    // the velocities that the kinetic energy couples to a momentum that an impulse changes
    let mut coupled = changed.clone();
    let depends = |i: usize, j: usize| {
        equations.pool.depends(equations.momenta[i], equations.coordinates[j].velocity)
    };
    loop {
        let more: Vec<usize> = (0..n)
            .filter(|&j| {
                !coupled[j] && (0..n).any(|i| coupled[i] && (depends(i, j) || depends(j, i)))
            })
            .collect();
        if more.is_empty() {
            break;
        }
        for j in more {
            coupled[j] = true;
        }
    }
    let mut moved = vec![energy];
    for (i, c) in equations.coordinates.iter().enumerate() {
        if changed[i] || constrained {
            moved.push(c.momentum);
        }
        if coupled[i] || constrained {
            moved.extend([c.velocity, c.acceleration]);
        }
    }
    equations.pool.depends_on_any(quantity, &moved)
}
