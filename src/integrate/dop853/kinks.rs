//! Kinks in the way of steps whose size is chosen by their error alone.
//!
//! In: an attempted step. Out: whether it passes a kink that no shorter one would pass, or the motion follows the kink. Never
//! here: where a kink lies within a step.

use super::{DormandPrince, SHORTEST};
use crate::system::{MotionError, MotionErrorKind, State};

/// A kink may lie within a step that is this many times as long as the shortest one: it moves nothing but by rounding,
/// whatever jumps within it.
const OVER_A_KINK: f64 = 8.0;

/// The least part of the longest step between two kinks that are passed so. Where a motion sticks at a kink, it comes back
/// to it at once.
const BETWEEN_KINKS: f64 = 1e-6;

/// The greatest number of steps below this part of the longest one that cross a kink, with none longer between them. There
/// the motion follows the kink, and every step is as long as the tolerance allows an error of the jump.
const MOST_CROSSINGS: u32 = 64;
const ALONG_A_KINK: f64 = 1e-8;

impl DormandPrince {
    /// The size below which no step can continue the motion.
    pub(super) fn shortest(&self) -> f64 {
        (1e-16 * self.state.time.abs()).max(1e-290).max(SHORTEST * self.longest)
    }

    /// Whether the motion has just passed a kink by the shortest of steps.
    pub(super) fn is_beside_a_kink(&self) -> bool {
        let recent = |kink: f64| (self.state.time - kink).abs() < BETWEEN_KINKS * self.longest;
        self.kink.is_some_and(recent)
    }

    /// Whether the attempted step is as short as a step can be and a kink lies within it. No shorter one would have less
    /// of an error relative to a number that was zero before the kink. Before the first step no size is known to go on with.
    pub(super) fn passes_kink(&mut self, step: f64) -> Result<bool, MotionError> {
        let begins = self.longest == 0.0;
        if begins || step.abs() > OVER_A_KINK * self.shortest() || self.is_beside_a_kink() {
            return Ok(false);
        }
        self.crosses_kink(step)
    }

    /// Whether the ends of the attempted step lie on two sides of a kink.
    fn crosses_kink(&mut self, step: f64) -> Result<bool, MotionError> {
        let State { time, values, .. } = &self.state;
        self.rates.evaluate(*time, values, &mut self.fresh)?;
        let before = self.rates.sides();
        self.rates.evaluate(time + step, &self.next.values, &mut self.fresh)?;
        Ok(!self.rates.sides().agrees(&before))
    }

    /// Counts the short steps that cross a kink. Returns an error if there are too many without a longer one.
    pub(super) fn count_crossings(&mut self, step: f64) -> Result<(), MotionError> {
        if !self.system.has_kinks() || step.abs() > ALONG_A_KINK * self.longest {
            self.crossings = 0;
        } else if self.crosses_kink(step)? {
            self.crossings += 1;
        }
        if self.crossings <= MOST_CROSSINGS {
            return Ok(());
        }
        Err(self.system.fault(MotionErrorKind::Sticks, self.state.time, &self.state.values))
    }
}
