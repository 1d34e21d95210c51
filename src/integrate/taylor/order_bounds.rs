//! The steps that the last orders of a series allow, each by itself.
//!
//! In: the coefficients of a series, or the logarithms of their sizes. Out: the logarithm of the step that one of its last orders
//! allows. Never here: the constants of the rule, which orders are asked.
//!
//! ```text
//!   order k:    j = 0   1   2   3  │  4   5   6   7  │  …  k − 1     four lower orders at once
//!               (ln |c_j| − ln |c_k|)/(k − j) + ln ε/(p − j)         the largest of these, but no more than
//!               (ln |c_j| − ln |c_k|)/(k − j) + ln of the part of    the largest of these, 2 ≤ j < k − 1
//!                                             the radius
//! ```
//!
//! The four lowest orders mostly decide. What they allow is found for all of the last orders at once, and that no other one
//! allows more is seen by multiplications.

use super::last_orders::{
    CHUNKS, CLEARLY, LANES, LastOrders, ROOM, WIDTH, has_radius, lanes_of_last_orders, last_orders,
};
use super::rough_logarithms::four_logarithms;
use crate::num::{FourLanes, math, padded};

/// What the lower orders enter with for one of the last, four at once.
#[derive(Clone, Debug)]
struct OrderBound {
    order: usize,
    chunks: Vec<BoundChunk>,
    /// By how much the logarithm of the step may be longer.
    indulgence: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct BoundChunk {
    /// The reciprocals of the differences of the orders.
    pub(super) reciprocals: [f64; LANES],
    /// What is added for the tolerance; −∞ where the order is none of those below.
    pub(super) by_tolerance: [f64; LANES],
    /// What is added for the radius of convergence; −∞ where the order gives none.
    pub(super) by_radius: [f64; LANES],
    /// With the terms a_j = |c_j| h^j at a step h, the j-th order may allow more than h only where a_j times this is
    /// no less than a_k: by the tolerance.
    pub(super) tolerance_factors: [f64; LANES],
    /// The same factor by the radius of convergence.
    radius_factors: [f64; LANES],
}

/// One of the lowest orders, for all of the last at once.
#[derive(Clone, Copy, Debug)]
struct LowOrder {
    reciprocals: LastOrders,
    by_tolerance: LastOrders,
    by_radius: LastOrders,
}

/// The logarithms of the steps that the lowest orders allow, one for each of the last orders. Other orders may allow more.
#[derive(Clone, Copy, Debug)]
pub(super) struct LowestBounds {
    by_tolerance: LastOrders,
    /// By the tolerance and by the radius of convergence.
    pub(super) logs: LastOrders,
    /// The least of them, and its place.
    pub(super) least: f64,
    place: usize,
}

impl LowestBounds {
    /// Those of a series too short to have these orders: nothing is known to be allowed.
    const NOTHING: LowestBounds = LowestBounds {
        by_tolerance: [[f64::NEG_INFINITY; LANES]; CHUNKS],
        logs: [[f64::NEG_INFINITY; LANES]; CHUNKS],
        least: f64::NEG_INFINITY,
        place: 0,
    };

    pub(super) fn bound(&self, lane: usize) -> f64 {
        self.logs[lane / LANES][lane % LANES]
    }
}

/// The bounds at one tolerance and order.
#[derive(Clone, Debug)]
pub(super) struct OrderBounds {
    bounds: Vec<OrderBound>,
    lowest: [LowOrder; LANES],
    indulgences: LastOrders,
}

impl OrderBounds {
    /// Those of a series of this order, from the part of the tolerance for each order, the part of the radius of
    /// convergence, and what each of the last orders may be longer by.
    pub(super) fn new(
        order: usize,
        table: &[f64; ROOM],
        log_part: f64,
        indulgence: impl Fn(usize) -> f64,
    ) -> OrderBounds {
        let only = |known: bool, x: f64| if known { x } else { f64::NEG_INFINITY };
        let (roots, part) = (table.map(math::exp), math::exp(log_part));
        let chunk = |k: usize, first: usize| {
            let lanes = |of: &dyn Fn(usize) -> f64| std::array::from_fn(|i| of(first + i));
            let longer = math::exp(indulgence(k));
            let factor = |j: usize, known: bool, root: f64| {
                if known { CLEARLY * math::powi(root * longer, (k - j) as i32) } else { 0.0 }
            };
            BoundChunk {
                tolerance_factors: lanes(&|j| factor(j, j < k, roots[j])),
                radius_factors: lanes(&|j| factor(j, (2..k - 1).contains(&j), part)),
                reciprocals: lanes(&|j| if j < k { 1.0 / (k - j) as f64 } else { 1.0 }),
                by_tolerance: lanes(&|j| only(j < k, table[j])),
                by_radius: lanes(&|j| only((2..k - 1).contains(&j), log_part)),
            }
        };
        let bound = |k: usize| OrderBound {
            order: k,
            chunks: (0..k).step_by(LANES).map(|first| chunk(k, first)).collect(),
            indulgence: indulgence(k),
        };
        let bounds: Vec<OrderBound> = last_orders(order).map(bound).collect();
        let first = |k: usize| &bounds[k - *last_orders(order).start()].chunks[0];
        let low =
            |otherwise: f64, of: &dyn Fn(usize) -> f64| lanes_of_last_orders(order, otherwise, of);
        // an order that does not enter, and a radius that is not known, allow anything
        let any = f64::INFINITY;
        let radius = |j: usize, k: usize| if has_radius(k) { first(k).by_radius[j] } else { any };
        let lowest = std::array::from_fn(|j| LowOrder {
            reciprocals: low(0.0, &|k| first(k).reciprocals[j]),
            by_tolerance: low(any, &|k| first(k).by_tolerance[j]),
            by_radius: low(any, &|k| radius(j, k)),
        });
        let indulgences = lanes_of_last_orders(order, 0.0, indulgence);
        OrderBounds { bounds, lowest, indulgences }
    }

    /// What the lower orders enter with for the highest order but so many.
    pub(super) fn chunks_of_last(&self, below: usize) -> &[BoundChunk] {
        &self.bounds[self.bounds.len() - 1 - below].chunks
    }

    /// What the lowest orders of a series allow.
    #[inline(always)]
    pub(super) fn of_lowest<L: FourLanes>(&self, lanes: L, coefficients: &[f64]) -> LowestBounds {
        let (low, own) = (coefficients.first_chunk::<LANES>(), coefficients.last_chunk::<WIDTH>());
        let (Some(low), Some(own)) = (low, own) else { return LowestBounds::NOTHING };
        let low = lanes.to_array(four_logarithms(lanes, lanes.abs(lanes.from_array(*low))));
        let (infinite, none) = (lanes.splat(f64::INFINITY), lanes.splat(f64::NEG_INFINITY));
        let mut found = LowestBounds::NOTHING;
        let mut least = infinite;
        let mut bounds = [infinite; CHUNKS];
        let own = own.as_chunks::<LANES>().0;
        // by places, since what is given to an iterator is not always inlined
        for i in 0..CHUNKS {
            let own = four_logarithms(lanes, lanes.abs(lanes.from_array(own[i])));
            let (mut by_tolerance, mut by_radius) = (none, none);
            for j in 0..LANES {
                let order = &self.lowest[j];
                let apart = lanes.sub(lanes.splat(low[j]), own);
                let root = lanes.mul(apart, lanes.from_array(order.reciprocals[i]));
                let allowed = lanes.add(root, lanes.from_array(order.by_tolerance[i]));
                by_tolerance = lanes.max(by_tolerance, allowed);
                // the first two say nothing of the radius
                if j >= 2 {
                    let allowed = lanes.add(root, lanes.from_array(order.by_radius[i]));
                    by_radius = lanes.max(by_radius, allowed);
                }
            }
            let indulgences = lanes.from_array(self.indulgences[i]);
            let logs = lanes.add(lanes.min(by_tolerance, by_radius), indulgences);
            // a coefficient that vanishes allows anything
            let logs = lanes.where_below(own, lanes.splat(f64::MIN), infinite, logs);
            found.by_tolerance[i] = lanes.to_array(lanes.add(by_tolerance, indulgences));
            found.logs[i] = lanes.to_array(logs);
            bounds[i] = logs;
            least = lanes.min(least, logs);
        }
        found.least = lanes.least(least);
        let (all, mut equal) = (lanes.splat(found.least), 0);
        for i in 0..CHUNKS {
            equal |= lanes.equal(bounds[i], all) << (LANES * i);
        }
        found.place = equal.trailing_zeros() as usize;
        found
    }

    /// Whether the least of these bounds is the step that all orders allow, whose powers are given.
    #[inline(always)]
    pub(super) fn is_decided<L: FourLanes>(
        &self,
        lanes: L,
        lowest: &LowestBounds,
        coefficients: &[f64],
        powers: &[f64; ROOM],
    ) -> bool {
        let place = lowest.place;
        let Some(bound) = self.in_lane(place) else { return false };
        let own = coefficients[bound.order].abs() * powers[bound.order];
        let (chunk, lane) = (place / LANES, place % LANES);
        let by_tolerance = lowest.logs[chunk][lane] == lowest.by_tolerance[chunk][lane];
        let (chunks, rest) = coefficients.as_chunks::<LANES>();
        let powers = powers.as_chunks::<LANES>().0;
        let (all, mut most) = (lanes.splat(own), lanes.splat(0.0));
        for i in 1..bound.chunks.len() {
            let chunk = &bound.chunks[i];
            let lower = if i < chunks.len() { chunks[i] } else { padded(rest, 0.0) };
            let factors =
                if by_tolerance { &chunk.tolerance_factors } else { &chunk.radius_factors };
            let terms = lanes.mul(lanes.abs(lanes.from_array(lower)), lanes.from_array(powers[i]));
            most = lanes.max(most, lanes.mul(terms, lanes.from_array(*factors)));
        }
        own.is_normal() && lanes.above(all, most) == lanes.all_lanes()
    }

    #[inline(always)]
    fn in_lane(&self, lane: usize) -> Option<&OrderBound> {
        self.bounds.get((lane + self.bounds.len()).checked_sub(WIDTH)?)
    }

    /// The logarithm of the step that the order in a lane of [`lanes_of_last_orders`](super::last_orders::lanes_of_last_orders)
    /// allows, infinite for one that does not enter. A coefficient that vanishes has the logarithm −∞.
    #[inline(always)]
    pub(super) fn of_lane<L: FourLanes>(&self, lanes: L, lane: usize, logs: &[f64; ROOM]) -> f64 {
        let Some(bound) = self.in_lane(lane) else { return f64::INFINITY };
        let own = logs[bound.order];
        if own == f64::NEG_INFINITY {
            // a coefficient that vanishes allows anything
            return f64::INFINITY;
        }
        let own = lanes.splat(own);
        let none = lanes.splat(f64::NEG_INFINITY);
        let (mut by_tolerance, mut by_radius) = (none, none);
        let logs = logs.as_chunks::<LANES>().0;
        for i in 0..bound.chunks.len() {
            let chunk = &bound.chunks[i];
            let root = lanes.mul(
                lanes.sub(lanes.from_array(logs[i]), own),
                lanes.from_array(chunk.reciprocals),
            );
            let allowed = lanes.add(root, lanes.from_array(chunk.by_tolerance));
            by_tolerance = lanes.max(by_tolerance, allowed);
            by_radius = lanes.max(by_radius, lanes.add(root, lanes.from_array(chunk.by_radius)));
        }
        let (by_tolerance, by_radius) = (lanes.largest(by_tolerance), lanes.largest(by_radius));
        let no_radius = by_radius == f64::NEG_INFINITY;
        let log = if no_radius { by_tolerance } else { by_tolerance.min(by_radius) };
        log + bound.indulgence
    }
}
