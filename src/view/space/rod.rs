//! What stands out from a track: rods, which are two dots wide, and masses, around which dots stay blank.
//!
//! In: the lines and masses of a scene. Out: dots. Never here: which lines are rods; their constant lengths decide it.

use super::{SOLID, ScenePainter, TRACK};
use crate::model::{Point, Shape};
use crate::view::glyphs::Glyphs;
use crate::view::plot::{Pen, Visibility};
use crate::view::theme::Role;

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

    /// How the point of a ball that is nearest to the eye is seen: its centre is hidden by the ball itself.
    fn sight_of_front(&self, centre: [f64; 3], radius: f64) -> Visibility {
        let [x, y, near] = self.camera.project(centre);
        self.depth.sight_of([x, y, near + radius])
    }

    /// Blanks the tracks around the masses that are drawn with their radius.
    pub(super) fn halos(&mut self) {
        for (shape, _) in self.q.lab.shapes(self.eye) {
            let Shape::Mass { at, radius: Some(radius) } = shape else { continue };
            let (at, radius) = (self.point(at), self.q.number(*radius).abs());
            if self.cells(radius).is_some() && self.sight_of_front(at, radius) == Visibility::Clear
            {
                let centre = self.flat(at);
                self.raster.halo(&self.frame, centre, radius, TRACK);
            }
        }
    }
}
