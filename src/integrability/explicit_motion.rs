//! The equations of motion solved for the accelerations, and how a change of time and coordinates acts on them.
//!
//! In: equations; ξ and η. Out: q̈ = F(q, q̇, t), prolongations, whether they leave the equations as they are. Never here: how
//! ξ and η are found.
//! Source: P. J. Olver, *Applications of Lie Groups to Differential Equations*, § 2.3.

use std::collections::HashMap;

use super::units::Unsupported;
use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::mechanics::{Equations, Flow};

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

/// Equations of motion solved for the accelerations.
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
    pub(super) fn prolonged(&self, pool: &mut Pool, xi: Expr, eta: &[Expr]) -> (Expr, Vec<Expr>) {
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

    /// Whether the second prolongation is proved to leave q̈ = F as it is.
    pub(super) fn is_symmetry(&self, pool: &mut Pool, xi: Expr, eta: &[Expr]) -> bool {
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

    /// X⁽¹⁾L + L Dξ.
    pub(super) fn change_of(
        &self,
        pool: &mut Pool,
        lagrangian: Expr,
        xi: Expr,
        eta: &[Expr],
    ) -> Expr {
        let (rate, first) = self.prolonged(pool, xi, eta);
        let mut seeds = vec![(self.time, xi)];
        seeds.extend(self.positions.iter().copied().zip(eta.iter().copied()));
        seeds.extend(self.velocities.iter().copied().zip(first));
        let moved = pool.derivation(lagrangian, &seeds);
        let stretched = pool.mul(lagrangian, rate);
        pool.add(moved, stretched)
    }
}
