//! Derivatives in the form that the derivation steps need: simplified, and zero where that can be
//! proved.
//!
//! In: an expression and a symbol. Out: an expression. Never here: which derivatives a law needs.

use std::collections::HashMap;

use crate::expr::{Expr, Pool, Symbol, Zero};

/// ∂e/∂symbol, simplified, and 0 if it can be proved to vanish.
pub(super) fn tidy_derivative(pool: &mut Pool, e: Expr, symbol: Symbol) -> Expr {
    let slope = pool.derivative(e, symbol);
    pool.refuse_heavy(slope);
    if pool.is_full() {
        return Expr::ZERO;
    }
    let slope = zero_if_proved(pool, slope);
    pool.simplify(slope)
}

/// Returns the expression itself, or 0 if it is proved to vanish identically.
pub(super) fn zero_if_proved(pool: &mut Pool, e: Expr) -> Expr {
    if pool.is_zero(e) == Zero::Proved { Expr::ZERO } else { e }
}

/// The same expression where the factors under its roots are positive, with fewer different roots.
pub(super) fn with_common_roots(pool: &mut Pool, e: Expr) -> Expr {
    let opened = pool.open_quotients(e);
    match pool.as_one_root(opened) {
        Some(root) => pool.simplify(root),
        None => pool.simplify(opened),
    }
}

/// Relations in which slopes stand beside symbols of their own, so rewritten; empty where that changes nothing, so that
/// nothing is solved twice.
pub(super) fn relations_with_common_roots(
    pool: &mut Pool,
    relations: &[Expr],
    own: &[Symbol],
) -> Vec<Expr> {
    let mut opened = Vec::new();
    for (&relation, &own) in relations.iter().zip(own) {
        let rest = pool.substitute(relation, &HashMap::from([(own, Expr::ZERO)]));
        let slope = with_common_roots(pool, rest);
        let own = pool.sub(relation, rest);
        opened.push(pool.add(own, slope));
    }
    if opened == relations { Vec::new() } else { opened }
}
