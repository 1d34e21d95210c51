//! A phase portrait: one quantity against another, with its fading trail and, for one degree of freedom, the level
//! curves of the energy behind it.
//!
//! In: two channels, the trail, the landscape. Out: cells. Never here: what the levels are.

use ratatui::layout::Rect;
use ratatui::style::Style;

use super::canvas::{Canvas, Span, groups};
use super::cursor;
use super::marks::{self, Marks};
use super::number::readable;
use super::plot::{Axes, Frame, Marker, Pen, Raster};
use super::quantity::Quantities;
use super::theme::Role;
use crate::analysis::{Curve, Landscape};
use crate::app::Plot;

/// The layers of the picture, the lowest first.
const LEVELS: u8 = 0;
const SEPARATRIX: u8 = 1;
const TRAIL: u8 = 2;
const MARK: u8 = 3;
const NOW: u8 = 4;

/// A level curve is left out if others share its cells along more than this part of its way, in ASCII and with dots.
const CROWDED: [f64; 2] = [0.25, 0.35];

/// In more cells than this all levels have room.
const ROOMY: u32 = 2000;

/// The heading: what is shown, and the present values.
pub(super) fn title(
    canvas: &Canvas<'_>,
    q: &Quantities<'_>,
    ([x, y], title): ([usize; 2], &str),
    room: usize,
) -> Vec<Span> {
    let mut pieces = vec![vec![canvas.span(Role::Title, title)]];
    for channel in [x, y] {
        let value = readable(q.value(channel), 4, canvas.look.glyphs);
        pieces.push(vec![
            canvas.span(Role::Dim, format!("  {}", q.name(channel))),
            canvas.span(Role::Accent, format!(" {value:<8}")),
        ]);
    }
    pieces.push(marks::legend(canvas, q));
    groups(pieces, room)
}

/// Draws the picture, and says where its axes stand.
pub(super) fn draw(
    canvas: &mut Canvas<'_>,
    area: Rect,
    q: &Quantities<'_>,
    plot: &Plot,
) -> Option<Frame> {
    let Plot::Phase { x, y, viewport } = plot else { return None };
    let look = canvas.look;
    let landscape = q.lab.landscape(plot);
    let window = |axis: usize| landscape.map(|l| l.window[axis]);
    let axes =
        Axes::new(q.axis(*x, window(0), (*viewport, 0)), q.axis(*y, window(1), (*viewport, 1)));
    let axes = if viewport.equal { axes.equal() } else { axes };
    let frame = axes.draw(area, canvas.buffer, &look.theme, look.glyphs);
    let mut raster = Raster::new(frame.area, look.glyphs);
    if let Some(landscape) = landscape {
        levels(canvas, &mut raster, &frame, landscape);
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
    cursor::draw(canvas, area, &frame, (*viewport, &marks));
    Some(frame)
}

/// Separatrices, and as many levels of the energy as have room beside each other.
fn levels(canvas: &Canvas<'_>, raster: &mut Raster, frame: &Frame, landscape: &Landscape) {
    let look = canvas.look;
    let crowded = look.glyphs.pick(CROWDED[1], CROWDED[0]);
    let plain = Pen::new(Style::new(), 0);
    let trace = |raster: &mut Raster, curves: &[Curve], pen: &Pen| {
        for curve in curves {
            raster.polyline(frame, curve.iter().copied(), pen);
        }
    };
    let pen = Pen::shaded(look.theme.line(Role::Separatrix), SEPARATRIX);
    trace(raster, &landscape.separatrices, &pen);
    let pen = Pen::shaded(look.theme.line(Role::Level), LEVELS);
    if frame.area.area() > ROOMY && !look.glyphs.is_ascii() {
        landscape.levels.iter().for_each(|level| trace(raster, level, &pen));
        return;
    }
    let blank = Raster::new(frame.area, look.glyphs);
    let mut drawn = blank.clone();
    trace(&mut drawn, &landscape.separatrices, &plain);
    for level in &landscape.levels {
        // Curves that fill the same cells are no curves any more.
        let mut alone = blank.clone();
        trace(&mut alone, level, &plain);
        if alone.shared(&drawn) <= crowded {
            trace(raster, level, &pen);
            drawn.absorb(&alone);
        }
    }
}
