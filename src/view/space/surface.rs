//! The surfaces of shapes: what they hide, and their dots in light and shade.
//!
//! In: the shapes of a scene. Out: depths, dots. Never here: lines and masses.

use super::circle;
use super::filling::{Filling, PieceStyle, is_small};
use super::solid::{self, DrawnPiece, Occluder, Surface};
use super::{BODY, SOLID, SURFACE, ScenePainter};
use crate::model::Shape;
use crate::view::colour::ColourDepth;
use crate::view::plot::{DepthBuffer, Letters, Pen, Visibility};
use crate::view::theme::Role;

/// The share of a surface's dots that are drawn in the shade, and in full light: of spheres, on which curves are drawn,
/// of other solids, and of masses. Without colour a curve differs from the dots of its sphere, and an edge from those of its solid, by
/// their number alone.
const SPHERE: [f64; 2] = [0.06, 0.55];
const COLOURLESS_SPHERE: [f64; 2] = [0.02, 0.12];
const OPAQUE: [f64; 2] = [0.2, 0.9];
const COLOURLESS_OPAQUE: [f64; 2] = [0.06, 0.35];
const WHOLE: [f64; 2] = [1.0, 1.0];

/// The share of its light that a shaded surface has behind a veil.
const BEHIND: f64 = 0.5;

/// How far inside of its outline, in radii, a sphere is asked whether it is the nearest one.
const INSIDE: f64 = 0.9;

impl ScenePainter<'_> {
    /// Adds the surfaces of a shape to what hides others.
    pub(super) fn surfaces(&mut self, shape: &Shape) {
        let in_space = self.range.is_some();
        if !in_space && !matches!(shape, Shape::Disc { .. } | Shape::Mass { .. }) {
            return;
        }
        let theme = &self.q.style.theme;
        // without colour an edge differs from what it bounds by its dots alone
        let colourless = theme.depth() == ColourDepth::None;
        let opaque = if colourless { COLOURLESS_OPAQUE } else { OPAQUE };
        let faint = |own: Option<usize>| {
            let style = own.map_or(theme[Role::Level], |series| theme.curve(series));
            (Pen::new(style, SURFACE), opaque)
        };
        let piece =
            |surface, extents| DrawnPiece { surfaces: vec![surface], edges: Vec::new(), extents };
        let ((pen, shares), pieces) = match shape {
            Shape::Disc { centre, radius, normal, shade } => {
                let own = self.own_colour(centre);
                let filled = self
                    .shade(*shade)
                    .map_or(faint(own), |style| (Pen::new(style, SURFACE), WHOLE));
                let (centre, normal) = (self.point(centre), self.direction(normal));
                let radius = self.q.number(*radius);
                let above = [0, 1, 2].map(|k| centre[k] + normal[k]);
                let disc = Surface::Disc { centre, above, radius };
                (filled, vec![piece(disc, solid::disc(radius))])
            }
            Shape::Cone { tip, base, radius } => {
                let own = self.own_colour(base);
                let (tip, base) = (self.point(tip), self.point(base));
                let radius = self.q.number(*radius);
                let cone = Surface::Cone { tip, base, radius };
                (faint(own), vec![piece(cone, solid::along(tip, base, radius))])
            }
            Shape::Cylinder { from, to, radius } => {
                let own = self.own_colour(from);
                let ends = [self.point(from), self.point(to)];
                let radius = self.q.number(*radius);
                let tube = Surface::Cylinder { ends, radius, closed: true };
                (faint(own), vec![piece(tube, solid::along(ends[0], ends[1], radius))])
            }
            Shape::Sphere { centre, radius } => {
                let shares = if colourless { COLOURLESS_SPHERE } else { SPHERE };
                let radius = self.q.number(*radius).abs();
                let ball = Occluder::Ball(self.point(centre), radius);
                ((faint(None).0, shares), vec![piece(Surface::Plain(ball), [2.0 * radius; 2])])
            }
            Shape::Mass { at, radius: Some(radius) } => {
                let radius = self.q.number(*radius).abs();
                if !self.is_ball(radius) {
                    return;
                }
                let style = theme.curve(self.colour(at));
                let centre = self.point(at);
                let ball = Occluder::Ball(centre, radius);
                (
                    (Pen::new(style, BODY), WHOLE),
                    vec![piece(Surface::Plain(ball), [2.0 * radius; 2])],
                )
            }
            Shape::Body { at } => {
                let Some(outline) = self.outline else { return };
                let centre = self.q.point(at);
                let pieces = outline.pieces.iter().cloned();
                let place = |own| self.place(centre, own);
                (faint(None), pieces.map(|piece| piece.moved(place)).collect())
            }
            _ => return,
        };
        // What moves on a sphere or inside it is seen through it.
        let see_through = matches!(shape, Shape::Sphere { .. });
        let (column, projection) = (self.column(), self.camera.projection());
        for piece in pieces {
            let surfaces = piece.surfaces.into_iter();
            let solids = surfaces.flat_map(|surface| surface.occluders(|r| self.spacing(r)));
            let solids: Vec<_> =
                solids.map(|solid| solid.moved(|point| projection.of(point))).collect();
            let width = || solid::least_width(&solids);
            let style = PieceStyle::seen(piece.extents, width, column, self.q.style.glyphs);
            let is_thin = style == PieceStyle::Dots && !self.q.style.glyphs.is_ascii();
            let is_mass = !see_through && (is_thin || self.is_mass(piece.extents));
            let pen = if is_thin { self.dots(&pen) } else { pen };
            self.surfaces.push(Filling { pen, shares, style, solids, is_mass, see_through });
        }
    }

    /// Fills the surfaces, each dot with the nearest one: with tones where the terminal has them and the piece is thick enough, else
    /// with some of the dots.
    pub(super) fn fill(&mut self) {
        let surfaces = std::mem::take(&mut self.surfaces);
        let style = self.q.style;
        let tones: Vec<Option<usize>> = surfaces
            .iter()
            .map(|surface| {
                let tones =
                    style.theme.tones(surface.pen.style).filter(|_| !style.glyphs.is_ascii());
                let tones = tones.filter(|_| surface.style != PieceStyle::Dots)?;
                Some(self.shading.add(*tones))
            })
            .collect();
        // What is thin leaves its dots, and the tones behind it, on the screen.
        let all = |_: usize| true;
        let blocks = tones.iter().any(Option::is_some);
        self.depth = self.depth_of(&surfaces, blocks, all);
        let has_tones = |number: usize| tones[number].is_some();
        if blocks {
            let some_lines = tones.iter().any(Option::is_none);
            let toned = some_lines.then(|| self.depth_of(&surfaces, blocks, has_tones));
            for (dot, covered) in toned.as_ref().unwrap_or(&self.depth).dots() {
                if let Some(tones) = tones[covered.surface] {
                    let light = if covered.veiled { BEHIND * covered.light } else { covered.light };
                    self.shading.cover(dot, tones, light);
                }
            }
        }
        if (0..tones.len()).all(has_tones) {
            return;
        }
        let pens: Vec<_> = surfaces.iter().map(|s| [s.pen, self.dim(&s.pen)]).collect();
        for (dot, covered) in self.depth.dots().filter(|(_, covered)| !has_tones(covered.surface)) {
            let pen = pens[covered.surface][usize::from(covered.veiled)];
            let surface = &surfaces[covered.surface];
            if surface.is_mass {
                let letters = if style.glyphs.is_ascii() { Letters::Mass } else { pen.letters };
                self.raster.dot(dot, &Pen { layer: pen.layer.max(SOLID), letters, ..pen });
                continue;
            }
            let [shade, light] = surface.shares;
            let coverage = shade + (light - shade) * covered.light * covered.light;
            self.raster.shade(dot, &pen.covering(coverage));
        }
    }

    /// What hides what among some of the surfaces.
    fn depth_of(
        &self,
        surfaces: &[Filling],
        blocks: bool,
        counts: impl Fn(usize) -> bool,
    ) -> DepthBuffer {
        let mut depth = DepthBuffer::new(&self.frame, self.raster.size());
        if blocks {
            depth = depth.with_blocks(self.shading.block());
        }
        for (number, surface) in surfaces.iter().enumerate().filter(|(number, _)| counts(*number)) {
            for solid in &surface.solids {
                match solid {
                    Occluder::Face(corners) => depth.face(corners, number),
                    Occluder::Ball(centre, radius) if surface.see_through => {
                        depth.veil(*centre, *radius, number);
                    }
                    Occluder::Ball(centre, radius) => depth.ball(*centre, *radius, number),
                }
            }
        }
        depth
    }

    /// Whether a piece with these extents is one mass of characters.
    fn is_mass(&self, extents: [f64; 2]) -> bool {
        self.q.style.glyphs.is_ascii() && is_small(extents, self.column())
    }

    /// The pen of a surface that is filled with dots.
    fn dots(&self, pen: &Pen) -> Pen {
        let theme = &self.q.style.theme;
        let is_level = pen.style == theme[Role::Level];
        let otherwise = if is_level { theme[Role::Text] } else { pen.style };
        Pen { style: theme.dots(pen.style).unwrap_or(otherwise), ..*pen }
    }

    /// Draws edges of a piece with these extents along some lines: those of a solid are lines only where they are no blocks, and
    /// those of one that is all dots, or a mass of characters, are a part of it.
    pub(super) fn edge(
        &mut self,
        extents: [f64; 2],
        lines: &[&[[f64; 3]]],
        pen: &Pen,
        draw: impl FnOnce(&mut Self, &Pen),
    ) {
        if self.is_mass(extents) {
            self.letters = Some(Letters::Mass);
            draw(self, pen);
            self.letters = None;
            return;
        }
        let projection = self.camera.projection();
        let place = |line: &&[[f64; 3]]| {
            Occluder::Face(line.iter().map(|point| projection.of(*point)).collect())
        };
        let width = || solid::least_width(&lines.iter().map(place).collect::<Vec<_>>());
        match PieceStyle::seen(extents, width, self.column(), self.q.style.glyphs) {
            PieceStyle::Dots => {
                let theme = &self.q.style.theme;
                let is_text = pen.style == theme[Role::Text];
                let style = if is_text { theme[Role::Level] } else { pen.style };
                let pen = self.dots(&Pen { style, ..*pen });
                draw(self, &pen);
            }
            PieceStyle::Solid if self.shading.is_on() => {
                std::mem::swap(&mut self.raster, &mut self.edges);
                draw(self, pen);
                std::mem::swap(&mut self.raster, &mut self.edges);
            }
            PieceStyle::Solid => draw(self, pen),
        }
    }

    /// Whether a mass of this radius is a ball among the surfaces: in space if it has its size on the screen, and in a plane
    /// beside a disc.
    pub(super) fn is_ball(&self, radius: f64) -> bool {
        let is_disc = |shape: &Shape| matches!(shape, Shape::Disc { .. });
        let is_thick = PieceStyle::of(2.0 * radius, self.column()) == PieceStyle::Solid;
        let beside_disc =
            || is_thick && self.q.lab.shapes(self.eye).any(|(shape, _)| is_disc(shape));
        self.cells(radius).is_some() && (self.range.is_some() || beside_disc())
    }

    /// Draws the outline of a sphere where it has no tones of its own: all of it if it is small, and otherwise what is seen through
    /// another sphere.
    pub(super) fn limb(&mut self, centre: [f64; 3], radius: f64, pen: &Pen) {
        let is_small = PieceStyle::of(2.0 * radius, self.column()) != PieceStyle::Solid;
        let is_dotted = is_small || self.range.is_none() || !self.shading.is_on();
        let towards = self.camera.towards();
        let out = radius * (1.0 - INSIDE * INSIDE).sqrt();
        let front = [0, 1, 2].map(|k| centre[k] + out * towards[k]);
        let inside = circle::circle(front, INSIDE * radius, towards);
        let outline = circle::circle(centre, radius, towards);
        let flat = outline.into_iter().zip(inside).map(|(point, inside)| {
            let is_seen = is_dotted || self.sight(inside) == Visibility::Veiled;
            if is_seen { self.flat(point) } else { [f64::NAN; 2] }
        });
        let flat: Vec<_> = flat.collect();
        self.raster.polyline(&self.frame, flat, pen);
    }
}
