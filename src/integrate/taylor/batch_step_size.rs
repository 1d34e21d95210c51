//! The longest step that the series of several orbits allow, each its own.
//!
//! In: the series of a [`BatchSeries`]. Out: for each lane the step that [`StepSize`](super::step_size::StepSize)
//! finds for that orbit alone, to the last bit. Never here: the rule and its constants.

use super::argument_step::{
    FARTHEST_ARGUMENT, before_pole, may_pass_pole, of_argument, of_steep_pole,
};
use super::last_orders::{FAINT, FIRST, ROOM, last_orders};
use super::rough_logarithms::rough_logarithms;
use super::step_screen::StepScreen;
use super::step_size::{Shares, reciprocals};
use crate::num::{Analytic, BATCH, Batch, Kernel, math, vectorized};
use crate::system::BatchSeries;

/// The rule for several orbits at once.
#[derive(Clone, Debug)]
pub(super) struct BatchStepSize {
    motion: Shares,
    integrals: Shares,
    /// The number whose series allowed the least last time, in each lane.
    least: [usize; BATCH],
    /// Its series in each lane.
    gathered: Box<[Batch; ROOM]>,
    logs: Box<[Batch; ROOM]>,
    /// The powers of the shortest step so far.
    powers: Box<[Batch; ROOM]>,
}

impl BatchStepSize {
    pub(super) fn new(tolerance: f64, order: usize) -> BatchStepSize {
        BatchStepSize {
            motion: Shares::of_motion(tolerance, order),
            integrals: Shares::of_integrals(tolerance, order),
            least: [0; BATCH],
            gathered: Box::new([Batch::ZERO; ROOM]),
            logs: Box::new([Batch::ZERO; ROOM]),
            powers: Box::new([Batch::ONE; ROOM]),
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
        let mut shortest = BatchShortest::new();
        let BatchStepSize { motion, integrals, least, gathered, logs, powers } = self;
        let count = series.inputs();
        if count > 0 {
            // mostly this shows that all numbers allow more
            let length = series.coefficients(0).len();
            for (lane, &number) in least.iter().enumerate() {
                let coefficients = series.coefficients(number.min(count - 1));
                for (place, c) in gathered.iter_mut().zip(coefficients) {
                    place.0[lane] = c.0[lane];
                }
            }
            shortest.take(&gathered[..length], Batch::ZERO, motion, (logs, powers));
        }
        for i in 0..count {
            let mut known = Batch::ZERO;
            for lane in 0..BATCH {
                known.0[lane] = f64::from(least[lane] == i);
            }
            let shorter = shortest.take(series.coefficients(i), known, motion, (logs, powers));
            for (least, _) in least.iter_mut().zip(shorter).filter(|(_, shorter)| *shorter) {
                *least = i;
            }
        }
        for i in count..series.len() {
            shortest.take(series.coefficients(i), Batch::ZERO, integrals, (logs, powers));
        }
        // zero times anything that is not finite is NaN
        shortest.step + shortest.finite
    }
}

/// The shortest steps that some series allow.
struct BatchShortest {
    log: Batch,
    step: Batch,
    is_known: bool,
    /// Zero, or NaN where a coefficient is not finite.
    finite: Batch,
}

impl BatchShortest {
    fn new() -> BatchShortest {
        let step = Batch::splat(f64::INFINITY);
        BatchShortest { log: step, step, is_known: false, finite: Batch::ZERO }
    }

    /// Takes another series into account, which is not `known` already in some lanes (1, else 0).
    /// Returns in which lanes it allows less than those before.
    #[inline(always)]
    fn take(
        &mut self,
        coefficients: &[Batch],
        known: Batch,
        shares: &Shares,
        (logs, powers): (&mut [Batch; ROOM], &mut [Batch; ROOM]),
    ) -> [bool; BATCH] {
        for c in coefficients {
            self.finite = self.finite + *c * 0.0;
        }
        let mut shorter = [false; BATCH];
        if self.is_known && passes(&shares.screen, (coefficients, known), powers) {
            return shorter;
        }
        let found = of_one(coefficients, shares, self.log, logs);
        for lane in 0..BATCH {
            shorter[lane] = found.0[lane] < self.log.0[lane];
            if shorter[lane] {
                self.step.0[lane] = math::exp(found.0[lane]);
            }
        }
        if !self.is_known || shorter != [false; BATCH] {
            (self.log, self.is_known) = (found, true);
            let mut power = Batch::ONE;
            for place in &mut powers[..coefficients.len()] {
                *place = power;
                power = power * self.step;
            }
        }
        shorter
    }
}

/// Whether a series allows a step in all lanes where that is not known (1, else 0); the powers are
/// those of the step. May be false where it does.
#[inline(always)]
fn passes(
    screen: &StepScreen,
    (coefficients, known): (&[Batch], Batch),
    powers: &[Batch; ROOM],
) -> bool {
    let mut low = [Batch::ZERO; 2 + FIRST];
    for ((low, c), power) in low.iter_mut().zip(coefficients).zip(powers) {
        let size = c.abs();
        *low = size.where_below(FAINT, Batch::ZERO, size * *power);
    }
    let mut all = Batch::ONE;
    let last = coefficients[screen.first..].iter().zip(&powers[screen.first..]);
    for (lane, (c, power)) in last.enumerate() {
        let (mut by_tolerance, mut by_radius) = (Batch::ZERO, Batch::ZERO);
        for j in 0..FIRST {
            by_tolerance = by_tolerance.larger(low[j] * screen.by_tolerance[j].0[lane]);
            by_radius = by_radius.larger(low[j + 2] * screen.by_radius[j].0[lane]);
        }
        let size = c.abs() * screen.entering.0[lane];
        let passed = by_tolerance.smaller(by_radius).is_above(size * *power);
        // a coefficient that vanishes allows anything
        all = all * size.where_below(FAINT, Batch::ONE, passed);
    }
    all.larger(known).all_reach(Batch::ONE)
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
