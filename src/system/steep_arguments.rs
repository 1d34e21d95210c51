//! The arguments of the functions that a law may hide in: e^u, tanh u, sinh u and cosh u change only where u is small, and a barrier
//! or a pulse of theirs may be narrower than the steps of a motion. So may one of c/u^n, which is large only where u is small.
//!
//! In: states of a system. Out: the arguments there. Never here: steps.

use std::sync::Arc;

use super::native_states::NativeStates;
use super::program::Program;
use super::value::Evaluator;
use super::{MotionError, State, System};

/// Evaluates the arguments, or the divisors, in the law of one system at one set of parameters.
#[derive(Clone, Debug)]
pub struct SteepArguments {
    system: System,
    native: NativeStates,
    program: Arc<Program>,
    values: Evaluator<f64>,
    inputs: Vec<f64>,
    count: usize,
}

impl SteepArguments {
    /// Takes other values, in the order of the model, for all evaluations to come.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        let inputs = self.system.inputs(parameters);
        self.native.set_parameters(parameters, &inputs);
        self.values.set_parameters(&inputs);
    }

    /// Their number.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Writes them at a state into `out`.
    ///
    /// # Errors
    /// Returns an error if one has no value there.
    pub fn observe(&mut self, state: &State, out: &mut [f64]) -> Result<(), MotionError> {
        self.native.write(state, &mut self.inputs)?;
        self.values
            .evaluate(state.time, &self.inputs)
            .map_err(|why| self.system.singular(&self.program, why, state.time, &state.values))?;
        for (i, x) in out.iter_mut().enumerate() {
            *x = self.values.output(i);
        }
        Ok(())
    }
}

impl System {
    /// Returns the evaluator of the arguments of exponential functions in the law; `None` if there are none.
    pub fn steep_arguments(&self, parameters: &[f64]) -> Option<SteepArguments> {
        self.evaluator_of(&self.shared.steep, parameters)
    }

    /// Returns the evaluator of what negative powers in the law divide by; `None` if there are none.
    pub fn divisors(&self, parameters: &[f64]) -> Option<SteepArguments> {
        self.evaluator_of(&self.shared.divisors, parameters)
    }

    /// Returns the evaluator of those of them that may change their sign; `None` if there are none.
    pub fn signed_divisors(&self, parameters: &[f64]) -> Option<SteepArguments> {
        self.evaluator_of(&self.shared.signed_divisors, parameters)
    }

    fn evaluator_of(&self, program: &Arc<Program>, parameters: &[f64]) -> Option<SteepArguments> {
        let count = program.outputs();
        if count == 0 {
            return None;
        }
        let mut arguments = SteepArguments {
            system: self.clone(),
            native: NativeStates::new(self),
            program: Arc::clone(program),
            values: Evaluator::new(Arc::clone(program)),
            inputs: vec![0.0; self.motion_len() + 2],
            count,
        };
        arguments.set_parameters(parameters);
        Some(arguments)
    }
}
