//! A potential: its curve along one coordinate, the energy as a line over it, and where the motion is allowed.
//!
//! In: the curve's values with all else held at the present, the energy, the present point. Out: cells. Never here:
//! what the potential is, or how its values are found.

use ratatui::layout::Rect;

use super::canvas::{Canvas, Span, groups};
use super::cursor;
use super::marks::Marks;
use super::number::readable;
use super::plot::ticks::nice_range;
use super::plot::{Axes, Axis, Frame, Marker, Pen, Raster, Scale};
use super::quantity::{Quantities, through};
use super::theme::Role;
use crate::app::{Potential, Viewport};

/// The layers of the picture, the lowest first.
const ALLOWED: u8 = 0;
const LEVEL: u8 = 1;
const CURVE: u8 = 2;
const NOW: u8 = 3;

/// Points of the curve.
const POINTS: usize = 240;

/// Share of the dots drawn where the motion is allowed.
const SHADE: f64 = 0.12;

/// What is shown beyond the turning points, in parts of the way between them.
const BEYOND: f64 = 0.4;

/// The heading: what is shown, and the present values.
pub(super) fn title(
    canvas: &Canvas<'_>,
    q: &Quantities<'_>,
    shown: &Potential,
    room: usize,
) -> Vec<Span> {
    let title = if shown.title.is_empty() { "Potential" } else { &shown.title };
    let mut pieces = vec![vec![canvas.span(Role::Title, title)]];
    let energy = readable(shown.energy, 4, canvas.look.glyphs);
    for (name, value) in [
        (q.name(shown.x), readable(q.value(shown.x), 4, canvas.look.glyphs)),
        (q.name(shown.y), readable(q.value(shown.y), 4, canvas.look.glyphs)),
        ("E".to_owned(), energy),
    ] {
        pieces.push(vec![
            canvas.span(Role::Dim, format!("  {name}")),
            canvas.span(Role::Accent, format!(" {value:<8}")),
        ]);
    }
    groups(pieces, room)
}

/// Draws the picture, and says where its axes stand.
pub(super) fn draw(
    canvas: &mut Canvas<'_>,
    area: Rect,
    q: &Quantities<'_>,
    (shown, viewport): (&Potential, Viewport),
) -> Frame {
    let look = canvas.look;
    let across = q.axis(shown.x, Some(across(q, shown.x)), (viewport, 0));
    let (from, to) = (across.scale.lo, across.scale.hi);
    let x = |i: usize| from + (to - from) * i as f64 / (POINTS - 1) as f64;
    let curve: Vec<[f64; 2]> = (0..POINTS).map(|i| [x(i), shown.at(q.lab, x(i))]).collect();
    let now = [q.value(shown.x), q.value(shown.y)];
    let upwards = Axis::new(
        q.name(shown.y),
        q.unit(shown.y),
        through(height(&curve, shown.energy, now[1]), (viewport, 1)),
    );
    let axes = Axes::new(across, upwards);
    let frame = axes.draw(area, canvas.buffer, &look.theme, look.glyphs);
    let mut raster = Raster::new(frame.area, look.glyphs);
    let (level, bright) = (look.theme.line(Role::Level), look.theme[Role::Accent]);
    for pair in curve.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let allowed = a[1] <= shown.energy && b[1] <= shown.energy;
        let [left, right] = [[a[0], shown.energy], [b[0], shown.energy]];
        if allowed {
            raster.line(&frame, a, left, &Pen::shaded(level, ALLOWED).covering(SHADE));
            raster.line(&frame, left, right, &Pen::new(look.theme[Role::Warn], LEVEL));
            raster.line(&frame, a, b, &Pen::new(bright, CURVE));
        } else {
            raster.line(&frame, left, right, &Pen::shaded(level, LEVEL));
            raster.line(&frame, a, b, &Pen::new(look.theme[Role::Text], CURVE));
        }
    }
    raster.marker(
        &frame,
        [now[0], shown.energy],
        Marker::Ring,
        &Pen::new(look.theme[Role::Warn], NOW),
    );
    raster.marker(&frame, now, Marker::Disc, &Pen::new(bright, NOW));
    raster.draw(canvas.buffer);
    cursor::draw(canvas, area, &frame, (viewport, &Marks::none()));
    frame
}

/// The range of a coordinate that does not repeat: somewhat more than the motion has reached.
fn across(q: &Quantities<'_>, channel: usize) -> [f64; 2] {
    if let Some(period) = q.period(channel) {
        return [-period / 2.0, period / 2.0];
    }
    let (lo, hi) = q.bounds(channel);
    let reached = (hi - lo).max(0.1 * lo.abs().max(hi.abs())).max(f64::MIN_POSITIVE);
    // What has kept its sign all the time, as a distance does, is not shown beyond zero.
    let low = lo - BEYOND * reached;
    let low = if lo > 0.0 { low.max(0.05 * lo) } else { low };
    [low, hi + BEYOND * reached]
}

/// From the bottom of the curve to well above the energy.
fn height(curve: &[[f64; 2]], energy: f64, now: f64) -> Scale {
    let finite = |v: &f64| v.is_finite();
    let values = curve.iter().map(|point| point[1]).filter(finite);
    let bottom = values.clone().fold(f64::INFINITY, f64::min).min(now).min(energy);
    let top = values.fold(f64::NEG_INFINITY, f64::max).max(energy);
    let deep = energy - bottom;
    let room = if deep > 1e-9 * energy.abs().max(bottom.abs()) { deep } else { top - bottom };
    let (lo, hi) =
        nice_range(bottom - 0.1 * room, (energy + 0.6 * room).min(top.max(energy + 0.1 * room)));
    Scale::linear(lo, hi)
}
