//! Sums that are squares, as x² − 2x + 1 = (x − 1)²: a root of one has a kink at its zero, which the sum does not show.
//!
//! In: the terms of a sum. Out: what it is the square of, with a factor. Never here: roots.

use super::node::{Expr, Node};
use super::pool::Pool;
use crate::num::Number;

/// The greatest number of terms of what is squared.
const MOST: usize = 4;

impl Pool {
    /// The factor a > 0 and the sum s for which the sum of these terms is a s².
    pub(super) fn perfect_square(
        &mut self,
        constant: Number,
        terms: &[(Number, Expr)],
    ) -> Option<(Number, Expr)> {
        let (mut squares, mut products) = (Vec::new(), Vec::new());
        if !constant.is_zero() {
            squares.push((constant, Expr::ONE));
        }
        for &(c, term) in terms {
            match self.root_of_square(term).filter(|_| !c.is_negative()) {
                Some(root) => squares.push((c, root)),
                None => products.push((c, term)),
            }
        }
        let n = squares.len();
        let may_be =
            (2..=MOST).contains(&n) && products.len() == n * (n - 1) / 2 && !constant.is_negative();
        if !may_be {
            return None;
        }
        let (a, first) = squares[0];
        let mut coefficient = |u: Expr, v: Expr| {
            let product = self.mul(u, v);
            products
                .iter()
                .find(|(_, term)| *term == product)
                .map(|&(c, _)| c * (Number::integer(2) * a).recip())
        };
        let mut roots = vec![(Number::ONE, first)];
        for &(c, u) in &squares[1..] {
            let root = coefficient(first, u)?;
            if root * root != c * a.recip() {
                return None;
            }
            roots.push((root, u));
        }
        for (i, &(b, u)) in roots.iter().enumerate().skip(1) {
            for &(c, v) in &roots[i + 1..] {
                if coefficient(u, v)? != b * c {
                    return None;
                }
            }
        }
        Some((a, self.linear(Number::ZERO, &roots)))
    }

    /// What a product without a factor of its own is the square of, where all its powers are even.
    fn root_of_square(&mut self, term: Expr) -> Option<Expr> {
        let Node::Product(one, factors) = self.node(term) else { return None };
        let half = |&(base, power): &(Expr, Number)| {
            let half = power.as_integer().filter(|n| n % 2 == 0)? / 2;
            Some((base, Number::integer(half)))
        };
        let roots =
            one.is_one().then(|| factors.iter().map(half).collect::<Option<Vec<_>>>())??;
        Some(self.monomial(Number::ONE, &roots))
    }
}
