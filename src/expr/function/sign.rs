//! The sign: 1, −1, and 0 at zero.

use super::{Function, FunctionId, KinkBranches, Rule};
use crate::expr::{Expr, Node, Pool};
use crate::num::{Number, math};

/// sign uⁿ = sign u or sign² u for whole n > 1: where u passes zero, uⁿ has a root of order n, which is located with fewer digits.
fn of_power(pool: &mut Pool, argument: Expr) -> Option<Expr> {
    let Node::Product(factor, bases) = pool.node(argument) else { return None };
    let &[(base, exponent)] = &**bases else { return None };
    let order = exponent.as_integer().filter(|&order| order > 1)?;
    let outer = if factor.is_negative() { Number::MINUS_ONE } else { Number::ONE };
    let sign = pool.call(FunctionId::Sign, &[base]);
    let sign = if order % 2 == 0 { pool.powi(sign, 2) } else { sign };
    Some(pool.scale(outer, sign))
}

/// Factors beyond this, or below its reciprocal, are taken out: beside a zero nothing else keeps what they multiply in range.
const LARGE: f64 = 1e100;

/// sign(2ᵏ u) = sign u, for what has a very small, or a very large number as a factor, or only such coefficients.
fn within_range(pool: &mut Pool, argument: Expr) -> Option<Expr> {
    let is_extreme = |c: f64| c.is_normal() && !(1.0 / LARGE..=LARGE).contains(&c.abs());
    let bare = match &*pool.shared(argument) {
        Node::Product(c, factors) if is_extreme(c.value()) => {
            let sign = if c.is_negative() { Number::MINUS_ONE } else { Number::ONE };
            pool.monomial(sign, factors)
        }
        Node::Sum(constant, terms) => {
            let sizes = terms.iter().map(|(c, _)| *c).chain([*constant]).map(|c| c.value().abs());
            let largest = sizes.fold(0.0, f64::max);
            if !is_extreme(largest) {
                return None;
            }
            let power = math::powi(2.0, -math::log2(largest).clamp(-1000.0, 1000.0) as i32);
            let scaled = |c: Number| Number::Real(c.value() * power).canonical();
            let terms: Vec<(Number, Expr)> =
                terms.iter().map(|&(c, term)| (scaled(c), term)).collect();
            pool.linear(scaled(*constant), &terms)
        }
        _ => return None,
    };
    Some(pool.call(FunctionId::Sign, &[bare]))
}

/// The sign of a quotient is that of a product: one that changes at a pole changes at a zero then, which can be located.
fn of_quotient(pool: &mut Pool, argument: Expr) -> Option<Expr> {
    let cleared = pool.with_the_sign_of(argument);
    (cleared != argument).then(|| pool.call(FunctionId::Sign, &[cleared]))
}

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Sign,
    name: "sign",
    unicode: "sign",
    latex: "\\operatorname{sign}",
    arity: 1,
    value: |u| if u[0] == 0.0 { 0.0 } else { u[0].signum() },
    fold: |pool, u| match *pool.node(u[0]) {
        Node::Number(n) if !n.is_zero() => Some(pool.integer(n.value().signum() as i64)),
        Node::Pi => Some(Expr::ONE),
        _ => (pool.fold_odd(FunctionId::Sign, u[0]))
            .or_else(|| of_power(pool, u[0]))
            .or_else(|| of_quotient(pool, u[0]))
            .or_else(|| within_range(pool, u[0])),
    },
    derivative: |_, _, _| Expr::ZERO,
    rule: Rule::Branch(|pool, u| KinkBranches {
        switch: u[0],
        positive: Expr::ONE,
        negative: pool.integer(-1),
    }),
};
