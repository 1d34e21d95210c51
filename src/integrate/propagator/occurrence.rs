//! What happens along a motion: impulses are applied, events occur, constraints are released.
//!
//! In: a motion at the time of an occurrence. Out: the state after it, and an [`Occurrence`]. Never
//! here: when it is due.

use super::Propagator;
use crate::integrate::located_event::LocatedEvent;
use crate::model::EventAction;
use crate::system::{CompiledAction, MotionError, MotionErrorKind, State, System};

/// An occurrence along a motion.
#[derive(Clone, PartialEq, Debug)]
pub struct Occurrence {
    /// The name of the event or the impulse.
    pub name: String,
    /// The index of the event in the compiled system; `None` for an impulse that no event causes.
    pub event: Option<usize>,
    /// The time of the occurrence.
    pub time: f64,
    /// The kind of occurrence.
    pub kind: OccurrenceKind,
}

/// The kind of an occurrence, with its data.
#[derive(Clone, PartialEq, Debug)]
pub enum OccurrenceKind {
    /// An event without effect on the motion.
    Mark,
    /// The surface of section of this index was crossed.
    Crossing(usize),
    /// An event ended the motion.
    Stop,
    /// An event released the constraint of this index.
    Release(usize),
    /// The velocities have jumped with the law, at unchanged momenta.
    StepInTime,
    /// An impulse was applied.
    Impulse {
        /// Δp of each coordinate, or the jump of each variable.
        jump: Vec<f64>,
        /// Λ of each constraint.
        reaction: Vec<f64>,
    },
}

impl Propagator {
    pub(super) fn apply_scheduled(&mut self, impulse: usize) -> Result<Occurrence, MotionError> {
        let time = self.search.impulses.apply_scheduled(impulse, self.search.clear);
        self.move_to_exactly(time)?;
        self.impulse_at(impulse, None)
    }

    /// Applies an impulse to the current state, as requested by the user.
    ///
    /// # Errors
    /// Returns an error if no motion has the momenta after the impulse.
    pub fn apply_impulse_now(&mut self, impulse: usize) -> Result<Occurrence, MotionError> {
        self.impulse_at(impulse, None)
    }

    /// Applies an impulse to the current state.
    fn impulse_at(
        &mut self,
        impulse: usize,
        event: Option<usize>,
    ) -> Result<Occurrence, MotionError> {
        let mut before = self.native_state()?;
        let time = before.time;
        if let Some(projector) = &mut self.projector {
            projector.project(&mut before)?;
        }
        let after_impulse = self.system.apply_impulse(impulse, &before, &self.parameters)?;
        let kind =
            OccurrenceKind::Impulse { jump: after_impulse.jump, reaction: after_impulse.reaction };
        if let Some(events) = &mut self.search.events {
            events.after_impulse(&before, &after_impulse.after, event)?;
        }
        if let Some(event) = event {
            self.note_impulse(event, &before, &after_impulse.after);
        }
        self.before.copy_from(&before);
        self.impulse = Some((impulse, event));
        self.resume(&after_impulse.after)?;
        self.search.unsettled = self.search.events.is_some();
        let discontinuities = self.system.discontinuities();
        let name = match event {
            Some(event) => discontinuities.events[event].name.clone(),
            None => discontinuities.impulses[impulse].name.clone(),
        };
        Ok(Occurrence { name, event, time, kind })
    }

    /// Carries out the action of an event; `None` if it is a step in time that turns out to be none.
    pub(super) fn on_event(
        &mut self,
        found: LocatedEvent,
    ) -> Result<Option<Occurrence>, MotionError> {
        self.move_to_exactly(found.exact)?;
        self.check_accumulation(found)?;
        let event = self.system.discontinuities().events[found.event].clone();
        let Some(action) = event.action.written() else {
            let is_one = self.cross_step_in_time(found)?;
            let kind = OccurrenceKind::StepInTime;
            let (name, event, time) = (event.name, Some(found.event), found.exact.high);
            return Ok(is_one.then_some(Occurrence { name, event, time, kind }));
        };
        let kind = match action {
            EventAction::Mark => OccurrenceKind::Mark,
            EventAction::Section(section) => OccurrenceKind::Crossing(section),
            EventAction::Stop => {
                self.ended = true;
                OccurrenceKind::Stop
            }
            EventAction::Release(constraint) => {
                self.before.copy_from(&self.state);
                let state = self.native_state()?;
                self.release(constraint, &state)?;
                OccurrenceKind::Release(constraint)
            }
            EventAction::Impulse(impulse) => {
                return self.impulse_at(impulse, Some(found.event)).map(Some);
            }
        };
        let (name, event, time) = (event.name, Some(found.event), found.exact.high);
        Ok(Some(Occurrence { name, event, time, kind }))
    }

    /// Releases a constraint at the current state, which is `state` in the system's native form.
    pub(super) fn release(&mut self, constraint: usize, state: &State) -> Result<(), MotionError> {
        let system = self.system.release(constraint, state, &self.parameters);
        self.take_active_set(system, state)
    }

    /// Continues at a state with another set of enforced constraints.
    pub(super) fn take_active_set(
        &mut self,
        system: System,
        state: &State,
    ) -> Result<(), MotionError> {
        self.system = system;
        if let Ok(stepper) = (self.method.make)(&self.system, &self.settings) {
            self.stepper = stepper;
        }
        let known = self.search.events.take();
        self.take_system();
        if let (Some(events), Some(known)) = (&mut self.search.events, known) {
            events.inherit(known, state)?;
        }
        self.resume(state)
    }

    /// Returns an error if an event recurs at ever shorter intervals, without end.
    fn check_accumulation(&mut self, found: LocatedEvent) -> Result<(), MotionError> {
        let time = found.exact.high;
        // a picture does not end a motion
        let action = self.system.discontinuities().events[found.event].action;
        if matches!(action, CompiledAction::Written(EventAction::Section(_))) {
            return Ok(());
        }
        if !self.search.accumulates(found) {
            return Ok(());
        }
        let name = self.system.discontinuities().events[found.event].name.clone();
        Err(self.system.error(MotionErrorKind::EventsAccumulate(name), time, &self.state.values))
    }
}
