//! The transform of κ √(R₀ + ½ ẋ·W ẋ) + b·ẋ + L₀: a relativistic particle in any potential, and the
//! way back from its Hamiltonian.
//!
//! With u = p − b and Q = u·W⁻¹u: R = R₀/(1 − 2Q/κ²), ẋ = 2 √R W⁻¹u/κ, and the transform is
//! −κ √R₀ √(1 − 2Q/κ²) − L₀. For κ = −mc², R₀ = 1, W = −2/c² that is c √(m²c² + p²).
//! Source: Goldstein, *Classical Mechanics*, § 7.9.

use std::collections::HashMap;

use super::super::linear;
use super::{LegendreTransform, constant_in, tidy_derivative};
use crate::expr::{Expr, Node, Pool, Symbol};
use crate::num::Number;

/// The transform of `f`, if it has this form.
pub(super) fn transform(
    pool: &mut Pool,
    from: &[Symbol],
    to: &[Symbol],
    f: Expr,
) -> Option<LegendreTransform> {
    let zeros: HashMap<Symbol, Expr> = from.iter().map(|&s| (s, Expr::ZERO)).collect();
    // exactly one term has a root; the others are linear in the variables
    let mut root = None;
    let mut rest = Vec::new();
    for (c, term) in pool.summands(f) {
        match split_root(pool, term, from) {
            Some((kappa, radicand)) if root.is_none() => {
                root = Some((pool.scale(c, kappa), radicand));
            }
            _ => rest.push((c, term)),
        }
    }
    let (kappa, radicand) = root?;
    let rest = pool.linear(Number::ZERO, &rest);
    let mut w = Vec::new();
    let mut u = Vec::new();
    for (&s, &conjugate) in from.iter().zip(to) {
        let slope = tidy_derivative(pool, rest, s);
        let b = constant_in(pool, slope, from)?;
        let slope = tidy_derivative(pool, radicand, s);
        if pool.substitute(slope, &zeros) != Expr::ZERO {
            return None;
        }
        let mut row = Vec::new();
        for &other in from {
            let entry = tidy_derivative(pool, slope, other);
            row.push(constant_in(pool, entry, from)?);
        }
        w.push(row);
        let conjugate = pool.variable(conjugate);
        u.push(pool.sub(conjugate, b));
    }
    let r0 = pool.substitute(radicand, &zeros);
    let l0 = pool.substitute(rest, &zeros);
    let inverse = linear::solve(pool, &w, &u).ok()?.x.ok()?;
    let products: Vec<Expr> = u.iter().zip(&inverse).map(|(&u, &x)| pool.mul(u, x)).collect();
    let q = pool.sum(&products);
    let ratio = pool.monomial(Number::ONE, &[(q, Number::ONE), (kappa, Number::integer(-2))]);
    let factor = pool.linear(Number::ONE, &[(Number::integer(-2), ratio)]);
    let factor = pool.simplify(factor);
    // ẋ = 2 √(R₀/factor) W⁻¹u / κ
    let speeds: Vec<Expr> = inverse
        .iter()
        .map(|&x| {
            let factors = [
                (r0, Number::HALF),
                (factor, -Number::HALF),
                (x, Number::ONE),
                (kappa, Number::MINUS_ONE),
            ];
            let speed = pool.monomial(Number::integer(2), &factors);
            pool.simplify(speed)
        })
        .collect();
    let factors = [(kappa, Number::ONE), (r0, Number::HALF), (factor, Number::HALF)];
    let energy = pool.monomial(Number::MINUS_ONE, &factors);
    let transformed = pool.sub(energy, l0);
    Some((pool.simplify_terms(transformed), Ok(speeds)))
}

/// Splits `term = κ √radicand`, where the variables occur in the radicand but not in κ.
fn split_root(pool: &mut Pool, term: Expr, from: &[Symbol]) -> Option<(Expr, Expr)> {
    let factors = match pool.node(term) {
        Node::Product(c, factors) if c.is_one() => factors.to_vec(),
        _ => return None,
    };
    let place = factors
        .iter()
        .position(|&(base, n)| n == Number::HALF && pool.depends_on_any(base, from))?;
    let radicand = factors[place].0;
    let mut others = factors;
    others.remove(place);
    let kappa = pool.monomial(Number::ONE, &others);
    (!pool.depends_on_any(kappa, from)).then_some((kappa, radicand))
}
