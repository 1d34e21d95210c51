//! The Legendre transform in both directions, where it exists in closed form.
//! Source: *The Principles of Dynamics*, § 3.1.1.

mod root;

use std::collections::HashMap;

use super::equations::{CoordinateSymbols, NoClosedForm};
use super::slope::tidy_derivative;
use super::{CLOSED_FORM_LIMIT, linear};
use crate::expr::{Expr, Pool, Symbol};
use crate::num::Number;

/// A transform and, if they are short enough, the old variables in terms of the new.
type LegendreTransform = (Expr, Result<Vec<Expr>, NoClosedForm>);

/// H(q, p, t) and q̇(q, p, t) from L(q, q̇, t), its momenta ∂L/∂q̇ and its mass matrix.
///
/// For L = ½ q̇·M q̇ + b·q̇ + L₀: q̇ = M⁻¹(p − b) and H = ½ (p − b)·q̇ − L₀.
///
/// # Errors
/// Returns an error if L is neither quadratic in the velocities nor a root of a quadratic form (a
/// relativistic particle), M is singular, or the result is too long to write.
pub fn lagrangian_to_hamiltonian(
    pool: &mut Pool,
    coordinates: &[CoordinateSymbols],
    lagrangian: Expr,
    momenta: Vec<Expr>,
    mass: Vec<Vec<Expr>>,
) -> Result<LegendreTransform, NoClosedForm> {
    let from: Vec<Symbol> = coordinates.iter().map(|c| c.velocity).collect();
    let to: Vec<Symbol> = coordinates.iter().map(|c| c.momentum).collect();
    let names = ("L", "velocities", "the mass matrix");
    transform(pool, &from, &to, lagrangian, (momenta, mass), names)
        .or_else(|why| root::transform(pool, &from, &to, lagrangian).ok_or(why))
}

/// L(q, q̇, t) from H(q, p, t): the inverse transform.
///
/// # Errors
/// Returns an error if H is neither quadratic in the momenta nor a root of a quadratic form,
/// ∂²H/∂p² is singular, or the result is too long to write.
pub fn hamiltonian_to_lagrangian(
    pool: &mut Pool,
    coordinates: &[CoordinateSymbols],
    hamiltonian: Expr,
) -> Result<Expr, NoClosedForm> {
    let from: Vec<Symbol> = coordinates.iter().map(|c| c.momentum).collect();
    let to: Vec<Symbol> = coordinates.iter().map(|c| c.velocity).collect();
    let names = ("H", "momenta", "∂²H/∂p²");
    let slopes: Vec<Expr> = from.iter().map(|&s| tidy_derivative(pool, hamiltonian, s)).collect();
    let mut hessian = Vec::new();
    for &slope in &slopes {
        let row: Vec<Expr> = from.iter().map(|&s| tidy_derivative(pool, slope, s)).collect();
        hessian.push(row);
    }
    transform(pool, &from, &to, hamiltonian, (slopes, hessian), names)
        .or_else(|why| root::transform(pool, &from, &to, hamiltonian).ok_or(why))
        .map(|(l, _)| l)
}

/// The transform of `f`, with its first and second derivatives, from the variables `from` to their
/// conjugates `to`, and `from` in terms of `to`.
fn transform(
    pool: &mut Pool,
    from: &[Symbol],
    to: &[Symbol],
    f: Expr,
    (slopes, mut hessian): (Vec<Expr>, Vec<Vec<Expr>>),
    (name, variables, matrix): (&str, &str, &str),
) -> Result<LegendreTransform, NoClosedForm> {
    for row in &mut hessian {
        for entry in row.iter_mut() {
            *entry = constant_in(pool, *entry, from).ok_or_else(|| {
                NoClosedForm(format!("{name} is not quadratic in the {variables}"))
            })?;
        }
    }
    let zeros: HashMap<Symbol, Expr> = from.iter().map(|&s| (s, Expr::ZERO)).collect();
    let mut shifted = Vec::new();
    for (&slope, &conjugate) in slopes.iter().zip(to) {
        let offset = pool.substitute(slope, &zeros);
        let conjugate = pool.variable(conjugate);
        shifted.push(pool.sub(conjugate, offset));
    }
    let solution = linear::solve(pool, &hessian, &shifted).map_err(|why| {
        NoClosedForm(format!("{variables} cannot be eliminated with {matrix}: {why}"))
    })?;
    let rest = pool.substitute(f, &zeros);
    let mut parts = vec![(Number::MINUS_ONE, rest)];
    match &solution.squares {
        Some(squares) => {
            for &(u, d) in squares {
                let factors = [(u, Number::integer(2)), (d, Number::MINUS_ONE)];
                parts.push((Number::HALF, pool.monomial(Number::ONE, &factors)));
            }
        }
        None => {
            let inverse = solution.x.as_ref().map_err(Clone::clone)?;
            for (&u, &v) in shifted.iter().zip(inverse) {
                parts.push((Number::HALF, pool.mul(u, v)));
            }
        }
    }
    let transformed = pool.linear(Number::ZERO, &parts);
    let transformed = pool.simplify_terms(transformed);
    if pool.weight(transformed) > CLOSED_FORM_LIMIT {
        return Err(NoClosedForm(format!(
            "the closed form has more than {CLOSED_FORM_LIMIT} nodes"
        )));
    }
    Ok((transformed, solution.x))
}

/// `e` with the symbols removed, if it does not vary with them.
fn constant_in(pool: &mut Pool, e: Expr, symbols: &[Symbol]) -> Option<Expr> {
    if !pool.depends_on_any(e, symbols) {
        return Some(e);
    }
    if symbols.iter().any(|&s| tidy_derivative(pool, e, s) != Expr::ZERO) {
        return None;
    }
    let ones = symbols.iter().map(|&s| (s, Expr::ONE)).collect();
    Some(pool.substitute(e, &ones))
}
