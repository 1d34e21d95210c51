//! Whether a function may have a kink or a jump where its derivatives, piece by piece, do not show it.
//!
//! In: an expression. Out: yes, or that it is smooth wherever it has a value. Identities between derivatives are proved on
//! each side of a kink; what is concluded from them for the whole function needs that there is none. Never here: where
//! the kinks lie, and proofs.

use super::function::Rule;
use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use super::symbol::Symbol;

impl Pool {
    /// Whether an expression may have a kink or a jump as a function of the `moving` symbols: through abs, sign, min or
    /// max, a root of what touches zero on a surface, or an inverse function of what is no polynomial.
    pub fn may_have_kink(&self, e: Expr, moving: &[Symbol]) -> bool {
        let parts = self.reachable(&[e]);
        parts.into_iter().filter(|&part| self.depends_on_any(part, moving)).any(|part| {
            match self.node(part) {
                Node::Call(FunctionId::Atan2, _) => true,
                Node::Call(FunctionId::Asin | FunctionId::Acos | FunctionId::Atan, arguments) => {
                    !arguments.iter().all(|&u| self.is_polynomial(u, moving))
                }
                Node::Call(function, _) => matches!(function.row().rule, Rule::Branch(_)),
                Node::Product(_, factors) => factors.iter().any(|&(base, n)| {
                    n.as_integer().is_none()
                        && self.depends_on_any(base, moving)
                        && self.touches_zero(base, moving)
                }),
                Node::Power(base, exponent) => {
                    !self.depends_on_any(*exponent, moving) && self.touches_zero(*base, moving)
                }
                Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Sum(..) => false,
            }
        })
    }

    /// Whether an expression is a polynomial in the `moving` symbols.
    fn is_polynomial(&self, e: Expr, moving: &[Symbol]) -> bool {
        let parts = self.reachable(&[e]);
        parts.into_iter().filter(|&part| self.depends_on_any(part, moving)).all(|part| {
            match self.node(part) {
                Node::Product(_, factors) => factors.iter().all(|&(base, n)| {
                    !self.depends_on_any(base, moving) || n.as_integer().is_some_and(|n| n >= 0)
                }),
                Node::Call(..) | Node::Power(..) => false,
                Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Sum(..) => true,
            }
        })
    }
}
