//! Kinks of a law that is not smooth.
//!
//! In: a model, its ramps included. Out: whether its law switches anywhere but at the ends of smooth ramps. Never here: where a
//! motion meets a kink.

use super::Model;
use crate::expr::{Expr, FunctionId, Node, Rule};

impl Model {
    /// Whether `abs`, `sign`, `min`, `max` or the cut of an `atan2` is applied in the law to anything but parameters and `located`
    /// functions, apart from the progress of ramps that begin and end smoothly. Constraints belong to the law.
    pub fn has_kinks_beside_smooth_ramps(&self, located: &[Expr]) -> bool {
        let mut mechanics = self.mechanics.clone();
        let mut roots: Vec<Expr> = mechanics.expressions_mut().into_iter().map(|e| *e).collect();
        roots.extend(self.constraints.iter().map(|constraint| constraint.expression));
        let ramped = |e: Expr| self.ramped.is_smooth_progress(e);
        let reached = self.pool.reachable_until(&roots, ramped);
        let is_located = |e: Expr| match self.pool.node(e) {
            Node::Call(FunctionId::Sign | FunctionId::Abs, argument) => {
                located.contains(&argument[0])
            }
            _ => false,
        };
        let mut pool = self.pool.clone();
        let is_angle = |e: Expr| matches!(self.pool.node(e), Node::Call(FunctionId::Atan2, _));
        let mut shows_its_cut = |e: Expr| !roots.iter().all(|&law| pool.has_whole_turns(law, e));
        reached.into_iter().any(|e| {
            self.is_switch(e)
                && !is_located(e)
                && !self.is_constant_between(e, located)
                && (!is_angle(e) || shows_its_cut(e))
        })
    }

    /// Whether an expression changes at the zeros of `located` functions only, as max(0, sign(t)) does.
    fn is_constant_between(&self, e: Expr, located: &[Expr]) -> bool {
        let node = self.pool.node(e);
        match node {
            Node::Call(FunctionId::Sign, argument) if located.contains(&argument[0]) => true,
            Node::Symbol(symbol) => self.parameters.iter().any(|p| p.symbol == *symbol),
            _ => node.parts().into_iter().all(|part| self.is_constant_between(part, located)),
        }
    }

    /// Whether the law has an angle that is folded back, as acos(cos(x)) and asin(sin(x)): it has kinks where the function in it
    /// is 1 or −1, which it touches and does not pass.
    pub fn has_folded_angles(&self) -> bool {
        let mut mechanics = self.mechanics.clone();
        let mut roots: Vec<Expr> = mechanics.expressions_mut().into_iter().map(|e| *e).collect();
        roots.extend(self.constraints.iter().map(|constraint| constraint.expression));
        let is_fixed = |symbol| self.parameters.iter().any(|p| p.symbol == symbol);
        let moves =
            |e: Expr| matches!(*self.pool.node(e), Node::Symbol(symbol) if !is_fixed(symbol));
        let is_wave =
            |e: Expr| matches!(self.pool.node(e), Node::Call(FunctionId::Sin | FunctionId::Cos, _));
        let folds = |e: Expr| match self.pool.node(e) {
            Node::Call(FunctionId::Asin | FunctionId::Acos, arguments) => {
                arguments.iter().any(|&argument| is_wave(argument))
                    && self.pool.reachable(&[e]).into_iter().any(moves)
            }
            _ => false,
        };
        self.pool.reachable(&roots).into_iter().any(folds)
    }

    /// Whether an expression switches where something other than a parameter has a value.
    fn is_switch(&self, e: Expr) -> bool {
        let Node::Call(function, arguments) = self.pool.node(e) else { return false };
        // the cut of atan2(y, x) lies where x < 0
        let has_cut = || !self.is_positive_constant(arguments[1]);
        let switches = match function {
            FunctionId::Atan2 => has_cut(),
            _ => matches!(function.row().rule, Rule::Branch(_)),
        };
        let is_fixed = |symbol| self.parameters.iter().any(|p| p.symbol == symbol);
        let moves =
            |e: Expr| matches!(*self.pool.node(e), Node::Symbol(symbol) if !is_fixed(symbol));
        switches && self.pool.reachable(&[e]).into_iter().any(moves)
    }

    /// Whether an expression is a number above zero, or a parameter whose value is.
    fn is_positive_constant(&self, e: Expr) -> bool {
        match self.pool.node(e) {
            Node::Symbol(symbol) => {
                self.parameters.iter().any(|p| p.symbol == *symbol && p.value > 0.0)
            }
            _ => self.pool.as_number(e).is_some_and(|n| n.value() > 0.0),
        }
    }
}
