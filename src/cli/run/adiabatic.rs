//! The action variable of a run with a ramp: ∮ p dq at the start and at the end, each with the parameters of its time.
//!
//! In: a model of one coordinate before its parameters became functions of the time, the ramps. Out: an invariant of the
//! report with the verdict *adiabatic*, or *broken by the physics*. Never here: the motion between.
//! Source: *The Principles of Dynamics*, § 4.3.

use crate::cli::interrupt::Interrupt;
use crate::cli::report::Invariant;
use crate::diagnostic::Document;
use crate::ensemble::Start;
use crate::model::{Model, Ramp};
use crate::orbits::ActionRow;
use crate::system::{Form, InitialOverride, State, System};

/// The action is an adiabatic invariant if it changes by less than this part of the change of the parameter.
const FAR_LESS: f64 = 0.1;

/// The action variable at a start, as `actions` finds it.
pub(crate) type ActionOf = fn(&Document, Model, Start, &Interrupt) -> Option<ActionRow>;

/// What is needed to know the action at any time of the run.
pub(super) struct Adiabatic<'i> {
    document: Document,
    model: Model,
    ramps: Vec<Ramp>,
    parameters: Vec<f64>,
    interrupt: &'i Interrupt,
    action: ActionOf,
}

impl<'i> Adiabatic<'i> {
    /// The action variable of a model with ramps; `None` where there is none.
    pub(super) fn of(
        document: &Document,
        model: &Model,
        ramps: &[Ramp],
        parameters: &[f64],
        (action, interrupt): (ActionOf, &'i Interrupt),
    ) -> Option<Adiabatic<'i>> {
        let suited = !ramps.is_empty()
            && model.coordinates.len() == 1
            && !model.is_poisson()
            && model.constraints.is_empty();
        suited.then(|| {
            let mut model = model.clone();
            // the frozen system is followed by itself
            model.impulses.clear();
            model.events.clear();
            model.observables.clear();
            model.space.clear();
            model.expect = crate::model::Expect::default();
            let (ramps, parameters) = (ramps.to_vec(), parameters.to_vec());
            Adiabatic { document: document.clone(), model, ramps, parameters, interrupt, action }
        })
    }

    /// The parameters at a time.
    fn parameters(&self, time: f64) -> Vec<f64> {
        let mut values = self.parameters.clone();
        for ramp in &self.ramps {
            values[ramp.parameter] = ramp.at(time);
        }
        values
    }

    /// The action of a state; `None` if its motion does not return at these parameters.
    fn action(&self, system: &System, state: &State) -> Option<ActionRow> {
        let parameters = self.parameters(state.time);
        let state = system.convert(state, Form::Momentum, &parameters).ok()?;
        let overrides = vec![
            InitialOverride::Position(0, state.values[0]),
            InitialOverride::Momentum(0, state.values[1]),
        ];
        let mut model = self.model.clone();
        model.parameters.iter_mut().zip(&parameters).for_each(|(p, &value)| p.value = value);
        let start = Start { time: 0.0, parameters, overrides };
        let row = (self.action)(&self.document, model, start, self.interrupt)?;
        (row.action.is_finite() && row.action > 0.0).then_some(row)
    }

    /// The invariant from the first to the last state of a run.
    pub(super) fn invariant(
        &self,
        system: &System,
        first: &State,
        last: &State,
    ) -> Option<Invariant> {
        let (before, after) = (self.action(system, first)?, self.action(system, last)?);
        let driven = self
            .ramps
            .iter()
            .map(|ramp| {
                let (from, to) = (ramp.at(first.time), ramp.at(last.time));
                (to - from).abs() / from.abs().max(f64::MIN_POSITIVE)
            })
            .fold(0.0, f64::max);
        let change = (after.action - before.action).abs() / before.action;
        let verdict = match (driven > 0.0, change <= FAR_LESS * driven) {
            (false, _) => "open",
            (true, true) => "adiabatic",
            (true, false) => "broken by the physics",
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
