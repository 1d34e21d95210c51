//! Roots of what has positive factors, exponentials and hyperbolic cosines: these are taken out of the root, and differences of
//! squares are factored where that gives one, as `√(1 − tanh²u) → 1/cosh u` and `√(1 − (1 − e^u)²) → e^(u/2) √(2 − e^u)`. The
//! difference has no digits where u saturates.
//!
//! In: a base, an exponent that is not whole. Out: factors. Never here: whole powers.

use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use super::product::Factor;
use crate::num::Number;

/// The greatest power of a hyperbolic tangent that is divided by its square.
const MOST: i64 = 16;

impl Pool {
    fn is_positive_function(&self, e: Expr) -> bool {
        matches!(self.node(e), Node::Call(FunctionId::Exp | FunctionId::Cosh, _))
    }

    /// Takes positive factors of a product out of its root.
    pub(super) fn take_out_positive(
        &mut self,
        (coefficient, inner): (Number, &[Factor]),
        exponent: Number,
    ) -> Option<Vec<Factor>> {
        let (positive, rest): (Vec<Factor>, Vec<Factor>) =
            inner.iter().partition(|&&(base, _)| self.is_positive_function(base));
        if positive.is_empty() {
            return None;
        }
        let rest = self.finish_product(coefficient, rest);
        let outside = positive.into_iter().map(|(base, n)| (base, n * exponent));
        Some(outside.chain([(rest, exponent)]).collect())
    }

    /// Whether an expression is a product of such functions.
    fn is_positive(&self, e: Expr) -> bool {
        match self.node(e) {
            Node::Product(c, factors) => {
                !c.is_negative() && factors.iter().all(|&(base, _)| self.is_positive_function(base))
            }
            _ => self.is_positive_function(e),
        }
    }

    /// The positive factors of c + d s^n, with an even n, and the rest.
    pub(super) fn factor_difference_of_squares(
        &mut self,
        constant: Number,
        terms: &[(Number, Expr)],
        exponent: Number,
    ) -> Option<Vec<Factor>> {
        let &[(d, term)] = terms else { return None };
        let Node::Product(one, factors) = self.node(term) else { return None };
        let &[(s, n)] = &**factors else { return None };
        let n = n.as_integer().filter(|n| one.is_one() && n % 2 == 0)?;
        let shared = self.shared(s);
        match &*shared {
            Node::Call(FunctionId::Tanh, argument) if (2..=MOST).contains(&n) => {
                if !(constant + d).is_zero() || constant.is_negative() {
                    return None;
                }
                let cosine = self.call(FunctionId::Cosh, argument);
                let powers: Vec<(Number, Expr)> =
                    (0..n / 2).map(|k| (constant, self.powi(s, 2 * k))).collect();
                let rest = self.linear(Number::ZERO, &powers);
                Some(vec![(cosine, Number::integer(-2) * exponent), (rest, exponent)])
            }
            Node::Sum(k, sum) => {
                let &[(multiple, t)] = &**sum else { return None };
                // with s = k + m t it is d m t (m t + 2k), or c m t (m t + 2k)/s²
                let (first, is_inverse) = match n {
                    2 => (d, false),
                    -2 => (constant, true),
                    _ => return None,
                };
                let last = if is_inverse { d } else { constant };
                let keeps_sign = !k.is_negative() && !multiple.is_negative();
                let is_factored = (last + first * *k * *k).is_zero()
                    && self.is_positive(t)
                    && (keeps_sign || !is_inverse);
                if !is_factored {
                    return None;
                }
                let first = first * multiple;
                let sign = if first.is_negative() { Number::MINUS_ONE } else { Number::ONE };
                let twice = Number::integer(2) * *k;
                let rest = self.linear(sign * twice, &[(sign * multiple, t)]);
                let size = self.number(first.abs());
                let mut factors = vec![(size, exponent), (t, exponent), (rest, exponent)];
                if is_inverse {
                    factors.push((s, Number::integer(-2) * exponent));
                }
                Some(factors)
            }
            _ => None,
        }
    }
}
