//! Several orbits of one system carried side by side.
//!
//! In: a system and a method of which that is possible, a state, parameters and a limit for each
//! lane. Out: steps, states, dense output: those that a [`Propagator`](super::Propagator) of each
//! orbit alone takes and has, to the last bit, or the word that an orbit must be followed alone.
//! Never here: which orbits, what is seen of them.

use super::lane_status::LaneStatus;
use super::method::{Method, Settings};
use super::taylor::TaylorBatch;
use crate::num::BATCH;
use crate::system::{Form, MotionError, State, System};

/// Orbits side by side.
pub struct BatchPropagator {
    system: System,
    stepper: TaylorBatch,
}

impl BatchPropagator {
    /// Room for [`BATCH`] orbits; `None` where they have to be followed one by one.
    pub fn new(
        system: &System,
        method: &'static Method,
        settings: Settings,
    ) -> Option<BatchPropagator> {
        let stepper = TaylorBatch::new(system, method, &settings)?;
        Some(BatchPropagator { system: system.clone(), stepper })
    }

    /// Puts an orbit into a lane, at its beginning.
    pub fn begin(&mut self, lane: usize, state: &State, parameters: &[f64]) -> LaneStatus {
        let regular = self.can_begin(state, parameters).is_ok();
        if regular { self.stepper.start(lane, state, parameters) } else { LaneStatus::Irregular }
    }

    /// The same checks that an orbit alone has to pass.
    fn can_begin(&self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        let state = self.system.convert(state, self.system.form(), parameters)?;
        self.system.check_energy(&state, parameters)
    }

    /// The form of the states.
    pub fn form(&self) -> Form {
        self.system.form()
    }

    /// Empties a lane.
    pub fn clear(&mut self, lane: usize) {
        self.stepper.clear(lane);
    }

    /// How a lane stands.
    pub fn status(&self, lane: usize) -> LaneStatus {
        self.stepper.status(lane)
    }

    /// Takes a step in every lane that is under way, none beyond its limit. Returns false if it was
    /// cancelled.
    #[must_use]
    pub fn step(&mut self, limits: &[f64; BATCH]) -> bool {
        self.stepper.step(limits)
    }

    /// The state at the end of the last step of a lane.
    pub fn state(&self, lane: usize) -> &State {
        self.stepper.state(lane)
    }

    /// Writes the state of a lane at a time within its last step into `out`.
    pub fn at(&mut self, lane: usize, time: f64, out: &mut State) {
        self.stepper.at(lane, time, out);
    }
}
