//! Several orbits of one system carried side by side.
//!
//! In: a system and a method of which that is possible, a state, parameters and a limit for each
//! lane. Out: steps, states, dense output: those that a [`Propagator`](super::Propagator) of each
//! orbit alone takes and has, to the last bit, or the word that an orbit must be followed alone.
//! Never here: which orbits, what is seen of them.

use super::batch_events::{BatchEvents, LaneEvent};
use super::equal_steps_batch::EqualStepsBatch;
use super::lane_status::LaneStatus;
use super::method::{Method, Settings};
use super::rk4::RungeKutta;
use super::rk4_batch::RungeKuttaBatch;
use super::splitting::Splitting;
use super::taylor::TaylorBatch;
use super::{rk4, symplectic_euler};
use crate::num::BATCH;
use crate::system::{BatchSplitStep, BatchStates, Composition, Form, MotionError, State, System};

/// Orbits side by side.
pub struct BatchPropagator {
    system: System,
    stepper: BatchStepper,
    /// The search for events, if they are searched for.
    events: Option<Box<BatchEvents>>,
}

enum BatchStepper {
    Taylor(Box<TaylorBatch>),
    Splitting(Box<EqualStepsBatch<BatchSplitStep, Splitting>>),
    RungeKutta(Box<EqualStepsBatch<RungeKuttaBatch, RungeKutta>>),
}

/// Calls the same function of each.
macro_rules! of_stepper {
    ($own:expr, $stepper:ident => $call:expr) => {
        match $own {
            BatchStepper::Taylor($stepper) => $call,
            BatchStepper::Splitting($stepper) => $call,
            BatchStepper::RungeKutta($stepper) => $call,
        }
    };
}

impl BatchStepper {
    fn new(system: &System, method: &Method, settings: &Settings) -> Option<BatchStepper> {
        if method.name == rk4::METHOD.name {
            let steps = (RungeKuttaBatch::new(system)?, RungeKutta::new(system));
            let orbits = EqualStepsBatch::new(system, settings, steps)?;
            return Some(BatchStepper::RungeKutta(Box::new(orbits)));
        }
        let leapfrogs = (method.leapfrogs)();
        let composition = if method.name == symplectic_euler::METHOD.name {
            Composition::KickDrift
        } else if leapfrogs.is_empty() {
            let series = TaylorBatch::new(system, method, settings)?;
            return Some(BatchStepper::Taylor(Box::new(series)));
        } else {
            Composition::Leapfrogs(leapfrogs)
        };
        let many = system.batch_split_step(&composition)?;
        let steps = (many, Splitting::new(system, &composition)?);
        let orbits = EqualStepsBatch::new(system, settings, steps)?;
        Some(BatchStepper::Splitting(Box::new(orbits)))
    }
}

impl BatchPropagator {
    /// Room for [`BATCH`] orbits; `None` where they have to be followed one by one.
    pub fn new(
        system: &System,
        method: &'static Method,
        settings: Settings,
    ) -> Option<BatchPropagator> {
        let stepper = BatchStepper::new(system, method, &settings)?;
        Some(BatchPropagator { system: system.clone(), stepper, events: None })
    }

    /// Room for [`BATCH`] orbits with the events of the system, which must all be without effect on the motion, by a
    /// method whose steps are power series; otherwise `None`.
    pub fn with_events(
        system: &System,
        method: &'static Method,
        settings: Settings,
    ) -> Option<BatchPropagator> {
        let mut batch = BatchPropagator::new(&system.without_marks(), method, settings)?;
        let BatchStepper::Taylor(series) = &batch.stepper else { return None };
        let tolerance = settings.tolerance.unwrap_or(0.0);
        batch.events = Some(Box::new(BatchEvents::new(system, series.series().order(), tolerance)));
        Some(batch)
    }

    /// Puts an orbit into a lane, at its beginning.
    pub fn begin(&mut self, lane: usize, state: &State, parameters: &[f64]) -> LaneStatus {
        let regular = self.can_begin(state, parameters).is_ok();
        if !regular {
            return LaneStatus::Irregular;
        }
        let status =
            of_stepper!(&mut self.stepper, stepper => stepper.start(lane, state, parameters));
        if let Some(events) = &mut self.events {
            events.begin(lane, state, parameters);
        }
        status
    }

    /// The same checks that an orbit alone has to pass.
    fn can_begin(&self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        let state = self.system.convert(state, self.system.form(), parameters)?;
        self.system.check_energy(&state, parameters)
    }

    /// The form of the states.
    pub fn form(&self) -> Form {
        match &self.stepper {
            BatchStepper::Taylor(_) => self.system.form(),
            BatchStepper::Splitting(steps) => steps.form(),
            BatchStepper::RungeKutta(steps) => steps.form(),
        }
    }

    /// Empties a lane.
    pub fn clear(&mut self, lane: usize) {
        of_stepper!(&mut self.stepper, stepper => stepper.clear(lane));
    }

    /// The status of a lane.
    #[inline]
    pub fn status(&self, lane: usize) -> LaneStatus {
        of_stepper!(&self.stepper, stepper => stepper.status(lane))
    }

    /// Takes steps whose intermediate states nobody observes, in every lane that is under way and before its limit: at
    /// least one, and no more once a step has reached the time of a lane in `observations`. A method may take them one by
    /// one; one of variable step does not go beyond the limit. Returns false if it was cancelled.
    #[must_use]
    pub fn steps_unobserved(&mut self, limits: &[f64; BATCH], observations: &[f64; BATCH]) -> bool {
        match (&mut self.stepper, &mut self.events) {
            (BatchStepper::Taylor(series), None) => series.step(limits),
            (BatchStepper::Taylor(series), Some(events)) => {
                let stepped = series.step(limits);
                events.pass(series);
                stepped
            }
            (BatchStepper::Splitting(steps), _) => steps.step(limits, observations),
            (BatchStepper::RungeKutta(steps), _) => steps.step(limits, observations),
        }
    }

    /// The next event of a lane in its last step, whose state is written into `out`; `None` if there is
    /// no other before the end of the step.
    ///
    /// # Errors
    /// Returns an error if the functions of the events cannot be followed, or if events accumulate.
    pub fn next_event(
        &mut self,
        lane: usize,
        out: &mut State,
    ) -> Result<Option<LaneEvent>, MotionError> {
        match (&mut self.stepper, &mut self.events) {
            (BatchStepper::Taylor(series), Some(events)) => events.next(series, lane, out),
            _ => Ok(None),
        }
    }

    /// The times at which the last step of a lane began and ended.
    pub fn interval(&self, lane: usize) -> (f64, f64) {
        of_stepper!(&self.stepper, stepper => stepper.interval(lane))
    }

    /// The state at the end of the last step of a lane.
    pub fn state(&mut self, lane: usize) -> &State {
        of_stepper!(&mut self.stepper, stepper => stepper.state(lane))
    }

    /// The time of that state.
    #[inline]
    pub fn time(&self, lane: usize) -> f64 {
        of_stepper!(&self.stepper, stepper => stepper.time(lane))
    }

    /// The times and the numbers of these states, those of all lanes side by side.
    pub fn states(&mut self) -> &BatchStates {
        of_stepper!(&mut self.stepper, stepper => stepper.states())
    }

    /// Writes the state of a lane at a time within its last step into `out`.
    pub fn at(&mut self, lane: usize, time: f64, out: &mut State) {
        of_stepper!(&mut self.stepper, stepper => stepper.at(lane, time, out));
    }
}
