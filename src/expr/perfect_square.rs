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
        let two = Number::integer(2);
        let (mut squares, mut products) = (Vec::new(), Vec::new());
        if !constant.is_zero() {
            squares.push((constant, Expr::ONE));
        }
        for &(c, term) in terms {
            match self.node(term) {
                Node::Product(one, factors)
                    if one.is_one() && factors.len() == 1 && factors[0].1 == two =>
                {
                    squares.push((c, factors[0].0));
                }
                _ => products.push((c, term)),
            }
        }
        let n = squares.len();
        let may_be = (2..=MOST).contains(&n)
            && products.len() == n * (n - 1) / 2
            && squares.iter().all(|(c, _)| !c.is_negative());
        if !may_be {
            return None;
        }
        let (a, first) = squares[0];
        let mut coefficient = |u: Expr, v: Expr| {
            let product = self.mul(u, v);
            products.iter().find(|(_, term)| *term == product).map(|&(c, _)| c * (two * a).recip())
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
}
