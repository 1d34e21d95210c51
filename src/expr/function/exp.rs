//! The exponential.

use super::recurrence::{BilinearEquation, Convolution, FIRST, Recurrence, VALUE};
use super::{Function, FunctionId, Rule};
use crate::expr::{Expr, Node, Pool, Rank, is_never_negative};
use crate::num::{Analytic, Number, math};

/// The value, and that of the companion.
pub(super) fn with_companion<R: Analytic>(u: [R; 2]) -> (R, R) {
    (u[0].exp(), R::ZERO)
}

/// y = exp u: y′ = y u′.
const RECURRENCE: Recurrence = Recurrence {
    companion_first: false,
    value: BilinearEquation::over_order(&[Convolution::of_slope(1.0, FIRST, VALUE)]),
    companion: None,
};

/// `exp(c ln u + v) → u^c exp(v)` where both have a value for the same u, but for the limit at u = 0; c may be a parameter.
fn powers_of_logarithms(pool: &mut Pool, exponent: Expr) -> Option<Expr> {
    let (mut powers, mut others) = (Vec::new(), Vec::new());
    for (c, term) in pool.summands(exponent) {
        match power_of_logarithm(pool, c, term) {
            Some(power) => powers.push((power, Number::ONE)),
            None => others.push((c, term)),
        }
    }
    if powers.is_empty() {
        return None;
    }
    let rest = pool.linear(Number::ZERO, &others);
    let rest = pool.call(FunctionId::Exp, &[rest]);
    powers.push((rest, Number::ONE));
    Some(pool.monomial(Number::ONE, &powers))
}

/// The power that the exponential of c times a term is.
fn power_of_logarithm(pool: &mut Pool, c: Number, term: Expr) -> Option<Expr> {
    let (c, factors) = match pool.node(term) {
        Node::Product(k, factors) => (c * *k, factors.to_vec()),
        _ => (c, vec![(term, Number::ONE)]),
    };
    let is_logarithm = |&(base, n): &(Expr, Number)| {
        n.is_one() && matches!(pool.node(base), Node::Call(FunctionId::Ln, _))
    };
    let place = factors.iter().position(is_logarithm)?;
    let Node::Call(_, u) = pool.node(factors[place].0) else { return None };
    let u = u[0];
    if factors.len() == 1 {
        return is_same_power(pool, u, c).then(|| pool.monomial(Number::ONE, &[(u, c)]));
    }
    let others: Vec<_> = factors.iter().copied().enumerate().filter(|(k, _)| *k != place).collect();
    let others: Vec<(Expr, Number)> = others.into_iter().map(|(_, factor)| factor).collect();
    let exponent = pool.monomial(c, &others);
    let is_fixed = pool.rank_of(exponent) == Rank::Constant;
    (is_fixed && is_never_negative(pool, u)).then(|| pool.pow(u, exponent))
}

/// Whether `u^c` has a value for no more u than `exp(c ln u)`, but for 0.
fn is_same_power(pool: &Pool, u: Expr, c: Number) -> bool {
    let is_root = matches!(c, Number::Rational(_, below) if below % 2 == 0);
    !c.is_negative() && (is_root || is_never_negative(pool, u))
}

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Exp,
    name: "exp",
    unicode: "exp",
    latex: "\\exp",
    arity: 1,
    value: |u| math::exp(u[0]),
    fold: |pool, u| match u[0] {
        Expr::ZERO => Some(Expr::ONE),
        exponent => powers_of_logarithms(pool, exponent),
    },
    derivative: |pool, u, _| pool.call(FunctionId::Exp, u),
    rule: Rule::Series(RECURRENCE),
};
