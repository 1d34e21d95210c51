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
    CLEARLY, LANES, ROOM, WIDTH, has_radius, lanes_of_last_orders, last_orders,
};
use super::rough_logarithms::rough_logarithms;
use crate::num::{Batch, math, padded};

/// What the lower orders enter with for one of the last, four at once.
#[derive(Clone, Debug)]
struct OrderBound {
    order: usize,
    chunks: Vec<BoundChunk>,
    /// By how much the logarithm of the step may be longer.
    indulgence: f64,
}

#[derive(Clone, Copy, Debug)]
struct BoundChunk {
    /// The reciprocals of the differences of the orders.
    reciprocals: Batch<LANES>,
    /// What is added for the tolerance; −∞ where the order is none of those below.
    by_tolerance: Batch<LANES>,
    /// What is added for the radius of convergence; −∞ where the order gives none.
    by_radius: Batch<LANES>,
    /// With the terms a_j = |c_j| h^j at a step h, the j-th order may allow more than h only where a_j times this is
    /// no less than a_k: by the tolerance.
    tolerance_factors: Batch<LANES>,
    /// The same factor by the radius of convergence.
    radius_factors: Batch<LANES>,
}

/// One of the lowest orders, for all of the last at once.
#[derive(Clone, Copy, Debug)]
struct LowOrder {
    reciprocals: Batch<WIDTH>,
    by_tolerance: Batch<WIDTH>,
    by_radius: Batch<WIDTH>,
}

/// The logarithms of the steps that the lowest orders allow, one for each of the last orders. Other orders may allow more.
#[derive(Clone, Copy, Debug)]
pub(super) struct LowestBounds {
    by_tolerance: Batch<WIDTH>,
    /// By the tolerance and by the radius of convergence.
    pub(super) logs: Batch<WIDTH>,
}

impl LowestBounds {
    /// Those of a series too short to have these orders: nothing is known to be allowed.
    const NOTHING: LowestBounds = LowestBounds {
        by_tolerance: Batch([f64::NEG_INFINITY; WIDTH]),
        logs: Batch([f64::NEG_INFINITY; WIDTH]),
    };
}

/// The bounds at one tolerance and order.
#[derive(Clone, Debug)]
pub(super) struct OrderBounds {
    bounds: Vec<OrderBound>,
    lowest: [LowOrder; LANES],
    indulgences: Batch<WIDTH>,
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
        let chunk = |k: usize, first: usize| {
            let lanes = |of: &dyn Fn(usize) -> f64| Batch(std::array::from_fn(|i| of(first + i)));
            let factor = |j: usize, log: f64| {
                CLEARLY * math::exp(k.saturating_sub(j).max(1) as f64 * (log + indulgence(k)))
            };
            BoundChunk {
                tolerance_factors: lanes(&|j| factor(j, only(j < k, table[j]))),
                radius_factors: lanes(&|j| factor(j, only((2..k - 1).contains(&j), log_part))),
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
        let low = |otherwise: f64, of: &dyn Fn(usize) -> f64| {
            Batch(lanes_of_last_orders(order, otherwise, of))
        };
        // an order that does not enter, and a radius that is not known, allow anything
        let any = f64::INFINITY;
        let radius = |j: usize, k: usize| if has_radius(k) { first(k).by_radius.0[j] } else { any };
        let lowest = std::array::from_fn(|j| LowOrder {
            reciprocals: low(0.0, &|k| first(k).reciprocals.0[j]),
            by_tolerance: low(any, &|k| first(k).by_tolerance.0[j]),
            by_radius: low(any, &|k| radius(j, k)),
        });
        let indulgences = Batch(lanes_of_last_orders(order, 0.0, indulgence));
        OrderBounds { bounds, lowest, indulgences }
    }

    /// What the lowest orders of a series allow.
    #[inline(always)]
    pub(super) fn of_lowest(&self, coefficients: &[f64]) -> LowestBounds {
        let (low, own) = (coefficients.first_chunk::<LANES>(), coefficients.last_chunk::<WIDTH>());
        let (Some(low), Some(own)) = (low, own) else { return LowestBounds::NOTHING };
        let (low, own) = (Batch(*low).abs(), Batch(*own).abs());
        let (low, own) = (rough_logarithms(low.0), Batch(rough_logarithms(own.0)));
        let mut by_tolerance = Batch([f64::NEG_INFINITY; WIDTH]);
        let mut by_radius = by_tolerance;
        for j in 0..LANES {
            let (order, log) = (&self.lowest[j], low[j]);
            let root = (Batch::splat(log) - own) * order.reciprocals;
            by_tolerance = by_tolerance.larger(root + order.by_tolerance);
            by_radius = by_radius.larger(root + order.by_radius);
        }
        // a coefficient that vanishes allows anything
        let any = Batch([f64::INFINITY; WIDTH]);
        let logs = by_tolerance.smaller(by_radius) + self.indulgences;
        let logs = own.where_equal(f64::NEG_INFINITY, any, logs);
        LowestBounds { by_tolerance: by_tolerance + self.indulgences, logs }
    }

    /// Whether the least of these bounds is the step that all orders allow, whose powers are given.
    #[inline(always)]
    pub(super) fn is_decided(
        &self,
        lowest: &LowestBounds,
        coefficients: &[f64],
        powers: &[f64; ROOM],
    ) -> bool {
        let lane = lowest.logs.place_of_least();
        let Some(bound) = self.in_lane(lane) else { return false };
        let own = coefficients[bound.order].abs() * powers[bound.order];
        let by_tolerance = lowest.logs.0[lane] == lowest.by_tolerance.0[lane];
        let (chunks, rest) = coefficients.as_chunks::<LANES>();
        let last = padded(rest, 0.0);
        let powers = powers.as_chunks::<LANES>().0;
        let mut are_smaller = true;
        for i in 1..bound.chunks.len() {
            let (chunk, lower) = (&bound.chunks[i], chunks.get(i).unwrap_or(&last));
            let factors = if by_tolerance { chunk.tolerance_factors } else { chunk.radius_factors };
            let terms = Batch(*lower).abs() * Batch(powers[i]) * factors;
            are_smaller &= Batch::splat(own).all_above(terms);
        }
        own.is_normal() && are_smaller
    }

    #[inline(always)]
    fn in_lane(&self, lane: usize) -> Option<&OrderBound> {
        self.bounds.get((lane + self.bounds.len()).checked_sub(WIDTH)?)
    }

    /// The logarithm of the step that the order in a lane of [`lanes_of_last_orders`](super::last_orders::lanes_of_last_orders)
    /// allows, infinite for one that does not enter. A coefficient that vanishes has the logarithm −∞.
    #[inline(always)]
    pub(super) fn of_lane(&self, lane: usize, logs: &[f64; ROOM]) -> f64 {
        let Some(bound) = self.in_lane(lane) else { return f64::INFINITY };
        let own = logs[bound.order];
        if own == f64::NEG_INFINITY {
            // a coefficient that vanishes allows anything
            return f64::INFINITY;
        }
        let own = Batch::splat(own);
        let mut by_tolerance = Batch([f64::NEG_INFINITY; LANES]);
        let mut by_radius = by_tolerance;
        for (chunk, logs) in bound.chunks.iter().zip(logs.as_chunks::<LANES>().0) {
            let root = (Batch(*logs) - own) * chunk.reciprocals;
            by_tolerance = by_tolerance.larger(root + chunk.by_tolerance);
            by_radius = by_radius.larger(root + chunk.by_radius);
        }
        let (by_tolerance, by_radius) = (by_tolerance.largest(), by_radius.largest());
        let no_radius = by_radius == f64::NEG_INFINITY;
        let log = if no_radius { by_tolerance } else { by_tolerance.min(by_radius) };
        log + bound.indulgence
    }
}
