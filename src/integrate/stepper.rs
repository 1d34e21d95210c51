//! What every method can do.

use super::Unstable;
use crate::num::DoubleDouble;
use crate::system::{Form, MotionError, State};

/// A motion under way by one method. A call of [`Stepper::step`] takes one step; afterwards the
/// motion is known anywhere inside it.
pub trait Stepper: Send {
    /// Begins at a state, at these parameters; it may have either form. Forgets all steps taken.
    fn start(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError>;

    /// Takes one step towards `limit`, which lies before or after the present time. A method of
    /// variable step never passes the limit and ends its last step exactly on it. A method of
    /// fixed step keeps its step and so may pass it: states between are reported by [`Stepper::at`].
    /// Does nothing where the present time has reached the limit.
    fn step(&mut self, limit: f64) -> Result<(), MotionError>;

    /// Goes on from a state that differs from the one at the end of the last step by rounding only,
    /// as one put back on its constraints does. The last step stays as it was.
    fn replace_state(&mut self, state: &State);

    /// The state at the end of the last step, in the form the method works in.
    fn state(&self) -> &State;

    /// The times at which the last step began and ended; equal before the first.
    fn interval(&self) -> (f64, f64);

    /// The state at a time within the last step.
    ///
    /// Adaptive methods evaluate their interpolant (the Taylor polynomial itself, `dop853`'s of
    /// order 7). A method of fixed step takes one shorter step of its own from the beginning of
    /// the last step and throws it away afterwards: the result has the method's order, and the
    /// sequence of equal steps, on which the good behaviour of symplectic methods rests, is not
    /// disturbed.
    fn at(&mut self, time: f64, out: &mut State) -> Result<(), MotionError>;

    /// The same at a time that is known beyond the last digit of an `f64`, as that of a crossing
    /// is. A method that cannot tell such times apart gives the state at the nearest.
    fn at_exactly(&mut self, time: DoubleDouble, out: &mut State) -> Result<(), MotionError> {
        self.at(time.high, out)
    }

    /// The step in use: the fixed one, or the last one taken (zero before the first).
    fn step_size(&self) -> f64 {
        let (begin, end) = self.interval();
        end - begin
    }

    /// Where the fixed step was found to lie beyond what is stable, if it was.
    fn unstable(&self) -> Option<Unstable> {
        None
    }

    /// The form the method works in, and that its states have.
    fn form(&self) -> Form {
        self.state().form
    }

    /// The present time: the end of the last step.
    fn time(&self) -> f64 {
        self.state().time
    }
}
