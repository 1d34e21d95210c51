//! The state at the end of a motion, without its derivatives.
//!
//! In: a state of a phase space, a time. Out: the state then. Never here: what it is compared with.

use nalgebra::DMatrix;

use super::carrier::Carrier;
use super::error::DynamicsError;
use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Settings};
use crate::system::State;

/// The state at a time, in the variables of the space.
///
/// # Errors
/// Returns an error if the motion cannot be followed so far, or is cancelled.
pub(super) fn end_state(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    start: &State,
    until: f64,
) -> Result<State, DynamicsError> {
    let mut carrier = Carrier::new(space, method, settings, 0)?;
    carrier.start(start, &DMatrix::zeros(space.dimension(), 0))?;
    let forwards = until >= start.time;
    while carrier.is_before(until, forwards) {
        carrier.step(until)?;
    }
    Ok(carrier.at(until)?.0)
}
