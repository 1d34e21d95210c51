//! The growth of tangent vectors along a motion, and its mean rates.
//!
//! An exponent is the mean rate of growth with a weight that vanishes smoothly at both ends
//! (S. Das et al., Europhys. Lett. 114 (2016) 40005), which converges faster than the plain mean
//! where the motion is periodic.
//!
//! In: times, and the logarithms of the growth up to them. Out: mean rates with their uncertainty. Never here: the vectors.

use crate::num::math;

/// The number of parts of the motion whose exponents are compared.
const BLOCKS: usize = 10;

/// The growth of the vectors so far.
pub(super) struct TangentGrowth {
    /// The times at which it was measured, the first is the start.
    pub(super) times: Vec<f64>,
    /// The logarithms by which each vector has grown up to these times.
    pub(super) logarithms: Vec<Vec<f64>>,
}

impl TangentGrowth {
    /// The mean rate of growth of a vector between two times, with a smooth weight.
    pub(super) fn weighted(&self, vector: usize, begin: f64, end: f64) -> f64 {
        let weight = |time: f64| {
            let s = (time - begin) / (end - begin);
            if s > 0.0 && s < 1.0 { math::exp(-1.0 / (s * (1.0 - s))) } else { 0.0 }
        };
        let (mut sum, mut whole) = (0.0, 0.0);
        for (times, logs) in self.times.windows(2).zip(self.logarithms.windows(2)) {
            let [from, to] = [times[0], times[1]];
            // the growth of a round is spread over it; Simpson's rule for the weight
            let mean = (weight(from) + 4.0 * weight(0.5 * (from + to)) + weight(to)) / 6.0;
            sum += mean * (logs[1][vector] - logs[0][vector]);
            whole += mean * (to - from);
        }
        if whole > 0.0 { sum / whole } else { self.plain(vector, begin, end) }
    }

    /// The plain mean rate of growth of a vector between two times.
    pub(super) fn plain(&self, vector: usize, begin: f64, end: f64) -> f64 {
        (self.at(vector, end) - self.at(vector, begin)) / (end - begin)
    }

    /// The logarithm of the growth of a vector up to a time, interpolated.
    pub(super) fn at(&self, vector: usize, time: f64) -> f64 {
        let next = self.times.partition_point(|&t| t < time).clamp(1, self.times.len() - 1);
        let (from, to) = (self.times[next - 1], self.times[next]);
        let part = ((time - from) / (to - from)).clamp(0.0, 1.0);
        let [a, b] = [next - 1, next].map(|i| self.logarithms[i][vector]);
        a + part * (b - a)
    }

    pub(super) fn begin(&self) -> f64 {
        self.times[0]
    }

    pub(super) fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// The uncertainty of a weighted mean: the spread of the parts of the motion, and the change of
    /// direction of a vector, whose logarithm is of order 1, over the whole time.
    pub(super) fn uncertainty(&self, vector: usize) -> f64 {
        let length = (self.end() - self.begin()) / BLOCKS as f64;
        let block = |i: usize| {
            let begin = self.begin() + length * i as f64;
            self.plain(vector, begin, begin + length)
        };
        // the first part belongs to the search for the direction
        let all: Vec<f64> = (1..BLOCKS).map(block).collect();
        let count = all.len() as f64;
        let mean = all.iter().sum::<f64>() / count;
        let variance = all.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (count - 1.0);
        let turning = 2.0 / (self.end() - self.begin());
        // the weight makes less of the parts near both ends
        (1.7 * variance / count + turning * turning).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_weighted_mean_of_constant_growth_is_that_growth() {
        let times: Vec<f64> = (0..100).map(|i| f64::from(i) * 0.37).collect();
        let logarithms = times.iter().map(|t| vec![0.3 * t, -2.0 * t]).collect();
        let growth = TangentGrowth { times, logarithms };
        let end = growth.end();
        assert!((growth.weighted(0, 0.0, end) - 0.3).abs() < 1e-14);
        assert!((growth.weighted(1, 0.0, end) + 2.0).abs() < 1e-14);
    }
}
