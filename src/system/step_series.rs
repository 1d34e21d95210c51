//! The power series of a step, as read by those who expand functions along it.
//!
//! Out: coefficients about the beginning of the step. Never here: how they are built.

use crate::num::DoubleDouble;

/// The series of all numbers of a state.
pub trait StepSeries {
    /// The highest order.
    fn order(&self) -> usize;

    /// The number of series.
    fn count(&self) -> usize;

    /// The time of the origin.
    fn time(&self) -> DoubleDouble;

    /// The unit of time of the coefficients.
    fn scale(&self) -> f64;

    /// The unit of the coefficients of a number.
    fn unit(&self, _i: usize) -> f64 {
        1.0
    }

    /// All coefficients of a number in its unit, that of order k at place k.
    fn coefficients(&self, i: usize) -> &[f64];
}
