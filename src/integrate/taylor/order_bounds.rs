//! The steps that the last orders of a series allow, all of them side by side.
//!
//! In: the logarithms of the sizes of a series' coefficients. Out: the logarithm of the step that they allow. Never here:
//! coefficients, the constants of the rule.
//!
//! ```text
//!                 k = p−11  p−10  …  p        one lane for each of the last orders; the first two are not among them
//!   j = 0             ·      ·       ·
//!   j = 1             ·      ·       ·        (ln |c_j| − ln |c_k|)/(k − j) + ln ε/(p − j)
//!   …                                         the largest of each column
//! ```

use super::last_orders::{ROOM, WIDTH, lanes_of_last_orders};
use crate::num::Batch;

/// Less than anything that a coefficient allows.
const LEAST: Batch<WIDTH> = Batch([f64::NEG_INFINITY; WIDTH]);

/// What a coefficient of an order enters with.
#[derive(Clone, Copy, Debug)]
struct Bound {
    /// The reciprocals of the differences of the orders.
    reciprocals: Batch<WIDTH>,
    /// What is added for the tolerance; −∞ where the order is none of those below.
    by_tolerance: Batch<WIDTH>,
    /// What is added for the radius of convergence; −∞ where the order gives none.
    by_radius: Batch<WIDTH>,
}

/// The bounds at one tolerance and order.
#[derive(Clone, Debug)]
pub(super) struct OrderBounds {
    bounds: Vec<Bound>,
    /// By how much the logarithm of the step may be longer; infinite for an order that is not among the last, which therefore
    /// allows anything.
    indulgence: Batch<WIDTH>,
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
        let of_last = |of: &dyn Fn(usize) -> f64| Batch(lanes_of_last_orders(order, 0.0, of));
        let bound = |j: usize| Bound {
            reciprocals: of_last(&|k| {
                if j < k { 1.0 / (k - j) as f64 } else { 0.0 }
            }),
            by_tolerance: of_last(&|k| only(j < k, table[j])),
            by_radius: of_last(&|k| only((2..k - 1).contains(&j), log_part)),
        };
        OrderBounds {
            bounds: (0..order).map(bound).collect(),
            indulgence: Batch(lanes_of_last_orders(order, f64::INFINITY, indulgence)),
        }
    }

    /// The logarithm of the step, or `shortest` if that is less. A coefficient that vanishes has the logarithm −∞.
    #[inline(always)]
    pub(super) fn shortest(&self, logs: &[f64; ROOM], shortest: f64) -> f64 {
        let order = self.bounds.len();
        let (Some(own), logs) = (logs[..=order].last_chunk::<WIDTH>(), &logs[..order]) else {
            return shortest;
        };
        let own = Batch(*own);
        let (mut by_tolerance, mut by_radius) = (LEAST, LEAST);
        for j in 0..order {
            let (bound, log) = (&self.bounds[j], logs[j]);
            let root = (Batch::splat(log) - own) * bound.reciprocals;
            by_tolerance = by_tolerance.larger(root + bound.by_tolerance);
            by_radius = by_radius.larger(root + bound.by_radius);
        }
        let within = by_tolerance.smaller(by_radius);
        let log = by_radius.where_equal(f64::NEG_INFINITY, by_tolerance, within) + self.indulgence;
        // a coefficient that vanishes allows anything
        let anything = Batch::splat(f64::INFINITY);
        own.where_equal(f64::NEG_INFINITY, anything, log).least().min(shortest)
    }
}
