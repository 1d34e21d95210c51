//! Solids: the surfaces of discs, cones and the pieces of bodies, as faces and balls.
//!
//! In: points in space, radii. Out: flat convex faces, balls. Never here: the camera, or colours.

use super::circle;
use crate::num::math;

/// A piece: its surfaces, the lines along its edges, and its two smaller extents, the smallest first.
#[derive(Clone, Debug)]
pub(super) struct DrawnPiece {
    pub(super) surfaces: Vec<Surface>,
    pub(super) edges: Vec<Vec<[f64; 3]>>,
    pub(super) extents: [f64; 2],
}

impl DrawnPiece {
    /// The same piece with its points at other places; they keep their distances.
    pub(super) fn moved(self, place: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let surfaces = self.surfaces.into_iter().map(|surface| surface.moved(&place)).collect();
        let edges = self.edges.into_iter();
        let edges = edges.map(|line| line.into_iter().map(&place).collect()).collect();
        Self { surfaces, edges, extents: self.extents }
    }
}

/// The two smaller ones of three extents, the smallest first.
pub(super) fn smaller(extents: [f64; 3]) -> [f64; 2] {
    let mut extents = extents.map(f64::abs);
    extents.sort_by(f64::total_cmp);
    [extents[0], extents[1]]
}

/// The smaller extents of a disc.
pub(super) fn disc(radius: f64) -> [f64; 2] {
    smaller([0.0, 2.0 * radius, 2.0 * radius])
}

/// The smaller extents of a cone or a cylinder between two points of its axis.
pub(super) fn along(from: [f64; 3], to: [f64; 3], radius: f64) -> [f64; 2] {
    let length = (0..3).map(|k| math::powi(to[k] - from[k], 2)).sum::<f64>().sqrt();
    smaller([2.0 * radius, 2.0 * radius, length])
}

/// A surface of a piece. What is round has no faces yet: those of a solid that spins about its axis would spin with it, and
/// their light would flicker.
#[derive(Clone, Debug)]
pub(super) enum Surface {
    /// A face or a ball.
    Plain(Occluder),
    /// A cylinder about the line between two points, with its ends or without.
    Cylinder {
        ends: [[f64; 3]; 2],
        radius: f64,
        closed: bool,
    },
    Cone {
        tip: [f64; 3],
        base: [f64; 3],
        radius: f64,
    },
    /// A disc about a centre, and a point above it.
    Disc {
        centre: [f64; 3],
        above: [f64; 3],
        radius: f64,
    },
}

impl Surface {
    /// The same surface with its points at other places; they keep their distances.
    fn moved(self, place: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        match self {
            Self::Plain(solid) => Self::Plain(solid.moved(place)),
            Self::Cylinder { ends, radius, closed } => {
                Self::Cylinder { ends: ends.map(place), radius, closed }
            }
            Self::Cone { tip, base, radius } => {
                Self::Cone { tip: place(tip), base: place(base), radius }
            }
            Self::Disc { centre, above, radius } => {
                Self::Disc { centre: place(centre), above: place(above), radius }
            }
        }
    }

    /// Its faces, where the rim of a radius has every so many corners of a circle.
    pub(super) fn occluders(self, spacing: impl Fn(f64) -> usize) -> Vec<Occluder> {
        match self {
            Self::Plain(solid) => vec![solid],
            Self::Cylinder { ends, radius, closed } => {
                let [low, high] = rims(ends, radius, spacing(radius));
                tube(&low, &high, closed)
            }
            Self::Cone { tip, base, radius } => cone(tip, base, radius, spacing(radius)),
            Self::Disc { centre, above, radius } => {
                let normal = [0, 1, 2].map(|k| above[k] - centre[k]);
                vec![Occluder::Face(circle::rim(centre, radius, normal, spacing(radius)))]
            }
        }
    }
}

/// What hides the things behind it.
#[derive(Clone, Debug)]
pub(super) enum Occluder {
    /// A flat convex face.
    Face(Vec<[f64; 3]>),
    /// A ball about a centre.
    Ball([f64; 3], f64),
}

impl Occluder {
    /// The same solid with its points at other places; they keep their distances.
    pub(super) fn moved(self, place: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        match self {
            Self::Face(corners) => Self::Face(corners.into_iter().map(place).collect()),
            Self::Ball(centre, radius) => Self::Ball(place(centre), radius),
        }
    }
}

/// The least width of what the eye sees of some surfaces, which together are convex: that across one of their edges. Balls are not
/// counted.
pub(super) fn least_width(seen: &[Occluder]) -> f64 {
    let faces = || {
        seen.iter().map(|one| match one {
            Occluder::Face(corners) => corners.as_slice(),
            Occluder::Ball(..) => &[],
        })
    };
    let edges = faces().flat_map(|corners| {
        let next = corners.iter().cycle().skip(1);
        corners.iter().zip(next).map(|(from, to)| [to[0] - from[0], to[1] - from[1]])
    });
    let width = |[x, y]: [f64; 2]| {
        let length = math::hypot(x, y);
        let ends = faces().flatten().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
            let across = (at[0] * y - at[1] * x) / length;
            [low.min(across), high.max(across)]
        });
        ends[1] - ends[0]
    };
    edges.filter(|edge| *edge != [0.0; 2]).map(width).fold(f64::INFINITY, f64::min)
}

/// The surface of a cone, its base first, with every so many corners of its rim.
fn cone(tip: [f64; 3], base: [f64; 3], radius: f64, spacing: usize) -> Vec<Occluder> {
    let axis = [0, 1, 2].map(|k| base[k] - tip[k]);
    let rim = circle::rim(base, radius, axis, spacing);
    let sides = rim.windows(2).map(|pair| Occluder::Face(vec![tip, pair[0], pair[1]])).collect();
    [vec![Occluder::Face(rim.clone())], sides].concat()
}

/// The rims of a cylinder about the centres of its ends, with every so many of their corners.
pub(super) fn rims([from, to]: [[f64; 3]; 2], radius: f64, spacing: usize) -> [Vec<[f64; 3]>; 2] {
    let axis = [0, 1, 2].map(|k| to[k] - from[k]);
    [from, to].map(|centre| circle::rim(centre, radius, axis, spacing))
}

/// The straight lines at which a surface between two rims turns away from the eye, which looks along the third axis.
pub(super) fn silhouette(low: &[[f64; 3]], high: &[[f64; 3]]) -> Vec<[[f64; 3]; 2]> {
    let sides: Vec<[[f64; 3]; 2]> = low.iter().zip(high).map(|(a, b)| [*a, *b]).collect();
    // Whichever rim is a point, the other one has sides of some length.
    let faces_eye = |pair: &[[[f64; 3]; 2]]| {
        let ([a, b], [c, d]) = (pair[0], pair[1]);
        let along = |p: [f64; 3], q: [f64; 3]| [q[0] - p[0], q[1] - p[1]];
        let up = along([0, 1, 2].map(|k| a[k] + c[k]), [0, 1, 2].map(|k| b[k] + d[k]));
        let round = along([0, 1, 2].map(|k| a[k] + b[k]), [0, 1, 2].map(|k| c[k] + d[k]));
        round[0] * up[1] > round[1] * up[0]
    };
    let facing: Vec<bool> = sides.windows(2).map(faces_eye).collect();
    let count = facing.len();
    let turns = (0..count).filter(|&i| facing[i] != facing[(i + count - 1) % count]);
    turns.map(|i| sides[i]).collect()
}

/// The surface of a tube between two rims of the same number of points, with its ends.
pub(super) fn tube(low: &[[f64; 3]], high: &[[f64; 3]], closed: bool) -> Vec<Occluder> {
    let pairs = low.windows(2).zip(high.windows(2));
    let sides = pairs.map(|(l, h)| Occluder::Face(vec![l[0], l[1], h[1], h[0]]));
    let ends = [low, high].map(|rim| Occluder::Face(rim.to_vec()));
    sides.chain(ends.into_iter().filter(|_| closed)).collect()
}

#[cfg(test)]
mod tests {
    use super::{Occluder, least_width, rims, silhouette};

    /// A disc of radius 1 whose normal is at 60° to the line of sight is half as wide as it is long, whichever way it lies.
    #[test]
    fn a_tilted_disc_is_narrower_by_the_cosine_of_its_tilt() {
        let (sin, cos) = (0.75_f64.sqrt(), 0.5);
        for (a, b) in [(0.0, 1.0), (0.6, 0.8), (0.195, 0.981), (1.0, 0.0)] {
            let [rim, _] = rims([[0.0; 3], [sin * a, sin * b, cos]], 1.0, 1);
            let width = least_width(&[Occluder::Face(rim)]);
            assert!((0.99..1.001).contains(&width), "{width}");
        }
        assert_eq!(least_width(&[Occluder::Ball([0.0; 3], 1.0)]), f64::INFINITY);
    }

    /// The eye looks along the third axis, so that a cylinder across it has two edges at its radius.
    #[test]
    fn a_cylinder_has_an_edge_at_each_side_and_none_from_its_end() {
        let [low, high] = rims([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]], 0.5, 1);
        let edges = silhouette(&low, &high);
        assert_eq!(edges.len(), 2, "{edges:?}");
        for [from, to] in edges {
            assert!((from[0].abs() - 0.5).abs() < 0.01, "{from:?}");
            assert!((from[0] - to[0]).abs() < 1e-12 && to[1] - from[1] > 1.9, "{from:?} {to:?}");
        }
        let [low, high] = rims([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]], 0.5, 1);
        assert!(silhouette(&low, &high).is_empty());
    }

    /// From the side the edges of a cone end at the widest places of its rim; from a tip in front of the rim there are none.
    #[test]
    fn a_cone_has_edges_where_its_tip_lies_outside_its_rim() {
        let rim = |base: [f64; 3]| rims([base, base.map(|v| 2.0 * v)], 0.5, 1)[0].clone();
        let upright = rim([0.0, 1.0, 0.0]);
        let edges = silhouette(&vec![[0.0; 3]; upright.len()], &upright);
        assert_eq!(edges.len(), 2);
        assert!(edges.iter().all(|[tip, end]| *tip == [0.0; 3] && end[0].abs() > 0.49));
        let towards = rim([0.1, 0.0, 1.0]);
        assert!(silhouette(&vec![[0.0; 3]; towards.len()], &towards).is_empty());
    }
}
