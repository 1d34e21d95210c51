//! Events whose functions are zero all along the motion but for rounding: they never happen, and that is said.
//!
//! In: the states at which a motion begins or is changed, and the ends of its steps. Out: such events. Never here: how they are found.

use super::Propagator;
use crate::integrate::event_location::EventLocator;
use crate::model::EventAction;
use crate::system::{CompiledAction, MotionError};

impl Propagator {
    /// The names of the events and sections whose functions are zero all along the current motion but for rounding, and since when.
    /// An event that has released its constraint is none of them: it cannot happen again, and a multiplier is zero from then on. Nor is
    /// a step in time of the law.
    pub fn vanishing_events(&self) -> impl Iterator<Item = (&str, f64)> {
        let events = &self.system.discontinuities().events;
        let is_over = |action: CompiledAction| match action {
            CompiledAction::Written(EventAction::Release(constraint)) => {
                self.system.is_released(constraint)
            }
            CompiledAction::Written(_) => false,
            // no event of the file
            CompiledAction::StepInTime => true,
        };
        let known = self.search.events.iter().flat_map(EventLocator::vanishing);
        let known = known.filter_map(|(event, since)| Some((events.get(event)?, since)));
        known
            .filter(move |(event, _)| !is_over(event.action))
            .map(|(event, since)| (event.name.as_str(), since))
    }

    /// Finds them from the current state on.
    pub(super) fn find_vanishing_events(&mut self) -> Result<(), MotionError> {
        if self.search.events.is_none() {
            return Ok(());
        }
        let state = self.native_state()?;
        if let Some(events) = &mut self.search.events {
            events.find_vanishing(&self.system, &state, &self.parameters);
        }
        Ok(())
    }

    /// Follows those that are zero no more at the end of a step.
    pub(super) fn note_departures(&mut self) {
        if let Some(events) = &mut self.search.events {
            events.note_departures(self.stepper.state(), self.stepper.tolerance());
        }
    }
}
