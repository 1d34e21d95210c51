//! Marks of what happened during a motion: one marker on a plot for each event and impulse that fits.
//!
//! In: occurrences and the trail. Out: named points of a plot, a legend. Never here: what an event does.

use ratatui::layout::Position;

use super::canvas::{Canvas, StyledText};
use super::plot::{Marker, Pen, PlotFrame, Raster};
use super::quantity::Quantities;
use super::theme::Role;

/// The most occurrences that are marked; the newest come first.
const MOST: usize = 256;

/// The most names listed in a heading.
const NAMES: usize = 3;

/// The least distance of two marks, in cells.
const APART: [u16; 2] = [3, 2];

/// The points of a plot at which something happened, newest first.
pub(super) struct Marks<'a> {
    points: Vec<(&'a str, [f64; 2])>,
}

impl<'a> Marks<'a> {
    /// An empty set of marks.
    pub(super) fn none() -> Self {
        Self { points: Vec::new() }
    }

    /// Finds the points of a plot at which something happened. `place` reads a point from a row of the trail (time, then
    /// the channels). For an impulse, the point is the one just after it.
    pub(super) fn of(q: &Quantities<'a>, place: impl Fn(&[f64]) -> Option<[f64; 2]>) -> Self {
        let mut points = Vec::new();
        let trail = &q.snapshot.trail;
        let mut rows = trail.rows().rev().peekable();
        let mut later: Option<&[f64]> = None;
        for occurrence in q.snapshot.occurrences.iter().rev().take(MOST) {
            while let Some(row) =
                rows.next_if(|row| trail.order(row[0]) > trail.order(occurrence.time))
            {
                later = Some(row);
            }
            // Occurrences older than the trail have no point.
            let Some(earlier) = rows.peek() else { break };
            let share = later.map_or(0.0, |later| {
                ((occurrence.time - earlier[0]) / (later[0] - earlier[0])).clamp(0.0, 1.0)
            });
            let point = place(earlier).and_then(|a| {
                let b = if share > 0.0 { place(later?)? } else { a };
                // at a caustic an image has a value on one side only
                Some([0, 1].map(|k| {
                    let all = [a[k] + share * (b[k] - a[k]), a[k], b[k]];
                    all.into_iter().find(|x| x.is_finite()).unwrap_or(f64::NAN)
                }))
            });
            points.extend(point.map(|point| (occurrence.name.as_str(), point)));
        }
        Self { points }
    }

    /// Draws as many marks as fit without overlap, newest first.
    pub(super) fn draw(&self, raster: &mut Raster, frame: &PlotFrame, pen: &Pen) {
        let mut taken: Vec<Position> = Vec::new();
        for (_, point) in &self.points {
            let Some(cell) = frame.cell(*point) else { continue };
            let near = |other: &Position| {
                other.x.abs_diff(cell.x) < APART[0] && other.y.abs_diff(cell.y) < APART[1]
            };
            if !taken.iter().any(near) {
                raster.marker(frame, *point, Marker::Diamond, pen);
                taken.push(cell);
            }
        }
    }

    /// Returns what happened in a cell or beside it.
    pub(super) fn at(&self, frame: &PlotFrame, at: Position) -> Option<&'a str> {
        let here = |(_, point): &&(&str, [f64; 2])| {
            let cell = frame.cell(*point);
            cell.is_some_and(|cell| cell.x.abs_diff(at.x) <= 1 && cell.y.abs_diff(at.y) <= 1)
        };
        self.points.iter().find(here).map(|(name, _)| *name)
    }
}

/// The names of the most recent occurrences, for a plot's heading.
pub(super) fn legend(canvas: &Canvas<'_>, q: &Quantities<'_>) -> Vec<StyledText> {
    let mut names: Vec<&str> = Vec::new();
    for occurrence in q.snapshot.occurrences.iter().rev().take(MOST) {
        if names.len() < NAMES && !names.contains(&occurrence.name.as_str()) {
            names.push(&occurrence.name);
        }
    }
    if names.is_empty() {
        return Vec::new();
    }
    let sign = Marker::Diamond.symbol(canvas.style.glyphs);
    vec![canvas.span(Role::Warn, format!("  {sign} {}", names.join(", ")))]
}
