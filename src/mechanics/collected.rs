//! Sums whose terms in the same variables are multiplied out and collected where that is shorter: `½ (P + u)² − u (P + u)` is
//! `½ P² − ½ u²`, beside a fourth power of other variables that stays what it is.
//!
//! In: an expression, the variables by which its terms are distinguished. Out: an equal one, no longer than it. Never here: what it
//! means.

use crate::expr::{Expr, Pool, Symbol};
use crate::num::Number;

/// An equal sum, with the terms in some of the variables collected wherever that is shorter.
pub(super) fn collected(pool: &mut Pool, e: Expr, variables: &[Symbol]) -> Expr {
    let of = |pool: &Pool, term: Expr| -> Vec<Symbol> {
        variables.iter().copied().filter(|&s| pool.depends(term, s)).collect()
    };
    let mut best = e;
    let mut sets: Vec<Vec<Symbol>> =
        pool.summands(e).into_iter().map(|(_, term)| of(pool, term)).collect();
    sets.sort_unstable();
    sets.dedup();
    for set in sets {
        let terms = pool.summands(best);
        // those without variables may cancel with these
        let (near, rest): (Vec<_>, Vec<_>) = terms
            .into_iter()
            .partition(|&(_, term)| of(pool, term).iter().all(|s| set.contains(s)));
        let near = pool.linear(Number::ZERO, &near);
        let opened = pool.multiplied_out(near);
        let mut all = rest;
        all.push((Number::ONE, opened));
        let other = pool.linear(Number::ZERO, &all);
        if pool.weight(other) < pool.weight(best) {
            best = other;
        }
    }
    best
}
