//! The halo of a disc: dots around it that lower layers leave blank.
//!
//! In: a disc in the coordinates of a frame. Out: fewer dots. Never here: the disc itself.

use super::Raster;
use crate::num::math;
use crate::view::plot::PlotFrame;

/// The width of a halo in dots.
const WIDTH: f64 = 1.5;

impl Raster {
    /// Blanks the dots inside and around a disc that are on a layer up to this one. In ASCII a cell has one character,
    /// and nothing is blanked.
    pub fn halo(&mut self, frame: &PlotFrame, [x, y]: [f64; 2], radius: f64, layer: u8) {
        if self.glyphs.is_ascii() {
            return;
        }
        let size = self.size();
        let (a, b) =
            (frame.dot([x - radius, y + radius], size), frame.dot([x + radius, y - radius], size));
        let middle = [0, 1].map(|k| f64::midpoint(a[k], b[k]));
        let half = [0, 1].map(|k| (b[k] - a[k]).abs() / 2.0 + WIDTH);
        if !middle.iter().chain(&half).all(|v| v.is_finite()) {
            return;
        }
        let range = |k: usize| {
            let within = |v: f64| v.clamp(0.0, f64::from(size[k])) as i32;
            within((middle[k] - half[k]).floor())..within((middle[k] + half[k]).ceil())
        };
        for row in range(1) {
            for column in range(0) {
                let off = |dot: i32, k: usize| (f64::from(dot) + 0.5 - middle[k]) / half[k];
                let Some((index, bit)) = self.place([column, row]) else { continue };
                let cell = &mut self.cells[index];
                if math::hypot(off(column, 0), off(row, 1)) <= 1.0
                    && cell.rank.0 <= layer
                    && cell.sign.is_none()
                {
                    cell.dots &= !bit;
                    cell.upper &= !bit;
                }
            }
        }
    }
}
