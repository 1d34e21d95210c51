//! The longest step that the series of several orbits allow, each its own.
//!
//! In: the series of a [`BatchSeries`]. Out: for each lane the step that [`StepSize`](super::step_size::StepSize)
//! finds for that orbit alone, to the last bit. Never here: the rule and its constants.
//!
//! Each orbit has a number that mostly allows the least, not the same as its neighbours'. Its series come first, put together lane by
//! lane; that the other numbers allow as much is then seen by multiplications.

use super::argument_step::{
    FARTHEST_ARGUMENT, before_pole, may_pass_pole, of_argument, of_steep_pole,
};
use super::last_orders::{FIRST, ROOM, last_orders};
use super::rough_logarithms::{rough_exponentials, rough_logarithms};
use super::step_size::{Shares, reciprocals};
use crate::num::{Analytic, BATCH, Batch, Kernel, vectorized};
use crate::system::BatchSeries;

/// The rule for several orbits at once.
#[derive(Clone, Debug)]
pub(super) struct BatchStepSize {
    motion: Shares,
    integrals: Shares,
    /// The number whose series allowed the least last time, in each lane.
    least: Batch,
    scratch: Box<RuleScratch>,
}

/// Room for what the rule computes.
#[derive(Clone, Debug)]
struct RuleScratch {
    logs: [Batch; ROOM],
    /// The series of the numbers that allowed the least.
    likely: [Batch; ROOM],
    /// The powers of the shortest step so far.
    powers: [Batch; ROOM],
}

impl BatchStepSize {
    pub(super) fn new(tolerance: f64, order: usize) -> BatchStepSize {
        BatchStepSize {
            motion: Shares::of_motion(tolerance, order),
            integrals: Shares::of_integrals(tolerance, order),
            least: Batch::ZERO,
            scratch: Box::new(RuleScratch {
                logs: [Batch::ZERO; ROOM],
                likely: [Batch::ZERO; ROOM],
                powers: [Batch::ZERO; ROOM],
            }),
        }
    }

    /// The longest step of each lane, in its unit; infinite for a polynomial, NaN where a coefficient
    /// is not finite.
    pub(super) fn longest(&mut self, series: &BatchSeries) -> Batch {
        let mut shortest = vectorized(BatchByCoefficients { rule: self, series });
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

    #[inline(always)]
    fn by_coefficients(&mut self, series: &BatchSeries) -> Batch {
        let BatchStepSize { motion, integrals, least, scratch } = self;
        let RuleScratch { logs, likely, powers } = &mut **scratch;
        let likely = &mut likely[..=series.order()];
        // zero, or NaN where a coefficient is not finite
        let mut finite = [Batch::ZERO; 2];
        for i in 0..series.len() {
            let coefficients = series.coefficients(i);
            for (k, &c) in coefficients.iter().enumerate() {
                finite[k % 2] = finite[k % 2] + c * 0.0;
            }
            if i < series.inputs() {
                for (likely, &c) in likely.iter_mut().zip(coefficients) {
                    *likely = least.where_equal(i as f64, c, *likely);
                }
            }
        }
        let mut shortest = Batch::splat(f64::INFINITY);
        let mut step = shortest;
        // in one loop, so that there is one copy of what it does
        for place in 0..=series.len() {
            let (coefficients, shares) = match place.checked_sub(1) {
                None => (&*likely, &*motion),
                Some(i) if i < series.inputs() => (series.coefficients(i), &*motion),
                Some(i) => (series.coefficients(i), &*integrals),
            };
            if place > 0 && shares.screen.passes_all(coefficients, powers) {
                continue;
            }
            let found = of_one(coefficients, shares, shortest, logs);
            if place > 0 && !found.is_below_somewhere(shortest) {
                continue;
            }
            if (1..=series.inputs()).contains(&place) {
                *least =
                    (shortest - found).where_positive(Batch::splat((place - 1) as f64), *least);
            }
            shortest = found;
            step = Batch(rough_exponentials(shortest.0));
            set_powers(&mut powers[..coefficients.len()], step);
        }
        step + (finite[0] + finite[1])
    }
}

/// The powers of a step, four apart.
#[inline(always)]
fn set_powers(powers: &mut [Batch], step: Batch) {
    let square = step * step;
    let mut next = [Batch::ONE, step, square, square * step];
    let fourth = square * square;
    for (k, power) in powers.iter_mut().enumerate() {
        *power = next[k % 4];
        next[k % 4] = next[k % 4] * fourth;
    }
}

/// The kernel of the rule.
struct BatchByCoefficients<'a> {
    rule: &'a mut BatchStepSize,
    series: &'a BatchSeries,
}

impl Kernel for BatchByCoefficients<'_> {
    type Output = Batch;
    const OF_SEVERAL: bool = true;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Batch {
        self.rule.by_coefficients(self.series)
    }
}

/// The logarithms of the steps that one series allows, or `shortest` where that is less.
#[inline(always)]
fn of_one(
    coefficients: &[Batch],
    shares: &Shares,
    mut shortest: Batch,
    logs: &mut [Batch; ROOM],
) -> Batch {
    const LEAST: Batch = Batch([f64::NEG_INFINITY; BATCH]);
    const MOST: Batch = Batch([f64::INFINITY; BATCH]);
    let p = coefficients.len() - 1;
    for (log, c) in logs.iter_mut().zip(coefficients) {
        *log = Batch(rough_logarithms(c.abs().0));
    }
    for k in last_orders(p).rev() {
        let (below, own, indulgence) = (&logs[..k], logs[k], shares.indulgence(k, p));
        let (reciprocals, table) = (&reciprocals(k)[..k], &shares.table[..k]);
        let root = |j: usize| (below[j] - own) * reciprocals[j];
        // a coefficient that vanishes allows anything
        let allowed = |log: Batch| own.where_equal(f64::NEG_INFINITY, MOST, log + indulgence);
        let (mut most, mut radius) = (LEAST, LEAST);
        for j in 0..FIRST.min(k) {
            most = most.larger(root(j) + table[j]);
        }
        for j in 2..(2 + FIRST).min(k - 1) {
            radius = radius.larger(root(j));
        }
        if allowed(most.smaller(radius + shares.log_part)).all_reach(shortest) {
            continue;
        }
        // the bounds of the first terms are among the others
        for j in (0..2).chain(k - 1..k) {
            most = most.larger(root(j) + table[j]);
        }
        for j in 2..k - 1 {
            let root = root(j);
            most = most.larger(root + table[j]);
            radius = radius.larger(root);
        }
        let radius = radius + shares.log_part;
        let radius = radius.where_equal(f64::NEG_INFINITY, MOST, radius);
        shortest = shortest.smaller(allowed(most.smaller(radius)));
    }
    shortest
}
