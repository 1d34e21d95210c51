//! Roots of quadratic equations where the leading coefficient vanishes: (√(b² − 4ac) − b)/2a as −2c/(√(b² − 4ac) + b).
//!
//! In: a written solution, a point. Out: the same with values at the point where it was 0/0. Never here: which root is right.

use super::isolate::Solution;
use super::valuation::Valuation;
use crate::expr::{Expr, Node, Pool};
use crate::num::Number;

/// The same solution, each expression without a value at a point by its conjugate if that has one.
pub(super) fn with_values_at(pool: &mut Pool, found: Solution, point: &Valuation) -> Solution {
    let mut all = Solution::new();
    for (symbol, e) in found {
        let has_value = |pool: &Pool, e: Expr| point.value(pool, e).is_finite();
        let other = if has_value(pool, e) { None } else { conjugate(pool, e) };
        all.push((symbol, other.filter(|&other| has_value(pool, other)).unwrap_or(e)));
    }
    all
}

/// c (A + B √U) D as c (A² − B² U) D/(A − B √U), if an expression is that with one root in one factor.
fn conjugate(pool: &mut Pool, e: Expr) -> Option<Expr> {
    let Node::Product(c, factors) = pool.node(e).clone() else { return None };
    for (place, &(base, n)) in factors.iter().enumerate() {
        let Node::Sum(constant, terms) = pool.node(base).clone() else { continue };
        let is_root = |&(_, term): &(Number, Expr)| match pool.node(term) {
            Node::Product(_, factors) => factors.iter().any(|&(_, n)| n == Number::HALF),
            _ => false,
        };
        let (roots, others): (Vec<_>, Vec<_>) = terms.iter().copied().partition(is_root);
        if !n.is_one() || roots.len() != 1 {
            continue;
        }
        let (root, rest) = (pool.linear(Number::ZERO, &roots), pool.linear(constant, &others));
        let (root_squared, rest_squared) = (pool.powi(root, 2), pool.powi(rest, 2));
        let difference = pool.sub(rest_squared, root_squared);
        let difference = pool.simplify(difference);
        let below = pool.sub(rest, root);
        let mut all = factors.to_vec();
        all[place] = (difference, Number::ONE);
        all.push((below, Number::MINUS_ONE));
        let e = pool.monomial(c, &all);
        return Some(pool.simplify(e));
    }
    None
}
