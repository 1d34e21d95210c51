//! Derivatives in the form that the derivation steps need: simplified, and zero where that can be
//! proved.
//!
//! In: an expression and a symbol. Out: an expression. Never here: which derivatives a law needs.

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
