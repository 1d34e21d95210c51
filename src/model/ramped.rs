//! Parameters as functions of the time, as expressions.
//!
//! In: a parameter, the parts of its way. Out: the function that stands for it wherever it is used. Never here: models, what
//! follows from a law that depends on the time.

use std::collections::HashMap;

use crate::expr::{Expr, FunctionId, Pool, Symbol};
use crate::num::Number;

/// A part of a parameter's way, as a file gives it: its numbers may be expressions in other parameters.
#[derive(Clone, Copy, Debug)]
pub struct RampPart {
    /// The value that it leads to.
    pub to: Expr,
    /// When it begins.
    pub start: Expr,
    /// How long it takes, above zero.
    pub duration: Expr,
    /// How it goes.
    pub form: RampForm,
}

/// How smoothly a ramp begins and ends, with u from 0 to 1 on the way.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum RampForm {
    /// 10u³ − 15u⁴ + 6u⁵: the third derivative jumps at both ends.
    #[default]
    Smooth,
    /// 3u² − 2u³: the second derivative jumps.
    Cubic,
    /// u: the first derivative jumps.
    Linear,
}

impl RampForm {
    /// All forms with their names in files.
    pub const NAMED: [(&str, RampForm); 3] =
        [("smooth", RampForm::Smooth), ("cubic", RampForm::Cubic), ("linear", RampForm::Linear)];
}

/// Parameters as functions of the time.
#[derive(Clone, Debug, Default)]
pub struct Ramped(HashMap<Symbol, Expr>);

impl Ramped {
    /// Lets a parameter go its way, one part after the other, from its own value, which stays what it is before the first.
    pub fn lead(&mut self, pool: &mut Pool, time: Symbol, parameter: Symbol, parts: &[RampPart]) {
        let own = pool.variable(parameter);
        let time = pool.variable(time);
        let (mut value, mut last) = (own, own);
        for part in parts {
            let passed = pool.sub(time, part.start);
            let passed = pool.div(passed, part.duration);
            let passed = pool.call(FunctionId::Max, &[passed, Expr::ZERO]);
            let one = pool.number(Number::ONE);
            let u = pool.call(FunctionId::Min, &[passed, one]);
            let powers: &[(i64, i64)] = match part.form {
                RampForm::Smooth => &[(10, 3), (-15, 4), (6, 5)],
                RampForm::Cubic => &[(3, 2), (-2, 3)],
                RampForm::Linear => &[(1, 1)],
            };
            let mut share = Vec::new();
            for &(coefficient, power) in powers {
                let power = pool.monomial(Number::ONE, &[(u, Number::integer(power))]);
                share.push((Number::integer(coefficient), power));
            }
            let share = pool.linear(Number::ZERO, &share);
            let change = pool.sub(part.to, last);
            let change = pool.mul(change, share);
            value = pool.linear(Number::ZERO, &[(Number::ONE, value), (Number::ONE, change)]);
            last = part.to;
        }
        self.0.insert(parameter, value);
    }

    /// Lets a parameter be a function of the time.
    pub(super) fn insert(&mut self, parameter: Symbol, value: Expr) {
        self.0.insert(parameter, value);
    }

    /// Whether no parameter changes with the time.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Each parameter with its function of the time.
    pub fn functions(&self) -> impl Iterator<Item = (Symbol, Expr)> {
        self.0.iter().map(|(&symbol, &e)| (symbol, e))
    }

    /// Whether an expression has a parameter that changes with the time.
    pub fn acts_on(&self, pool: &Pool, e: Expr) -> bool {
        self.0.keys().any(|&symbol| pool.depends(e, symbol))
    }

    /// An expression with these functions in place of the parameters.
    pub fn replace(&self, pool: &mut Pool, e: Expr) -> Expr {
        if self.0.is_empty() { e } else { pool.substitute(e, &self.0) }
    }
}
