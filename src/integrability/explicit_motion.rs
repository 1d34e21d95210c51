//! The equations of motion solved for the accelerations, and how a change of time and coordinates acts on them.
//!
//! In: equations; ξ and η. Out: q̈ = F(q, q̇, t), prolongations, whether they leave the equations as they are. Never here: how
//! ξ and η are found.
//! Source: P. J. Olver, *Applications of Lie Groups to Differential Equations*, § 2.3.

use std::collections::HashMap;

use super::units::Unsupported;
use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::mechanics::{Equations, Flow, weighted_degree};
use crate::num::Number;

/// q̈ as a function of (q, q̇, t).
pub(super) fn accelerations(equations: &mut Equations) -> Result<Vec<Expr>, Unsupported> {
    let unknown = |why: String| Unsupported(format!("the accelerations are not known: {why}"));
    match equations.flow.clone() {
        Flow::Lagrange { .. } => equations.solved().clone().map_err(|why| unknown(why.0)),
        Flow::Poisson { .. } => {
            Err(Unsupported("a Poisson system has no accelerations".to_owned()))
        }
        Flow::Hamilton { velocities, momentum_rates } => {
            let lagrangian = equations.lagrangian().clone().map_err(|why| unknown(why.0))?;
            let coordinates = equations.coordinates.clone();
            let pool = &mut equations.pool;
            let mut along = vec![(equations.symbols.time, Expr::ONE)];
            let mut momenta = HashMap::new();
            for ((c, &v), &rate) in coordinates.iter().zip(&velocities).zip(&momentum_rates) {
                along.extend([(c.position, v), (c.momentum, rate)]);
                momenta.insert(c.momentum, pool.derivative(lagrangian, c.velocity));
            }
            let solved = velocities.iter().map(|&v| {
                let rate = pool.derivation(v, &along);
                let rate = pool.substitute(rate, &momenta);
                pool.simplify(rate)
            });
            Ok(solved.collect())
        }
    }
}

#[derive(Clone)]
pub(super) struct ExplicitMotion {
    pub(super) time: Symbol,
    pub(super) positions: Vec<Symbol>,
    pub(super) velocities: Vec<Symbol>,
    pub(super) accelerations: Vec<Expr>,
    /// Of each acceleration its slopes by t, q and q̇.
    pub(super) slopes: Vec<(Expr, Vec<Expr>, Vec<Expr>)>,
}

impl ExplicitMotion {
    pub(super) fn of(
        pool: &mut Pool,
        time: Symbol,
        positions: Vec<Symbol>,
        velocities: Vec<Symbol>,
        accelerations: Vec<Expr>,
    ) -> ExplicitMotion {
        let mut slopes = Vec::new();
        for &f in &accelerations {
            let by_time = pool.derivative(f, time);
            let by_position = positions.iter().map(|&q| pool.derivative(f, q)).collect();
            let by_velocity = velocities.iter().map(|&v| pool.derivative(f, v)).collect();
            slopes.push((by_time, by_position, by_velocity));
        }
        ExplicitMotion { time, positions, velocities, accelerations, slopes }
    }

    /// D of functions of (q, t).
    pub(super) fn first(&self, pool: &mut Pool) -> Vec<(Symbol, Expr)> {
        let mut seeds = vec![(self.time, Expr::ONE)];
        let both = self.positions.iter().zip(&self.velocities);
        seeds.extend(both.map(|(&q, &v)| (q, pool.variable(v))));
        seeds
    }

    /// D along the motion.
    pub(super) fn along(&self, pool: &mut Pool) -> Vec<(Symbol, Expr)> {
        let mut seeds = self.first(pool);
        seeds.extend(self.velocities.iter().copied().zip(self.accelerations.iter().copied()));
        seeds
    }

    /// D ξ and the η^{i(1)}.
    fn prolonged(&self, pool: &mut Pool, xi: Expr, eta: &[Expr]) -> (Expr, Vec<Expr>) {
        let seeds = self.first(pool);
        let rate = pool.derivation(xi, &seeds);
        let mut all = Vec::new();
        for (&e, &v) in eta.iter().zip(&self.velocities) {
            let moved = pool.derivation(e, &seeds);
            let v = pool.variable(v);
            let carried = pool.mul(v, rate);
            all.push(pool.sub(moved, carried));
        }
        (rate, all)
    }

    /// The exponents of a scaling t → λ^a t, q_i → λ^{b_i} q_i: a and the b_i.
    pub(super) fn scaling(&self, pool: &mut Pool, xi: Expr, eta: &[Expr]) -> Option<Vec<Number>> {
        let symbols = [self.time].into_iter().chain(self.positions.iter().copied());
        let changes = [xi].into_iter().chain(eta.iter().copied());
        let exponents = symbols.zip(changes).map(|(s, e)| {
            let x = pool.variable(s);
            let ratio = pool.div(e, x);
            pool.as_number(ratio)
        });
        exponents.collect()
    }

    /// Whether a scaling leaves q̈ = F as it is: F^i is of degree b_i − 2a as it is written.
    fn is_scaled(&self, pool: &mut Pool, exponents: &[Number]) -> bool {
        let [a, b @ ..] = exponents else { return false };
        let mut weights = vec![(self.time, *a)];
        weights.extend(self.positions.iter().copied().zip(b.iter().copied()));
        weights.extend(self.velocities.iter().copied().zip(b.iter().map(|&b| b + -*a)));
        self.accelerations.iter().zip(b).all(|(&f, &b)| {
            let expected = pool.number(b + -*a + -*a);
            f == Expr::ZERO || weighted_degree(pool, f, &weights) == Some(expected)
        })
    }

    /// Whether the second prolongation is proved to leave q̈ = F as it is.
    pub(super) fn is_symmetry(&self, pool: &mut Pool, xi: Expr, eta: &[Expr]) -> bool {
        // this is seen where terms are too many to be multiplied out
        if self.scaling(pool, xi, eta).is_some_and(|exponents| self.is_scaled(pool, &exponents)) {
            return true;
        }
        let (rate, first) = self.prolonged(pool, xi, eta);
        let seeds = self.along(pool);
        (0..eta.len()).all(|i| {
            let (by_time, by_position, by_velocity) = &self.slopes[i];
            let moved = pool.derivation(first[i], &seeds);
            let carried = pool.mul(self.accelerations[i], rate);
            let mut terms = vec![pool.neg(moved), carried, pool.mul(xi, *by_time)];
            for j in 0..eta.len() {
                terms.push(pool.mul(eta[j], by_position[j]));
                terms.push(pool.mul(first[j], by_velocity[j]));
            }
            let condition = pool.sum(&terms);
            pool.is_zero(condition) == Zero::Proved
        })
    }
}
