//! What is conserved, found symbolically and never asked of the user: cyclic momenta, the energy,
//! the momenta of common translations and rotations (`symmetry`), and those of the file's
//! observables whose rate of change vanishes.
//! Source: *The Principles of Dynamics*, §§ 1.4.2, 3.2.3.

use super::equations::{Conserved, Equations, Flow, Reason};
use super::symmetry;
use crate::expr::{Expr, Symbol, Zero};
use crate::model::{Action, Mechanics, Model, Observable};

/// Fills `cyclic` and `conserved`.
pub(super) fn find(equations: &mut Equations, model: &Model) {
    let rates = match &equations.flow {
        Flow::Lagrange { momentum_rates, .. } | Flow::Hamilton { momentum_rates, .. } => {
            momentum_rates.clone()
        }
        Flow::Poisson { .. } => Vec::new(),
    };
    for (i, (&rate, coordinate)) in rates.iter().zip(&model.coordinates).enumerate() {
        let reason = match equations.pool.is_zero(rate) {
            Zero::No => continue,
            Zero::Numerically => Reason::Numerically,
            // a force that balances a slope leaves p constant, but the coordinate is not cyclic
            Zero::Proved if is_absent(equations, model, i) => {
                equations.cyclic.push(i);
                Reason::Cyclic(coordinate.shown.clone())
            }
            Zero::Proved => Reason::Proved,
        };
        equations.conserved.push(Conserved {
            name: format!("p_{}", coordinate.name),
            expression: equations.momenta[i],
            reason,
        });
    }
    let energy = Conserved {
        name: "energy".to_owned(),
        expression: equations.energy,
        reason: Reason::TimeTranslation(if equations.is_lagrangian() { 'L' } else { 'H' }),
    };
    let rate = equations.energy_rate;
    match equations.pool.is_zero(rate) {
        Zero::Proved => equations.conserved.push(energy),
        Zero::Numerically => {
            equations.conserved.push(Conserved { reason: Reason::Numerically, ..energy });
        }
        Zero::No => {}
    }
    if let Mechanics::Poisson { casimirs, forces, .. } = &model.mechanics {
        for (name, casimir, _) in casimirs {
            let rate = casimir_rate(equations, *casimir, forces);
            if rate == Expr::ZERO {
                let (name, reason) = (name.clone(), Reason::Casimir);
                equations.conserved.push(Conserved { name, expression: *casimir, reason });
            }
        }
    } else {
        symmetry::find(equations, model, &rates);
    }
    // what follows from a constraint does no longer once that is let go
    let released = model.events.iter().any(|e| matches!(e.action, Action::Release(_)));
    for observable in &model.observables {
        name_observable(equations, observable, released);
    }
    for i in 0..equations.conserved.len() {
        if is_struck(equations, model, equations.conserved[i].expression) {
            let reason = Box::new(equations.conserved[i].reason.clone());
            equations.conserved[i].reason = Reason::BetweenBlows(reason);
        }
    }
}

/// Whether a blow of the file may change a quantity.
fn is_struck(equations: &Equations, model: &Model, quantity: Expr) -> bool {
    let struck = |i: usize| model.impulses.iter().any(|blow| blow.change[i] != Expr::ZERO);
    let depends = |i: usize| {
        let c = &equations.coordinates[i];
        let moved = if model.is_poisson() {
            vec![c.position, equations.symbols.energy]
        } else {
            vec![c.velocity, c.momentum, equations.symbols.energy]
        };
        equations.pool.depends_on_any(quantity, &moved)
    };
    (0..equations.coordinates.len()).any(|i| struck(i) && depends(i))
}

/// dC/dt = ∇C · f for a Casimir: H does not move it. Zero exactly where it vanishes.
pub fn casimir_rate(equations: &mut Equations, casimir: Expr, forces: &[Expr]) -> Expr {
    let variables = equations.coordinates.iter().map(|c| c.position);
    let seeds: Vec<(Symbol, Expr)> = variables.zip(forces.iter().copied()).collect();
    let rate = equations.pool.derivation(casimir, &seeds);
    if equations.pool.is_zero(rate) == Zero::No {
        equations.pool.simplify(rate)
    } else {
        Expr::ZERO
    }
}

/// Adds an observable that is conserved. One that was found already, as the momentum of a
/// symmetry, only gives it the file's own name.
fn name_observable(equations: &mut Equations, observable: &Observable, released: bool) {
    let expression = observable.expression;
    let opened = equations.open(expression);
    for i in 0..equations.conserved.len() {
        let known = &equations.conserved[i];
        if !matches!(known.reason, Reason::Translation(_) | Reason::Rotation(_)) {
            continue;
        }
        let difference = equations.pool.sub(opened, known.expression);
        if equations.pool.is_zero(difference) == Zero::Proved {
            observable.name.clone_into(&mut equations.conserved[i].name);
            return;
        }
    }
    let proof = if released && !equations.constraints.is_empty() {
        None
    } else {
        equations.is_conserved(expression)
    };
    let reason = match proof {
        Some(Zero::Proved) => Reason::Proved,
        Some(Zero::Numerically) => Reason::Numerically,
        _ if observable.conserved == Some(true) => Reason::Declared,
        _ => return,
    };
    equations.conserved.push(Conserved { name: observable.name.clone(), expression, reason });
}

/// Whether the i-th coordinate does not appear in L (or H).
fn is_absent(equations: &mut Equations, model: &Model, i: usize) -> bool {
    let (_, f) = model.mechanics.function();
    let slope = equations.pool.derivative(f, model.coordinates[i].position);
    equations.pool.is_zero(slope) == Zero::Proved
}

impl Equations {
    /// Whether dG/dt = 0 along the motion, for G as an observable is written; `None` where the
    /// rate is not known in closed form.
    pub fn is_conserved(&mut self, observable: Expr) -> Option<Zero> {
        let rate = self.rate_of(observable)?;
        Some(self.pool.is_zero(rate))
    }

    /// dG/dt along the motion, in the variables of the state; `None` where the accelerations are
    /// not known in closed form or G holds the action.
    pub fn rate_of(&mut self, observable: Expr) -> Option<Expr> {
        let g = self.open(observable);
        let solved = self.solved.clone().ok()?;
        let accelerations = self.coordinates.iter().map(|c| c.acceleration);
        let multipliers = self.constraints.iter().map(|c| c.multiplier);
        let unknown: Vec<Symbol> =
            accelerations.chain(multipliers).chain([self.symbols.action]).collect();
        if self.pool.depends_on_any(g, &unknown) {
            return None;
        }
        let mut seeds = self.along_the_flow();
        for carried in &self.beside.carried {
            if carried.rates.plain.len() == carried.symbols.len() {
                seeds.extend(carried.symbols.iter().copied().zip(carried.rates.plain.clone()));
            } else if self.pool.depends_on_any(g, &carried.symbols) {
                return None;
            }
        }
        if self.is_lagrangian() {
            for (c, &acceleration) in self.coordinates.clone().iter().zip(&solved) {
                let velocity = self.pool.variable(c.velocity);
                seeds.push((c.position, velocity));
                seeds.push((c.velocity, acceleration));
            }
        }
        Some(self.pool.derivation(g, &seeds))
    }
}
