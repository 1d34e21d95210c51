//! What stands out from a track: rods, which are two dots wide, and masses, around which dots stay blank.
//!
//! In: the lines and masses of a scene. Out: dots. Never here: which lines are rods; their constant lengths decide it.

use super::{SOLID, ScenePainter, TRACK};
use crate::model::{Point, Shape};
use crate::view::glyphs::Glyphs;
use crate::view::plot::{Pen, Visibility};
use crate::view::theme::Role;

/// The half width of a circle, in dots, from which on it has room for spokes.
const ROOM: f64 = 3.0;

/// How far off a circle, in radii, the end of a spoke may be.
const ON_IT: f64 = 1e-6;

impl ScenePainter<'_> {
    /// Draws a rod: in a plane a line two dots wide where dots are fine enough, else a line.
    pub(super) fn rod(&mut self, from: &Point, to: &Point) {
        let pen = Pen::new(self.q.style.theme[Role::Text], SOLID);
        let (from, to) = (self.point(from), self.point(to));
        self.curve(&[from, to], &pen);
        let fine = matches!(self.q.style.glyphs, Glyphs::Braille | Glyphs::Octant);
        if self.range.is_some() || !fine {
            return;
        }
        let size = self.raster.size();
        let dot = [
            (self.frame.x.hi - self.frame.x.lo) / f64::from(size[0].max(1)),
            (self.frame.y.hi - self.frame.y.lo) / f64::from(size[1].max(1)),
        ];
        let (a, b) = (self.flat(from), self.flat(to));
        let steep = ((b[1] - a[1]) / dot[1]).abs() > ((b[0] - a[0]) / dot[0]).abs();
        let beside =
            |p: [f64; 2]| if steep { [p[0] + dot[0], p[1]] } else { [p[0], p[1] + dot[1]] };
        self.raster.polyline(&self.frame, [beside(a), beside(b)], &pen);
    }

    /// Whether a line is a spoke of a circle or disc that is seen from so near its edge that there is no room for spokes between the
    /// two sides of its rim.
    pub(super) fn is_crowded_spoke(&self, ends: [&Point; 2]) -> bool {
        if self.range.is_none() {
            return false;
        }
        let (wide, _) = self.q.style.glyphs.dots();
        let dots = if self.q.style.glyphs.is_ascii() { 1.0 } else { f64::from(wide) };
        let room = ROOM * self.column() / dots;
        let ends = ends.map(|end| self.q.point(end));
        let towards = self.camera.towards();
        self.q.lab.shapes(self.eye).any(|(shape, _)| {
            let (Shape::Circle { centre, radius, normal }
            | Shape::Disc { centre, radius, normal, .. }) = shape
            else {
                return false;
            };
            let (centre, radius) = (self.q.point(centre), self.q.number(*radius).abs());
            let normal = self.q.point(normal);
            let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
            let length = dot(normal, normal).sqrt();
            let is_on = |end: [f64; 3]| {
                let off = [0, 1, 2].map(|k| end[k] - centre[k]);
                dot(off, normal).abs() <= ON_IT * radius * length
                    && dot(off, off).sqrt() <= (1.0 + ON_IT) * radius
            };
            ends.iter().all(|end| is_on(*end))
                && radius * dot(self.direction_of(normal), towards).abs() < room * length
        })
    }

    /// How the point of a ball that is nearest to the eye is seen: its centre is hidden by the ball itself.
    fn sight_of_front(&self, centre: [f64; 3], radius: f64) -> Visibility {
        let [x, y, near] = self.camera.project(centre);
        self.depth.sight_of([x, y, near + radius])
    }

    /// Blanks the tracks around the masses that are drawn with their radius.
    pub(super) fn halos(&mut self) {
        for (shape, _) in self.q.lab.shapes(self.eye) {
            let Shape::Mass { at, radius } = shape else { continue };
            let (at, own) = (self.point(at), radius.map(|radius| self.q.number(radius)));
            let Some(radius) = self.disc_radius(own) else { continue };
            if self.sight_of_front(at, radius) == Visibility::Clear {
                let centre = self.flat(at);
                self.raster.halo(&self.frame, centre, radius, TRACK);
            }
        }
    }
}
