//! The flow of a generator: dq/dε = ∂G/∂p, dp/dε = −∂G/∂q, in place of the motion.
//!
//! In: a model with its equations, and G. Out: a model whose law is G and whose states, velocities
//! and energy are still those of the first one, so that H is seen to change or not along the flow.
//! Never here: how far the flow is followed.
//! Source: *The Principles of Dynamics*, §§ 3.3.2, 3.4.

use std::collections::HashMap;

use super::bracket::{bracket, in_phase_space};
use super::derive::derive_for_motion;
use super::equations::{Conserved, Equations, NoClosedForm, Reason};
use crate::expr::{Expr, Zero};
use crate::model::{Mechanics, Model, Observable, WrittenExpr};
use crate::num::Number;

/// A model that moves along the flow of a generator.
#[derive(Clone, Debug)]
pub struct GeneratorFlow {
    /// The model, whose law is G; its time is ε, from 0.
    pub model: Model,
    /// Those of the law G.
    pub equations: Equations,
    /// The columns, as functions of (q, p).
    pub columns: Vec<WrittenExpr>,
    /// The observables that are no functions of q and p, and why.
    pub left_out: Vec<(String, NoClosedForm)>,
}

/// The flow of G at a time, which stands still while ε runs.
///
/// # Errors
/// Returns an error if G, H, the velocities or a column is not known as a function of q and p, or
/// the system is subject to constraints.
pub fn flow_of(
    model: &Model,
    equations: &mut Equations,
    (name, generator): (&str, Expr),
    columns: &[WrittenExpr],
    time: f64,
) -> Result<GeneratorFlow, NoClosedForm> {
    if !model.constraints.is_empty() {
        let why =
            "the state is subject to constraints, which the flow of a generator need not keep";
        return Err(NoClosedForm(why.to_owned()));
    }
    let hamiltonian = equations.hamiltonian().clone()?;
    let velocities =
        if model.is_poisson() { Vec::new() } else { equations.velocities().clone()? };
    let commutator = bracket(model, equations, hamiltonian, generator)?;
    let symbol = model.symbols.time;
    let now = equations.pool.number(Number::Real(time).canonical());
    let now = HashMap::from([(symbol, now)]);
    let still = |equations: &mut Equations, e: Expr| -> Result<Expr, NoClosedForm> {
        let e = in_phase_space(equations, e)?;
        Ok(equations.pool.substitute(e, &now))
    };
    let generator = still(equations, generator)?;
    let energy = still(equations, hamiltonian)?;
    let rate = still(equations, commutator)?;
    let mut shown = Vec::new();
    for velocity in velocities {
        shown.push(still(equations, velocity)?);
    }
    let mut moved = model.clone();
    let mut left_out = Vec::new();
    moved.observables.clear();
    for observable in &model.observables {
        match still(equations, observable.expression) {
            Ok(expression) => {
                let observable = Observable { expression, conserved: None, ..observable.clone() };
                moved.observables.push(observable);
            }
            Err(why) => left_out.push((observable.name.clone(), why)),
        }
    }
    let mut columns = columns.to_vec();
    for column in &mut columns {
        column.expression = still(equations, column.expression)?;
    }
    moved.pool = equations.pool.clone();
    let none = vec![Expr::ZERO; model.coordinates.len()];
    match &mut moved.mechanics {
        Mechanics::Poisson { hamiltonian, forces, .. } => {
            *hamiltonian = generator;
            *forces = none;
        }
        Mechanics::Lagrangian { .. } | Mechanics::Hamiltonian { .. } => {
            moved.mechanics = Mechanics::Hamiltonian { hamiltonian: generator, forces: none };
        }
    }
    moved.impulses.clear();
    moved.events.clear();
    moved.views.clear();
    moved.picture.shapes.clear();
    moved.frames.clear();
    moved.attitude = None;
    moved.comparison = None;
    moved.transformations.clear();
    moved.with_ramps_named = None;
    moved.generators.clear();
    moved.complete_integral = None;
    moved.expect = crate::model::Expect::default();
    moved.run.start = 0.0;
    let mut follow = derive_for_motion(&moved)?;
    // what the columns call velocity and energy is that of the motion
    follow.supplements.shown_velocities = Some(shown);
    follow.conserved.retain(|c| c.name != "energy");
    follow.conserved.insert(
        0,
        Conserved {
            name: name.to_owned(),
            expression: generator,
            reason: Reason::TimeTranslation('G'),
        },
    );
    follow.energy = energy;
    follow.energy_rate = rate;
    if follow.pool.is_zero(rate) == Zero::Proved {
        follow.energy_rate = Expr::ZERO;
        let name = "energy".to_owned();
        follow.conserved.push(Conserved { name, expression: energy, reason: Reason::Commutes });
    }
    Ok(GeneratorFlow { model: moved, equations: follow, columns, left_out })
}
