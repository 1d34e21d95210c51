//! The longest step that the series of several orbits allow, each its own.
//!
//! In: the series of a [`BatchSeries`]. Out: for each lane the step that [`StepSize`](super::step_size::StepSize)
//! finds for that orbit alone, to the last bit. Never here: the rule and its constants.
//!
//! The lowest orders mostly decide, and what they allow is found for all orbits at once. An orbit that they do not decide is asked
//! by itself: beside one another the seven others would wait for it.

use super::argument_step::{
    FARTHEST_ARGUMENT, before_pole, may_pass_pole, of_argument, of_steep_pole,
};
use super::lowest_steps::{LowestOfAll, LowestSteps, StepTables, lowest_steps};
use super::step_size::{SeriesCounts, SeriesOrders, StepSize};
use crate::num::{BATCH, Batch, FourLaneKernel, FourLanes, ScalarLanes, all_finite, in_four_lanes};
use crate::system::BatchSeries;

/// The rule for several orbits.
#[derive(Clone, Debug)]
pub(super) struct BatchStepSize {
    rule: StepSize,
    /// The bounds by the lowest orders, of the motion and of what does not act on it.
    lowest: [LowestOfAll; 2],
    tables: Box<StepTables>,
    /// The number whose series allowed the least last time, in each lane that was asked by itself.
    least: [usize; BATCH],
    /// The series of all numbers of one orbit.
    gathered: Vec<f64>,
}

impl BatchStepSize {
    pub(super) fn new(tolerance: f64, orders: SeriesOrders) -> BatchStepSize {
        let mut rule = StepSize::new(tolerance, orders);
        let lowest = rule.lowest_bounds();
        let tables = Box::new(StepTables::ZERO);
        BatchStepSize { rule, lowest, tables, least: [0; BATCH], gathered: Vec::new() }
    }

    /// The longest step of each of these lanes, in its unit; infinite for a polynomial, NaN where a coefficient
    /// is not finite.
    pub(super) fn longest(&mut self, series: &BatchSeries, of: [bool; BATCH]) -> Batch {
        let mut shortest = self.by_coefficients(series, of);
        for (function, u) in series.arguments() {
            for lane in 0..BATCH {
                let alone = || -> Vec<f64> { u.iter().map(|c| c.0[lane]).collect() };
                if may_pass_pole(function) && !shortest.0[lane].is_nan() {
                    shortest.0[lane] = shortest.0[lane].min(before_pole(&alone()));
                }
                let h = shortest.0[lane];
                let far = |k: usize, h: f64| u[k].0[lane].abs() * h > FARTHEST_ARGUMENT;
                let (square, cube) = (h * h, h * h * h);
                let moves_far = far(1, h) || far(2, square) || far(3, cube) || !cube.is_finite();
                if moves_far && !h.is_nan() {
                    shortest.0[lane] = h.min(of_argument(function, &alone(), None));
                }
            }
        }
        for (degree, above, u) in series.steep_poles() {
            for (lane, shortest) in shortest.0.iter_mut().enumerate() {
                let alone: Vec<f64> = u.iter().map(|c| c.0[lane]).collect();
                let own = of_steep_pole(degree.0[lane], above.0[lane], &alone);
                // a NaN remains
                if own < *shortest {
                    *shortest = own;
                }
            }
        }
        shortest
    }

    /// The steps that the coefficients allow: where the lowest orders decide it, for all lanes at once; the other lanes are asked
    /// by themselves.
    fn by_coefficients(&mut self, series: &BatchSeries, of: [bool; BATCH]) -> Batch {
        let counts = (series.len(), series.inputs());
        let of_number = |i: usize| series.coefficients(i);
        let LowestSteps { step: mut steps, decided } =
            lowest_steps(counts, of_number, &self.lowest, &mut self.tables);
        for lane in (0..BATCH).filter(|&lane| of[lane] && !decided[lane]) {
            steps.0[lane] = self.of_lane(series, lane);
        }
        steps
    }

    /// The step of one lane by the rule of one orbit; NaN where a coefficient is not finite.
    #[cold]
    fn of_lane(&mut self, series: &BatchSeries, lane: usize) -> f64 {
        let BatchStepSize { rule, least, gathered, .. } = self;
        gathered.clear();
        for i in 0..series.len() {
            gathered.extend(series.coefficients(i).iter().map(|c| c.0[lane]));
        }
        if !all_finite(ScalarLanes, gathered) {
            return f64::NAN;
        }
        let counts = counts_of(series);
        rule.least = least[lane];
        let step = in_four_lanes(OfOneLane { rule, counts, gathered });
        least[lane] = rule.least;
        step
    }
}

fn counts_of(series: &BatchSeries) -> SeriesCounts {
    let inputs = series.inputs();
    SeriesCounts { inputs, switches: 0, integrals: series.len() - inputs }
}

/// The kernel of [`BatchStepSize::of_lane`].
struct OfOneLane<'a> {
    rule: &'a mut StepSize,
    counts: SeriesCounts,
    /// The series of all numbers, one after another.
    gathered: &'a [f64],
}

impl FourLaneKernel for OfOneLane<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<L: FourLanes, const FUSED: bool>(self, lanes: L) -> f64 {
        let OfOneLane { rule, counts, gathered } = self;
        let terms = rule.order() + 1;
        rule.by_coefficients(lanes, counts, |i| &gathered[terms * i..][..terms])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::math;

    const INPUTS: usize = 3;
    const COUNTS: (usize, usize) = (INPUTS + 1, INPUTS);

    /// Series of four numbers of eight orbits, whose terms grow or shrink by a factor, with noise over so many powers of e, and
    /// some zeros.
    fn noisy(seed: u64, order: usize, noise: f64) -> Vec<Vec<Batch>> {
        let mut bits = seed;
        let mut unit = || {
            bits = bits.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (bits >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut of_number = || {
            let ratios: [f64; BATCH] = std::array::from_fn(|_| math::exp(2.0 * unit() - 2.5));
            let mut term = |k: usize, lane: usize| {
                let size = math::powi(ratios[lane], k as i32) * math::exp(noise * (unit() - 0.5));
                if unit() < 0.1 { 0.0 } else { size }
            };
            (0..=order).map(|k| Batch(std::array::from_fn(|lane| term(k, lane)))).collect()
        };
        (0..=INPUTS).map(|_| of_number()).collect()
    }

    #[test]
    fn what_the_lowest_orders_decide_is_the_step_of_the_orbit_alone() {
        for (tolerance, highest) in [(1e-15, 28), (1e-12, 23), (1e-6, 13)] {
            let mut rule = StepSize::new(tolerance, SeriesOrders { highest, exact: 0 });
            let bounds = rule.lowest_bounds();
            let mut tables = Box::new(StepTables::ZERO);
            for noise in [0.5, 3.0, 12.0] {
                let mut decided = 0;
                for seed in 0..100 {
                    let series = noisy(seed, highest, noise);
                    let of_number = |i: usize| &series[i][..];
                    let all = lowest_steps(COUNTS, of_number, &bounds, &mut tables);
                    for lane in (0..BATCH).filter(|&lane| all.decided[lane]) {
                        let own: Vec<Vec<f64>> =
                            series.iter().map(|c| c.iter().map(|c| c.0[lane]).collect()).collect();
                        let counts = SeriesCounts { inputs: INPUTS, switches: 0, integrals: 1 };
                        let alone = rule.by_coefficients(ScalarLanes, counts, |i| &own[i][..]);
                        assert_eq!(all.step.0[lane].to_bits(), alone.to_bits(), "{seed} {lane}");
                        decided += 1;
                    }
                }
                // it is of use only if it mostly decides
                assert!(noise > 1.0 || decided > 400, "{tolerance} {noise}: {decided}");
                assert!(decided > 20, "{tolerance} {noise}: {decided}");
            }
        }
    }

    #[test]
    fn what_is_not_finite_or_vanishes_is_not_decided() {
        let mut rule = StepSize::new(1e-12, SeriesOrders { highest: 23, exact: 0 });
        let bounds = rule.lowest_bounds();
        let mut tables = Box::new(StepTables::ZERO);
        let mut series = noisy(7, 23, 0.5);
        for (lane, bad) in [f64::NAN, f64::INFINITY, -f64::INFINITY].into_iter().enumerate() {
            series[lane][5 + lane].0[lane] = bad;
        }
        for k in 1..=23 {
            for number in &mut series {
                number[k].0[3] = 0.0;
            }
        }
        let all = lowest_steps(COUNTS, |i| &series[i][..], &bounds, &mut tables);
        assert_eq!(all.decided[..4], [false; 4]);
    }
}
