//! Springs.
//!
//! In: two ends. Out: a zigzag. Never here: forces.

use super::ScenePainter;
use crate::num::math;
use crate::view::plot::Pen;

impl ScenePainter<'_> {
    /// Draws a zigzag of eight turns between two straight ends; its width does not depend on its extension.
    pub(super) fn spring(&mut self, from: [f64; 3], to: [f64; 3], pen: &Pen) {
        let (a, b) = (self.flat(from), self.flat(to));
        let along = [b[0] - a[0], b[1] - a[1]];
        let length = math::hypot(along[0], along[1]);
        let width =
            0.025 * (self.frame.x.hi - self.frame.x.lo).min(self.frame.y.hi - self.frame.y.lo);
        let across = [-along[1] / length * width, along[0] / length * width];
        let turns = 16;
        let corner = |i: i32| {
            let share = 0.1 + 0.8 * (f64::from(i) + 0.5) / f64::from(turns);
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            [0, 1].map(|k| a[k] + share * along[k] + side * across[k])
        };
        let straight = |share: f64| [0, 1].map(|k| a[k] + share * along[k]);
        let coil = (0..turns).map(corner);
        let points = [a, straight(0.1)].into_iter().chain(coil).chain([straight(0.9), b]);
        self.raster.polyline(&self.frame, points, pen);
    }
}
