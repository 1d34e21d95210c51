//! The exponential.

use super::recurrence::{BilinearEquation, Convolution, FIRST, Recurrence, VALUE};
use super::{Function, FunctionId, Rule};
use crate::expr::{Expr, Node, Pool, is_never_negative};
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

/// `exp(c ln u + v) → u^c exp(v)` where both have a value for the same u, but for the limit at u = 0.
fn powers_of_logarithms(pool: &mut Pool, exponent: Expr) -> Option<Expr> {
    let (mut powers, mut others) = (Vec::new(), Vec::new());
    for (c, term) in pool.summands(exponent) {
        let (c, term) = match pool.node(term) {
            Node::Product(k, factors) if matches!(**factors, [(_, n)] if n.is_one()) => {
                (c * *k, factors[0].0)
            }
            _ => (c, term),
        };
        match pool.node(term) {
            Node::Call(FunctionId::Ln, u) if is_same_power(pool, u[0], c) => powers.push((u[0], c)),
            _ => others.push((c, term)),
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
