//! A time series: quantities against time, each in its colour, named in the frame.
//!
//! In: channels and the trail. Out: cells. Never here: how the trail is recorded.

use ratatui::layout::Rect;

use super::canvas::{Canvas, Span, groups, wide};
use super::colour::ColourDepth;
use super::cursor;
use super::marks::{self, Marks};
use super::number::readable;
use super::plot::{Axes, Axis, Frame, Marker, Pen, Raster, Scale};
use super::quantity::{Quantities, through};
use super::theme::Role;
use crate::app::Viewport;

/// For how many seconds of the wall clock, at the file's own speed, the window reaches back.
const SECONDS: f64 = 20.0;

/// The layer of marks, above all curves but below where they are now.
const MARK: u8 = 201;
const NOW: u8 = 202;

/// The heading: each quantity in its colour with its present value; where not all have room, without the values.
pub(super) fn title(
    canvas: &Canvas<'_>,
    q: &Quantities<'_>,
    (channels, title): (&[usize], Option<&str>),
    room: usize,
) -> Vec<Span> {
    let head = |title: &str| vec![canvas.span(Role::Title, title)];
    let named =
        || channels.iter().enumerate().map(|(index, channel)| key(canvas, q, index, *channel));
    let valued = named().zip(channels).map(|(mut key, channel)| {
        let value = readable(q.value(*channel), 4, canvas.look.glyphs);
        key.push(canvas.span(Role::Accent, format!(" {value:<8}")));
        key
    });
    let (valued, mut named): (Vec<_>, Vec<_>) = (valued.collect(), named().collect());
    let whole = [head(title.unwrap_or("Time")), valued.concat()].concat();
    let pieces = if wide(&whole) <= room {
        [vec![head(title.unwrap_or("Time"))], valued, vec![marks::legend(canvas, q)]].concat()
    } else if let Some(title) = title {
        [vec![head(title)], named].concat()
    } else {
        // What a curve is called is worth more than that it runs with time.
        if let Some((first, _)) = named.first_mut().and_then(|key| key.first_mut()) {
            *first = first.trim_start().to_owned();
        }
        named
    };
    groups(pieces, room)
}

/// How a curve is drawn, and what it is called.
fn key(canvas: &Canvas<'_>, q: &Quantities<'_>, index: usize, channel: usize) -> Vec<Span> {
    let theme = &canvas.look.theme;
    let [unicode, ascii] = theme.series(index).dash.sample();
    let sample = canvas.look.glyphs.pick(unicode, ascii);
    // A colour is seen on one character, a pattern on three.
    let plain = theme.depth() != ColourDepth::None;
    let mark = if plain { canvas.look.glyphs.pick("━", "-") } else { sample };
    vec![(format!("  {mark} "), theme.curve(index)), canvas.span(Role::Dim, q.name(channel))]
}

/// Draws the picture, and says where its axes stand.
pub(super) fn draw(
    canvas: &mut Canvas<'_>,
    area: Rect,
    q: &Quantities<'_>,
    (channels, viewport): (&[usize], Viewport),
) -> Frame {
    let look = canvas.look;
    let time = Axis::new("t", q.lab.loaded.model.time_unit(), window(q, viewport));
    let axes = Axes::new(time, common_axis(q, channels, viewport));
    let frame = axes.draw(area, canvas.buffer, &look.theme, look.glyphs);
    let mut raster = Raster::new(frame.area, look.glyphs);
    for (index, channel) in channels.iter().enumerate().rev() {
        let layer = (channels.len() - index).min(200) as u8;
        let now = [q.snapshot.time, q.value(*channel)];
        let rows = q.snapshot.trail.rows();
        let points = rows.filter_map(|row| Some([*row.first()?, *row.get(1 + channel)?]));
        let shown = points.filter(|point| point[0] >= frame.x.lo - (frame.x.hi - frame.x.lo));
        let pen = Pen::shaded(look.theme.series(index), layer);
        raster.polyline(&frame, shown.chain([now]), &pen);
        raster.marker(&frame, now, Marker::Disc, &Pen::new(look.theme.curve(index), NOW));
    }
    let first = channels.first().copied().unwrap_or_default();
    let marks = Marks::of(q, |row| Some([*row.first()?, *row.get(1 + first)?]));
    marks.draw(&mut raster, &frame, &Pen::new(look.theme[Role::Warn], MARK));
    raster.draw(canvas.buffer);
    cursor::draw(canvas, area, &frame, (viewport, &marks));
    frame
}

/// The stretch of time shown: it stands still until it is full, then moves along.
fn window(q: &Quantities<'_>, viewport: Viewport) -> Scale {
    let speed = q.lab.loaded.model.run.speed;
    let span = SECONDS * if speed.is_finite() && speed > 0.0 { speed } else { 1.0 };
    let start = q.lab.loaded.model.run.start;
    let end = q.snapshot.time.max(start + span);
    let span = span / viewport.zoom[0];
    let shift = viewport.pan[0] * span;
    Scale::linear(end - span + shift, end + shift)
}

/// One axis for all quantities: their names stand in the frame, the unit here if they share it.
fn common_axis(q: &Quantities<'_>, channels: &[usize], viewport: Viewport) -> Axis {
    if let [only] = channels {
        return q.axis(*only, None, (viewport, 1));
    }
    let axes: Vec<Axis> = channels.iter().map(|c| q.axis(*c, None, (Viewport::WHOLE, 1))).collect();
    let lo = axes.iter().map(|axis| axis.scale.lo).fold(f64::INFINITY, f64::min);
    let hi = axes.iter().map(|axis| axis.scale.hi).fold(f64::NEG_INFINITY, f64::max);
    let unit = axes.first().map_or("", |axis| &axis.unit);
    let shared = axes.iter().all(|axis| axis.unit == unit);
    Axis::new("", if shared { unit } else { "" }, through(Scale::linear(lo, hi), (viewport, 1)))
}
