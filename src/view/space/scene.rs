//! The scene: the points of the shapes, and the box that contains all they may reach.
//!
//! In: shapes and the bounds of their channels. Out: points, and a box that rarely changes. Never here: the camera.

use super::body::Outline;
use super::circle::{circle, square};
use super::reference_frame::ReferenceFrame;
use crate::instrument::CameraPose;
use crate::model::{Point, Shape};
use crate::num::math;
use crate::view::plot::{Bounds, Camera};
use crate::view::quantity::{Quantities, Source};

/// The contents of the picture.
pub(super) struct Scene {
    /// The box that contains everything.
    pub(super) bounds: Bounds,
}

/// Two opposite corners of a box.
type Span3 = [[f64; 3]; 2];

impl Scene {
    /// The scene of a lab.
    ///
    /// A rod (a line of constant length) may swing around one of its ends. The box contains its whole circle from the
    /// start, so that the picture does not shrink during the first swing.
    pub(super) fn of(
        q: &Quantities<'_>,
        eye: CameraPose,
        reference_frame: Option<&ReferenceFrame>,
    ) -> Self {
        let mut scene = Self { bounds: Bounds::EMPTY };
        if let Some(bounds) = followed(q, eye, reference_frame) {
            return Self { bounds };
        }
        let mut reached: Vec<(Point, Span3)> = Vec::new();
        for (shape, rod) in q.lab.shapes(eye) {
            scene.include(q, shape, rod, &mut reached);
        }
        if let (Some(ends), Some(reference_frame)) = (scene.bounds.ends(), reference_frame) {
            scene.bounds = Bounds::around(reference_frame.around(q, ends));
        }
        // The box is rounded outwards, so that the picture does not move while the motion grows a little.
        if let Some([low, high]) = scene.bounds.ends() {
            let longest = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
            let step = round_step(longest / 10.0);
            let out = |v: f64, round: fn(f64) -> f64| round(v / step) * step;
            let flat = |k: usize| low[k] == high[k];
            let corner = |end: [f64; 3], round: fn(f64) -> f64| {
                [0, 1, 2].map(|k| if flat(k) { end[k] } else { out(end[k], round) })
            };
            let ends = [corner(low, f64::floor), corner(high, f64::ceil)];
            if ends.as_flattened().iter().all(|v| v.is_finite()) {
                scene.bounds = Bounds::around(ends);
            }
        }
        scene
    }

    /// How near to the eye the farthest and the nearest corner of a scene are; `None` in a plane seen face on.
    pub(super) fn depths(&self, camera: &Camera) -> Option<[f64; 2]> {
        let [low, high] = self.bounds.ends()?;
        let corner = |i: usize| [0, 1, 2].map(|k| if i >> k & 1 == 0 { low[k] } else { high[k] });
        let near = || (0..8).map(|i| camera.project(corner(i))[2]);
        let (far, near) =
            (near().fold(f64::INFINITY, f64::min), near().fold(f64::NEG_INFINITY, f64::max));
        let size = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        (near - far > 1e-6 * size).then_some([far, near])
    }

    fn include(
        &mut self,
        q: &Quantities<'_>,
        shape: &Shape,
        rod: bool,
        reached: &mut Vec<(Point, Span3)>,
    ) {
        match shape {
            Shape::Spring { from, to } => {
                self.add(reach(q, from, reached));
                self.add(extent(q, to));
            }
            Shape::Line { from, to } => {
                let start = reach(q, from, reached);
                let end = if rod { swing(q, from, to, start) } else { reach(q, to, reached) };
                self.add(start);
                self.add(end);
                reached.push((*to, end));
            }
            Shape::Mass { at, radius } => {
                let radius = radius.map_or(0.0, |radius| q.number(radius));
                self.add(grown(reach(q, at, reached), radius, is_flat(q, at)));
            }
            Shape::Trace { at } => self.add(reach(q, at, reached)),
            Shape::Body { at } => {
                let radius = Outline::of(q).map_or(0.0, |outline| outline.reach());
                self.add(grown(reach(q, at, reached), radius, false));
            }
            Shape::Circle { centre, radius, normal } | Shape::Disc { centre, radius, normal } => {
                let middle = q.point(centre);
                let normal = q.point(normal);
                for point in circle(middle, q.number(*radius), normal) {
                    self.bounds = self.bounds.with(point);
                }
            }
            Shape::Sphere { centre, radius } => {
                self.add(grown(reach(q, centre, reached), q.number(*radius).abs(), false));
            }
            Shape::Cone { tip, base, radius } => {
                self.add(reach(q, tip, reached));
                self.add(grown(reach(q, base, reached), q.number(*radius).abs(), false));
            }
            Shape::Vector { at, components, .. } => {
                let foot = q.point(at);
                let along = q.point(components);
                self.bounds = self.bounds.with(foot).with([0, 1, 2].map(|k| foot[k] + along[k]));
            }
            Shape::Path { points } => {
                for point in points {
                    self.bounds = self.bounds.with(q.point(point));
                }
            }
            Shape::Plane { at, normal, size } => {
                let at = q.point(at);
                let normal = q.point(normal);
                for corner in square(at, normal, q.number(*size)) {
                    self.bounds = self.bounds.with(corner);
                }
            }
        }
    }

    fn add(&mut self, [low, high]: Span3) {
        self.bounds = self.bounds.with(low).with(high);
    }
}

/// The box around the point that the camera follows, in the picture of the model in its own axes.
fn followed(
    q: &Quantities<'_>,
    eye: CameraPose,
    reference_frame: Option<&ReferenceFrame>,
) -> Option<Bounds> {
    let model = &q.lab.loaded.model;
    let follow = model.follow.as_ref()?;
    if reference_frame.is_some() || eye.own_shapes(model).is_some() {
        return None;
    }
    let (at, reach) = (q.point(&follow.at), q.number(follow.reach).abs());
    let box_of = |plane: bool| grown([at, at], reach, plane);
    let [low, high] = box_of(is_flat(q, &follow.at) && eye.pitch == std::f64::consts::FRAC_PI_2);
    let bounds = Bounds::around([low, high]);
    (reach > 0.0 && bounds.ends() == Some([low, high])).then_some(bounds)
}

/// The greatest of 1, 2 and 5 times a power of ten that does not exceed a length.
fn round_step(length: f64) -> f64 {
    let power = math::powf(10.0, math::log10(length).floor());
    let digit = [5.0, 2.0].into_iter().find(|digit| digit * power <= length);
    digit.unwrap_or(1.0) * power
}

/// The box that the far end of a rod may reach: its extent so far and, in a plane, the circle around the near end. In
/// space the motion rarely fills the sphere.
fn swing(q: &Quantities<'_>, from: &Point, to: &Point, start: Span3) -> Span3 {
    let own = extent(q, to);
    let (a, b) = (q.point(from), q.point(to));
    let moves = own[0] != own[1];
    let length = (0..3).map(|k| math::powi(b[k] - a[k], 2)).sum::<f64>().sqrt();
    let plane = is_flat(q, from) && is_flat(q, to);
    if !moves || !plane || !length.is_finite() {
        return own;
    }
    let round = grown(start, length, plane);
    [0, 1].map(|end| {
        [0, 1, 2]
            .map(|k| if end == 0 { own[0][k].min(round[0][k]) } else { own[1][k].max(round[1][k]) })
    })
}

/// The box that a point may reach: the one found for the end of a rod, or its extent so far.
fn reach(q: &Quantities<'_>, point: &Point, reached: &[(Point, Span3)]) -> Span3 {
    let known = reached.iter().find(|(other, _)| other == point);
    known.map_or_else(|| extent(q, point), |(_, span)| *span)
}

/// The extent of a point's motion so far.
fn extent(q: &Quantities<'_>, point: &Point) -> Span3 {
    let ends = point.map(|expression| match q.place(expression) {
        Source::Number(number) => (number, number),
        Source::Channel(channel) => q.bounds(channel),
    });
    [ends.map(|end| end.0), ends.map(|end| end.1)]
}

fn is_flat(q: &Quantities<'_>, point: &Point) -> bool {
    matches!(q.place(point[2]), Source::Number(z) if z == 0.0)
}

fn grown([low, high]: Span3, by: f64, flat: bool) -> Span3 {
    let by = [by, by, if flat { 0.0 } else { by }];
    [[0, 1, 2].map(|k| low[k] - by[k]), [0, 1, 2].map(|k| high[k] + by[k])]
}
