//! Derivatives as the arrows want them: simplified, and zero where that can be proved.
//!
//! In: an expression, a symbol. Out: an expression. Never here: which derivatives a law needs.

use crate::expr::{Expr, Pool, Symbol, Zero};

/// ∂e/∂symbol, simplified, and 0 where it can be proved to vanish.
pub(super) fn tidy_derivative(pool: &mut Pool, e: Expr, symbol: Symbol) -> Expr {
    let slope = pool.derivative(e, symbol);
    pool.refuse_heavy(slope);
    if pool.is_full() {
        return Expr::ZERO;
    }
    let slope = zero_if_proved(pool, slope);
    pool.simplify(slope)
}

/// The expression itself, or 0 where it is proved to vanish identically.
pub(super) fn zero_if_proved(pool: &mut Pool, e: Expr) -> Expr {
    if pool.is_zero(e) == Zero::Proved { Expr::ZERO } else { e }
}
