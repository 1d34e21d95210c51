//! Where an orbit begins.
//!
//! In and out: numbers by their places in the model. Never here: their names, see `cli`.

use crate::system::{InitialOverride, MotionError, State, System};

/// The parameters and initial values of one orbit.
#[derive(Clone, PartialEq, Debug)]
pub struct Start {
    /// The time of the initial values.
    pub time: f64,
    /// The parameters, in the model's order.
    pub parameters: Vec<f64>,
    /// The initial values that replace the file's.
    pub overrides: Vec<InitialOverride>,
}

impl Start {
    /// The initial state.
    ///
    /// # Errors
    /// Returns an error if these values determine no state.
    pub fn state(&self, system: &System) -> Result<State, MotionError> {
        system.initial(self.time, &self.parameters, &self.overrides)
    }

    /// Replaces the initial value of one coordinate, or of its velocity or momentum, each of which follows from the
    /// other.
    pub fn replace(&mut self, given: InitialOverride) {
        let same = |old: &InitialOverride| match (*old, given) {
            (InitialOverride::Position(i, _), InitialOverride::Position(j, _)) => i == j,
            (InitialOverride::Position(..), _) | (_, InitialOverride::Position(..)) => false,
            (
                InitialOverride::Velocity(i, _) | InitialOverride::Momentum(i, _),
                InitialOverride::Velocity(j, _) | InitialOverride::Momentum(j, _),
            ) => i == j,
        };
        self.overrides.retain(|old| !same(old));
        self.overrides.push(given);
    }
}
