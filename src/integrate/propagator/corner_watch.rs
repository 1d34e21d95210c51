//! Corners of the constraints that a motion comes to.
//!
//! In: the last step, before its end is projected onto the constraints. Out: an error where the motion meets a corner that it does
//! not pass without an impulse: projected, it would go on with velocities that no law gives it. Never here: what a corner is.

use super::Propagator;
use crate::integrate::clock::spacing;
use crate::num::{ALL_HALVINGS, bisect};
use crate::system::{Form, MotionError, MotionErrorKind};

/// The part of a step on each side of a kink at which the constraints are compared.
const BESIDE: f64 = 1e-12;

/// That part is at least so many digits of the time.
const DIGITS: f64 = 4.0;

impl Propagator {
    /// Looks for a corner in the last step. One at its end is an error of the next step, unless something else acts there.
    ///
    /// # Errors
    /// Returns an error if the step leads over one.
    pub(super) fn watch_corners(&mut self) -> Result<(), MotionError> {
        let Some(projector) = &mut self.projector else { return Ok(()) };
        if self.stepper.state().form != Form::Velocity || !projector.may_have_corners() {
            return Ok(());
        }
        let state = self.stepper.state().clone();
        let (begin, end) = self.stepper.interval();
        if begin == end {
            return Ok(());
        }
        let beside = |time: f64| {
            (BESIDE * (end - begin).abs()).max(DIGITS * spacing(time)).copysign(end - begin)
        };
        let error = |name: String, time: f64, state: &crate::system::State| {
            self.system.error(MotionErrorKind::ConstraintCorner(name), time, &state.values)
        };
        let after = beside(end);
        if let Some(name) = projector.corner(&state, [-after, after]) {
            self.watch.corner = Some(error(name, end, &state));
            return Ok(());
        }
        self.stepper.at(begin, &mut self.before)?;
        let sides = projector.sides(&self.before, beside(begin));
        if projector.sides(&state, -after) == sides {
            return Ok(());
        }
        let [low, high] = bisect([begin, end], ALL_HALVINGS, |middle| {
            self.stepper.at(middle, &mut self.before)?;
            Ok::<_, MotionError>(projector.sides(&self.before, 0.0) == sides)
        })?;
        self.stepper.at(low, &mut self.before)?;
        let after = beside(low);
        match projector.corner(&self.before, [-after, high - low + after]) {
            Some(name) => Err(error(name, high, &self.before)),
            None => Ok(()),
        }
    }
}
