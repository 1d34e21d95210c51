//! The numbers in and before the sums of a product, as short as they can be: `½ (p − 0.3 x)²`, not `0.005 (10 p − 3 x)²`.
//!
//! In: an expression. Out: an equal one. Never here: symbols, the notation.

use rustc_hash::FxHashMap;

use crate::expr::node::{Expr, Node};
use crate::expr::notation::FRACTIONS;
use crate::expr::pool::Pool;
use crate::expr::product::Factor;
use crate::num::Number;

/// What a fraction of one character within a sum counts for: more than a digit. ½ before a sum counts for nothing.
const FRACTION: usize = 2;

/// Sums are not rescaled under higher powers.
const HIGHEST_POWER: i64 = 4;

impl Pool {
    /// Divides the sums of products by one of their numbers, which goes before the product, where less is written then.
    /// Where that makes no difference, a product that begins with ½ is the one taken: `½ m (x′² + ½ r² θ′²)`.
    pub(super) fn shorten_coefficients(&mut self, e: Expr) -> Expr {
        let mut shorter: FxHashMap<Expr, Expr> = FxHashMap::default();
        for part in self.reachable(&[e]) {
            let node = match self.node(part).with_parts(|part| shorter[&part]) {
                Node::Product(c, factors) => {
                    let (c, factors) = self.rescaled(c, &factors);
                    Node::Product(c, factors)
                }
                Node::Sum(constant, mut terms) => {
                    for (c, term) in &mut terms {
                        let Node::Product(k, factors) = self.node(*term).clone() else { continue };
                        let (all, factors) = self.rescaled(*c * k, &factors);
                        (*c, *term) = (all, self.intern(Node::Product(Number::ONE, factors)));
                    }
                    Node::Sum(constant, terms)
                }
                node => node,
            };
            let new = self.intern(node);
            shorter.insert(part, new);
        }
        shorter[&e]
    }

    /// The product of a number and factors with the same value, its sums rescaled.
    fn rescaled(&mut self, c: Number, factors: &[Factor]) -> (Number, Box<[Factor]>) {
        let (mut c, mut factors) = (c, factors.to_vec());
        for (base, n) in &mut factors {
            let Some(power) = n.as_integer().filter(|n| n.abs() <= HIGHEST_POWER) else { continue };
            let Node::Sum(constant, terms) = &*self.shared(*base) else { continue };
            let numbers = terms.iter().map(|&(c, _)| c).chain([*constant]);
            let numbers: Vec<Number> = numbers.filter(|n| !n.is_zero()).map(Number::abs).collect();
            let written = |scale: Number| {
                let before = (c * Number::powi(scale, power)).abs();
                let is_half = before == Number::HALF;
                let inside = numbers.iter().map(|&n| digits(n * scale.recip(), FRACTION));
                let before = if is_half { 0 } else { digits(before, 1) };
                (before + inside.sum::<usize>(), !is_half)
            };
            let scales = [Number::ONE].into_iter().chain(numbers.iter().copied());
            let Some(scale) = scales.min_by_key(|&scale| written(scale)) else { continue };
            if !scale.is_one() {
                let inverse = scale.recip();
                let rescaled = terms.iter().map(|&(c, term)| (c * inverse, term)).collect();
                *base = self.intern(Node::Sum(*constant * inverse, rescaled));
                c = c * Number::powi(scale, power);
            }
        }
        (c, factors.into())
    }
}

/// How many characters a number takes as a factor, given what a fraction of one character counts for; one is not written.
fn digits(n: Number, fraction: usize) -> usize {
    let length = |n: i64| n.unsigned_abs().to_string().len();
    match n.abs() {
        n if n.is_one() => 0,
        Number::Rational(n, 1) => length(n),
        Number::Rational(n, d) if FRACTIONS.iter().any(|f| (f.0, f.1) == (n, d)) => fraction,
        // a line between them, or a point, and often parentheses
        Number::Rational(n, d) => length(n) + 3 + length(d),
        Number::Real(x) => x.to_string().len(),
    }
}
