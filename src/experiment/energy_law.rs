//! Why the energy is not conserved, in words and as a formula.
//!
//! dh/dt = −∂L/∂t − q̇·∂F/∂q̇ + q̇·Q − Σ λ_β A_β, *The Principles of Dynamics*, §§ 1.3.1, 1.3.2, 1.4.2.

use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{Equations, Valuation, absent_at};
use crate::model::{Mechanics, Model};

/// A longer formula is replaced by its general form.
pub(super) const LONGEST: usize = 48;

/// Why the energy changes.
pub(super) struct EnergyLaw {
    /// The cause in words: `friction, explicit time`.
    pub(super) cause: String,
    /// The causes one by one, where there are several.
    pub(super) parts: Vec<Cause>,
    /// The rate as a formula: `dE/dt = −c θ̇²`.
    pub(super) rate: String,
}

/// One of several causes of a change.
#[derive(Clone, Debug)]
pub(super) struct Cause {
    name: &'static str,
    /// What vanishes where it does not act, or depends on the symbol no more.
    of: Vec<Expr>,
    symbol: Option<Symbol>,
}

/// The causes in words that act at these values of the parameters; `None` where all of them do, or none.
pub(super) fn acting(pool: &Pool, causes: &[Cause], values: &Valuation) -> Option<String> {
    let of = |cause: &Cause| cause.of.iter().map(|&e| (e, cause.symbol)).collect::<Vec<_>>();
    let parts: Vec<(Expr, Option<Symbol>)> = causes.iter().flat_map(of).collect();
    let mut absent = absent_at(pool, &parts, values).into_iter();
    let acts = |cause: &&Cause| {
        // all of its parts are taken
        let present = absent.by_ref().take(cause.of.len()).filter(|absent| !absent).count();
        present > 0
    };
    let names: Vec<&str> = causes.iter().filter(acts).map(|cause| cause.name).collect();
    (!names.is_empty() && names.len() < causes.len()).then(|| names.join(", "))
}

impl EnergyLaw {
    pub(super) fn of(model: &Model, equations: &Equations) -> EnergyLaw {
        let any = |all: &[Expr]| all.iter().any(|&e| e != Expr::ZERO);
        let timed = |e: Expr| model.pool.depends(e, model.symbols.time);
        let rates: Vec<Expr> = equations.constraints.iter().map(|row| row.rate).collect();
        let moved = any(&rates);
        let terms = match &model.mechanics {
            Mechanics::Lagrangian { lagrangian, dissipation, forces } => [
                (timed(*lagrangian), "explicit time", "− ∂L/∂t", vec![*lagrangian]),
                (*dissipation != Expr::ZERO, "friction", "− q′·∂F/∂q′", vec![*dissipation]),
                (any(forces), "forces", "+ q′·Q", forces.clone()),
                (moved, "moving constraint", "− Σ λ A₀", rates),
            ],
            Mechanics::Hamiltonian { hamiltonian, forces } => [
                (timed(*hamiltonian), "explicit time", "+ ∂H/∂t", vec![*hamiltonian]),
                (any(forces), "forces", "+ q′·Q", forces.clone()),
                (false, "", "", Vec::new()),
                (false, "", "", Vec::new()),
            ],
            Mechanics::Poisson { hamiltonian, forces, .. } => [
                (timed(*hamiltonian), "explicit time", "+ ∂H/∂t", vec![*hamiltonian]),
                (any(forces), "forces", "+ ∇H·f", forces.clone()),
                (false, "", "", Vec::new()),
                (false, "", "", Vec::new()),
            ],
        };
        let present = || terms.iter().filter(|term| term.0);
        let mut cause = present().map(|term| term.1).collect::<Vec<_>>().join(", ");
        let of_time = |name| (name == "explicit time").then_some(model.symbols.time);
        let mut parts: Vec<Cause> = present()
            .map(|(_, name, _, of)| Cause { name, of: of.clone(), symbol: of_time(*name) })
            .collect();
        let steps = equations.law_jumps();
        if steps {
            let law = if equations.is_lagrangian() { "L" } else { "H" };
            let what = if equations.has_impulses_at_steps() {
                ", where the force is an impulse"
            } else {
                " in time"
            };
            cause = format!("a step of {law}{what}");
            parts.clear();
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
        EnergyLaw { cause, parts, rate: format!("dE/dt = {rate}{between}") }
    }
}
