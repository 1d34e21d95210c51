//! What is known of a motion inside its last step.
//!
//! In: a time within the step. Out: the state there, or the power series of the step. Never here: taking steps.

use crate::num::DoubleDouble;
use crate::system::{MotionError, State, StepSeries};

/// The motion within the last step of a method.
pub trait DenseOutput {
    /// The times at which the last step began and ended; equal before the first.
    fn interval(&self) -> (f64, f64);

    /// Writes the state at a time within the last step into `out`.
    ///
    /// Adaptive methods evaluate their interpolant (the Taylor polynomial itself, `dop853`'s of
    /// order 7). A method of fixed step takes a shorter step from the beginning of the last step
    /// and discards it afterwards: the result has the method's order, and the sequence of equal
    /// steps, on which the good behaviour of symplectic methods rests, is not disturbed.
    fn at(&mut self, time: f64, out: &mut State) -> Result<(), MotionError>;

    /// The same at a time that is known beyond the last digit of an `f64`, such as that of a
    /// crossing. A method that cannot distinguish such times gives the state at the nearest one.
    fn at_exactly(&mut self, time: DoubleDouble, out: &mut State) -> Result<(), MotionError> {
        self.at(time.high, out)
    }

    /// The time at which the last step ended, if it is known beyond the last digit of an `f64`.
    fn exact_end(&self) -> Option<DoubleDouble> {
        None
    }

    /// The power series of the last step, about its beginning. Returns `None` for methods without
    /// series, and if the last step did not use it.
    fn series(&self) -> Option<&dyn StepSeries> {
        None
    }
}
