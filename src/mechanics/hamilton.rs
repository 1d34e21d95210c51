//! Hamilton's equations: q̇ = ∂H/∂p, ṗ = −∂H/∂q + force.
//! Source: *The Principles of Dynamics*, § 3.1.

use super::equations::{
    CoordinateSymbols, Equations, Flow, NoClosedForm, Pending, Separable, Supplements,
};
use super::slope::{tidy_derivative, zero_if_proved};
use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::model::Model;
use crate::num::Number;

/// Everything that follows from H(q, p, t) and the forces added to ṗ, except the invariants. The
/// pool field of the result is empty: the caller moves `pool` in.
pub(super) fn equations(
    pool: &mut Pool,
    model: &Model,
    hamiltonian: Expr,
    forces: &[Expr],
) -> Equations {
    let coordinates = CoordinateSymbols::of(model);
    let time = model.symbols.time;
    let momenta: Vec<Expr> = coordinates.iter().map(|c| pool.variable(c.momentum)).collect();
    let velocities: Vec<Expr> =
        coordinates.iter().map(|c| tidy_derivative(pool, hamiltonian, c.momentum)).collect();
    let mut momentum_rates = Vec::new();
    let mut power = vec![tidy_derivative(pool, hamiltonian, time)];
    for (i, c) in coordinates.iter().enumerate() {
        let slope = tidy_derivative(pool, hamiltonian, c.position);
        let force = forces.get(i).copied().unwrap_or(Expr::ZERO);
        let rate = pool.sub(force, slope);
        momentum_rates.push(pool.simplify(rate));
        power.push(pool.mul(force, velocities[i]));
    }
    // dH/dt = ∂H/∂t + Σ force ∂H/∂p
    let energy_rate = pool.sum(&power);
    let energy_rate = zero_if_proved(pool, energy_rate);
    // L = Σ p q̇ − H
    let mut parts: Vec<(Number, Expr)> = Vec::new();
    for (p, v) in momenta.iter().zip(&velocities) {
        parts.push((Number::ONE, pool.mul(*p, *v)));
    }
    parts.push((Number::MINUS_ONE, hamiltonian));
    let action_rate = pool.linear(Number::ZERO, &parts);
    let action_rate = pool.simplify_terms(action_rate);
    let solved = velocities.iter().chain(&momentum_rates).copied().collect();
    let beside = forces.iter().any(|&f| f != Expr::ZERO).then_some(FORCED);
    Equations {
        pool: Pool::new(),
        coordinates,
        symbols: model.symbols,
        momenta,
        flow: Flow::Hamilton { velocities: velocities.clone(), momentum_rates },
        law: hamiltonian,
        lagrangian: Err(NoClosedForm::pending()),
        hamiltonian: Ok(hamiltonian),
        velocities: Ok(velocities),
        energy: hamiltonian,
        energy_rate,
        action_rate,
        solved: Ok(solved),
        constraints: Vec::new(),
        multipliers: Ok(Vec::new()),
        cyclic: Vec::new(),
        conserved: Vec::new(),
        separable: Err(NoClosedForm::pending()),
        pending: Pending { solved: false, transform: true, separable: true },
        beside,
        supplements: Supplements::of(model),
    }
}

/// The reason why a motion with forces does not follow from H alone.
pub(super) const FORCED: &str = "a force acts that does not come from H";

/// Separates H = T(p) + V(q, t), if that is possible and nothing else acts; `others` names what
/// does.
pub(super) fn separate(
    pool: &mut Pool,
    coordinates: &[CoordinateSymbols],
    time: Symbol,
    hamiltonian: Result<&Expr, &NoClosedForm>,
    others: Option<&str>,
) -> Result<Separable, NoClosedForm> {
    let h =
        *hamiltonian.map_err(|why| NoClosedForm(format!("there is no H in closed form: {why}")))?;
    if let Some(why) = others {
        return Err(NoClosedForm(why.to_owned()));
    }
    let positions: Vec<Symbol> = coordinates.iter().map(|c| c.position).collect();
    let momenta: Vec<Symbol> = coordinates.iter().map(|c| c.momentum).collect();
    let mut velocities = Vec::new();
    for c in coordinates {
        let velocity = tidy_derivative(pool, h, c.momentum);
        for other in positions.iter().chain([&time]) {
            let mixed = pool.derivative(velocity, *other);
            if pool.is_zero(mixed) != Zero::Proved {
                let (p, q) = (pool.symbol_info(c.momentum), pool.symbol_info(*other));
                return Err(NoClosedForm(format!(
                    "H is not of the form T(p) + V(q, t): ∂²H/∂{}∂{} does not vanish",
                    p.name, q.name
                )));
            }
        }
        velocities.push(without(pool, velocity, &positions));
    }
    let momentum_rates = coordinates
        .iter()
        .map(|c| {
            let slope = tidy_derivative(pool, h, c.position);
            let rate = pool.neg(slope);
            without(pool, rate, &momenta)
        })
        .collect();
    Ok(Separable { velocities, momentum_rates })
}

/// An expression that is known not to vary with `symbols`, with those set to one: it may still
/// contain them if they cancel.
fn without(pool: &mut Pool, e: Expr, symbols: &[Symbol]) -> Expr {
    if !pool.depends_on_any(e, symbols) {
        return e;
    }
    let ones = symbols.iter().map(|&s| (s, Expr::ONE)).collect();
    pool.substitute(e, &ones)
}
