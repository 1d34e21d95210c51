//! Rates of change in double-double at any single state, together with the side of each switch and
//! the branch of each root on which the state lies. They serve where a series has to end, and to
//! check a series against the function it represents.

use std::sync::Arc;

use super::program::Program;
use super::value::Evaluator;
use super::{MotionError, System};
use crate::num::DoubleDouble;

/// The rates of change of states in the native form of a system. It owns its registers.
#[derive(Clone, Debug)]
pub struct ExactRates {
    system: System,
    program: Arc<Program>,
    values: Evaluator<DoubleDouble>,
}

impl System {
    /// Returns the rates of change of states in [`System::form`], in double-double.
    pub fn exact_rates(&self) -> ExactRates {
        let program = Arc::clone(&self.motion().native);
        let values = Evaluator::new(Arc::clone(&program));
        ExactRates { system: self.clone(), program, values }
    }
}

impl ExactRates {
    /// Sets the parameters. Must be called before the first evaluation.
    pub fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        self.values.set_parameters(parameters);
    }

    /// Evaluates at a time and at the numbers of a state.
    ///
    /// # Errors
    /// Returns an error if the mass matrix is singular there, or no velocities belong to the momenta.
    pub fn evaluate(
        &mut self,
        time: DoubleDouble,
        numbers: &[DoubleDouble],
    ) -> Result<(), MotionError> {
        let outcome = self.values.evaluate(time, &numbers[..self.system.driven_len()]);
        outcome.map_err(|singular| {
            let values: Vec<f64> = numbers.iter().map(|x| x.high).collect();
            self.system.singular(&self.program, singular, time.high, &values)
        })
    }

    /// The number of coordinates and rates, or of variables.
    pub fn moving(&self) -> usize {
        self.system.moving()
    }

    /// Whether any rate depends explicitly on time.
    pub fn depends_on_time(&self) -> bool {
        self.program.depends_on_time()
    }

    /// The rate of a number of the state.
    pub fn rate(&self, i: usize) -> DoubleDouble {
        self.values.output(i)
    }

    /// The value of a switch.
    pub fn switch(&self, i: usize) -> f64 {
        self.values.switch(i).high
    }

    /// The value of a function whose branch a motion may leave.
    pub fn guard(&self, i: usize) -> f64 {
        self.values.register(self.program.guards[i].value).high
    }
}
