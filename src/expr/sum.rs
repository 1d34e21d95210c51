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

    /// `n · a` for a number `n`.
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
        let mut terms: Vec<(Expr, Number)> = Vec::with_capacity(parts.len());
        for &(c, e) in parts {
            if c.is_zero() {
                continue;
            }
            match &*self.shared(e) {
                Node::Number(n) => constant = constant + c * *n,
                Node::Sum(inner, list) => {
                    constant = constant + c * *inner;
                    terms.extend(list.iter().map(|&(k, t)| (t, c * k)));
                }
                Node::Product(k, factors) if !k.is_one() => {
                    let bare = self.finish_product(Number::ONE, factors.to_vec());
                    terms.push((bare, c * *k));
                }
                _ => terms.push((e, c)),
            }
        }
        terms.sort_unstable_by_key(|&(e, _)| e);
        let mut merged: Vec<(Number, Expr)> = Vec::with_capacity(terms.len());
        for (e, c) in terms {
            match merged.last_mut() {
                Some((total, last)) if *last == e => *total = *total + c,
                _ => merged.push((c, e)),
            }
        }
        // sums of reals may equal a number that has an exact form: 1 − 1e-22 is the number one
        let constant = constant.canonical();
        for (c, _) in &mut merged {
            *c = c.canonical();
        }
        merged.retain(|(c, _)| !c.is_zero());
        match merged.as_slice() {
            [] => self.number(constant),
            &[(c, e)] if constant.is_zero() => self.scaled_term(c, e),
            _ => self.intern(Node::Sum(constant, merged.into_boxed_slice())),
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
