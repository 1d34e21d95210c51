//! The motions beside the main one: what moves of each, as lines.
//!
//! In: the shapes of a scene, a motion. Out: dots. Never here: surfaces.

use super::{SOLID, ScenePainter, TRACK, circle, companions, solid};
use crate::model::{Point, Shape};
use crate::view::cache::FrameCache;
use crate::view::plot::{Marker, Pen};
use crate::view::quantity::QuantitySource;

impl ScenePainter<'_> {
    /// Draws what moves of a motion beside the main one: its lines, rims, edges, masses and tracks, in its colour. Its surfaces
    /// would hide the main one.
    pub(super) fn ghost(&mut self, shape: &Shape, cache: &mut FrameCache) {
        let moves = |point: &Point| {
            point.iter().any(|e| matches!(self.q.place(*e), QuantitySource::Channel(_)))
        };
        let number = self.beside.unwrap_or(0);
        let pen = Pen::new(companions::ink(&self.q.look.theme, number), TRACK);
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
            Shape::Disc { centre, radius, normal } if moves(centre) || moves(normal) => {
                let (centre, normal) = (self.point(centre), self.direction(normal));
                let radius = self.q.number(*radius);
                let rim = self.rim(centre, radius, normal);
                self.edge(solid::disc(radius), |artist| artist.curve(&rim, &pen));
            }
            Shape::Cone { tip, base, radius } if moves(tip) || moves(base) => {
                let (tip, base) = (self.point(tip), self.point(base));
                let axis = [0, 1, 2].map(|k| base[k] - tip[k]);
                let radius = self.q.number(*radius);
                let rim = self.rim(base, radius, axis);
                self.edge(solid::along(tip, base, radius), |artist| {
                    artist.curve(&rim, &pen);
                    artist.silhouette(&vec![tip; rim.len()], &rim, &pen);
                });
            }
            Shape::Cylinder { from, to, radius } if moves(from) || moves(to) => {
                let ends = [self.point(from), self.point(to)];
                let radius = self.q.number(*radius);
                let [low, high] = solid::rims(ends, radius, self.spacing(radius));
                self.edge(solid::along(ends[0], ends[1], radius), |artist| {
                    artist.curve(&low, &pen);
                    artist.curve(&high, &pen);
                    artist.silhouette(&low, &high, &pen);
                });
            }
            _ => {}
        }
    }
}
