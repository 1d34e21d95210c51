//! Is an expression zero? Proved by a normal form where it can be; where it cannot, the values at
//! many points speak, and the answer says so.

use rustc_hash::FxHashMap;

use super::expand::PROOF_TERMS;
use super::number::Number;
use super::pool::{Expr, Node, Pool};
use super::symbol::Symbol;

/// How far an expression is known to vanish.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Zero {
    /// Proved symbolically.
    Proved,
    /// Zero to rounding at every point tried, no proof found.
    Numerically,
    /// Not zero.
    No,
}

/// How many points are tried.
const POINTS: u64 = 24;

/// An expression heavier than this is not worth the symbolic attempt.
const WEIGHT_LIMIT: u64 = 20_000;

impl Pool {
    /// Whether `e` vanishes identically. Quick for what does not: a few values settle it.
    pub fn is_zero(&mut self, e: Expr) -> Zero {
        if e == Expr::ZERO {
            return Zero::Proved;
        }
        if self.is_stopped() || self.as_number(e).is_some() || !self.vanishes_at_points(e) {
            return Zero::No;
        }
        if self.weight(e) < WEIGHT_LIMIT && self.normal_form(e) == Expr::ZERO {
            return Zero::Proved;
        }
        Zero::Numerically
    }

    /// Whether `e` is zero to rounding at points spread over its domain.
    fn vanishes_at_points(&self, e: Expr) -> bool {
        let mut seen = 0;
        for point in 0..POINTS {
            let (value, size) = self.evaluate_with_size(e, &|s: Symbol| sample(s, point));
            if !value.is_finite() || !size.is_finite() {
                continue;
            }
            seen += 1;
            if value.abs() > 1e-11 * size.max(1e-3) {
                return false;
            }
        }
        seen >= 4
    }

    /// A form in which an expression that is zero as a rational function of symbols, roots, sines
    /// and cosines *is* 0: angles opened, denominators cleared, multiplied out, squares of
    /// cosines replaced. For anything else it is some numerator of `e`.
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

    /// Multiplies a sum through by the lowest power of every base that stands below a line, or
    /// that is a sum under a root; afterwards such powers are non-negative.
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

/// A value for a symbol at the n-th point: spread over (0.1, 2.1), different for each symbol, so
/// that logarithms, roots and quotients are mostly defined. Every third point has other signs.
fn sample(symbol: Symbol, point: u64) -> f64 {
    let mut x = (symbol.index() as u64 + 1)
        .wrapping_mul(0x9E37_79B9_7F4A_7C15)
        .wrapping_add((point + 1).wrapping_mul(0xD1B5_4A32_D192_ED03));
    x ^= x >> 30;
    x = x.wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x ^= x >> 27;
    x = x.wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^= x >> 31;
    let unit = (x >> 11) as f64 / (1_u64 << 53) as f64;
    let value = 0.1 + 2.0 * unit;
    if point % 3 == 2 && x & 1 == 1 { -value } else { value }
}
