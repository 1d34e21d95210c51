//! What a change of time and coordinates does to a Lagrangian, and what is constant because of it.
//!
//! In: L; ξ, η and a gauge term f. Out: the change of L dt, a [`Symmetry`] with its constant. Never here: how changes are found.
//! Source: *The Principles of Dynamics*, § 1.4.2.

use super::naming::name_of;
use crate::expr::{Expr, Pool, Symbol, Zero};

/// A symmetry of a Lagrangian.
#[derive(Clone, Debug)]
pub struct Symmetry {
    /// What it is called: a time shift, a translation, a rotation, a boost, a dilation, where it is one; else what it
    /// changes.
    pub name: String,
    /// ξ, the change of time.
    pub time: Expr,
    /// η, the change of each coordinate.
    pub coordinates: Vec<Expr>,
    /// f, by whose derivative L dt changes.
    pub gauge: Expr,
    /// ξ (Σ q̇ p − L) − Σ η p + f, which is constant.
    pub conserved: Expr,
    /// Whether that is proved symbolically.
    pub proved: bool,
    /// Whether it is so for all values of the parameters, and not only at the current ones.
    pub for_all_parameters: bool,
    /// Whether an impulse of the file may change the constant.
    pub between_impulses: bool,
}

#[derive(Clone)]
pub(super) struct VariedLagrangian {
    pub(super) time: Symbol,
    pub(super) positions: Vec<Symbol>,
    pub(super) velocities: Vec<Symbol>,
    pub(super) lagrangian: Expr,
    /// L_t, L_q, L_q̇.
    pub(super) slopes: (Expr, Vec<Expr>, Vec<Expr>),
}

impl VariedLagrangian {
    pub(super) fn of(
        pool: &mut Pool,
        lagrangian: Expr,
        time: Symbol,
        positions: Vec<Symbol>,
        velocities: Vec<Symbol>,
    ) -> VariedLagrangian {
        let slopes = (
            pool.derivative(lagrangian, time),
            positions.iter().map(|&q| pool.derivative(lagrangian, q)).collect(),
            velocities.iter().map(|&v| pool.derivative(lagrangian, v)).collect(),
        );
        VariedLagrangian { time, positions, velocities, lagrangian, slopes }
    }

    /// Another Lagrangian of the same coordinates.
    pub(super) fn with(&self, pool: &mut Pool, lagrangian: Expr) -> VariedLagrangian {
        let (positions, velocities) = (self.positions.clone(), self.velocities.clone());
        VariedLagrangian::of(pool, lagrangian, self.time, positions, velocities)
    }

    /// D along any curve.
    fn along(&self, pool: &mut Pool) -> Vec<(Symbol, Expr)> {
        let velocities = self.velocities.iter().map(|&v| pool.variable(v));
        let both = self.positions.iter().copied().zip(velocities);
        [(self.time, Expr::ONE)].into_iter().chain(both).collect()
    }

    /// ξ L_t + η L_q + (D η − q̇ D ξ) L_q̇ + L D ξ, by which L dt changes.
    pub(super) fn change(&self, pool: &mut Pool, xi: Expr, eta: &[Expr]) -> Expr {
        let seeds = self.along(pool);
        let (by_time, by_position, by_velocity) = &self.slopes;
        let moved = pool.derivation(xi, &seeds);
        let mut terms = vec![pool.mul(xi, *by_time), pool.mul(self.lagrangian, moved)];
        for i in 0..eta.len() {
            terms.push(pool.mul(eta[i], by_position[i]));
            let change = pool.derivation(eta[i], &seeds);
            let carried = pool.mul(seeds[i + 1].1, moved);
            let change = pool.sub(change, carried);
            terms.push(pool.mul(change, by_velocity[i]));
        }
        pool.sum(&terms)
    }

    /// A change of time and coordinates with its constant, and whether it is proved to be a symmetry.
    pub(super) fn symmetry(&self, pool: &mut Pool, xi: Expr, eta: Vec<Expr>, f: Expr) -> Symmetry {
        let seeds = self.along(pool);
        let (change, gauge) = (self.change(pool, xi, &eta), pool.derivation(f, &seeds));
        let condition = pool.sub(change, gauge);
        let proved = pool.is_zero(condition) == Zero::Proved;
        let momenta = &self.slopes.2;
        let energy: Vec<Expr> =
            seeds[1..].iter().zip(momenta).map(|(&(_, v), &p)| pool.mul(v, p)).collect();
        let energy = pool.sum(&energy);
        let energy = pool.sub(energy, self.lagrangian);
        let mut constant = vec![pool.mul(xi, energy), f];
        for (&change, &p) in eta.iter().zip(momenta) {
            let work = pool.mul(change, p);
            constant.push(pool.neg(work));
        }
        let conserved = pool.sum(&constant);
        let conserved = pool.simplify(conserved);
        let name = name_of(pool, self.time, &self.positions, xi, &eta);
        Symmetry {
            name,
            time: xi,
            coordinates: eta,
            gauge: f,
            conserved,
            proved,
            for_all_parameters: true,
            between_impulses: false,
        }
    }
}
