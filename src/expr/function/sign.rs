//! The sign: 1, −1, and 0 at zero.

use super::{Function, FunctionId, KinkBranches, Rule};
use crate::expr::{Expr, Node};

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
        _ => pool.fold_odd(FunctionId::Sign, u[0]),
    },
    derivative: |_, _, _| Expr::ZERO,
    rule: Rule::Branch(|pool, u| KinkBranches {
        switch: u[0],
        positive: Expr::ONE,
        negative: pool.integer(-1),
    }),
};
