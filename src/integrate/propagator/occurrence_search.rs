//! The search for what happens along a motion: how far its last step is known, and what is due at the end of that.
//!
//! In: the steps of a motion. Out: the next event or impulse, and its time. Never here: what it does.

use crate::integrate::Stepper;
use crate::integrate::event_location::EventLocator;
use crate::integrate::impulse_schedule::ImpulseSchedule;
use crate::integrate::located_event::LocatedEvent;
use crate::integrate::zeno::AccumulationDetector;
use crate::system::{MotionError, State, System};

/// The events and impulses of one motion, and how far they are known.
#[derive(Default)]
pub(super) struct OccurrenceSearch {
    pub(super) events: Option<EventLocator>,
    pub(super) impulses: ImpulseSchedule,
    start: f64,
    /// The time up to which the last step contains no unknown event.
    pub(super) clear: f64,
    pub(super) waiting: Option<LocatedEvent>,
    /// Whether events may happen at the time of the last impulse that are known only after the next step.
    pub(super) unsettled: bool,
    accumulation: Vec<AccumulationDetector>,
}

impl OccurrenceSearch {
    /// Begins a motion without earlier events.
    pub(super) fn begin(&mut self, start: f64, events: usize) {
        self.start = start;
        self.impulses.begin(start);
        self.accumulation = vec![AccumulationDetector::NONE; events];
    }

    /// Restores a motion that began at `start`, and whose occurrences up to a time are in the past.
    pub(super) fn restore(&mut self, start: f64, now: f64) {
        self.start = start;
        self.impulses.begin(start);
        self.impulses.pass(now);
    }

    /// Takes the events and impulses of a system.
    pub(super) fn take_system(&mut self, system: &System, parameters: &[f64]) {
        let blank = State::new(0.0, system.form(), Vec::new());
        let functions = system.event_functions(parameters);
        let events = &system.discontinuities().events;
        self.events = functions.map(|functions| EventLocator::new(functions, events, blank));
        self.impulses.reschedule(system.schedule(parameters));
    }

    pub(super) fn set_parameters(&mut self, system: &System, parameters: &[f64]) {
        self.impulses.reschedule(system.schedule(parameters));
        if let Some(events) = &mut self.events {
            events.set_parameters(parameters);
            events.forget();
        }
    }

    /// Continues from a time up to which all has happened.
    pub(super) fn continue_from(&mut self, time: f64) {
        self.clear = time;
        self.waiting = None;
        self.unsettled = false;
        if let Some(events) = &mut self.events {
            events.turn();
        }
    }

    /// Whether the system has neither events nor impulses.
    pub(super) fn is_empty(&self) -> bool {
        self.events.is_none() && self.impulses.is_empty()
    }

    /// The impulse that is due at the end of what is known.
    pub(super) fn due(&self) -> Option<usize> {
        self.impulses.due(self.clear)
    }

    /// Takes the next event that is known to be at the end of what is known, if none waits there.
    pub(super) fn find_next(&mut self) {
        if self.waiting.is_none()
            && let Some(events) = &mut self.events
        {
            self.waiting = events.next_at(self.clear);
        }
    }

    /// A time, or that of the next impulse if it is before.
    pub(super) fn limit(&self, time: f64) -> f64 {
        self.impulses.next(self.clear).map_or(time, |impulse| impulse.min(time))
    }

    /// Searches for events in what was computed beyond `clear`, up to the next impulse, as far as
    /// the functions can be followed at once.
    pub(super) fn scan(&mut self, stepper: &mut dyn Stepper) -> Result<(), MotionError> {
        self.unsettled = false;
        let mut end = self.limit(stepper.time());
        if let Some(events) = &mut self.events {
            (self.waiting, end) = events.scan(stepper, self.clear, end)?;
        }
        self.clear = self.waiting.map_or(end, |found| found.exact.high);
        Ok(())
    }

    /// Records an event, and returns whether it recurs at ever shorter intervals, without end.
    pub(super) fn accumulates(&mut self, found: LocatedEvent) -> bool {
        self.accumulation[found.event].record(found.exact.high, self.start)
    }

    pub(super) fn value(&mut self, event: usize, state: &State) -> Option<f64> {
        self.events.as_mut()?.value(event, state)
    }
}
