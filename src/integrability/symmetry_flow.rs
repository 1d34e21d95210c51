//! The flow of a symmetry of the equations of motion on states: each motion becomes another one, seen at the same time.
//!
//! In: a model with its equations, a change t → t + ε ξ, q → q + ε η, a time. Out: a model whose variables are q and q̇,
//! and whose time is ε: dq/dε = Q and dq̇/dε = D Q with the characteristic Q = η − ξ q̇ and D along the motion, while t
//! stands still. Never here: how far the flow is followed.
//! Source: P. J. Olver, *Applications of Lie Groups to Differential Equations*, § 5.1.

use std::collections::HashMap;

use super::explicit_motion::accelerations;
use super::units::Unsupported;
use crate::expr::{Expr, Symbol};
use crate::mechanics::{Equations, derive_for_motion};
use crate::model::{Coordinate, Mechanics, Model};
use crate::num::Number;

/// A model that moves along the flow of a symmetry: its variables are the coordinates, then their velocities.
///
/// # Errors
/// Returns an error if the accelerations are needed and not known in closed form, or the flow grows too large.
pub fn symmetry_flow(
    model: &Model,
    equations: &mut Equations,
    (time_change, changes): (Expr, &[Expr]),
    time: f64,
) -> Result<(Model, Equations), Unsupported> {
    let symbols = equations.coordinates.clone();
    // with ξ = 0 nothing depends on the accelerations
    let accelerations = if time_change == Expr::ZERO {
        vec![Expr::ZERO; symbols.len()]
    } else {
        accelerations(equations)?
    };
    let pool = &mut equations.pool;
    let mut along = vec![(equations.symbols.time, Expr::ONE)];
    let mut rates = Vec::new();
    for ((c, &change), acceleration) in symbols.iter().zip(changes).zip(accelerations) {
        let velocity = pool.variable(c.velocity);
        let carried = pool.mul(time_change, velocity);
        rates.push(pool.sub(change, carried));
        along.extend([(c.position, velocity), (c.velocity, acceleration)]);
    }
    let second: Vec<Expr> = rates.iter().map(|&rate| pool.derivation(rate, &along)).collect();
    rates.extend(second);
    let mut moved = Model::new(&model.info.title);
    (moved.pool, moved.symbols) = (pool.clone(), model.symbols);
    moved.parameters.clone_from(&model.parameters);
    moved.body.clone_from(&model.body);
    let mut put: HashMap<Symbol, Expr> = HashMap::new();
    for c in &model.coordinates {
        let variable = Coordinate::variable(&mut moved.pool, &c.name, &c.shown, "");
        put.insert(c.position, moved.pool.variable(variable.position));
        moved.coordinates.push(variable);
    }
    for c in &model.coordinates {
        let name = format!("velocity of {}", c.name);
        let variable = Coordinate::variable(&mut moved.pool, &name, "", "");
        put.insert(c.velocity, moved.pool.variable(variable.position));
        moved.coordinates.push(variable);
    }
    put.insert(equations.symbols.time, moved.pool.number(Number::Real(time).canonical()));
    let forces = rates.into_iter().map(|rate| moved.pool.substitute(rate, &put)).collect();
    let size = moved.coordinates.len();
    moved.mechanics = Mechanics::Poisson {
        hamiltonian: Expr::ZERO,
        brackets: vec![vec![Expr::ZERO; size]; size],
        casimirs: Vec::new(),
        forces,
        place: 0..0,
    };
    let follow = derive_for_motion(&moved).map_err(|why| Unsupported(why.0))?;
    Ok((moved, follow))
}
