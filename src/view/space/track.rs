//! The track of a point: where it has been, as seen from the reference frame.
//!
//! In: the kept rows of the motion. Out: dots. Never here: which points leave one.

use super::{ScenePainter, TRACK, colours};
use crate::model::Point;
use crate::view::cache::{self, FrameCache, Track, TrailKey};
use crate::view::companions;
use crate::view::plot::Ages;

impl ScenePainter<'_> {
    /// Draws the track of a point through the reference frame.
    pub(super) fn track(&mut self, point: &Point, cache: &mut FrameCache) {
        let sources = point.map(|expression| self.q.place(expression));
        let rows = &self.q.snapshot.trail;
        let track = Track::Point(sources, self.camera, self.seen);
        let key = TrailKey {
            epoch: self.q.snapshot.epoch,
            motion: self.beside.unwrap_or(0),
            frame: self.frame,
            track,
        };
        let projection = self.camera.projection();
        let [right, up, near] = self.camera.project(self.point(point));
        let present = [right, up];
        // Each past point is transformed to the reference frame at its own time.
        let drawn = cache.trail(key, (rows, self.q.style.glyphs), |row| {
            let row = row.get(1..)?;
            let r = sources.map(|source| source.read(row));
            let seen = self.reference_frame.as_ref().map_or(r, |frame| frame.point(row, r));
            Some(projection.of(seen))
        });
        let series = self.beside.map_or_else(|| self.colour(point), companions::series);
        let ramp = colours::ramp(self.q, &self.colours, point, series);
        let since = cache::since(rows, ramp.len());
        let ages = Ages { since: &since, ramp, layer: TRACK, behind: Some((&self.depth, near)) };
        drawn.draw(&mut self.raster, ages, present);
    }
}
