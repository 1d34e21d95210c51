//! How an expression grows when its symbols are scaled, as it is written.
//!
//! In: an expression, a weight b of each symbol, which is scaled by λ^b. Out: the k of λ^k, by which the expression is scaled;
//! what is found is so. Never here: degrees that take rearrangement.

use crate::expr::{Expr, Node, Pool, Symbol};
use crate::num::Number;

/// The degree of an expression, each symbol with its weight: of sums of terms of one degree, products, powers, functions of
/// what has degree 0. An exponent may be a parameter.
pub fn weighted_degree(pool: &mut Pool, e: Expr, weights: &[(Symbol, Number)]) -> Option<Expr> {
    let scaled: Vec<Symbol> = weights.iter().map(|(s, _)| *s).collect();
    degree(pool, e, weights, &scaled)
}

fn degree(
    pool: &mut Pool,
    e: Expr,
    weights: &[(Symbol, Number)],
    scaled: &[Symbol],
) -> Option<Expr> {
    if !pool.depends_on_any(e, scaled) {
        return Some(Expr::ZERO);
    }
    match pool.node(e).clone() {
        Node::Number(_) | Node::Pi => Some(Expr::ZERO),
        Node::Symbol(s) => {
            let weight = weights.iter().find(|(symbol, _)| *symbol == s)?.1;
            Some(pool.number(weight))
        }
        Node::Sum(constant, terms) => {
            let mut degrees = Vec::new();
            for &(_, term) in &terms {
                degrees.push(degree(pool, term, weights, scaled)?);
            }
            if !constant.is_zero() {
                degrees.push(Expr::ZERO);
            }
            degrees.iter().all(|d| *d == degrees[0]).then(|| degrees[0])
        }
        Node::Product(_, factors) => {
            let mut parts = Vec::new();
            for &(base, n) in &factors {
                parts.push((n, degree(pool, base, weights, scaled)?));
            }
            Some(pool.linear(Number::ZERO, &parts))
        }
        Node::Power(base, exponent) if !pool.depends_on_any(exponent, scaled) => {
            let own = degree(pool, base, weights, scaled)?;
            Some(pool.mul(own, exponent))
        }
        Node::Power(..) => None,
        Node::Call(_, arguments) => {
            let free =
                arguments.iter().all(|&u| degree(pool, u, weights, scaled) == Some(Expr::ZERO));
            free.then_some(Expr::ZERO)
        }
    }
}
