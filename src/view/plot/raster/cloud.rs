//! Clouds: many points at once, shaded by how many fall into each cell.
//!
//! In: points in data coordinates and a ramp. Out: dots where the points are, styled by density. Never here: a single
//! point's history.

use super::{Cell, Pen, Raster};
use crate::num::math;
use crate::view::glyphs::Glyphs;
use crate::view::plot::scale::PlotFrame;
use crate::view::theme::Shade;

/// Where a curve was drawn before, a wide cloud takes its colour from this density on, as a part of the fullest on the
/// logarithmic scale: its edge is left to the curve around it. A thin cloud, of whose cells the curve goes through most, hides
/// it: nothing else would be seen of it.
const DENSE: f64 = 0.65;

/// ASCII characters from sparse to dense.
pub(super) const DENSITY: [char; 9] = ['.', ':', '-', '=', '+', '*', 'o', '#', '@'];

impl Raster {
    /// Draws points shaded by density: the step of the ramp grows with the logarithm of the count in a cell, and the
    /// fullest cell gets the last step.
    pub fn cloud(
        &mut self,
        frame: &PlotFrame,
        points: impl IntoIterator<Item = [f64; 2]>,
        ramp: &[Shade],
        layer: u8,
    ) {
        let size = self.size();
        let mut counts = vec![(0_u32, 0_u8); self.cells.len()];
        for point in points {
            let place = frame.dot(point, size);
            if (0..2).all(|i| (0.0..=f64::from(size[i])).contains(&place[i])) {
                let dot = std::array::from_fn(|i| (place[i] as i32).min(size[i] - 1));
                if let Some((cell, bit)) = self.place(dot) {
                    counts[cell].0 = counts[cell].0.saturating_add(1);
                    counts[cell].1 |= bit;
                }
            }
        }
        let fullest = counts.iter().map(|(count, _)| *count).max().unwrap_or(0);
        if fullest == 0 || ramp.is_empty() {
            return;
        }
        let covered = |cell: &Cell| cell.dots != 0 && cell.rank.0 < layer;
        let occupied = || self.cells.iter().zip(&counts).filter(|(_, (count, _))| *count > 0);
        let thin = 2 * occupied().filter(|(cell, _)| covered(cell)).count() > occupied().count();
        for (cell, (count, dots)) in self.cells.iter_mut().zip(counts) {
            if count == 0 {
                continue;
            }
            let level = math::ln_1p(f64::from(count)) / math::ln_1p(f64::from(fullest));
            let step = |steps: usize| ((level * steps as f64) as usize).min(steps - 1);
            let pen = Pen::aged(ramp[step(ramp.len())], layer, step(ramp.len()));
            let edge = !thin && covered(cell) && level < DENSE;
            cell.dots |= dots;
            if edge {
                continue;
            }
            if pen.layer >= cell.rank.0 {
                cell.upper = if pen.layer > cell.rank.0 { dots } else { cell.upper | dots };
            }
            let rank = (pen.layer, false, pen.fresh);
            if rank >= cell.rank {
                cell.rank = rank;
                cell.style = pen.style;
                cell.sign = (self.glyphs == Glyphs::Ascii).then(|| DENSITY[step(DENSITY.len())]);
            }
        }
    }
}
