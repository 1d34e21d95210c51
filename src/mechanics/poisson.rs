//! Motion given by brackets of variables that are not canonical: ẋ = {x, H} + force.
//! Source: *The Principles of Dynamics*, §§ 2.2.1, 3.2.3.

use super::equations::{CoordinateSymbols, Equations, Flow, NoClosedForm, Pending, Supplements};
use super::slope::{tidy_derivative, zero_if_proved};
use crate::expr::{Expr, Pool};
use crate::model::Model;

/// Everything that follows from H(x, t), the brackets {x_i, x_j} and the forces added to each ẋ,
/// except the invariants. The pool field of the result is empty: the caller moves `pool` in.
pub(super) fn equations(
    pool: &mut Pool,
    model: &Model,
    hamiltonian: Expr,
    brackets: &[Vec<Expr>],
    forces: &[Expr],
) -> Equations {
    let coordinates = CoordinateSymbols::of(model);
    let slopes: Vec<Expr> =
        coordinates.iter().map(|c| tidy_derivative(pool, hamiltonian, c.position)).collect();
    // ẋ_i = Σ_j {x_i, x_j} ∂H/∂x_j + force_i, and dH/dt = ∂H/∂t + Σ force_i ∂H/∂x_i
    let mut power = vec![tidy_derivative(pool, hamiltonian, model.symbols.time)];
    let mut rates = Vec::new();
    for (i, row) in brackets.iter().enumerate() {
        let force = forces.get(i).copied().unwrap_or(Expr::ZERO);
        let mut terms = vec![force];
        for (&bracket, &slope) in row.iter().zip(&slopes) {
            terms.push(pool.mul(bracket, slope));
        }
        let rate = pool.sum(&terms);
        rates.push(pool.simplify(rate));
        power.push(pool.mul(force, slopes[i]));
    }
    let energy_rate = pool.sum(&power);
    let energy_rate = zero_if_proved(pool, energy_rate);
    let none =
        |what: &str| NoClosedForm(format!("variables given by their brackets have no {what}"));
    Equations {
        pool: Pool::new(),
        coordinates,
        symbols: model.symbols,
        momenta: Vec::new(),
        flow: Flow::Poisson { rates: rates.clone() },
        law: hamiltonian,
        lagrangian: Err(none("Lagrangian")),
        hamiltonian: Ok(hamiltonian),
        velocities: Ok(rates.clone()),
        energy: hamiltonian,
        energy_rate,
        action_rate: Expr::ZERO,
        solved: Ok(rates),
        constraints: Vec::new(),
        multipliers: Ok(Vec::new()),
        cyclic: Vec::new(),
        conserved: Vec::new(),
        separable: Err(none("momenta to split H by")),
        pending: Pending::default(),
        beside: None,
        supplements: Supplements::of(model),
    }
}
