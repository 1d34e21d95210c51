//! Mechanical similarity and the virial theorem: T and V homogeneous in the coordinates.
//!
//! In: L = T − V, with T of degree 2 in the velocities. Out: the degree k of V in coordinates that are scaled together, in
//! which T has degree 2 as well. Then a motion scaled by l is a motion, in a time scaled by l^{1 − k/2}, and
//! d(Σ q p)/dt = 2T − kV, so that 2⟨T⟩ = k⟨V⟩ where Σ q p is bounded. Never here: averages.
//! Source: L. D. Landau and E. M. Lifshitz, *Mechanics*, § 10.

use std::collections::HashMap;

use super::equations::Equations;
use super::weighted_degree::weighted_degree;
use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::num::Number;

/// The largest number of coordinates of which subsets are tried.
const MOST: usize = 8;

/// T and V that are homogeneous.
#[derive(Clone, Debug)]
pub struct Similarity {
    /// The coordinates that are scaled; the others are angles.
    pub scaled: Vec<Symbol>,
    /// T.
    pub kinetic: Expr,
    /// V.
    pub potential: Expr,
    /// The degree k of V.
    pub degree: Expr,
    /// Σ q p of the scaled coordinates, whose rate is 2T − kV.
    pub virial: Expr,
}

impl Equations {
    /// The similarity of a system, where it is proved; the equations' pool grows.
    pub fn similarity(&mut self) -> Option<Similarity> {
        if self.beside.is_some() {
            return None;
        }
        let lagrangian = self.lagrangian().clone().ok()?;
        let (coordinates, time) = (self.coordinates.clone(), self.symbols.time);
        let pool = &mut self.pool;
        if pool.depends(lagrangian, time) {
            return None;
        }
        let rest: HashMap<Symbol, Expr> =
            coordinates.iter().map(|c| (c.velocity, Expr::ZERO)).collect();
        let potential = pool.substitute(lagrangian, &rest);
        let potential = pool.neg(potential);
        let potential = pool.simplify(potential);
        if pool.is_zero(potential) != Zero::No {
            return None;
        }
        let kinetic = pool.add(lagrangian, potential);
        let speeds: Vec<(Symbol, Expr)> =
            coordinates.iter().map(|c| (c.velocity, pool.variable(c.velocity))).collect();
        if !is_homogeneous(pool, kinetic, &speeds, Expr::ONE, Number::integer(2)) {
            return None;
        }
        let n = coordinates.len();
        if n > 64 {
            return None;
        }
        let all = if n == 64 { u64::MAX } else { (1 << n) - 1 };
        let mut subsets: Vec<u64> = if n <= MOST { (1..=all).collect() } else { vec![all] };
        subsets.sort_by_key(|subset| std::cmp::Reverse(subset.count_ones()));
        let momenta: Vec<Expr> =
            coordinates.iter().map(|c| pool.derivative(lagrangian, c.velocity)).collect();
        let moving: Vec<Symbol> = coordinates.iter().map(|c| c.position).collect();
        for subset in subsets {
            let is_in = |i: usize| subset >> i & 1 == 1;
            let mut both = Vec::new();
            let mut positions = Vec::new();
            let mut terms = Vec::new();
            for (i, c) in coordinates.iter().enumerate().filter(|(i, _)| is_in(*i)) {
                let q = pool.variable(c.position);
                positions.push((c.position, q));
                both.extend([(c.position, q), (c.velocity, pool.variable(c.velocity))]);
                terms.push(pool.mul(q, momenta[i]));
            }
            if !is_homogeneous(pool, kinetic, &both, Expr::ONE, Number::integer(2)) {
                continue;
            }
            let Some(degree) = degree_of(pool, potential, &positions, &moving) else { continue };
            let virial = pool.sum(&terms);
            return Some(Similarity {
                scaled: positions.into_iter().map(|(s, _)| s).collect(),
                kinetic: pool.simplify(kinetic),
                potential,
                degree,
                virial: pool.simplify(virial),
            });
        }
        None
    }
}

/// Whether Euler's operator multiplies an expression by a factor: proved.
fn is_homogeneous(
    pool: &mut Pool,
    e: Expr,
    scaled: &[(Symbol, Expr)],
    factor: Expr,
    times: Number,
) -> bool {
    let moved = pool.derivation(e, scaled);
    let expected = pool.mul(factor, e);
    let difference = pool.linear(Number::ZERO, &[(Number::ONE, moved), (-times, expected)]);
    difference == Expr::ZERO || pool.is_zero(difference) == Zero::Proved
}

/// k with Σ q ∂V/∂q = k V, proved; k is free of all coordinates.
fn degree_of(
    pool: &mut Pool,
    potential: Expr,
    scaled: &[(Symbol, Expr)],
    moving: &[Symbol],
) -> Option<Expr> {
    let moved = pool.derivation(potential, scaled);
    let ratio = pool.div(moved, potential);
    let ratio = pool.simplify(ratio);
    let at = |seed: u64| {
        let value = |s: Symbol| 0.4 + 0.11 * ((s.index() as u64 * 7 + seed * 13) % 17) as f64;
        pool.evaluate(ratio, &value)
    };
    // a number of small denominator, else what is left by simplification
    let guess = (at(1) * 12.0).round();
    let close = (guess / 12.0 - at(1)).abs() < 1e-9 && (guess / 12.0 - at(2)).abs() < 1e-9;
    if close && guess.abs() < 1e4 {
        let degree = pool.ratio(guess as i64, 12);
        if is_homogeneous(pool, potential, scaled, degree, Number::ONE) {
            return Some(degree);
        }
    }
    let weights: Vec<(Symbol, Number)> = scaled.iter().map(|(s, _)| (*s, Number::ONE)).collect();
    weighted_degree(pool, potential, &weights)
        .filter(|&degree| !pool.depends_on_any(degree, moving))
}
