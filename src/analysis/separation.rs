//! How far two motions are from each other as time passes, and how fast their distance grows.
//!
//! The distance is that of the canonical variables (q, p), or of the variables of brackets, in the units of the file; a
//! coordinate with a period takes the shorter way round. Near each other, neighbours part like e^{λt}: λ is the slope of
//! ln d, here that of the straight line nearest to it (least squares) from the beginning to where d is no longer small
//! beside the motion itself.
//!
//! In: the variables of both motions at the same times. Out: points of ln d over time, and the slope. Never here: how
//! the motions are computed, or Lyapunov exponents, which take tangent vectors.

use crate::num::math;

/// The most points that are kept; beyond it every second one is dropped.
const MOST: usize = 4096;

/// The distance, as a part of the size of the motion, beyond which it no longer grows as a small one does.
const SMALL: f64 = 0.03;

/// The fewest points of a line.
const FEWEST: usize = 8;

/// The distance of two motions at past times.
#[derive(Clone, Debug, Default)]
pub struct DistanceHistory {
    /// Times and ln d, the oldest first.
    points: Vec<[f64; 2]>,
    /// One of so many points is kept.
    stride: u64,
    seen: u64,
    /// The least and greatest value of each variable of the first motion.
    bounds: Vec<[f64; 2]>,
    /// The number of points before the distance was large, once it has been.
    small: Option<usize>,
}

/// The line nearest to ln d while it was small.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Slope {
    /// λ, the growth of ln d in a unit of time.
    pub rate: f64,
    /// How well it is known: half the difference of its values in the first and in the second half of the points.
    pub error: f64,
    /// ln d of the line at the time 0.
    pub level: f64,
    /// The times between which it was measured.
    pub from: f64,
    /// The later one.
    pub to: f64,
    /// The logarithm of the growth between them.
    pub grown: f64,
}

/// The distance of two motions with these variables; a variable with a period takes the shorter way round.
pub fn distance(one: &[f64], other: &[f64], periods: &[Option<f64>]) -> f64 {
    let mut square = 0.0;
    for (i, (a, b)) in one.iter().zip(other).enumerate() {
        let mut apart = b - a;
        if let Some(period) = periods.get(i).copied().flatten() {
            apart -= (apart / period).round() * period;
        }
        square += apart * apart;
    }
    square.sqrt()
}

impl DistanceHistory {
    /// Adds the variables of both motions at a time; `periods` are those of the variables.
    pub fn add(&mut self, time: f64, one: &[f64], other: &[f64], periods: &[Option<f64>]) {
        if self.bounds.len() != one.len() {
            self.bounds = vec![[f64::INFINITY, f64::NEG_INFINITY]; one.len()];
            self.stride = 1;
        }
        for (a, [least, greatest]) in one.iter().zip(&mut self.bounds) {
            (*least, *greatest) = (least.min(*a), greatest.max(*a));
        }
        let distance = distance(one, other, periods);
        if !(distance.is_finite() && distance > 0.0) {
            return;
        }
        if self.small.is_none() && distance > SMALL * self.size() {
            self.small = Some(self.points.len());
        }
        self.seen += 1;
        if !self.seen.is_multiple_of(self.stride.max(1)) {
            return;
        }
        self.points.push([time, math::ln(distance)]);
        if self.points.len() == MOST {
            let mut index = 0;
            self.points.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.stride *= 2;
            self.small = self.small.map(|count| count.div_ceil(2));
        }
    }

    /// Forgets what came after a time.
    pub fn rewind(&mut self, time: f64) {
        self.points.retain(|point| point[0] <= time);
        self.small = self.small.filter(|count| *count < self.points.len());
    }

    /// The times and ln d, the oldest first.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// The size of the first motion: the diagonal of the box that it has filled, or its distance from zero if it rests.
    fn size(&self) -> f64 {
        let extent: f64 = self.bounds.iter().map(|[a, b]| (b - a) * (b - a)).sum();
        let far: f64 = self.bounds.iter().map(|[a, b]| a.abs().max(b.abs())).map(|x| x * x).sum();
        // at first the motion has filled no box
        extent.max(far).sqrt()
    }

    /// The growth while the distance was small; `None` where it never was, or too short.
    pub fn slope(&self) -> Option<Slope> {
        let end = self.small.unwrap_or(self.points.len()).min(self.points.len());
        let points = &self.points[..end];
        if points.len() < FEWEST {
            return None;
        }
        let (rate, level) = line_through(points);
        let (first, second) = points.split_at(points.len() / 2);
        let error = (line_through(first).0 - line_through(second).0).abs() / 2.0;
        let (from, to) = (points[0][0], points[points.len() - 1][0]);
        let grown = rate * (to - from);
        rate.is_finite().then_some(Slope { rate, error, level, from, to, grown })
    }
}

/// The slope of the straight line nearest to some points, and its value at zero.
fn line_through(points: &[[f64; 2]]) -> (f64, f64) {
    let count = points.len() as f64;
    let mean = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / count);
    let (mut spread, mut common) = (0.0, 0.0);
    for [t, l] in points {
        spread += (t - mean[0]) * (t - mean[0]);
        common += (t - mean[0]) * (l - mean[1]);
    }
    let rate = common / spread;
    (rate, mean[1] - rate * mean[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_of_exponential_growth_is_its_rate_and_stops_where_the_distance_is_large() {
        let mut separation = DistanceHistory::default();
        for k in 0..20_000 {
            let t = f64::from(k) * 0.01;
            // grows like e^{0.3t} up to the size of the motion, and then no more
            let d = (1e-8 * math::exp(0.3 * t)).min(1.0);
            let a = [math::sin(t), math::cos(t)];
            separation.add(t, &a, &[a[0] + d, a[1]], &[None, None]);
        }
        let slope = separation.slope().expect("a slope");
        assert!((slope.rate - 0.3).abs() < 1e-9 && slope.error < 1e-9, "{slope:?}");
        // ln(0.03 · size · 1e8)/0.3, the size lies between 1 and √8
        assert!((slope.to - 50.0).abs() < 5.0, "{slope:?}");
        assert!(separation.points().len() < MOST);
    }

    /// ln d = t²/2 grows at the rate 1 to 3 in equal halves of four units: at 2 in the mean, known to 1.
    #[test]
    fn a_slope_that_changes_is_known_as_well_as_its_halves_agree() {
        let mut separation = DistanceHistory::default();
        for k in 0..=400 {
            let t = f64::from(k) * 0.01;
            let d = 1e-9 * math::exp(0.5 * t * t);
            separation.add(t, &[1.0 + t], &[1.0 + t + d], &[None]);
        }
        let slope = separation.slope().expect("a slope");
        assert!((slope.rate - 2.0).abs() < 0.02, "{slope:?}");
        assert!((slope.error - 1.0).abs() < 0.02, "{slope:?}");
    }

    #[test]
    fn an_angle_takes_the_shorter_way_and_equal_motions_have_no_distance() {
        let mut separation = DistanceHistory::default();
        let turn = std::f64::consts::TAU;
        separation.add(0.0, &[3.1], &[-3.1], &[Some(turn)]);
        assert!((separation.points()[0][1] - math::ln(turn - 6.2)).abs() < 1e-13);
        separation.add(1.0, &[3.1], &[3.1], &[Some(turn)]);
        assert_eq!(separation.points().len(), 1);
        assert_eq!(separation.slope(), None);
    }
}
