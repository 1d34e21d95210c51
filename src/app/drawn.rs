//! What drawing the screen has determined.
//!
//! In: nothing. Out: [`Drawn`], which `view` fills in. Never here: cells.

use std::sync::Arc;

use super::Pane;

/// What drawing the screen has determined.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawn {
    /// The number of rows of the text page beyond the screen when it is scrolled to its start.
    pub beyond: u16,
    /// The number of rows by which it was scrolled, where a section of it is to be in view.
    pub scroll: Option<u16>,
    /// The number of its rows in which a search has found its words.
    pub matches: usize,
    /// The number of its rows that fit on the screen.
    pub rows: u16,
    /// The number of columns of an edited text that fit.
    pub columns: u16,
    /// The position of the terminal's cursor, column and row: in the text being typed, or at the line being read.
    pub cursor: Option<(u16, u16)>,
    /// The coordinates of the cursor of the focused plot.
    pub reading: Option<[f64; 2]>,
    /// Its place in the window, in fractions of the width from the left and of the height from below.
    pub cursor_place: Option<[f64; 2]>,
    /// The place of the moving point on the focused plot, in fractions of the width from the left and of the height from below.
    pub moving: Option<[f64; 2]>,
    /// The panes of the lab, if they were drawn.
    pub panes: Option<DrawnPanes>,
}

/// What drawing the panes of the lab has determined.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawnPanes {
    /// Whether there is room for one pane only.
    pub single: bool,
    /// How much of the law of motion is in view.
    pub law: LawInView,
    /// The panes in view.
    pub in_view: PanesInView,
}

/// The panes in view, in the order of their places; all of them before anything was drawn.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PanesInView(Option<Arc<[Pane]>>);

impl PanesInView {
    /// These, in order.
    pub fn of(panes: impl IntoIterator<Item = Pane>) -> Self {
        Self(Some(panes.into_iter().collect()))
    }

    /// Whether a pane is among them.
    pub fn has(&self, pane: Pane) -> bool {
        self.0.as_ref().is_none_or(|all| all.contains(&pane))
    }

    /// All of them, if anything was drawn.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = Pane> {
        self.0.iter().flat_map(|all| all.iter()).copied()
    }
}

/// How much of the law of motion is in view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LawInView {
    /// All of it.
    #[default]
    Whole,
    /// Its pane has room for all but this many rows.
    Clipped(u16),
    /// It has no pane until it is focused.
    Hidden,
}
