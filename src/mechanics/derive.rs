//! The derivation of the equations from a law, step by step.
//!
//! In: a [`Model`]. Out: [`Equations`]. Never here: the individual steps.

use std::sync::Arc;

use super::attitude;
use super::equations::{Equations, Flow, NamedRamps, NoClosedForm};
use super::frames;
use super::group;
use super::hamilton;
use super::hamilton_jacobi;
use super::invariants;
use super::lagrange;
use super::named_ramps;
use super::poisson;
use super::rigid_body;
use super::vakonomic;
use crate::expr::{NODE_LIMIT, Symbol};
use crate::model::{Mechanics, Model};
use crate::num::Number;

/// Derives everything that follows from a model's law of motion.
///
/// # Errors
/// Returns an error if the derivation grows beyond [`crate::expr::NODE_LIMIT`] nodes.
pub fn derive(model: &Model) -> Result<Equations, NoClosedForm> {
    let mut equations = derive_for_motion(model)?;
    equations.find_closed_forms();
    Ok(equations)
}

/// Derives what a motion needs and what is conserved. The closed forms that take elimination are
/// found when they are asked for: [`Equations::find_closed_forms`].
///
/// # Errors
/// Returns an error if the derivation grows beyond [`crate::expr::NODE_LIMIT`] nodes.
pub fn derive_for_motion(model: &Model) -> Result<Equations, NoClosedForm> {
    let mut equations = derive_once(model)?;
    equations.supplements.law_with_ramps_named = named_ramps::model(model).map(Arc::new);
    Ok(equations)
}

impl Equations {
    /// Derives the law with its ramps by name, once. It only reads better: where it grows beyond the limit it is left out, and
    /// where the work is cancelled it remains to be done.
    pub(super) fn find_named_ramps(&mut self) {
        let Some(model) = &self.supplements.law_with_ramps_named else { return };
        let mut model = Model::clone(model);
        model.pool.set_cancel(self.pool.cancel().clone());
        let derived = derive_once(&model);
        if self.pool.cancel().is_cancelled() {
            return;
        }
        self.supplements.law_with_ramps_named = None;
        self.supplements.named_ramps = derived.ok().map(|derived| {
            let mut named = NamedRamps::of(model, derived, &self.conserved);
            named.equations.find_closed_forms();
            Arc::new(named)
        });
    }
}

fn derive_once(model: &Model) -> Result<Equations, NoClosedForm> {
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
    equations.supplements.constants = exact_constants(model, &equations);
    attitude::find(&mut equations, model);
    equations.supplements.frames = frames::find(model, &mut equations);
    if let Some(comparison) = &model.comparison {
        equations.supplements.vakonomic =
            Some(vakonomic::vakonomic(&mut equations, model, comparison));
    }
    group::find(&mut equations, model);
    hamilton_jacobi::find(&mut equations, model);
    equations.find_holonomy();
    invariants::find(&mut equations, model);
    if equations.pool.is_full() || longest(&equations) > NODE_LIMIT as u64 {
        return Err(too_large());
    }
    Ok(equations)
}

/// The parameters and what follows from a body, with their values as exact numbers.
pub fn exact_constants(model: &Model, equations: &Equations) -> Vec<(Symbol, Number)> {
    let values = model.parameter_values();
    let body = equations.supplements.body.as_ref();
    let body = rigid_body::body_values(model, &equations.pool, body, &values);
    let own = model.parameters.iter().map(|p| p.symbol).zip(values);
    own.chain(body).map(|(s, x)| (s, Number::Real(x).canonical())).collect()
}

pub(super) fn too_large() -> NoClosedForm {
    NoClosedForm(format!("what follows from this law grows beyond {NODE_LIMIT} nodes"))
}

/// The written-out size of the longest derived expression.
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
