//! The surfaces of shapes: what they hide, and their dots in light and shade.
//!
//! In: the shapes of a scene. Out: depths, dots. Never here: lines and masses.

use super::solid::{self, Occluder};
use super::{BODY, SURFACE, ScenePainter};
use crate::model::Shape;
use crate::view::colour::ColourDepth;
use crate::view::plot::Pen;
use crate::view::theme::Role;

/// The share of a surface's dots that are drawn in the shade, and in full light: of spheres, on which curves are drawn,
/// of other solids, and of masses. Without colour a curve is told from the dots of its sphere by their number alone.
const SPHERE: [f64; 2] = [0.06, 0.55];
const COLOURLESS_SPHERE: [f64; 2] = [0.02, 0.12];
const OPAQUE: [f64; 2] = [0.2, 0.9];
const WHOLE: [f64; 2] = [1.0, 1.0];

/// The share of its light that a shaded surface has behind a veil.
const BEHIND: f64 = 0.5;

impl ScenePainter<'_> {
    /// Adds the surfaces of a shape to what hides others.
    pub(super) fn surfaces(&mut self, shape: &Shape) {
        if self.range.is_none() && !matches!(shape, Shape::Disc { .. }) {
            return;
        }
        let theme = &self.q.look.theme;
        let faint = (Pen::new(theme[Role::Level], SURFACE), OPAQUE);
        let (pen, solids) = match shape {
            Shape::Disc { centre, radius, normal } => {
                let (centre, normal) = (self.point(centre), self.direction(normal));
                let rim = self.rim(centre, self.q.number(*radius), normal);
                (faint, vec![Occluder::Face(rim)])
            }
            Shape::Cone { tip, base, radius } => {
                let (tip, base) = (self.point(tip), self.point(base));
                let radius = self.q.number(*radius);
                (faint, solid::cone(tip, base, radius, self.spacing(radius)))
            }
            Shape::Cylinder { from, to, radius } => {
                let (from, to) = (self.point(from), self.point(to));
                let radius = self.q.number(*radius);
                let [low, high] = solid::rims([from, to], radius, self.spacing(radius));
                (faint, solid::tube(&low, &high, true))
            }
            Shape::Sphere { centre, radius } => {
                let colourless = theme.depth() == ColourDepth::None;
                let shares = if colourless { COLOURLESS_SPHERE } else { SPHERE };
                let ball = Occluder::Ball(self.point(centre), self.q.number(*radius).abs());
                ((faint.0, shares), vec![ball])
            }
            Shape::Mass { at, radius: Some(radius) } => {
                let radius = self.q.number(*radius).abs();
                if self.cells(radius).is_none() {
                    return;
                }
                let style = theme.curve(self.colour(at));
                ((Pen::new(style, BODY), WHOLE), vec![Occluder::Ball(self.point(at), radius)])
            }
            Shape::Body { at } => {
                let Some(outline) = self.outline else { return };
                let centre = self.q.point(at);
                let solids = outline.surfaces.iter().cloned();
                (faint, solids.map(|solid| solid.moved(|own| self.place(centre, own))).collect())
            }
            _ => return,
        };
        // What moves on a sphere or inside it is seen through it.
        let see_through = matches!(shape, Shape::Sphere { .. });
        let (number, projection) = (self.surfaces.len(), self.camera.projection());
        self.surfaces.push(pen);
        for solid in solids {
            match solid.moved(|point| projection.of(point)) {
                Occluder::Face(corners) => self.depth.face(&corners, number),
                Occluder::Ball(centre, radius) if see_through => {
                    self.depth.veil(centre, radius, number);
                }
                Occluder::Ball(centre, radius) => self.depth.ball(centre, radius, number),
            }
        }
    }

    /// Fills the surfaces, each dot with the nearest one: with tones where the terminal has them, else with some of the dots.
    pub(super) fn fill(&mut self) {
        let pens: Vec<_> = std::mem::take(&mut self.surfaces)
            .into_iter()
            .map(|(pen, shares)| ([pen, self.dim(&pen)], shares))
            .collect();
        let look = self.q.look;
        let tones: Vec<Option<usize>> = pens
            .iter()
            .map(|([pen, _], _)| {
                let tones = look.theme.tones(pen.style).filter(|_| !look.glyphs.is_ascii())?;
                Some(self.shading.add(*tones))
            })
            .collect();
        for (dot, covered) in self.depth.dots() {
            let Some((pen, [shade, light])) = pens.get(covered.surface) else { continue };
            if let Some(tones) = tones[covered.surface] {
                let light = if covered.veiled { BEHIND * covered.light } else { covered.light };
                self.shading.cover(dot, tones, light);
                continue;
            }
            let pen = pen[usize::from(covered.veiled)];
            let coverage = shade + (light - shade) * covered.light * covered.light;
            self.raster.shade(dot, &pen.covering(coverage));
        }
        self.shading.finish();
    }
}
