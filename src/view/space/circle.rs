//! Circles and squares in space.
//!
//! In: a centre, a size, a normal. Out: points in order. Never here: what they belong to.

use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use crate::num::math;

const SIDES: i32 = 96;

/// The sine and cosine of the direction of each corner.
static DIRECTIONS: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    (0..=SIDES).map(|side| math::sin_cos(f64::from(side) * TAU / f64::from(SIDES))).collect()
});

/// The points of a circle about an axis.
pub(super) fn circle(centre: [f64; 3], radius: f64, normal: [f64; 3]) -> Vec<[f64; 3]> {
    rim(centre, radius, normal, 1)
}

/// The points of the rim of a solid: every so many corners of a circle.
pub(super) fn rim(
    centre: [f64; 3],
    radius: f64,
    normal: [f64; 3],
    spacing: usize,
) -> Vec<[f64; 3]> {
    let [u, v] = perpendicular(normal);
    let point = |&(sin, cos): &(f64, f64)| {
        [0, 1, 2].map(|k| centre[k] + radius * (cos * u[k] + sin * v[k]))
    };
    DIRECTIONS.iter().step_by(spacing).map(point).collect()
}

/// Every how many corners are enough for a rim of this many dots in radius: no side is then farther than a quarter of a
/// dot from the circle, by r (1 − cos π/n) < r π²/(2 n²).
pub(super) fn spacing(radius: f64) -> usize {
    let off =
        |spacing: i32| radius * math::powi(PI * f64::from(spacing) / f64::from(SIDES), 2) / 2.0;
    [4, 2].into_iter().find(|spacing| off(*spacing) < 0.25).map_or(1, |spacing| spacing as usize)
}

/// The outline of a square with the given normal and edge.
pub(super) fn square(centre: [f64; 3], normal: [f64; 3], edge: f64) -> Vec<[f64; 3]> {
    let [u, v] = perpendicular(normal);
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let corner =
        |(a, b): (f64, f64)| [0, 1, 2].map(|k| centre[k] + edge / 2.0 * (a * u[k] + b * v[k]));
    corners.into_iter().map(corner).collect()
}

/// Two unit vectors orthogonal to a normal and to each other; for a zero normal, those of the x–y plane.
fn perpendicular(normal: [f64; 3]) -> [[f64; 3]; 2] {
    let length = normal.iter().map(|v| v * v).sum::<f64>().sqrt();
    if !length.is_finite() || length == 0.0 {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    }
    let n = normal.map(|v| v / length);
    // An axis far from the normal avoids cancellation.
    let helper = if n[2].abs() > 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] };
    let u = unit(cross(helper, n));
    [u, cross(n, u)]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|v| v * v).sum::<f64>().sqrt();
    v.map(|v| v / length)
}
