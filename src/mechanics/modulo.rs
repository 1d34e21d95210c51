//! Tests for vanishing on the constraints: each constraint eliminates a velocity and a position
//! until nothing is left.
//!
//! In: a rate of change in (q, q̇, t). Out: whether it is proved to vanish on the constraints.
//! Never here: numbers.

use std::collections::HashMap;

use super::equations::Equations;
use crate::expr::{Expr, Symbol, Zero};

/// The largest weight of a rate for which this is tried.
const WEIGHT_LIMIT: u64 = 4_000;

/// The number of times the remainder is brought back to a normal form.
const ROUNDS: usize = 4;

/// A coordinate that a holonomic constraint determines.
pub(super) enum Determined {
    /// q equals this expression.
    Value(Symbol, Expr),
    /// q² equals this expression.
    Square(Symbol, Expr),
}

impl Equations {
    /// Returns whether a function of (q, q̇, t) is proved to vanish wherever the constraints are
    /// satisfied. No divisor used on the way is identically zero, so the proof is valid except at
    /// singular configurations.
    pub(super) fn vanishes_on_constraints(&mut self, rate: Expr) -> bool {
        if self.constraints.is_empty() || self.pool.weight(rate) > WEIGHT_LIMIT {
            return false;
        }
        let velocities = self.fixed_velocities();
        let mut rest = rate;
        for (v, value) in &velocities {
            rest = self.pool.substitute(rest, &HashMap::from([(*v, *value)]));
        }
        let positions = self.fixed_positions();
        for _ in 0..ROUNDS {
            for fixed in &positions {
                if let Determined::Value(q, value) = fixed {
                    rest = self.pool.substitute(rest, &HashMap::from([(*q, *value)]));
                }
            }
            rest = self.pool.numerator(rest);
            for fixed in &positions {
                if let Determined::Square(q, value) = fixed {
                    rest = self.pool.with_square(rest, *q, *value);
                }
            }
            if self.pool.is_full() || self.pool.weight(rest) > 4 * WEIGHT_LIMIT {
                return false;
            }
            if self.pool.is_zero(rest) == Zero::Proved {
                return true;
            }
        }
        false
    }

    /// One velocity for each constraint, in terms of the remaining ones; to be substituted in this
    /// order.
    pub(super) fn fixed_velocities(&mut self) -> Vec<(Symbol, Expr)> {
        let symbols: Vec<Symbol> = self.coordinates.iter().map(|c| c.velocity).collect();
        let mut fixed: Vec<(Symbol, Expr)> = Vec::new();
        for row in self.constraints.clone() {
            let mut terms = vec![row.rate];
            for (&a, &v) in row.row.iter().zip(&symbols) {
                let v = self.pool.variable(v);
                terms.push(self.pool.mul(a, v));
            }
            let mut condition = self.pool.sum(&terms);
            for (v, value) in &fixed {
                condition = self.pool.substitute(condition, &HashMap::from([(*v, *value)]));
            }
            let mut slopes: Vec<(u64, Symbol, Expr)> = Vec::new();
            for &v in &symbols {
                let slope = self.pool.derivative(condition, v);
                let slope = self.pool.simplify(slope);
                if self.pool.is_zero(slope) == Zero::No {
                    slopes.push((self.pool.weight(slope), v, slope));
                }
            }
            let Some((_, v, slope)) = slopes.into_iter().min() else { continue };
            let without = self.pool.substitute(condition, &HashMap::from([(v, Expr::ZERO)]));
            let value = self.pool.div(without, slope);
            let value = self.pool.neg(value);
            fixed.push((v, self.pool.simplify(value)));
        }
        fixed
    }

    /// A coordinate for each holonomic constraint that is linear in it, or contains only its
    /// square.
    pub(super) fn fixed_positions(&mut self) -> Vec<Determined> {
        let symbols: Vec<Symbol> = self.coordinates.iter().map(|c| c.position).collect();
        let holonomic: Vec<Expr> = self.constraints.iter().filter_map(|c| c.position).collect();
        let mut fixed: Vec<Determined> = Vec::new();
        let mut used: Vec<Symbol> = Vec::new();
        for mut f in holonomic {
            for one in &fixed {
                if let Determined::Value(q, value) = one {
                    f = self.pool.substitute(f, &HashMap::from([(*q, *value)]));
                }
            }
            let found = symbols.iter().filter(|q| !used.contains(q)).find_map(|&q| {
                let pool = &mut self.pool;
                let slope = pool.derivative(f, q);
                let curvature = pool.derivative(slope, q);
                let at_zero = HashMap::from([(q, Expr::ZERO)]);
                let rest = pool.substitute(f, &at_zero);
                if pool.is_zero(curvature) == Zero::Proved && pool.is_zero(slope) == Zero::No {
                    let slope = pool.substitute(slope, &at_zero);
                    let value = pool.div(rest, slope);
                    return Some(Determined::Value(q, pool.neg(value)));
                }
                let curvature = pool.simplify(curvature);
                let middle = pool.substitute(slope, &at_zero);
                if pool.depends(curvature, q)
                    || pool.is_zero(middle) != Zero::Proved
                    || pool.is_zero(curvature) != Zero::No
                {
                    return None;
                }
                let value = pool.div(rest, curvature);
                let minus_two = pool.integer(-2);
                Some(Determined::Square(q, pool.mul(minus_two, value)))
            });
            if let Some(one) = found {
                let (Determined::Value(q, _) | Determined::Square(q, _)) = one;
                used.push(q);
                fixed.push(one);
            }
        }
        fixed
    }
}
