//! How far a motion whose time was reversed has come back, and how far it is expected to.
//!
//! In: nothing. Out: [`Return`]. Never here: how it is measured.

use crate::analysis::expected_return;

/// How a motion that went back has returned, or is about to.
#[derive(Clone, PartialEq, Debug)]
pub struct Return {
    /// The time at which it was reversed.
    pub turned: f64,
    /// The time at which the run before began.
    pub start: f64,
    /// ε, the error of a step: the tolerance or, where steps are fixed and a step back is the inverse of one forwards, the
    /// rounding, times the size of the motion; of any other method how far a step there and back misses, as measured.
    pub step_error: f64,
    /// The mean size of a step, where its error was measured.
    pub step: Option<f64>,
    /// The distance from the run before, in canonical variables, now or where it was seen last.
    pub distance: Option<f64>,
    /// The same at the start, once the motion has been there: the return error.
    pub error: Option<f64>,
}

impl Return {
    /// The error that is expected after a time gone back, where errors grow like e^{λt}.
    pub fn expected(&self, rate: f64, gone: f64) -> f64 {
        expected_return((self.step_error, self.step), rate, gone)
    }
}
