//! The longest step that a series allows.
//!
//! The error of each number of the state is measured relative to its own size, so units do not
//! matter and nothing small is lost beside something large. Its series is truncated at order p; the
//! step h is such that the last terms are a small part of the tolerance, |c_p| h^p ≤ ε/100 max_j
//! |c_j| h^j, and stays inside the radius of convergence however small those terms are: a body far
//! from a collision is hardly affected by it.
//!
//! For each of the last orders k the logarithm of the step is the largest of `(ln |c_j| − ln |c_k|)/(k − j) + ln ε/(p − j)`
//! over all j < k, but no more than the radius of convergence, that is the largest of the first terms alone, allows.

use std::cell::RefCell;
use std::sync::Arc;

use super::argument_step::{
    FARTHEST_ARGUMENT, before_pole, may_pass_pole, of_argument, of_steep_pole,
};
use super::last_orders::{INDULGENCE, ROOM, WIDTH, indulgence_of};
use super::lowest_steps::LowestOfAll;
use super::order_bounds::{LowestBounds, OrderBounds};
use super::rough_logarithms::{logarithms, rough_exponential};
use super::step_screen::{StepScreen, set_powers};
use crate::num::{FourLaneKernel, FourLanes, in_four_lanes, math};
use crate::system::{Series, System};

/// Below this tolerance the lowest orders are built in double-double.
pub(super) const EXACT_BELOW: f64 = 1e-16;

/// The number of orders in double-double: the part left to `f64` is a ten-thousandth of a step.
pub(super) const EXACT_ORDERS: usize = 8;

/// The part of the tolerance allowed for the last terms, which represent everything truncated.
/// Truncation errs in the same direction step by step, while rounding does not.
const SHARE: f64 = 0.01;

/// The largest step as a part of the radius of convergence.
const PART_OF_RADIUS: f64 = 0.6;

/// The tolerance of an integral (action, work) and of a tangent vector, in tolerances of the motion:
/// its errors have no effect on the motion.
const SPARED: f64 = 1e3;

/// The orders of a series.
#[derive(Clone, Copy, Debug)]
pub(super) struct SeriesOrders {
    pub(super) highest: usize,
    /// The number of orders in double-double.
    pub(super) exact: usize,
}

impl SeriesOrders {
    /// Those at which a tolerance costs least, for the motion of a system. The step grows with the order. In large
    /// systems the work grows with its square (Jorba & Zou, proposition 3.2, find −½ ln ε + 1 if each order costs the
    /// same work); in small ones an order in `f64` costs nearly the same whatever it is, and a step has a cost of its
    /// own. In double-double it pays no more: in the longer steps of motions without singularities terms of high order,
    /// which are in `f64`, are larger than their sum.
    pub(super) fn of(tolerance: f64, system: &System) -> SeriesOrders {
        let (part, exact) = match tolerance < EXACT_BELOW {
            true => (0.66, EXACT_ORDERS),
            false if system.degrees() <= SMALL && tolerance < LOOSE => (0.8, 0),
            false => (0.66, 0),
        };
        let highest = ((-math::ln(tolerance) * part).ceil() as usize).clamp(WIDTH, 44);
        SeriesOrders { highest, exact }
    }
}

/// From this tolerance on it is loose; time scales of motions are measured with it.
const LOOSE: f64 = 1e-9;

/// With no more degrees of freedom than this the products of series are not most of the work
/// (measured on chains of pendulums).
const SMALL: usize = 6;

/// Whether all rates of change are finite.
pub(super) fn has_velocity(series: &Series) -> bool {
    numbers(series).all(|c| c[1].is_finite())
}

/// The rule at one tolerance and order.
#[derive(Clone, Debug)]
pub(super) struct StepSize {
    motion: Arc<Shares>,
    /// Those of what does not act on the motion, once there is such a number.
    integrals: Option<Arc<Shares>>,
    /// The tolerance of the last terms of the motion.
    tolerance: f64,
    /// The number whose series allowed the least last time. Taken first, it mostly shows that the others allow more.
    pub(super) least: usize,
}

impl StepSize {
    pub(super) fn new(tolerance: f64, orders: SeriesOrders) -> StepSize {
        StepSize {
            motion: Shares::of_motion(tolerance * SHARE, orders.highest),
            integrals: None,
            tolerance: tolerance * SHARE,
            least: 0,
        }
    }

    /// The longest step that the tolerance allows, in the unit of the series; infinite for a
    /// polynomial. Returns `None` if a coefficient is not finite.
    pub(super) fn longest(&mut self, series: &Series) -> Option<f64> {
        if !series.is_finite() {
            return None;
        }
        let mut shortest = in_four_lanes(ByCoefficients { rule: self, series });
        for (function, u, wide) in series.arguments() {
            if may_pass_pole(function) {
                shortest = shortest.min(before_pole(u));
            }
            // most arguments are far from their bound, which is costly to compute
            let far = |k: usize, h: f64| u[k].abs() * h > FARTHEST_ARGUMENT;
            let (square, cube) = (shortest * shortest, shortest * shortest * shortest);
            if far(1, shortest) || far(2, square) || far(3, cube) || !cube.is_finite() {
                shortest = shortest.min(of_argument(function, u, wide));
            }
        }
        for (degree, above, u) in series.steep_poles() {
            shortest = shortest.min(of_steep_pole(degree, above, u));
        }
        Some(shortest)
    }

    /// The highest order.
    pub(super) fn order(&self) -> usize {
        self.motion.order
    }

    /// The bounds by the lowest orders, of the motion and of what does not act on it.
    pub(super) fn lowest_bounds(&mut self) -> [LowestOfAll; 2] {
        let order = self.motion.order;
        let spared =
            self.integrals.get_or_insert_with(|| Shares::of_integrals(self.tolerance, order));
        [&self.motion, spared].map(|shares| LowestOfAll::new(order, &shares.bounds, &shares.screen))
    }

    /// The step that the coefficients allow, which are finite.
    #[inline(always)]
    pub(super) fn by_coefficients<'a, L: FourLanes>(
        &mut self,
        lanes: L,
        counts: SeriesCounts,
        coefficients_of: impl Fn(usize) -> &'a [f64],
    ) -> f64 {
        let SeriesCounts { inputs, switches, integrals } = counts;
        if integrals > 0 && self.integrals.is_none() {
            self.integrals = Some(Shares::of_integrals(self.tolerance, self.motion.order));
        }
        let StepSize { motion, integrals: spared, least, .. } = self;
        let motion: &Shares = motion;
        let spared = spared.as_deref().unwrap_or(motion);
        let mut shortest = ShortestStep::new();
        let first = *least;
        // in one loop, so that there is one copy of what it does
        for place in 0..inputs + switches + integrals {
            let i = match place {
                0 => first,
                place if place <= first => place - 1,
                place => place,
            };
            let shares = if i < inputs + switches { motion } else { spared };
            if shortest.take(lanes, coefficients_of(i), shares) && i < inputs {
                *least = i;
            }
        }
        shortest.step()
    }
}

/// The numbers of series that limit a step, which are taken in this order.
#[derive(Clone, Copy, Debug)]
pub(super) struct SeriesCounts {
    /// The numbers of the motion.
    pub(super) inputs: usize,
    pub(super) switches: usize,
    pub(super) integrals: usize,
}

struct ShortestStep {
    /// Its logarithm, and its powers.
    log: f64,
    powers: [f64; ROOM],
}

impl ShortestStep {
    const fn new() -> ShortestStep {
        ShortestStep { log: f64::INFINITY, powers: [f64::NAN; ROOM] }
    }

    /// Its length, infinite where nothing limits it.
    #[inline(always)]
    fn step(&self) -> f64 {
        if self.log < f64::INFINITY { self.powers[1] } else { f64::INFINITY }
    }

    /// Takes another series into account, whose coefficients are finite. Returns whether it allows less than those before.
    ///
    /// A test by multiplications tells whether its last orders surely allow the step found so far. If not, what the lowest
    /// orders allow mostly decides; only where it does not, all are asked.
    #[inline(always)]
    fn take<L: FourLanes>(&mut self, lanes: L, coefficients: &[f64], shares: &Shares) -> bool {
        if self.log < f64::INFINITY && shares.screen.passes(lanes, coefficients, &self.powers) {
            return false;
        }
        let lowest = shares.bounds.of_lowest(lanes, coefficients);
        let log = lowest.least;
        if log >= self.log {
            return false;
        }
        set_powers(lanes, &mut self.powers, rough_exponential(log), shares.order);
        if shares.bounds.is_decided(lanes, &lowest, coefficients, &self.powers) {
            self.log = log;
            return true;
        }
        let before = self.log;
        self.log = shares.of_all(lanes, coefficients, &lowest, before);
        set_powers(lanes, &mut self.powers, rough_exponential(self.log), shares.order);
        self.log < before
    }
}

/// The kernel of the rule.
struct ByCoefficients<'a> {
    rule: &'a mut StepSize,
    series: &'a Series,
}

impl FourLaneKernel for ByCoefficients<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<L: FourLanes, const FUSED: bool>(self, lanes: L) -> f64 {
        let ByCoefficients { rule, series } = self;
        let (inputs, switches) = (series.inputs(), series.switches());
        let counts = SeriesCounts { inputs, switches, integrals: series.len() - inputs };
        rule.by_coefficients(lanes, counts, |i| match i {
            i if i < inputs => series.coefficients(i),
            i if i < inputs + switches => series.switch(i - inputs),
            i => series.coefficients(i - switches),
        })
    }
}

/// The series of the coordinates and rates.
fn numbers(series: &Series) -> impl Iterator<Item = &[f64]> {
    (0..series.inputs()).map(|i| series.coefficients(i))
}

/// The reciprocals of the differences of two orders, so that those of k − j for j = 0, 1, …, k − 1
/// lie side by side: 1/n is the one at `ROOM - n`.
const RECIPROCALS: [f64; ROOM] = {
    let mut table = [0.0; ROOM];
    let mut n = 1;
    while n < ROOM {
        table[ROOM - n] = 1.0 / n as f64;
        n += 1;
    }
    table
};

/// The logarithm of a tolerance, divided among the orders: `ln ε / (p − j)` for the j-th of p.
#[derive(Clone, Debug)]
struct Shares {
    order: usize,
    bounds: OrderBounds,
    screen: StepScreen,
}

thread_local! {
    /// The shares of the last tolerances, each with the bits of its tolerance, the oldest first.
    static KNOWN: RefCell<Vec<(u64, Arc<Shares>)>> = const { RefCell::new(Vec::new()) };
}

/// No more are kept.
const MOST_KNOWN: usize = 8;

impl Shares {
    /// Those of the coordinates and rates, at the tolerance of the last terms.
    fn of_motion(tolerance: f64, order: usize) -> Arc<Shares> {
        Shares::of(tolerance, order)
    }

    /// Those of what does not act on the motion.
    fn of_integrals(tolerance: f64, order: usize) -> Arc<Shares> {
        Shares::of(tolerance * SPARED, order)
    }

    /// The same, which are computed once for all motions of a thread at a tolerance: a motion has a stepper anew wherever it begins.
    fn of(tolerance: f64, order: usize) -> Arc<Shares> {
        let same =
            |known: &&(u64, Arc<Shares>)| known.0 == tolerance.to_bits() && known.1.order == order;
        KNOWN.with_borrow_mut(|known| {
            if let Some((_, shares)) = known.iter().find(same) {
                return Arc::clone(shares);
            }
            let shares = Arc::new(Shares::new(tolerance, order));
            if known.len() == MOST_KNOWN {
                known.remove(0);
            }
            known.push((tolerance.to_bits(), Arc::clone(&shares)));
            shares
        })
    }

    /// The logarithm of the step that all orders allow, or `before` where that is less; the lowest allow as much as is said.
    #[inline(always)]
    fn of_all<L: FourLanes>(
        &self,
        lanes: L,
        coefficients: &[f64],
        lowest: &LowestBounds,
        before: f64,
    ) -> f64 {
        let mut logs = [f64::NEG_INFINITY; ROOM];
        logarithms(lanes, coefficients, &mut logs);
        let mut least = before;
        for lane in 0..WIDTH {
            if lowest.bound(lane) < least {
                least = least.min(self.bounds.of_lane(lanes, lane, &logs));
            }
        }
        least
    }

    fn new(tolerance: f64, order: usize) -> Shares {
        let log = math::ln(tolerance);
        let mut table = [f64::NEG_INFINITY; ROOM];
        for (share, reciprocal) in table.iter_mut().zip(&RECIPROCALS[ROOM - order..]) {
            *share = log * reciprocal;
        }
        let (log_part, log_indulgence) = (math::ln(PART_OF_RADIUS), math::ln(INDULGENCE));
        let screen = StepScreen::new(order, &table, log_part, log_indulgence);
        let indulgence = |k: usize| indulgence_of(log_indulgence, k, order);
        let bounds = OrderBounds::new(order, &table, log_part, indulgence);
        Shares { order, bounds, screen }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::ScalarLanes;

    /// A series whose terms grow by a factor from one to the next.
    fn geometric(ratio: f64) -> Vec<f64> {
        (0..29).map(|k| math::powi(ratio, k)).collect()
    }

    /// The logarithm of the step that a series allows, with every order asked.
    fn of_one(coefficients: &[f64], shares: &Shares) -> f64 {
        let mut logs = [f64::NEG_INFINITY; ROOM];
        logarithms(ScalarLanes, coefficients, &mut logs);
        let of_lane = |lane| shares.bounds.of_lane(ScalarLanes, lane, &logs);
        (0..WIDTH).map(of_lane).fold(f64::INFINITY, f64::min)
    }

    /// The step that a series of order 28 allows.
    fn step_of(coefficients: &[f64], tolerance: f64) -> f64 {
        math::exp(of_one(coefficients, &Shares::new(tolerance, coefficients.len() - 1)))
    }

    /// Series whose terms grow or shrink by a factor, with noise over many powers of ten, and zeros.
    fn noisy(seed: u64, order: usize) -> Vec<f64> {
        let next =
            |x: &u64| Some(x.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407));
        let bits: Vec<u64> =
            std::iter::successors(Some(seed), next).skip(1).take(order + 3).collect();
        let unit = |i: usize| (bits[i] >> 11) as f64 / (1_u64 << 53) as f64;
        let ratio = math::exp(4.0 * unit(order + 2) - 2.0);
        let term = |k: usize| {
            let size = math::powi(ratio, k as i32) * math::exp(12.0 * unit(k) - 6.0);
            if bits[k].is_multiple_of(7) { 0.0 } else { size }
        };
        (0..=order).map(term).collect()
    }

    #[test]
    fn what_is_not_asked_would_change_nothing() {
        for order in [12, 13, 14, 15, 28, 30, 44] {
            let (motion, integrals) =
                (Shares::of_motion(1e-15, order), Shares::of_integrals(1e-4, order));
            for (shares, moves) in [(motion, true), (integrals, false)] {
                let (mut passed, mut decided) = (0, 0);
                for seed in 0..600 {
                    let mut with = ShortestStep::new();
                    let mut without = f64::INFINITY;
                    for series in (0..4).map(|i| noisy(4 * seed + i, order)) {
                        let shorter = with.take(ScalarLanes, &series, &shares);
                        let found = of_one(&series, &shares);
                        assert_eq!(shorter, found < without, "{series:?}");
                        without = without.min(found);
                        let passes = shares.screen.passes(ScalarLanes, &series, &with.powers);
                        passed += usize::from(passes);
                        let lowest = shares.bounds.of_lowest(ScalarLanes, &series);
                        let log = lowest.least;
                        assert!(log <= found, "{series:?}");
                        let mut powers = [f64::NAN; ROOM];
                        set_powers(ScalarLanes, &mut powers, rough_exponential(log), order);
                        let known =
                            shares.bounds.is_decided(ScalarLanes, &lowest, &series, &powers);
                        assert!(!known || log == found, "{series:?}");
                        decided += usize::from(known);
                    }
                    assert_eq!(with.log.to_bits(), without.to_bits());
                }
                // each is of use only if it mostly spares the next
                let useful = !moves || passed > 800 && decided > 800;
                assert!(useful, "{order}: {passed} {decided}");
            }
        }
    }

    #[test]
    fn a_step_leaves_last_terms_of_a_hundredth_of_the_tolerance() {
        // of an entire function: |c_k| h^k = 1/k! · h^k, at h where the last is ε
        let series: Vec<f64> =
            std::iter::successors(Some((1.0, 1.0)), |&(c, k)| Some((c / k, k + 1.0)))
                .map(|(c, _)| c)
                .take(29)
                .collect();
        let tolerance = 1e-12 * SHARE;
        let step = step_of(&series, tolerance);
        let last = series[28] * math::powi(step, 28);
        let largest = (0..29).map(|k| series[k as usize] * math::powi(step, k));
        let part = last / largest.fold(0.0, f64::max);
        // earlier terms also enter, so less than a hundredth is left
        assert!((0.4e-15..4e-15).contains(&part), "{part:e}");
    }

    #[test]
    fn a_step_stays_within_six_tenths_of_the_radius() {
        // 1/(1 − t) has radius 1; a loose tolerance would lead beyond
        let step = step_of(&geometric(1.0), 0.1);
        assert!((0.59..0.61).contains(&step), "{step}");
        // in any unit
        let step = step_of(&geometric(4.0), 0.1);
        assert!((0.147..0.153).contains(&step), "{step}");
    }

    /// The step of 1 + c t²⁸ is (ε/c)^(1/28), some 6e9, unless c is an underflow.
    #[test]
    fn what_underflow_has_left_shortens_no_step() {
        let step = |last: f64| {
            let mut series = [0.0; 29];
            (series[0], series[28]) = (1.0, last);
            step_of(&series, 1e-17)
        };
        let shortened = step(1.1e-290);
        assert!((1e9..1e10).contains(&shortened), "{shortened}");
        assert_eq!(step(0.9e-290), f64::INFINITY);
    }
}
