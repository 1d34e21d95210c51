//! Quotients under roots: √(1 − x²/a²) as √(a² − x²)/√(a²), so that roots which differ by a factor become the same root.
//!
//! In: an expression. Out: one that is equal to it where the factors that are taken out are positive; whoever asks has to
//! look whether that is so. Never here: proofs.

use rustc_hash::FxHashMap;

use super::node::{Expr, Node};
use super::pool::Pool;
use super::product::Factor;
use super::zero_test::Zero;
use crate::num::Number;

/// Numbers with a larger denominator stay as they are.
const LARGEST_DENOMINATOR: i64 = 1000;

impl Pool {
    /// Takes out of every root of a sum what all its terms have in common, denominators and a leading number included, and
    /// parts roots of products.
    pub fn open_quotients(&mut self, e: Expr) -> Expr {
        self.each_part(e, |pool, part| match &*pool.shared(part) {
            Node::Product(c, factors) => {
                let mut all = Vec::new();
                for &factor in factors {
                    pool.open_factor(factor, &mut all);
                }
                pool.monomial(*c, &all)
            }
            _ => part,
        })
    }

    /// c √N, where an expression is that for one of its roots √N; roots have to be opened before.
    pub fn as_one_root(&mut self, e: Expr) -> Option<Expr> {
        let mut sums = Vec::new();
        for (_, term) in self.summands(e) {
            if let Node::Product(_, factors) = self.node(term) {
                let root = |&&(base, n): &&Factor| {
                    n.as_integer().is_none() && matches!(self.node(base), Node::Sum(..))
                };
                sums.extend(factors.iter().filter(root).map(|&(base, _)| base));
            }
        }
        sums.sort_unstable();
        sums.dedup();
        for sum in sums {
            let root = self.sqrt(sum);
            let times = self.mul(e, root);
            let times = self.multiplied_out(times);
            let Some(&(n, first)) = self.summands(sum).first() else { continue };
            let first = self.scale(n, first);
            for (k, term) in self.summands(times) {
                let term = self.scale(k, term);
                let ratio = self.div(term, first);
                let whole = self.mul(ratio, sum);
                let rest = self.sub(times, whole);
                if self.is_zero(rest) == Zero::Proved {
                    return Some(self.mul(ratio, root));
                }
            }
        }
        None
    }

    /// Opens a power that is not whole.
    fn open_factor(&mut self, (base, n): Factor, all: &mut Vec<Factor>) {
        if n.as_integer().is_some() {
            all.push((base, n));
            return;
        }
        match &*self.shared(base) {
            Node::Sum(..) => {
                let (common, leading, rest) = self.without_common(base);
                for (part, m) in common {
                    self.open_factor((part, m * n), all);
                }
                self.push_number(leading, n, all);
                all.push((rest, n));
            }
            Node::Product(c, inner) => {
                let mut inner = inner.to_vec();
                if c.is_negative() {
                    // the sign belongs to a sum
                    let sum = |&(part, m): &Factor| {
                        m.is_one() && matches!(self.node(part), Node::Sum(..))
                    };
                    let Some(k) = inner.iter().position(sum) else {
                        all.push((base, n));
                        return;
                    };
                    inner[k].0 = self.neg(inner[k].0);
                }
                self.push_number(c.abs(), n, all);
                for (part, m) in inner {
                    self.open_factor((part, m * n), all);
                }
            }
            Node::Number(number) if !number.is_negative() => self.push_number(*number, n, all),
            _ => all.push((base, n)),
        }
    }

    /// A power of a number, as powers of whole ones, which merge with others: √½ is 1/√2.
    fn push_number(&mut self, number: Number, n: Number, all: &mut Vec<Factor>) {
        let whole = |d: i64| (number * Number::integer(d)).as_integer();
        match (1..=LARGEST_DENOMINATOR).find_map(|d| Some((whole(d)?, d))) {
            Some((numerator, denominator)) => {
                all.push((self.integer(numerator), n));
                all.push((self.integer(denominator), -n));
            }
            None => all.push((self.number(number), n)),
        }
    }

    /// What the terms of a sum have in common, the size of its leading number, and the sum that is left.
    fn without_common(&mut self, sum: Expr) -> (Vec<Factor>, Number, Expr) {
        let lists: Vec<(Number, Vec<Factor>)> = self
            .summands(sum)
            .into_iter()
            .map(|(c, term)| match &*self.shared(term) {
                Node::Product(k, factors) if k.is_one() => (c, factors.to_vec()),
                Node::Number(_) => (c, Vec::new()),
                _ => (c, vec![(term, Number::ONE)]),
            })
            .collect();
        let mut exponents: FxHashMap<Expr, Vec<Number>> = FxHashMap::default();
        for &(base, n) in lists.iter().flat_map(|(_, factors)| factors) {
            exponents.entry(base).or_default().push(n);
        }
        let mut common: Vec<Factor> = Vec::new();
        for (base, seen) in exponents {
            let absent = (seen.len() < lists.len()).then_some(Number::ZERO);
            let least = seen.into_iter().chain(absent).min().unwrap_or(Number::ZERO);
            if !least.is_zero() {
                common.push((base, least));
            }
        }
        common.sort_unstable_by_key(|&(base, _)| base);
        let mut terms = Vec::new();
        for (c, mut factors) in lists {
            factors.extend(common.iter().map(|&(base, n)| (base, -n)));
            terms.push((c, self.monomial(Number::ONE, &factors)));
        }
        let cleared = self.linear(Number::ZERO, &terms);
        let leading = self.summands(cleared).first().map_or(Number::ONE, |&(c, _)| c.abs());
        let rest = self.scale(leading.recip(), cleared);
        (common, leading, rest)
    }
}
