//! The smaller of two.

use super::{Function, FunctionId, KinkBranches, Rule};
use crate::num::Number;

pub(super) const FUNCTION: Function = Function {
    id: FunctionId::Min,
    name: "min",
    unicode: "min",
    latex: "\\min",
    arity: 2,
    value: |u| u[0].min(u[1]),
    fold: |pool, u| match (pool.as_number(u[0]), pool.as_number(u[1])) {
        (Some(a), Some(b)) => Some(pool.number(a.min(b))),
        _ => (u[0] == u[1]).then_some(u[0]),
    },
    // the chosen branch has slope 1, the other 0: ½(1 ± sign(a − b))
    derivative: |pool, u, i| {
        let difference = pool.sub(u[0], u[1]);
        let side = pool.call(FunctionId::Sign, &[difference]);
        let half = if i == 1 { Number::HALF } else { -Number::HALF };
        pool.linear(Number::HALF, &[(half, side)])
    },
    rule: Rule::Branch(|pool, u| KinkBranches {
        switch: pool.sub(u[0], u[1]),
        positive: u[1],
        negative: u[0],
    }),
};
