//! Lagrange's equations, complete: d/dt(∂L/∂q̇) − ∂L/∂q + ∂F/∂q̇ = Q + Aᵀλ, expanded to
//! M q̈ = f + Aᵀλ.
//! Source: *The Principles of Dynamics*, §§ 1.2.3, 1.3.1, 1.4.2.

use super::equations::{CoordinateSymbols, Equations, Flow, NoClosedForm, Pending, Supplements};
use super::slope::{tidy_derivative, zero_if_proved};
use super::{constrain, hamilton};
use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::model::Model;
use crate::num::Number;

/// Everything that follows from L(q, q̇, t), Rayleigh's F(q, q̇, t) and the forces Q, except the
/// invariants. The pool field of the result is empty: the caller moves `pool` in.
pub(super) fn equations(
    pool: &mut Pool,
    model: &Model,
    lagrangian: Expr,
    dissipation: Expr,
    forces: &[Expr],
) -> Equations {
    let coordinates = CoordinateSymbols::of(model);
    let time = model.symbols.time;
    let velocities: Vec<Expr> = coordinates.iter().map(|c| pool.variable(c.velocity)).collect();

    // p_i = ∂L/∂q̇_i, M_ij = ∂p_i/∂q̇_j
    let momenta: Vec<Expr> =
        coordinates.iter().map(|c| tidy_derivative(pool, lagrangian, c.velocity)).collect();
    let mut mass = vec![vec![Expr::ZERO; coordinates.len()]; coordinates.len()];
    for i in 0..coordinates.len() {
        for j in 0..=i {
            mass[i][j] = tidy_derivative(pool, momenta[i], coordinates[j].velocity);
            mass[j][i] = mass[i][j];
        }
    }

    // ṗ_i = ∂L/∂q_i − ∂F/∂q̇_i + Q_i, and f_i = ṗ_i − (q̇·∂/∂q + ∂/∂t) p_i
    let drift: Vec<(Symbol, Expr)> = coordinates
        .iter()
        .zip(&velocities)
        .map(|(c, &v)| (c.position, v))
        .chain([(time, Expr::ONE)])
        .collect();
    let constraints = constrain::rows(pool, model);
    let mut momentum_rates = Vec::new();
    let mut force = Vec::new();
    let mut power = Vec::new();
    for (i, c) in coordinates.iter().enumerate() {
        let slope = tidy_derivative(pool, lagrangian, c.position);
        let friction = tidy_derivative(pool, dissipation, c.velocity);
        let applied = [
            (Number::MINUS_ONE, friction),
            (Number::ONE, forces.get(i).copied().unwrap_or(Expr::ZERO)),
        ];
        let applied = pool.linear(Number::ZERO, &applied);
        let rate = pool.add(slope, applied);
        let auxiliary = pool.derivation(momenta[i], &drift);
        let acting = pool.sub(rate, auxiliary);
        let reaction = constrain::force(pool, &constraints, i);
        let rate = pool.add(rate, reaction);
        momentum_rates.push(pool.simplify(rate));
        force.push(pool.simplify(acting));
        power.push(pool.mul(velocities[i], applied));
    }

    // dh/dt = −∂L/∂t − q̇·∂F/∂q̇ + q̇·Q − Σ λ_β A_β
    let explicit = tidy_derivative(pool, lagrangian, time);
    power.push(pool.neg(explicit));
    power.push(constrain::power(pool, &constraints));
    let energy_rate = pool.sum(&power);
    let energy_rate = zero_if_proved(pool, energy_rate);
    let energy = energy_function(pool, &coordinates, lagrangian);

    let beside = if !constraints.is_empty() {
        Some("the motion is subject to constraints")
    } else if dissipation != Expr::ZERO || forces.iter().any(|&f| f != Expr::ZERO) {
        Some(hamilton::FORCED)
    } else {
        None
    };
    Equations {
        pool: Pool::new(),
        coordinates,
        symbols: model.symbols,
        momenta,
        flow: Flow::Lagrange { mass, force, momentum_rates },
        law: lagrangian,
        lagrangian: Ok(lagrangian),
        hamiltonian: Err(NoClosedForm::pending()),
        velocities: Err(NoClosedForm::pending()),
        energy,
        energy_rate,
        action_rate: lagrangian,
        solved: Err(NoClosedForm::pending()),
        multipliers: Err(NoClosedForm::pending()),
        constraints,
        cyclic: Vec::new(),
        conserved: Vec::new(),
        separable: Err(NoClosedForm::pending()),
        pending: Pending { solved: true, transform: true, separable: true },
        beside,
        supplements: Supplements::of(model),
    }
}

/// Jacobi's h = Σ q̇ ∂L/∂q̇ − L, term by term, so that terms homogeneous in the velocities keep
/// their form: a term of degree d gives d − 1 times itself (Euler).
fn energy_function(pool: &mut Pool, coordinates: &[CoordinateSymbols], lagrangian: Expr) -> Expr {
    let scaled: Vec<(Symbol, Expr)> =
        coordinates.iter().map(|c| (c.velocity, pool.variable(c.velocity))).collect();
    let mut parts: Vec<(Number, Expr)> = Vec::new();
    for (c, term) in pool.summands(lagrangian) {
        let euler = pool.derivation(term, &scaled);
        let degree = (0..=4).find(|&d| {
            let difference =
                pool.linear(Number::ZERO, &[(Number::ONE, euler), (Number::integer(-d), term)]);
            pool.is_zero(difference) == Zero::Proved
        });
        match degree {
            Some(d) => parts.push((c * Number::integer(d - 1), term)),
            None => parts.extend([(c, euler), (-c, term)]),
        }
    }
    let energy = pool.linear(Number::ZERO, &parts);
    pool.simplify_terms(energy)
}
