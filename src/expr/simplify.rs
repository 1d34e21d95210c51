//! Shortening an expression without changing its value: terms are combined by trigonometric
//! identities, common factors are taken out, and products are multiplied out if that is shorter.

use super::expand::TRIAL_TERMS;
use super::memo::Pass;
use super::node::{Expr, Node};
use super::pool::Pool;
use crate::num::Number;

/// The largest weight of an expression that is multiplied out on trial; heavier ones are only
/// combined and factored.
pub(super) const TRIAL_LIMIT: u64 = 400;

/// The largest number of sums that are combined into one denominator.
const MOST_DENOMINATORS: usize = 3;

impl Pool {
    /// An equal expression, no longer than `e` and often shorter.
    pub fn simplify(&mut self, e: Expr) -> Expr {
        if self.is_stopped() {
            return e;
        }
        if let Some(known) = self.memo.get(Pass::Simplify, e) {
            return known;
        }
        let simpler = self.simplified_anew(e);
        self.remember(Pass::Simplify, e, simpler);
        simpler
    }

    fn simplified_anew(&mut self, e: Expr) -> Expr {
        let mut best = self.simplify_parts(e);
        if self.weight(e) <= TRIAL_LIMIT {
            let expanded = self.expand(e, TRIAL_TERMS);
            let candidate = self.simplify_parts(expanded);
            best = self.lighter(best, candidate);
            let opened = self.open_angles(e);
            let opened = self.expand(opened, TRIAL_TERMS);
            let opened = self.reduce_squares(opened, TRIAL_TERMS);
            let candidate = self.simplify_parts(opened);
            best = self.lighter(best, candidate);
            if let Some(candidate) = self.over_one_line(expanded) {
                best = self.lighter(best, candidate);
            }
        }
        self.lighter(e, best)
    }

    /// A sum of fractions as one fraction: `a − a/(1 + b) → a b/(1 + b)`. Returns `None` if no
    /// denominator is a sum, or too many are.
    fn over_one_line(&mut self, e: Expr) -> Option<Expr> {
        let terms = self.summands(e);
        if terms.len() < 2 {
            return None;
        }
        let mut below: Vec<(Expr, Number)> = Vec::new();
        for &(_, term) in &terms {
            let Node::Product(_, factors) = self.node(term) else { continue };
            for &(base, n) in factors.iter().filter(|(_, n)| n.is_negative()) {
                if n.as_integer().is_none() || !matches!(self.node(base), Node::Sum(..)) {
                    continue;
                }
                match below.iter_mut().find(|(known, _)| *known == base) {
                    Some((_, least)) => *least = (*least).min(n),
                    None => below.push((base, n)),
                }
            }
        }
        if below.is_empty() || below.len() > MOST_DENOMINATORS {
            return None;
        }
        let raised: Vec<(Expr, Number)> = below.iter().map(|&(base, n)| (base, -n)).collect();
        let above = self.monomial(Number::ONE, &raised);
        let lifted: Vec<(Number, Expr)> =
            terms.into_iter().map(|(c, term)| (c, self.mul(term, above))).collect();
        let numerator = self.linear(Number::ZERO, &lifted);
        let numerator = self.expand(numerator, TRIAL_TERMS);
        let numerator = self.simplify_parts(numerator);
        let line = self.monomial(Number::ONE, &below);
        Some(self.mul(numerator, line))
    }

    /// An equal sum whose terms are simplified one by one, so that a kinetic and a potential part
    /// remain separate. They are combined across terms only if that is much shorter.
    pub fn simplify_terms(&mut self, e: Expr) -> Expr {
        let terms: Vec<(Number, Expr)> =
            self.summands(e).into_iter().map(|(c, term)| (c, self.simplify(term))).collect();
        let apart = self.linear(Number::ZERO, &terms);
        let joined = self.simplify(e);
        let (joined_cost, apart_cost) = (self.cost(joined), self.cost(apart));
        if joined_cost.saturating_mul(5) < apart_cost.saturating_mul(3) { joined } else { apart }
    }

    fn lighter(&self, a: Expr, b: Expr) -> Expr {
        if self.cost(b) < self.cost(a) { b } else { a }
    }

    pub(super) fn simplify_parts(&mut self, e: Expr) -> Expr {
        self.rewrite(Pass::Shorten, e, |pool, rebuilt| {
            let joined = pool.join_terms(rebuilt);
            let factored = pool.factor_out(joined);
            pool.lighter(joined, factored)
        })
    }

    /// A sum with its common factors taken out: `a x² + a x y → a x (x + y)`.
    pub(super) fn factor_out(&mut self, e: Expr) -> Expr {
        let shared = self.shared(e);
        let Node::Sum(constant, terms) = &*shared else { return e };
        if !constant.is_zero() {
            return e;
        }
        let mut common = self.factors_of(terms[0].1);
        for &(_, term) in &terms[1..] {
            let alone = [(term, Number::ONE)];
            let list = match self.node(term) {
                Node::Product(k, factors) if k.is_one() => &**factors,
                _ => &alone,
            };
            common.retain_mut(|(base, n)| match list.iter().find(|(b, _)| b == base) {
                Some((_, m)) if m.is_negative() == n.is_negative() => {
                    *n = if n.is_negative() { (*n).max(*m) } else { (*n).min(*m) };
                    true
                }
                _ => false,
            });
            if common.is_empty() {
                return e;
            }
        }
        let inverse: Vec<(Expr, Number)> = common.iter().map(|&(b, n)| (b, -n)).collect();
        let inner: Vec<(Number, Expr)> = terms
            .iter()
            .map(|&(c, term)| {
                let mut list = self.factors_of(term);
                list.extend_from_slice(&inverse);
                (c, self.monomial(Number::ONE, &list))
            })
            .collect();
        let inner = self.linear(Number::ZERO, &inner);
        let inner = self.join_terms(inner);
        common.push((inner, Number::ONE));
        self.monomial(Number::ONE, &common)
    }

    /// The factors of a term of a sum; what is not a product is its own only factor.
    fn factors_of(&self, term: Expr) -> Vec<(Expr, Number)> {
        match self.node(term) {
            Node::Product(k, factors) if k.is_one() => factors.to_vec(),
            _ => vec![(term, Number::ONE)],
        }
    }
}
