//! A prediction on a plot: the points and the curve that a person set, and beside them what the motion did.
//!
//! In: the lab's prediction, a frame. Out: dots and two words. Never here: how far the two are apart.

use ratatui::layout::Position;

use super::canvas::Canvas;
use super::plot::{Marker, Pen, PlotFrame, Raster};
use super::quantity::Quantities;
use super::theme::Role;
use crate::app::Prediction;
use crate::instrument::{Level, Plot};

/// The levels: over the motion, what was found under what was predicted.
const FOUND: Level = 250;
const PREDICTED: Level = 251;

fn shown<'a>(q: &Quantities<'a>, plot: &Plot) -> Option<&'a Prediction> {
    q.lab.prediction.as_deref().filter(|prediction| prediction.is_on(plot))
}

/// Draws the points and curves.
pub(super) fn draw(
    canvas: &Canvas<'_>,
    raster: &mut Raster,
    frame: &PlotFrame,
    (q, plot): (&Quantities<'_>, &Plot),
) {
    let Some(prediction) = shown(q, plot) else { return };
    let pen = |role: Role, level| Pen::new(canvas.style.theme[role], level);
    let (found, predicted) = (pen(Role::Good, FOUND), pen(Role::Warn, PREDICTED));
    raster.polyline(frame, prediction.outcome.iter().copied(), &found);
    if let ([only], false) = (prediction.outcome.as_slice(), prediction.is_curve) {
        raster.marker(frame, *only, Marker::Ring, &found);
    }
    raster.polyline(frame, prediction.line(), &predicted);
    for point in &prediction.points {
        raster.marker(frame, *point, Marker::Cross, &predicted);
    }
}

/// Writes which is which, once it was committed.
pub(super) fn label(
    canvas: &mut Canvas<'_>,
    frame: &PlotFrame,
    (q, plot): (&Quantities<'_>, &Plot),
) {
    let Some(prediction) = shown(q, plot) else { return };
    let named = [
        (prediction.points.last(), Role::Warn, "predicted"),
        (prediction.outcome.last(), Role::Good, "measured"),
    ];
    let mut taken: Option<Position> = None;
    for (at, role, name) in named {
        let Some(cell) = at.and_then(|at| frame.cell(*at)) else { continue };
        let width = name.len() as u16;
        // beside the mark, on the side where there is room; a row lower where the other word stands
        let right = cell.x + 2 + width <= frame.area.right();
        let x = if right { cell.x + 2 } else { cell.x.saturating_sub(width + 1) };
        let below = taken.is_some_and(|other| other.y == cell.y);
        let y = match cell.y {
            y if below && y + 1 < frame.area.bottom() => y + 1,
            y if below => y.saturating_sub(1),
            y => y,
        };
        let style = canvas.style(role);
        canvas.write(Position::new(x.max(frame.area.x), y), width, name, style);
        taken = Some(Position::new(x, y));
    }
}
