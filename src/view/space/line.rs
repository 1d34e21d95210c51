//! Lines in space: what is visible of them, dimmer where it is farther away or behind a see-through surface.
//!
//! In: points, a pen. Out: dots. Never here: the shapes they belong to.

use ratatui::style::Style;

use super::{DISTANCES, GROUND, ScenePainter, solid};
use crate::view::plot::{Letters, Pen};

impl ScenePainter<'_> {
    /// Draws what is visible of a line through points, dimmer where it is farther away.
    pub(super) fn curve(&mut self, points: &[[f64; 3]], pen: &Pen) {
        let projection = self.camera.projection();
        let seen: Vec<_> = points.iter().map(|point| projection.of(*point)).collect();
        self.in_view(&seen, pen);
    }

    /// Draws what is visible of a line through points in the coordinates of the camera.
    fn in_view(&mut self, seen: &[[f64; 3]], pen: &Pen) {
        let Some([far, near]) = self.range else {
            let flat = seen.iter().map(|[x, y, _]| [*x, *y]);
            return self.raster.polyline(&self.frame, flat, pen);
        };
        let last = DISTANCES - 1;
        let own = if pen.layer <= GROUND { Letters::Dots } else { Letters::Direction };
        let letters = self.letters.unwrap_or(own);
        // dots are light enough
        let ascii_scenery = letters == Letters::Dots && self.q.style.glyphs.is_ascii();
        let coverage = if ascii_scenery { 1.0 } else { pen.coverage };
        let styles = self.receding(pen.style);
        let pens: [Pen; DISTANCES] = std::array::from_fn(|step| Pen {
            style: styles[step],
            fresh: (last - step) as u8,
            letters,
            coverage,
            ..*pen
        });
        // Scenery behind a see-through surface is left out; what moves is as dim there as at the back.
        let is_scenery = pen.layer <= GROUND;
        let line = self.depth.visible(seen).into_iter().map(|([x, y, depth], veiled)| {
            let share = (near - depth) / (near - far) * DISTANCES as f64;
            match (veiled, is_scenery) {
                (true, true) => ([f64::NAN; 2], last),
                (true, false) => ([x, y], last),
                _ if share.is_finite() => ([x, y], share.clamp(0.0, last as f64) as usize),
                _ => ([x, y], 0),
            }
        });
        let line: Vec<_> = line.collect();
        self.raster.polyline_in(&self.frame, line, &pens);
    }

    pub(super) fn receding(&mut self, style: Style) -> [Style; DISTANCES] {
        if let Some((_, styles)) = self.receding.iter().find(|(known, _)| *known == style) {
            return *styles;
        }
        let theme = &self.q.style.theme;
        let share = |step: usize| step as f64 / (DISTANCES - 1) as f64;
        let styles = std::array::from_fn(|step| theme.receding(style, share(step)));
        self.receding.push((style, styles));
        styles
    }

    /// Draws where a surface between two rims turns away from the eye.
    pub(super) fn silhouette(&mut self, low: &[[f64; 3]], high: &[[f64; 3]], pen: &Pen) {
        let projection = self.camera.projection();
        let [low, high]: [Vec<_>; 2] =
            [low, high].map(|rim| rim.iter().map(|point| projection.of(*point)).collect());
        for [from, to] in solid::silhouette(&low, &high) {
            self.in_view(&[from, to], pen);
        }
    }
}
