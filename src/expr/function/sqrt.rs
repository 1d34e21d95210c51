//! The square root: another way of writing the power ½.

use super::{Function, FunctionId, Rule};
use crate::num::Number;

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Sqrt,
    name: "sqrt",
    unicode: "√",
    latex: "\\sqrt",
    arity: 1,
    value: |u| u[0].sqrt(),
    fold: |pool, u| Some(pool.sqrt(u[0])),
    derivative: |pool, u, _| pool.monomial(Number::HALF, &[(u[0], -Number::HALF)]),
    rule: Rule::Power,
};
