//! Single characters, and what lies under all else.
//!
//! In: places in cells. Out: characters. Never here: data coordinates.

use super::{Cell, Pen, Raster};

impl Raster {
    /// Puts a character into a cell: column and row from the upper left one.
    pub fn character(&mut self, [column, row]: [u16; 2], sign: char, pen: &Pen) {
        let [wide, high] = self.cell();
        self.ink([i32::from(column) * wide, i32::from(row) * high], pen, Some(sign));
    }

    /// Adds the cells of another raster of the same area in which there is nothing yet.
    pub fn lay_blank(&mut self, other: &Self) {
        let is_drawn = |cell: &Cell| cell.dots != 0 || cell.sign.is_some();
        for (cell, other) in self.cells.iter_mut().zip(&other.cells) {
            if is_drawn(other) && !is_drawn(cell) {
                *cell = *other;
            }
        }
    }
}
