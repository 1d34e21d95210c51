//! The periodic orbit near a motion, closed for a picture of it or of its family.
//!
//! In: a system, a start, a method. Out: a [`ClosedOrbit`]. Never here: pictures, or how Newton's method works
//! ([`nearest_orbit`]).

use super::Physics;
use super::conditions::PlotConditions;
use crate::dynamics::{
    DynamicsError, Fixed, Orbit, PhaseSpace, nearest_driven_orbit, nearest_orbit,
};
use crate::ensemble::Start;
use crate::integrate::{Method, Settings};
use crate::system::State;

pub(super) struct ClosedOrbit {
    pub(super) space: PhaseSpace,
    pub(super) orbit: Orbit,
    /// What was to be the same for it as for the start.
    pub(super) fixed: Fixed,
}

/// The space of an orbit, and the state that it is searched near. Impulses that come at their times count from the initial
/// values; over them the orbit is closed from there.
pub(super) fn beginning(
    physics: Physics<'_>,
    (start, conditions): (&Start, &PlotConditions),
) -> Result<(PhaseSpace, State), DynamicsError> {
    let (system, parameters) = (physics.system, &start.parameters);
    let (model, equations) = (physics.model, physics.equations);
    let space = PhaseSpace::on_constraints((model, equations, system), parameters)?;
    let begun = if space.has_jumps() {
        conditions.state(system, model.run.start)?
    } else {
        start.state(system)?
    };
    let state = space.state(&begun)?;
    Ok((space, state))
}

/// Closes the orbit near a start: that of its energy, if that is conserved, or of a multiple of the period of its drive.
/// `report` is given the steps taken, and their greatest number.
pub(super) fn closed_orbit(
    physics: Physics<'_>,
    method: (&'static Method, Settings),
    (start, conditions): (&Start, &PlotConditions),
    report: &dyn Fn(u64, u64),
) -> Result<ClosedOrbit, DynamicsError> {
    let (space, state) = beginning(physics, (start, conditions))?;
    let fixed = if space.has_energy_levels() {
        Fixed::Energy(physics.system.energy(&state, &start.parameters)?)
    } else {
        Fixed::Nothing
    };
    let orbit = match space.drive() {
        Some(drive) => nearest_driven_orbit(&space, method, &state, drive, report)?,
        None => nearest_orbit(&space, method, &state, (None, fixed), report)?,
    };
    Ok(ClosedOrbit { space, orbit, fixed })
}
