//! The scene: the points of the shapes, and the box that contains all they may reach.
//!
//! In: shapes and the bounds of their channels. Out: points, and a box that rarely changes. Never here: the camera.

use ratatui::layout::Rect;

use super::body::Outline;
use super::circle::{circle, rim, square};
use super::reference_frame::ReferenceFrame;
use crate::expr::{Expr, Symbol};
use crate::instrument::CameraPose;
use crate::model::{Point, Shape};
use crate::num::{OrientationPolytope, math};
use crate::view::plot::{Bounds, Camera, Extent, MARGIN, PlotFrame};
use crate::view::quantity::{Quantities, QuantitySource};

pub(super) struct Scene {
    /// The box that contains everything.
    bounds: Bounds,
    /// What each shape may reach.
    extents: Vec<Extent>,
    /// The points of what stays where it is.
    points: Vec<[f64; 3]>,
}

/// Two opposite corners of a box.
type Span3 = [[f64; 3]; 2];

impl Scene {
    /// The scene of a lab.
    ///
    /// A rod (a line of constant length) may swing around one of its ends. The box contains its whole circle from the
    /// start, so that the picture does not shrink during the first swing. A free rod does not swing around its ends.
    pub(super) fn of(
        (q, body): (&Quantities<'_>, Option<&Outline>),
        eye: CameraPose,
        reference_frame: Option<&ReferenceFrame>,
    ) -> Self {
        let mut scene = Self { bounds: Bounds::EMPTY, extents: Vec::new(), points: Vec::new() };
        if let Some(extent) = followed(q, eye, reference_frame) {
            scene.add([extent.low, extent.high], extent.radius, None);
            return scene;
        }
        let mut reached: Vec<(Point, Span3)> = Vec::new();
        for (shape, rod) in q.lab.shapes(eye) {
            scene.include((q, body), (shape, rod), &mut reached);
        }
        // What moves is rounded outwards, so that the picture does not move while the motion grows a little.
        if let Some([low, high]) = scene.bounds.ends() {
            let longest = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
            let step = round_step(longest / 10.0);
            scene.bounds = rounded([low, high], step).map_or(scene.bounds, Bounds::around);
            for extent in &mut scene.extents {
                if let Some([low, high]) = rounded([extent.low, extent.high], step) {
                    let hull = extent.hull.map(|hull| hull.rounded(step));
                    *extent = Extent { low, high, hull, ..*extent };
                }
            }
        }
        if let Some([x, y]) = q.lab.plane_before(eye) {
            // the margin is in these ranges
            let corner = |k: usize| [x, y].map(|ends| within(ends, k));
            for [x, y] in [0, 1].map(corner) {
                scene.bounds = scene.bounds.with([x, y, 0.0]);
            }
        }
        match reference_frame {
            Some(reference_frame) => scene.seen_from(q, reference_frame),
            None => scene,
        }
    }

    /// The same scene as seen from a frame.
    fn seen_from(self, q: &Quantities<'_>, reference_frame: &ReferenceFrame) -> Self {
        let mut scene = Self { bounds: Bounds::EMPTY, extents: Vec::new(), points: Vec::new() };
        let still = |&point: &[f64; 3]| Extent { low: point, high: point, radius: 0.0, hull: None };
        let still = self.points.iter().map(still);
        for extent in self.extents.iter().copied().chain(still) {
            let seen = reference_frame.around(q, &extent);
            let flat = is_level([seen.low, seen.high]) && reference_frame.keeps_planes(q);
            scene.include_extent(&seen, flat);
        }
        scene
    }

    /// The frame over an area in which the whole scene is seen.
    pub(super) fn frame(&self, camera: &Camera, area: Rect) -> PlotFrame {
        let flat = self.bounds.ends().is_some_and(is_level);
        let face_on = camera.pitch == Camera::FACE_ON.pitch && camera.yaw == Camera::FACE_ON.yaw;
        if flat && face_on || self.extents.is_empty() && self.points.is_empty() {
            camera.frame(&self.bounds, area)
        } else {
            camera.frame_with(&self.extents, &self.points, area)
        }
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
        (q, body): (&Quantities<'_>, Option<&Outline>),
        (shape, rod): (&Shape, bool),
        reached: &mut Vec<(Point, Span3)>,
    ) {
        match shape {
            Shape::Spring { from, to } => {
                self.reached(q, from, reached, 0.0);
                self.add(extent(q, to), 0.0, hull(q, to));
            }
            Shape::Line { from, to } => {
                let start = reach(q, from, reached);
                let swings = rod && !is_free(q, from, to);
                self.reached(q, from, reached, 0.0);
                if swings && let Some(circle) = swing(q, from, to, start) {
                    reached.push((*to, circle));
                }
                self.reached(q, to, reached, 0.0);
            }
            Shape::Mass { at, radius } => {
                let radius = radius.map_or(0.0, |radius| room(q, radius));
                self.reached(q, at, reached, radius);
            }
            Shape::Trace { at } => self.reached(q, at, reached, 0.0),
            // Words need no room of their own: they end where the picture does.
            Shape::Caption { .. } => {}
            Shape::Body { at } => {
                let radius = body.map_or(0.0, Outline::reach);
                self.reached(q, at, reached, radius);
            }
            Shape::Circle { centre, radius, normal }
            | Shape::Disc { centre, radius, normal, .. } => {
                let radius = room(q, *radius);
                if rests(q, centre) && rests(q, normal) {
                    self.points(circle(q.point(centre), radius, q.point(normal)));
                } else if rests(q, normal) {
                    self.rim(q, (centre, radius, q.point(normal)), reached);
                } else {
                    // A rim that turns may be anywhere on the sphere.
                    self.reached(q, centre, reached, radius);
                }
            }
            Shape::Sphere { centre, radius } => {
                self.reached(q, centre, reached, room(q, *radius));
            }
            Shape::Cone { tip, base, radius } => {
                self.reached(q, tip, reached, 0.0);
                self.reached(q, base, reached, room(q, *radius));
            }
            Shape::Cylinder { from, to, radius } => {
                let radius = room(q, *radius);
                self.reached(q, from, reached, radius);
                self.reached(q, to, reached, radius);
            }
            Shape::Vector { at, components, .. } => {
                let foot = reach(q, at, reached);
                self.reached(q, at, reached, 0.0);
                let along = extent(q, components);
                let tip = [0, 1].map(|end| [0, 1, 2].map(|k| foot[end][k] + along[end][k]));
                let both = hull(q, at).zip(hull(q, components)).map(|(a, b)| a.plus(&b));
                self.add(tip, 0.0, both);
            }
            Shape::Path { points } => self.points(points.iter().map(|point| q.point(point))),
            Shape::Plane { at, normal, size } => {
                self.points(square(q.point(at), q.point(normal), room(q, *size)));
            }
        }
    }

    /// Adds what a point may reach, with a ball around it.
    fn reached(
        &mut self,
        q: &Quantities<'_>,
        point: &Point,
        reached: &[(Point, Span3)],
        radius: f64,
    ) {
        // The circle of a rod is wider than what its end has reached so far.
        let swings = reached.iter().any(|(other, _)| other == point);
        let hull = hull(q, point).filter(|_| !swings);
        self.add(reach(q, point, reached), radius, hull);
    }

    /// Adds a circle that keeps its direction wherever its centre may be.
    fn rim(
        &mut self,
        q: &Quantities<'_>,
        (centre, radius, normal): (&Point, f64, [f64; 3]),
        reached: &[(Point, Span3)],
    ) {
        let (span, hull) = (reach(q, centre, reached), hull(q, centre));
        for corner in rim([0.0; 3], radius, normal, CORNERS) {
            let span = span.map(|end| [0, 1, 2].map(|k| end[k] + corner[k]));
            let hull = hull.as_ref().map(|hull| hull.plus(&OrientationPolytope::around(corner)));
            self.add(span, 0.0, hull);
        }
    }

    fn add(&mut self, [low, high]: Span3, radius: f64, hull: Option<OrientationPolytope>) {
        self.include_extent(&Extent { low, high, radius, hull }, is_level([low, high]));
    }

    fn include_extent(&mut self, extent: &Extent, flat: bool) {
        let [lowest, highest] = grown([extent.low, extent.high], extent.radius, flat);
        if [lowest, highest].as_flattened().iter().all(|v| v.is_finite()) {
            self.bounds = self.bounds.with(lowest).with(highest);
            self.extents.push(*extent);
        }
    }

    /// Adds points that stay where they are.
    fn points(&mut self, points: impl IntoIterator<Item = [f64; 3]>) {
        for point in points.into_iter().filter(|p| p.iter().all(|v| v.is_finite())) {
            self.bounds = self.bounds.with(point);
            self.points.push(point);
        }
    }
}

/// An end of a range without the margin that a camera leaves at each side.
fn within([low, high]: [f64; 2], end: usize) -> f64 {
    let half = (high - low) / 2.0 / MARGIN;
    f64::midpoint(low, high) + if end == 0 { -half } else { half }
}

/// What is around the point that the camera follows, and around the same point of the comparison motion, in the picture of the
/// model in its own axes.
fn followed(
    q: &Quantities<'_>,
    eye: CameraPose,
    reference_frame: Option<&ReferenceFrame>,
) -> Option<Extent> {
    let model = &q.lab.loaded.model;
    let follow = model.picture.follow.as_ref()?;
    if reference_frame.is_some() || eye.own_shapes(model).is_some() {
        return None;
    }
    let (at, radius) = (q.point(&follow.at), q.number(follow.reach).abs());
    let finite = |ends: Span3| ends.as_flattened().iter().all(|v| v.is_finite());
    let beside = follow.beside.map(|at| q.point(&at)).filter(|other| finite([*other, at]));
    // two motions that part are both in the picture until it would make them small
    let apart =
        |other: [f64; 3]| (0..3).map(|k| math::powi(other[k] - at[k], 2)).sum::<f64>().sqrt();
    let nearer = |other: [f64; 3]| {
        let share = (MOST_RADII * radius / apart(other)).min(1.0);
        [0, 1, 2].map(|k| at[k] + share * (other[k] - at[k]))
    };
    let other = beside.map_or(at, nearer);
    let low = [0, 1, 2].map(|k| at[k].min(other[k]));
    let high = [0, 1, 2].map(|k| at[k].max(other[k]));
    (radius > 0.0 && finite(grown([low, high], radius, false))).then_some(Extent {
        low,
        high,
        radius,
        hull: None,
    })
}

/// How far the comparison motion is followed, in radii of what is around the point that the camera follows.
const MOST_RADII: f64 = 3.0;

/// Every how many corners of a circle its place is taken from.
const CORNERS: usize = 4;

/// The part of a step to which a box is rounded where it is thinner than that.
const THIN: f64 = 0.01;

/// A box rounded outwards to multiples of a length where it is not flat, or of a hundredth of it where it is thin, such as by the
/// rounding errors of what is conserved; `None` if that leaves the range of numbers.
fn rounded([low, high]: Span3, step: f64) -> Option<Span3> {
    let corner = |end: [f64; 3], round: fn(f64) -> f64| {
        [0, 1, 2].map(|k| {
            let step = if high[k] - low[k] < THIN * step { THIN * step } else { step };
            if low[k] == high[k] { end[k] } else { round(end[k] / step) * step }
        })
    };
    let ends = [corner(low, f64::floor), corner(high, f64::ceil)];
    ends.as_flattened().iter().all(|v| v.is_finite()).then_some(ends)
}

/// The room for a radius or an edge. What is computed of the motion is rounded up by at most a hundredth, so that the picture
/// does not move with the rounding errors of a number that is otherwise constant.
fn room(q: &Quantities<'_>, length: Expr) -> f64 {
    let length = q.number(length).abs();
    let step = round_step(length / 100.0);
    let rounded = (length / step - SPARE).ceil() * step;
    if rounded.is_finite() { rounded } else { length }
}

/// By how much of a step a multiple of it may be missed by rounding errors.
const SPARE: f64 = 1e-6;

/// The greatest of 1, 2 and 5 times a power of ten that does not exceed a length.
fn round_step(length: f64) -> f64 {
    let power = math::powf(10.0, math::log10(length).floor());
    let digit = [5.0, 2.0].into_iter().find(|digit| digit * power <= length);
    digit.unwrap_or(1.0) * power
}

/// The box that the far end of a rod may reach in a plane: its extent so far and the circle around the near end. In
/// space there is none, because the motion rarely fills the sphere.
fn swing(q: &Quantities<'_>, from: &Point, to: &Point, start: Span3) -> Option<Span3> {
    let own = extent(q, to);
    let (a, b) = (q.point(from), q.point(to));
    let length = (0..3).map(|k| math::powi(b[k] - a[k], 2)).sum::<f64>().sqrt();
    let plane = is_flat(q, from) && is_flat(q, to);
    if rests(q, to) || !plane || !length.is_finite() {
        return None;
    }
    let round = grown(start, length, plane);
    Some([0, 1].map(|end| {
        [0, 1, 2]
            .map(|k| if end == 0 { own[0][k].min(round[0][k]) } else { own[1][k].max(round[1][k]) })
    }))
}

/// Whether a rod swings around neither of its ends: both move with the same coordinates, so none of them is the angle at
/// the other.
fn is_free(q: &Quantities<'_>, from: &Point, to: &Point) -> bool {
    let equations = &q.lab.loaded.equations;
    let moves = |point: &Point, with: Symbol| {
        point.iter().any(|component| equations.pool.depends(*component, with))
    };
    let mut coordinates = equations.coordinates.iter().map(|c| c.position);
    coordinates.all(|q| moves(from, q) == moves(to, q))
}

/// Whether a point is the same at all times: given by numbers and by parameters that do not change with the time.
pub(super) fn rests(q: &Quantities<'_>, point: &Point) -> bool {
    point.iter().all(|expression| q.is_constant(*expression))
}

/// The box that a point may reach: the one found for the end of a rod, or its extent so far.
fn reach(q: &Quantities<'_>, point: &Point, reached: &[(Point, Span3)]) -> Span3 {
    let known = reached.iter().find(|(other, _)| other == point);
    known.map_or_else(|| extent(q, point), |(_, span)| *span)
}

/// The extent of a point's motion so far.
fn extent(q: &Quantities<'_>, point: &Point) -> Span3 {
    let ends = point.map(|expression| match q.place(expression) {
        QuantitySource::Number(number) => (number, number),
        QuantitySource::Channel(channel) => {
            // a motion that was begun in a picture keeps its window
            let before = q.lab.window_before(channel);
            let set = q.lab.least_range(channel).map(|[from, to]| (from, to));
            let more = [before, set].into_iter().flatten();
            more.fold(q.bounds(channel), |(lo, hi), (from, to)| (lo.min(from), hi.max(to)))
        }
    });
    [ends.map(|end| end.0), ends.map(|end| end.1)]
}

/// The polytope that contains a point's motion so far, if its hull is recorded or it does not move, and no more is to be in
/// the picture.
fn hull(q: &Quantities<'_>, point: &Point) -> Option<OrientationPolytope> {
    let sources = point.map(|expression| q.place(expression));
    let channels = sources.map(|source| match source {
        QuantitySource::Channel(channel) => Some(channel),
        QuantitySource::Number(_) => None,
    });
    if channels.iter().flatten().any(|channel| q.lab.least_range(*channel).is_some()) {
        return None;
    }
    let constant = sources.map(|source| match source {
        QuantitySource::Number(number) => number,
        QuantitySource::Channel(_) => 0.0,
    });
    let rest = OrientationPolytope::around(constant);
    if channels == [None; 3] {
        return Some(rest).filter(|rest| !rest.is_empty());
    }
    let known = q.snapshot.hulls.iter().find(|hull| hull.channels == channels)?;
    let polytope = match q.lab.hull_before(channels) {
        Some(before) => known.polytope.joined(before),
        None => known.polytope,
    };
    Some(polytope).filter(|hull| !hull.is_empty()).map(|hull| hull.plus(&rest))
}

fn is_flat(q: &Quantities<'_>, point: &Point) -> bool {
    matches!(q.place(point[2]), QuantitySource::Number(z) if z == 0.0)
}

/// Whether a box is in the plane z = 0.
fn is_level([low, high]: Span3) -> bool {
    low[2] == 0.0 && high[2] == 0.0
}

fn grown([low, high]: Span3, by: f64, flat: bool) -> Span3 {
    let by = [by, by, if flat { 0.0 } else { by }];
    [[0, 1, 2].map(|k| low[k] - by[k]), [0, 1, 2].map(|k| high[k] + by[k])]
}
