//! A piece of a step on which functions are represented by their series.
//!
//! In: nothing. Out: [`SeriesPiece`]. Never here: the series, and how long they hold.

use crate::num::DoubleDouble;

/// A piece of a step on which the functions are represented by their series.
pub(super) struct SeriesPiece {
    pub(super) from: DoubleDouble,
    pub(super) unit: f64,
    /// The length in that unit.
    pub(super) length: f64,
}
