//! The sign: 1, −1, and 0 at zero.

use super::{Function, FunctionId, KinkBranches, Rule};
use crate::expr::{Expr, Node, Pool};
use crate::num::Number;

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
        _ => pool.fold_odd(FunctionId::Sign, u[0]).or_else(|| of_power(pool, u[0])),
    },
    derivative: |_, _, _| Expr::ZERO,
    rule: Rule::Branch(|pool, u| KinkBranches {
        switch: u[0],
        positive: Expr::ONE,
        negative: pool.integer(-1),
    }),
};
