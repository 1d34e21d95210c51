//! Multiplying out to a sum of monomials: sines and cosines of sums are expanded, and even powers
//! of cosines become sines. Expressions that are equal as polynomials in their symbols, sines and
//! cosines expand to the same one.

use super::memo::Pass;
use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use crate::num::Number;

/// The largest number of terms in a trial; a longer result would not be chosen.
pub(super) const TRIAL_TERMS: usize = 120;

/// The largest number of monomials in a product that is multiplied out in a proof.
pub(super) const PROOF_TERMS: usize = 4000;

impl Pool {
    /// The expression with products of sums multiplied out.
    pub fn multiplied_out(&mut self, e: Expr) -> Expr {
        self.expand(e, PROOF_TERMS)
    }

    /// Multiplies out products of sums and small positive powers of sums, everywhere in `e`, if the
    /// result has no more than `most` terms.
    pub(super) fn expand(&mut self, e: Expr, most: usize) -> Expr {
        let pass = if most == PROOF_TERMS { Pass::ExpandInProof } else { Pass::ExpandInTrial };
        debug_assert!(most == PROOF_TERMS || most == TRIAL_TERMS, "results are kept for each");
        self.rewrite(pass, e, |pool, rebuilt| pool.expand_top(rebuilt, most))
    }

    /// Expands the product at the top of `e`, whose factors are already expanded.
    pub(super) fn expand_top(&mut self, e: Expr, most: usize) -> Expr {
        let shared = self.shared(e);
        let (c, factors) = match &*shared {
            Node::Product(c, factors) => (*c, factors),
            Node::Sum(constant, terms) => {
                let expanded: Vec<(Number, Expr)> =
                    terms.iter().map(|&(c, t)| (c, self.expand_top(t, most))).collect();
                if *expanded == **terms {
                    return e;
                }
                return self.linear(*constant, &expanded);
            }
            _ => return e,
        };
        if !factors.iter().any(|&(base, _)| matches!(self.node(base), Node::Sum(..))) {
            return e;
        }
        let mut single: Vec<(Expr, Number)> = Vec::new();
        let mut sums: Vec<Expr> = Vec::new();
        let mut size = 1_usize;
        for &(base, n) in factors {
            match (self.node(base), n.as_integer()) {
                (Node::Sum(_, terms), Some(k @ 1..=12)) => {
                    for _ in 0..k {
                        size = size.saturating_mul(terms.len() + 1);
                    }
                    sums.extend(std::iter::repeat_n(base, k as usize));
                }
                // a root to a power above 1: s^(3/2) = s · √s
                (Node::Sum(_, terms), None) if (1.0..12.0).contains(&n.value()) => {
                    let whole = n.value().floor() as i64;
                    for _ in 0..whole {
                        size = size.saturating_mul(terms.len() + 1);
                    }
                    sums.extend(std::iter::repeat_n(base, whole as usize));
                    single.push((base, n + Number::integer(-whole)));
                }
                _ => single.push((base, n)),
            }
        }
        if sums.is_empty() || size > most {
            return e;
        }
        let mut total = self.monomial(c, &single);
        for sum in sums {
            total = self.multiply_out(total, sum, most);
        }
        total
    }

    /// `a · b`, term by term.
    fn multiply_out(&mut self, a: Expr, b: Expr, most: usize) -> Expr {
        let (left, right) = (self.summands(a), self.summands(b));
        let mut terms = Vec::with_capacity(left.len() * right.len());
        for &(c, x) in &left {
            for &(d, y) in &right {
                let product = self.mul(x, y);
                let product = self.expand_top(product, most);
                terms.push((c * d, product));
            }
        }
        self.linear(Number::ZERO, &terms)
    }

    /// The terms of a sum with their coefficients; any other expression is its own only term.
    pub fn summands(&self, e: Expr) -> Vec<(Number, Expr)> {
        match self.node(e) {
            Node::Sum(constant, terms) => {
                let mut all = terms.to_vec();
                if !constant.is_zero() {
                    all.push((*constant, Expr::ONE));
                }
                all
            }
            _ => vec![(Number::ONE, e)],
        }
    }

    /// Expands sines and cosines of sums and multiples, and writes tan, cot and tanh as quotients.
    /// The result has only sines and cosines of the simplest arguments.
    pub(super) fn open_angles(&mut self, e: Expr) -> Expr {
        self.rewrite(Pass::OpenAngles, e, |pool, rebuilt| {
            let opened = match pool.shared(rebuilt).as_ref() {
                Node::Call(function, arguments) => pool.open_call(*function, arguments[0]),
                _ => None,
            };
            opened.unwrap_or(rebuilt)
        })
    }

    fn open_call(&mut self, function: FunctionId, argument: Expr) -> Option<Expr> {
        let (above, below) = match function {
            FunctionId::Sin => return self.open_sine(argument).map(|(sine, _)| sine),
            FunctionId::Cos => return self.open_sine(argument).map(|(_, cosine)| cosine),
            FunctionId::Tan => (FunctionId::Sin, FunctionId::Cos),
            FunctionId::Cot => (FunctionId::Cos, FunctionId::Sin),
            FunctionId::Tanh => (FunctionId::Sinh, FunctionId::Cosh),
            _ => return None,
        };
        let above = self.call(above, &[argument]);
        let below = self.call(below, &[argument]);
        let above = self.open_angles(above);
        let below = self.open_angles(below);
        Some(self.div(above, below))
    }

    /// The sine and cosine of a sum or a small multiple, by the addition theorems.
    fn open_sine(&mut self, argument: Expr) -> Option<(Expr, Expr)> {
        let mut parts: Vec<Expr> = Vec::new();
        for (c, term) in self.summands(argument) {
            match c.as_integer() {
                Some(n) if n.abs() <= 4 && term != Expr::ONE => {
                    let unit = if n < 0 { self.neg(term) } else { term };
                    parts.extend(std::iter::repeat_n(unit, n.unsigned_abs() as usize));
                }
                _ => parts.push(self.scale(c, term)),
            }
        }
        if let Node::Product(c, factors) = &*self.shared(argument)
            && let Some(n @ 2..=4) = c.as_integer()
        {
            let unit = self.finish_product(Number::ONE, factors.to_vec());
            parts = vec![unit; n as usize];
        }
        if parts.len() < 2 || parts.len() > 6 {
            return None;
        }
        let (mut sine, mut cosine) = (Expr::ZERO, Expr::ONE);
        for part in parts {
            let (s, c) = (self.call(FunctionId::Sin, &[part]), self.call(FunctionId::Cos, &[part]));
            let (a, b) = (self.mul(sine, c), self.mul(cosine, s));
            let (d, f) = (self.mul(cosine, c), self.mul(sine, s));
            sine = self.add(a, b);
            cosine = self.sub(d, f);
        }
        Some((sine, cosine))
    }

    /// Replaces `cos²u → 1 − sin²u` and `cosh²u → 1 + sinh²u` in an expanded expression, and
    /// multiplies out again.
    pub(super) fn reduce_squares(&mut self, e: Expr, most: usize) -> Expr {
        let mut terms = self.summands(e);
        let mut any = false;
        for (_, term) in &mut terms {
            let shared = self.shared(*term);
            let factors = match &*shared {
                Node::Product(k, factors) if k.is_one() => factors,
                _ => &[(*term, Number::ONE)][..],
            };
            let mut reduced = Vec::new();
            for (i, &(base, n)) in factors.iter().enumerate() {
                if let Some((square, k)) = self.square_of(base, n) {
                    if reduced.is_empty() {
                        reduced.extend_from_slice(&factors[..i]);
                    }
                    reduced.push((square, Number::integer(k.div_euclid(2))));
                    reduced.push((base, Number::integer(k.rem_euclid(2))));
                } else if !reduced.is_empty() {
                    reduced.push((base, n));
                }
            }
            if !reduced.is_empty() {
                let product = self.monomial(Number::ONE, &reduced);
                *term = self.expand_top(product, most);
                any = true;
            }
        }
        if any { self.linear(Number::ZERO, &terms) } else { e }
    }

    /// For `cos^n u`, `n ≥ 2`: `cos²u` in terms of sines, and `n`. Likewise for `cosh`.
    fn square_of(&mut self, base: Expr, n: Number) -> Option<(Expr, i64)> {
        let k = n.as_integer().filter(|k| *k >= 2)?;
        let (other, sign, argument) = match self.node(base) {
            Node::Call(FunctionId::Cos, u) => (FunctionId::Sin, Number::MINUS_ONE, u[0]),
            Node::Call(FunctionId::Cosh, u) => (FunctionId::Sinh, Number::ONE, u[0]),
            _ => return None,
        };
        let other = self.call(other, &[argument]);
        let square = self.powi(other, 2);
        Some((self.linear(Number::ONE, &[(sign, square)]), k))
    }
}
