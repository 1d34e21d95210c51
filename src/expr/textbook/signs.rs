//! The signs of differences within products, the same in every equation.
//!
//! In: an expression. Out: an equal one. Never here: fractions, the notation.

use rustc_hash::FxHashMap;

use crate::expr::node::{Expr, Node};
use crate::expr::pool::Pool;
use crate::expr::product::Factor;
use crate::expr::symbol::Rank;
use crate::num::Number;

impl Pool {
    /// Differences within products begin with their number, in every equation, and the sign of the product stands before it:
    /// `x + a (e − 1)` as `x − a (1 − e)`, `(e − 1) (cos θ − 1)/l` as `(1 − e) (1 − cos θ)/l`. What is not constant and no function
    /// stays before the number: `−k (x − 1)`. No product gets a sign within a function, a power or another product, or where it is
    /// all that is written: `(b − 1) M₂ M₃`.
    pub(super) fn turn_signs(&mut self, e: Expr) -> Expr {
        let mut turned: FxHashMap<Expr, Expr> = FxHashMap::default();
        let mut within: FxHashMap<Expr, Expr> = FxHashMap::default();
        for part in self.reachable(&[e]) {
            let is_sum = matches!(self.node(part), Node::Sum(..));
            let parts = if is_sum { &turned } else { &within };
            match self.node(part).with_parts(|part| parts[&part]) {
                Node::Product(c, factors) => {
                    let (is_opposite, other_factors) = self.turned_factors(&factors);
                    let other = if is_opposite { -c } else { c };
                    let new = self.intern(Node::Product(other, other_factors));
                    turned.insert(part, new);
                    let gets_sign = other.is_negative() && !c.is_negative();
                    let signed =
                        if gets_sign { self.intern(Node::Product(c, factors)) } else { new };
                    within.insert(part, signed);
                }
                Node::Sum(constant, mut terms) => {
                    for (c, term) in &mut terms {
                        let Node::Product(k, factors) = self.node(*term).clone() else { continue };
                        if k.is_negative() {
                            (*c, *term) = (-*c, self.intern(Node::Product(-k, factors)));
                        }
                    }
                    let new = self.intern(Node::Sum(constant, terms));
                    turned.insert(part, new);
                    within.insert(part, new);
                }
                node => {
                    let new = self.intern(node);
                    turned.insert(part, new);
                    within.insert(part, new);
                }
            }
        }
        // a term alone has no sign before it that another could take
        if matches!(self.node(e), Node::Product(..)) { within[&e] } else { turned[&e] }
    }

    /// The factors of a product with every sum whose only negative term is its number, or all of whose terms are negative,
    /// replaced by its opposite, and whether they make the opposite product.
    fn turned_factors(&mut self, factors: &[Factor]) -> (bool, Box<[Factor]>) {
        let is_odd = |n: Number| n.as_integer().is_some_and(|n| n % 2 != 0);
        let mut is_opposite = false;
        let mut turned = factors.to_vec();
        for (base, _) in turned.iter_mut().filter(|(_, n)| is_odd(*n)) {
            let Node::Sum(constant, terms) = &*self.shared(*base) else { continue };
            let comes_second = constant.is_negative()
                && terms.iter().all(|&(c, term)| {
                    let is_call = matches!(self.node(term), Node::Call(..));
                    !c.is_negative() && (is_call || self.rank_of(term) == Rank::Constant)
                });
            let all_negative = (constant.is_zero() || constant.is_negative())
                && terms.iter().all(|(c, _)| c.is_negative());
            if comes_second || all_negative {
                let opposite = terms.iter().map(|&(c, term)| (-c, term)).collect();
                *base = self.intern(Node::Sum(-*constant, opposite));
                is_opposite = !is_opposite;
            }
        }
        (is_opposite, turned.into())
    }
}
