//! What a name in an expression stands for.

use crate::expr::{Expr, Symbol};

#[derive(Clone, Copy, Debug)]
pub(super) enum Meaning {
    Symbol(Symbol),
    /// A coordinate: q, q̇ and q̈.
    Position([Symbol; 3]),
    /// A coordinate of the comparison motion, and its velocity.
    Other([Symbol; 2]),
    Defined(Expr),
    /// A name that is defined only after the place of use.
    Later,
}
