//! Steps in time of the momenta of L, at which velocities jump.
//!
//! In: the end of the last step, by a method that ends its steps there. Out: the motion continued with the velocities after it. Never
//! here: what these are (`system`).

use super::Propagator;
use crate::integrate::clock::spacing;
use crate::system::{Form, MotionError};

/// The motion goes on so many digits of the time after the instant, where every evaluation of the law is on its new side.
const DIGITS: f64 = 16.0;

impl Propagator {
    /// Notes that the last step may have ended where the momenta have a step in time.
    pub(super) fn note_step_in_time(&mut self) {
        let state = self.stepper.state();
        if self.system.keeps_momenta_at_steps()
            && self.method.locates_kinks
            && state.form == Form::Velocity
        {
            self.awaited_step = Some(state.exact_time());
        }
    }

    /// Gives the motion the velocities after a step in time, once all that happened before it is known.
    ///
    /// # Errors
    /// Returns an error if there are none.
    pub(super) fn cross_step_in_time(&mut self) -> Result<(), MotionError> {
        let Some(time) = self.awaited_step.take() else { return Ok(()) };
        let state = self.stepper.state();
        if state.exact_time() != time {
            return Ok(());
        }
        let (begin, end) = self.stepper.interval();
        let step = end - begin;
        let found = self.system.across_step_in_time(state, &self.parameters, step)?;
        let Some((before, after)) = found else { return Ok(()) };
        let moment = (DIGITS * spacing(end)).copysign(step);
        let later = self.system.a_moment_later(&after, &self.parameters, moment)?;
        if let Some(events) = &mut self.search.events {
            events.after_impulse(&before, &after, None)?;
        }
        self.stepper.replace_state(&later);
        self.search.clear = later.time;
        self.crossed = Some(after);
        Ok(())
    }
}
