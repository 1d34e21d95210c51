//! What a gauge measures from.
//!
//! In: a gauge's name and numbers. Out: a [`Reference`]. Never here: gauges.

use serde::{Deserialize, Serialize};

/// What a gauge measured from.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Reference {
    /// The gauge's name.
    pub name: String,
    /// What it showed.
    pub value: f64,
    /// What it measured from, and when that was taken.
    pub from: f64,
    /// When that was taken.
    pub since: f64,
    /// The greatest drift.
    pub max_drift: f64,
    /// What its value was then, before any impulse; as `from` where it is not reported.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial: Option<f64>,
    /// What drift is relative to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// The greatest distance, which is the greatest drift times that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub farthest: Option<f64>,
    /// Since when the drift is more than it may be.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left: Option<f64>,
}
