//! Products and powers in canonical form: exponents of equal bases collected, numbers combined,
//! sums in them primitive, exponentials joined. No rule changes a value where the original has one:
//! `sqrt(x^2)` is left unchanged.

use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use crate::num::Number;
use crate::num::math;

pub(super) type Factor = (Expr, Number);

/// Powers of coefficients stay with their base beyond this number and its inverse.
const LARGE: f64 = 1e150;

impl Pool {
    /// `a · b`.
    pub fn mul(&mut self, a: Expr, b: Expr) -> Expr {
        self.monomial(Number::ONE, &[(a, Number::ONE), (b, Number::ONE)])
    }

    /// `a / b`.
    pub fn div(&mut self, a: Expr, b: Expr) -> Expr {
        self.monomial(Number::ONE, &[(a, Number::ONE), (b, Number::MINUS_ONE)])
    }

    /// `Π parts`.
    pub fn product(&mut self, parts: &[Expr]) -> Expr {
        let factors: Vec<Factor> = parts.iter().map(|&e| (e, Number::ONE)).collect();
        self.monomial(Number::ONE, &factors)
    }

    /// `base ^ n` for an integer `n`.
    pub fn powi(&mut self, base: Expr, n: i64) -> Expr {
        self.monomial(Number::ONE, &[(base, Number::integer(n))])
    }

    /// The square root.
    pub fn sqrt(&mut self, e: Expr) -> Expr {
        self.monomial(Number::ONE, &[(e, Number::HALF)])
    }

    /// `base ^ exponent`.
    pub fn pow(&mut self, base: Expr, exponent: Expr) -> Expr {
        if let Some(n) = self.as_number(exponent) {
            return self.monomial(Number::ONE, &[(base, n)]);
        }
        if base == Expr::ONE {
            return Expr::ONE;
        }
        self.intern(Node::Power(base, exponent))
    }

    /// `coefficient · Π base ^ exponent`, the general constructor of products.
    pub fn monomial(&mut self, coefficient: Number, factors: &[Factor]) -> Expr {
        let mut coefficient = coefficient;
        let mut factors = factors.to_vec();
        loop {
            self.note_roots(&factors);
            merge(&mut factors);
            // the factors anew, from the first that is rewritten on
            let mut next: Option<Vec<Factor>> = None;
            for (i, &(base, exponent)) in factors.iter().enumerate() {
                let opened = self.rewrite_power(base, exponent).filter(|(c, _)| {
                    exponent.is_one()
                        || !matches!(self.node(base), Node::Product(..) | Node::Sum(..))
                        || !leaves_range(coefficient, *c)
                });
                if let Some((c, opened)) = opened {
                    coefficient = coefficient * c;
                    next.get_or_insert_with(|| factors[..i].to_vec()).extend(opened);
                } else if let Some(next) = &mut next {
                    next.push((base, exponent));
                }
            }
            let opened = next.is_some();
            factors = next.unwrap_or(factors);
            if !self.join_exponentials(&mut factors) && !opened {
                break;
            }
        }
        self.finish_product(coefficient, factors)
    }

    /// Records the bases whose roots disappear when exponents of equal bases are added.
    fn note_roots(&mut self, factors: &[Factor]) {
        for (i, &(base, exponent)) in factors.iter().enumerate() {
            if !is_root(exponent) || factors[..i].iter().any(|&(b, n)| b == base && is_root(n)) {
                continue;
            }
            let same = factors.iter().filter(|(b, _)| *b == base);
            let total = same.fold(Number::ZERO, |sum, &(_, n)| sum + n);
            if !is_root(total) {
                self.note_root(base);
            }
        }
    }

    /// Builds the node of a merged and settled product.
    pub(super) fn finish_product(&mut self, coefficient: Number, factors: Vec<Factor>) -> Expr {
        let coefficient = coefficient.canonical();
        if coefficient.is_zero() {
            return Expr::ZERO;
        }
        match factors.as_slice() {
            [] => self.number(coefficient),
            &[(base, exponent)] if exponent.is_one() => {
                if coefficient.is_one() {
                    base
                } else if matches!(self.node(base), Node::Sum(..)) {
                    self.linear(Number::ZERO, &[(coefficient, base)])
                } else {
                    self.intern(Node::Product(coefficient, factors.into_boxed_slice()))
                }
            }
            _ => self.intern(Node::Product(coefficient, factors.into_boxed_slice())),
        }
    }

    /// Rewrites a factor that is not canonical under its exponent: `Some((c, factors))` means
    /// `base^exponent = c · Π factors`, `None` that the factor stays.
    fn rewrite_power(&mut self, base: Expr, exponent: Number) -> Option<(Number, Vec<Factor>)> {
        if let Node::Symbol(_) | Node::Pi = self.node(base) {
            return None;
        }
        let integer = exponent.as_integer();
        match &*self.shared(base) {
            Node::Number(n) => self.rewrite_numeric_power(*n, exponent),
            Node::Product(c, inner) => {
                if let Some(k) = integer {
                    // a coefficient whose power is beyond most other numbers stays where it is
                    let power = c.powi(k).value().abs();
                    if !c.is_zero() && !(1.0 / LARGE..=LARGE).contains(&power) {
                        return None;
                    }
                    for &(b, n) in inner.iter().filter(|&&(_, n)| is_root(n)) {
                        if !is_root(n * exponent) {
                            self.note_root(b);
                        }
                    }
                    let opened = inner.iter().map(|&(b, n)| (b, n * exponent)).collect();
                    return Some((c.powi(k), opened));
                }
                if let Some(factors) = self.take_out_positive((*c, inner), exponent) {
                    return Some((Number::ONE, factors));
                }
                if let &[(b, n)] = &**inner
                    && c.is_one()
                {
                    let combined = n * exponent;
                    let odd = n.as_integer().is_none_or(|n| n % 2 != 0);
                    return (odd && combined.as_integer().is_none())
                        .then(|| (Number::ONE, vec![(b, combined)]));
                }
                if !c.is_one() && !c.is_negative() {
                    let root = self.number(*c);
                    let bare = self.finish_product(Number::ONE, inner.to_vec());
                    return Some((Number::ONE, vec![(root, exponent), (bare, exponent)]));
                }
                None
            }
            Node::Sum(constant, terms) => {
                if integer.is_none() {
                    if let Some(factors) =
                        self.factor_difference_of_squares(*constant, terms, exponent)
                    {
                        return Some((Number::ONE, factors));
                    }
                    if let Some((factor, root)) = self.perfect_square(*constant, terms) {
                        let (factor, square) = (self.number(factor), self.powi(root, 2));
                        return Some((Number::ONE, vec![(factor, exponent), (square, exponent)]));
                    }
                }
                let content = content(*constant, terms, integer.is_some());
                if content.is_one() {
                    return None;
                }
                let outside = content.exact_power(exponent)?;
                let primitive = self.scale(content.recip(), base);
                Some((outside, vec![(primitive, exponent)]))
            }
            Node::Power(b, e) if !exponent.is_one() && integer.is_some() => {
                let e = self.scale(exponent, *e);
                let power = self.pow(*b, e);
                Some((Number::ONE, vec![(power, Number::ONE)]))
            }
            Node::Call(FunctionId::Abs, arguments) if integer.is_some_and(|n| n % 2 == 0) => {
                Some((Number::ONE, vec![(arguments[0], exponent)]))
            }
            _ => None,
        }
    }

    /// A numeric base: evaluated if exact, else reduced to an exponent in (0, 1).
    fn rewrite_numeric_power(
        &mut self,
        n: Number,
        exponent: Number,
    ) -> Option<(Number, Vec<Factor>)> {
        if let Some(exact) = n.exact_power(exponent) {
            return Some((exact, Vec::new()));
        }
        let inexact = Number::Real(math::powf(n.value(), exponent.value()));
        let (Number::Rational(en, ed), false) = (exponent, n.value() <= 0.0) else {
            return Some((inexact, Vec::new()));
        };
        if matches!(n, Number::Real(_)) || ed == 1 {
            return Some((inexact, Vec::new()));
        }
        let whole = en.div_euclid(ed);
        if whole == 0 {
            return None;
        }
        let outside = n.powi(whole);
        if matches!(outside, Number::Real(_)) {
            return Some((inexact, Vec::new()));
        }
        let base = self.number(n);
        Some((outside, vec![(base, Number::Rational(en.rem_euclid(ed), ed))]))
    }

    /// Joins exponentials: `exp(a)^m exp(b)^n → exp(m a + n b)`. Returns whether any were joined.
    fn join_exponentials(&mut self, factors: &mut Vec<Factor>) -> bool {
        let exponentials: Vec<(Number, Expr)> = factors
            .iter()
            .filter_map(|&(base, n)| match self.node(base) {
                Node::Call(FunctionId::Exp, arguments) => Some((n, arguments[0])),
                _ => None,
            })
            .collect();
        if exponentials.is_empty() || matches!(exponentials.as_slice(), [(n, _)] if n.is_one()) {
            return false;
        }
        factors.retain(|&(base, _)| !matches!(self.node(base), Node::Call(FunctionId::Exp, _)));
        let exponent = self.linear(Number::ZERO, &exponentials);
        let joined = self.call(FunctionId::Exp, &[exponent]);
        factors.push((joined, Number::ONE));
        true
    }
}

/// Whether the product of two numbers in range is out of it.
fn leaves_range(a: Number, b: Number) -> bool {
    let is_in_range = |x: Number| (f64::MIN_POSITIVE..f64::INFINITY).contains(&x.value().abs());
    is_in_range(a) && is_in_range(b) && !is_in_range(a * b)
}

/// Returns whether a power has a value only for a nonnegative base.
fn is_root(exponent: Number) -> bool {
    matches!(exponent, Number::Rational(_, below) if below % 2 == 0)
}

/// Sorts by base and adds the exponents of equal bases.
fn merge(factors: &mut Vec<Factor>) {
    factors.sort_unstable_by_key(|&(base, _)| base);
    factors.dedup_by(|&mut (base, exponent), (last, total)| {
        let is_equal = *last == base;
        if is_equal {
            *total = *total + exponent;
        }
        is_equal
    });
    for (_, exponent) in factors.iter_mut() {
        *exponent = exponent.canonical();
    }
    factors.retain(|(_, exponent)| !exponent.is_zero());
}

/// The factor to be taken out of a sum: the common divisor of its coefficients and, if `signed`,
/// the sign of its first term.
fn content(constant: Number, terms: &[(Number, Expr)], signed: bool) -> Number {
    let real = |n: &Number| matches!(n, Number::Real(_));
    if real(&constant) || terms.iter().any(|(c, _)| real(c)) {
        return Number::ONE;
    }
    let first = terms[0].0;
    let mut divisor = if constant.is_zero() { first.abs() } else { constant.abs() };
    for &(c, _) in terms {
        divisor = divisor.common_divisor(c);
    }
    if signed && first.is_negative() { -divisor } else { divisor }
}
