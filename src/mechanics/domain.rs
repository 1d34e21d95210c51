//! The domain of a law that was written with roots: (√x)² simplifies to x, but only for x ≥ 0.
//!
//! In: a model with its equations. Out: expressions that must not be negative, although no root of
//! them remains. Never here: domains of functions that remain; their values show these.

use super::equations::Equations;
use crate::expr::{Expr, Node, Symbol, is_never_negative};
use crate::model::Model;
use crate::num::Number;

/// Returns the expressions of the motion that occurred under an even root in the file's law but occur under none now.
/// Where one of them is negative, the file's law has no value although the equations do. Expressions that cannot be
/// negative are omitted.
pub fn widened(model: &Model, equations: &Equations) -> Vec<Expr> {
    let pool = &model.pool;
    let coordinates = model.coordinates.iter();
    let mut moving: Vec<Symbol> =
        coordinates.flat_map(|c| [c.position, c.velocity, c.momentum]).collect();
    moving.push(model.symbols.time);
    let is_root = |n: &Number| matches!(n, Number::Rational(_, below) if below % 2 == 0);
    let law = model.mechanics.function().1;
    let reachable = [
        (pool, pool.reachable(&[law])),
        (&equations.pool, equations.pool.reachable(&[equations.energy])),
    ];
    let remains = |e: Expr| {
        reachable.iter().any(|(pool, nodes)| {
            nodes.iter().any(|&node| match pool.node(node) {
                Node::Product(_, factors) => factors.iter().any(|(b, n)| *b == e && is_root(n)),
                _ => false,
            })
        })
    };
    let roots = pool.under_roots().iter().copied();
    let may_be_negative = |e: Expr| !is_never_negative(pool, e);
    let counts = |&e: &Expr| pool.depends_on_any(e, &moving) && may_be_negative(e) && !remains(e);
    roots.filter(counts).collect()
}
