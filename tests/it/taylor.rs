//! The Taylor method compared with closed forms and published numbers, on kinks, in trivial motions and
//! at singularities.

mod accuracy;
mod branches;
mod far;
mod kinks;
mod narrow;
mod piecewise;
mod roots;
mod saturated;
mod steps;

use phaselab::integrate::{METHODS, Settings, Stepper};
use phaselab::model::Model;
use phaselab::system::{MotionError, State, System};

use crate::system::compile;

/// A motion by Taylor series.
pub(crate) struct Run {
    pub(crate) system: System,
    pub(crate) parameters: Vec<f64>,
    pub(crate) stepper: Box<dyn Stepper>,
    pub(crate) steps: u32,
}

impl Run {
    /// Starts at the file's initial values at time 0, with the tolerance of the table.
    pub(crate) fn new(text: &str) -> Run {
        Run::with(text, None)
    }

    pub(crate) fn with(text: &str, tolerance: Option<f64>) -> Run {
        let (model, system): (Model, System) = compile(text);
        let parameters = model.parameter_values();
        let state = system.initial(0.0, &parameters, &[]).expect("regular");
        let settings = Settings { step: None, tolerance };
        let mut stepper = (METHODS[0].make)(&system, &settings).expect("it fits every system");
        stepper.start(&state, &parameters).expect("regular");
        Run { system, parameters, stepper, steps: 0 }
    }

    pub(crate) fn try_to(&mut self, time: f64) -> Result<&State, MotionError> {
        while self.stepper.time() != time {
            self.stepper.step(time)?;
            self.steps += 1;
            assert!(self.steps < 1_000_000, "at t = {}", self.stepper.time());
        }
        Ok(self.stepper.state())
    }

    /// The state at a time, reached by steps.
    pub(crate) fn to(&mut self, time: f64) -> Vec<f64> {
        self.try_to(time).unwrap_or_else(|error| panic!("{error}")).values.clone()
    }

    /// The columns of the current state.
    pub(crate) fn columns(&self) -> Vec<f64> {
        let mut out = vec![0.0; self.system.columns()];
        let mut observer = self.system.observer(&self.parameters);
        observer.observe_columns(self.stepper.state(), &mut out).expect("regular");
        out
    }
}

/// Asserts |value − expected| ≤ within, number by number.
#[track_caller]
pub(crate) fn near(values: &[f64], expected: &[f64], within: f64) {
    assert!(!expected.is_empty() && values.len() >= expected.len(), "{values:?} {expected:?}");
    for (i, (a, b)) in values.iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= within, "number {i}: {a} and {b} differ by {:e}", (a - b).abs());
    }
}
