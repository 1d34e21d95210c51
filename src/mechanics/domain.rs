//! Where a law holds that was written with roots: (√x)² is x, but for x ≥ 0 only.
//!
//! In: a model with its equations. Out: what must not be below zero, though no root of it is left to
//! say so. Never here: domains of functions that are left; these say so themselves.

use super::equations::Equations;
use crate::expr::{Expr, Node, Symbol};
use crate::model::Model;
use crate::num::Number;

/// Expressions of the motion that stood under even roots in the file and are nowhere under one in
/// the energy: where they are below zero, the file's law has no value and the equations do.
pub fn widened(model: &Model, equations: &Equations) -> Vec<Expr> {
    let pool = &model.pool;
    let coordinates = model.coordinates.iter();
    let mut moving: Vec<Symbol> =
        coordinates.flat_map(|c| [c.position, c.velocity, c.momentum]).collect();
    moving.push(model.symbols.time);
    let is_root = |n: &Number| matches!(n, Number::Rational(_, below) if below % 2 == 0);
    let reachable = equations.pool.reachable(&[equations.energy]);
    let kept = |e: Expr| {
        reachable.iter().any(|&node| match equations.pool.node(node) {
            Node::Product(_, factors) => factors.iter().any(|(b, n)| *b == e && is_root(n)),
            _ => false,
        })
    };
    let roots = pool.under_roots().iter().copied();
    roots.filter(|&e| pool.depends_on_any(e, &moving) && !kept(e)).collect()
}
