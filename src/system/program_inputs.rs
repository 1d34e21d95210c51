//! The inputs of programs on states in the native form, and what such a program is at one state.
//!
//! In: a state. Out: numbers in the order of a program's inputs, or the values of a program there. Never here: other forms of a
//! state (`native_states`).

use std::sync::Arc;

use super::program::Program;
use super::value::Evaluator;
use super::{MotionError, State, System};
use crate::num::{DoubleDouble, Real};

impl System {
    /// Writes the inputs of the observing programs: a state in the system's native form, then
    /// action and work, which are zero if the state does not carry them.
    pub(super) fn inputs_of<R: Real>(&self, state: &State, out: &mut [R]) {
        let motion_len = self.motion_len();
        for (i, x) in out[..motion_len].iter_mut().enumerate() {
            *x = R::of(state.exact(i));
        }
        let quadratures = self.quadratures();
        let mut next = self.driven_len();
        for (auxiliary, place) in
            [(quadratures.action, motion_len), (quadratures.work, motion_len + 1)]
        {
            out[place] = R::ZERO;
            if auxiliary {
                out[place] = R::of(state.exact(next));
                next += 1;
            }
        }
    }

    /// A program of native states, evaluated at one of them.
    pub(super) fn evaluated(
        &self,
        program: &Arc<Program>,
        state: &State,
        parameters: &[f64],
    ) -> Result<Evaluator<DoubleDouble>, MotionError> {
        let mut values: Evaluator<DoubleDouble> = Evaluator::new(Arc::clone(program));
        values.set_parameters(&self.inputs(parameters));
        let numbers: Vec<DoubleDouble> = (0..self.moving()).map(|i| state.exact(i)).collect();
        let outcome = values.evaluate(state.exact_time(), &numbers);
        outcome.map_err(|why| self.singular(program, why, state.time, &state.values))?;
        Ok(values)
    }
}
