//! The expansion of a motion at its current state: a series in a unit of time near the step that it allows.
//!
//! In: the state, the time to go. Out: the series, and the longest step that its last terms allow. Never here: where a
//! step ends.

use super::{Taylor, step_size};
use crate::system::{MotionError, MotionErrorKind};

/// A step is well represented in a unit of time between these parts of it.
pub(super) const NEARBY_UNITS: (f64, f64) = (1e-4, 1e3);

impl Taylor {
    /// Points the series in the direction of `left`, the time to go in steps of about the unit of the series.
    pub(super) fn aim(&mut self, left: f64) {
        self.series.set_scale(self.history.unit.next(self.series.scale(), left));
        self.series.expect(left / self.series.scale());
    }

    /// Builds the series at the current state in a unit of time near the step it allows, and
    /// returns the size of that step, which may be longer than `left`.
    pub(super) fn expand(&mut self, left: f64) -> Result<f64, MotionError> {
        let (size, direction) = (left.abs(), left.signum());
        let mut units = UnitTrials::NONE;
        let mut known = Vec::new();
        loop {
            self.series.build(&self.state)?;
            let scale = self.series.scale().abs();
            let lost = known.iter().any(|&(i, k)| self.series.coefficient(i, k) == 0.0);
            let found = self.step_size.longest(&self.series);
            let Some(step) = found.map(|step| step * scale) else {
                // a coefficient is out of range, which a smaller unit may avoid
                if scale < 1e-280 || (scale <= 1.0 && !step_size::has_velocity(&self.series)) {
                    return Err(self.not_finite());
                }
                if known.is_empty() {
                    known = self.first_coefficients();
                }
                units.long = scale;
                self.series.set_scale(units.next(scale * 1e-6) * direction);
                if self.series.scale().abs() == scale {
                    // there is no smaller one
                    return Err(self.not_finite());
                }
                continue;
            };
            if lost {
                // where a root has no series it seems to have one once its argument underflows
                return Err(self.not_finite());
            }
            match units.judge(step, size, scale) {
                UnitTrial::Fits(step) => return Ok(step),
                UnitTrial::Try(unit) => self.series.set_scale(unit * direction),
            }
            if self.series.scale().abs() == scale {
                return Ok(step);
            }
        }
    }

    /// The variables that change, each with its first coefficient that is not zero.
    fn first_coefficients(&self) -> Vec<(usize, usize)> {
        let first = |i: usize| {
            let changes = self.series.coefficients(i).iter().skip(1);
            let k = 1 + changes.take_while(|&&c| c == 0.0).count();
            let c = self.series.coefficients(i).get(k)?;
            c.is_finite().then_some((i, k))
        };
        (0..self.series.inputs()).filter_map(first).collect()
    }

    fn not_finite(&self) -> MotionError {
        let names = self.system.channels();
        let n = self.system.degrees();
        let culprit =
            (0..self.system.moving()).find(|&i| !self.series.coefficient(i, 1).is_finite());
        let name = match culprit {
            Some(i) if i < n => format!("the velocity of {}", names[i].shown),
            Some(i) => format!("the force on {}", names[i - n].shown),
            None => "the motion".to_owned(),
        };
        self.system.error(MotionErrorKind::NotFinite(name), self.state.time, &self.state.values)
    }
}

/// The units of time tried for one series. Each trial narrows the interval between those found too
/// short and those found too long, so the search ends.
pub(super) struct UnitTrials {
    short: f64,
    long: f64,
    tried: u32,
}

pub(super) enum UnitTrial {
    /// The unit represents the step well, which is this long.
    Fits(f64),
    /// Another one is to be tried.
    Try(f64),
}

/// The number of units taken as the series suggests; after that the interval is bisected.
const ASKED_FOR: u32 = 12;

impl UnitTrials {
    /// Nothing is tried yet.
    pub(super) const NONE: UnitTrials = UnitTrials { short: 0.0, long: f64::INFINITY, tried: 0 };

    /// Judges a unit in which the series allows a step, with this much to go.
    #[inline]
    pub(super) fn judge(&mut self, step: f64, left: f64, unit: f64) -> UnitTrial {
        let wanted = step.min(left);
        if (unit * NEARBY_UNITS.0..=unit * NEARBY_UNITS.1).contains(&wanted) {
            return UnitTrial::Fits(step);
        }
        if wanted < unit {
            self.long = unit;
        } else {
            self.short = unit;
            if self.long <= 2.0 * unit {
                // goes no further than the bound found with the unit twice as long
                return UnitTrial::Fits(step.min(self.long));
            }
        }
        UnitTrial::Try(self.next(wanted.clamp(unit * 1e-12, unit * 1e12)))
    }

    /// The next unit to try after the one that the series suggests.
    fn next(&mut self, wanted: f64) -> f64 {
        self.tried += 1;
        let (least, most) = (2.0 * self.short, 0.5 * self.long);
        if self.short == 0.0 || self.long == f64::INFINITY {
            return wanted;
        }
        if most < least {
            return self.short;
        }
        if self.tried < ASKED_FOR && (least..=most).contains(&wanted) {
            return wanted;
        }
        // bisects the interval of exponents
        (self.short.sqrt() * self.long.sqrt()).clamp(least, most)
    }
}
