//! An expression as a textbook writes it: terms over the same denominator are one fraction, no fraction stands inside
//! another where that is no longer, and cos u/sin u is cot u.
//!
//! In: an expression. Out: an equal one, in a pool of its own, to be printed. Never here: the notation.

mod coefficients;
mod signs;

use rustc_hash::FxHashMap;

use super::expand::TRIAL_TERMS;
use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use super::product::Factor;
use super::symbol::Rank;
use crate::num::Number;

/// Heavier expressions are printed as they stand.
const HEAVIEST: u64 = 250;

impl Pool {
    /// Hands `print` the expression as a textbook writes it, and the pool it is in.
    pub(super) fn in_textbook_form(
        &self,
        e: Expr,
        print: impl Fn(&Pool, Expr) -> String,
    ) -> String {
        let matters =
            |&part: &Expr| matches!(self.node(part), Node::Sum(..)) || self.has_quotient(part);
        if self.weight(e) > HEAVIEST || !self.reachable(&[e]).iter().any(matters) {
            return print(self, e);
        }
        let mut pool = self.with_the_same_symbols();
        let copy = pool.copy_from(self, e);
        let opened = pool.shorter_multiplied_out(copy);
        let joined = pool.each_part(opened, |pool, part| match pool.node(part) {
            Node::Sum(..) => pool.join_fractions(part),
            Node::Product(..) => pool.flatten_fractions(part),
            _ => part,
        });
        let written = pool.each_part(joined, |pool, part| match pool.node(part) {
            Node::Sum(..) => pool.collect_constants(part),
            Node::Product(..) => {
                let apart = pool.split_fraction(part);
                pool.quotient_of_sine_and_cosine(apart)
            }
            _ => part,
        });
        let turned = pool.turn_signs(written);
        let shorter = pool.shorten_coefficients(turned);
        print(&pool, shorter)
    }

    /// A sum with its products multiplied out where terms combine and it is shorter so: `x (x − y) − ½ (x − y)²` as
    /// `½ x² − ½ y²`.
    fn shorter_multiplied_out(&mut self, e: Expr) -> Expr {
        // what is added to a momentum stays with it in a square
        let is_square = |&(base, n): &Factor| {
            n.value() > 1.0
                && matches!(self.node(base), Node::Sum(..))
                && self.rank_of(base) == Rank::Momentum
        };
        let has_square = |part| matches!(self.node(part), Node::Product(_, factors) if factors.iter().any(is_square));
        if self.reachable(&[e]).into_iter().any(has_square) {
            return e;
        }
        let mut opened = e;
        while let (Node::Sum(..), then) =
            (self.node(opened).clone(), self.expand_top(opened, TRIAL_TERMS))
        {
            if then == opened {
                break;
            }
            opened = then;
        }
        let opened = self.join_terms(opened);
        let combine = self.summands(opened).len() < self.terms_multiplied_out(e);
        if combine && self.cost(opened) < self.cost(e) { opened } else { e }
    }

    /// The number of terms of an expression that is multiplied out, if none of them combine but those of powers.
    fn terms_multiplied_out(&self, e: Expr) -> usize {
        let of = |term: Expr| match self.node(term) {
            Node::Product(_, factors) => factors
                .iter()
                .filter(|(base, _)| matches!(self.node(*base), Node::Sum(..)))
                .filter_map(|&(base, n)| Some((self.terms_multiplied_out(base), n.as_integer()?)))
                .map(|(k, n)| ways_to_choose(n.max(0) as usize, k))
                .fold(1, |product, ways| ways.saturating_mul(product).min(MANY)),
            _ => 1,
        };
        let terms = self.summands(e).into_iter().map(|(_, term)| of(term));
        terms.fold(0, |sum, n| (sum + n).min(MANY))
    }

    /// `(a d − b)/(c d)` as `a/c − b/(c d)` where a term contains all of the denominator, `(a c + b d)/(c d)` as `a/d + b/c` where
    /// every term contains some of it, and nothing but constants is written twice.
    fn split_fraction(&mut self, e: Expr) -> Expr {
        let (above, below) = self.above_and_below(e);
        let is_sum = |&(base, _): &Factor| matches!(self.node(base), Node::Sum(..));
        let mut sums = above.iter().filter(|factor| is_sum(factor));
        let (Some(&(sum, n)), None) = (sums.next(), sums.next()) else { return e };
        let is_constant = |&(base, _): &Factor| self.rank_of(base) == Rank::Constant;
        let others = above.iter().filter(|factor| !is_sum(factor)).all(is_constant);
        if !others
            || below.is_empty()
            || below.iter().any(is_sum)
            || !n.is_one()
            || is_constant(&(sum, n))
        {
            return e;
        }
        let terms: Vec<(Number, Expr)> = self.summands(sum);
        let left = |pool: &mut Pool, term: Expr| {
            let quotient =
                pool.monomial(Number::ONE, &[&[(term, Number::ONE)], &below[..]].concat());
            pool.above_and_below(quotient).1
        };
        let left: Vec<Vec<Factor>> = terms.iter().map(|&(_, term)| left(self, term)).collect();
        let some = |&(base, n): &Factor| below.iter().any(|&(other, m)| other == base && m <= n);
        let all_shorter = left.iter().all(|left| *left != below && left.iter().all(some));
        if !all_shorter && !left.iter().any(Vec::is_empty) {
            return e;
        }
        let whole = self.div(e, sum);
        let (mut apart, mut together) = (Vec::new(), Vec::new());
        for ((c, term), left) in terms.into_iter().zip(left) {
            if all_shorter || left.is_empty() {
                apart.push((c, self.mul(term, whole)));
            } else {
                together.push((c, term));
            }
        }
        let together = self.linear(Number::ZERO, &together);
        let together = self.factor_out(together);
        apart.push((Number::ONE, self.mul(together, whole)));
        self.linear(Number::ZERO, &apart)
    }

    /// Returns whether a node is a product with something in its denominator.
    pub(super) fn has_quotient(&self, e: Expr) -> bool {
        matches!(self.node(e), Node::Product(_, factors) if factors.iter().any(|(_, n)| n.is_negative()))
    }

    fn copy_from(&mut self, other: &Pool, e: Expr) -> Expr {
        let mut copies: FxHashMap<Expr, Expr> = FxHashMap::default();
        // handles ascend in both pools, so what is ordered by handles remains so
        for part in other.reachable(&[e]) {
            let node = other.node(part).with_parts(|part| copies[&part]);
            let copy = self.intern(node);
            copies.insert(part, copy);
        }
        copies[&e]
    }

    /// A term as what stands above and below its line.
    fn above_and_below(&self, term: Expr) -> (Vec<Factor>, Vec<Factor>) {
        match self.node(term) {
            Node::Product(_, factors) => factors.iter().partition(|(_, n)| !n.is_negative()),
            _ => (vec![(term, Number::ONE)], Vec::new()),
        }
    }

    /// `a/d + b/d` as `(a + b)/d`, and one denominator for all terms if that is shorter.
    fn join_fractions(&mut self, e: Expr) -> Expr {
        let shared = self.shared(e);
        let Node::Sum(constant, terms) = &*shared else { return e };
        let mut groups: Vec<(Vec<Factor>, Rank, Vec<(Number, Expr)>)> = Vec::new();
        for &(c, term) in terms {
            let (above, below) = self.above_and_below(term);
            let rank = self.rank_of(term).max(Rank::Variable);
            if below.is_empty() {
                groups.push((below, rank, vec![(c, term)]));
                continue;
            }
            let above = self.monomial(Number::ONE, &above);
            match groups.iter_mut().find(|(known, r, _)| *known == below && *r == rank) {
                Some((_, _, all)) => all.push((c, above)),
                None => groups.push((below, rank, vec![(c, above)])),
            }
        }
        let mut joined = Vec::with_capacity(groups.len());
        for (below, _, above) in groups {
            let above = self.linear(Number::ZERO, &above);
            let mut factors = below;
            factors.push((above, Number::ONE));
            let fraction = self.monomial(Number::ONE, &factors);
            joined.push((Number::ONE, self.common_factors_of_sums(fraction)));
        }
        let grouped = self.linear(*constant, &joined);
        let momenta = terms.iter().any(|&(_, t)| self.rank_of(t) == Rank::Momentum);
        let below_a_sum = joined.iter().any(|&(_, term)| {
            let (_, below) = self.above_and_below(term);
            below.iter().any(|&(base, _)| matches!(self.node(base), Node::Sum(..)))
        });
        match self.over_one_denominator(grouped) {
            Some(one) if below_a_sum && !momenta && self.cost(one) < self.cost(grouped) => one,
            _ => grouped,
        }
    }

    /// A product without fractions inside its factors, where that is no longer; a denominator that is half fractions
    /// has none afterwards.
    fn flatten_fractions(&mut self, e: Expr) -> Expr {
        let mut flat = self.common_factors_of_sums(e);
        // what leaves a denominator may cancel above, so denominators come first
        while let Some(flatter) = self
            .flatter(flat, Number::is_negative)
            .or_else(|| self.flatter(flat, |n| !n.is_negative()))
        {
            flat = flatter;
        }
        self.cancel_sums(flat)
    }

    /// A product with the constants that the terms of a sum have in common, and whatever else cancels, as factors of its own:
    /// `x/(m a + m)` times m is `x/(a + 1)`.
    fn common_factors_of_sums(&mut self, e: Expr) -> Expr {
        let Node::Product(c, factors) = &*self.shared(e) else { return e };
        let mut apart = factors.to_vec();
        for factor in &mut apart {
            let (sum, n) = *factor;
            if n.as_integer().is_none() || !matches!(self.node(sum), Node::Sum(..)) {
                continue;
            }
            let out = self.factor_out(sum);
            let cancels = |base| {
                factors
                    .iter()
                    .any(|&(other, m)| other == base && m.is_negative() != n.is_negative())
            };
            let Node::Product(_, common) = self.node(out) else { continue };
            let inner = |base: Expr| matches!(self.node(base), Node::Sum(..));
            if common.iter().all(|&(base, _)| {
                inner(base) || self.rank_of(base) == Rank::Constant || cancels(base)
            }) {
                factor.0 = out;
            }
        }
        self.monomial(*c, &apart)
    }

    /// The product with one fraction fewer inside a factor whose exponent is as `side` says.
    fn flatter(&mut self, e: Expr, side: impl Fn(Number) -> bool) -> Option<Expr> {
        let Node::Product(c, factors) = &*self.shared(e) else { return None };
        for (i, &(base, n)) in factors.iter().enumerate() {
            if n.as_integer().is_none() || !side(n) {
                continue;
            }
            let Some(one) = self.over_one_denominator(base) else { continue };
            let mut trial = factors.to_vec();
            trial[i] = (one, n);
            let then = self.monomial(*c, &trial);
            let mixed = self.summands(base);
            let whole =
                mixed.iter().filter(|&&(_, t)| self.above_and_below(t).1.is_empty()).count();
            let inside = n.is_negative() && 2 * whole <= mixed.len();
            if then != e && (inside || self.cost(then) <= self.cost(e)) {
                return Some(then);
            }
        }
        None
    }

    /// `(M a + m a)/(M + m)` as `a`.
    fn cancel_sums(&mut self, e: Expr) -> Expr {
        self.with_quotient(e, |pool, whole, divisor| {
            let quotient = pool.exact_quotient(whole, divisor)?;
            Some(pool.simplify_parts(quotient))
        })
        .unwrap_or(e)
    }

    /// A sum with fractions as one fraction; `None` if it has none, or is a momentum and what is added to it, as in
    /// `p + e A/c`.
    fn over_one_denominator(&mut self, e: Expr) -> Option<Expr> {
        let Node::Sum(..) = self.node(e) else { return None };
        let terms = self.summands(e);
        let mut below: Vec<Factor> = Vec::new();
        for &(_, term) in &terms {
            let momentum = |s| self.symbol_info(s).rank == Rank::Momentum;
            if self.as_symbol(term).is_some_and(momentum) {
                return None;
            }
            for (base, n) in self.above_and_below(term).1 {
                n.as_integer()?;
                match below.iter_mut().find(|(known, _)| *known == base) {
                    Some((_, least)) => *least = (*least).min(n),
                    None => below.push((base, n)),
                }
            }
        }
        if below.is_empty() {
            return None;
        }
        let raised: Vec<Factor> = below.iter().map(|&(base, n)| (base, -n)).collect();
        let raised = self.monomial(Number::ONE, &raised);
        let lifted: Vec<(Number, Expr)> =
            terms.into_iter().map(|(c, term)| (c, self.mul(term, raised))).collect();
        let above = self.linear(Number::ZERO, &lifted);
        let expanded = self.expand(above, TRIAL_TERMS);
        let short = [above, expanded].map(|e| self.simplify_parts(e));
        let above = if self.cost(short[1]) < self.cost(short[0]) { short[1] } else { short[0] };
        below.push((above, Number::ONE));
        Some(self.monomial(Number::ONE, &below))
    }

    /// `m x + M x` as `(m + M) x`, and `m g + M g` as `(m + M) g`.
    pub(super) fn collect_constants(&mut self, e: Expr) -> Expr {
        let Node::Sum(constant, terms) = &*self.shared(e) else { return e };
        let is_constant = |&(base, _): &Factor| self.rank_of(base) == Rank::Constant;
        let mut groups: Vec<(Vec<Factor>, Vec<(Number, Vec<Factor>)>)> = Vec::new();
        for &(c, term) in terms {
            let factors = match self.node(term) {
                Node::Product(_, factors) => factors.to_vec(),
                _ => vec![(term, Number::ONE)],
            };
            let (constants, rest): (Vec<Factor>, Vec<Factor>) =
                factors.into_iter().partition(is_constant);
            match groups.iter_mut().find(|(known, _)| *known == rest) {
                Some((_, all)) => all.push((c, constants)),
                None => groups.push((rest, vec![(c, constants)])),
            }
        }
        if groups.len() == terms.len() {
            return e;
        }
        let mut collected = Vec::with_capacity(groups.len());
        for (mut rest, constants) in groups {
            let constants: Vec<(Number, Expr)> =
                constants.into_iter().map(|(c, f)| (c, self.monomial(Number::ONE, &f))).collect();
            let sum = self.linear(Number::ZERO, &constants);
            let sum = self.simplify_parts(sum);
            rest.push((sum, Number::ONE));
            collected.push((Number::ONE, self.monomial(Number::ONE, &rest)));
        }
        self.linear(*constant, &collected)
    }

    /// `cos u/sin u` as `cot u`, `sin u/cos u` as `tan u`.
    fn quotient_of_sine_and_cosine(&mut self, e: Expr) -> Expr {
        let shared = self.shared(e);
        let Node::Product(c, factors) = &*shared else { return e };
        let mut factors = factors.to_vec();
        for (over, under, quotient) in [
            (FunctionId::Cos, FunctionId::Sin, FunctionId::Cot),
            (FunctionId::Sin, FunctionId::Cos, FunctionId::Tan),
        ] {
            let argument = |(base, n): &Factor, function, power| match self.node(*base) {
                Node::Call(f, u) if *f == function && *n == power => Some(u[0]),
                _ => None,
            };
            let above: Vec<Expr> =
                factors.iter().filter_map(|f| argument(f, over, Number::ONE)).collect();
            let both: Vec<Expr> = factors
                .iter()
                .filter_map(|f| argument(f, under, Number::MINUS_ONE))
                .filter(|u| above.contains(u))
                .collect();
            for u in both {
                let pair = [over, under].map(|f| self.call(f, &[u]));
                factors.retain(|(base, _)| !pair.contains(base));
                factors.push((self.call(quotient, &[u]), Number::ONE));
            }
        }
        self.monomial(*c, &factors)
    }

    /// The highest rank among the symbols of an expression.
    pub(super) fn rank_of(&self, e: Expr) -> Rank {
        let ranks = self.symbols_of(e).into_iter().map(|s| self.symbol_info(s).rank);
        ranks.max().unwrap_or_default()
    }
}
/// More terms than are ever multiplied out.
const MANY: usize = 1 << 20;

/// In how many ways n of k terms are chosen with repetition, at most [`MANY`].
fn ways_to_choose(n: usize, k: usize) -> usize {
    // n of n + k − 1, or the k − 1 others
    let all = n.saturating_add(k).saturating_sub(1);
    let mut ways = 1_usize;
    for i in 1..=n.min(k.saturating_sub(1)) {
        ways = ways.saturating_mul(all - i + 1) / i;
        if ways >= MANY {
            return MANY;
        }
    }
    ways
}
