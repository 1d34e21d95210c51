//! The growth of tangent vectors along a motion, and its mean rates.
//!
//! An exponent is the mean rate of growth with a weight that vanishes smoothly at both ends
//! (S. Das et al., Europhys. Lett. 114 (2016) 40005), which converges faster than the plain mean
//! where the motion is periodic.
//!
//! The uncertainty of a mean is that of the means of blocks of the motion, where these are independent: blocks are joined two
//! by two, and while the uncertainty that they give grows they are not (H. Flyvbjerg and H. G. Petersen, J. Chem. Phys. 91
//! (1989) 461).
//!
//! In: times, and the logarithms of the growth up to them. Out: mean rates with their uncertainty. Never here: the vectors.

use crate::num::math;

/// The blocks of the motion whose exponents are compared first, and those that are left when no more are joined.
const BLOCKS: usize = 64;
const LEAST_BLOCKS: usize = 8;

/// The part of the motion that belongs to the search for the direction.
const SEARCH: f64 = 0.1;

/// Blocks depend on each other where those left at the end give so many times the uncertainty of the first: eight independent
/// ones do by chance in one case of five hundred, while those of a trend give √8 times as much.
const GROWING: f64 = 1.75;

/// The growth of the vectors so far.
pub(super) struct TangentGrowth {
    /// The times at which it was measured, the first is the start.
    pub(super) times: Vec<f64>,
    /// The logarithms by which each vector has grown up to these times.
    pub(super) logarithms: Vec<Vec<f64>>,
}

/// The mean rate of growth in some parts of the time between two times, with a smooth weight; `None` where it has no part.
fn weighted_mean(
    parts: impl Iterator<Item = ([f64; 2], f64)>,
    [begin, end]: [f64; 2],
) -> Option<f64> {
    let weight = |time: f64| {
        let s = (time - begin) / (end - begin);
        if s > 0.0 && s < 1.0 { math::exp(-1.0 / (s * (1.0 - s))) } else { 0.0 }
    };
    let (mut sum, mut whole) = (0.0, 0.0);
    for ([from, to], growth) in parts {
        // the growth of a part is spread over it; Simpson's rule for the weight
        let mean = (weight(from) + 4.0 * weight(0.5 * (from + to)) + weight(to)) / 6.0;
        sum += mean * growth;
        whole += mean * (to - from);
    }
    (whole > 0.0).then(|| sum / whole)
}

impl TangentGrowth {
    /// The mean rate of growth of a vector between two times, with a smooth weight.
    pub(super) fn weighted(&self, vector: usize, begin: f64, end: f64) -> f64 {
        let rounds = self.times.windows(2).zip(self.logarithms.windows(2));
        let rounds =
            rounds.map(|(times, logs)| ([times[0], times[1]], logs[1][vector] - logs[0][vector]));
        weighted_mean(rounds, [begin, end]).unwrap_or_else(|| self.plain(vector, begin, end))
    }

    /// The weighted mean rate of growth of a vector from the beginning up to so many times; the last is that of all rounds, the
    /// others are those of as many parts as there are times.
    pub(super) fn means(&self, vector: usize, count: usize) -> Vec<(f64, f64)> {
        let (begin, end) = (self.begin(), self.end());
        let times: Vec<f64> =
            (0..=count).map(|i| begin + (end - begin) * i as f64 / count as f64).collect();
        let logs: Vec<f64> = times.iter().map(|&time| self.at(vector, time)).collect();
        let mean = |last: usize| {
            let parts = (1..=last).map(|i| ([times[i - 1], times[i]], logs[i] - logs[i - 1]));
            let known = weighted_mean(parts, [begin, times[last]]);
            known.unwrap_or_else(|| self.plain(vector, begin, times[last]))
        };
        let mut means: Vec<(f64, f64)> = (1..count).map(|i| (times[i], mean(i))).collect();
        means.push((end, self.weighted(vector, begin, end)));
        means
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

    /// The uncertainty of a weighted mean, and whether the mean has settled: the spread of blocks of the motion, and the
    /// change of direction of a vector, whose logarithm is of order 1, over the whole time. A mean has not settled if
    /// blocks of the motion still depend on each other; the uncertainty is then a lower bound.
    pub(super) fn uncertainty(&self, vector: usize) -> (f64, bool) {
        let turning = 2.0 / (self.end() - self.begin());
        let begin = self.begin() + SEARCH * (self.end() - self.begin());
        let length = (self.end() - begin) / BLOCKS as f64;
        let block = |i: usize| {
            let from = begin + length * i as f64;
            self.plain(vector, from, from + length)
        };
        let mut blocks: Vec<f64> = (0..BLOCKS).map(block).collect();
        let first = variance_of_mean(&blocks);
        let mut last = [first; 2];
        while blocks.len() > LEAST_BLOCKS {
            blocks = blocks.chunks_exact(2).map(|pair| f64::midpoint(pair[0], pair[1])).collect();
            last = [last[1], variance_of_mean(&blocks)];
        }
        let grows = last[1] > GROWING * GROWING * first;
        // less than a turn of the direction is no growth
        let settled = !grows || last[1] <= turning * turning;
        // the weight makes less of the parts near both ends
        ((1.7 * last[0].max(last[1]) + turning * turning).sqrt(), settled)
    }
}

/// The variance of the mean of independent numbers.
fn variance_of_mean(all: &[f64]) -> f64 {
    let count = all.len() as f64;
    let mean = all.iter().sum::<f64>() / count;
    all.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (count * (count - 1.0))
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

    /// Growth at rates of one block of unit time each.
    fn growth(rates: impl Iterator<Item = f64>) -> TangentGrowth {
        let mut growth = TangentGrowth { times: vec![0.0], logarithms: vec![vec![0.0]] };
        for (i, rate) in rates.enumerate() {
            growth.times.push((i + 1) as f64);
            growth.logarithms.push(vec![growth.logarithms[i][0] + rate]);
        }
        growth
    }

    /// Numbers from −1 to 1 of a linear congruence.
    fn noise() -> impl Iterator<Item = f64> {
        let step = |x: &u64| Some(x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1));
        std::iter::successors(Some(7), step)
            .skip(1)
            .map(|x| (x >> 11) as f64 / math::powi(2.0, 52) - 1.0)
    }

    /// Independent rates of variance 1/3 leave their mean uncertain by √(1/(3 n)); it has settled.
    #[test]
    fn the_mean_of_independent_rates_settles() {
        for count in [640, 6400] {
            let (off, settled) = growth(noise().map(|x| 0.5 + x).take(count)).uncertainty(0);
            let known = (1.7 / (3.0 * 0.9 * count as f64)).sqrt();
            assert!(settled && (0.6..2.0).contains(&(off / known)), "{count}: {off} {known}");
        }
    }

    /// A motion that sticks for long stretches to where it is regular: x' = a x + noise with a correlation time of a fortieth
    /// of the motion has an uncertainty √((1 + a)/(1 − a)) times that of independent rates. Where the correlation time is as
    /// long as the motion the mean has not settled.
    #[test]
    fn rates_that_depend_on_those_before_leave_a_larger_uncertainty() {
        let correlated = |a: f64| {
            let rates = noise().scan(0.0, move |last, x| {
                *last = a * *last + x;
                Some(*last)
            });
            growth(rates.skip(100_000).take(20_000))
        };
        let known = |a: f64| (1.7_f64 / (0.9 * 20_000.0 * 3.0)).sqrt() / (1.0 - a);
        let (off, settled) = correlated(0.95).uncertainty(0);
        assert!(settled && (0.6..2.0).contains(&(off / known(0.95))), "{off}");
        let (off, settled) = correlated(0.9999).uncertainty(0);
        assert!(!settled, "{off} {}", known(0.9999));
    }

    /// The growth of a regular motion is that of its time: its rate has no mean but 0, which is within a turn.
    #[test]
    fn a_vector_that_turns_back_and_forth_has_settled() {
        let (off, settled) =
            growth((0..2000).map(|i| 0.4 * math::cos(0.3 * f64::from(i)))).uncertainty(0);
        assert!(settled && off < 1e-2, "{off}");
    }
}
