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

use super::last_orders::{ROOM, WIDTH, lanes_of_last_orders, larger};

/// Less than anything that a coefficient allows.
const LEAST: [f64; WIDTH] = [f64::NEG_INFINITY; WIDTH];

/// What a coefficient of an order enters with.
#[derive(Clone, Copy, Debug)]
struct Bound {
    /// The reciprocals of the differences of the orders.
    reciprocals: [f64; WIDTH],
    /// What is added for the tolerance; −∞ where the order is none of those below.
    by_tolerance: [f64; WIDTH],
    /// What is added for the radius of convergence; −∞ where the order gives none.
    by_radius: [f64; WIDTH],
}

/// The bounds at one tolerance and order.
#[derive(Clone, Debug)]
pub(super) struct OrderBounds {
    bounds: Vec<Bound>,
    /// By how much the logarithm of the step may be longer; infinite for an order that is not among the last, which therefore
    /// allows anything.
    indulgence: [f64; WIDTH],
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
        let bound = |j: usize| Bound {
            reciprocals: lanes_of_last_orders(order, 0.0, |k| {
                if j < k { 1.0 / (k - j) as f64 } else { 0.0 }
            }),
            by_tolerance: lanes_of_last_orders(order, 0.0, |k| only(j < k, table[j])),
            by_radius: lanes_of_last_orders(order, 0.0, |k| {
                only((2..k - 1).contains(&j), log_part)
            }),
        };
        OrderBounds {
            bounds: (0..order).map(bound).collect(),
            indulgence: lanes_of_last_orders(order, f64::INFINITY, indulgence),
        }
    }

    /// The logarithm of the step, or `shortest` if that is less. A coefficient that vanishes has the logarithm −∞.
    #[inline(always)]
    pub(super) fn shortest(&self, logs: &[f64; ROOM], mut shortest: f64) -> f64 {
        let order = self.bounds.len();
        let (Some(own), logs) = (logs[..=order].last_chunk::<WIDTH>(), &logs[..order]) else {
            return shortest;
        };
        let (mut by_tolerance, mut by_radius) = (LEAST, LEAST);
        for j in 0..order {
            let (bound, log) = (&self.bounds[j], logs[j]);
            for lane in 0..WIDTH {
                let root = (log - own[lane]) * bound.reciprocals[lane];
                by_tolerance[lane] = larger(by_tolerance[lane], root + bound.by_tolerance[lane]);
                by_radius[lane] = larger(by_radius[lane], root + bound.by_radius[lane]);
            }
        }
        for lane in 0..WIDTH {
            if own[lane] == f64::NEG_INFINITY {
                // a coefficient that vanishes allows anything
                continue;
            }
            let mut log = by_tolerance[lane];
            if by_radius[lane] > f64::NEG_INFINITY {
                log = log.min(by_radius[lane]);
            }
            shortest = shortest.min(log + self.indulgence[lane]);
        }
        shortest
    }
}
