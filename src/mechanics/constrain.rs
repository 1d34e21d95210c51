//! Constraints: Σ A_βα q̇_α + A_β = 0, enforced by the forces Σ λ_β A_βα.
//!
//! In: the model's constraints. Out: each one's row A_β, and the equations of motion with their
//! multipliers, M q̈ = f + Aᵀλ and A q̈ = γ, as one system. Never here: numbers; whether the
//! initial values agree.
//! Source: *The Principles of Dynamics*, § 1.3.2.

use super::equations::{ConstraintRow, CoordinateSymbols, NoClosedForm};
use super::linear;
use super::slope::tidy_derivative;
use crate::expr::{Expr, Pool, Symbol};
use crate::model::{Constraint, Model};
use crate::num::Number;

pub(super) fn rows(pool: &mut Pool, model: &Model) -> Vec<ConstraintRow> {
    let coordinates = CoordinateSymbols::of(model);
    let time = model.symbols.time;
    model.constraints.iter().map(|c| row(pool, &coordinates, time, c)).collect()
}

fn row(
    pool: &mut Pool,
    coordinates: &[CoordinateSymbols],
    time: Symbol,
    constraint: &Constraint,
) -> ConstraintRow {
    let given = constraint.expression;
    let velocities: Vec<Symbol> = coordinates.iter().map(|c| c.velocity).collect();
    let holonomic = !pool.depends_on_any(given, &velocities);
    let (row, rate): (Vec<Expr>, Expr) = if holonomic {
        let slopes = coordinates.iter().map(|c| tidy_derivative(pool, given, c.position));
        (slopes.collect(), tidy_derivative(pool, given, time))
    } else {
        let row = velocities.iter().map(|&v| tidy_derivative(pool, given, v)).collect();
        let rest = velocities.iter().map(|&v| (v, Expr::ZERO)).collect();
        let rate = pool.substitute(given, &rest);
        (row, pool.simplify(rate))
    };
    // A_β q̈ + (q̇·∂/∂q + ∂/∂t)(A_β q̇ + A_β0) = 0
    let mut terms = vec![rate];
    let mut drift = vec![(time, Expr::ONE)];
    for (c, &a) in coordinates.iter().zip(&row) {
        let v = pool.variable(c.velocity);
        terms.push(pool.mul(a, v));
        drift.push((c.position, v));
    }
    let condition = pool.sum(&terms);
    let auxiliary = pool.derivation(condition, &drift);
    let bias = pool.neg(auxiliary);
    ConstraintRow {
        name: constraint.name.clone(),
        multiplier: constraint.multiplier,
        row,
        rate,
        bias: pool.simplify(bias),
        position: holonomic.then_some(given),
    }
}

/// Σ_β λ_β A_βα for the coordinate of index α, in the multipliers' symbols.
pub(super) fn force(pool: &mut Pool, rows: &[ConstraintRow], coordinate: usize) -> Expr {
    let terms: Vec<Expr> = rows
        .iter()
        .map(|c| {
            let multiplier = pool.variable(c.multiplier);
            pool.mul(multiplier, c.row[coordinate])
        })
        .collect();
    pool.sum(&terms)
}

/// f + Aᵀλ with the multipliers' symbols: the right-hand side of M q̈ = f + Aᵀλ.
pub fn with_reactions(pool: &mut Pool, rows: &[ConstraintRow], acting: &[Expr]) -> Vec<Expr> {
    let all = acting.iter().enumerate();
    all.map(|(i, &f)| {
        let reaction = force(pool, rows, i);
        pool.add(f, reaction)
    })
    .collect()
}

/// −Σ_β λ_β A_β0: the power of the rheonomic (time-dependent) constraints.
pub(super) fn power(pool: &mut Pool, rows: &[ConstraintRow]) -> Expr {
    let terms: Vec<(Number, Expr)> = rows
        .iter()
        .map(|c| {
            let multiplier = pool.variable(c.multiplier);
            (Number::MINUS_ONE, pool.mul(multiplier, c.rate))
        })
        .collect();
    pool.linear(Number::ZERO, &terms)
}

/// The matrix of M q̈ − Aᵀλ = f, A q̈ = γ. It may be regular even if M alone is singular.
fn augmented(pool: &mut Pool, mass: &[Vec<Expr>], rows: &[ConstraintRow]) -> Vec<Vec<Expr>> {
    let mut matrix = mass.to_vec();
    for (i, row) in matrix.iter_mut().enumerate() {
        row.extend(rows.iter().map(|c| pool.neg(c.row[i])));
    }
    for c in rows {
        matrix.push(c.row.iter().copied().chain(rows.iter().map(|_| Expr::ZERO)).collect());
    }
    matrix
}

/// The accelerations, and the multipliers, in closed form.
pub(super) fn solve(
    pool: &mut Pool,
    mass: &[Vec<Expr>],
    force: &[Expr],
    rows: &[ConstraintRow],
) -> Result<(Vec<Expr>, Vec<Expr>), NoClosedForm> {
    let matrix = augmented(pool, mass, rows);
    let right: Vec<Expr> = force.iter().copied().chain(rows.iter().map(|c| c.bias)).collect();
    let mut solution = linear::solve(pool, &matrix, &right)?.x?;
    let multipliers = solution.split_off(force.len());
    Ok((solution, multipliers))
}
