//! A session as stored: which system, how it is viewed, and the state of its motion, by names.
//!
//! In: nothing. Out: [`Saved`]. Never here: the file it is stored in, or how it is resumed.

use serde::{Deserialize, Serialize};

use super::{Page, Pane, Selection};
use crate::experiment::Checkpoint;
use crate::instrument::SavedPlot;
use crate::preset::NewObservable;

/// A session.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    /// The version of this format, [`Saved::VERSION`].
    pub version: u32,
    /// The version of the program that wrote it.
    pub phaselab: String,
    /// The preset's name or the file's path.
    pub open: String,
    /// The page that was shown.
    pub page: Page,
    /// The focused pane.
    pub focus: Pane,
    /// Whether that pane was zoomed.
    pub zoomed: bool,
    /// The selected lines.
    pub selection: Selection,
    /// Whether the system came from an unsaved text instead of the file.
    #[serde(default)]
    pub edited: bool,
    /// A digest of what its text said of the law of motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law: Option<String>,
    /// The unit of its time; empty where it has none.
    #[serde(default)]
    pub time_unit: String,
    /// The times that are marked.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub marks: Vec<f64>,
    /// The quantities that were typed for axes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub typed: Vec<NewObservable>,
    /// The pictures that were focused, the last one first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub in_front: Vec<usize>,
    /// The pictures.
    pub plots: Vec<SavedPlot>,
    /// The state of the motion.
    #[serde(rename = "moment")]
    pub checkpoint: Checkpoint,
}

impl Saved {
    /// The version of this format that this program writes and reads.
    pub const VERSION: u32 = 1;
}
