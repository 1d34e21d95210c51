//! Sums in canonical form: like terms collected, nested sums flattened, numbers combined.

use super::node::{Expr, Node};
use super::pool::Pool;
use crate::num::Number;

impl Pool {
    /// `a + b`.
    pub fn add(&mut self, a: Expr, b: Expr) -> Expr {
        self.linear(Number::ZERO, &[(Number::ONE, a), (Number::ONE, b)])
    }

    /// `a − b`.
    pub fn sub(&mut self, a: Expr, b: Expr) -> Expr {
        self.linear(Number::ZERO, &[(Number::ONE, a), (Number::MINUS_ONE, b)])
    }

    /// `−a`.
    pub fn neg(&mut self, a: Expr) -> Expr {
        self.scale(Number::MINUS_ONE, a)
    }

    /// `n · a`.
    pub fn scale(&mut self, n: Number, a: Expr) -> Expr {
        self.linear(Number::ZERO, &[(n, a)])
    }

    /// `Σ parts`.
    pub fn sum(&mut self, parts: &[Expr]) -> Expr {
        let terms: Vec<(Number, Expr)> = parts.iter().map(|&e| (Number::ONE, e)).collect();
        self.linear(Number::ZERO, &terms)
    }

    /// `constant + Σ coefficient · expression`, the general constructor of sums.
    pub fn linear(&mut self, constant: Number, parts: &[(Number, Expr)]) -> Expr {
        let mut constant = constant;
        let mut terms: Vec<(Number, Expr)> = Vec::with_capacity(parts.len());
        for &(c, e) in parts {
            if c.is_zero() {
                continue;
            }
            if let Node::Symbol(_) | Node::Call(..) = self.node(e) {
                terms.push((c, e));
                continue;
            }
            match &*self.shared(e) {
                Node::Number(n) => constant = constant + c * *n,
                Node::Sum(inner, list) => {
                    constant = constant + c * *inner;
                    terms.extend(list.iter().map(|&(k, t)| (c * k, t)));
                }
                Node::Product(k, factors) if !k.is_one() => {
                    let bare = self.finish_product(Number::ONE, factors.to_vec());
                    terms.push((c * *k, bare));
                }
                _ => terms.push((c, e)),
            }
        }
        terms.sort_unstable_by_key(|&(_, e)| e);
        terms.dedup_by(|&mut (c, e), (total, last)| {
            let is_equal = *last == e;
            if is_equal {
                *total = *total + c;
            }
            is_equal
        });
        // sums of reals may equal a number that has an exact form: 1 − 1e-22 is the number one
        let constant = constant.canonical();
        for (c, _) in &mut terms {
            *c = c.canonical();
        }
        terms.retain(|(c, _)| !c.is_zero());
        match terms.as_slice() {
            [] => self.number(constant),
            &[(c, e)] if constant.is_zero() => self.scaled_term(c, e),
            _ => self.intern(Node::Sum(constant, terms.into_boxed_slice())),
        }
    }

    /// `c · e` for a term that is neither a number nor a sum and carries no coefficient.
    fn scaled_term(&mut self, c: Number, e: Expr) -> Expr {
        if c.is_one() {
            return e;
        }
        match &*self.shared(e) {
            Node::Product(_, factors) => self.intern(Node::Product(c, factors.clone())),
            _ => self.intern(Node::Product(c, Box::new([(e, Number::ONE)]))),
        }
    }
}
