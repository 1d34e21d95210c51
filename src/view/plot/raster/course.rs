//! The course of a line: it breaks at gaps, wraps, clips and stays thin.
//!
//! In: successive data points, each with an ink. Out: calls with dots inside the plot. Never here: cells, or the
//! appearance of a dot.

use crate::view::plot::scale::{PlotFrame, Scale};
use crate::view::plot::stroke::{Tip, clip};

/// A dot's ink, and how the line ran through it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inked<Ink> {
    pub(super) ink: Ink,
    /// The axis along which the line, and thus its pattern, advances.
    pub(super) along: usize,
    /// The number of dots drawn as one: columns, rows.
    grid: [i32; 2],
}

impl<Ink> Inked<Ink> {
    pub(super) fn centre(&self, dot: [i32; 2]) -> [i32; 2] {
        let ([x, y], [wide, high]) = (dot, self.grid);
        [x * wide + wide / 2, y * high + high / 2]
    }
}

/// Follows points in data coordinates; [`Course::rest`] ends a line.
#[derive(Clone, Debug)]
pub(super) struct Course<Ink> {
    frame: PlotFrame,
    size: [i32; 2],
    /// The number of dots in one turn of each axis, if it is periodic.
    turns: [Option<f64>; 2],
    tip: Tip<Inked<Ink>>,
    at: Option<[f64; 2]>,
    /// The first point of a line, until there is a second.
    lone: Option<([f64; 2], Inked<Ink>)>,
}

impl<Ink: Copy> Course<Ink> {
    /// Creates a course without points over a raster of this many dots.
    pub(super) fn new(frame: &PlotFrame, size: [i32; 2]) -> Self {
        let turn = |scale: &Scale, dots: i32| Some(scale.turn_length()? * f64::from(dots));
        let turns = [turn(&frame.x, size[0]), turn(&frame.y, size[1])];
        Self { frame: *frame, size, turns, tip: Tip::lifted(), at: None, lone: None }
    }

    /// Continues the line to a point; `grid` is the number of dots drawn as one.
    pub(super) fn to(
        &mut self,
        point: [f64; 2],
        (ink, grid): (Ink, [i32; 2]),
        put: &mut impl FnMut([i32; 2], Inked<Ink>),
    ) {
        let next = self.frame.dot(point, self.size);
        if !next.iter().all(|v| v.is_finite()) {
            return self.rest(put);
        }
        let ink = Inked { ink, along: 0, grid };
        let Some(from) = self.at.replace(next) else {
            self.lone = Some((next, ink));
            return;
        };
        self.lone = None;
        let shift = self.wrapped(from, next);
        if shift == [0.0, 0.0] {
            self.stroke(from, next, ink, put);
        } else {
            // The line leaves at one edge and enters at the other.
            self.stroke(from, [next[0] - shift[0], next[1] - shift[1]], ink, put);
            self.tip.lift(&mut *put);
            self.stroke([from[0] + shift[0], from[1] + shift[1]], next, ink, put);
        }
    }

    /// Ends the line; a line of one point is a dot.
    pub(super) fn rest(&mut self, put: &mut impl FnMut([i32; 2], Inked<Ink>)) {
        if let Some((point, ink)) = self.lone.take() {
            self.stroke(point, point, ink, put);
        }
        self.tip.lift(put);
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

    fn stroke(
        &mut self,
        from: [f64; 2],
        next: [f64; 2],
        ink: Inked<Ink>,
        put: &mut impl FnMut([i32; 2], Inked<Ink>),
    ) {
        let [wide, high] = ink.grid;
        let count = [self.size[0] / wide, self.size[1] / high];
        let inside = clip(from, next, self.size.map(f64::from));
        let Some((a, b)) = inside.filter(|_| !count.contains(&0)) else {
            return self.tip.lift(put);
        };
        let (last, whole) = ([count[0] - 1, count[1] - 1], b[0] == next[0] && b[1] == next[1]);
        let on_grid = |[x, y]: [f64; 2]| [x / f64::from(wide), y / f64::from(high)];
        let (a, b) = (on_grid(a), on_grid(b));
        let along = usize::from((b[1] - a[1]).abs() > (b[0] - a[0]).abs());
        self.tip.follow((a, b), last, Inked { along, ..ink }, &mut *put);
        if !whole {
            self.tip.lift(put);
        }
    }
}
