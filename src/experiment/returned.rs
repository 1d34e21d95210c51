//! How far a motion whose time was reversed has come back, and how far it is expected to.
//!
//! In: nothing. Out: [`Return`]. Never here: how it is measured.

use std::sync::Arc;

use crate::system::State;

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
    /// The state at which it was reversed.
    pub state: Arc<State>,
    /// The mean size of a step.
    pub mean_step: f64,
    /// The same of the steps whose error was measured, where it was.
    pub step: Option<f64>,
    /// The distance from the run before, in canonical variables, now or where it was seen last.
    pub distance: Option<f64>,
    /// The same at the start, once the motion has been there: the return error.
    pub error: Option<f64>,
}
