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
        while let Some(then) = self.divided_once(whole) {
            whole = then;
        }
        if whole == e { e } else { self.simplify(whole) }
    }

    fn divided_once(&mut self, e: Expr) -> Option<Expr> {
        self.with_quotient(e, Pool::quotient)
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

    /// The quotient of two sums by long division in a symbol that is a term of the divisor and in none of its others.
    fn quotient(&mut self, whole: Expr, divisor: Expr) -> Option<Expr> {
        let terms = self.summands(divisor);
        let (k, leading) = terms.iter().copied().find(|&(_, term)| {
            let Some(symbol) = self.as_symbol(term) else { return false };
            terms.iter().filter(|(_, other)| self.depends(*other, symbol)).count() == 1
        })?;
        let whole = self.expand(whole, TRIAL_TERMS);
        let (mut rest, mut quotient) = (whole, Expr::ZERO);
        for _ in 0..STEPS {
            if rest == Expr::ZERO {
                return Some(quotient);
            }
            let degree = |pool: &Pool, term: Expr| match pool.node(term) {
                Node::Product(_, factors) => {
                    let power = factors.iter().find(|(base, _)| *base == leading);
                    power.and_then(|(_, n)| n.as_integer()).unwrap_or(0)
                }
                _ => i64::from(term == leading),
            };
            let terms = self.summands(rest);
            let (c, first) = terms.into_iter().max_by_key(|&(_, term)| degree(self, term))?;
            if degree(self, first) < 1 {
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
}
