//! A test which of a series' last orders allow a step, by multiplications alone: most allow more than the one that allows the
//! least, and need no logarithms.
//!
//! In: a series, the powers of a step. Out: whether the rule of [`step_size`](super::step_size) surely
//! finds no shorter one; "not surely" decides nothing. Never here: the rule, its constants.

use super::last_orders::{
    CLEARLY, FAINT, FIRST, LANES, ROOM, WIDTH, has_radius, indulgence_of, lanes_of_last_orders,
};
use crate::num::{Batch, math};

/// With the terms a_j = |c_j| h^j at a step h, the bound of the j-th order on the k-th is no shorter
/// than h where a_j times a constant is no less than a_k. The lowest orders mostly suffice.
#[derive(Clone, Debug)]
pub(super) struct StepScreen {
    /// The order in the first lane.
    first: usize,
    /// The constants of the tolerance, for the j-th order.
    by_tolerance: [Batch<WIDTH>; FIRST],
    /// Those of the radius of convergence, for the order j + 2; zero where that gives none.
    by_radius: [Batch<WIDTH>; FIRST],
    /// Zero for an order that does not enter, else one.
    entering: Batch<WIDTH>,
}

impl StepScreen {
    pub(super) fn new(
        order: usize,
        table: &[f64; ROOM],
        log_part: f64,
        log_indulgence: f64,
    ) -> StepScreen {
        let constant = |j: usize, k: usize, log: f64| {
            let log = log + indulgence_of(log_indulgence, k, order);
            math::exp((k - j) as f64 * log) / CLEARLY
        };
        let by_radius = |j: usize, k: usize| match j < k - 1 {
            true => constant(j, k, log_part),
            false if has_radius(k) => 0.0,
            false => f64::INFINITY,
        };
        StepScreen {
            first: order + 1 - WIDTH,
            by_tolerance: std::array::from_fn(|j| {
                Batch(lanes_of_last_orders(order, 0.0, |k| constant(j, k, table[j])))
            }),
            by_radius: std::array::from_fn(|j| {
                Batch(lanes_of_last_orders(order, 0.0, |k| by_radius(j + 2, k)))
            }),
            entering: Batch(lanes_of_last_orders(order, 0.0, |_| 1.0)),
        }
    }

    /// Whether all of the last orders of a series surely allow the step whose powers are given.
    #[inline(always)]
    pub(super) fn passes(&self, coefficients: &[f64], powers: &[f64; ROOM]) -> bool {
        let last = powers[self.first..].first_chunk::<WIDTH>();
        let (Some(&own), Some(&powers_of_last)) = (coefficients.last_chunk::<WIDTH>(), last) else {
            return false;
        };
        let low = |j: usize| {
            let c = coefficients[j].abs();
            Batch::splat(if c < FAINT { 0.0 } else { c * powers[j] })
        };
        let own = Batch(own).abs() * self.entering;
        // a coefficient that vanishes allows anything
        let terms = own.where_below(FAINT, Batch([-1.0; WIDTH]), own * Batch(powers_of_last));
        let mut by_tolerance = low(0) * self.by_tolerance[0];
        let mut by_radius = low(2) * self.by_radius[0];
        // one order of each is mostly enough
        if by_tolerance.smaller(by_radius).all_above(terms) {
            return true;
        }
        for j in 1..FIRST {
            by_tolerance = by_tolerance.larger(low(j) * self.by_tolerance[j]);
            by_radius = by_radius.larger(low(j + 2) * self.by_radius[j]);
        }
        by_tolerance.smaller(by_radius).all_above(terms)
    }
}

/// The powers of a step up to one of this order, several at once; the others stay as they are.
#[inline(always)]
pub(super) fn set_powers(powers: &mut [f64; ROOM], h: f64, order: usize) {
    let square = h * h;
    let mut next = [1.0, h, square, square * h];
    for chunk in &mut powers.as_chunks_mut::<LANES>().0[..=order / LANES] {
        *chunk = next;
        for power in &mut next {
            *power *= square * square;
        }
    }
}
