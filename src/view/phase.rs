//! A phase portrait: one quantity against another, with its fading trail and, for one degree of freedom, the level
//! curves of the energy behind it.
//!
//! In: two channels, the trail, the landscape. Out: cells. Never here: what the levels are.

use ratatui::layout::Rect;

use super::canvas::{Canvas, Span};
use super::cursor;
use super::marks::{self, Marks};
use super::number::readable;
use super::plot::{Axes, Frame, Marker, Pen, Raster};
use super::quantity::Quantities;
use super::theme::Role;
use crate::app::Plot;

/// The layers of the picture, the lowest first.
const LEVELS: u8 = 0;
const SEPARATRIX: u8 = 1;
const TRAIL: u8 = 2;
const MARK: u8 = 3;
const NOW: u8 = 4;

/// The heading: what is shown, and the present values.
pub(super) fn title(
    canvas: &Canvas<'_>,
    q: &Quantities<'_>,
    ([x, y], title): ([usize; 2], &str),
) -> Vec<Span> {
    let mut spans = vec![canvas.span(Role::Title, title)];
    for channel in [x, y] {
        let value = readable(q.value(channel), 4, canvas.look.glyphs);
        spans.push(canvas.span(Role::Dim, format!("  {}", q.name(channel))));
        spans.push(canvas.span(Role::Accent, format!(" {value:<8}")));
    }
    spans.extend(marks::legend(canvas, q));
    spans
}

/// Draws the picture, and says where its axes stand.
pub(super) fn draw(
    canvas: &mut Canvas<'_>,
    area: Rect,
    q: &Quantities<'_>,
    plot: &Plot,
) -> Option<Frame> {
    let Plot::Phase { x, y, lens } = plot else { return None };
    let look = canvas.look;
    let landscape = q.lab.landscape(plot);
    let window = |axis: usize| landscape.map(|l| l.window[axis]);
    let axes = Axes::new(q.axis(*x, window(0), (*lens, 0)), q.axis(*y, window(1), (*lens, 1)));
    let axes = if lens.equal { axes.equal() } else { axes };
    let frame = axes.draw(area, canvas.buffer, &look.theme, look.glyphs);
    let mut raster = Raster::new(frame.area, look.glyphs);
    if let Some(landscape) = landscape {
        let kinds = [
            (&landscape.levels, Role::Level, LEVELS),
            (&landscape.separatrices, Role::Separatrix, SEPARATRIX),
        ];
        for (curves, role, layer) in kinds {
            let pen = Pen::shaded(look.theme.line(role), layer);
            for curve in curves {
                raster.polyline(&frame, curve.iter().copied(), &pen);
            }
        }
        let pen = Pen::shaded(look.theme.line(Role::Separatrix), SEPARATRIX);
        for saddle in &landscape.saddles {
            raster.marker(&frame, *saddle, Marker::Cross, &pen);
        }
    }
    let mut points: Vec<[f64; 2]> = q
        .snapshot
        .trail
        .rows()
        .filter_map(|row| Some([*row.get(1 + x)?, *row.get(1 + y)?]))
        .collect();
    let now = [q.value(*x), q.value(*y)];
    points.push(now);
    raster.trail(&frame, &points, look.theme.trail(0), TRAIL);
    raster.marker(&frame, now, Marker::Disc, &Pen::new(look.theme[Role::Accent], NOW));
    let marks = Marks::of(q, |row| Some([*row.get(1 + x)?, *row.get(1 + y)?]));
    marks.draw(&mut raster, &frame, &Pen::new(look.theme[Role::Warn], MARK));
    raster.draw(canvas.buffer);
    cursor::draw(canvas, area, &frame, (*lens, &marks));
    Some(frame)
}
