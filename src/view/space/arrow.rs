//! Arrows: the apparent forces in a frame of reference.
//!
//! In: the apparent forces on each particle. Out: lines, and their names where they have no colours.
//! Never here: the legend.

use super::annotation::{FORCES, Label};
use super::{SOLID, ScenePainter, is_colourless};
use crate::mechanics::Apparent;
use crate::model::Point;
use crate::view::plot::{Pen, Scale};
use crate::view::quantity::{Quantities, QuantitySource};
use crate::view::theme::Role;

/// The length of the longest apparent force so far, as a fraction of the picture.
const LONGEST: f64 = 0.25;

/// The apparent forces on a particle, in the order of their names.
fn forces(particle: &Apparent) -> [Point; 4] {
    [particle.centrifugal, particle.coriolis, particle.euler, particle.dragging]
}

/// The greatest size of a force so far.
fn greatest(q: &Quantities<'_>, vector: &Point) -> f64 {
    let most = vector.map(|e| match q.place(e) {
        QuantitySource::Number(number) => number.abs(),
        QuantitySource::Channel(channel) => {
            let (lo, hi) = q.bounds(channel);
            lo.abs().max(hi.abs())
        }
    });
    most.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Which apparent forces there are on a frame's particles, by their number.
pub(super) fn apparent_forces(q: &Quantities<'_>, seen: &[Apparent]) -> Vec<usize> {
    let acts =
        |index: usize| seen.iter().any(|particle| greatest(q, &forces(particle)[index]) > 0.0);
    (0..4).filter(|&index| acts(index)).collect()
}

impl ScenePainter<'_> {
    /// Draws the apparent forces on the frame's particles.
    pub(super) fn apparent(&mut self, seen: &[Apparent]) {
        let all = seen.iter().flat_map(forces).map(|vector| greatest(self.q, &vector));
        let largest = all.filter(|v| v.is_finite()).fold(0.0, f64::max);
        if largest == 0.0 {
            return;
        }
        let (x, y) = (self.frame.x, self.frame.y);
        let scale = LONGEST * (x.hi - x.lo).abs().min((y.hi - y.lo).abs()) / largest;
        for particle in seen {
            let at = particle.at.map(|e| self.q.number(e));
            for (index, vector) in forces(particle).iter().enumerate() {
                if greatest(self.q, vector) > 0.0 {
                    let along = vector.map(|e| scale * self.q.number(e));
                    let pen = Pen::new(self.q.style.theme.curve(index + 1), SOLID);
                    self.arrow(at, along, &pen);
                    if is_colourless(self.q.style) {
                        self.name_force(at, along, FORCES[index]);
                    }
                }
            }
        }
    }

    /// Writes the name of a force at the tip of its arrow, or where this leaves the picture.
    fn name_force(&mut self, foot: [f64; 3], along: [f64; 3], name: &str) {
        let [foot, tip] = [foot, [0, 1, 2].map(|k| foot[k] + along[k])].map(|at| self.flat(at));
        let within = |v: f64, scale: Scale| v.clamp(scale.lo.min(scale.hi), scale.hi.max(scale.lo));
        self.labels.push(Label {
            tip: [within(tip[0], self.frame.x), within(tip[1], self.frame.y)],
            apart: false,
            leftwards: tip[0] < foot[0],
            text: self.q.style.glyphs.text(name).into_owned(),
            style: self.q.style.theme[Role::Text],
        });
    }

    /// Draws a shaft with a head of two strokes, an eighth of its length.
    pub(super) fn arrow(&mut self, foot: [f64; 3], along: [f64; 3], pen: &Pen) {
        let tip = [0, 1, 2].map(|k| foot[k] + along[k]);
        let (a, b) = (self.flat(foot), self.flat(tip));
        let back = [(a[0] - b[0]) / 8.0, (a[1] - b[1]) / 8.0];
        let wing = |side: f64| [b[0] + back[0] - side * back[1], b[1] + back[1] + side * back[0]];
        self.curve(&[foot, tip], pen);
        if let Some(pen) = self.seen_at(tip, pen) {
            self.raster.polyline(&self.frame, [wing(0.7), b, wing(-0.7)], &pen);
        }
    }
}
