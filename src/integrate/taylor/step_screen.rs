//! A test that a series allows a step, by multiplications alone: most series allow more than the one
//! that allows the least, and need no logarithms.
//!
//! In: a series, the powers of a step. Out: whether the rule of [`step_size`](super::step_size) surely
//! finds no shorter one; "no" decides nothing. Never here: the rule, its constants.

use super::last_orders::{
    BEFORE, FAINT, FIRST, LANES, LAST, ROOM, indulgence_of, larger, last_orders,
};
use crate::num::math;

/// Room for the last orders, in whole chunks.
const WIDTH: usize = (LAST + BEFORE).next_multiple_of(LANES);

/// With the terms a_j = |c_j| h^j at a step h, the bound of the j-th order on the k-th is no shorter
/// than h where a_j times a constant is no less than a_k. The lowest orders mostly suffice.
#[derive(Clone, Debug)]
pub(super) struct StepScreen {
    /// The first of the last orders, which lie side by side.
    pub(super) first: usize,
    /// The constants of the tolerance, for the j-th order.
    pub(super) by_tolerance: [[f64; WIDTH]; FIRST],
    /// Those of the radius of convergence, for the order j + 2; zero where that gives none.
    pub(super) by_radius: [[f64; WIDTH]; FIRST],
}

/// The ratio by which terms must differ to do so beyond the errors of rough logarithms.
const CLEARLY: f64 = 1.001;

impl StepScreen {
    pub(super) fn new(
        order: usize,
        table: &[f64; ROOM],
        log_part: f64,
        log_indulgence: f64,
    ) -> StepScreen {
        let mut screen = StepScreen {
            first: *last_orders(order).start(),
            by_tolerance: [[0.0; WIDTH]; FIRST],
            by_radius: [[0.0; WIDTH]; FIRST],
        };
        for (lane, k) in last_orders(order).enumerate() {
            let indulgence = indulgence_of(log_indulgence, k, order);
            let constant =
                |j: usize, log: f64| math::exp((k - j) as f64 * (log + indulgence)) / CLEARLY;
            for j in 0..FIRST {
                screen.by_tolerance[j][lane] = constant(j, table[j]);
                let inner = j + 2 < k - 1;
                screen.by_radius[j][lane] = if inner { constant(j + 2, log_part) } else { 0.0 };
            }
        }
        screen
    }

    /// Whether a series allows a step, whose powers these are. May be false where it does.
    #[inline(always)]
    pub(super) fn passes(&self, coefficients: &[f64], powers: &[f64; ROOM]) -> bool {
        let mut own = [0.0; WIDTH];
        for (own, c) in own.iter_mut().zip(&coefficients[self.first..]) {
            *own = c.abs();
        }
        let low = |j: usize| {
            let c = coefficients[j].abs();
            if c < FAINT { 0.0 } else { c * powers[j] }
        };
        let (mut by_tolerance, mut by_radius) = ([0.0; WIDTH], [0.0; WIDTH]);
        for j in 0..FIRST {
            let (a, b) = (low(j), low(j + 2));
            for lane in 0..WIDTH {
                by_tolerance[lane] = larger(by_tolerance[lane], a * self.by_tolerance[j][lane]);
                by_radius[lane] = larger(by_radius[lane], b * self.by_radius[j][lane]);
            }
        }
        let mut all = true;
        for lane in 0..WIDTH {
            let term = own[lane] * powers[self.first + lane];
            // a coefficient that vanishes allows anything
            let bound = by_tolerance[lane].min(by_radius[lane]);
            all &= if own[lane] < FAINT { true } else { bound > term };
        }
        all
    }

    /// The powers of a step that are needed.
    #[inline(always)]
    pub(super) fn powers(&self, h: f64) -> [f64; ROOM] {
        let mut powers = [1.0; ROOM];
        for k in 1..self.first + WIDTH {
            powers[k] = powers[k - 1] * h;
        }
        powers
    }
}
