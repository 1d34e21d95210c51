//! A function of its own inverse, and parts replaced by others.
//!
//! In: an expression. Out: an expression without `sin(asin(u))`, `cot(atan2(y, x))`, `exp(ln(u))`
//! and their kin, equal wherever the old one is defined; or one with a part exchanged. Never here:
//! the branch of an inverse.

use rustc_hash::FxHashMap;

use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use crate::num::Number;

impl Pool {
    /// `e` with every occurrence of a part replaced.
    pub fn replace(&mut self, e: Expr, part: Expr, by: Expr) -> Expr {
        let mut done: FxHashMap<Expr, Expr> = FxHashMap::default();
        for node in self.reachable(&[e]) {
            if self.is_stopped() {
                return e;
            }
            let replaced = if node == part { by } else { self.rebuild_from(node, &done) };
            done.insert(node, replaced);
        }
        done.get(&e).copied().unwrap_or(e)
    }

    /// An equal expression in which no function is applied to its own inverse, nor a circular
    /// function to an angle that is given by a ratio: `sin(atan2(y, x)) = y/√(x² + y²)`.
    pub fn open_inverses(&mut self, e: Expr) -> Expr {
        self.each_part(e, |pool, part| pool.opened(part).unwrap_or(part))
    }

    /// An equal expression with sines and cosines in place of tangents and cotangents.
    pub fn open_tangents(&mut self, e: Expr) -> Expr {
        self.each_part(e, |pool, part| {
            let (above, below) = match pool.node(part) {
                Node::Call(FunctionId::Tan, _) => (FunctionId::Sin, FunctionId::Cos),
                Node::Call(FunctionId::Cot, _) => (FunctionId::Cos, FunctionId::Sin),
                _ => return part,
            };
            let arguments = pool.node(part).parts();
            let (above, below) = (pool.call(above, &arguments), pool.call(below, &arguments));
            pool.div(above, below)
        })
    }

    /// The value of a function at an inverse function.
    fn opened(&mut self, e: Expr) -> Option<Expr> {
        use FunctionId::{Acos, Asin, Atan, Atan2, Cos, Cosh, Cot, Exp, Ln, Sin, Sinh, Tan, Tanh};
        let Node::Call(outer, arguments) = self.node(e) else { return None };
        let (outer, argument) = (*outer, *arguments.first()?);
        let Node::Call(inner, arguments) = self.node(argument) else { return None };
        let (inner, arguments) = (*inner, arguments.to_vec());
        let u = *arguments.first()?;
        match (outer, inner) {
            (Exp, Ln) | (Ln, Exp) => return Some(u),
            (Sinh | Cosh | Tanh, Ln) => {
                let inverse = self.powi(u, -1);
                let (plus, minus) = (self.add(u, inverse), self.sub(u, inverse));
                return Some(match outer {
                    Sinh => self.scale(Number::HALF, minus),
                    Cosh => self.scale(Number::HALF, plus),
                    _ => self.div(minus, plus),
                });
            }
            _ => {}
        }
        // the sides of a triangle with that angle
        let (opposite, adjacent, hypotenuse) = match inner {
            Asin | Acos => {
                let square = self.powi(u, 2);
                let rest = self.sub(Expr::ONE, square);
                let root = self.sqrt(rest);
                if inner == Asin { (u, root, Expr::ONE) } else { (root, u, Expr::ONE) }
            }
            Atan | Atan2 => {
                let adjacent = if inner == Atan { Expr::ONE } else { *arguments.get(1)? };
                let squares = [self.powi(u, 2), self.powi(adjacent, 2)];
                let sum = self.sum(&squares);
                (u, adjacent, self.sqrt(sum))
            }
            _ => return None,
        };
        Some(match outer {
            Sin => self.div(opposite, hypotenuse),
            Cos => self.div(adjacent, hypotenuse),
            Tan => self.div(opposite, adjacent),
            Cot => self.div(adjacent, opposite),
            _ => return None,
        })
    }
}
