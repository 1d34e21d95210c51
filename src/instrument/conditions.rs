//! What the result of a job depends on: when it changes, the job is begun anew.
//!
//! In: the current state, what was added. Out: [`PlotConditions`], to be compared. Never here: what is computed.

use super::{Present, Seed};
use crate::integrate::Settings;
use crate::system::{InitialOverride, MotionError, State, System};

/// The values of the system, the method, and what a person added to the plot.
#[derive(Clone, PartialEq)]
pub(super) struct PlotConditions {
    pub(super) parameters: Vec<f64>,
    initial: Vec<f64>,
    method: &'static str,
    pub(super) settings: Settings,
    pub(super) seeds: Vec<Seed>,
}

impl PlotConditions {
    pub(super) fn of(present: &Present<'_>, seeds: &[Seed]) -> Self {
        Self {
            parameters: present.parameters.to_vec(),
            initial: present.initial.to_vec(),
            method: present.method,
            settings: present.settings,
            seeds: seeds.to_vec(),
        }
    }

    /// The state of the initial values.
    pub(super) fn state(&self, system: &System, time: f64) -> Result<State, MotionError> {
        let given = self.initial.iter().enumerate();
        let given: Vec<InitialOverride> =
            given.map(|(i, &x)| system.initial_override(i, x)).collect();
        system.initial(time, &self.parameters, &given)
    }
}
