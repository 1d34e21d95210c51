//! What is filled: the surfaces of a piece, with the style that its size on the screen gives it.
//!
//! In: extents, the width of a column. Out: a style. Never here: attitudes, or which dots are covered.

use super::solid::Occluder;
use crate::view::plot::Pen;

/// The thickness, in columns, from which on a piece is drawn in blocks: two quarters of a cell across, however it turns.
const THICK: f64 = 3.0;

/// How a piece is drawn with tones. It follows from its size on the screen and not from its attitude, so that it does not change
/// while it turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PieceStyle {
    /// Too thin for blocks: lines along its edges, and dots between them.
    Lines,
    /// Thin from one side: blocks between lines along its edges.
    Sheet,
    /// Blocks.
    Solid,
}

impl PieceStyle {
    /// The style of a piece with these extents, the smaller one first, where a column of cells has this width.
    pub(super) fn of([least, other]: [f64; 2], column: f64) -> Self {
        match (least / column >= THICK, other / column >= THICK) {
            (true, _) => Self::Solid,
            (false, true) => Self::Sheet,
            (false, false) => Self::Lines,
        }
    }
}

/// A surface that is filled.
pub(super) struct Filling {
    pub(super) pen: Pen,
    /// The shares of its dots in the shade and in full light.
    pub(super) shares: [f64; 2],
    pub(super) style: PieceStyle,
    pub(super) solids: Vec<Occluder>,
    /// Whether what is behind is seen through it.
    pub(super) see_through: bool,
}
