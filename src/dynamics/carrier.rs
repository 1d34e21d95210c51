//! A motion that carries tangent vectors in canonical variables.
//!
//! In: a phase space, a method, a state with vectors. Out: the state and the vectors later on.
//! Never here: which vectors to carry, what becomes of them.

use nalgebra::DMatrix;

use super::error::DynamicsError;
use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Settings, Stepper, Stepping};
use crate::system::{MotionError, State, System};

/// A motion with tangent vectors, in steps of a method. Under a method of fixed step the vectors
/// are those of the method's own map.
pub struct Carrier {
    space: PhaseSpace,
    /// The system with tangent vectors.
    system: System,
    method: &'static Method,
    settings: Settings,
    stepper: Box<dyn Stepper>,
    steps: u64,
}

impl Carrier {
    /// A motion with `count` vectors, which must then be started.
    ///
    /// # Errors
    /// Returns an error if the method does not suit the system.
    pub fn new(
        space: &PhaseSpace,
        method: &'static Method,
        settings: Settings,
        count: usize,
    ) -> Result<Carrier, DynamicsError> {
        let system = space.system().with_tangents(count);
        let stepper = (method.make)(&system, &settings)?;
        Ok(Carrier { space: space.clone(), system, method, settings, stepper, steps: 0 })
    }

    /// Starts at a state of the space, with the columns of `vectors`.
    ///
    /// # Errors
    /// Returns an error if the motion cannot begin there.
    pub fn start(&mut self, state: &State, vectors: &DMatrix<f64>) -> Result<(), DynamicsError> {
        let mut full = self.system.extended(state, self.space.system());
        for (j, column) in vectors.column_iter().enumerate() {
            let first = self.system.tangent_place(j);
            for (i, &x) in column.iter().enumerate() {
                full.values[first + i] = x;
            }
        }
        if self.method.stepping == Stepping::Fixed && self.settings.step.is_none() {
            self.stepper.start(&full, self.space.parameters())?;
            // the same step from now on, wherever the motion is started again
            self.settings.step = Some(self.stepper.step_size().abs());
            self.stepper = (self.method.make)(&self.system, &self.settings)?;
        }
        Ok(self.stepper.start(&full, self.space.parameters())?)
    }

    /// Takes one step towards `limit`.
    ///
    /// # Errors
    /// Returns an error if the motion cannot continue, or was cancelled.
    pub fn step(&mut self, limit: f64) -> Result<(), MotionError> {
        if self.system.cancel().is_cancelled() {
            let state = self.stepper.state();
            let kind = crate::system::MotionErrorKind::Cancelled;
            return Err(self.system.fault(kind, state.time, &state.values));
        }
        self.steps += 1;
        self.stepper.step(limit)
    }

    /// The settings in use: the step is known after the start.
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// Whether all steps are equal.
    pub fn is_fixed(&self) -> bool {
        self.method.stepping == Stepping::Fixed
    }

    /// The number of steps taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The time at the end of the last step.
    pub fn time(&self) -> f64 {
        self.stepper.time()
    }

    /// The times at which the last step began and ended.
    pub fn interval(&self) -> (f64, f64) {
        self.stepper.interval()
    }

    /// The state and the vectors, as columns, at a time within the last step.
    ///
    /// # Errors
    /// Returns an error if they cannot be evaluated.
    pub fn at(&mut self, time: f64) -> Result<(State, DMatrix<f64>), MotionError> {
        let mut state = self.stepper.state().clone();
        if time != state.time {
            self.stepper.at(time, &mut state)?;
        }
        let full = self.system.convert(&state, self.space.form(), self.space.parameters())?;
        let (n, count) = (self.space.dimension(), self.system.tangents());
        let first = self.system.tangent_place(0);
        let vectors = DMatrix::from_column_slice(n, count, &full.values[first..first + n * count]);
        Ok((self.space.system().extended(&full, &self.system), vectors))
    }
}
