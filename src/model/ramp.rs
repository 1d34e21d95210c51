//! A parameter that changes with the time: it is replaced by a function of t before anything is derived, so that L or H
//! depends on the time and every term that follows from that is there.
//!
//! In: a model, a ramp. Out: the model with the parameter replaced in its law, constraints, impulses, events and
//! observables. Initial values keep the number that the parameter has at the start. Never here: motions.

use super::ramped::{RampForm, Ramped};
use super::{Allowed, Model, Scope};
use crate::expr::Expr;

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
    /// How it goes.
    pub form: RampForm,
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
        let share = |u: f64| match self.form {
            RampForm::Linear => u,
            RampForm::Cubic => u * u * (3.0 - 2.0 * u),
            RampForm::Smooth => u * u * u * (10.0 - u * (15.0 - 6.0 * u)),
        };
        let [from, to] = self.values;
        from * share(1.0 - u) + to * share(u)
    }

    /// The parts of its time that are behind and left, from 0 to 1, as functions of t in the syntax of files.
    fn parts(&self) -> [String; 2] {
        let passed = format!("(t - ({:?}))/({:?})", self.start, self.duration);
        [passed.clone(), format!("1 - {passed}")].map(|part| format!("min(max({part}, 0), 1)"))
    }

    /// The value as a function of t, in the syntax of files; see [`Ramped::lead`].
    fn written(&self) -> String {
        let [from, to] = self.values;
        let [passed, left] = self.parts().map(|u| match self.form {
            RampForm::Linear => u,
            RampForm::Cubic => format!("(3*{u}^2 - 2*{u}^3)"),
            RampForm::Smooth => format!("(10*{u}^3 - 15*{u}^4 + 6*{u}^5)"),
        });
        format!("({from:?})*{left} + ({to:?})*{passed}")
    }
}

/// Replaces parameters by functions of the time. Returns the replacements, which are those of every expression that is
/// read later, and belong to the model's pool.
///
/// # Errors
/// Returns an error if a parameter determines something that cannot change with the time.
pub fn replace_by_ramps(model: &mut Model, ramps: &[Ramp]) -> Result<Ramped, RampRefused> {
    let mut ramped = Ramped::default();
    model.with_ramps_named = None;
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
        let mut scope = Scope::new(model, Allowed::Event, "a ramp");
        let mut read = |text: &str| scope.read(&mut pool, text).ok_or(RampRefused::TooLarge);
        let value = read(&ramp.written())?;
        let [passed, left] = ramp.parts();
        let parts = [read(&passed)?, read(&left)?];
        model.pool = pool;
        ramped.insert(symbol, value);
        for part in parts {
            model.ramped.proceed(part, ramp.form == RampForm::Smooth);
        }
    }
    let Model { pool, mechanics, constraints, impulses, events, observables, definitions, .. } =
        model;
    let mut all: Vec<&mut Expr> = mechanics.expressions_mut();
    all.extend(constraints.iter_mut().map(|constraint| &mut constraint.expression));
    all.extend(impulses.iter_mut().flat_map(|impulse| &mut impulse.change));
    all.extend(events.iter_mut().map(|event| &mut event.when));
    all.extend(observables.iter_mut().map(|observable| &mut observable.expression));
    all.extend(definitions.iter_mut().map(|definition| &mut definition.1));
    for e in all {
        *e = ramped.replace(pool, *e);
    }
    ramped.functions().for_each(|(symbol, e)| model.ramped.insert(symbol, e));
    Ok(ramped)
}
