//! The picture of any plot: what its instrument describes, in the characters and colours of this terminal.
//!
//! In: a plot, its picture as data, the trail. Out: cells, and the frame of the axes. Never here: what is specific to one
//! kind of plot.

use ratatui::layout::Rect;

use super::cache::{self, CrossingsKey, Track, TrailKey};
use super::canvas::{Canvas, StyledText, row, wide};
use super::ink::{colourless_mark, marker, pen};
use super::marks::Marks;
use super::names;
use super::number::with_powers;
use super::picture_title::keys_in;
use super::plot::ticks::nice_range;
use super::plot::{Ages, Axes, DrawnAxis, Pen, PlotFrame, Raster, Scale};
use super::quantity::{Quantities, through};
use super::theme::Role;
use super::time_window::time_window;
use super::{
    companions, cursor, field, legend, level_curves, placeholder, prediction, space, vector_field,
};
use crate::instrument::{Across, Ink, Layer, Level, MarkerShape, Picture, Plot, Upwards, Viewport};

/// The rows above the axes that keys may take.
const KEY_ROWS: usize = 3;

/// Writes the keys of curves, pairs of a mark and a name, above the axes: as far to the right as there is room for all of them, where
/// a curve may be in the way, else in the widest room. Those that a row has no room for stand in the next one, and over the picture
/// rather than nowhere.
fn keys_above(canvas: &mut Canvas<'_>, area: Rect, keys: &[StyledText]) {
    let mark = canvas.style.glyphs.pick("…", "~");
    let rows = KEY_ROWS.min(area.height.into());
    let mut rest = keys;
    for index in 0..rows {
        let here = row(area, index);
        let rooms = rooms(canvas, here);
        let is_last = index + 1 == rows;
        let all = rooms.iter().rfind(|(_, width)| usize::from(*width) >= wide(rest));
        let widest = all.or_else(|| rooms.iter().max_by_key(|(_, width)| *width)).copied();
        let over = is_last.then_some((here.x + 1, here.width.saturating_sub(1)));
        let Some((first, width)) = all.copied().or(over).or(widest) else { continue };
        let mut shown = keys_in(rest, width.into(), mark);
        let mut count = shown.len();
        while !is_last && count > 0 && wide(&shown[..count]) > width.into() {
            count -= 2.min(count);
        }
        shown.truncate(count);
        let used = width.min(wide(&shown) as u16);
        if used > 0 {
            let at = Rect { x: first + width - used, width: used, ..here };
            canvas.spans(at, &shown);
        }
        rest = &rest[count..];
        if rest.is_empty() {
            return;
        }
    }
}

/// Where a row is blank: the first column and the width of each part.
fn rooms(canvas: &Canvas<'_>, top: Rect) -> Vec<(u16, u16)> {
    let blank = |x: u16| canvas.buffer[(x, top.y)].symbol().trim().is_empty();
    let columns_of: Vec<u16> = (top.x..top.right()).collect();
    let rooms = columns_of.chunk_by(|a, b| blank(*a) == blank(*b)).filter(|room| blank(room[0]));
    // a blank keeps them apart from what is beside them
    let rooms = rooms.map(|room| {
        let last = room[room.len() - 1] + 1;
        let end = if last == top.right() { last } else { last - 1 };
        (room[0] + 1, end.saturating_sub(room[0] + 1))
    });
    rooms.collect()
}

/// Draws the picture with keys of curves above it, and returns the frame of its axes if it has any.
pub(super) fn draw(
    canvas: &mut Canvas<'_>,
    area: Rect,
    (q, plot): (&Quantities<'_>, &Plot),
    keys: &[StyledText],
) -> Option<PlotFrame> {
    let present = q.present();
    let context = q.lab.context(plot, &present);
    let viewport = plot.viewport().unwrap_or(Viewport::WHOLE);
    // a cursor needs the axes
    if let Some(words) = plot.kind.awaits(context).filter(|_| viewport.cursor.is_none()) {
        placeholder::draw(canvas, area, &words);
        return None;
    }
    let across = axis_across(q, plot.kind.across(context), viewport);
    let seen = across.as_ref().map_or([f64::NAN; 2], |axis| [axis.scale.lo, axis.scale.hi]);
    let Some(picture) = plot.kind.picture(context, seen) else {
        placeholder::draw(
            canvas,
            area,
            "There is nothing to show here. v chooses what this pane shows.",
        );
        return None;
    };
    let (upwards, layers, occurrences) = match picture {
        Picture::Scene(eye) => {
            space::draw(canvas, area, q, &eye);
            return None;
        }
        Picture::Axes { upwards, layers, occurrences } => (upwards, layers, occurrences),
    };
    let style = canvas.style;
    let (whole, zoomable) = (area, !q.lab.focus.zoomed);
    let (area, beside) = legend::beside(whole, (&layers, zoomable), canvas.style);
    let mut axes = Axes::new(across?, axis_upwards(q, &upwards, viewport));
    if let Across::Channel(x, None) = plot.kind.across(context)
        && let Upwards::Channel(y, None) = upwards
        && [x, y].iter().all(|&channel| q.period(channel).is_none())
    {
        let whole = [x, y].map(|channel| q.axis(channel, None, (Viewport::WHOLE, 0)).scale);
        if let Some([wide, high]) = names::in_reach(&layers, whole.map(|s| [s.lo, s.hi])) {
            let axis = |channel, range, k| q.axis(channel, Some(range), (viewport, k));
            axes = Axes::new(axis(x, wide, 0), axis(y, high, 1));
        }
    }
    let mut axes = if viewport.equal {
        // the window has its shape before it is moved, so that a part of its width is one of what is seen
        let still = |scale: Scale, k: usize| match viewport.pan[k] {
            0.0 => scale,
            pan => scale.panned(-pan),
        };
        (axes.x.scale, axes.y.scale) = (still(axes.x.scale, 0), still(axes.y.scale, 1));
        axes.equal().panned(viewport.pan)
    } else {
        axes
    };
    if let Across::Time = plot.kind.across(context) {
        let cells = axes.frame(area, style.glyphs).area.width;
        axes.x.scale = time_window(q, viewport, cells);
    }
    let frame = axes.draw(area, canvas.buffer, &style.theme, style.glyphs);
    let mut raster = Raster::new(frame.area, style.glyphs);
    let is_line = |(_, layer): &(Level, Layer)| matches!(layer, Layer::Line(..));
    for run in layers.chunk_by(|a, b| is_line(a) && is_line(b)) {
        if run.len() > 1 {
            draw_lines(canvas, &mut raster, (&frame, q), run);
        } else {
            for (level, layer) in run {
                draw_layer(canvas, &mut raster, (&frame, q), (*level, layer));
            }
        }
    }
    let marks = occurrences.map_or_else(Marks::none, |(level, columns)| {
        let place = |row: &[f64]| {
            let [x, y] = columns.map(|column| row.get(column.map_or(0, |c| 1 + c)).copied());
            Some([x?, y?])
        };
        let marks = Marks::of(q, place);
        marks.draw(&mut raster, &frame, &Pen::new(style.theme[Role::Warn], level));
        marks
    });
    prediction::draw(canvas, &mut raster, &frame, (q, plot));
    draw_field(canvas, &mut raster, &frame, &layers);
    raster.draw(canvas.buffer);
    prediction::label(canvas, &frame, (q, plot));
    names::draw(canvas, &frame, &layers);
    for (_, layer) in &layers {
        if let Layer::Legend(lines) = layer {
            let most = legend::most(whole, beside, zoomable);
            legend::draw(canvas, beside.unwrap_or(frame.area), (lines, most));
        }
    }
    let shades = layers.iter().flat_map(|(_, layer)| match layer {
        Layer::Field(found) => field::keys(canvas, found),
        _ => Vec::new(),
    });
    let keys: Vec<StyledText> = keys.iter().cloned().chain(shades).collect();
    keys_above(canvas, area, &keys);
    let reading = cursor::draw(canvas, area, &frame, (viewport, &marks));
    if q.lab.focused_plot().is_some_and(|(_, focused)| std::ptr::eq(focused, plot)) {
        canvas.reading = reading;
        let now = layers.iter().rev().find_map(|(_, layer)| match layer {
            Layer::Point(at, MarkerShape::Disc, Ink::Accent) => Some(*at),
            _ => None,
        });
        canvas.moving = now.map(|[x, y]| [frame.x.fraction(x), frame.y.fraction(y)]);
    }
    Some(frame)
}

fn axis_across(q: &Quantities<'_>, across: Across, viewport: Viewport) -> Option<DrawnAxis> {
    let time = |scale| DrawnAxis::new("t", q.lab.loaded.model.time_unit(), scale);
    match across {
        Across::Nothing => None,
        Across::Channel(channel, range) => Some(q.axis(channel, range, (viewport, 0))),
        Across::Times([from, to]) => Some(time(through(Scale::linear(from, to), (viewport, 0)))),
        Across::Named(name, [from, to]) => {
            let name = q.style.glyphs.text(&name).into_owned();
            Some(DrawnAxis::new(name, "", through(Scale::linear(from, to), (viewport, 0))))
        }
        Across::Time => Some(time(time_window(q, viewport, 1))),
    }
}

fn axis_upwards(q: &Quantities<'_>, upwards: &Upwards, viewport: Viewport) -> DrawnAxis {
    match upwards {
        Upwards::Channel(channel, range) => q.axis(*channel, *range, (viewport, 1)),
        Upwards::Shared(channels) => common_axis(q, channels, viewport),
        Upwards::Around(channel, [low, high]) => {
            let (lo, hi) = nice_range(*low, *high);
            let scale = through(Scale::linear(lo, hi), (viewport, 1));
            DrawnAxis::new(q.name(*channel), q.unit(*channel), scale)
        }
        Upwards::Annotated { channel, range, words } => {
            let axis = q.axis(*channel, *range, (viewport, 1));
            let words = q.style.glyphs.text(words);
            let unit =
                if axis.unit.is_empty() { String::new() } else { format!(" [{}]", axis.unit) };
            DrawnAxis::new(format!("{}{unit}   {words}", axis.title), "", axis.scale)
        }
        Upwards::Named(name, [low, high]) => {
            let (lo, hi) = nice_range(*low, *high);
            let name = with_powers(name, q.style.glyphs);
            let name = q.style.glyphs.text(&name);
            DrawnAxis::new(name, "", through(Scale::linear(lo, hi), (viewport, 1)))
        }
    }
}

/// Draws the arrows of a vector field where nothing else is.
fn draw_field(
    canvas: &mut Canvas<'_>,
    raster: &mut Raster,
    frame: &PlotFrame,
    layers: &[(Level, Layer)],
) {
    for (level, layer) in layers {
        let Layer::VectorField(field) = layer else { continue };
        let mut cache = std::mem::take(&mut canvas.cache);
        let arrows = cache.field(field, (frame, *level), || {
            let mut fresh = Raster::new(frame.area, canvas.style.glyphs);
            vector_field::arrows(canvas, &mut fresh, (frame, field), *level);
            fresh
        });
        raster.lay_blank(arrows);
        canvas.cache = cache;
    }
}

/// Draws lines that often are those of the last frame.
fn draw_lines(
    canvas: &mut Canvas<'_>,
    raster: &mut Raster,
    (frame, q): (&PlotFrame, &Quantities<'_>),
    lines: &[(Level, Layer)],
) {
    let mut cache = std::mem::take(&mut canvas.cache);
    raster.lay(cache.lines(lines, frame, || {
        let mut fresh = Raster::new(frame.area, canvas.style.glyphs);
        for (level, layer) in lines {
            draw_layer(canvas, &mut fresh, (frame, q), (*level, layer));
        }
        fresh
    }));
    canvas.cache = cache;
}

fn draw_layer(
    canvas: &mut Canvas<'_>,
    raster: &mut Raster,
    (frame, q): (&PlotFrame, &Quantities<'_>),
    (level, layer): (Level, &Layer),
) {
    let style = canvas.style;
    match layer {
        Layer::Landscape(landscape, every) => {
            let every = *every;
            let mut cache = std::mem::take(&mut canvas.cache);
            raster.lay(cache.levels(landscape, (frame, level, every), || {
                let mut fresh = Raster::new(frame.area, style.glyphs);
                level_curves::draw(canvas, &mut fresh, frame, (landscape, every), level);
                fresh
            }));
            canvas.cache = cache;
        }
        Layer::Nullclines(field, curves) => {
            let mut cache = std::mem::take(&mut canvas.cache);
            raster.lay(cache.field(field, (frame, level), || {
                let mut fresh = Raster::new(frame.area, style.glyphs);
                vector_field::nullclines(canvas, &mut fresh, (frame, field), *curves, level);
                fresh
            }));
            canvas.cache = cache;
        }
        Layer::Trail([x, y]) | Layer::RecentTrail([x, y], _) => {
            let rows = &q.snapshot.trail;
            let (track, begin) = match layer {
                Layer::RecentTrail(_, Some(time)) => {
                    (Track::Recent([*x, *y], *time), rows.order(*time))
                }
                _ => (Track::Channels([*x, *y]), f64::NEG_INFINITY),
            };
            let key = TrailKey { epoch: q.snapshot.epoch, motion: 0, frame: *frame, track };
            let trail = canvas.cache.trail(key, (rows, style.glyphs), |row| {
                let recent = rows.order(*row.first()?) >= begin;
                recent.then_some([*row.get(1 + x)?, *row.get(1 + y)?, 0.0])
            });
            let ramp = style.theme.trail(0);
            let since = cache::since(rows, ramp.len());
            let ages = Ages { since: &since, ramp, layer: level, behind: None };
            trail.draw(raster, ages, [q.value(*x), q.value(*y)]);
        }
        Layer::Curve { index, channel } => {
            let now = [q.snapshot.time, q.value(*channel)];
            let shade = style.theme.series(*index);
            let since = frame.x.lo - (frame.x.hi - frame.x.lo);
            let track = Track::Curve(*channel, shade.dash, since);
            let key = TrailKey { epoch: q.snapshot.epoch, motion: 0, frame: *frame, track };
            let trail = canvas.cache.trail(key, (&q.snapshot.trail, style.glyphs), |row| {
                Some([*row.first()?, *row.get(1 + channel)?, 0.0])
            });
            let since = [f64::MIN];
            trail.draw(raster, cache::whole(&since, &[shade], level), now);
        }
        Layer::Line(points, stroke) => {
            let pen = match stroke.ink {
                // Without colour, or where colours repeat, a curve differs from others by its dashes.
                Ink::Curve(index) => Pen::shaded(canvas.style.theme.series(index), level),
                ink => pen(canvas, ink, level),
            };
            let pen = match stroke.covering {
                Some(share) => pen.covering(share),
                None => pen,
            };
            raster.polyline(frame, points.iter().copied(), &pen);
        }
        Layer::Points(points, ink) => {
            let pen = pen(canvas, *ink, level);
            match colourless_mark(canvas, *ink) {
                Some(shape) => {
                    let pen = Pen { style: canvas.style(Role::Text), ..pen };
                    points.iter().for_each(|at| raster.marker(frame, *at, marker(shape), &pen));
                }
                None => raster.points(frame, points.iter().copied(), &pen),
            }
        }
        Layer::Cloud(points) => {
            raster.cloud(frame, points.iter().copied(), style.theme.density(), level);
        }
        Layer::Bands(points, curve) => {
            raster.bands(frame, points.iter().copied(), style.theme.trail(*curve), level);
        }
        Layer::Field(found) => field::draw(canvas, frame, found),
        Layer::Crossings { section, channels, ink } => {
            let (section, channels) = (*section, *channels);
            let pen = pen(canvas, *ink, level);
            let epoch = q.snapshot.epoch;
            let key = CrossingsKey { epoch, section, channels, frame: *frame, pen };
            let rows = q.snapshot.crossings.rows(section, q.snapshot.values.len());
            raster.lay_points(canvas.cache.crossings(key, style.glyphs, rows));
        }
        Layer::LastCrossing { section, channels, shape } => {
            if let Some(at) = crossings(q, *section, *channels).next_back() {
                raster.marker(frame, at, marker(*shape), &pen(canvas, Ink::Accent, level));
            }
        }
        Layer::Companions(channels) => {
            companions::trails(canvas, raster, (frame, q), (*channels, level));
        }
        Layer::CompanionCurves(channel) => {
            companions::curves(canvas, raster, (frame, q), (*channel, level));
        }
        Layer::CompanionCrossings { section, channels } => {
            companions::crossings(canvas, raster, (frame, q), (*section, *channels, level));
        }
        // written when the dots are there
        Layer::Legend(_) | Layer::Name(..) | Layer::VectorField(_) => {}
        Layer::Point(at, shape, ink) => {
            raster.marker(frame, *at, marker(*shape), &pen(canvas, *ink, level));
        }
    }
}

/// Where the running motion has crossed a surface of section.
fn crossings<'a>(
    q: &Quantities<'a>,
    section: usize,
    channels: [usize; 2],
) -> impl DoubleEndedIterator<Item = [f64; 2]> + 'a {
    let rows = q.snapshot.crossings.rows(section, q.snapshot.values.len());
    rows.map(move |row| channels.map(|channel| row[1 + channel]))
}

/// One axis for all quantities: their names are in the frame, and the axis has the unit if they share it.
fn common_axis(q: &Quantities<'_>, channels: &[usize], viewport: Viewport) -> DrawnAxis {
    if let [only] = channels {
        return q.axis(*only, None, (viewport, 1));
    }
    let axis = |channel: &usize| q.axis(*channel, None, (Viewport::WHOLE, 1));
    // what is zero but for rounding has room beside what is not
    let is_zero = |channel: &&usize| q.is_rounding_error(**channel);
    let zero = channels.iter().any(|channel| is_zero(&channel)).then_some(0.0);
    let moving: Vec<DrawnAxis> = channels.iter().filter(|c| !is_zero(c)).map(axis).collect();
    let (axes, zero) = if moving.is_empty() {
        (channels.iter().map(axis).collect(), None)
    } else {
        (moving, zero)
    };
    let ends = |end: fn(&Scale) -> f64| axes.iter().map(move |axis| end(&axis.scale)).chain(zero);
    let lo = ends(|scale| scale.lo).fold(f64::INFINITY, f64::min);
    let hi = ends(|scale| scale.hi).fold(f64::NEG_INFINITY, f64::max);
    let unit = channels.first().map_or("", |channel| q.unit(*channel));
    let shared = channels.iter().all(|channel| q.unit(*channel) == unit);
    DrawnAxis::new(
        "",
        if shared { unit } else { "" },
        through(Scale::linear(lo, hi), (viewport, 1)),
    )
}
