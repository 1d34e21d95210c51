//! Several orbits of one system carried side by side.
//!
//! In: a system and a method of which that is possible, a state, parameters and a limit for each
//! lane. Out: steps, states, dense output: those that a [`Propagator`](super::Propagator) of each
//! orbit alone takes and has, to the last bit, or the word that an orbit must be followed alone.
//! Never here: which orbits, what is seen of them.

use super::lane_status::LaneStatus;
use super::method::{Method, Settings};
use super::splitting_batch::SplittingBatch;
use super::taylor::TaylorBatch;
use crate::num::BATCH;
use crate::system::{Form, MotionError, State, System};

/// Orbits side by side.
pub struct BatchPropagator {
    system: System,
    stepper: BatchStepper,
}

/// The orbits, by a method.
enum BatchStepper {
    Taylor(Box<TaylorBatch>),
    Splitting(Box<SplittingBatch>),
}

/// Calls the same function of either.
macro_rules! of_stepper {
    ($own:expr, $stepper:ident => $call:expr) => {
        match $own {
            BatchStepper::Taylor($stepper) => $call,
            BatchStepper::Splitting($stepper) => $call,
        }
    };
}

impl BatchPropagator {
    /// Room for [`BATCH`] orbits; `None` where they have to be followed one by one.
    pub fn new(
        system: &System,
        method: &'static Method,
        settings: Settings,
    ) -> Option<BatchPropagator> {
        let series = TaylorBatch::new(system, method, &settings);
        let stepper = match series {
            Some(series) => BatchStepper::Taylor(Box::new(series)),
            None => {
                let splitting = SplittingBatch::new(system, method, &settings)?;
                BatchStepper::Splitting(Box::new(splitting))
            }
        };
        Some(BatchPropagator { system: system.clone(), stepper })
    }

    /// Puts an orbit into a lane, at its beginning.
    pub fn begin(&mut self, lane: usize, state: &State, parameters: &[f64]) -> LaneStatus {
        let regular = self.can_begin(state, parameters).is_ok();
        if !regular {
            return LaneStatus::Irregular;
        }
        of_stepper!(&mut self.stepper, stepper => stepper.start(lane, state, parameters))
    }

    /// The same checks that an orbit alone has to pass.
    fn can_begin(&self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        let state = self.system.convert(state, self.system.form(), parameters)?;
        self.system.check_energy(&state, parameters)
    }

    /// The form of the states.
    pub fn form(&self) -> Form {
        match self.stepper {
            BatchStepper::Taylor(_) => self.system.form(),
            BatchStepper::Splitting(_) => Form::Momentum,
        }
    }

    /// Empties a lane.
    pub fn clear(&mut self, lane: usize) {
        of_stepper!(&mut self.stepper, stepper => stepper.clear(lane));
    }

    /// How a lane stands.
    pub fn status(&self, lane: usize) -> LaneStatus {
        of_stepper!(&self.stepper, stepper => stepper.status(lane))
    }

    /// Takes a step in every lane that is under way and before its limit. A method of variable step
    /// does not go beyond the limit. Returns false if it was cancelled.
    #[must_use]
    pub fn step(&mut self, limits: &[f64; BATCH]) -> bool {
        self.steps_unseen(limits, &[f64::NEG_INFINITY; BATCH])
    }

    /// The same for as many steps as nobody looks between: at least one, and none more where one has
    /// led to or beyond the time of a lane in `looks`. A method may take them one by one.
    #[must_use]
    pub fn steps_unseen(&mut self, limits: &[f64; BATCH], looks: &[f64; BATCH]) -> bool {
        match &mut self.stepper {
            BatchStepper::Taylor(series) => series.step(limits),
            BatchStepper::Splitting(splitting) => splitting.step(limits, looks),
        }
    }

    /// The state at the end of the last step of a lane.
    pub fn state(&self, lane: usize) -> &State {
        of_stepper!(&self.stepper, stepper => stepper.state(lane))
    }

    /// Writes the state of a lane at a time within its last step into `out`.
    pub fn at(&mut self, lane: usize, time: f64, out: &mut State) {
        of_stepper!(&mut self.stepper, stepper => stepper.at(lane, time, out));
    }
}
