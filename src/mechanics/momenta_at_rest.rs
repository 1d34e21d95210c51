//! The momenta of a state at rest: of p − A in a vector potential A, and 0 without one.
//!
//! In: Hamilton's equations. Out: p(q, t) at which q̇ = ∂H/∂p vanishes. Never here: Lagrangians, whose states at rest have no
//! velocities.

use std::collections::HashMap;

use super::equations::{Equations, Flow};
use super::linear;
use crate::expr::{Expr, Symbol};

/// Momenta at rest that are heavier are not used.
const HEAVIEST: u64 = 200;

impl Equations {
    /// p(q, t) at rest, where H is quadratic in the momenta and this can be written down; `None` elsewhere.
    pub fn momenta_at_rest(&mut self) -> Option<Vec<Expr>> {
        let Flow::Hamilton { velocities, .. } = &self.flow else { return None };
        let velocities = velocities.clone();
        let momenta: Vec<Symbol> = self.coordinates.iter().map(|c| c.momentum).collect();
        let pool = &mut self.pool;
        let zeros: HashMap<Symbol, Expr> = momenta.iter().map(|&p| (p, Expr::ZERO)).collect();
        let mut inertia = Vec::new();
        let mut without = Vec::new();
        for &velocity in &velocities {
            let row: Vec<Expr> = momenta.iter().map(|&p| pool.derivative(velocity, p)).collect();
            let row: Vec<Expr> = row.into_iter().map(|e| pool.simplify(e)).collect();
            if row.iter().any(|&e| pool.depends_on_any(e, &momenta)) {
                return None;
            }
            inertia.push(row);
            let at_zero = pool.substitute(velocity, &zeros);
            without.push(pool.neg(at_zero));
        }
        if without.iter().all(|&e| e == Expr::ZERO) {
            return Some(without);
        }
        let found = linear::solve(pool, &inertia, &without).ok()?.x.ok()?;
        let found: Vec<Expr> = found.into_iter().map(|e| pool.simplify(e)).collect();
        found.iter().all(|&e| pool.weight(e) <= HEAVIEST).then_some(found)
    }
}
