//! The polyline: a line drawn at once, each part with its pen.
//!
//! In: successive data points, each with its pen. Out: dots of a raster. Never here: the course of the line.

use super::course::{Course, Inked};
use super::letter::stroke;
use super::{Letters, Pen, Raster};
use crate::view::glyphs::Glyphs;
use crate::view::plot::scale::PlotFrame;

/// The coverage below which a line is shading and, in ASCII, drawn as single dots.
const FAINT: f64 = 0.3;

impl Raster {
    /// Draws a straight line between two points of the frame, clipped.
    pub fn line(&mut self, frame: &PlotFrame, a: [f64; 2], b: [f64; 2], pen: &Pen) {
        self.polyline(frame, [a, b], pen);
    }

    /// Draws a line through points. It is broken at points without a position (NaN) and where it wraps around an axis.
    pub fn polyline(
        &mut self,
        frame: &PlotFrame,
        points: impl IntoIterator<Item = [f64; 2]>,
        pen: &Pen,
    ) {
        let mut line = Polyline::new(self, frame);
        for point in points {
            line.to(point, pen);
        }
        line.rest();
    }

    /// Draws a line through points, each with the number of the pen that leads to it.
    pub fn polyline_in(
        &mut self,
        frame: &PlotFrame,
        points: impl IntoIterator<Item = ([f64; 2], usize)>,
        pens: &[Pen],
    ) {
        let mut line = Polyline::new(self, frame);
        for (point, pen) in points {
            if let Some(pen) = pens.get(pen) {
                line.to(point, pen);
            }
        }
        line.rest();
    }
}

/// Draws a line through points in data coordinates; [`Polyline::rest`] ends it.
struct Polyline<'a, 'p> {
    raster: &'a mut Raster,
    course: Course<DotStyle<'p>>,
    frame: PlotFrame,
    /// The last point in dots, from which the direction of the line is taken.
    last: [f64; 2],
}

impl<'a, 'p> Polyline<'a, 'p> {
    /// Creates a polyline without points.
    fn new(raster: &'a mut Raster, frame: &PlotFrame) -> Self {
        let course = Course::new(frame, raster.size());
        Self { raster, course, frame: *frame, last: [f64::NAN; 2] }
    }

    /// Continues the line to a point.
    fn to(&mut self, point: [f64; 2], pen: &'p Pen) {
        let sign = self.sign(pen, point);
        // Lines of characters are drawn cell by cell.
        let grid = if sign.is_some() { self.raster.cell() } else { [1, 1] };
        let raster = &mut *self.raster;
        self.course.to(point, (DotStyle { pen, sign }, grid), &mut |dot, inked| {
            inked.put(raster, dot);
        });
    }

    /// Ends the line; a line of one point is a dot.
    fn rest(&mut self) {
        let raster = &mut *self.raster;
        self.course.rest(&mut |dot, inked| inked.put(raster, dot));
    }

    /// The ASCII character for one of several lines, or for the direction to a point.
    fn sign(&mut self, pen: &Pen, point: [f64; 2]) -> Option<char> {
        if self.raster.glyphs != Glyphs::Ascii {
            return None;
        }
        let faint = (pen.coverage < FAINT || pen.letters == Letters::Dots).then_some('.');
        let known = pen.dash.letter().or(faint);
        if known.is_some() || pen.letters != Letters::Direction {
            return known;
        }
        let cell = self.raster.cell();
        let next = self.frame.dot(point, self.raster.size());
        let along = [0, 1].map(|k| (next[k] - self.last[k]) / f64::from(cell[k]));
        self.last = next;
        Some(stroke(along, next[1] / f64::from(cell[1])))
    }
}

/// How a dot of a line is drawn.
#[derive(Clone, Copy)]
struct DotStyle<'p> {
    pen: &'p Pen,
    sign: Option<char>,
}

impl Inked<DotStyle<'_>> {
    /// Draws a dot of a line unless it is in a gap of the pattern.
    fn put(&self, raster: &mut Raster, dot: [i32; 2]) {
        if self.ink.sign.is_some() || self.ink.pen.dash.covers(dot[self.along]) {
            raster.ink(self.centre(dot), self.ink.pen, self.ink.sign);
        }
    }
}
