//! The motion in space: the file's shapes and the tracks they leave, seen through the camera.
//!
//! In: shapes, channels, the camera. Out: cells. Never here: the meaning of the shapes.

mod body;
mod reference_frame;
mod scene;

use ratatui::layout::Rect;

use super::canvas::{Canvas, row};
use super::kept::{self, Kept, Track, TrailKey};
use super::plot::{Ages, Camera, Frame, Marker, Pen, Raster, Scale};
use super::quantity::{Quantities, Source};
use super::theme::Role;
use crate::instrument::CameraPose;
use crate::mechanics::Apparent;
use crate::model::{Point, Shape};
use crate::num::math;
use body::Outline;
use reference_frame::ReferenceFrame;
use scene::Scene;

/// The layers of the picture, from the lowest.
const GROUND: u8 = 0;
const TRACK: u8 = 1;
const SOLID: u8 = 2;
const BODY: u8 = 3;

/// The apparent forces, in the order of their colours.
const FORCES: [&str; 4] = ["centrifugal", "Coriolis", "Euler", "of the origin"];

/// The length of the longest apparent force so far, as a fraction of the picture.
const LONGEST: f64 = 0.25;

/// Draws the picture inside the frame.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, q: &Quantities<'_>, eye: &CameraPose) {
    if area.is_empty() {
        return;
    }
    let camera = Camera { yaw: eye.yaw, pitch: eye.pitch, zoom: eye.zoom, ..Camera::FACE_ON };
    let reference_frame = ReferenceFrame::of(q, eye.frame);
    let scene = Scene::of(q, *eye, reference_frame.as_ref());
    let frame = camera.frame(&scene.bounds, area);
    let raster = Raster::new(area, canvas.look.glyphs);
    let mut artist = ScenePainter {
        raster,
        frame,
        camera,
        q,
        reference_frame,
        seen: eye.frame,
        colours: colours(q, *eye),
    };
    let mut kept = std::mem::take(&mut canvas.kept);
    for (shape, _) in q.lab.shapes(*eye) {
        artist.shape(shape, &mut kept);
    }
    canvas.kept = kept;
    let seen = eye.frame.and_then(|frame| q.lab.loaded.equations.supplements.frames.get(frame));
    let forces = artist.apparent(seen.map_or(&[], Vec::as_slice));
    artist.raster.draw(canvas.buffer);
    legend(canvas, area, &forces);
    if eye.pitch < std::f64::consts::FRAC_PI_2 {
        compass(canvas, area, &camera);
    }
}

/// The points of the masses and of the traces of other points, in the order of their colours: what moves comes first,
/// and the second colour, an amber, is left to a single mass that stays where it is.
fn colours(q: &Quantities<'_>, eye: CameraPose) -> Vec<Point> {
    let stays = |at: &Point| at.iter().all(|e| matches!(q.place(*e), Source::Number(_)));
    let shapes = || q.lab.shapes(eye).map(|(shape, _)| shape);
    let masses: Vec<Point> = shapes()
        .filter_map(|shape| match shape {
            Shape::Mass { at, .. } => Some(*at),
            _ => None,
        })
        .collect();
    let (fixed, mut points): (Vec<_>, Vec<_>) = masses.into_iter().partition(stays);
    let traces = shapes().filter_map(|shape| match shape {
        Shape::Trace { at } => Some(*at),
        _ => None,
    });
    for at in traces {
        if !points.contains(&at) {
            points.push(at);
        }
    }
    for (index, at) in fixed.into_iter().enumerate() {
        points.insert((1 + index).min(points.len()), at);
    }
    points
}

/// Draws the directions of the axes in the lower left corner, each as an arm with its name.
fn compass(canvas: &mut Canvas<'_>, area: Rect, camera: &Camera) {
    if area.width < 30 || area.height < 14 {
        return;
    }
    let corner = Rect { x: area.x, y: area.bottom() - 6, width: 12, height: 6 };
    let reach = Scale::linear(-1.3, 1.3);
    let frame = Frame::equal(reach, reach, corner);
    let mut arms = Raster::new(corner, canvas.look.glyphs);
    let pen = Pen::new(canvas.style(Role::Dim), GROUND);
    let axes = [("x", [1.0, 0.0, 0.0]), ("y", [0.0, 1.0, 0.0]), ("z", [0.0, 0.0, 1.0])];
    let tips = axes.map(|(name, axis)| {
        let [right, up, _] = camera.project(axis);
        (name, [right, up])
    });
    for (_, tip) in tips {
        arms.line(&frame, [0.0; 2], tip.map(|v| 0.7 * v), &pen);
    }
    arms.draw(canvas.buffer);
    for (name, tip) in tips {
        if let Some(at) = frame.cell(tip) {
            canvas.write(at, 1, name, canvas.style(Role::Dim));
        }
    }
}

/// Draws the names of the apparent forces in their colours in the upper left corner.
fn legend(canvas: &mut Canvas<'_>, area: Rect, forces: &[usize]) {
    if area.width < 24 || usize::from(area.height) < 8 {
        return;
    }
    let arrow = canvas.look.glyphs.pick("→", "->");
    for (index, force) in forces.iter().enumerate() {
        let text = format!("{arrow} {}", FORCES[*force]);
        let at = row(area, index);
        let style = canvas.look.theme.curve(force + 1);
        canvas.write(at.as_position(), at.width, &text, style);
    }
}

/// Draws the shapes of a scene.
struct ScenePainter<'a> {
    raster: Raster,
    frame: Frame,
    camera: Camera,
    q: &'a Quantities<'a>,
    reference_frame: Option<ReferenceFrame>,
    /// The index of the reference frame.
    seen: Option<usize>,
    /// The points that have a colour of their own.
    colours: Vec<Point>,
}

impl ScenePainter<'_> {
    fn shape(&mut self, shape: &Shape, kept: &mut Kept) {
        let theme = &self.q.look.theme;
        let solid = Pen::new(theme[Role::Text], SOLID);
        let ground = Pen::shaded(theme.line(Role::Level), GROUND);
        match shape {
            Shape::Line { from, to } => {
                let (from, to) = (self.point(from), self.point(to));
                self.curve(&[from, to], &solid);
            }
            Shape::Spring { from, to } => {
                let (from, to) = (self.point(from), self.point(to));
                self.spring(from, to, &solid);
            }
            Shape::Circle { centre, radius, normal } => {
                let (centre, normal) = (self.point(centre), self.direction(normal));
                let rim = scene::circle(centre, self.q.number(*radius), normal);
                self.curve(&rim, &solid);
            }
            Shape::Mass { at, radius } => {
                let radius = radius.map(|radius| self.q.number(radius));
                self.mass(at, radius);
            }
            Shape::Trace { at } => self.track(at, kept),
            Shape::Vector { at, components } => {
                let (foot, along) = (self.point(at), self.direction(components));
                let pen = Pen::new(theme[Role::Accent], SOLID);
                self.arrow(foot, along, &pen);
            }
            Shape::Path { points } => {
                let points: Vec<_> = points.iter().map(|point| self.point(point)).collect();
                self.curve(&points, &ground);
            }
            Shape::Body { at } => self.body(at),
            Shape::Plane { at, normal, size } => {
                let (at, normal) = (self.point(at), self.direction(normal));
                let edge = self.q.number(*size);
                let corners = scene::square(at, normal, edge);
                self.curve(&corners, &ground);
            }
        }
    }

    /// The current position of a point of a shape in the reference frame.
    fn point(&self, point: &Point) -> [f64; 3] {
        let r = self.q.point(point);
        self.reference_frame
            .as_ref()
            .map_or(r, |reference_frame| reference_frame.point(&self.q.snapshot.values, r))
    }

    /// The current components of a direction in the reference frame.
    fn direction(&self, direction: &Point) -> [f64; 3] {
        let v = self.q.point(direction);
        self.reference_frame
            .as_ref()
            .map_or(v, |reference_frame| reference_frame.direction(&self.q.snapshot.values, v))
    }

    /// Draws the apparent forces on the frame's particles, and returns which of them are present.
    fn apparent(&mut self, seen: &[Apparent]) -> Vec<usize> {
        let forces = |a: &Apparent| [a.centrifugal, a.coriolis, a.euler, a.dragging];
        let greatest = |vector: &Point| {
            let most = vector.map(|e| match self.q.place(e) {
                Source::Number(number) => number.abs(),
                Source::Channel(channel) => {
                    let (lo, hi) = self.q.bounds(channel);
                    lo.abs().max(hi.abs())
                }
            });
            most.iter().map(|v| v * v).sum::<f64>().sqrt()
        };
        let all = seen.iter().flat_map(|a| forces(a).map(|vector| greatest(&vector)));
        let largest = all.filter(|v| v.is_finite()).fold(0.0, f64::max);
        let (x, y) = (self.frame.x, self.frame.y);
        let scale = LONGEST * (x.hi - x.lo).abs().min((y.hi - y.lo).abs()) / largest;
        let mut named = Vec::new();
        if largest == 0.0 {
            return named;
        }
        for particle in seen {
            let at = particle.at.map(|e| self.q.number(e));
            for (index, vector) in forces(particle).iter().enumerate() {
                if greatest(vector) > 0.0 {
                    let along = vector.map(|e| scale * self.q.number(e));
                    let pen = Pen::new(self.q.look.theme.curve(index + 1), SOLID);
                    self.arrow(at, along, &pen);
                    if !named.contains(&index) {
                        named.push(index);
                    }
                }
            }
        }
        named.sort_unstable();
        named
    }

    fn flat(&self, point: [f64; 3]) -> [f64; 2] {
        let [right, up, _] = self.camera.project(point);
        [right, up]
    }

    fn curve(&mut self, points: &[[f64; 3]], pen: &Pen) {
        let flat: Vec<_> = points.iter().map(|point| self.flat(*point)).collect();
        self.raster.polyline(&self.frame, flat, pen);
    }

    /// Draws a zigzag of eight turns between two straight ends; its width does not depend on its extension.
    fn spring(&mut self, from: [f64; 3], to: [f64; 3], pen: &Pen) {
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

    /// Draws a point mass: a disc of its radius, or a marker if that is smaller than a cell.
    fn mass(&mut self, point: &Point, radius: Option<f64>) {
        let at = self.point(point);
        let style = self.q.look.theme.curve(self.colour(point));
        let pen = Pen::new(style, BODY);
        let centre = self.flat(at);
        let cell = (self.frame.x.hi - self.frame.x.lo) / f64::from(self.frame.area.width.max(1));
        let cells = radius.map_or(0.0, |radius| radius.abs() / cell);
        if cells.is_finite() && cells > 1.2 {
            self.raster.disc(&self.frame, centre, cells * cell, &pen);
        } else {
            self.raster.marker(&self.frame, centre, Marker::Disc, &pen);
        }
    }

    /// The colour of the mass at a point, and of its trace: the masses that move are counted first, then one that stays
    /// where it is, such as a sun, then the traces of other points.
    fn colour(&self, point: &Point) -> usize {
        self.colours.iter().position(|other| other == point).unwrap_or(self.colours.len())
    }

    /// Draws the pieces of the model's body and its principal axes, with its centre of mass at a point.
    fn body(&mut self, at: &Point) {
        let Some(outline) = Outline::of(self.q) else { return };
        let at = self.q.point(at);
        let place = |own: [f64; 3]| {
            let r = [0, 1, 2].map(|k| at[k] + own[k]);
            self.reference_frame
                .as_ref()
                .map_or(r, |reference_frame| reference_frame.point(&self.q.snapshot.values, r))
        };
        let placed = |lines: Vec<Vec<[f64; 3]>>| -> Vec<Vec<[f64; 3]>> {
            lines.into_iter().map(|line| line.into_iter().map(place).collect()).collect()
        };
        let (axes, edges) = (placed(outline.axes), placed(outline.edges));
        let points: Vec<_> = outline.points.into_iter().map(place).collect();
        let theme = &self.q.look.theme;
        for line in axes {
            self.curve(&line, &Pen::shaded(theme.line(Role::Separatrix), TRACK));
        }
        for line in edges {
            self.curve(&line, &Pen::new(theme[Role::Text], SOLID));
        }
        for point in points {
            let (flat, pen) = (self.flat(point), Pen::new(theme.curve(0), BODY));
            self.raster.marker(&self.frame, flat, Marker::Disc, &pen);
        }
    }

    fn track(&mut self, point: &Point, kept: &mut Kept) {
        let sources = point.map(|expression| self.q.place(expression));
        let rows = &self.q.snapshot.trail;
        let track = Track::Point(sources, self.camera, self.seen);
        let key = TrailKey { epoch: self.q.snapshot.epoch, frame: self.frame, track };
        let projection = self.camera.projection();
        let present = self.flat(self.point(point));
        // Each past point is transformed to the reference frame at its own time.
        let drawn = kept.trail(key, (rows, self.q.look.glyphs), |row| {
            let row = row.get(1..)?;
            let r = sources.map(|source| source.read(row));
            let seen = self.reference_frame.as_ref().map_or(r, |frame| frame.point(row, r));
            let [right, up, _] = projection.of(seen);
            Some([right, up])
        });
        let ramp = self.q.look.theme.trail(self.colour(point));
        let since = kept::since(rows, ramp.len());
        let ages = Ages { since: &since, ramp, layer: TRACK };
        drawn.draw(&mut self.raster, ages, present);
    }

    /// Draws a shaft with a head of two strokes, an eighth of its length.
    fn arrow(&mut self, foot: [f64; 3], along: [f64; 3], pen: &Pen) {
        let tip = [0, 1, 2].map(|k| foot[k] + along[k]);
        let (a, b) = (self.flat(foot), self.flat(tip));
        let back = [(a[0] - b[0]) / 8.0, (a[1] - b[1]) / 8.0];
        let wing = |side: f64| [b[0] + back[0] - side * back[1], b[1] + back[1] + side * back[0]];
        self.raster.polyline(&self.frame, [a, b], pen);
        self.raster.polyline(&self.frame, [wing(0.7), b, wing(-0.7)], pen);
    }
}
