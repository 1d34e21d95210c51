//! The steps that the last orders of a series allow, each by itself.
//!
//! In: the logarithms of the sizes of a series' coefficients. Out: the logarithm of the step that one of its last orders
//! allows. Never here: coefficients, the constants of the rule, which orders are asked.
//!
//! ```text
//!   order k:    j = 0   1   2   3  │  4   5   6   7  │  …  k − 1     four lower orders at once
//!               (ln |c_j| − ln |c_k|)/(k − j) + ln ε/(p − j)         the largest of these, but no more than
//!               (ln |c_j| − ln |c_k|)/(k − j) + ln of the part of    the largest of these, 2 ≤ j < k − 1
//!                                             the radius
//! ```

use super::last_orders::{LANES, ROOM, WIDTH, last_orders};
use crate::num::Batch;

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
}

/// The bounds at one tolerance and order.
#[derive(Clone, Debug)]
pub(super) struct OrderBounds {
    bounds: Vec<OrderBound>,
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
            BoundChunk {
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
        OrderBounds { bounds: last_orders(order).map(bound).collect() }
    }

    /// The logarithm of the step that the order in a lane of [`lanes_of_last_orders`](super::last_orders::lanes_of_last_orders)
    /// allows, infinite for one that does not enter. A coefficient that vanishes has the logarithm −∞.
    #[inline(always)]
    pub(super) fn of_lane(&self, lane: usize, logs: &[f64; ROOM]) -> f64 {
        let place = (lane + self.bounds.len()).checked_sub(WIDTH);
        let Some(bound) = place.and_then(|i| self.bounds.get(i)) else { return f64::INFINITY };
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
