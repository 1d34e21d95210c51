//! The pages of the program.
//!
//! In: nothing. Out: [`Page`]. Never here: what a page shows.

use serde::{Deserialize, Serialize};

/// A section of the page of equations that a key asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EquationsSection {
    /// What is conserved.
    Constants,
    /// The brackets of the constants.
    Brackets,
}

/// A whole screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Page {
    /// The systems, and a preview of the selected one.
    Picker,
    /// The panes of the lab.
    Lab,
    /// The equations derived from L or H.
    Equations,
    /// The notes in the file.
    Notes,
    /// Every channel as a number.
    Numbers,
    /// Everything on the screen as lines of plain text, which do not change by themselves.
    Plain,
}
