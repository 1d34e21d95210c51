//! Which orders of a series decide a step, and how its coefficients are compared.
//!
//! In: the order of a series. Out: its last orders, and what is allowed to each. Never here: coefficients, steps.

use std::ops::RangeInclusive;

/// The number of last orders that enter. There are more than two, because symmetric motions have
/// coefficients that vanish in a regular pattern.
pub(super) const LAST: usize = 4;

/// The number of orders before these that also enter, with a larger tolerance.
pub(super) const BEFORE: usize = 6;
pub(super) const INDULGENCE: f64 = 1.5;

/// A coefficient below this is an underflow: in a unit of time near the step its term is far below
/// the last digit of anything.
pub(super) const FAINT: f64 = 1e-290;

/// The most coefficients that a series has, and room for a whole chunk behind them.
pub(super) const ROOM: usize = 64;

/// The number of logarithms taken together.
pub(super) const LANES: usize = crate::num::LANES;

/// The number of lowest orders that are looked at first.
pub(super) const FIRST: usize = 3;

/// The ratio by which terms must differ to do so beyond the errors of rough logarithms.
pub(super) const CLEARLY: f64 = 1.001;

/// The number of lanes for the last orders, in whole chunks. The highest order is in the last lane.
pub(super) const WIDTH: usize = (LAST + BEFORE).next_multiple_of(LANES);

pub(super) const CHUNKS: usize = WIDTH / LANES;

pub(super) type LastOrders = [[f64; LANES]; CHUNKS];

/// By how much the logarithm of the step may be longer for the k-th of p orders.
#[inline(always)]
pub(super) fn indulgence_of(log_indulgence: f64, k: usize, p: usize) -> f64 {
    if k + LAST <= p { log_indulgence } else { 0.0 }
}

/// Whether lower orders say of the k-th what the radius of convergence allows: the j-th does for 2 ≤ j < k − 1.
#[inline(always)]
pub(super) fn has_radius(k: usize) -> bool {
    k > 3
}

/// The orders up to p that enter.
#[inline(always)]
pub(super) fn last_orders(p: usize) -> RangeInclusive<usize> {
    (p + 1).saturating_sub(LAST + BEFORE).max(3)..=p
}

/// What each of the last orders of a series gives, in its lane; `otherwise` in the lanes of lower orders, which do not enter.
pub(super) fn lanes_of_last_orders(
    p: usize,
    otherwise: f64,
    of: impl Fn(usize) -> f64,
) -> LastOrders {
    std::array::from_fn(|chunk| {
        std::array::from_fn(|lane| {
            let order = (p + 1 + LANES * chunk + lane).checked_sub(WIDTH);
            order.filter(|k| last_orders(p).contains(k)).map_or(otherwise, &of)
        })
    })
}
