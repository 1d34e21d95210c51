//! A step whose size is chosen by its error.
//!
//! In: the state, a limit. Out: the state at the end of the step. Never here: what follows a kink.

use super::{DormandPrince, FORGETTING, LONGER, METHOD_STAGES, SAFETY, SHORTER, TRIES};
use crate::num::{DoubleDouble, math};
use crate::system::{MotionError, MotionErrorKind};

impl DormandPrince {
    /// Takes a step as long as its error allows, no farther than a limit.
    pub(super) fn controlled_step(&mut self, limit: f64) -> Result<(), MotionError> {
        let time = self.state.exact_time();
        let left = DoubleDouble::from_decimal(limit) - time;
        if self.stale {
            self.rates.evaluate(time.high, &self.state.values, &mut self.slopes[0])?;
            self.stale = false;
        }
        for (remembered, noise) in self.remembered_noise.iter_mut().zip(&self.noise) {
            *remembered = FORGETTING * noise;
        }
        let mut rejected = 0;
        loop {
            self.noise.copy_from_slice(&self.remembered_noise);
            // take a last step that is a little longer rather than another tiny one
            let last = 1.01 * self.size >= left.high.abs();
            let step = if last { left.high } else { self.size.copysign(left.high) };
            self.may_try(step, last)?;
            if let Err(error) = self.attempt(step) {
                // a stage of a step too long may lie where there are no rates
                if rejected == TRIES || error.kind == MotionErrorKind::Cancelled {
                    return Err(error);
                }
                self.size = step.abs() * SHORTER;
                rejected += 1;
                continue;
            }
            self.measure(step);
            let mut error = self.error(step);
            if error > 1.0 && error.is_finite() {
                self.estimate_roundoff(step);
                error = self.error(step);
            }
            let passes_kink = error > 1.0 && self.passes_kink(step)?;
            if passes_kink {
                error = 1.0;
            }
            let part = if error <= 1.0 { self.resolved_part(step) } else { 1.0 };
            if part < 1.0 {
                self.size = step.abs() * part;
                rejected += 1;
                continue;
            }
            let most = if rejected > 0 { 1.0 } else { LONGER };
            let factor = (SAFETY * math::powf(error, -1.0 / 8.0)).clamp(SHORTER, most);
            if error <= 1.0 {
                self.count_crossings(step)?;
                let end =
                    if last { DoubleDouble::from(limit) } else { time + DoubleDouble::from(step) };
                (self.next.time, self.next.time_carry) = (end.high, end.low);
                let slope = &mut self.slopes[METHOD_STAGES];
                self.rates.evaluate(end.high, &self.next.values, slope)?;
                self.longest = self.longest.max(step.abs());
                // a step cut short is no measure of the next one
                self.size =
                    if last { self.size.max(step.abs() * factor) } else { self.size * factor };
                if passes_kink {
                    // the clock has too few digits for steps that grow slowly from there
                    self.size = self.size.max(self.longest);
                }
                break;
            }
            self.size = step.abs() * factor;
            rejected += 1;
        }
        std::mem::swap(&mut self.before, &mut self.state);
        std::mem::swap(&mut self.state, &mut self.next);
        std::mem::swap(&mut self.slopes, &mut self.last);
        self.slopes[0].clone_from(&self.last[METHOD_STAGES]);
        self.has_interpolant = false;
        Ok(())
    }
}
