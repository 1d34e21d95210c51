//! The watch for an approach to an essential singularity, which ends the motion.
//!
//! In: the last step. Out: an error where no number of steps arrives. Never here: how an approach is known.

use super::approach::{Approach, nearest_zero};
use super::{StepCourse, Taylor};
use crate::num;
use crate::system::{MotionError, MotionErrorKind};

/// The digits of the instant that are said.
const SHOWN: usize = 9;

impl Taylor {
    /// Looks at the last step, which may be one of an approach that never comes to a limit.
    ///
    /// # Errors
    /// Returns an error if that is known.
    pub(super) fn watch_approach(&mut self, limit: f64) -> Result<(), MotionError> {
        if self.history.is_long() || !matches!(self.course, StepCourse::Series) {
            self.approach = None;
            return Ok(());
        }
        let (begin, scale) = (self.series.time().high, self.series.scale());
        let after = nearest_zero(self.series.divisors()) * scale;
        let size = self.state.time - begin;
        self.approach = Approach::after(self.approach, (begin + after, after.abs()), size.abs());
        let known = self.approach.and_then(|approach| approach.unreachable(after.abs()));
        match known.filter(|instant| (limit - instant) * scale >= 0.0) {
            Some(instant) => {
                let kind = MotionErrorKind::Unreachable(num::rounded(instant, SHOWN), size.abs());
                Err(self.system.error(kind, self.state.time, &self.state.values))
            }
            None => Ok(()),
        }
    }
}
