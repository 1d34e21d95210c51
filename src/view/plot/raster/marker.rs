//! Markers: one character for a single point, with blank dots beside it.
//!
//! In: a point in the coordinates of a frame. Out: a character in its cell. Never here: what the point is.

use super::{Cell, Pen, Raster};
use crate::view::glyphs::Glyphs;
use crate::view::plot::PlotFrame;

/// A one-cell marker for a single point: a body, the current state, a fixed point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// `●`, or `@`: the current state, a mass.
    Disc,
    /// `○`, or `o`: a second of the same kind, a centre.
    Ring,
    /// `×`, or `x`: a saddle, an unstable point.
    Cross,
    /// `◆`, or `*`: an event.
    Diamond,
    /// The number of a motion among several, one digit.
    Number(usize),
}

impl Marker {
    /// The marker's character.
    pub fn symbol(self, glyphs: Glyphs) -> char {
        match self {
            Self::Disc => glyphs.pick('●', '@'),
            Self::Ring => glyphs.pick('○', 'o'),
            Self::Cross => glyphs.pick('×', 'x'),
            Self::Diamond => glyphs.pick('◆', '*'),
            Self::Number(number) => char::from(b'0' + (number % 10) as u8),
        }
    }
}

impl Raster {
    /// Draws a marker in the cell of a point, above the dots of its own layer and of all layers below.
    pub fn marker(&mut self, frame: &PlotFrame, point: [f64; 2], marker: Marker, pen: &Pen) {
        let Some(at) = frame.cell(point) else { return };
        let sign = marker.symbol(self.glyphs);
        let (column, row) = (at.x.wrapping_sub(self.area.x), at.y.wrapping_sub(self.area.y));
        if column >= self.area.width || row >= self.area.height {
            return;
        }
        let cell =
            &mut self.cells[usize::from(row) * usize::from(self.area.width) + usize::from(column)];
        let rank = (pen.layer, true, pen.fresh);
        if rank >= cell.rank {
            *cell = Cell { sign: Some(sign), rank, style: pen.style, ..*cell };
        }
    }

    /// The dots of each cell that markers beside it keep blank: those that touch them, of layers far below. It is empty if
    /// there is no marker, and in ASCII, where a cell has one character.
    pub(super) fn beside_markers(&self) -> Vec<u8> {
        if self.glyphs.is_ascii() || !self.cells.iter().any(|cell| cell.rank.1) {
            return Vec::new();
        }
        let mut covered = vec![0; self.cells.len()];
        let [columns, rows] = self.cell();
        let wide = usize::from(self.area.width);
        let touching = |beside: &dyn Fn(i32) -> bool| {
            (0..columns * rows).filter(|bit| beside(*bit)).fold(0_u8, |dots, bit| dots | 1 << bit)
        };
        let markers = self.cells.iter().enumerate().filter(|(_, cell)| cell.rank.1);
        for (index, marker) in markers {
            let column = index % wide;
            let mut cover = |other: Option<usize>, dots: u8| {
                let Some((index, cell)) = other.and_then(|i| Some((i, self.cells.get(i)?))) else {
                    return;
                };
                if cell.sign.is_none() && marker.rank.0 >= cell.rank.0 + 2 {
                    covered[index] |= dots;
                }
            };
            cover(Some(index + 1).filter(|_| column + 1 < wide), touching(&|b| b % columns == 0));
            cover(
                index.checked_sub(1).filter(|_| column > 0),
                touching(&|b| b % columns == columns - 1),
            );
            cover(Some(index + wide), touching(&|b| b / columns == 0));
            cover(index.checked_sub(wide), touching(&|b| b / columns == rows - 1));
        }
        covered
    }
}
