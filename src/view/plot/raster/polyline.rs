//! The polyline: it breaks at gaps, wraps, clips and stays thin.
//!
//! In: successive data points, each with its pen. Out: dots of a raster. Never here: the appearance of a dot.

use super::{Pen, Raster, position};
use crate::view::glyphs::Glyphs;
use crate::view::plot::scale::{Frame, Scale};
use crate::view::plot::stroke::{Tip, clip};

/// The coverage below which a line is shading and, in ASCII, drawn as single dots.
const FAINT: f64 = 0.3;

/// Draws a line through points in data coordinates; [`Polyline::rest`] ends it.
pub(super) struct Polyline<'a, 'p> {
    raster: &'a mut Raster,
    frame: Frame,
    size: [i32; 2],
    /// The number of dots in one turn of each axis, if it is periodic.
    turns: [Option<f64>; 2],
    tip: Tip<DotStyle<'p>>,
    at: Option<[f64; 2]>,
    /// The first point of a line, until there is a second.
    lone: Option<([f64; 2], &'p Pen)>,
    /// The age and the number of ages of a trail, which choose the character in ASCII.
    fading: Option<(usize, usize)>,
}

impl<'a, 'p> Polyline<'a, 'p> {
    /// Creates a polyline without points.
    pub(super) fn new(raster: &'a mut Raster, frame: &Frame) -> Self {
        let size = raster.size();
        let turn = |scale: &Scale, dots: i32| Some(scale.turn_length()? * f64::from(dots));
        let turns = [turn(&frame.x, size[0]), turn(&frame.y, size[1])];
        let tip = Tip::lifted();
        Self { raster, frame: *frame, size, turns, tip, at: None, lone: None, fading: None }
    }

    /// Sets the age of the following part of the line, one of `ages` steps.
    pub(super) fn fade(&mut self, age: usize, ages: usize) {
        self.fading = Some((age, ages));
    }

    /// Continues the line to a point.
    pub(super) fn to(&mut self, point: [f64; 2], pen: &'p Pen) {
        let next = position(&self.frame, point, self.size);
        if !next.iter().all(|v| v.is_finite()) {
            return self.rest();
        }
        let Some(from) = self.at.replace(next) else {
            self.lone = Some((next, pen));
            return;
        };
        self.lone = None;
        let shift = self.wrapped(from, next);
        if shift == [0.0, 0.0] {
            self.stroke(from, next, pen);
        } else {
            // The line leaves at one edge and enters at the other.
            self.stroke(from, [next[0] - shift[0], next[1] - shift[1]], pen);
            self.lift();
            self.stroke([from[0] + shift[0], from[1] + shift[1]], next, pen);
        }
    }

    /// Ends the line; a line of one point is a dot.
    pub(super) fn rest(&mut self) {
        if let Some((point, pen)) = self.lone.take() {
            self.stroke(point, point, pen);
        }
        self.lift();
        self.at = None;
    }

    /// The shift of `next` by wrapping, in dots; a jump of more than half a turn counts as a wrap.
    fn wrapped(&self, from: [f64; 2], next: [f64; 2]) -> [f64; 2] {
        let turn = |axis: usize| {
            let Some(turn) = self.turns[axis] else { return 0.0 };
            let jump = next[axis] - from[axis];
            if jump.abs() > turn / 2.0 { turn.copysign(jump) } else { 0.0 }
        };
        [turn(0), turn(1)]
    }

    fn stroke(&mut self, from: [f64; 2], next: [f64; 2], pen: &'p Pen) {
        let sign = self.sign(pen);
        // Lines of characters are drawn cell by cell.
        let grid = if sign.is_some() { self.raster.cell() } else { [1, 1] };
        let count = [0, 1].map(|i| self.size[i] / grid[i]);
        let inside = clip(from, next, self.size.map(f64::from));
        let Some((a, b)) = inside.filter(|_| !count.contains(&0)) else { return self.lift() };
        let (last, whole) = (count.map(|n| n - 1), b == next);
        let [a, b] = [a, b].map(|point| [0, 1].map(|i| point[i] / f64::from(grid[i])));
        // The axis along which the line, and thus its pattern, advances.
        let along = usize::from((b[1] - a[1]).abs() > (b[0] - a[0]).abs());
        let ink = DotStyle { pen, sign, along, grid };
        let raster = &mut *self.raster;
        self.tip.follow((a, b), last, ink, |dot, ink| ink.put(raster, dot));
        if !whole {
            self.lift();
        }
    }

    /// The ASCII character for the age of a trail, or for one of several lines.
    fn sign(&self, pen: &Pen) -> Option<char> {
        if self.raster.glyphs != Glyphs::Ascii {
            return None;
        }
        let faint = (pen.coverage < FAINT).then_some('.');
        self.fading.map(|(age, ages)| faded(age, ages)).or(pen.dash.letter()).or(faint)
    }

    fn lift(&mut self) {
        let raster = &mut *self.raster;
        self.tip.lift(|dot, ink| ink.put(raster, dot));
    }
}

/// How a dot of a line is drawn.
#[derive(Clone, Copy)]
struct DotStyle<'p> {
    pen: &'p Pen,
    sign: Option<char>,
    along: usize,
    grid: [i32; 2],
}

impl DotStyle<'_> {
    /// Draws a dot of a line unless it is in a gap of the pattern.
    fn put(&self, raster: &mut Raster, dot: [i32; 2]) {
        if self.sign.is_some() || self.pen.dash.covers(dot[self.along]) {
            // The centre of its cell.
            let dot = [0, 1].map(|i| dot[i] * self.grid[i] + self.grid[i] / 2);
            raster.ink(dot, self.pen, self.sign);
        }
    }
}

/// The ASCII character for the age of a trail.
fn faded(age: usize, ages: usize) -> char {
    const AGES: [char; 4] = ['.', ':', '+', 'o'];
    AGES[(age * AGES.len() / ages.max(1)).min(AGES.len() - 1)]
}
