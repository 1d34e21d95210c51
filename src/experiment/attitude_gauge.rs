//! The gauge of an attitude: whether A is a rotation, and its angle and axis (Euler's theorem: tr A
//! = 1 + 2 cos Φ). Source: *The Principles of Dynamics*, §§ 2.1.2–3.
//!
//! In: the nine entries of A. Out: a [`Gauge`]. Never here: how the entries are computed.

use super::deviation::Deviation;
use super::{Gauge, Reference};
use crate::num::math;
use crate::system::{ChannelKind, System};

#[derive(Clone, Debug)]
pub(super) struct AttitudeGauge {
    /// The channel of the first entry; the others follow in row-major order.
    first: usize,
    deviation: Deviation,
}

/// The name of the gauge of an attitude.
pub const ATTITUDE_GAUGE: &str = "attitude";

impl AttitudeGauge {
    /// Returns the gauge, or `None` if the system has no attitude.
    pub(super) fn of(system: &System) -> Option<AttitudeGauge> {
        let mut kinds = system.channels().iter().map(|c| c.kind);
        let first = kinds.position(|kind| kind == ChannelKind::Attitude(0))?;
        Some(AttitudeGauge { first, deviation: Deviation::since(0.0) })
    }

    pub(super) fn refer(&mut self, time: f64) {
        self.deviation = Deviation::since(time);
    }

    pub(super) fn observe(&mut self, values: &[f64]) {
        self.deviation.observe(missing(&self.matrix(values)));
    }

    pub(super) fn sample(&mut self, time: f64, values: &[f64]) {
        self.deviation.sample(time, missing(&self.matrix(values)));
    }

    /// The deviation from a rotation.
    pub(super) fn now(&self, values: &[f64]) -> f64 {
        missing(&self.matrix(values))
    }

    /// Continues from a saved reference.
    pub(super) fn restore(&mut self, known: &Reference) {
        self.deviation.restore(known);
    }

    fn matrix(&self, values: &[f64]) -> [[f64; 3]; 3] {
        let row = |i: usize| [0, 1, 2].map(|j| values[self.first + 3 * i + j]);
        [row(0), row(1), row(2)]
    }

    pub(super) fn show(&self, values: &[f64]) -> Gauge {
        let a = self.matrix(values);
        let (angle, axis) = turn(&a);
        let [x, y, z] = axis.map(|x| if x.abs() < 5e-4 { 0.0 } else { x });
        let reason =
            format!("A Aᵀ = 1, det A = 1; turned by Φ = {angle:.3} about ({x:.3}, {y:.3}, {z:.3})");
        self.deviation.gauge(ATTITUDE_GAUGE, ATTITUDE_GAUGE, reason, missing(&a))
    }
}

/// The greatest entry of A Aᵀ − 1 in absolute value, or |det A − 1| if that is greater.
fn missing(a: &[[f64; 3]; 3]) -> f64 {
    let mut most = (determinant(a) - 1.0).abs();
    for i in 0..3 {
        for j in 0..3 {
            let product: f64 = (0..3).map(|k| a[i][k] * a[j][k]).sum();
            most = most.max((product - f64::from(u8::from(i == j))).abs());
        }
    }
    most
}

fn determinant(a: &[[f64; 3]; 3]) -> f64 {
    let minor = |i: usize, j: usize| a[1][i] * a[2][j] - a[1][j] * a[2][i];
    a[0][0] * minor(1, 2) - a[0][1] * minor(0, 2) + a[0][2] * minor(0, 1)
}

/// The angle in [0, π] and the axis of the body's rotation. A maps space components to body
/// components, so the rotation is its inverse.
fn turn(a: &[[f64; 3]; 3]) -> (f64, [f64; 3]) {
    let odd = [a[1][2] - a[2][1], a[2][0] - a[0][2], a[0][1] - a[1][0]];
    let size = odd.iter().map(|x| x * x).sum::<f64>().sqrt();
    let trace = a[0][0] + a[1][1] + a[2][2];
    let angle = math::atan2(size, trace - 1.0);
    if size > 1e-6 {
        return (angle, odd.map(|x| x / size));
    }
    if trace > 0.0 {
        return (angle, [0.0; 3]);
    }
    // the angle is π: A + 1 = 2 n nᵀ
    let longest = (0..3).max_by(|&i, &j| a[i][i].total_cmp(&a[j][j])).unwrap_or(0);
    let column = [0, 1, 2].map(|i| a[i][longest] + f64::from(u8::from(i == longest)));
    let length = column.iter().map(|x| x * x).sum::<f64>().sqrt();
    (angle, column.map(|x| x / length))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rotation by an angle about z, as a matrix from space to body components.
    fn about_z(angle: f64) -> [[f64; 3]; 3] {
        let (s, c) = math::sin_cos(angle);
        [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]
    }

    #[test]
    fn a_turn_is_found_by_eulers_theorem() {
        for angle in [1e-3, 0.5, 2.0, 3.1] {
            let (found, axis) = turn(&about_z(angle));
            assert!((found - angle).abs() < 1e-12, "{found} is not {angle}");
            assert_eq!(axis, [0.0, 0.0, 1.0]);
        }
        let (found, axis) = turn(&about_z(-0.5));
        assert!((found - 0.5).abs() < 1e-15);
        assert_eq!(axis, [0.0, 0.0, -1.0]);
        let (half, axis) = turn(&[[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]);
        assert!((half - std::f64::consts::PI).abs() < 1e-15);
        assert_eq!(axis, [0.0, 1.0, 0.0]);
        assert_eq!(turn(&about_z(0.0)), (0.0, [0.0; 3]));
    }

    #[test]
    fn what_is_no_rotation_is_reported() {
        assert!(missing(&about_z(1.0)) < 1e-15);
        let mirror = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
        assert_eq!(missing(&mirror), 2.0);
        let mut sheared = about_z(1.0);
        sheared[0][2] = 0.1;
        assert!(missing(&sheared) > 0.09);
    }
}
