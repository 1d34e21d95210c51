//! The longest step that the series of several orbits allow, each its own.
//!
//! In: the series of a [`BatchSeries`]. Out: for each lane the step that [`StepSize`](super::step_size::StepSize)
//! finds for that orbit alone, to the last bit. Never here: the rule and its constants.

use super::step_size::{
    FARTHEST_ARGUMENT, FIRST, ROOM, Shares, last_orders, of_argument, reciprocal, rough_logarithms,
};
use crate::num::{Analytic, BATCH, Batch, Kernel, math, vectorized};
use crate::system::BatchSeries;

/// The rule for several orbits at once.
#[derive(Clone, Debug)]
pub(super) struct BatchStepSize {
    motion: Shares,
    integrals: Shares,
    /// The number whose series allowed the least last time, in any lane.
    least: usize,
    logs: Box<[Batch; ROOM]>,
}

impl BatchStepSize {
    pub(super) fn new(tolerance: f64, order: usize) -> BatchStepSize {
        BatchStepSize {
            motion: Shares::of_motion(tolerance, order),
            integrals: Shares::of_integrals(tolerance, order),
            least: 0,
            logs: Box::new([Batch::ZERO; ROOM]),
        }
    }

    /// The longest step of each lane, in its unit; infinite for a polynomial, NaN where a coefficient
    /// is not finite.
    pub(super) fn longest(&mut self, series: &BatchSeries) -> Batch {
        let mut shortest = vectorized(ByCoefficients { rule: self, series });
        shortest.0 = shortest.0.map(math::exp);
        for (function, u) in series.arguments() {
            for lane in 0..BATCH {
                let h = shortest.0[lane];
                let far = |k: usize, h: f64| u[k].0[lane].abs() * h > FARTHEST_ARGUMENT;
                let (square, cube) = (h * h, h * h * h);
                if far(1, h) || far(2, square) || far(3, cube) || !cube.is_finite() {
                    let alone: Vec<f64> = u.iter().map(|c| c.0[lane]).collect();
                    if !h.is_nan() {
                        shortest.0[lane] = h.min(of_argument(function, &alone));
                    }
                }
            }
        }
        shortest
    }

    #[inline(always)]
    fn by_coefficients(&mut self, series: &BatchSeries) -> Batch {
        let (motion, integrals) = (&self.motion, &self.integrals);
        let mut shortest = Batch::splat(f64::INFINITY);
        let mut finite = Batch::ZERO;
        let mut least = self.least.min(series.inputs().saturating_sub(1));
        let first = least;
        let after = (0..series.inputs()).filter(|&i| i != first);
        for i in std::iter::once(first).chain(after) {
            let found =
                of_one(series.coefficients(i), motion, shortest, &mut self.logs, &mut finite);
            if found.0[0] < shortest.0[0] {
                least = i;
            }
            shortest = found;
        }
        for i in series.inputs()..series.len() {
            let c = series.coefficients(i);
            shortest = of_one(c, integrals, shortest, &mut self.logs, &mut finite);
        }
        self.least = least;
        // zero times anything that is not finite is NaN
        shortest + finite
    }
}

/// The kernel of the rule.
struct ByCoefficients<'a> {
    rule: &'a mut BatchStepSize,
    series: &'a BatchSeries,
}

impl Kernel for ByCoefficients<'_> {
    type Output = Batch;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Batch {
        self.rule.by_coefficients(self.series)
    }
}

/// The logarithms of the steps that one series allows, or `shortest` where that is less. What is not
/// finite makes `finite` NaN.
#[inline(always)]
fn of_one(
    coefficients: &[Batch],
    shares: &Shares,
    mut shortest: Batch,
    logs: &mut [Batch; ROOM],
    finite: &mut Batch,
) -> Batch {
    const LEAST: Batch = Batch([f64::NEG_INFINITY; BATCH]);
    const MOST: Batch = Batch([f64::INFINITY; BATCH]);
    let p = coefficients.len() - 1;
    for (log, c) in logs.iter_mut().zip(coefficients) {
        let size = c.abs();
        *log = Batch(rough_logarithms(size.0));
        *finite = *finite + size * 0.0;
    }
    for k in last_orders(p).rev() {
        let (own, indulgence) = (logs[k], shares.indulgence(k, p));
        let (early, inner) = (FIRST.min(k), (2 + FIRST).min(k - 1));
        let (mut most, mut radius) = (LEAST, LEAST);
        for j in 0..early {
            most = most.larger((logs[j] - own) * reciprocal(k - j) + shares.table[j]);
        }
        for j in 2..inner {
            radius = radius.larger((logs[j] - own) * reciprocal(k - j));
        }
        // a coefficient that vanishes allows anything
        let allowed = |log: Batch| own.where_equal(f64::NEG_INFINITY, MOST, log + indulgence);
        if allowed(most.smaller(radius + shares.log_part)).all_reach(shortest) {
            continue;
        }
        for j in early..k {
            most = most.larger((logs[j] - own) * reciprocal(k - j) + shares.table[j]);
        }
        for j in inner..k - 1 {
            radius = radius.larger((logs[j] - own) * reciprocal(k - j));
        }
        let radius = radius + shares.log_part;
        let radius = radius.where_equal(f64::NEG_INFINITY, MOST, radius);
        shortest = shortest.smaller(allowed(most.smaller(radius)));
    }
    shortest
}
