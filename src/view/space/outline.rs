//! The edges of discs, cones and cylinders.
//!
//! In: a shape. Out: dots. Never here: surfaces, and which shapes are drawn.

use super::{ScenePainter, solid};
use crate::model::Shape;
use crate::view::plot::Pen;

impl ScenePainter<'_> {
    /// Draws the rims and the silhouette of a disc, a cone or a cylinder. Other shapes have none here.
    pub(super) fn outline(&mut self, shape: &Shape, pen: &Pen) {
        match shape {
            Shape::Disc { centre, radius, normal, shade } => {
                let style = self.shade(*shade).unwrap_or(pen.style);
                let pen = &Pen { style, ..*pen };
                let (centre, normal) = (self.point(centre), self.direction(normal));
                let radius = self.q.number(*radius);
                let rim = self.rim(centre, radius, normal);
                self.edge(solid::disc(radius), &[&rim], pen, |painter, pen| {
                    painter.curve(&rim, pen);
                });
            }
            Shape::Cone { tip, base, radius } => {
                let (tip, base) = (self.point(tip), self.point(base));
                let axis = [0, 1, 2].map(|k| base[k] - tip[k]);
                let radius = self.q.number(*radius);
                let rim = self.rim(base, radius, axis);
                self.edge(solid::along(tip, base, radius), &[&[tip], &rim], pen, |painter, pen| {
                    painter.curve(&rim, pen);
                    painter.silhouette(&vec![tip; rim.len()], &rim, pen);
                });
            }
            Shape::Cylinder { from, to, radius } => {
                let ends = [self.point(from), self.point(to)];
                let radius = self.q.number(*radius);
                let [low, high] = solid::rims(ends, radius, self.spacing(radius));
                let extents = solid::along(ends[0], ends[1], radius);
                self.edge(extents, &[&low, &high], pen, |painter, pen| {
                    painter.curve(&low, pen);
                    painter.curve(&high, pen);
                    painter.silhouette(&low, &high, pen);
                });
            }
            _ => {}
        }
    }
}
