//! Finds conserved quantities symbolically, without input from the user: cyclic momenta, coordinates
//! whose momenta are absent from H, the energy, the momenta of common translations and rotations
//! (`symmetry`), and those of the file's observables whose rate of change vanishes.
//! Source: *The Principles of Dynamics*, §§ 1.4.2, 3.2.3.

use super::conservation::{Class, class_of};
use super::equations::{Conserved, Equations, Flow, Reason};
use super::impulse_change::is_changed_by_impulse;
use super::rate_of_change::ConservedBy;
use super::symmetry;
use crate::expr::{Expr, Symbol, Zero};
use crate::model::{EventAction, Mechanics, Model, Observable};

/// Fills `cyclic` and `conserved`.
pub(super) fn find(equations: &mut Equations, model: &Model) {
    let rates = match &equations.flow {
        Flow::Lagrange { momentum_rates, .. } | Flow::Hamilton { momentum_rates, .. } => {
            momentum_rates.clone()
        }
        Flow::Poisson { .. } => Vec::new(),
    };
    let jumps = equations.law_jumps();
    for (i, (&rate, coordinate)) in rates.iter().zip(&model.coordinates).enumerate() {
        let reason = match equations.pool.is_zero(rate) {
            _ if jumps && !is_absent(equations, model, i) => continue,
            Zero::No | Zero::Unknown => continue,
            Zero::Numerically => Reason::Numerically,
            // a force that balances a slope leaves p constant, but the coordinate is not cyclic
            Zero::Proved if is_absent(equations, model, i) => {
                equations.cyclic.push(i);
                Reason::Cyclic(coordinate.shown.clone())
            }
            Zero::Proved => proved(equations, model),
        };
        equations.conserved.push(Conserved {
            name: format!("p_{}", coordinate.name),
            expression: equations.momenta[i],
            reason,
        });
    }
    if !jumps {
        find_constant_coordinates(equations, model);
    }
    let energy = Conserved {
        name: "energy".to_owned(),
        expression: equations.energy,
        reason: energy_reason(equations, model),
    };
    let rate = equations.energy_rate;
    match equations.pool.is_zero(rate) {
        _ if jumps => {}
        Zero::Proved => equations.conserved.push(energy),
        Zero::Numerically => {
            equations.conserved.push(Conserved { reason: Reason::Numerically, ..energy });
        }
        Zero::No | Zero::Unknown => {}
    }
    if let Mechanics::Poisson { casimirs, forces, .. } = &model.mechanics {
        for (name, casimir, _) in casimirs {
            let rate = casimir_rate(equations, *casimir, forces);
            if rate == Expr::ZERO {
                let (name, reason) = (name.clone(), Reason::Casimir);
                equations.conserved.push(Conserved { name, expression: *casimir, reason });
            }
        }
    } else if !jumps {
        symmetry::find(equations, model, &rates);
    }
    // a consequence of a constraint is lost once the constraint is released
    let released = model.events.iter().any(|e| matches!(e.action, EventAction::Release(_)));
    for observable in &model.observables {
        name_observable(equations, model, observable, released);
    }
    for i in 0..equations.conserved.len() {
        let quantity = equations.conserved[i].expression;
        if is_changed_by_impulse(equations, model, quantity) {
            let reason = Box::new(equations.conserved[i].reason.clone());
            equations.conserved[i].reason = Reason::BetweenImpulses(reason);
        }
    }
}

/// Adds the coordinates whose momenta do not appear in H. Nothing but H moves a coordinate: forces, constraints and
/// impulses act on momenta.
fn find_constant_coordinates(equations: &mut Equations, model: &Model) {
    let Flow::Hamilton { velocities, .. } = &equations.flow else { return };
    for (velocity, coordinate) in velocities.clone().into_iter().zip(&model.coordinates) {
        if equations.pool.is_zero(velocity) != Zero::Proved {
            continue;
        }
        let momentum = equations.pool.symbol_info(coordinate.momentum).unicode.clone();
        let expression = equations.pool.variable(coordinate.position);
        let (name, reason) = (coordinate.name.clone(), Reason::AbsentMomentum(momentum));
        equations.conserved.push(Conserved { name, expression, reason });
    }
}

/// Returns whether nothing but the law acts: no forces, no dissipation, no constraints.
fn is_free(model: &Model) -> bool {
    model.constraints.is_empty()
        && model.mechanics.dissipation() == Expr::ZERO
        && model.mechanics.forces().iter().all(|&force| force == Expr::ZERO)
}

/// The reason for a quantity whose rate is proved to vanish: by the bracket if the motion is
/// Hamiltonian.
fn proved(equations: &mut Equations, model: &Model) -> Reason {
    if is_free(model) && equations.hamiltonian().is_ok() {
        Reason::Commutes
    } else {
        Reason::Proved
    }
}

/// Why the energy's rate vanishes: either the law does not contain the time and nothing else acts
/// except scleronomic constraints, or the contributions balance.
fn energy_reason(equations: &mut Equations, model: &Model) -> Reason {
    let (_, law) = model.mechanics.function();
    let explicit = equations.pool.derivative(law, equations.symbols.time);
    let undriven = model.mechanics.dissipation() == Expr::ZERO
        && model.mechanics.forces().iter().all(|&force| force == Expr::ZERO)
        && equations.constraints.iter().all(|c| c.rate == Expr::ZERO);
    if undriven && equations.pool.is_zero(explicit) == Zero::Proved {
        Reason::TimeTranslation(if equations.is_lagrangian() { 'L' } else { 'H' })
    } else {
        Reason::Proved
    }
}

/// dC/dt = ∇C · f for a Casimir, which H does not change. The result is exactly zero if it is
/// proved to vanish.
pub fn casimir_rate(equations: &mut Equations, casimir: Expr, forces: &[Expr]) -> Expr {
    let variables = equations.coordinates.iter().map(|c| c.position);
    let seeds: Vec<(Symbol, Expr)> = variables.zip(forces.iter().copied()).collect();
    let rate = equations.pool.derivation(casimir, &seeds);
    if equations.pool.is_zero(rate) == Zero::Proved {
        Expr::ZERO
    } else {
        equations.pool.simplify(rate)
    }
}

/// Adds a conserved observable. If it has already been found, as the momentum of a symmetry, it
/// only receives the file's name.
fn name_observable(
    equations: &mut Equations,
    model: &Model,
    observable: &Observable,
    released: bool,
) {
    let expression = observable.expression;
    let opened = equations.open(expression);
    for i in 0..equations.conserved.len() {
        let known = &equations.conserved[i];
        let symmetry = matches!(
            known.reason,
            Reason::Translation(_) | Reason::CommonRotation(_) | Reason::Rotation(_)
        );
        if !symmetry {
            continue;
        }
        let difference = equations.pool.sub(opened, known.expression);
        if equations.pool.is_zero(difference) == Zero::Proved {
            observable.name.clone_into(&mut equations.conserved[i].name);
            return;
        }
    }
    let reason = match equations.knowledge_of(expression, released) {
        Some(ConservedBy::Always) => proved(equations, model),
        Some(ConservedBy::OnConstraints) => Reason::ProvedOnConstraints,
        Some(ConservedBy::ByValues) => Reason::Numerically,
        None if observable.conserved == Some(true) => {
            match class_of(model, equations, &observable.name, expression).class {
                Class::Changing => Reason::OfThisMotion,
                _ => Reason::Declared,
            }
        }
        None => return,
    };
    equations.conserved.push(Conserved { name: observable.name.clone(), expression, reason });
}

/// Returns whether the i-th coordinate does not appear in L (or H), or has no effect there.
fn is_absent(equations: &mut Equations, model: &Model, i: usize) -> bool {
    let (_, f) = model.mechanics.function();
    let position = model.coordinates[i].position;
    if equations.law_jumps() && equations.pool.depends(f, position) {
        return false;
    }
    let slope = equations.pool.derivative(f, position);
    equations.pool.is_zero(slope) == Zero::Proved
}
