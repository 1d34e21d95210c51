//! A cache between frames, of what is drawn until what it shows changes: drawn trails and crossings, level curves, lines of pictures,
//! the text of the law.
//!
//! In: the recorded motion, and what decides how it is drawn. Out: the same picture as without it, at the cost of what
//! is new. Never here: anything that is not a pure function of the application and the render style.

mod crossings;

use std::sync::Arc;

use ratatui::style::Style;

use super::RenderStyle;
use super::glyphs::Glyphs;
use super::plot::{Ages, CachedTrail, Camera, PlotFrame, Raster};
use super::quantity::QuantitySource;
use super::theme::{Dash, Shade};
use crate::analysis::Landscape;
use crate::experiment::Trail;
use crate::instrument::{Layer, Level, PlaneField};
use crate::mechanics::Equations;
pub(super) use crossings::CrossingsKey;
use crossings::{DrawnCrossings, same};

/// The widths at which the text of the law is kept.
const LAWS: usize = 2;

/// The styled pieces of a row of text.
type Row = Vec<(String, Style)>;

/// What was drawn in the last frames.
#[derive(Debug, Default)]
pub(super) struct FrameCache {
    style: Option<CachedStyle>,
    trails: Vec<CachedEntry<TrailKey, DrawnTrail>>,
    levels: Vec<CachedEntry<LevelsKey, Raster>>,
    fields: Vec<CachedEntry<FieldKey, Raster>>,
    lines: Vec<CachedEntry<LinesKey, Raster>>,
    crossings: Vec<CachedEntry<CrossingsKey, DrawnCrossings>>,
    /// The law as laid out for a pane, and for its first line alone.
    law: Vec<(LawKey, Vec<Row>)>,
    /// How many rows of trails have been stroked.
    stroked: u64,
}

/// The parts of a render style that decide how what is cached looks.
#[derive(Debug, PartialEq)]
struct CachedStyle {
    palette: &'static str,
    trail: Vec<Shade>,
    glyphs: Glyphs,
}

/// An entry, and whether the current frame needed it.
#[derive(Debug)]
struct CachedEntry<Key, Value> {
    key: Key,
    value: Value,
    used: bool,
}

/// What a trail is drawn from, and where.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TrailKey {
    pub(super) epoch: u64,
    /// The number of a motion beside the main one; 0 for the main one.
    pub(super) motion: usize,
    pub(super) frame: PlotFrame,
    pub(super) track: Track,
}

/// The past of what is drawn.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Track {
    Channels([usize; 2]),
    /// Of two channels from a time on.
    Recent([usize; 2], f64),
    /// Of a channel against time, with the pattern of its line, from a time on.
    Curve(usize, Dash, f64),
    /// Of a point in space, through a camera in a reference frame.
    Point([QuantitySource; 3], Camera, Option<usize>),
}

/// A drawn trail, and the rows by which its continuation is known.
#[derive(Debug)]
struct DrawnTrail {
    trail: CachedTrail,
    first: Vec<f64>,
    last: Vec<f64>,
}

#[derive(Debug)]
struct LevelsKey {
    landscape: Arc<Landscape>,
    frame: PlotFrame,
    level: u8,
    /// Which part of the levels is drawn: one in so many.
    every: usize,
}

/// Where the strokes or the nullclines of a vector field are drawn.
#[derive(Debug)]
struct FieldKey {
    field: Arc<PlaneField>,
    frame: PlotFrame,
    level: u8,
}

/// Lines of a picture, and where they are drawn.
#[derive(Debug)]
struct LinesKey {
    lines: Vec<(Level, Layer)>,
    frame: PlotFrame,
}

/// The law whose text is cached, and its width in columns.
#[derive(Debug)]
struct LawKey {
    equations: Arc<Equations>,
    width: u16,
}

impl FrameCache {
    /// Begins a frame. Nothing stays of another theme or other characters.
    pub(super) fn begin(&mut self, style: &RenderStyle) {
        let style = CachedStyle {
            palette: style.theme.palette().name,
            trail: style.theme.trail(0).to_vec(),
            glyphs: style.glyphs,
        };
        if self.style.as_ref() != Some(&style) {
            *self = Self { style: Some(style), stroked: self.stroked, ..Self::default() };
        }
        self.trails.iter_mut().for_each(|entry| entry.used = false);
        self.levels.iter_mut().for_each(|entry| entry.used = false);
        self.fields.iter_mut().for_each(|entry| entry.used = false);
        self.lines.iter_mut().for_each(|entry| entry.used = false);
        self.crossings.iter_mut().for_each(|entry| entry.used = false);
    }

    /// Ends a frame: what it did not need is dropped.
    pub(super) fn end(&mut self) {
        self.trails.retain(|entry| entry.used);
        self.levels.retain(|entry| entry.used);
        self.fields.retain(|entry| entry.used);
        self.lines.retain(|entry| entry.used);
        self.crossings.retain(|entry| entry.used);
    }

    /// The trail of a motion, carried on to its newest row; `locate` gives the point of a row: right, up, towards the
    /// eye.
    pub(super) fn trail(
        &mut self,
        key: TrailKey,
        (rows, glyphs): (&Trail, Glyphs),
        locate: impl Fn(&[f64]) -> Option<[f64; 3]>,
    ) -> &CachedTrail {
        let found = self.trails.iter().position(|entry| entry.key == key);
        let index = found.unwrap_or_else(|| {
            let value = DrawnTrail::empty(&key, glyphs);
            self.trails.push(CachedEntry { key, value, used: true });
            self.trails.len() - 1
        });
        let CachedEntry { key, value, used } = &mut self.trails[index];
        *used = true;
        let new = value.continuation(rows).unwrap_or_else(|| {
            *value = DrawnTrail::empty(key, glyphs);
            match key.track {
                Track::Curve(_, _, from) => {
                    rows.rows().rev().take_while(|row| row.first() >= Some(&from)).count()
                }
                _ => rows.len(),
            }
        });
        self.stroked += value.carry_on(rows, new, locate);
        &value.trail
    }

    /// How many rows of trails have been stroked since the first frame.
    pub(super) fn stroked(&self) -> u64 {
        self.stroked
    }

    /// The raster of level curves, drawn where it is not known yet.
    pub(super) fn levels(
        &mut self,
        landscape: &Arc<Landscape>,
        (frame, level, every): (&PlotFrame, u8, usize),
        draw: impl FnOnce() -> Raster,
    ) -> &Raster {
        let same = |entry: &CachedEntry<LevelsKey, Raster>| {
            Arc::ptr_eq(&entry.key.landscape, landscape)
                && entry.key.frame == *frame
                && (entry.key.level, entry.key.every) == (level, every)
        };
        let index = self.levels.iter().position(same).unwrap_or_else(|| {
            let key = LevelsKey { landscape: Arc::clone(landscape), frame: *frame, level, every };
            self.levels.push(CachedEntry { key, value: draw(), used: true });
            self.levels.len() - 1
        });
        self.levels[index].used = true;
        &self.levels[index].value
    }

    /// The raster of what a level shows of a vector field, drawn where it is not known yet.
    pub(super) fn field(
        &mut self,
        field: &Arc<PlaneField>,
        (frame, level): (&PlotFrame, u8),
        draw: impl FnOnce() -> Raster,
    ) -> &Raster {
        let same = |entry: &CachedEntry<FieldKey, Raster>| {
            entry.key.field.is_same(field) && entry.key.frame == *frame && entry.key.level == level
        };
        let index = self.fields.iter().position(same).unwrap_or_else(|| {
            let key = FieldKey { field: Arc::clone(field), frame: *frame, level };
            self.fields.push(CachedEntry { key, value: draw(), used: true });
            self.fields.len() - 1
        });
        self.fields[index].used = true;
        &self.fields[index].value
    }

    /// The raster of lines, drawn where they are not those of the last frame.
    pub(super) fn lines(
        &mut self,
        lines: &[(Level, Layer)],
        frame: &PlotFrame,
        draw: impl FnOnce() -> Raster,
    ) -> &Raster {
        let same = |entry: &CachedEntry<LinesKey, Raster>| {
            entry.key.frame == *frame
                && entry.key.lines.len() == lines.len()
                && entry.key.lines.iter().zip(lines).all(|(a, b)| same_line(a, b))
        };
        let index = self.lines.iter().position(same).unwrap_or_else(|| {
            let key = LinesKey { lines: lines.to_vec(), frame: *frame };
            self.lines.push(CachedEntry { key, value: draw(), used: true });
            self.lines.len() - 1
        });
        self.lines[index].used = true;
        &self.lines[index].value
    }

    /// The raster of where a motion has crossed a surface, with what is new of it. A row of crossings begins with their time.
    pub(super) fn crossings<'a>(
        &mut self,
        key: CrossingsKey,
        glyphs: Glyphs,
        rows: impl DoubleEndedIterator<Item = &'a [f64]> + Clone,
    ) -> &Raster {
        let index = self.crossings.iter().position(|entry| entry.key == key).unwrap_or_else(|| {
            let value = DrawnCrossings::empty(&key, glyphs);
            self.crossings.push(CachedEntry { key, value, used: true });
            self.crossings.len() - 1
        });
        let CachedEntry { key, value, used } = &mut self.crossings[index];
        *used = true;
        value.carry_on(key, glyphs, rows)
    }

    /// The rows of the law's text at a width, made where they are not known yet.
    pub(super) fn law(
        &mut self,
        equations: &Arc<Equations>,
        width: u16,
        make: impl FnOnce() -> Vec<Row>,
    ) -> &[Row] {
        let same = |(key, _): &(LawKey, Vec<Row>)| {
            Arc::ptr_eq(&key.equations, equations) && key.width == width
        };
        let known = self.law.iter().position(same);
        let at = known.unwrap_or_else(|| {
            if self.law.len() == LAWS {
                self.law.remove(0);
            }
            let key = LawKey { equations: Arc::clone(equations), width };
            self.law.push((key, make()));
            self.law.len() - 1
        });
        &self.law[at].1
    }
}

impl DrawnTrail {
    fn empty(key: &TrailKey, glyphs: Glyphs) -> Self {
        let line = match key.track {
            Track::Curve(_, dash, _) => Some(dash),
            Track::Channels(_) | Track::Recent(..) | Track::Point(..) => None,
        };
        let trail = CachedTrail::new(&key.frame, glyphs, line);
        Self { trail, first: Vec::new(), last: Vec::new() }
    }

    /// The number of rows after the last one drawn; `None` if these rows do not continue what is drawn.
    ///
    /// The rows of one motion are distinguished from those of another by their bits: the last drawn row must be among them, and
    /// the oldest must be the first one drawn or a later one.
    fn continuation(&self, rows: &Trail) -> Option<usize> {
        let (oldest, began) = (rows.row(0)?, self.first.first()?);
        if rows.order(oldest[0]) < rows.order(*began)
            || oldest[0] == *began && !same(oldest, &self.first)
        {
            return None;
        }
        for (count, row) in rows.rows().rev().enumerate() {
            if same(row, &self.last) {
                return Some(count);
            }
            if rows.order(row[0]) < rows.order(self.last[0]) {
                return None;
            }
        }
        None
    }

    /// Draws the newest rows, and returns how many these are.
    fn carry_on(
        &mut self,
        rows: &Trail,
        count: usize,
        locate: impl Fn(&[f64]) -> Option<[f64; 3]>,
    ) -> u64 {
        if self.first.is_empty() {
            self.first = rows.row(0).unwrap_or_default().to_vec();
        }
        // from the end: an index would be searched for among the chunks
        let newest: Vec<&[f64]> = rows.rows().rev().take(count).collect();
        for row in newest.iter().rev() {
            if let Some(point) = locate(row) {
                self.trail.to(point, rows.order(row[0]));
            }
        }
        if let Some(&newest) = newest.first() {
            newest.clone_into(&mut self.last);
        }
        newest.len() as u64
    }
}

fn same_line((level, layer): &(Level, Layer), (other_level, other): &(Level, Layer)) -> bool {
    match (layer, other) {
        (Layer::Line(points, stroke), Layer::Line(others, other_stroke)) => {
            // by bits: what is not a number equals itself
            let mut pairs = points.iter().zip(others);
            let same = points.len() == others.len() && pairs.all(|(a, b)| same(a, b));
            level == other_level && stroke == other_stroke && same
        }
        _ => false,
    }
}

/// The times from which the rows of a trail have each age, for its rows and the current state after them.
pub(super) fn since(rows: &Trail, ages: usize) -> Vec<f64> {
    let count = rows.len() + 1;
    let begins =
        |age: usize| rows.row(age * count / ages).map_or(f64::INFINITY, |row| rows.order(row[0]));
    (0..ages).map(begins).collect()
}

/// Draws a line of one age, from a time on.
pub(super) fn whole<'a>(since: &'a [f64; 1], ramp: &'a [Shade; 1], layer: u8) -> Ages<'a> {
    Ages { since, ramp, layer, behind: None }
}
