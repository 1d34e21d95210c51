//! What the result of a job depends on: when it changes, the job begins again.
//!
//! In: the current state, what was added. Out: [`PlotConditions`], to be compared. Never here: what is computed.

use std::sync::Arc;

use super::{Present, Seed};
use crate::integrate::{Method, Settings, method_named};
use crate::num::significant;
use crate::system::{InitialOverride, MotionError, State, System};

/// The values of the system, the method, and what a person added to the plot.
#[derive(Clone, PartialEq)]
pub(super) struct PlotConditions {
    pub(super) parameters: Vec<f64>,
    initial: Vec<f64>,
    method: &'static str,
    pub(super) settings: Settings,
    pub(super) seeds: Vec<Seed>,
    /// What of the law was changed last on the way, and the state there, if the motion is followed from there.
    changed: Option<(String, Arc<State>)>,
}

impl PlotConditions {
    pub(super) fn of(present: &Present<'_>, seeds: &[Seed]) -> Self {
        Self {
            parameters: present.parameters.to_vec(),
            initial: present.initial.to_vec(),
            method: present.method,
            settings: present.settings,
            seeds: seeds.to_vec(),
            changed: None,
        }
    }

    /// The same for a picture of the motion as it was recorded: under the law of now it is so from where that was changed last.
    pub(super) fn of_recorded(present: &Present<'_>, seeds: &[Seed]) -> Self {
        let changed = present.changed.map(|(what, state)| (what.to_owned(), Arc::clone(state)));
        Self { changed, ..Self::of(present, seeds) }
    }

    /// Whether parameters and initial values are the same.
    pub(super) fn begin_alike(&self, other: &Self) -> bool {
        self.parameters == other.parameters && self.initial == other.initial
    }

    pub(super) fn method(&self) -> Option<(&'static Method, Settings)> {
        Some((method_named(self.method)?, self.settings))
    }

    /// Whether they differ in nothing but the method and its settings.
    pub(super) fn differ_in_method_alone(&self, other: &Self) -> bool {
        let method = (other.method, other.settings);
        let alike = Self { method: method.0, settings: method.1, ..self.clone() };
        self != other && alike == *other
    }

    /// Whether they differ in parameters, and in nothing that does not follow from these.
    pub(super) fn differ_in_parameters_alone(&self, other: &Self) -> bool {
        let alike = Self {
            parameters: other.parameters.clone(),
            initial: other.initial.clone(),
            ..self.clone()
        };
        self.parameters != other.parameters && alike == *other
    }

    /// Whether the law was changed last at the same state, or never.
    pub(super) fn are_of_one_motion(&self, other: &Self) -> bool {
        self.changed == other.changed
    }

    /// When the motion begins that is followed: `start`, or where the law was changed last.
    pub(super) fn begin(&self, start: f64) -> f64 {
        self.changed.as_ref().map_or(start, |(_, state)| state.time)
    }

    /// Why it does not begin at the start, if it does not.
    pub(super) fn since(&self) -> Option<String> {
        let (what, state) = self.changed.as_ref()?;
        let time = significant(state.time, 4, 1e-3..1e5).replace('-', "−");
        Some(format!("since t = {time}, where {what} was changed"))
    }

    /// The state of the initial values at the start, or that where the law was changed last.
    pub(super) fn state(&self, system: &System, time: f64) -> Result<State, MotionError> {
        if let Some((_, state)) = &self.changed {
            return Ok(State::clone(state));
        }
        let given = self.initial.iter().enumerate();
        let given: Vec<InitialOverride> =
            given.map(|(i, &x)| system.initial_override(i, x)).collect();
        system.initial(time, &self.parameters, &given)
    }
}
