//! Bands: many points at once in one colour, the stronger the more of them fall on a dot.
//!
//! In: points in data coordinates and a ramp. Out: dots where the points are, styled by how many fall on each dot of a cell
//! in the mean, relative to all those of a column. Without colour, dots where there are few are thinned out. Never here: a
//! single point's history.

use super::cloud::DENSITY;
use super::{Pen, Raster};
use crate::num::math;
use crate::view::glyphs::Glyphs;
use crate::view::plot::scale::PlotFrame;
use crate::view::theme::Shade;

impl Raster {
    /// Draws points; the step of the ramp grows with the logarithm of the mean count on the dots of a cell that have any, and
    /// the last one is for all points of a column on one dot: a curve is stronger than a band over which they are spread.
    pub fn bands(
        &mut self,
        frame: &PlotFrame,
        points: impl IntoIterator<Item = [f64; 2]>,
        ramp: &[Shade],
        layer: u8,
    ) {
        let size = self.size();
        let mut counts = vec![[0_u32; 8]; self.cells.len()];
        let mut columns = vec![0_u32; size[0].max(0) as usize];
        for point in points {
            let place = frame.dot(point, size);
            if (0..2).all(|i| (0.0..=f64::from(size[i])).contains(&place[i])) {
                let dot: [i32; 2] = std::array::from_fn(|i| (place[i] as i32).min(size[i] - 1));
                if let (Some((cell, bit)), Some(column)) =
                    (self.place(dot), columns.get_mut(dot[0] as usize))
                {
                    *column = column.saturating_add(1);
                    let count = &mut counts[cell][bit.trailing_zeros() as usize];
                    *count = count.saturating_add(1);
                }
            }
        }
        let mean = |counts: &[u32; 8]| {
            let dots = counts.iter().filter(|count| **count > 0).count();
            let all: f64 = counts.iter().map(|count| f64::from(*count)).sum();
            (dots > 0).then(|| all / dots as f64)
        };
        let strongest = columns.into_iter().max().map_or(0.0, f64::from);
        if strongest == 0.0 || ramp.is_empty() {
            return;
        }
        for (cell, counts) in counts.iter().enumerate() {
            let Some(mean) = mean(counts) else { continue };
            let level = (math::ln_1p(mean) / math::ln_1p(strongest)).min(1.0);
            let step = |steps: usize| ((level * steps as f64) as usize).min(steps - 1);
            let pen = Pen::aged(ramp[step(ramp.len())], layer, step(ramp.len()));
            let sign = (self.glyphs == Glyphs::Ascii).then(|| DENSITY[step(DENSITY.len())]);
            // In ASCII the character says how many there are; none is left out.
            let pen = if sign.is_some() { pen.covering(1.0) } else { pen };
            for bit in (0..counts.len()).filter(|bit| counts[*bit] > 0) {
                self.ink_bit((cell, bit), &pen, sign);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::Buffer;
    use ratatui::layout::Rect;
    use ratatui::style::Color;

    use super::*;
    use crate::view::colour::ColourDepth;
    use crate::view::plot::Scale;
    use crate::view::theme::Theme;

    /// Ten cells, from the left: a band of three points per dot, a band of thirty, and a line of six hundred.
    fn drawn(glyphs: Glyphs, depth: ColourDepth) -> (Raster, Buffer) {
        let area = Rect::new(0, 0, 30, 5);
        let scale = Scale::linear(0.0, 1.0);
        let frame = PlotFrame::new(scale, scale, area);
        let mut raster = Raster::new(area, glyphs);
        let [wide, high] = raster.size();
        let points = (0..wide).flat_map(|x| {
            let part = 3 * x / wide;
            let spread = [3, 30, 0][part as usize];
            let rows = move |y: i32| {
                let count = if part == 2 && y == high / 2 { 600 } else { spread };
                let at = [x, y].map(|dot| f64::from(dot) + 0.5);
                let at = [at[0] / f64::from(wide), 1.0 - at[1] / f64::from(high)];
                std::iter::repeat_n(at, count)
            };
            (0..high).flat_map(rows)
        });
        raster.bands(&frame, points, Theme::dark(depth).trail(0), 1);
        let mut buffer = Buffer::empty(area);
        raster.draw(&mut buffer);
        (raster, buffer)
    }

    #[test]
    fn a_line_is_stronger_than_a_band_and_a_dense_band_than_a_thin_one() {
        let theme = Theme::dark(ColourDepth::True);
        let age = |buffer: &Buffer, x: u16| {
            let fg =
                (0..5).map(|y| &buffer[(x, y)]).find(|cell| cell.symbol() != " ").expect("ink").fg;
            theme
                .trail(0)
                .iter()
                .position(|shade| shade.style.fg == Some(fg))
                .expect("a shade of the trail")
        };
        let (_, buffer) = drawn(Glyphs::Braille, ColourDepth::True);
        let ages = [4, 14, 24].map(|x| age(&buffer, x));
        assert!(ages[0] < ages[1] && ages[1] < ages[2], "{ages:?}");
        assert_eq!(ages[2], theme.trail(0).len() - 1);
        assert_ne!(buffer[(4, 1)].fg, Color::Reset);
    }

    #[test]
    fn without_colour_a_thin_band_has_fewer_dots_and_in_ascii_lighter_characters() {
        let (raster, _) = drawn(Glyphs::Braille, ColourDepth::None);
        let dots = |from: i32, to: i32| {
            (from..to)
                .flat_map(|x| (0..20).map(move |y| [x, y]))
                .filter(|d| raster.is_set(*d))
                .count()
        };
        let (thin, dense, line) = (dots(0, 20), dots(20, 40), dots(40, 60));
        assert!(thin < 300 && thin + 60 < dense && line == 20, "{thin} {dense} {line}");
        let (_, buffer) = drawn(Glyphs::Ascii, ColourDepth::None);
        let letter = |x: u16| {
            let symbol = (0..5).map(|y| buffer[(x, y)].symbol()).find(|symbol| *symbol != " ");
            DENSITY
                .iter()
                .position(|c| symbol == Some(c.to_string().as_str()))
                .expect("a character of density")
        };
        let weights = [4, 14, 24].map(letter);
        assert!(weights[0] < weights[1] && weights[1] < weights[2], "{weights:?}");
    }
}
