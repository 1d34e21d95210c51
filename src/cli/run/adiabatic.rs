//! The action variable of a run with a ramp: ∮ p dq at the start and at the end, each with the parameters of its time.
//!
//! In: a model of one coordinate whose parameters are functions of the time. Out: an invariant of the report with the verdict
//! *adiabatic*, or *not conserved*. Never here: the motion between.
//! Source: *The Principles of Dynamics*, § 4.3.

use crate::action_angle::{ActionRow, FrozenSystem, is_adiabatic};
use crate::cancel::Cancel;
use crate::cli::report::Invariant;
use crate::integrate::Settings;
use crate::model::Model;
use crate::system::{Form, State, System};

/// What is needed to know the action at any time of the run.
pub(super) struct Adiabatic {
    frozen: FrozenSystem,
    model: Model,
    parameters: Vec<f64>,
}

impl Adiabatic {
    /// The action variable of a model with ramps; `None` where there is none.
    pub(super) fn of(model: &Model, parameters: &[f64], cancel: &Cancel) -> Option<Adiabatic> {
        if model.ramped.is_empty() || model.coordinates.len() != 1 {
            return None;
        }
        let settings = Settings { step: None, tolerance: None };
        let frozen = FrozenSystem::of(model, 0, settings, cancel).ok()?;
        Some(Adiabatic { frozen, model: model.clone(), parameters: parameters.to_vec() })
    }

    /// The action of a state; `None` if its motion does not return at these parameters.
    fn action(&self, system: &System, state: &State) -> Option<ActionRow> {
        let state = system.convert(state, Form::Momentum, &self.parameters).ok()?;
        let halves = [&state.values[..1], &state.values[1..2]];
        let own = self.frozen.at(state.time, &self.parameters, halves).ok()?.own().ok()?;
        own.row.ok().filter(|row| row.action.is_finite() && row.action != 0.0)
    }

    /// How much the parameters that change have changed, each relative to what it was: the largest.
    fn driven(&self, [first, last]: [f64; 2]) -> f64 {
        let Model { pool, parameters, symbols, .. } = &self.model;
        let at = |e, time: f64| {
            let given = parameters.iter().zip(&self.parameters);
            let value = |s| {
                if s == symbols.time {
                    time
                } else {
                    given.clone().find(|(p, _)| p.symbol == s).map_or(f64::NAN, |(_, &x)| x)
                }
            };
            pool.evaluate(e, &value)
        };
        let change = |(_, e)| {
            let (from, to) = (at(e, first), at(e, last));
            (to - from).abs() / from.abs().max(f64::MIN_POSITIVE)
        };
        self.model.ramped.functions().map(change).fold(0.0, f64::max)
    }

    pub(super) fn invariant(
        &self,
        system: &System,
        first: &State,
        last: &State,
    ) -> Option<Invariant> {
        let (before, after) = (self.action(system, first)?, self.action(system, last)?);
        let driven = self.driven([first.time, last.time]);
        let change = (after.action - before.action).abs() / before.action.abs();
        let verdict = match (driven > 0.0, is_adiabatic(change, driven)) {
            (false, _) => "open",
            (true, true) => "adiabatic",
            (true, false) => "not conserved",
        };
        Some(Invariant {
            name: "action variable".to_owned(),
            reason: "adiabatic: ∮ p dq at the start and at the end".to_owned(),
            initial: before.action,
            last: after.action,
            max_drift: change,
            verdict,
        })
    }
}
