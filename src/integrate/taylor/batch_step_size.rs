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
use super::last_orders::{BEFORE, FIRST, LANES, LAST, ROOM, has_radius, last_orders};
use super::rough_logarithms::{four_logarithms, rough_exponentials};
use super::step_size::{Shares, reciprocals};
use crate::num::{BATCH, Batch, FourLaneKernel, FourLanes, in_four_lanes};
use crate::system::BatchSeries;

/// The rule for several orbits at once.
#[derive(Clone, Debug)]
pub(super) struct BatchStepSize {
    motion: Shares,
    integrals: Shares,
    /// The number whose series allowed the least last time, in each lane.
    least: [usize; BATCH],
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
            least: [0; BATCH],
            scratch: Box::new(RuleScratch {
                logs: [Batch::splat(0.0); ROOM],
                likely: [Batch::splat(0.0); ROOM],
                powers: [Batch::splat(0.0); ROOM],
            }),
        }
    }

    /// The longest step of each lane, in its unit; infinite for a polynomial, NaN where a coefficient
    /// is not finite.
    pub(super) fn longest(&mut self, series: &BatchSeries) -> Batch {
        let mut shortest = in_four_lanes(BatchByCoefficients { rule: self, series });
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
    fn by_coefficients<L: FourLanes>(&mut self, lanes: L, series: &BatchSeries) -> Batch {
        let mut steps = Batch::splat(f64::NAN);
        // in one loop, so that there is one copy of what it does
        for place in 0..BATCH / LANES {
            steps.set_half(lanes, place, self.of_half(lanes, series, place));
        }
        steps
    }

    /// The steps of one half of the orbits.
    #[inline(always)]
    fn of_half<L: FourLanes>(&mut self, lanes: L, series: &BatchSeries, at: usize) -> L::Numbers {
        let BatchStepSize { motion, integrals, least, scratch } = self;
        let RuleScratch { logs, likely, powers } = &mut **scratch;
        let likely = &mut likely[..=series.order()];
        // zero, or NaN where a coefficient is not finite
        let (mut finite, zero) = ([lanes.splat(0.0); 2], lanes.splat(0.0));
        for i in 0..series.len() {
            let coefficients = series.coefficients(i);
            for k in 0..coefficients.len() {
                let none = lanes.mul(coefficients[k].half(lanes, at), zero);
                finite[k % 2] = lanes.add(finite[k % 2], none);
            }
        }
        let own = LANES * at..LANES * (at + 1);
        for lane in own.clone() {
            let coefficients = series.coefficients(least[lane]);
            for k in 0..likely.len() {
                likely[k].0[lane] = coefficients[k].0[lane];
            }
        }
        let mut shortest = lanes.splat(f64::INFINITY);
        let mut step = shortest;
        // in one loop, so that there is one copy of what it does
        for place in 0..=series.len() {
            let (coefficients, shares) = match place.checked_sub(1) {
                None => (&*likely, &*motion),
                Some(i) if i < series.inputs() => (series.coefficients(i), &*motion),
                Some(i) => (series.coefficients(i), &*integrals),
            };
            if place > 0 && shares.screen.passes_all(lanes, coefficients, powers, at) {
                continue;
            }
            let found = of_one(lanes, (coefficients, at), shares, shortest, logs);
            let below = lanes.above(shortest, found);
            if place > 0 && below == 0 {
                continue;
            }
            if (1..=series.inputs()).contains(&place) {
                for (bit, lane) in own.clone().enumerate() {
                    if below >> bit & 1 == 1 {
                        least[lane] = place - 1;
                    }
                }
            }
            shortest = found;
            step = lanes.from_array(rough_exponentials(lanes.to_array(shortest)));
            set_powers(lanes, &mut powers[..coefficients.len()], step, at);
        }
        lanes.add(step, lanes.add(finite[0], finite[1]))
    }
}

/// The powers of a step, four apart.
#[inline(always)]
fn set_powers<L: FourLanes>(lanes: L, powers: &mut [Batch], step: L::Numbers, at: usize) {
    let square = lanes.mul(step, step);
    let mut next = [lanes.splat(1.0), step, square, lanes.mul(square, step)];
    let fourth = lanes.mul(square, square);
    for k in 0..powers.len() {
        powers[k].set_half(lanes, at, next[k % 4]);
        next[k % 4] = lanes.mul(next[k % 4], fourth);
    }
}

/// The kernel of the rule.
struct BatchByCoefficients<'a> {
    rule: &'a mut BatchStepSize,
    series: &'a BatchSeries,
}

impl FourLaneKernel for BatchByCoefficients<'_> {
    type Output = Batch;

    #[inline(always)]
    fn run<L: FourLanes, const FUSED: bool>(self, lanes: L) -> Batch {
        self.rule.by_coefficients(lanes, self.series)
    }
}

/// The logarithms of the steps that one series allows one half of the orbits, or `shortest` where that is less.
///
/// What the lowest orders allow to each of the last orders is no more than what all orders allow; an order that already allows
/// `shortest` by these is not asked any further, and the one to which they allow the least is asked first.
#[inline(always)]
fn of_one<L: FourLanes>(
    lanes: L,
    (coefficients, at): (&[Batch], usize),
    shares: &Shares,
    mut shortest: L::Numbers,
    logs: &mut [Batch; ROOM],
) -> L::Numbers {
    let (none, any) = (lanes.splat(f64::NEG_INFINITY), lanes.splat(f64::INFINITY));
    let p = coefficients.len() - 1;
    for k in 0..=p {
        let size = lanes.abs(coefficients[k].half(lanes, at));
        logs[k].set_half(lanes, at, four_logarithms(lanes, size));
    }
    let first = *last_orders(p).start();
    let mut lowest = [any; LAST + BEFORE];
    for k in first..=p {
        let own = logs[k].half(lanes, at);
        let reciprocals = reciprocals(k);
        let (mut most, mut radius) = (none, none);
        for j in 0..(2 + FIRST).min(k) {
            let apart = lanes.sub(logs[j].half(lanes, at), own);
            let root = lanes.mul(apart, lanes.splat(reciprocals[j]));
            if j < FIRST {
                most = lanes.max(most, lanes.add(root, lanes.splat(shares.table[j])));
            }
            if (2..k - 1).contains(&j) {
                radius = lanes.max(radius, root);
            }
        }
        let radius =
            if has_radius(k) { lanes.add(radius, lanes.splat(shares.log_part)) } else { any };
        lowest[k - first] = allowed(lanes, (most, radius), (own, shares.indulgence(k, p)));
    }
    for _ in first..=p {
        let mut least = any;
        for i in 0..lowest.len() {
            least = lanes.min(least, lowest[i]);
        }
        let shorter = lanes.above(shortest, least);
        if shorter == 0 {
            break;
        }
        let mut place = 0;
        for i in 0..lowest.len() {
            if lanes.equal(lowest[i], least) & shorter != 0 {
                place = i;
            }
        }
        let k = first + place;
        let own = logs[k].half(lanes, at);
        let (reciprocals, table) = (&reciprocals(k)[..k], &shares.table[..k]);
        let (mut most, mut radius) = (none, none);
        for j in 0..k {
            let apart = lanes.sub(logs[j].half(lanes, at), own);
            let root = lanes.mul(apart, lanes.splat(reciprocals[j]));
            most = lanes.max(most, lanes.add(root, lanes.splat(table[j])));
            if (2..k - 1).contains(&j) {
                radius = lanes.max(radius, root);
            }
        }
        let radius = lanes.add(radius, lanes.splat(shares.log_part));
        let radius = lanes.where_below(radius, lanes.splat(f64::MIN), any, radius);
        let found = allowed(lanes, (most, radius), (own, shares.indulgence(k, p)));
        shortest = lanes.min(shortest, found);
        lowest[place] = any;
    }
    shortest
}

/// The logarithm of the step that one order allows, from what the tolerance and the radius of convergence give.
#[inline(always)]
fn allowed<L: FourLanes>(
    lanes: L,
    (most, radius): (L::Numbers, L::Numbers),
    (own, indulgence): (L::Numbers, f64),
) -> L::Numbers {
    let log = lanes.add(lanes.min(most, radius), lanes.splat(indulgence));
    // a coefficient that vanishes allows anything
    lanes.where_below(own, lanes.splat(f64::MIN), lanes.splat(f64::INFINITY), log)
}
