//! Steps in time of the momenta of L, at which velocities jump.
//!
//! In: the instant of a step, located as an event of the time alone. Out: the motion continued with the velocities after it. Never
//! here: what these are (`system`).
//!
//! At the same instant events that only see the motion come before it, and scheduled impulses after it: what these give is a change of
//! the momenta, which the step does not change, and velocities in their formulas are those after it.

use super::Propagator;
use crate::integrate::located_event::LocatedEvent;
use crate::num::DoubleDouble;
use crate::system::{CompiledAction, MotionError};

/// So little of the time before a step that no motion takes place in it, as a part of the time.
const AT_ONCE: f64 = 1e-25;

impl Propagator {
    /// Gives the motion, which has come to the instant of a step, the velocities after it. Returns whether there is one.
    ///
    /// # Errors
    /// Returns an error if there are none.
    pub(super) fn cross_step_in_time(&mut self, found: LocatedEvent) -> Result<bool, MotionError> {
        let step = self.stepper.step_size();
        let crossed = self.system.across_step_in_time(&self.state, &self.parameters, step)?;
        let Some((before, after)) = crossed else { return Ok(false) };
        // found again from behind it
        if self.crossed.is_some_and(|crossed| (before.exact_time() - crossed).high <= 0.0) {
            return Ok(false);
        }
        if let Some(events) = &mut self.search.events {
            events.after_impulse(&before, &after, Some(found.event))?;
        }
        self.before.copy_from(&before);
        self.resume(&after)?;
        self.crossed = Some(after.exact_time());
        Ok(true)
    }

    /// Dates the end of the last step just before a step in time that it has come to, since the velocities are those before.
    pub(super) fn end_before_step_in_time(&mut self) -> Result<(), MotionError> {
        let Some(waiting) = self.search.waiting.filter(|_| self.ends_before_step_in_time()) else {
            return Ok(());
        };
        let step = self.stepper.step_size();
        let Some(steps) = &mut self.steps_in_time else { return Ok(()) };
        if let Some([before, _]) = steps.beside(waiting.exact, step)? {
            let mut end = self.stepper.state().clone();
            end.set_time(before);
            self.stepper.replace_state(&end);
        }
        Ok(())
    }

    /// Dates the current state, if its time is that of a step in time, on that side of it where the motion is.
    pub(super) fn date_beside_step_in_time(&mut self) -> Result<(), MotionError> {
        let time = self.state.exact_time();
        let Some((before, _)) = self.step_in_time_at(time)? else { return Ok(()) };
        self.state.set_time(self.crossed_at(time.high).unwrap_or(before));
        Ok(())
    }

    /// The step in time at this time of the last step, if rounding has hidden it from the search and the motion has not
    /// crossed it.
    pub(super) fn hidden_step_in_time(
        &mut self,
        time: f64,
    ) -> Result<Option<LocatedEvent>, MotionError> {
        if self.crossed_at(time).is_some() {
            return Ok(None);
        }
        let exact = DoubleDouble::from(time);
        Ok(self.step_in_time_at(exact)?.map(|(_, event)| LocatedEvent { event, exact }))
    }

    /// The time after the step in time that was crossed at a time.
    fn crossed_at(&self, time: f64) -> Option<DoubleDouble> {
        self.crossed.filter(|crossed| crossed.high == time)
    }

    /// The time just before the step in time that no number tells from a time, and its event.
    fn step_in_time_at(
        &mut self,
        time: DoubleDouble,
    ) -> Result<Option<(DoubleDouble, usize)>, MotionError> {
        let Some(steps) = &mut self.steps_in_time else { return Ok(None) };
        let Some(beside) = steps.beside(time, self.stepper.step_size())? else { return Ok(None) };
        if !(beside[0].high..=beside[1].high).contains(&time.high) {
            return Ok(None);
        }
        let events = &self.system.discontinuities().events;
        let first = events.iter().position(|event| event.action == CompiledAction::StepInTime);
        let changed = steps.changed_between(beside)?;
        Ok(first.zip(changed).map(|(first, k)| (beside[0], first + k)))
    }

    /// Whether the last step ends at a step in time, on one side or the other.
    ///
    /// # Errors
    /// Returns an error if the functions that have a step there have no value.
    pub fn ends_at_step_in_time(&mut self) -> Result<bool, MotionError> {
        let end = self.stepper.state().exact_time();
        let Some(steps) = &mut self.steps_in_time else { return Ok(false) };
        Ok(steps.beside(end, 0.0)?.is_some())
    }

    /// Whether the last step ends at a step in time that is not crossed yet.
    fn ends_before_step_in_time(&self) -> bool {
        let events = &self.system.discontinuities().events;
        self.search.waiting.is_some_and(|waiting| {
            events[waiting.event].action == CompiledAction::StepInTime
                && waiting.exact.high == self.stepper.time()
        })
    }

    /// Dates a state at which the motion begins, exactly at a step, just after it. One that is dated just before it, as that of a motion
    /// that is reversed there, is given the velocities after it.
    pub(super) fn begin_after_step_in_time(&mut self) -> Result<(), MotionError> {
        let Some(steps) = &mut self.steps_in_time else { return Ok(()) };
        let time = steps.after(self.state.exact_time())?;
        self.state.set_time(time);
        let Some(beside) = steps.beside(time, 0.0)? else { return Ok(()) };
        if !steps.is_behind(time, beside)? {
            let left = (beside[1] - time).high;
            if left > AT_ONCE * time.high.abs() {
                return Ok(());
            }
            let crossed = self.system.across_step_in_time(&self.state, &self.parameters, 0.0)?;
            let Some((_, after)) = crossed else { return Ok(()) };
            self.state.copy_from(&after);
        }
        let time = self.state.exact_time();
        self.crossed = Some(time);
        if let Some(events) = &mut self.search.events {
            events.begin_at(time);
        }
        Ok(())
    }
}
