//! The interface of every method.

use super::{DenseOutput, StepBlock, Unstable};
use crate::system::{MotionError, State};

/// A motion in progress by one method. A call of [`Stepper::step`] takes one step; afterwards the
/// motion is known anywhere inside it, by its [`DenseOutput`].
pub trait Stepper: DenseOutput + Send {
    /// Begins at a state, which may have either form, at these parameters. Forgets all steps taken.
    fn start(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError>;

    /// The same with this step, if steps are equal. It is the step of this start only: one that the method chooses is chosen anew
    /// at the next.
    fn start_with_step(
        &mut self,
        state: &State,
        parameters: &[f64],
        _step: f64,
    ) -> Result<(), MotionError> {
        self.start(state, parameters)
    }

    /// Takes one step towards `limit`, which lies before or after the current time. A method of
    /// variable step never passes the limit and ends its last step exactly on it. A method of fixed
    /// step keeps its step and so may pass it; [`DenseOutput::at`] gives the states between. Does
    /// nothing if the current time has reached the limit.
    fn step(&mut self, limit: f64) -> Result<(), MotionError>;

    /// Takes steps, each as [`Stepper::step`] towards `limit` does, until `time` is reached or passed
    /// or `budget` of them are taken, which are subtracted from it. Only the last step is available
    /// afterwards. A method may take steps that are not observed faster than others, with the same
    /// result.
    fn steps(&mut self, time: f64, limit: f64, budget: &mut u64) -> Result<(), MotionError> {
        let forwards = time > self.time();
        while *budget > 0 && self.time() != time && (self.time() < time) == forwards {
            *budget -= 1;
            self.step(limit)?;
        }
        Ok(())
    }

    /// Takes at most `most` steps in the direction of time, and at most as many as a block has lanes,
    /// until `time` is reached or passed, and writes the end of each into `block`. Returns their
    /// number, which is zero if the next step must be taken by itself.
    fn steps_seen(&mut self, _time: f64, _most: u64, _block: &mut StepBlock) -> u64 {
        0
    }

    /// Continues from a state that differs from the one at the end of the last step by rounding
    /// only, as one projected onto its constraints does. The last step remains available.
    fn replace_state(&mut self, state: &State);

    /// The state at the end of the last step, in the form the method works in.
    fn state(&self) -> &State;

    /// The step in use: the fixed one, or the last one taken (zero before the first).
    fn step_size(&self) -> f64 {
        let (begin, end) = self.interval();
        end - begin
    }

    /// The relative tolerance in use, of a method that has one.
    fn tolerance(&self) -> Option<f64> {
        None
    }

    /// The instability of the fixed step, if one was found.
    fn unstable(&self) -> Option<Unstable> {
        None
    }

    /// The current time: the end of the last step.
    fn time(&self) -> f64 {
        self.state().time
    }
}
