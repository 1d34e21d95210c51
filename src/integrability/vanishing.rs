//! Proofs that an expression vanishes.
//!
//! In: an expression of positions and momenta. Out: whether it is proved to be zero. Never here: what it means.

use std::collections::HashMap;

use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::num::Number;

/// How many coordinates are tried as the origin of the others in a proof.
const MOST_ORIGINS: usize = 3;

/// Whether a rate is proved to vanish, as it is or in other coordinates: their halves, which opens half angles, or
/// their differences. Each is a linear map that can be inverted, so that nothing is lost.
pub(super) fn vanishes(pool: &mut Pool, positions: &[Symbol], rate: Expr) -> bool {
    if pool.is_zero(rate) == Zero::Proved {
        return true;
    }
    let doubled = positions.iter().map(|&q| {
        let e = pool.variable(q);
        (q, pool.scale(Number::integer(2), e))
    });
    let doubled: HashMap<Symbol, Expr> = doubled.collect();
    let opened = pool.substitute(rate, &doubled);
    if pool.is_zero(opened) == Zero::Proved {
        return true;
    }
    // where differences of coordinates divide, one of them is the origin of the others
    positions.iter().take(MOST_ORIGINS).any(|&origin| {
        let from = pool.variable(origin);
        let moved = positions.iter().filter(|&&q| q != origin).map(|&q| {
            let e = pool.variable(q);
            (q, pool.add(e, from))
        });
        let moved: HashMap<Symbol, Expr> = moved.collect();
        let shifted = pool.substitute(rate, &moved);
        pool.is_zero(shifted) == Zero::Proved
    })
}
