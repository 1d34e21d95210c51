//! Division of sums: `(x² − 2 x y + y²)/(x − y)²` as `1`, `(x² − x y)/(x − y)²` as `x/(x − y)`.
//!
//! In: an expression. Out: the same one, with what its numerator and its denominator have in common cancelled. Never here:
//! quotients that are not sums, and greatest common divisors that the denominator does not show as a factor.

use super::expand::TRIAL_TERMS;
use super::node::{Expr, Node};
use super::pool::Pool;
use super::product::Factor;
use crate::num::Number;

/// The most terms of a quotient, each found from the leading one of what is left.
const STEPS: usize = 24;

impl Pool {
    /// A fraction with the sums cancelled that are factors below and divide a sum above.
    pub fn divided_out(&mut self, e: Expr) -> Expr {
        let mut whole = e;
        while let Some(then) = self.with_quotient(whole, Pool::exact_quotient) {
            whole = then;
        }
        if whole == e { e } else { self.simplify(whole) }
    }

    /// A fraction with the first sum above that has a quotient by a sum below in its place.
    pub(super) fn with_quotient(
        &mut self,
        e: Expr,
        quotient: fn(&mut Pool, Expr, Expr) -> Option<Expr>,
    ) -> Option<Expr> {
        let Node::Product(c, factors) = &*self.shared(e) else { return None };
        let is_sum = |(base, _): &&Factor| matches!(self.node(*base), Node::Sum(..));
        let (above, below): (Vec<Factor>, Vec<Factor>) =
            factors.iter().filter(is_sum).partition(|(_, n)| !n.is_negative());
        for &(whole, _) in above.iter().filter(|(_, n)| n.is_one()) {
            for &(divisor, n) in below.iter().filter(|(_, n)| n.as_integer().is_some()) {
                let Some(quotient) = quotient(self, whole, divisor) else { continue };
                let untouched = factors.iter().filter(|(base, _)| ![whole, divisor].contains(base));
                let mut left: Vec<Factor> = untouched.copied().collect();
                left.extend([(quotient, Number::ONE), (divisor, n + Number::ONE)]);
                return Some(self.monomial(*c, &left));
            }
        }
        None
    }

    /// The quotient of two sums, if it is a sum itself: long division by the leading term of the divisor.
    pub(super) fn exact_quotient(&mut self, whole: Expr, divisor: Expr) -> Option<Expr> {
        let (k, leading) = self.leading_term(divisor)?;
        let below = self.monomial_factors(leading);
        let whole = self.expand(whole, TRIAL_TERMS);
        let (mut rest, mut quotient) = (whole, Expr::ZERO);
        for _ in 0..STEPS {
            if rest == Expr::ZERO {
                return Some(quotient);
            }
            let (c, first) = self.leading_term(rest)?;
            let above = self.monomial_factors(first);
            let divides =
                |&(base, n): &Factor| above.iter().any(|&(other, m)| other == base && m >= n);
            if !below.iter().all(divides) {
                return None;
            }
            let next = self.div(first, leading);
            let next = self.scale(c * k.recip(), next);
            quotient = self.add(quotient, next);
            let taken = self.mul(next, divisor);
            let left = self.sub(rest, taken);
            rest = self.expand(left, TRIAL_TERMS);
        }
        None
    }

    /// The term with the highest power of the last base, of those the one with the highest power of the last but one, and so
    /// on: the lexicographic order of monomials.
    fn leading_term(&self, sum: Expr) -> Option<(Number, Expr)> {
        self.summands(sum).into_iter().max_by_key(|&(_, term)| self.monomial_factors(term))
    }

    /// The factors of a term, the last base first.
    fn monomial_factors(&self, term: Expr) -> Vec<Factor> {
        let mut factors = match self.node(term) {
            Node::Number(_) => Vec::new(),
            Node::Product(_, factors) => factors.to_vec(),
            _ => vec![(term, Number::ONE)],
        };
        factors.sort_unstable_by(|a, b| b.cmp(a));
        factors
    }
}
