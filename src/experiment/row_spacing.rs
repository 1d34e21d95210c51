//! How far apart the rows of the trail are.
//!
//! In: the setup, the method's step, how many rows a frame had. Out: the time to the next row. Never here: rows.

use super::observed_motion::ObservedMotion;
use super::setup::Setup;
use crate::integrate::Stepping;
use crate::num::math;

/// A step of a high-order method covers about a sixth of an oscillation.
const ROWS_PER_LONG_STEP: f64 = 32.0;

/// The number of rows in a step of a series where only the gauges see them: the motion is as accurate within it as at its end.
const SAMPLES_PER_LONG_STEP: f64 = 4.0;

/// The greatest multiple of the setup's spacing that lies between two rows which only the gauges see.
const SPARSEST_SAMPLES: f64 = 4.0;

/// The number of rows in a frame, at an unlimited speed, beyond which they are recorded farther apart, and below which
/// closer together: a quarter of the rows that are kept in full, and an eighth of that.
const MOST_ROWS: u64 = 2048;
const FEWEST_ROWS: u64 = MOST_ROWS / 8;

/// The greatest sparseness of rows.
const SPARSEST: f64 = 65_536.0;

/// The longest time between two rows, in seconds of wall time: one frame.
const LONGEST_LAG: f64 = 1.0 / 60.0;

pub(super) struct RowSpacing {
    /// The rows recorded since the last frame.
    rows: u64,
    /// How many times farther apart rows are at an unlimited speed than a smooth curve needs; a power of two.
    sparseness: f64,
    /// Whether only the gauges see the rows.
    only_gauges: bool,
}

impl Default for RowSpacing {
    fn default() -> RowSpacing {
        RowSpacing { rows: 0, sparseness: 1.0, only_gauges: false }
    }
}

impl RowSpacing {
    pub(super) fn row_recorded(&mut self) {
        self.rows += 1;
    }

    /// Only the gauges see the rows from now on.
    pub(super) fn see_gauges_only(&mut self) {
        self.only_gauges = true;
    }

    /// Adjusts the sparseness to the rows recorded since the last frame, at this speed.
    pub(super) fn frame_shown(&mut self, speed: f64) {
        let rows = std::mem::take(&mut self.rows);
        self.sparseness = match rows {
            _ if speed.is_finite() => 1.0,
            0..FEWEST_ROWS => (self.sparseness / 2.0).max(1.0),
            FEWEST_ROWS..MOST_ROWS => self.sparseness,
            _ => (self.sparseness * 2.0).min(SPARSEST),
        };
    }

    /// The time to the next row. It is short enough for a smooth curve, as estimated from the method's step, but not
    /// shorter than the setup's spacing, and not so long that the trail lags behind at the current speed. Where only the gauges
    /// see the rows, a few in each step of a series suffice.
    pub(super) fn to_next(&self, setup: &Setup, motion: &ObservedMotion) -> f64 {
        let sparseness = if setup.speed.is_finite() { 1.0 } else { self.sparseness };
        let least = setup.spacing * sparseness;
        let of_series = motion.method().order.is_none();
        let (per_step, most) = match motion.method().stepping {
            Stepping::Adaptive if self.only_gauges && of_series => {
                (SAMPLES_PER_LONG_STEP, least * SPARSEST_SAMPLES)
            }
            Stepping::Adaptive => (ROWS_PER_LONG_STEP, least.max(setup.speed * LONGEST_LAG)),
            Stepping::Fixed => (1.0, least.max(setup.speed * LONGEST_LAG)),
        };
        let smooth = motion.step_size().abs() / per_step * sparseness;
        if smooth <= least {
            return least;
        }
        // a power of two, so that it does not change with every step
        (least * math::exp2(math::log2(smooth / least).floor())).min(most)
    }
}
