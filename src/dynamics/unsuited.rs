//! Systems whose motions have no derivatives with respect to their starts, or for which none are computed.
//!
//! In: a compiled system. Out: an error that says what stands against it. Never here: what a phase space is made of.

use super::error::DynamicsError;
use crate::model::EventAction;
use crate::system::{Form, System};

/// Refuses what has no derivative at some places, where nothing here would notice.
pub(super) fn refuse(system: &System) -> Result<(), DynamicsError> {
    let unsuited = |why: &str| Err(DynamicsError::Unsuited(why.to_owned()));
    if system.has_kinks_of_states() {
        return unsuited(
            "the forces have kinks or jumps (abs, sign, min, max, or a cut of atan2), across which \
             derivatives of the motion are not computed",
        );
    }
    refuse_steps_in_time(system)?;
    if !system.has_tangents_in(Form::Momentum) && system.form() == Form::Velocity {
        return unsuited(
            "its velocities follow from its momenta by iteration only, and derivatives of such \
             motions are not computed",
        );
    }
    Ok(())
}

fn refuse_steps_in_time(system: &System) -> Result<(), DynamicsError> {
    if !system.discontinuities().momenta_jump {
        return Ok(());
    }
    let why = "L has a step in time in its momenta, where velocities jump, and derivatives of such motions are not computed: write H";
    Err(DynamicsError::Unsuited(why.to_owned()))
}

pub(super) fn refuse_constraints(system: &System) -> Result<(), DynamicsError> {
    if system.constraints() == 0 {
        return Ok(());
    }
    let why = "the motion is subject to constraints, and this asks for independent coordinates";
    Err(DynamicsError::Unsuited(why.to_owned()))
}

/// Refuses impulses that act on the motion, and events that do.
pub(super) fn refuse_acts(system: &System) -> Result<(), DynamicsError> {
    refuse_acts_but(system, |_| false)
}

/// The same, but for some actions of events.
pub(super) fn refuse_acts_but(
    system: &System,
    allowed: fn(EventAction) -> bool,
) -> Result<(), DynamicsError> {
    let unsuited = |why: &str| Err(DynamicsError::Unsuited(why.to_owned()));
    if acts_by_the_clock(system) {
        return unsuited(
            "impulses act on the way, across which derivatives of the motion are not computed",
        );
    }
    refuse_steps_in_time(system)?;
    let passive =
        |action: EventAction| matches!(action, EventAction::Mark | EventAction::Section(_));
    let mut events = system.discontinuities().events.iter();
    let may_be = |action: EventAction| passive(action) || allowed(action);
    // a step of the law in time that no momentum has changes no state
    if !events.all(|event| event.action.written().is_none_or(may_be)) {
        return unsuited("events act on the motion, across which its derivatives are not computed");
    }
    Ok(())
}

/// Whether impulses act at given times.
pub(super) fn acts_by_the_clock(system: &System) -> bool {
    system.discontinuities().impulses.iter().any(|impulse| impulse.scheduled)
}
