//! The motions beside the main one, in plots and in space: each in its colour, with its number where it is now.
//!
//! In: the companions of a snapshot. Out: dots and numbers on a raster. Never here: how they are computed, or the axes.

use ratatui::style::Style;

use super::cache::{self, Track, TrailKey};
use super::canvas::Canvas;
use super::glyphs::Glyphs;
use super::number::readable;
use super::plot::{Ages, Marker, Pen, PlotFrame, Raster};
use super::quantity::Quantities;
use super::theme::Theme;
use crate::analysis::DistanceHistory;
use crate::experiment::{Companion, Snapshot};
use crate::instrument::Level;
use crate::num::math;

/// The series of colours of companions: those that are farthest from the first two, of the main motion and its masses,
/// come first.
const SERIES: [usize; 6] = [4, 2, 5, 3, 6, 1];

pub(super) fn series(number: usize) -> usize {
    SERIES[(number.max(1) - 1) % SERIES.len()]
}

pub(super) fn ink(theme: &Theme, number: usize) -> Style {
    theme.curve(series(number))
}

/// Draws the past of two channels of each, and its number at the current point.
pub(super) fn trails(
    canvas: &mut Canvas<'_>,
    raster: &mut Raster,
    (frame, q): (&PlotFrame, &Quantities<'_>),
    ([x, y], level): ([usize; 2], Level),
) {
    let style = canvas.style;
    for one in q.snapshot.companions.iter() {
        let track = Track::Channels([x, y]);
        let (epoch, motion) = (q.snapshot.epoch, one.number);
        let key = TrailKey { epoch, motion, frame: *frame, track };
        let trail = canvas.cache.trail(key, (&one.trail, style.glyphs), |row| {
            Some([*row.get(1 + x)?, *row.get(1 + y)?, 0.0])
        });
        let ramp = style.theme.trail(series(one.number));
        let since = cache::since(&one.trail, ramp.len());
        let now = [x, y].map(|k| one.values.get(k).copied().unwrap_or(f64::NAN));
        let ages = Ages { since: &since, ramp, layer: level, behind: None };
        trail.draw(raster, ages, now);
        mark(raster, frame, (one, &style.theme), (now, level + 1));
    }
}

pub(super) fn curves(
    canvas: &mut Canvas<'_>,
    raster: &mut Raster,
    (frame, q): (&PlotFrame, &Quantities<'_>),
    (channel, level): (usize, Level),
) {
    let style = canvas.style;
    for one in q.snapshot.companions.iter() {
        let now = [one.time, one.values.get(channel).copied().unwrap_or(f64::NAN)];
        let shade = style.theme.series(series(one.number));
        let since = frame.x.lo - (frame.x.hi - frame.x.lo);
        let track = Track::Curve(channel, shade.dash, since);
        let (epoch, motion) = (q.snapshot.epoch, one.number);
        let key = TrailKey { epoch, motion, frame: *frame, track };
        let trail = canvas.cache.trail(key, (&one.trail, style.glyphs), |row| {
            Some([*row.first()?, *row.get(1 + channel)?, 0.0])
        });
        trail.draw(raster, cache::whole(&[f64::MIN], &[shade], level), now);
        mark(raster, frame, (one, &style.theme), (now, level + 1));
    }
}

/// Draws where each has crossed a surface of section.
pub(super) fn crossings(
    canvas: &Canvas<'_>,
    raster: &mut Raster,
    (frame, q): (&PlotFrame, &Quantities<'_>),
    (section, channels, level): (usize, [usize; 2], Level),
) {
    let theme = &canvas.style.theme;
    for one in q.snapshot.companions.iter() {
        let rows = one.crossings.rows(section, one.values.len());
        let points: Vec<[f64; 2]> = rows.map(|row| channels.map(|c| row[1 + c])).collect();
        raster.points(frame, points.iter().copied(), &Pen::new(ink(theme, one.number), level));
        if let Some(last) = points.last() {
            mark(raster, frame, (one, theme), (*last, level + 1));
        }
    }
}

fn mark(
    raster: &mut Raster,
    frame: &PlotFrame,
    (one, theme): (&Companion, &Theme),
    (at, level): ([f64; 2], Level),
) {
    let pen = Pen::new(ink(theme, one.number), level);
    raster.marker(frame, at, Marker::Number(one.number), &pen);
}

/// The snapshot as it would be if a companion were the main motion: what draws the one draws the other.
pub(super) fn as_main(snapshot: &Snapshot, one: &Companion) -> Snapshot {
    Snapshot {
        time: one.time,
        values: std::sync::Arc::clone(&one.values),
        parameters: std::sync::Arc::clone(&one.parameters),
        trail: one.trail.clone(),
        ..snapshot.clone()
    }
}

/// A companion in words: its name, its distance from the main motion, and the rest.
pub(super) fn words(
    one: &Companion,
    separation: &DistanceHistory,
    glyphs: Glyphs,
) -> (String, String, String) {
    let name = format!("{}, {}", one.number, one.origin.word());
    if let Some(message) = &one.message {
        return (name, "ended".to_owned(), glyphs.text(message).into_owned());
    }
    let last = separation.points().last();
    let distance = last.map_or_else(|| "0".to_owned(), |p| readable(math::exp(p[1]), 4, glyphs));
    let slope = separation.slope().map_or_else(String::new, |slope| {
        let rate = readable(slope.rate, 3, glyphs);
        format!("slope of ln d {rate}, grown by e^{:.1}; ", slope.grown)
    });
    (
        name,
        format!("d = {distance}"),
        format!("{slope}by {}, t = {}", one.method, readable(one.time, 6, glyphs)),
    )
}
