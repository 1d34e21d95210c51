//! What is filled: the surfaces of a piece, with the style that its size on the screen gives it.
//!
//! In: extents, the width of a column. Out: a style. Never here: which dots are covered.

use super::solid::Occluder;
use crate::view::glyphs::Glyphs;
use crate::view::plot::Pen;

/// The second smallest extent, in columns, from which on a piece is drawn in blocks.
const THICK: f64 = 2.0;

/// The width, in dots, from which on a strip covers dots in each of its rows nearly up to its ends.
const WHOLE: f64 = 2.0;

/// How a piece is drawn with tones. It follows from its size on the screen and, unless it is seen from an edge, not from its attitude, so
/// that it does not change while it turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PieceStyle {
    /// Too thin for blocks: all of its dots.
    Dots,
    /// Thick enough for blocks.
    Solid,
}

impl PieceStyle {
    /// The style of a piece with this second smallest extent, where a column of cells has this width.
    pub(super) fn of(extent: f64, column: f64) -> Self {
        if extent / column >= THICK { Self::Solid } else { Self::Dots }
    }

    /// The style of a piece with these extents, the smaller one first, where it is seen with this least width, which is asked for only
    /// if the piece is thin enough.
    pub(super) fn seen(
        [least, other]: [f64; 2],
        width: impl FnOnce() -> f64,
        column: f64,
        glyphs: Glyphs,
    ) -> Self {
        // a cell is twice as high as wide
        let (wide, high) = glyphs.dots();
        let dot = column * (1.0 / f64::from(wide)).max(2.0 / f64::from(high));
        match Self::of(other, column) {
            Self::Solid if least < WHOLE * dot && width() < WHOLE * dot => Self::Dots,
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
    use crate::view::glyphs::Glyphs;

    #[test]
    fn a_piece_of_few_columns_is_a_mass_of_characters() {
        let of = |extents: [f64; 2]| is_small(extents.map(|x| x * 0.5), 0.5);
        assert_eq!([[21.9, 21.9], [0.0, 21.9], [0.0, 22.1]].map(of), [true, true, false]);
    }

    #[test]
    fn what_is_thinner_than_two_columns_from_two_sides_is_not_filled() {
        for column in [0.01, 5.0] {
            let of = |extent: f64| PieceStyle::of(extent * column, column);
            assert_eq!([1.9, 2.1].map(of), [PieceStyle::Dots, PieceStyle::Solid]);
        }
    }

    #[test]
    fn a_disc_is_filled_unless_it_is_narrower_than_two_dots() {
        let of = |extents: [f64; 2], width: f64, glyphs| {
            PieceStyle::seen(extents.map(|x| 3.0 * x), || 3.0 * width, 3.0, glyphs)
        };
        let disc = |width| of([0.0, 16.0], width, Glyphs::Braille);
        assert_eq!([disc(1.1), disc(0.9)], [PieceStyle::Solid, PieceStyle::Dots]);
        let disc = |width| of([0.0, 16.0], width, Glyphs::HalfBlock);
        assert_eq!([disc(2.1), disc(1.9)], [PieceStyle::Solid, PieceStyle::Dots]);
        let small = of([0.0, 1.9], 0.4, Glyphs::Braille);
        let thick = of([1.1, 16.0], 0.4, Glyphs::Braille);
        assert_eq!([small, thick], [PieceStyle::Dots, PieceStyle::Solid]);
    }
}
