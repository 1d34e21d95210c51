//! Fractions within fractions as one: `(f − (a + b/d) u)/l` as `(d f − (a d + b) u)/(d l)`, without what its numerator and its
//! denominator have in common; a root counts as a power of its sum.
//!
//! In: an expression. Out: an equal one, if that is shorter. Never here: fractions beside each other, as in `r θ̇² − k/(m r²)`.

use rustc_hash::FxHashMap;

use super::expand::TRIAL_TERMS;
use super::node::{Expr, Node};
use super::pool::Pool;
use super::product::Factor;
use super::simplify::TRIAL_LIMIT;
use crate::num::Number;

/// The radicands without their denominators, and what these are in terms of the radicands: `c² − v²` is `c² (1 − v²/c²)`.
type Radicands = Vec<(Expr, Expr)>;

impl Pool {
    /// An expression without fractions inside its fractions, if it has some and is shorter so.
    pub fn as_one_fraction(&mut self, e: Expr) -> Expr {
        if self.weight(e) > TRIAL_LIMIT || !self.has_nested_fractions(e) {
            return e;
        }
        let mut radicands = Radicands::new();
        for root in self.radicands_in(e) {
            let cleared = self.cleared(root, &Radicands::new());
            let (_, factors) = self.split_product(cleared);
            if let Some(&(sum, _)) = factors.iter().find(|&&factor| self.is_sum(factor)) {
                let times = self.mul(root, sum);
                radicands.push((sum, self.div(times, cleared)));
            }
        }
        let one = self.cleared(e, &radicands);
        let one = self.each_part(one, |pool, part| match pool.node(part) {
            Node::Sum(..) => pool.collect_constants(part),
            _ => part,
        });
        if self.cost(one) < self.cost(e) { one } else { e }
    }

    /// Returns whether a sum that contains a fraction stands in a fraction.
    fn has_nested_fractions(&self, e: Expr) -> bool {
        self.reachable(&[e]).into_iter().filter(|&part| self.has_quotient(part)).any(|part| {
            let (_, factors) = self.split_product(part);
            factors.iter().any(|&(base, n)| n.as_integer().is_some() && self.has_fractions(base))
        })
    }

    /// Returns whether a sum has a term with a denominator.
    fn has_fractions(&self, e: Expr) -> bool {
        matches!(self.node(e), Node::Sum(..))
            && self.summands(e).iter().any(|&(_, term)| self.has_quotient(term))
    }

    /// The sums under roots.
    fn radicands_in(&self, e: Expr) -> Vec<Expr> {
        let mut found = Vec::new();
        for part in self.reachable(&[e]) {
            let Node::Product(_, factors) = self.node(part) else { continue };
            for &(base, n) in factors {
                let root = n.as_integer().is_none() && matches!(self.node(base), Node::Sum(..));
                if root && !found.contains(&base) {
                    found.push(base);
                }
            }
        }
        found
    }

    /// The expression with every sum over one denominator.
    fn cleared(&mut self, e: Expr, radicands: &Radicands) -> Expr {
        let mut done: FxHashMap<Expr, Expr> = FxHashMap::default();
        for part in self.reachable(&[e]) {
            let of = |base: Expr| done.get(&base).copied().unwrap_or(base);
            let cleared = match &*self.shared(part) {
                Node::Sum(constant, terms) => {
                    let terms: Vec<(Number, Expr)> =
                        terms.iter().map(|&(c, term)| (c, of(term))).collect();
                    let sum = self.linear(*constant, &terms);
                    self.over_common_denominator(sum, radicands)
                }
                Node::Product(c, factors) => {
                    let whole = |n: Number| n.as_integer().is_some();
                    let factors: Vec<Factor> = factors
                        .iter()
                        .map(|&(base, n)| (if whole(n) { of(base) } else { base }, n))
                        .collect();
                    self.monomial(*c, &factors)
                }
                // what stands in a function remains as it is
                _ => part,
            };
            done.insert(part, cleared);
        }
        done[&e]
    }

    /// A sum as the common factors of its terms, those with negative exponents included, times what is left.
    fn over_common_denominator(&mut self, e: Expr, radicands: &Radicands) -> Expr {
        let terms: Vec<(Number, Vec<Factor>)> = self
            .summands(e)
            .into_iter()
            .map(|(c, term)| {
                let (k, factors) = self.split_product(term);
                (c * k, factors)
            })
            .collect();
        let mut common: Vec<Factor> = Vec::new();
        for &(base, _) in terms.iter().flat_map(|(_, factors)| factors) {
            if !common.iter().any(|&(known, _)| known == base) {
                let exponent = |factors: &[Factor]| {
                    factors.iter().find(|f| f.0 == base).map_or(Number::ZERO, |f| f.1)
                };
                let least = terms.iter().map(|(_, factors)| exponent(factors)).min();
                common.push((base, least.unwrap_or(Number::ZERO)));
            }
        }
        let inverse: Vec<Factor> = common.iter().map(|&(base, n)| (base, -n)).collect();
        let lifted: Vec<(Number, Expr)> = terms
            .into_iter()
            .map(|(c, factors)| {
                (Number::ONE, self.monomial(c, &[factors, inverse.clone()].concat()))
            })
            .collect();
        let lifted = self.linear(Number::ZERO, &lifted);
        let opened = self.expand(lifted, TRIAL_TERMS);
        let squares = self.reduce_squares(opened, TRIAL_TERMS);
        let [joined, squares] = [opened, squares].map(|e| self.simplify_parts(e));
        let mut left = if self.cost(squares) < self.cost(joined) { squares } else { joined };
        // what was multiplied out may have brought denominators with it
        if self.has_fractions(left) {
            left = self.over_common_denominator(left, radicands);
        }
        common.push((left, Number::ONE));
        let mut whole = self.monomial(Number::ONE, &common);
        while let Some(then) = self.normalised(whole, radicands).filter(|then| *then != whole) {
            whole = then;
        }
        whole
    }

    /// A product with its sums without common numbers and radicands by their names, and one sum above divided by one below.
    fn normalised(&mut self, e: Expr, radicands: &Radicands) -> Option<Expr> {
        let Node::Product(..) = self.node(e) else { return None };
        let (c, mut factors) = self.split_product(e);
        let mut numbers: Vec<Factor> = Vec::new();
        for factor in &mut factors {
            let (base, n) = *factor;
            if n.as_integer().is_none() || !self.is_sum((base, Number::ONE)) {
                continue;
            }
            let divisor = self.signed_divisor(base);
            let plain = self.scale(divisor.recip(), base);
            let named = radicands.iter().find(|(sum, _)| *sum == plain).map(|(_, name)| *name);
            numbers.push((self.number(divisor), n));
            factor.0 = named.unwrap_or(plain);
        }
        factors.extend(numbers);
        let below: Vec<Expr> = factors
            .iter()
            .filter(|&&(base, n)| n.is_negative() && self.is_sum((base, Number::ONE)))
            .map(|&(base, _)| base)
            .collect();
        for k in 0..factors.len() {
            if !self.is_sum(factors[k]) {
                continue;
            }
            for &divisor in &below {
                let (_, root) = self.split_product(divisor);
                let sum = radicands.iter().find(|(_, name)| {
                    let (_, named) = self.split_product(*name);
                    named.contains(&root[0])
                });
                let (sum, name) = sum.copied().unwrap_or((divisor, divisor));
                if let Some(quotient) = self.exact_quotient(factors[k].0, sum) {
                    factors[k].0 = quotient;
                    factors.push((name, Number::ONE));
                    return Some(self.monomial(c, &factors));
                }
            }
        }
        Some(self.monomial(c, &factors))
    }

    /// The common divisor of the coefficients of a sum, with the sign of the first.
    fn signed_divisor(&self, sum: Expr) -> Number {
        let terms = self.summands(sum);
        let divisor =
            terms.iter().fold(terms[0].0.abs(), |divisor, (c, _)| divisor.common_divisor(*c));
        if terms[0].0.is_negative() { -divisor } else { divisor }
    }

    fn is_sum(&self, (base, n): Factor) -> bool {
        n.is_one() && matches!(self.node(base), Node::Sum(..))
    }

    /// The coefficient and the factors of an expression.
    fn split_product(&self, e: Expr) -> (Number, Vec<Factor>) {
        match self.node(e) {
            Node::Product(c, factors) => (*c, factors.to_vec()),
            Node::Number(n) => (*n, Vec::new()),
            _ => (Number::ONE, vec![(e, Number::ONE)]),
        }
    }
}
