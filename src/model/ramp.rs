//! A parameter that changes with the time: it is replaced by a function of t before anything is derived, so that L or H
//! depends on the time and every term that follows from that is there.
//!
//! In: a model, a ramp. Out: the model with the parameter replaced in its law, constraints, impulses, events and
//! observables. Initial values keep the number that the parameter has at the start. Never here: motions.

use std::collections::HashMap;

use super::{Allowed, Mechanics, Model, Scope};
use crate::expr::{Expr, FunctionId, Pool, Symbol};
use crate::num::Number;

/// A parameter's way from one value to another.
#[derive(Clone, PartialEq, Debug)]
pub struct Ramp {
    /// The parameter's place in the model.
    pub parameter: usize,
    /// Its value before, and after.
    pub values: [f64; 2],
    /// When it begins to change.
    pub start: f64,
    /// How long it changes, above zero.
    pub duration: f64,
    /// Whether it changes evenly, with corners, in place of 10u³ − 15u⁴ + 6u⁵.
    pub linear: bool,
}

/// Why a parameter cannot change with the time.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum RampRefused {
    /// It determines the times of an impulse.
    #[error("`{0}` determines when `{1}` acts, which cannot change with the time")]
    Schedule(String, String),
    /// The system is put together from pieces.
    #[error("`{0}` cannot change with the time in a system with a [body]")]
    Body(String),
    /// It makes the constraint depend on more than it may.
    #[error("the system grows beyond a million nodes")]
    TooLarge,
}

impl Ramp {
    /// The value at a time.
    pub fn at(&self, time: f64) -> f64 {
        let u = ((time - self.start) / self.duration).clamp(0.0, 1.0);
        let part = if self.linear { u } else { u * u * u * (10.0 - u * (15.0 - 6.0 * u)) };
        let [from, to] = self.values;
        if u == 1.0 { to } else { from + (to - from) * part }
    }

    /// The value as a function of t, in the syntax of files.
    fn written(&self) -> String {
        let [from, to] = self.values;
        let u = format!("min(max((t - ({:?}))/({:?}), 0), 1)", self.start, self.duration);
        let part = if self.linear { u } else { format!("(10*{u}^3 - 15*{u}^4 + 6*{u}^5)") };
        format!("({from:?}) + (({to:?}) - ({from:?}))*{part}")
    }
}

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

/// Replaces parameters by functions of the time. Returns the replacements, which are those of every expression that is
/// read later, and belong to the model's pool.
///
/// # Errors
/// Returns an error if a parameter determines something that cannot change with the time.
pub fn replace_by_ramps(model: &mut Model, ramps: &[Ramp]) -> Result<Ramped, RampRefused> {
    let mut ramped = Ramped::default();
    for ramp in ramps {
        let parameter = &model.parameters[ramp.parameter];
        let (name, symbol) = (parameter.name.clone(), parameter.symbol);
        if model.body.is_some() {
            return Err(RampRefused::Body(name));
        }
        for impulse in &model.impulses {
            if impulse.times.iter().chain(&impulse.period).any(|&e| model.pool.depends(e, symbol)) {
                return Err(RampRefused::Schedule(name, impulse.name.clone()));
            }
        }
        let mut pool = model.pool.clone();
        let read = Scope::new(model, Allowed::Event, "a ramp").read(&mut pool, &ramp.written());
        model.pool = pool;
        ramped.0.insert(symbol, read.ok_or(RampRefused::TooLarge)?);
    }
    let Model { pool, mechanics, constraints, impulses, events, observables, definitions, .. } =
        model;
    let mut all: Vec<&mut Expr> = Vec::new();
    match mechanics {
        Mechanics::Lagrangian { lagrangian, dissipation, forces } => {
            all.extend([lagrangian, dissipation]);
            all.extend(forces);
        }
        Mechanics::Hamiltonian { hamiltonian, forces } => {
            all.push(hamiltonian);
            all.extend(forces);
        }
        Mechanics::Poisson { hamiltonian, brackets, casimirs, forces, .. } => {
            all.push(hamiltonian);
            all.extend(brackets.iter_mut().flatten());
            all.extend(casimirs.iter_mut().map(|casimir| &mut casimir.1));
            all.extend(forces);
        }
    }
    all.extend(constraints.iter_mut().map(|constraint| &mut constraint.expression));
    all.extend(impulses.iter_mut().flat_map(|impulse| &mut impulse.change));
    all.extend(events.iter_mut().map(|event| &mut event.when));
    all.extend(observables.iter_mut().map(|observable| &mut observable.expression));
    all.extend(definitions.iter_mut().map(|definition| &mut definition.1));
    for e in all {
        *e = ramped.replace(pool, *e);
    }
    model.ramped.0.extend(ramped.0.iter().map(|(&symbol, &e)| (symbol, e)));
    Ok(ramped)
}
