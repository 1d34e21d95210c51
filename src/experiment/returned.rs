//! How far a motion whose time was reversed has come back.
//!
//! In: nothing. Out: [`Return`]. Never here: how it is measured.

/// How a motion that went back has returned, or is about to.
#[derive(Clone, PartialEq, Debug)]
pub struct Return {
    /// The time at which it was reversed.
    pub turned: f64,
    /// The time at which the run before began.
    pub start: f64,
    /// ε, the error of a step: the tolerance or, where steps are fixed, the rounding, times the size of the motion.
    pub step_error: f64,
    /// The distance from the run before, in canonical variables, now or where it was seen last.
    pub distance: Option<f64>,
    /// The same at the start, once the motion has been there: the return error.
    pub error: Option<f64>,
}
