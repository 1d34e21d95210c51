//! Decides whether an expression vanishes identically. A normal form proves it where possible, for
//! each side of every kink; a value beyond rounding error refutes it. If neither succeeds, the
//! values may be consistent with zero, or nothing is known.

use rustc_hash::FxHashMap;

use super::expand::PROOF_TERMS;
use super::function::Rule;
use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use super::sample::sample;
use super::symbol::Symbol;
use crate::num::Number;

/// What is known about the vanishing of an expression.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Zero {
    /// Proved symbolically.
    Proved,
    /// There is no proof, but nothing in the expression can hide, and its values are zero to
    /// rounding at points of all magnitudes.
    Numerically,
    /// Neither proved nor refuted: it may have a kink or a localised part between the points tried,
    /// or it has no values there.
    Unknown,
    /// Not zero: it has a value beyond the error of its own evaluation.
    No,
}

/// The number of points tried before a proof is attempted.
const QUICK: u64 = 6;

/// The number of points tried in all; later ones have increasingly different magnitudes.
const POINTS: u64 = 64;

/// The number of points that have to support zero before it is accepted.
const WITNESSES: usize = 12;

/// A point supports zero if its rounding error is this many powers of two below the terms.
const CLEAR: i64 = 24;

/// A power higher than this may be invisible beside its neighbours almost everywhere.
const HIGHEST: f64 = 16.0;

/// The largest weight of an expression for which a symbolic proof is attempted.
const WEIGHT_LIMIT: u64 = 20_000;

/// The largest number of kinks split in a proof; each one doubles the work.
const MOST_KINKS: usize = 5;

/// The evidence from the values at one point.
enum Witness {
    /// The expression is not zero there.
    Against,
    /// It is zero there to rounding. Carries which of its terms are large enough to be seen.
    For(Vec<bool>),
    /// There is no evidence.
    Silent,
}

impl Pool {
    /// Determines whether `e` vanishes identically. This is fast if it does not, because a few
    /// values settle it.
    pub fn is_zero(&mut self, e: Expr) -> Zero {
        if self.is_full() {
            // expressions built since then are not valid
            return Zero::Unknown;
        }
        if e == Expr::ZERO {
            return Zero::Proved;
        }
        if self.is_stopped() {
            return Zero::Unknown;
        }
        if self.as_number(e).is_some() {
            return Zero::No;
        }
        if self.is_refuted(e, 0..QUICK) {
            return Zero::No;
        }
        match self.proof(e) {
            Zero::Unknown => self.by_values(e),
            known => known,
        }
    }

    /// Returns whether a value at one of the points with these numbers shows that `e` is not zero.
    /// `true` is a proof: the value is beyond all rounding errors of its evaluation.
    fn is_refuted(&self, e: Expr, points: std::ops::Range<u64>) -> bool {
        points.into_iter().any(|n| self.refutes(e, &|s| sample(s, n)))
    }

    /// Returns whether `e` is zero at a point whose values are known to a relative accuracy of
    /// `slack`, or `None` if that cannot be decided.
    pub fn vanishes_at(&self, e: Expr, slack: f64, at: &dyn Fn(Symbol) -> f64) -> Option<bool> {
        match self.witness(e, slack, at) {
            Witness::Against => Some(false),
            Witness::For(_) => Some(true),
            Witness::Silent => None,
        }
    }

    /// Returns whether the value of `e` at a point shows that it is not zero.
    pub fn refutes(&self, e: Expr, at: &dyn Fn(Symbol) -> f64) -> bool {
        self.enclosure(e, at).is_some_and(super::ball::Ball::excludes_zero)
    }

    /// Attempts a symbolic decision: proved, refuted by what a normal form leaves, or unknown.
    fn proof(&mut self, e: Expr) -> Zero {
        if self.weight(e) >= WEIGHT_LIMIT {
            return Zero::Unknown;
        }
        let opened = self.open_roots(e);
        let form = self.normal_form(opened);
        if self.is_full() {
            return Zero::Unknown;
        }
        if form == Expr::ZERO {
            return Zero::Proved;
        }
        if self.is_refuted(form, 0..QUICK) {
            // Symbols that have cancelled no longer dominate the rest. The form also vanishes
            // wherever a cleared denominator does, so the points have to be generic, and they are.
            return Zero::No;
        }
        if self.vanishes_on_all_sides(opened, MOST_KINKS) { Zero::Proved } else { Zero::Unknown }
    }

    /// Returns whether `e` is proved to vanish on every side of each kink.
    fn vanishes_on_all_sides(&mut self, e: Expr, most: usize) -> bool {
        let Some(switch) = self.first_switch(e) else { return false };
        if most == 0 {
            return false;
        }
        [true, false].into_iter().all(|positive| {
            let side = self.on_side(e, switch, positive);
            let form = self.normal_form(side);
            !self.is_full() && (form == Expr::ZERO || self.vanishes_on_all_sides(side, most - 1))
        })
    }

    /// The switch of a call with a kink, and whether its sign was reversed to identify it with its
    /// opposite.
    pub(super) fn switch_of(&mut self, call: Expr) -> Option<(Expr, bool)> {
        let shared = self.shared(call);
        let Node::Call(function, arguments) = &*shared else { return None };
        let Rule::Branch(branches) = function.row().rule else { return None };
        let switch = branches(self, arguments).switch;
        let turned = self.neg(switch);
        Some(if turned < switch { (turned, true) } else { (switch, false) })
    }

    /// The switch of the innermost kink.
    pub(super) fn first_switch(&mut self, e: Expr) -> Option<Expr> {
        let parts = self.reachable(&[e]);
        parts.into_iter().find_map(|part| self.switch_of(part)).map(|(switch, _)| switch)
    }

    /// The expression on the side where a switch is positive, or negative.
    pub(super) fn on_side(&mut self, e: Expr, switch: Expr, positive: bool) -> Expr {
        self.each_part(e, |pool, part| {
            if let Some((own, turned)) = pool.switch_of(part)
                && own == switch
                && let Node::Call(function, arguments) = &*pool.shared(part)
                && let Rule::Branch(branches) = function.row().rule
            {
                let branches = branches(pool, arguments);
                return if positive == turned { branches.negative } else { branches.positive };
            }
            part
        })
    }

    /// Rewrites roots of even powers as absolute values, √(u²) = |u|, and exp(ln u) as u.
    pub(super) fn open_roots(&mut self, e: Expr) -> Expr {
        self.each_part(e, |pool, part| {
            if let Node::Call(FunctionId::Exp, arguments) = &*pool.shared(part)
                && let Node::Call(FunctionId::Ln, inner) = &*pool.shared(arguments[0])
            {
                return inner[0];
            }
            let shared = pool.shared(part);
            let Node::Product(c, factors) = &*shared else { return part };
            let mut opened: Vec<(Expr, Number)> = Vec::new();
            for &(base, n) in factors {
                match &*pool.shared(base) {
                    Node::Product(k, inner)
                        if k.is_one()
                            && n.as_integer().is_none()
                            && inner
                                .iter()
                                .all(|(_, m)| m.as_integer().is_some_and(|m| m % 2 == 0)) =>
                    {
                        for &(u, m) in inner {
                            opened.push((pool.call(FunctionId::Abs, &[u]), m * n));
                        }
                    }
                    _ => opened.push((base, n)),
                }
            }
            pool.monomial(*c, &opened)
        })
    }

    /// A numerator of `e`, multiplied out. It is zero where `e` is, and it is a polynomial in
    /// symbols, roots, sines and cosines if it can be written as one.
    pub fn numerator(&mut self, e: Expr) -> Expr {
        if self.weight(e) < WEIGHT_LIMIT { self.normal_form(e) } else { e }
    }

    /// A sum of monomials with every square of a symbol replaced.
    pub fn with_square(&mut self, e: Expr, symbol: Symbol, square: Expr) -> Expr {
        let base = self.variable(symbol);
        let mut terms = Vec::new();
        for (c, term) in self.summands(e) {
            let factors = match &*self.shared(term) {
                Node::Product(k, factors) if k.is_one() => factors.to_vec(),
                _ => vec![(term, Number::ONE)],
            };
            let replaced: Vec<(Expr, Number)> = factors
                .into_iter()
                .flat_map(|(b, n)| match n.as_integer() {
                    Some(k) if b == base && k >= 2 => {
                        vec![(square, Number::integer(k / 2)), (base, Number::integer(k % 2))]
                    }
                    _ => vec![(b, n)],
                })
                .collect();
            terms.push((c, self.monomial(Number::ONE, &replaced)));
        }
        let replaced = self.linear(Number::ZERO, &terms);
        self.expand(replaced, PROOF_TERMS)
    }

    /// Decides by values alone, without a proof.
    fn by_values(&self, e: Expr) -> Zero {
        match supported(|n| self.witness(e, 0.0, &|s| sample(s, n))) {
            Zero::Numerically if self.may_hide(e) => Zero::Unknown,
            known => known,
        }
    }

    fn witness(&self, e: Expr, slack: f64, at: &dyn Fn(Symbol) -> f64) -> Witness {
        let values = self.enclosures(e, slack, at);
        let Some(whole) = values[&e] else { return Witness::Silent };
        if whole.excludes_zero() {
            return Witness::Against;
        }
        let Node::Sum(_, terms) = self.node(e) else { return Witness::Silent };
        let magnitude = |&(c, term): &(Number, Expr)| {
            values[&term]?.mul(super::ball::Ball::number(c)?)?.magnitude()
        };
        let sizes: Vec<Option<i64>> = terms.iter().map(magnitude).collect();
        let Some(largest) = sizes.iter().copied().flatten().max() else { return Witness::Silent };
        let noise = whole.uncertainty().unwrap_or(i64::MIN / 2);
        if !is_clear(noise, largest) {
            return Witness::Silent;
        }
        Witness::For(sizes.iter().map(|size| size.is_some_and(|size| size > noise + 4)).collect())
    }

    /// Returns whether an expression has a part that a few points may miss: a kink, a function that
    /// saturates or is localised, a high power.
    pub fn may_hide(&self, e: Expr) -> bool {
        self.reachable(&[e]).into_iter().any(|part| match self.node(part) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Sum(..) => false,
            Node::Product(_, factors) => factors.iter().any(|(_, n)| n.value().abs() > HIGHEST),
            Node::Power(..) => true,
            Node::Call(function, _) => !matches!(
                function,
                FunctionId::Sin
                    | FunctionId::Cos
                    | FunctionId::Tan
                    | FunctionId::Cot
                    | FunctionId::Ln
                    | FunctionId::Sqrt
            ),
        })
    }

    /// A form that *is* 0 for any expression that is zero as a rational function of symbols, roots,
    /// sines and cosines: sums of angles are expanded, denominators cleared, products multiplied
    /// out, squares of cosines replaced. For any other expression it is some numerator of `e`.
    pub(super) fn normal_form(&mut self, e: Expr) -> Expr {
        let mut e = self.open_angles(e);
        e = self.expand(e, PROOF_TERMS);
        e = self.reduce_squares(e, PROOF_TERMS);
        for _ in 0..8 {
            let cleared = self.clear_denominators(e);
            let cleared = self.expand(cleared, PROOF_TERMS);
            let cleared = self.reduce_squares(cleared, PROOF_TERMS);
            if cleared == e || cleared == Expr::ZERO {
                return cleared;
            }
            e = cleared;
        }
        e
    }

    /// Multiplies a sum by the lowest power of every base that occurs in a denominator, or that is
    /// a sum under a root. Afterwards such powers are nonnegative.
    fn clear_denominators(&mut self, e: Expr) -> Expr {
        let terms = self.summands(e);
        if terms.len() < 2 {
            return e;
        }
        let mut exponents: FxHashMap<Expr, Vec<Number>> = FxHashMap::default();
        let mut factor_lists = Vec::new();
        for &(c, term) in &terms {
            let factors = match &*self.shared(term) {
                Node::Product(k, factors) if k.is_one() => factors.to_vec(),
                _ => vec![(term, Number::ONE)],
            };
            for &(base, n) in &factors {
                exponents.entry(base).or_default().push(n);
            }
            factor_lists.push((c, factors));
        }
        let count = terms.len();
        let mut lowest: Vec<(Expr, Number)> = Vec::new();
        for (base, seen) in exponents {
            let mut low = seen.iter().copied().min().unwrap_or(Number::ZERO);
            if seen.len() < count {
                low = low.min(Number::ZERO);
            }
            if low.is_negative() || (seen.len() == count && !low.is_zero()) {
                lowest.push((base, -low));
            }
        }
        lowest.sort_unstable_by_key(|&(base, _)| base);
        let cleared: Vec<(Number, Expr)> = factor_lists
            .into_iter()
            .map(|(c, mut factors)| {
                factors.extend_from_slice(&lowest);
                (c, self.monomial(Number::ONE, &factors))
            })
            .collect();
        self.linear(Number::ZERO, &cleared)
    }
}

/// What the values at the points with the later numbers support: zero if many do, and every term was seen at one of them.
fn supported(mut witness: impl FnMut(u64) -> Witness) -> Zero {
    let mut witnesses = 0;
    let mut seen: Vec<bool> = Vec::new();
    for n in QUICK..POINTS {
        match witness(n) {
            Witness::Against => return Zero::No,
            Witness::Silent => {}
            Witness::For(visible) => {
                witnesses += 1;
                seen.resize(visible.len(), false);
                seen.iter_mut().zip(visible).for_each(|(all, one)| *all |= one);
            }
        }
    }
    let spoken = witnesses >= WITNESSES && seen.iter().all(|&seen| seen);
    if spoken { Zero::Numerically } else { Zero::Unknown }
}

/// Whether a rounding error is far below the largest term; both as powers of two.
fn is_clear(noise: i64, largest: i64) -> bool {
    noise <= largest - CLEAR
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is supported where this many points do, and all others are silent.
    fn by_so_many(points: u64) -> Zero {
        let first = QUICK..QUICK + points;
        supported(|n| if first.contains(&n) { Witness::For(vec![true]) } else { Witness::Silent })
    }

    #[test]
    fn twelve_points_support_zero() {
        assert_eq!(by_so_many(11), Zero::Unknown);
        assert_eq!(by_so_many(12), Zero::Numerically);
    }

    #[test]
    fn points_from_6_to_63_are_tried() {
        let refuted_at = |at: u64| {
            supported(|n| if n == at { Witness::Against } else { Witness::For(vec![true]) })
        };
        for (at, found) in
            [(5, Zero::Numerically), (6, Zero::No), (63, Zero::No), (64, Zero::Numerically)]
        {
            assert_eq!(refuted_at(at), found, "point {at}");
        }
    }

    #[test]
    fn a_term_that_no_point_shows_is_not_decided() {
        let found = |at: u64| supported(|n| Witness::For(vec![true, n == at]));
        assert_eq!(found(40), Zero::Numerically);
        assert_eq!(found(100), Zero::Unknown);
    }

    #[test]
    fn rounding_is_24_powers_of_two_below_the_terms() {
        assert!(is_clear(6, 30) && !is_clear(7, 30));
    }

    #[test]
    fn a_power_beyond_16_may_hide() {
        let mut pool = Pool::new();
        let x = pool.named("x");
        for (power, hides) in [(16, false), (17, true), (-16, false), (-17, true)] {
            let e = pool.monomial(Number::ONE, &[(x, Number::integer(power))]);
            assert_eq!(pool.may_hide(e), hides, "x^{power}");
        }
    }
}
