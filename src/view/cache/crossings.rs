//! Drawn crossings of a surface, which are continued by those that are new.
//!
//! In: the rows of a log, how they are drawn. Out: a raster. Never here: where the rows come from.

use crate::view::glyphs::Glyphs;
use crate::view::plot::{Pen, PlotFrame, Raster};

/// Which crossings are drawn, where and how.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::view) struct CrossingsKey {
    pub(in crate::view) epoch: u64,
    pub(in crate::view) section: usize,
    pub(in crate::view) channels: [usize; 2],
    pub(in crate::view) frame: PlotFrame,
    pub(in crate::view) pen: Pen,
}

/// Drawn crossings, and the rows by which their continuation is known.
#[derive(Debug)]
pub(super) struct DrawnCrossings {
    raster: Raster,
    first: Vec<f64>,
    last: Vec<f64>,
}

impl DrawnCrossings {
    pub(super) fn empty(key: &CrossingsKey, glyphs: Glyphs) -> Self {
        let raster = Raster::new(key.frame.area, glyphs);
        Self { raster, first: Vec::new(), last: Vec::new() }
    }

    /// The number of rows after the last one drawn; `None` if these rows do not continue what is drawn.
    fn continuation<'a>(
        &self,
        mut rows: impl DoubleEndedIterator<Item = &'a [f64]> + Clone,
    ) -> Option<usize> {
        let mut newest = rows.clone().rev();
        let Some(oldest) = rows.next() else { return self.first.is_empty().then_some(0) };
        let is_same = same(oldest, &self.first);
        is_same.then(|| newest.position(|row| same(row, &self.last))).flatten()
    }

    /// Draws the rows that are new, or all where they do not continue what is drawn.
    pub(super) fn carry_on<'a>(
        &mut self,
        key: &CrossingsKey,
        glyphs: Glyphs,
        rows: impl DoubleEndedIterator<Item = &'a [f64]> + Clone,
    ) -> &Raster {
        let new = self.continuation(rows.clone()).unwrap_or_else(|| {
            *self = Self::empty(key, glyphs);
            rows.clone().count()
        });
        if self.first.is_empty() {
            self.first = rows.clone().next().unwrap_or_default().to_vec();
        }
        let mut newest = rows.rev().take(new).peekable();
        if let Some(row) = newest.peek() {
            self.last = row.to_vec();
        }
        let points = newest.map(|row| key.channels.map(|channel| row[1 + channel]));
        self.raster.points(&key.frame, points, &key.pen);
        &self.raster
    }
}

/// Whether two rows are the same bit by bit.
pub(super) fn same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::Buffer;
    use ratatui::layout::Rect;
    use ratatui::style::Style;

    use super::*;
    use crate::num::math;
    use crate::view::plot::Scale;

    fn shown(raster: &Raster, area: Rect) -> Buffer {
        let mut buffer = Buffer::empty(area);
        raster.draw(&mut buffer);
        buffer
    }

    /// A log grows, loses its oldest rows, goes back and takes another way: the dots are those of its present rows.
    #[test]
    fn crossings_that_are_carried_on_are_those_drawn_anew() {
        let area = Rect::new(0, 0, 20, 8);
        let scale = Scale::linear(-1.0, 1.0);
        let frame = PlotFrame::new(scale, scale, area);
        let pen = Pen::new(Style::new(), 2);
        let key = CrossingsKey { epoch: 1, section: 0, channels: [0, 1], frame, pen };
        let row = |k: usize, way: f64| {
            let angle = way * k as f64;
            vec![k as f64, math::sin(angle), math::cos(1.7 * angle)]
        };
        let all = |range: std::ops::Range<usize>, way: f64| range.map(|k| row(k, way)).collect();
        let logs: [Vec<Vec<f64>>; 9] = [
            Vec::new(),
            all(0..1, 1.0),
            all(0..7, 1.0),
            all(0..7, 1.0),
            all(0..40, 1.0),
            all(12..44, 1.0),
            all(12..20, 1.0),
            [all(12..20, 1.0), all(20..30, 2.0)].concat(),
            Vec::new(),
        ];
        for glyphs in [Glyphs::Braille, Glyphs::Ascii] {
            let mut drawn = DrawnCrossings::empty(&key, glyphs);
            for (index, log) in logs.iter().enumerate() {
                let rows = log.iter().map(Vec::as_slice);
                // others of the same rank are there already
                let others = (0..50).map(|k| [0.3 * f64::from(k % 7) - 1.0, 0.04 * f64::from(k)]);
                let mut both = Raster::new(area, glyphs);
                both.points(&frame, others, &pen);
                let mut anew = both.clone();
                both.lay_points(drawn.carry_on(&key, glyphs, rows.clone()));
                anew.points(&frame, rows.map(|row| [row[1], row[2]]), &pen);
                assert_eq!(shown(&both, area), shown(&anew, area), "{glyphs:?} {index}");
            }
        }
    }
}
