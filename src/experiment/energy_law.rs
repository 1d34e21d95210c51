//! Why the energy is not conserved, in words and as a formula.
//!
//! dh/dt = −∂L/∂t − q̇·∂F/∂q̇ + q̇·Q − Σ λ_β A_β, *The Principles of Dynamics*, §§ 1.3.1, 1.3.2, 1.4.2.

use crate::expr::Expr;
use crate::mechanics::Equations;
use crate::model::{Mechanics, Model};

/// A longer formula is replaced by its general form.
pub(super) const LONGEST: usize = 48;

/// Why the energy changes.
pub(super) struct EnergyLaw {
    /// The cause in words: `friction`, `explicit time`.
    pub(super) cause: String,
    /// The rate as a formula: `dE/dt = −c θ̇²`.
    pub(super) rate: String,
}

impl EnergyLaw {
    pub(super) fn of(model: &Model, equations: &Equations) -> EnergyLaw {
        let any = |all: &[Expr]| all.iter().any(|&e| e != Expr::ZERO);
        let timed = |e: Expr| model.pool.depends(e, model.symbols.time);
        let moved = equations.constraints.iter().any(|row| row.rate != Expr::ZERO);
        let terms = match &model.mechanics {
            Mechanics::Lagrangian { lagrangian, dissipation, forces } => [
                (timed(*lagrangian), "explicit time", "− ∂L/∂t"),
                (*dissipation != Expr::ZERO, "friction", "− q′·∂F/∂q′"),
                (any(forces), "forces", "+ q′·Q"),
                (moved, "moving constraint", "− Σ λ A₀"),
            ],
            Mechanics::Hamiltonian { hamiltonian, forces } => [
                (timed(*hamiltonian), "explicit time", "+ ∂H/∂t"),
                (any(forces), "forces", "+ q′·Q"),
                (false, "", ""),
                (false, "", ""),
            ],
            Mechanics::Poisson { hamiltonian, forces, .. } => [
                (timed(*hamiltonian), "explicit time", "+ ∂H/∂t"),
                (any(forces), "forces", "+ ∇H·f"),
                (false, "", ""),
                (false, "", ""),
            ],
        };
        let present = || terms.iter().filter(|term| term.0);
        let mut cause = present().map(|term| term.1).collect::<Vec<_>>().join(", ");
        let steps = equations.law_jumps();
        if steps {
            let law = if equations.is_lagrangian() { "L" } else { "H" };
            let what = if equations.has_impulses_at_steps() {
                ", where the force is an impulse"
            } else {
                " in time"
            };
            cause = format!("a step of {law}{what}");
        } else if cause.is_empty() {
            // along the flow of another generator
            "[H,G] is not 0".clone_into(&mut cause);
        }
        let mut rate = equations.pool.unicode(equations.energy_rate);
        if rate.chars().count() > LONGEST {
            rate = present().map(|term| term.2).collect::<Vec<_>>().join(" ");
            rate = match rate.strip_prefix("− ") {
                Some(rest) => format!("−{rest}"),
                None => rate.trim_start_matches("+ ").to_owned(),
            };
        }
        let between = if steps { " between steps" } else { "" };
        EnergyLaw { cause, rate: format!("dE/dt = {rate}{between}") }
    }
}
