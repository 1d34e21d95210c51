//! The saved reference of a gauge.
//!
//! In: a gauge's name and numbers. Out: a [`Reference`]. Never here: gauges.

use serde::{Deserialize, Serialize};

/// The saved reference of a gauge.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Reference {
    /// The gauge's name.
    pub name: String,
    /// The value it showed.
    pub value: f64,
    /// The reference value.
    pub from: f64,
    /// When the reference was taken.
    pub since: f64,
    /// The greatest drift.
    pub max_drift: f64,
    /// The value when the reference was taken, before any impulse; defaults to `from`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial: Option<f64>,
    /// The scale of the drift.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// The greatest distance from the reference; `max_drift` times `scale` by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub farthest: Option<f64>,
    /// Since when the drift has exceeded the limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left: Option<f64>,
}
