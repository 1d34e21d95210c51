//! What is recorded along a motion to detect singular configurations of its constraints.
//!
//! In: samples and states. Out: what the detection compares. Never here: the detection.

use crate::system::{ConstraintDirections, MotionError, State};

/// The data recorded to detect singular configurations of one motion.
#[derive(Clone, Debug, Default)]
pub(super) struct SingularityRecord {
    /// The time of the last sample, and its directions.
    pub(super) seen: Option<(f64, ConstraintDirections)>,
    /// Passages before the end of the last step that the current state has not reached.
    pub(super) ahead: Vec<f64>,
    pub(super) passed: u64,
    pub(super) first: Option<f64>,
    /// The state at the end of the last step.
    pub(super) left: Option<State>,
    /// A state before steps became much shorter, and the step there.
    pub(super) regular: Option<State>,
    pub(super) regular_step: f64,
    /// The greatest speed of each coordinate at the ends of regular steps.
    pub(super) fastest: Vec<f64>,
    /// The state at which it last began or continued.
    pub(super) begun: Option<State>,
    /// The corner of a constraint at which the last step has ended.
    pub(super) corner: Option<MotionError>,
    pub(super) comparison: ComparisonRecord,
}

/// The same of the comparison motion beside it.
#[derive(Clone, Debug, Default)]
pub(super) struct ComparisonRecord {
    /// The time of the last sample, and the directions where the comparison motion was.
    pub(super) seen: Option<(f64, ConstraintDirections)>,
    /// The first passage, with the coordinates there.
    pub(super) first: Option<(f64, Vec<f64>)>,
}
