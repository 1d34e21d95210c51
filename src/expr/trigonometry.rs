//! Combining two terms of a sum: `R cos²u + R sin²u → R`, `R − R sin²u → R cos²u`, the hyperbolic
//! analogues, and the addition theorems in reverse, `R cos a cos b + R sin a sin b → R cos(a − b)`.

use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use crate::num::Number;

/// The terms of a sum with their coefficients, as [`Pool::summands`] lists them.
type SumTerms = [(Number, Expr)];
/// Another term of the sum, and the term that results from combining it with the first.
type Join = (Expr, (Number, Expr));

impl Pool {
    /// Combines every pair of terms of a sum for which this is possible.
    pub(super) fn join_terms(&mut self, e: Expr) -> Expr {
        let mut e = e;
        while let Some(joined) = self.join_one(e) {
            e = joined;
        }
        e
    }

    /// Combines the first pair of terms for which this is possible.
    fn join_one(&mut self, e: Expr) -> Option<Expr> {
        let terms = self.summands(e);
        if terms.len() < 2 {
            return None;
        }
        for &(c, term) in &terms {
            let join =
                self.join_square(term, c, &terms).or_else(|| self.join_angles(term, c, &terms));
            if let Some((other, joined)) = join {
                let mut left: Vec<(Number, Expr)> =
                    terms.iter().copied().filter(|&(_, t)| t != term && t != other).collect();
                left.push(joined);
                return Some(self.linear(Number::ZERO, &left));
            }
        }
        None
    }

    /// For a term `c f(u)² rest`, with f a (hyperbolic) sine or cosine, finds another term to
    /// combine it with.
    fn join_square(&mut self, term: Expr, c: Number, all: &SumTerms) -> Option<Join> {
        use FunctionId::{Cos, Cosh, Sin, Sinh};
        let shared = self.shared(term);
        let factors = plain_factors(&shared)?;
        for (i, &(base, n)) in factors.iter().enumerate() {
            if n.as_integer().is_none_or(|n| n < 2) {
                continue;
            }
            let Node::Call(function, u) = self.node(base) else { continue };
            // f² = a + b g²
            let (partner, a, b) = match function {
                Sin => (Cos, Number::ONE, Number::MINUS_ONE),
                Cos => (Sin, Number::ONE, Number::MINUS_ONE),
                Sinh => (Cosh, Number::MINUS_ONE, Number::ONE),
                Cosh => (Sinh, Number::ONE, Number::ONE),
                _ => continue,
            };
            let u = u[0];
            let mut rest = factors.to_vec();
            rest[i].1 = n + Number::integer(-2);
            let rest = self.monomial(Number::ONE, &rest);
            let call = self.call(partner, &[u]);
            let squared = [(call, Number::integer(2)), (rest, Number::ONE)];
            let partner = self.monomial(Number::ONE, &squared);
            // c f² + d g² = c a for d = −c b
            if coefficient(all, partner).is_some_and(|d| (c * b + d).is_zero()) {
                return Some((partner, (c * a, rest)));
            }
            // c f² + d = c b g² for d = −c a
            if coefficient(all, rest).is_some_and(|d| (c * a + d).is_zero()) {
                return Some((rest, (c * b, partner)));
            }
        }
        None
    }

    /// For a term `c cos a cos b rest` or `c sin a cos b rest`, finds another term to combine it
    /// with.
    fn join_angles(&mut self, term: Expr, c: Number, all: &SumTerms) -> Option<Join> {
        use FunctionId::{Cos, Sin};
        let shared = self.shared(term);
        let factors = plain_factors(&shared)?;
        let circular: Vec<(usize, FunctionId, Expr)> = factors
            .iter()
            .enumerate()
            .filter(|(_, (_, n))| n.as_integer().is_some_and(|n| n >= 1))
            .filter_map(|(i, &(base, _))| match self.node(base) {
                Node::Call(function @ (Sin | Cos), u) => Some((i, *function, u[0])),
                _ => None,
            })
            .collect();
        for &(i, f, a) in &circular {
            for &(j, g, b) in &circular {
                // cos a cos b once, sin a cos b always
                if i == j || g != Cos || a == b || (f == Cos && i > j) {
                    continue;
                }
                let (f_partner, g_partner) = if f == Cos { (Sin, Sin) } else { (Cos, Sin) };
                let mut rest = factors.to_vec();
                for k in [i, j] {
                    rest[k].1 = rest[k].1 + Number::MINUS_ONE;
                }
                let rest = self.monomial(Number::ONE, &rest);
                let f_partner = self.call(f_partner, &[a]);
                let g_partner = self.call(g_partner, &[b]);
                let other = self.product(&[f_partner, g_partner, rest]);
                let Some(d) = coefficient(all, other) else { continue };
                // cos a cos b ± sin a sin b = cos(a ∓ b), sin a cos b ± cos a sin b = sin(a ± b)
                let plus = match (d == c, d == -c) {
                    (true, _) => f == Sin,
                    (_, true) => f == Cos,
                    _ => continue,
                };
                let angle = if plus { self.add(a, b) } else { self.sub(a, b) };
                let joined = self.call(f, &[angle]);
                return Some((other, (c, self.mul(joined, rest))));
            }
        }
        None
    }
}

/// The factors of a product that has no coefficient.
fn plain_factors(term: &Node) -> Option<&[(Expr, Number)]> {
    match term {
        Node::Product(c, factors) if c.is_one() => Some(factors),
        _ => None,
    }
}

/// The coefficient of a term: they ascend, but for the constant at the end.
fn coefficient(all: &SumTerms, term: Expr) -> Option<Number> {
    let (ascending, constant) = match all {
        [ascending @ .., (c, Expr::ONE)] => (ascending, Some(*c)),
        _ => (all, None),
    };
    if term == Expr::ONE {
        return constant;
    }
    ascending.binary_search_by_key(&term, |&(_, t)| t).ok().map(|i| ascending[i].0)
}
