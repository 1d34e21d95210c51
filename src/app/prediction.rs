//! A prediction on a picture: a point or a curve that was set before the motion goes there.
//!
//! In: the quantities on the two axes, points in their units, afterwards what the motion did. Out: the smooth curve
//! through the points, and how far it is from the motion. Never here: who predicts, cells.

use super::pane::Pane;
use crate::instrument::{MotionCurve, Plot};
use crate::num::math;

/// The number of pieces of a smooth curve between two of its points.
const PIECES: usize = 16;

/// A prediction, which is drawn on every plot with the same axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// The axes, the horizontal one first.
    pub axes: [PredictedAxis; 2],
    /// Whether the points lie on a curve; otherwise there is at most one.
    pub is_curve: bool,
    /// The points, in the units of the axes.
    pub points: Vec<[f64; 2]>,
    /// What the motion did, once it is to be shown: one point, or a curve.
    pub outcome: Vec<[f64; 2]>,
    /// The pane that had the focus before.
    pub before: Option<Pane>,
}

/// An axis of a prediction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PredictedAxis {
    /// The channel; `None` for the time.
    pub channel: Option<usize>,
    /// What the axis shows at least, from the less to the greater.
    pub range: Option<[f64; 2]>,
    /// The distance along this axis within which a prediction is right, above zero.
    pub within: f64,
}

impl Prediction {
    /// Whether a plot has these axes.
    pub fn is_on(&self, plot: &Plot) -> bool {
        let [across, upwards] = self.axes.map(|axis| axis.channel);
        match (plot.kind.properties().curve, across) {
            (Some(MotionCurve::AgainstTime), None) => plot
                .columns
                .first()
                .is_some_and(|shown| upwards.is_some_and(|channel| shown.contains(&channel))),
            (Some(MotionCurve::Portrait), Some(_)) => {
                [plot.column(0), plot.column(1)] == [across, upwards]
            }
            _ => false,
        }
    }

    /// The curve through the points, or the point.
    pub fn line(&self) -> Vec<[f64; 2]> {
        self.smooth(&self.points)
    }

    /// The smooth curve through these points: a centripetal Catmull-Rom spline, in which the unit of length along each
    /// axis is the distance that is right. (C. Yuksel, S. Schaefer, J. Keyser, Computer-Aided Design 43, 747 (2011).)
    pub fn smooth(&self, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut points = points.to_vec();
        points.dedup();
        let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return points };
        if points.len() < 2 {
            return points;
        }
        let beyond = |end: [f64; 2], next: [f64; 2]| [0, 1].map(|k| 2.0 * end[k] - next[k]);
        let before = beyond(first, points[1]);
        let after = beyond(last, points[points.len() - 2]);
        let all: Vec<[f64; 2]> = [before].into_iter().chain(points).chain([after]).collect();
        let mut line = vec![first];
        for four in all.windows(4) {
            let knots = four.iter().enumerate().skip(1).fold(vec![0.0], |mut knots, (k, point)| {
                let length = self.length(four[k - 1], *point).sqrt();
                knots.push(knots[k - 1] + length);
                knots
            });
            for piece in 1..=PIECES {
                let share = piece as f64 / PIECES as f64;
                line.push(spline(four, &knots, knots[1] + share * (knots[2] - knots[1])));
            }
        }
        line
    }

    /// The distance of the motion from the prediction, in units of what is right: of two points, or the Hausdorff
    /// distance of two curves. `None` where one of them is missing.
    pub fn distance(&self, outcome: &[[f64; 2]]) -> Option<f64> {
        let line = self.line();
        let (false, false) = (line.is_empty(), outcome.is_empty()) else { return None };
        Some(self.farthest(&line, outcome).max(self.farthest(outcome, &line)))
    }

    /// So many points of a curve, at equal distances along it.
    pub fn spread(&self, curve: &[[f64; 2]], count: usize) -> Vec<[f64; 2]> {
        let mut along = vec![0.0];
        for piece in curve.windows(2) {
            along.push(along[along.len() - 1] + self.length(piece[0], piece[1]));
        }
        let (Some(whole), Some(first)) =
            (along.last().filter(|length| **length > 0.0), curve.first())
        else {
            return curve.first().copied().into_iter().collect();
        };
        let steps = count.saturating_sub(1).max(1);
        let at = |step: usize| {
            let wanted = whole * step as f64 / steps as f64;
            let piece = along.partition_point(|length| *length < wanted).min(curve.len() - 1);
            let Some(before) = piece.checked_sub(1) else { return *first };
            let length = along[piece] - along[before];
            let share = if length > 0.0 { (wanted - along[before]) / length } else { 1.0 };
            [0, 1].map(|k| curve[before][k] + share * (curve[piece][k] - curve[before][k]))
        };
        (0..=steps).map(at).collect()
    }

    /// The greatest distance of a point of one curve from the other curve.
    fn farthest(&self, points: &[[f64; 2]], line: &[[f64; 2]]) -> f64 {
        let nearest = |point: &[f64; 2]| {
            let pieces = line.windows(2).map(|piece| self.off(*point, piece[0], piece[1]));
            let ends = line.first().map(|end| self.length(*point, *end));
            pieces.chain(ends).fold(f64::INFINITY, f64::min)
        };
        points.iter().map(nearest).fold(0.0, f64::max)
    }

    /// The distance of a point from a straight piece.
    fn off(&self, point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
        let scaled = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|k| (b[k] - a[k]) / self.axes[k].within);
        let (along, there) = (scaled(from, to), scaled(from, point));
        let square = along[0] * along[0] + along[1] * along[1];
        let share = if square > 0.0 {
            ((along[0] * there[0] + along[1] * there[1]) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        math::hypot(there[0] - share * along[0], there[1] - share * along[1])
    }

    fn length(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let [x, y] = [0, 1].map(|k| (to[k] - from[k]) / self.axes[k].within);
        math::hypot(x, y)
    }
}

/// The value of the spline through the middle two of four points, by the pyramid of Barry and Goldman.
fn spline(points: &[[f64; 2]], knots: &[f64], at: f64) -> [f64; 2] {
    let between = |a: [f64; 2], b: [f64; 2], from: f64, to: f64| {
        let share = if to > from { (at - from) / (to - from) } else { 0.0 };
        [0, 1].map(|k| a[k] + share * (b[k] - a[k]))
    };
    let lines = [0, 1, 2].map(|k| between(points[k], points[k + 1], knots[k], knots[k + 1]));
    let arcs = [0, 1].map(|k| between(lines[k], lines[k + 1], knots[k], knots[k + 2]));
    between(arcs[0], arcs[1], knots[1], knots[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(within: [f64; 2], points: &[[f64; 2]]) -> Prediction {
        let axes = within.map(|within| PredictedAxis { channel: None, range: None, within });
        Prediction {
            axes,
            is_curve: true,
            points: points.to_vec(),
            outcome: Vec::new(),
            before: None,
        }
    }

    #[test]
    fn a_smooth_curve_passes_through_its_points_and_follows_a_straight_line() {
        let points = [[0.0, 0.0], [1.0, 2.0], [4.0, 8.0]];
        let straight = curve([1.0, 1.0], &points).line();
        assert!(straight.iter().all(|[x, y]| (y - 2.0 * x).abs() < 1e-12), "{straight:?}");
        let bent = curve([1.0, 0.5], &[[0.0, 0.0], [1.0, 2.0], [4.0, -1.0]]);
        for (index, point) in bent.points.iter().enumerate() {
            let [x, y] = bent.line()[index * PIECES];
            assert!(math::hypot(x - point[0], y - point[1]) < 1e-12);
        }
    }

    /// Eight points of a circle: what the spline misses of it is far below its radius.
    #[test]
    fn a_smooth_curve_through_points_of_a_circle_is_near_to_it() {
        let on_circle = |turns: f64| {
            let angle = turns * std::f64::consts::TAU;
            [math::cos(angle), math::sin(angle)]
        };
        let points: Vec<_> = (0..=8).map(|k| on_circle(f64::from(k) / 8.0)).collect();
        let line = curve([1.0, 1.0], &points).line();
        // at the two ends the curve does not know how to continue
        let inner = &line[PIECES..line.len() - PIECES];
        let worst =
            inner.iter().map(|[x, y]| (math::hypot(*x, *y) - 1.0).abs()).fold(0.0, f64::max);
        assert!(worst < 0.01 && worst > 0.0, "{worst}");
    }

    #[test]
    fn the_distance_of_two_curves_is_that_of_their_farthest_points_in_units_of_what_is_right() {
        let one = curve([0.5, 2.0], &[[0.0, 0.0], [4.0, 0.0]]);
        let far = |outcome: &[[f64; 2]]| one.distance(outcome).expect("two curves");
        assert!(far(&[[0.0, 0.0], [4.0, 0.0]]) < 1e-12);
        assert!((far(&[[0.0, 3.0], [4.0, 3.0]]) - 1.5).abs() < 1e-12);
        // half of the way is not the way
        assert!((far(&[[0.0, 0.0], [2.0, 0.0]]) - 4.0).abs() < 1e-12);
        assert!((far(&[[0.0, 0.0], [6.0, 0.0]]) - 4.0).abs() < 1e-12);
        assert!(one.distance(&[]).is_none());
    }
}
