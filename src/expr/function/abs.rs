//! The absolute value.

use super::{Function, FunctionId, KinkBranches, Rule};
use crate::expr::Node;
use crate::num::Number;

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Abs,
    name: "abs",
    unicode: "abs",
    latex: "\\operatorname{abs}",
    arity: 1,
    value: |u| u[0].abs(),
    fold: |pool, u| match *pool.node(u[0]) {
        Node::Number(n) => Some(pool.number(n.abs())),
        Node::Pi | Node::Call(FunctionId::Abs, _) => Some(u[0]),
        _ => pool.fold_even(FunctionId::Abs, u[0]),
    },
    derivative: |pool, u, _| pool.call(FunctionId::Sign, u),
    rule: Rule::Branch(|pool, u| KinkBranches {
        switch: u[0],
        positive: u[0],
        negative: pool.scale(Number::MINUS_ONE, u[0]),
    }),
};
