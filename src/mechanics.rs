//! From a law to equations of motion: one file per arrow, all of it symbolic.
//!
//! In: a [`Model`]. Out: [`Equations`]: accelerations (or q̇ and ṗ), momenta, energy and the law
//! of its change, what is conserved and why. Never here: numbers in motion.

mod attitude;
mod bracket;
mod conservation;
mod constrain;
mod dimension;
mod domain;
mod equations;
mod frames;
mod hamilton;
mod invariants;
mod lagrange;
mod legendre;
mod linear;
mod modulo;
mod observe;
mod poisson;
mod poisson_structure;
mod rigid_body;
mod sampling;
mod symmetry;
mod vakonomic;

use crate::expr::NODE_LIMIT;
use crate::model::{Mechanics, Model};

pub use bracket::{ChainRule, Recognised, bracket, in_phase_space, rate_by_bracket, recognise};
pub use conservation::{Class, Classed, class_of, classes};
pub use constrain::with_reactions;
pub use domain::widened;
pub use equations::{
    Auxiliary, AuxiliaryRates, Conserved, ConstraintRow, CoordinateSymbols, Equations, Flow,
    NoClosedForm, Reason, Separable, Supplements, Vakonomic,
};
pub use frames::Apparent;
pub use invariants::casimir_rate;
pub use legendre::{hamiltonian_to_lagrangian, lagrangian_to_hamiltonian};
pub use poisson_structure::{StructureError, flaws};
pub use rigid_body::{
    COMPONENTS, RigidBody, Tensor, body_constants, body_values, matrix, principal,
};
pub use sampling::{POINTS, Point, TRIES};

/// The most pieces a solved or transformed expression may have and still be worth writing down.
pub const CLOSED_FORM_LIMIT: u64 = 10_000;

/// Derives everything that follows from a model's law of motion.
///
/// # Errors
/// Where the derivation grows beyond [`crate::expr::NODE_LIMIT`] nodes.
pub fn derive(model: &Model) -> Result<Equations, NoClosedForm> {
    let mut pool = model.pool.clone();
    let constraints = model.constraints.iter().map(|c| c.expression);
    let given = [model.mechanics.function().1, model.mechanics.dissipation()];
    let given = given.into_iter().chain(model.mechanics.forces().to_vec()).chain(constraints);
    given.for_each(|e| pool.refuse_heavy(e));
    if pool.is_full() {
        return Err(too_large());
    }
    let mut equations = match &model.mechanics {
        Mechanics::Lagrangian { lagrangian, dissipation, forces } => {
            lagrange::equations(&mut pool, model, *lagrangian, *dissipation, forces)
        }
        Mechanics::Hamiltonian { hamiltonian, forces } => {
            hamilton::equations(&mut pool, model, *hamiltonian, forces)
        }
        Mechanics::Poisson { hamiltonian, brackets, forces, .. } => {
            poisson::equations(&mut pool, model, *hamiltonian, brackets, forces)
        }
    };
    equations.supplements.body =
        model.body.as_ref().map(|body| rigid_body::compose(&mut pool, body));
    equations.pool = pool;
    attitude::find(&mut equations, model);
    equations.supplements.frames = frames::find(model, &mut equations);
    if let Some(comparison) = &model.comparison {
        equations.supplements.vakonomic =
            Some(vakonomic::vakonomic(&mut equations, model, comparison));
    }
    if !equations.supplements.auxiliary.is_empty() {
        let why = "numbers are carried along that do not follow from H";
        equations.separable = Err(NoClosedForm(why.to_owned()));
    }
    invariants::find(&mut equations, model);
    if equations.pool.is_full() || longest(&equations) > NODE_LIMIT as u64 {
        return Err(too_large());
    }
    Ok(equations)
}

fn too_large() -> NoClosedForm {
    NoClosedForm(format!("what follows from this law grows beyond {NODE_LIMIT} nodes"))
}

/// The pieces of the longest expression derived, written out.
fn longest(equations: &Equations) -> u64 {
    let (first, second) = match &equations.flow {
        Flow::Lagrange { mass, force, .. } => (mass.concat(), force),
        Flow::Hamilton { velocities, momentum_rates } => (velocities.clone(), momentum_rates),
        Flow::Poisson { rates } => (Vec::new(), rates),
    };
    let others = [equations.energy, equations.energy_rate, equations.action_rate];
    let all = first.iter().chain(second).chain(&equations.momenta).chain(&others);
    all.map(|&e| equations.pool.weight(e)).max().unwrap_or(0)
}
