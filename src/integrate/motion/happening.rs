//! What happens on the way of a motion: blows fall, events are passed, constraints are let go.
//!
//! In: a motion at the time of it. Out: the state after it, and a [`Happening`]. Never here: when it is due.

use super::Motion;
use crate::integrate::crossing::Found;
use crate::model::Action;
use crate::system::{Fault, FaultKind, State, System};

/// Something that happened.
#[derive(Clone, PartialEq, Debug)]
pub struct Happening {
    /// The event's or the impulse's name.
    pub name: String,
    /// When.
    pub time: f64,
    /// What it was.
    pub kind: Kind,
}

/// What happened.
#[derive(Clone, PartialEq, Debug)]
pub enum Kind {
    /// An event was passed.
    Mark,
    /// An event ended the motion.
    Stop,
    /// The constraint of this index was let go.
    Release(usize),
    /// A blow fell.
    Blow {
        /// Δp of each coordinate, or the jump of each variable.
        jump: Vec<f64>,
        /// Λ of each constraint.
        reaction: Vec<f64>,
    },
}

impl Motion {
    pub(super) fn fall(&mut self, impulse: usize) -> Result<Happening, Fault> {
        let time = self.calendar.fall(impulse, self.clear);
        self.look_exactly(time)?;
        self.strike(impulse, None)
    }

    /// The present is struck, as by the user's hand.
    ///
    /// # Errors
    /// Where no motion has the momenta the blow gives.
    pub fn strike_now(&mut self, impulse: usize) -> Result<Happening, Fault> {
        self.strike(impulse, None)
    }

    /// Strikes the present state.
    fn strike(&mut self, impulse: usize, event: Option<usize>) -> Result<Happening, Fault> {
        let mut before = self.own()?;
        let time = before.time;
        if let Some(keeper) = &mut self.keeper {
            keeper.project(&mut before)?;
        }
        let struck = self.system.strike_by(impulse, &before, &self.parameters)?;
        let kind = Kind::Blow { jump: struck.jump, reaction: struck.reaction };
        if let Some(crossings) = &mut self.crossings {
            crossings.struck(&before, &struck.after, event)?;
        }
        self.before.copy_from(&before);
        self.resume(&struck.after)?;
        let occasions = self.system.occasions();
        let name = match event {
            Some(event) => occasions.events[event].name.clone(),
            None => occasions.impulses[impulse].name.clone(),
        };
        Ok(Happening { name, time, kind })
    }

    /// An event is passed, and what it does is done.
    pub(super) fn meet(&mut self, found: Found) -> Result<Happening, Fault> {
        self.look_exactly(found.exact)?;
        self.note_haste(found)?;
        let trigger = self.system.occasions().events[found.event].clone();
        let kind = match trigger.action {
            Action::Mark => Kind::Mark,
            Action::Stop => {
                self.ended = true;
                Kind::Stop
            }
            Action::Release(constraint) => {
                self.before.copy_from(&self.state);
                let state = self.own()?;
                self.release(constraint, &state)?;
                Kind::Release(constraint)
            }
            Action::Impulse(impulse) => return self.strike(impulse, Some(found.event)),
        };
        Ok(Happening { name: trigger.name, time: found.exact.high, kind })
    }

    /// Lets a constraint go at the present, which is `state` in the system's own form.
    pub(super) fn release(&mut self, constraint: usize, state: &State) -> Result<(), Fault> {
        let system = self.system.release(constraint, state, &self.parameters);
        self.take_holding(system, state)
    }

    /// Goes on at a state with other constraints held.
    pub(super) fn take_holding(&mut self, system: System, state: &State) -> Result<(), Fault> {
        self.system = system;
        if let Ok(stepper) = (self.method.make)(&self.system, &self.settings) {
            self.stepper = stepper;
        }
        let known = self.crossings.take();
        self.take_system();
        if let (Some(crossings), Some(known)) = (&mut self.crossings, known) {
            crossings.inherit(known, state)?;
        }
        self.resume(state)
    }

    /// An event that comes again and again without end stops the motion with a reason.
    fn note_haste(&mut self, found: Found) -> Result<(), Fault> {
        let time = found.exact.high;
        if !self.haste[found.event].comes(time, self.start) {
            return Ok(());
        }
        let name = self.system.occasions().events[found.event].name.clone();
        Err(self.system.fault(FaultKind::PilesUp(name), time, &self.state.values))
    }
}
