//! A rigid body as it is drawn: the surfaces, edges and rims of its pieces, and its principal axes, in its current attitude.
//!
//! In: the pieces of `[body]`, the attitude's channels, current parameters. Out: lines in space about the centre of
//! mass. Never here: moments of inertia, or the computation of the attitude.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use super::solid::{self, DrawnPiece, Occluder, Surface};
use crate::expr::Expr;
use crate::instrument::CameraPose;
use crate::mechanics::principal;
use crate::model::{Model, Piece, PieceOrientation, Shape, Solid};
use crate::num::{DoubleDouble, math};
use crate::system::ChannelKind;
use crate::view::quantity::Quantities;

/// The number of sides of a drawn rim.
const SIDES: usize = 48;

/// The length of the principal axes relative to the body.
const AXES: f64 = 1.25;

/// The sine and cosine of the direction of each corner of a rim.
static DIRECTIONS: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    (0..=SIDES).map(|side| math::sin_cos(side as f64 * TAU / SIDES as f64)).collect()
});

type Polyline3 = Vec<[f64; 3]>;

/// The body's lines about its centre of mass, in the axes of space.
pub(super) struct Outline {
    /// What has an extent: surfaces, which hide what is behind them, rims and edges.
    pub(super) pieces: Vec<DrawnPiece>,
    /// The principal axes, from the centre of mass.
    pub(super) axes: Vec<Polyline3>,
    pub(super) points: Vec<[f64; 3]>,
}

impl Outline {
    /// The current outline of the model's body, or `None` if there is none in the picture.
    pub(super) fn of(q: &Quantities<'_>, eye: CameraPose) -> Option<Self> {
        let model: &Model = &q.lab.loaded.model;
        let body = model.body.as_ref()?;
        if !q.lab.shapes(eye).any(|(shape, _)| matches!(shape, Shape::Body { .. })) {
            return None;
        }
        let now = q.lab.valuation();
        let value = |e: Expr| now.value(&model.pool, e);
        let centre = body.names.centre.map(|symbol| now.at(symbol));
        let mut outline = Self { pieces: Vec::new(), axes: Vec::new(), points: Vec::new() };
        for piece in &body.pieces {
            let at = piece.at.map(value);
            let turn = turns(piece, &value);
            let place = |own: [f64; 3]| {
                let turned = turn.iter().fold(own, |v, turn| turn.of(v));
                [0, 1, 2].map(|k| at[k] + turned[k] - centre[k])
            };
            // a weight of no mass is not there
            if matches!(piece.solid, Solid::Point) && value(piece.mass) != 0.0 {
                outline.points.push(place([0.0; 3]));
            }
            let drawn = DrawnPiece {
                surfaces: surfaces(&piece.solid, &value),
                edges: lines(&piece.solid, &value),
                extents: extents(&piece.solid, &value),
            };
            outline.pieces.push(drawn.moved(place));
        }
        let reach = AXES * outline.reach();
        let inertia = body.names.inertia.map(|symbol| DoubleDouble::from(now.at(symbol)));
        let (_, axes) = principal(&inertia);
        outline.axes = axes.map(|axis| vec![[0.0; 3], axis.map(|n| reach * n)]).to_vec();
        Some(outline.rotated(q))
    }

    /// The distance of the farthest part from the centre of mass.
    pub(super) fn reach(&self) -> f64 {
        let edges = self.pieces.iter().flat_map(|piece| &piece.edges);
        let all = edges.chain(&self.axes).flatten().chain(&self.points);
        let far = all.map(|p| p.iter().map(|x| x * x).sum::<f64>().sqrt());
        far.filter(|r| r.is_finite()).fold(0.0, f64::max)
    }

    /// Rotates the outline from the body's axes to those of space, by the transpose of A.
    fn rotated(self, q: &Quantities<'_>) -> Self {
        let channels = q.lab.loaded.system.channels();
        let entry = |i: usize| {
            let place = channels.iter().position(|c| c.kind == ChannelKind::Attitude(i));
            place.map(|place| q.value(place))
        };
        let Some(a) = (0..9).map(entry).collect::<Option<Vec<f64>>>() else { return self };
        let rotate = |b: [f64; 3]| [0, 1, 2].map(|k| (0..3).map(|i| a[3 * i + k] * b[i]).sum());
        let axes = self.axes.into_iter();
        Self {
            pieces: self.pieces.into_iter().map(|piece| piece.moved(rotate)).collect(),
            axes: axes.map(|line| line.into_iter().map(rotate).collect()).collect(),
            points: self.points.into_iter().map(rotate).collect(),
        }
    }
}

/// The rotations, the first one first, from a piece's own axes to the body's.
fn turns(piece: &Piece, value: &impl Fn(Expr) -> f64) -> Vec<AxisRotation> {
    match &piece.turn {
        PieceOrientation::None => Vec::new(),
        PieceOrientation::Axis { axis, angle } => {
            vec![AxisRotation::about(axis.map(value), value(*angle))]
        }
        PieceOrientation::Euler([phi, theta, psi]) => {
            let (x, z) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
            let turns = [(z, psi), (x, theta), (z, phi)];
            turns.map(|(axis, angle)| AxisRotation::about(axis, value(*angle))).to_vec()
        }
    }
}

/// A rotation about an axis by the right-hand rule: v cos α + (n×v) sin α + n (n·v)(1 − cos α).
#[derive(Clone, Copy)]
struct AxisRotation {
    n: [f64; 3],
    sin: f64,
    cos: f64,
}

impl AxisRotation {
    fn about(axis: [f64; 3], angle: f64) -> Self {
        let length = axis.iter().map(|a| a * a).sum::<f64>().sqrt();
        let (sin, cos) = math::sin_cos(angle);
        Self { n: axis.map(|a| a / length), sin, cos }
    }

    fn of(&self, v: [f64; 3]) -> [f64; 3] {
        let Self { n, sin, cos } = *self;
        let along: f64 = (0..3).map(|k| n[k] * v[k]).sum();
        [0, 1, 2].map(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            v[k] * cos + (n[i] * v[j] - n[j] * v[i]) * sin + n[k] * along * (1.0 - cos)
        })
    }
}

/// The rims and edges of a solid in its own axes, about its centre of mass.
fn lines(solid: &Solid, value: &impl Fn(Expr) -> f64) -> Vec<Polyline3> {
    let rim =
        |radius: f64, z: f64| -> Polyline3 { circle(radius).map(|[x, y]| [x, y, z]).collect() };
    let sides = |low: (f64, f64), high: (f64, f64)| {
        [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]
            .map(|[x, y]| vec![[low.0 * x, low.0 * y, low.1], [high.0 * x, high.0 * y, high.1]])
    };
    match solid {
        Solid::Point => Vec::new(),
        Solid::Sphere(radius) | Solid::SphericalShell(radius) => {
            let r = value(*radius);
            vec![
                rim(r, 0.0),
                circle(r).map(|[x, z]| [x, 0.0, z]).collect(),
                circle(r).map(|[y, z]| [0.0, y, z]).collect(),
            ]
        }
        Solid::Cylinder { radius, length } | Solid::CylindricalShell { radius, length } => {
            let (r, half) = (value(*radius), value(*length) / 2.0);
            let mut all = vec![rim(r, -half), rim(r, half)];
            all.extend(sides((r, -half), (r, half)));
            all
        }
        // The centre of mass is a quarter of the height above the base.
        Solid::Cone { radius, height } => {
            let (r, h) = (value(*radius), value(*height));
            let mut all = vec![rim(r, -h / 4.0)];
            all.extend(sides((r, -h / 4.0), (0.0, 0.75 * h)));
            all
        }
        Solid::Disc(radius) => {
            let r = value(*radius);
            let mut all = vec![rim(r, 0.0)];
            all.extend(sides((0.0, 0.0), (r, 0.0)));
            all
        }
        Solid::Ring(radius) => vec![rim(value(*radius), 0.0)],
        Solid::Rod(length) => {
            let half = value(*length) / 2.0;
            vec![vec![[0.0, 0.0, -half], [0.0, 0.0, half]]]
        }
        Solid::Cuboid(edges) => {
            let half = edges.map(|e| value(e) / 2.0);
            let corner =
                |i: usize| [0, 1, 2].map(|k| if i >> k & 1 == 0 { -half[k] } else { half[k] });
            let edge =
                |i: usize, k: usize| (i >> k & 1 == 0).then(|| vec![corner(i), corner(i | 1 << k)]);
            (0..8).flat_map(|i| (0..3).filter_map(move |k| edge(i, k))).collect()
        }
    }
}

/// The surface of a solid in its own axes, about its centre of mass; what is thin has none.
fn surfaces(solid: &Solid, value: &impl Fn(Expr) -> f64) -> Vec<Surface> {
    let on_axis = |z: f64| [0.0, 0.0, z];
    match solid {
        Solid::Point | Solid::Ring(_) | Solid::Rod(_) => Vec::new(),
        Solid::Sphere(radius) | Solid::SphericalShell(radius) => {
            vec![Surface::Plain(Occluder::Ball([0.0; 3], value(*radius)))]
        }
        Solid::Cylinder { radius, length } | Solid::CylindricalShell { radius, length } => {
            let half = value(*length) / 2.0;
            let closed = matches!(solid, Solid::Cylinder { .. });
            let ends = [-half, half].map(on_axis);
            vec![Surface::Cylinder { ends, radius: value(*radius), closed }]
        }
        Solid::Cone { radius, height } => {
            let h = value(*height);
            let [tip, base] = [0.75 * h, -h / 4.0].map(on_axis);
            vec![Surface::Cone { tip, base, radius: value(*radius) }]
        }
        Solid::Disc(radius) => {
            let radius = value(*radius);
            vec![Surface::Disc { centre: [0.0; 3], above: on_axis(radius), radius }]
        }
        Solid::Cuboid(edges) => {
            let half = edges.map(|e| value(e) / 2.0);
            let square = |z: f64| -> Polyline3 {
                [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)]
                    .map(|(x, y)| [x * half[0], y * half[1], z])
                    .to_vec()
            };
            let faces = solid::tube(&square(-half[2]), &square(half[2]), true);
            faces.into_iter().map(Surface::Plain).collect()
        }
    }
}

/// The two smaller extents of a solid, the smallest first.
fn extents(solid: &Solid, value: &impl Fn(Expr) -> f64) -> [f64; 2] {
    match solid {
        Solid::Point | Solid::Ring(_) | Solid::Rod(_) => [0.0; 2],
        Solid::Sphere(radius) | Solid::SphericalShell(radius) => {
            solid::smaller([2.0 * value(*radius); 3])
        }
        Solid::Cylinder { radius, length: along }
        | Solid::CylindricalShell { radius, length: along }
        | Solid::Cone { radius, height: along } => {
            let across = 2.0 * value(*radius);
            solid::smaller([across, across, value(*along)])
        }
        Solid::Disc(radius) => solid::disc(value(*radius)),
        Solid::Cuboid(edges) => solid::smaller(edges.map(value)),
    }
}

fn circle(radius: f64) -> impl Iterator<Item = [f64; 2]> {
    DIRECTIONS.iter().map(move |(sin, cos)| [radius * cos, radius * sin])
}
