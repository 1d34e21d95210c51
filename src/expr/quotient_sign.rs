//! Signs of quotients as signs of products: sign(1 − 1/t) = sign(t (t − 1)), sign(tan u) = sign(sin 2u); and of functions and powers
//! that have the sign of their argument: sign(sinh u) = sign(e^u − 1) = sign u, sign(p u³) = sign(p u).
//!
//! In: an expression. Out: one without poles that has the same sign wherever the first has a value. What only parameters are in stays as
//! it is, and so does what depends on several variables or divides by high powers: of small numbers a product may leave the range in
//! which the quotient is. Never here: the function sign.

use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use super::product::Factor;
use super::symbol::Rank;
use crate::num::Number;

/// The highest power of what a sum divides by that it is multiplied by.
const HIGHEST: i64 = 4;

impl Pool {
    /// A function without poles that has the sign of another function of one variable: the same where that has none to be seen in its
    /// sums and products.
    pub(super) fn with_the_sign_of(&mut self, e: Expr) -> Expr {
        let symbols = self.symbols_of(e);
        let moving = symbols.iter().filter(|&&s| self.symbol_info(s).rank != Rank::Constant);
        if moving.count() != 1 {
            return e;
        }
        match &*self.shared(e) {
            Node::Product(c, factors) => {
                let mut all = Vec::new();
                for &factor in factors {
                    all.extend(self.factor_with_the_sign_of(factor));
                }
                self.monomial(*c, &all)
            }
            Node::Call(FunctionId::Tan | FunctionId::Cot, _) => {
                let factor = self.factor_with_the_sign_of((e, Number::ONE));
                self.monomial(Number::ONE, &factor.into_iter().collect::<Vec<_>>())
            }
            Node::Call(FunctionId::Sinh | FunctionId::Tanh | FunctionId::Atan, u) => {
                self.with_the_sign_of(u[0])
            }
            Node::Sum(constant, terms) => match self.difference_of_exponents(*constant, terms) {
                Some((c, difference)) => {
                    let bare = self.with_the_sign_of(difference);
                    self.scale(c, bare)
                }
                None => self.sum_over_divisors(e),
            },
            _ => e,
        }
    }

    /// The c and u − w of c (e^u − e^w), where w may be 0.
    fn difference_of_exponents(
        &mut self,
        constant: Number,
        terms: &[(Number, Expr)],
    ) -> Option<(Number, Expr)> {
        let exponent = |pool: &Pool, e: Expr| match pool.node(e) {
            Node::Call(FunctionId::Exp, u) => Some(u[0]),
            _ => None,
        };
        match *terms {
            [(c, e)] if (constant + c).is_zero() => Some((c, exponent(self, e)?)),
            [(c, e), (d, f)] if constant.is_zero() && (c + d).is_zero() => {
                let (u, w) = (exponent(self, e)?, exponent(self, f)?);
                let parts = [(Number::ONE, u), (Number::MINUS_ONE, w)];
                Some((c, self.linear(Number::ZERO, &parts)))
            }
            _ => None,
        }
    }

    /// A factor that has the sign of another, if it has another sign than 1.
    fn factor_with_the_sign_of(&mut self, (base, n): Factor) -> Option<Factor> {
        let is_odd = n.as_integer().is_none_or(|n| n % 2 != 0);
        let has_pole = self.may_have_pole((base, n));
        match &*self.shared(base) {
            Node::Call(FunctionId::Tan | FunctionId::Cot, u) if has_pole && is_odd => {
                let twice = self.scale(Number::integer(2), u[0]);
                Some((self.call(FunctionId::Sin, &[twice]), Number::ONE))
            }
            Node::Call(FunctionId::Sinh | FunctionId::Tanh | FunctionId::Atan, _)
                if n.as_integer().is_some() && is_odd =>
            {
                Some((self.with_the_sign_of(base), Number::ONE))
            }
            Node::Sum(..) if n.is_one() => Some((self.with_the_sign_of(base), n)),
            _ if has_pole && is_odd => Some((self.with_the_sign_of(base), Number::ONE)),
            _ if has_pole && n.is_negative() => None,
            // where the base passes zero its power leaves the range of numbers, or has a root with fewer digits
            _ if n.as_integer().is_some_and(|n| n > 2) && self.rank_of(base) != Rank::Constant => {
                let order = if is_odd { Number::ONE } else { Number::integer(2) };
                Some((if is_odd { self.with_the_sign_of(base) } else { base }, order))
            }
            _ => Some((base, n)),
        }
    }

    /// Whether a whole power has poles where something moves.
    fn may_have_pole(&self, (base, n): Factor) -> bool {
        let is_tangent =
            matches!(self.node(base), Node::Call(FunctionId::Tan | FunctionId::Cot, _));
        n.as_integer().is_some()
            && (is_tangent || n.is_negative())
            && self.rank_of(base) != Rank::Constant
    }

    /// A sum times what its terms divide by, that an even number of times.
    fn sum_over_divisors(&mut self, sum: Expr) -> Expr {
        let mut terms: Vec<(Number, Vec<Factor>)> = Vec::new();
        for (c, term) in self.summands(sum) {
            terms.push((c, self.factors_without_tangents(term)));
        }
        let mut divisors: Vec<Factor> = Vec::new();
        for &(base, n) in terms.iter().flat_map(|(_, factors)| factors) {
            if !n.is_negative() || !self.may_have_pole((base, n)) {
                continue;
            }
            match divisors.iter_mut().find(|(known, _)| *known == base) {
                Some((_, power)) => *power = (*power).max(-n),
                None => divisors.push((base, -n)),
            }
        }
        let degree: Option<i64> = divisors.iter().map(|(_, n)| n.as_integer()).sum();
        if divisors.is_empty() || degree.is_none_or(|degree| degree > HIGHEST) {
            return sum;
        }
        let mut above = Vec::new();
        for (c, factors) in terms {
            above.push((c, self.monomial(Number::ONE, &[factors, divisors.clone()].concat())));
        }
        let above = self.linear(Number::ZERO, &above);
        let mut all = vec![(self.with_the_sign_of(above), Number::ONE)];
        for (base, n) in divisors {
            all.extend(self.factor_with_the_sign_of((base, -n)));
        }
        self.monomial(Number::ONE, &all)
    }

    /// The factors of a term, with quotients of sines and cosines for tangents.
    fn factors_without_tangents(&mut self, term: Expr) -> Vec<Factor> {
        let factors = match self.node(term) {
            Node::Product(c, factors) if c.is_one() => factors.to_vec(),
            _ => vec![(term, Number::ONE)],
        };
        let mut plain = Vec::new();
        for (base, n) in factors {
            let (above, below, u) = match &*self.shared(base) {
                Node::Call(FunctionId::Tan, u) => (FunctionId::Sin, FunctionId::Cos, u[0]),
                Node::Call(FunctionId::Cot, u) => (FunctionId::Cos, FunctionId::Sin, u[0]),
                _ => {
                    plain.push((base, n));
                    continue;
                }
            };
            if self.may_have_pole((base, n)) {
                plain.push((self.call(above, &[u]), n));
                plain.push((self.call(below, &[u]), -n));
            } else {
                plain.push((base, n));
            }
        }
        plain
    }
}
