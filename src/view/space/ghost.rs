//! The motions beside the main one: what moves of each, as lines.
//!
//! In: the shapes of a scene, a motion. Out: dots. Never here: surfaces.

use super::body::Outline;
use super::{SOLID, ScenePainter, TRACK, circle, companions, scene};
use crate::model::{Point, Shape};
use crate::view::cache::FrameCache;
use crate::view::plot::{Marker, Pen};
use crate::view::quantity::Quantities;

impl ScenePainter<'_> {
    /// Draws what moves of a motion beside the main one: its lines, rims, edges, masses and tracks, in its colour. Its surfaces
    /// would hide the main one.
    pub(super) fn ghost(&mut self, shape: &Shape, main: &Quantities<'_>, cache: &mut FrameCache) {
        let q = self.q;
        // what rests is where that of the main motion is, unless the parameters differ
        let moves = |point: &Point| !scene::rests(q, point) || q.point(point) != main.point(point);
        let number = self.beside.unwrap_or(0);
        let pen = Pen::new(companions::ink(&self.q.style.theme, number), TRACK);
        match shape {
            Shape::Line { from, to } if moves(from) || moves(to) => {
                let (from, to) = (self.point(from), self.point(to));
                self.curve(&[from, to], &pen);
            }
            Shape::Spring { from, to } if moves(from) || moves(to) => {
                let (from, to) = (self.point(from), self.point(to));
                self.spring(from, to, &pen);
            }
            Shape::Mass { at, .. } if moves(at) => {
                let at = self.point(at);
                if let Some(pen) = self.seen_at(at, &Pen { layer: SOLID, ..pen }) {
                    let flat = self.flat(at);
                    self.raster.marker(&self.frame, flat, Marker::Number(number), &pen);
                }
            }
            Shape::Trace { at } => self.track(at, cache),
            // in space a circle that does not turn is scenery
            Shape::Circle { centre, radius, normal }
                if moves(normal) || moves(centre) && self.range.is_none() =>
            {
                let (centre, normal) = (self.point(centre), self.direction(normal));
                self.curve(&circle::circle(centre, self.q.number(*radius), normal), &pen);
            }
            Shape::Disc { centre: one, normal: other, .. }
            | Shape::Cone { tip: one, base: other, .. }
            | Shape::Cylinder { from: one, to: other, .. }
                if moves(one) || moves(other) =>
            {
                self.outline(shape, &pen);
            }
            Shape::Body { at } => {
                let Some(body) = Outline::of(q, self.eye) else { return };
                let at = self.q.point(at);
                for edge in body.pieces.iter().flat_map(|piece| &piece.edges) {
                    let edge: Vec<_> = edge.iter().map(|own| self.place(at, *own)).collect();
                    self.curve(&edge, &pen);
                }
            }
            _ => {}
        }
    }
}
