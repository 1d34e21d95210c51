//! What is filled: the surfaces of a piece, with the style that its size on the screen gives it.
//!
//! In: extents, the width of a column. Out: a style. Never here: which dots are covered.

use super::solid::Occluder;
use crate::view::plot::Pen;

/// The thickness, in columns, from which on a piece is drawn in blocks: two quarters of a cell across, however it turns.
const THICK: f64 = 2.0;

/// How a piece is drawn with tones. It follows from its size on the screen and, but for sheets, not from its attitude, so that
/// it does not change while it turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PieceStyle {
    /// Too thin for blocks: all of its dots.
    Dots,
    /// Thin from one side: blocks between lines along its edges.
    Sheet,
    Solid,
}

impl PieceStyle {
    /// The style of a piece with these extents, the smaller one first, where a column of cells has this width.
    pub(super) fn of([least, other]: [f64; 2], column: f64) -> Self {
        match (least / column >= THICK, other / column >= THICK) {
            (true, _) => Self::Solid,
            (false, true) => Self::Sheet,
            (false, false) => Self::Dots,
        }
    }

    /// The style of such a piece where it is seen with this least width: the edges of a sheet are blocks, unless it is seen from
    /// its edge.
    pub(super) fn seen(extents: [f64; 2], width: f64, column: f64) -> Self {
        match Self::of(extents, column) {
            Self::Sheet if width / column >= THICK => Self::Solid,
            style => style,
        }
    }
}

/// The extent, in columns, below which a piece is drawn in ASCII as one mass of characters: with fewer of them, edges and shading
/// cannot be told apart.
const SMALL: f64 = 22.0;

/// Whether a piece with these extents, the smaller one first, is too small for edges in ASCII, where a column of cells has this width.
pub(super) fn is_small([_, other]: [f64; 2], column: f64) -> bool {
    other / column < SMALL
}

pub(super) struct Filling {
    pub(super) pen: Pen,
    /// The shares of its dots in the shade and in full light.
    pub(super) shares: [f64; 2],
    pub(super) style: PieceStyle,
    pub(super) solids: Vec<Occluder>,
    /// Whether all of its dots are drawn, together with those of its edges.
    pub(super) is_mass: bool,
    /// Whether what is behind is seen through it.
    pub(super) see_through: bool,
}

#[cfg(test)]
mod tests {
    use super::{PieceStyle, is_small};

    #[test]
    fn a_piece_of_few_columns_is_a_mass_of_characters() {
        let of = |extents: [f64; 2]| is_small(extents.map(|x| x * 0.5), 0.5);
        assert_eq!([[21.9, 21.9], [0.0, 21.9], [0.0, 22.1]].map(of), [true, true, false]);
    }

    #[test]
    fn what_is_thinner_than_two_columns_is_not_filled_from_that_side() {
        for column in [0.01, 5.0] {
            let of = |extents: [f64; 2]| PieceStyle::of(extents.map(|x| x * column), column);
            assert_eq!(of([0.0, 1.9]), PieceStyle::Dots);
            assert_eq!(of([1.9, 1.9]), PieceStyle::Dots);
            assert_eq!(of([1.9, 2.1]), PieceStyle::Sheet);
            assert_eq!(of([2.1, 2.1]), PieceStyle::Solid);
        }
    }

    #[test]
    fn a_disc_has_blocks_for_edges_unless_it_is_seen_from_its_edge() {
        let of = |diameter: f64, width: f64| PieceStyle::seen([0.0, diameter], width, 1.0);
        assert_eq!([of(15.9, 2.1), of(15.9, 1.9)], [PieceStyle::Solid, PieceStyle::Sheet]);
        assert_eq!([of(60.0, 9.0), of(1.9, 1.9)], [PieceStyle::Solid, PieceStyle::Dots]);
    }
}
