//! A test which of a series' last orders allow a step, by multiplications alone: most allow more than the one that allows the
//! least, and need no logarithms.
//!
//! In: a series, the powers of a step. Out: whether the rule of [`step_size`](super::step_size) surely
//! finds no shorter one; "not surely" decides nothing. Never here: the rule, its constants.

use super::last_orders::{
    BEFORE, CHUNKS, CLEARLY, FAINT, FIRST, LANES, LAST, LastOrders, ROOM, WIDTH, has_radius,
    indulgence_of, lanes_of_last_orders,
};
use crate::num::{FourLanes, math};

/// With the terms a_j = |c_j| h^j at a step h, the bound of the j-th order on the k-th is no shorter
/// than h where a_j times a constant is no less than a_k. The lowest orders mostly suffice.
#[derive(Clone, Debug)]
pub(super) struct StepScreen {
    /// The order in the first lane.
    first: usize,
    /// The constants of the tolerance, for the j-th order.
    by_tolerance: [LastOrders; FIRST],
    /// Those of the radius of convergence, for the order j + 2; zero where that gives none.
    by_radius: [LastOrders; FIRST],
    /// Zero for an order that does not enter, else one.
    entering: LastOrders,
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
                lanes_of_last_orders(order, 0.0, |k| constant(j, k, table[j]))
            }),
            by_radius: std::array::from_fn(|j| {
                lanes_of_last_orders(order, 0.0, |k| by_radius(j + 2, k))
            }),
            entering: lanes_of_last_orders(order, 0.0, |_| 1.0),
        }
    }

    /// The first of the orders before the last that enter, and what the term of each is multiplied by to be compared with those of the
    /// four lowest orders: where it is no more than one of the first two, these surely allow the step by the tolerance, and no
    /// more than one of the others by the radius of convergence.
    pub(super) fn before_last(&self) -> (usize, [[f64; LANES]; BEFORE]) {
        let lane = WIDTH - LAST - BEFORE;
        let share =
            |constants: &LastOrders, lane: usize| 1.0 / constants[lane / LANES][lane % LANES];
        let of = |lane: usize| {
            let ([a, b, _], [c, d, _]) = (&self.by_tolerance, &self.by_radius);
            [a, b, c, d].map(|constants| share(constants, lane))
        };
        (self.first + lane, std::array::from_fn(|before| of(lane + before)))
    }

    /// Whether all of the last orders of a series surely allow the step whose powers are given.
    #[inline(always)]
    pub(super) fn passes<L: FourLanes>(
        &self,
        lanes: L,
        coefficients: &[f64],
        powers: &[f64; ROOM],
    ) -> bool {
        let last = powers[self.first..].first_chunk::<WIDTH>();
        let (Some(own), Some(last)) = (coefficients.last_chunk::<WIDTH>(), last) else {
            return false;
        };
        let (own, last) = (own.as_chunks::<LANES>().0, last.as_chunks::<LANES>().0);
        let (faint, vanishing) = (lanes.splat(FAINT), lanes.splat(-1.0));
        let (first, second) =
            (low(lanes, coefficients, powers, 0), low(lanes, coefficients, powers, 2));
        let mut terms = [vanishing; CHUNKS];
        let mut passing = lanes.all_lanes();
        // by places, since what is given to an iterator is not always inlined
        for i in 0..CHUNKS {
            let own =
                lanes.mul(lanes.abs(lanes.from_array(own[i])), lanes.from_array(self.entering[i]));
            let term = lanes.mul(own, lanes.from_array(last[i]));
            // a coefficient that vanishes allows anything
            terms[i] = lanes.where_below(own, faint, vanishing, term);
            let by_tolerance = lanes.mul(first, lanes.from_array(self.by_tolerance[0][i]));
            let by_radius = lanes.mul(second, lanes.from_array(self.by_radius[0][i]));
            passing &= lanes.above(lanes.min(by_tolerance, by_radius), terms[i]);
        }
        // one order of each is mostly enough
        if passing == lanes.all_lanes() {
            return true;
        }
        for i in 0..CHUNKS {
            let mut by_tolerance = lanes.mul(first, lanes.from_array(self.by_tolerance[0][i]));
            let mut by_radius = lanes.mul(second, lanes.from_array(self.by_radius[0][i]));
            for j in 1..FIRST {
                let own = low(lanes, coefficients, powers, j);
                by_tolerance = lanes
                    .max(by_tolerance, lanes.mul(own, lanes.from_array(self.by_tolerance[j][i])));
                let own = low(lanes, coefficients, powers, j + 2);
                by_radius =
                    lanes.max(by_radius, lanes.mul(own, lanes.from_array(self.by_radius[j][i])));
            }
            let allowed = lanes.min(by_tolerance, by_radius);
            if lanes.above(allowed, terms[i]) != lanes.all_lanes() {
                return false;
            }
        }
        true
    }
}

/// The term of one of the lowest orders in all lanes, zero where it is an underflow.
#[inline(always)]
fn low<L: FourLanes>(lanes: L, coefficients: &[f64], powers: &[f64; ROOM], j: usize) -> L::Numbers {
    let c = coefficients[j].abs();
    lanes.splat(if c < FAINT { 0.0 } else { c * powers[j] })
}

/// The powers of a step up to one of this order, several at once; the others stay as they are.
#[inline(always)]
pub(super) fn set_powers<L: FourLanes>(lanes: L, powers: &mut [f64; ROOM], h: f64, order: usize) {
    let square = h * h;
    let mut next = lanes.from_array([1.0, h, square, square * h]);
    let fourth = lanes.splat(square * square);
    let chunks = &mut powers.as_chunks_mut::<LANES>().0[..=order / LANES];
    for i in 0..chunks.len() {
        chunks[i] = lanes.to_array(next);
        next = lanes.mul(next, fourth);
    }
}
