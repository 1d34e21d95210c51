//! The way of a motion to a time: steps, and the search for events in them.
//!
//! In: a motion that has begun, a time, a number of steps. Out: the current state there, or at an occurrence before.
//! Never here: what an occurrence does.

use super::{Propagator, Reached};
use crate::integrate::{StepBlock, Stepping, clock};
use crate::num::DoubleDouble;
use crate::system::{Form, MotionError, MotionErrorKind};

/// A step on a kink may only choose a side, or find that the motion sticks; so many of them in a
/// row make no progress.
const MOST_STALLED: u32 = 128;

impl Propagator {
    /// Advances the current state to `time`, in at most `budget` steps (which are subtracted from
    /// it), or to an occurrence before. No step goes beyond `limit`, unless the method's step is
    /// fixed. Occurrences at `time` itself are included.
    ///
    /// # Errors
    /// Returns an error if the motion cannot continue.
    pub fn reach(
        &mut self,
        time: f64,
        limit: f64,
        budget: &mut u64,
    ) -> Result<Reached, MotionError> {
        self.reach_unexplained(time, limit, budget).map_err(|error| self.explained(error))
    }

    /// Advances as [`Propagator::reach`] does, without searching for the cause of an error, which takes longer than most
    /// motions and which nobody reads for one of many orbits.
    ///
    /// # Errors
    /// Returns an error if the motion cannot continue.
    pub fn reach_unexplained(
        &mut self,
        time: f64,
        limit: f64,
        budget: &mut u64,
    ) -> Result<Reached, MotionError> {
        loop {
            if self.ended {
                return Ok(Reached::Ended);
            }
            if !self.is_free && self.search.clear <= time {
                let due = self.search.due();
                self.search.find_next();
                if self.search.waiting.is_some() || due.is_some() {
                    // there may be infinitely many occurrences
                    if *budget == 0 {
                        return Ok(Reached::OutOfBudget);
                    }
                    *budget -= 1;
                    self.note_passages(self.search.clear);
                }
                if let Some(found) = self.search.waiting.take() {
                    match self.on_event(found)? {
                        Some(occurrence) => return Ok(Reached::Occurred(occurrence)),
                        None => continue,
                    }
                }
                if let Some(impulse) = due {
                    return self.apply_scheduled(impulse).map(Reached::Occurred);
                }
            }
            if self.search.clear >= time
                && self.search.unsettled
                && self.search.clear < limit
                && *budget > 0
            {
                *budget -= 1;
                self.step_past_impulse(limit)?;
                continue;
            }
            if self.search.clear >= time {
                if let Some(found) = self.hidden_step_in_time(time)?
                    && let Some(occurrence) = self.on_event(found)?
                {
                    return Ok(Reached::Occurred(occurrence));
                }
                let before = self.state.time;
                self.move_to(time)?;
                if !self.energy_has_a_value(false) {
                    return Err(self.left_domain(before));
                }
                self.note_passages(time);
                return Ok(Reached::Arrived);
            }
            if *budget == 0 {
                return Ok(Reached::OutOfBudget);
            }
            let outcome = if self.stepper.time() > self.search.clear {
                *budget -= 1;
                Ok(())
            } else if self.is_undisturbed() {
                self.several_steps(time, limit, budget)
            } else {
                *budget -= 1;
                self.step(limit)
            };
            if let Err(error) = outcome {
                self.note_passages(self.search.clear);
                return Err(error);
            }
            self.search.scan(self.stepper.as_mut())?;
            if !self.is_free {
                self.end_before_step_in_time()?;
            }
        }
    }

    /// Takes the next step after an impulse, which shows what else happens at its time: the state there is that after all of it.
    /// A step that cannot be taken shows nothing, and is an error once the motion is to be continued.
    fn step_past_impulse(&mut self, limit: f64) -> Result<(), MotionError> {
        self.search.unsettled = false;
        if self.stepper.time() <= self.search.clear && self.step(limit).is_err() {
            return Ok(());
        }
        self.search.scan(self.stepper.as_mut())
    }

    /// Whether nothing can happen between two steps.
    fn is_undisturbed(&self) -> bool {
        self.method.stepping == Stepping::Fixed && self.is_free
    }

    /// Takes the steps to a time, between which nothing is observed.
    fn several_steps(
        &mut self,
        time: f64,
        limit: f64,
        budget: &mut u64,
    ) -> Result<(), MotionError> {
        let most = *budget;
        let outcome = self.stepper.steps(time, limit, budget);
        // a step that failed was not taken
        self.steps += most - *budget - u64::from(outcome.is_err());
        self.search.clear = self.stepper.time();
        outcome
    }

    /// Takes at most `most` steps between which nothing can happen, until `time` is reached or passed,
    /// and writes the end of each into `block`. Returns their number, which is zero if the next step
    /// must be taken by itself.
    pub fn steps_seen(&mut self, time: f64, most: u64, block: &mut StepBlock) -> u64 {
        if self.ended || self.stepper.time() > self.search.clear || !self.is_undisturbed() {
            return 0;
        }
        let taken = self.stepper.steps_seen(time, most, block);
        if taken > 0 {
            self.steps += taken;
            self.search.clear = self.stepper.time();
        }
        taken
    }

    /// Takes a step of a motion in which nothing happens.
    fn step_alone(&mut self, limit: f64) -> Result<(), MotionError> {
        let before = self.stepper.state().exact_time();
        self.stepper.step(limit).map_err(|error| {
            if error.time.is_finite() { error } else { time_out_of_range(before.high) }
        })?;
        if !self.stepper.time().is_finite() {
            return Err(time_out_of_range(before.high));
        }
        let moved = (self.stepper.state().exact_time() - before).high > 0.0;
        self.stalled = if moved { 0 } else { self.stalled + 1 };
        if self.stalled > MOST_STALLED {
            return Err(no_digits_left(before.high));
        }
        self.steps += 1;
        Ok(())
    }

    fn step(&mut self, limit: f64) -> Result<(), MotionError> {
        if self.is_free {
            self.note_regular();
            return self.step_alone(limit);
        }
        let limit = self.search.limit(limit);
        let before = self.stepper.state().exact_time();
        if self.search.impulses.stands_still(before.high) {
            return Err(no_digits_left(before.high));
        }
        // only a motion that is continued from the end of a step has been there: an event may lie before
        if !self.energy_has_a_value(true) {
            return Err(self.left_domain(self.state.time));
        }
        if let Some(corner) = &self.watch.corner {
            return Err(corner.clone());
        }
        self.note_regular();
        self.choose_enforced()?;
        self.step_alone(limit)?;
        self.note_side();
        self.note_narrow_place()?;
        self.note_departures();
        self.check_branch()?;
        self.watch_corners()?;
        if self.watch.corner.is_some() {
            // the velocities are those on arrival
            return Ok(());
        }
        if self.projector.is_some() || self.system.attitude_place().is_some() {
            self.before.copy_from(self.stepper.state());
            if let Some(projector) = &mut self.projector {
                projector.project(&mut self.before)?;
            }
            self.system.orthonormalise(&mut self.before);
            self.stepper.replace_state(&self.before);
            self.check_course()?;
            self.watch_step();
            self.watch_comparison();
        }
        Ok(())
    }

    /// Sets the current state to that at a time within the last step.
    pub(super) fn move_to(&mut self, time: f64) -> Result<(), MotionError> {
        let (begin, end) = self.stepper.interval();
        if time == end || begin == end {
            self.state.copy_from(self.stepper.state());
        } else {
            self.stepper.at(time, &mut self.state)?;
            self.project_state()?;
        }
        if let Some(crossed) = self.crossed.filter(|crossed| crossed.high == time) {
            self.state.set_time(crossed);
        }
        // a step in time that rounding has located a little later
        self.date_beside_step_in_time()
    }

    /// Sets the current state to that at the time of an occurrence, known beyond the last digit of
    /// an `f64`.
    pub(super) fn move_to_exactly(&mut self, time: DoubleDouble) -> Result<(), MotionError> {
        let (begin, end) = self.stepper.interval();
        if begin == end {
            self.state.copy_from(self.stepper.state());
        } else {
            self.stepper.at_exactly(time, &mut self.state)?;
            self.project_state()?;
        }
        self.date_beside_step_in_time()
    }

    fn project_state(&mut self) -> Result<(), MotionError> {
        match (&mut self.projector, self.state.form) {
            (Some(projector), Form::Velocity) => projector.project(&mut self.state),
            _ => Ok(()),
        }
    }

    /// Returns an error if a step has led to velocities on another branch, across a fold of p =
    /// ∂L/∂q̇.
    fn check_branch(&mut self) -> Result<(), MotionError> {
        if self.domain.is_on_branch(self.stepper.state()) {
            return Ok(());
        }
        let (begin, _) = self.stepper.interval();
        let state = self.stepper.state();
        Err(self.system.error(MotionErrorKind::BranchLeft, begin, &state.values))
    }

    /// Whether the logarithms of the energy have values in the current state, or at the end of the last step.
    fn energy_has_a_value(&mut self, at_end: bool) -> bool {
        self.domain.has_energy(if at_end { self.stepper.state() } else { &self.state })
    }

    /// The error for a step that has led to where they have none; what lies before the step, and what was reached, stays.
    fn left_domain(&mut self, reached: f64) -> MotionError {
        let (begin, _) = self.stepper.interval();
        self.search.clear = begin.max(reached);
        let state = self.stepper.state();
        self.system.error(MotionErrorKind::LogarithmLeft, begin, &state.values)
    }

    /// Enforces those of redundant constraints that are most independent.
    fn choose_enforced(&mut self) -> Result<(), MotionError> {
        let state = self.stepper.state();
        let Some(system) = self.system.enforce_more_independent(state, &self.parameters) else {
            return Ok(());
        };
        let state = state.clone();
        self.active_set_changes += 1;
        self.take_active_set(system, &state)
    }
}

/// The error for a time without enough digits for what follows.
fn no_digits_left(time: f64) -> MotionError {
    let kind = MotionErrorKind::ClockStands(clock::spacing(time));
    MotionError { time, kind, place: Vec::new() }
}

/// A step of a motion that nothing bounds, as one at rest, leads beyond the range of times.
fn time_out_of_range(time: f64) -> MotionError {
    MotionError { time, kind: MotionErrorKind::OutOfRange(None), place: Vec::new() }
}
