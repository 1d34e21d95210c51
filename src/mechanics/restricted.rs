//! Functions of the state where the constraints hold: there less of the state is left, and what vanished at a point or
//! on a line may vanish on a surface. √(x² + y²) has no kink in the plane, and on y = 0 it is |x|.
//!
//! In: a function of (q, q̇, t). Out: whether it may vanish on a surface of the states that satisfy the constraints, and
//! whether a quotient of such functions may jump there; where that is not decided, it may. Never here: rates of change.

use std::collections::HashMap;

use super::equations::Equations;
use super::modulo::Determined;
use crate::expr::{Expr, FunctionId, Node, Symbol, Zero};

/// What the constraints determine.
pub(super) struct Restriction {
    velocities: Vec<(Symbol, Expr)>,
    positions: Vec<Determined>,
    /// Whether each holonomic constraint determines a coordinate, or its square.
    complete: bool,
}

impl Equations {
    /// What the constraints determine, or `None` if there are none.
    fn restriction(&mut self) -> Option<Restriction> {
        if self.constraints.is_empty() {
            return None;
        }
        let velocities = self.fixed_velocities();
        let positions = self.fixed_positions();
        let holonomic = self.constraints.iter().filter(|c| c.position.is_some()).count();
        let complete = positions.len() == holonomic;
        Some(Restriction { velocities, positions, complete })
    }

    /// Whether a root in an expression may have a kink where the constraints hold: whether what stands under it may
    /// vanish there on a surface. Without constraints there is nothing to find here.
    pub fn has_kink_on_constraints(&mut self, e: Expr) -> bool {
        self.restriction().is_some_and(|restriction| self.is_kinked_there(&restriction, e))
    }

    /// Whether a quotient in an expression may have another limit on each side of a surface of the states that satisfy
    /// the constraints.
    pub(super) fn may_jump_on_constraints(&mut self, e: Expr) -> bool {
        let Some(restriction) = self.restriction() else { return false };
        self.pool.reachable(&[e]).into_iter().any(|part| {
            let below = match self.pool.node(part).clone() {
                Node::Call(FunctionId::Atan, argument) => {
                    let parts = self.pool.reachable(&argument);
                    parts.into_iter().flat_map(|e| self.divisors(e)).map(|(e, _)| e).collect()
                }
                Node::Product(..) => {
                    let mut below = self.divisors(part);
                    if below.is_empty() {
                        return false;
                    }
                    let kinked = self.is_kinked_there(&restriction, part);
                    below.retain(|(_, root)| *root || kinked);
                    below.into_iter().map(|(e, _)| e).collect()
                }
                _ => Vec::new(),
            };
            below
                .into_iter()
                .any(|e| self.may_vanish_there(&restriction, e) && !self.is_proved_constant(e))
        })
    }

    /// Whether the rate of a function is proved to vanish.
    fn is_proved_constant(&mut self, e: Expr) -> bool {
        self.rate_of(e).is_some_and(|rate| {
            self.pool.is_zero(rate) == Zero::Proved || self.vanishes_on_constraints(rate)
        })
    }

    /// The bases of negative powers of a product, and whether the power is a root.
    pub(super) fn divisors(&self, e: Expr) -> Vec<(Expr, bool)> {
        let Node::Product(_, factors) = self.pool.node(e) else { return Vec::new() };
        let below = factors.iter().filter(|(_, power)| power.is_negative());
        below.map(|&(base, power)| (base, power.as_integer().is_none())).collect()
    }

    fn is_kinked_there(&mut self, restriction: &Restriction, e: Expr) -> bool {
        self.pool.reachable(&[e]).into_iter().any(|part| match self.pool.node(part).clone() {
            Node::Call(
                FunctionId::Abs | FunctionId::Max | FunctionId::Min | FunctionId::Sign,
                argument,
            ) => self.pool.depends_on_any(argument[0], &self.moving()),
            // |u| is also e^{½ ln u²}
            Node::Call(FunctionId::Ln, argument) => self.may_vanish_there(restriction, argument[0]),
            Node::Product(_, factors) => {
                let roots = factors.into_iter().filter(|(_, n)| n.as_integer().is_none());
                let roots: Vec<Expr> = roots.map(|(base, _)| base).collect();
                roots.into_iter().any(|base| self.may_vanish_there(restriction, base))
            }
            _ => false,
        })
    }

    /// Whether a function may vanish on a surface of the states that satisfy the constraints.
    fn may_vanish_there(&mut self, restriction: &Restriction, e: Expr) -> bool {
        let moving = self.moving();
        if !self.pool.depends_on_any(e, &moving) {
            return false;
        }
        let mut rest = self.open(e);
        for (v, value) in &restriction.velocities {
            rest = self.pool.substitute(rest, &HashMap::from([(*v, *value)]));
        }
        for fixed in &restriction.positions {
            if let Determined::Value(q, value) = fixed {
                rest = self.pool.substitute(rest, &HashMap::from([(*q, *value)]));
            }
        }
        rest = self.pool.numerator(rest);
        let mut curved = Vec::new();
        for fixed in &restriction.positions {
            if let Determined::Square(q, value) = fixed {
                rest = self.pool.with_square(rest, *q, *value);
                curved.push(*q);
                curved.extend(self.pool.symbols_of(*value));
            }
        }
        rest = self.pool.simplify(rest);
        if self.pool.is_full() || self.pool.is_zero(rest) == Zero::Proved {
            return true;
        }
        if !self.pool.depends_on_any(rest, &moving) {
            return false;
        }
        // lines are followed only where what is left of the state is free
        curved.retain(|s| moving.contains(s));
        if !restriction.complete || self.pool.depends_on_any(rest, &curved) {
            return true;
        }
        self.pool.vanishes(rest, &moving)
    }
}
