//! The periodic orbit near a start of a driven system: its period is that of the drive, or a small multiple of it.
//!
//! In: a start, the period of the drive. Out: the orbit, or what was searched for. Never here: how an orbit is closed.

use super::end_state::end_state;
use super::error::DynamicsError;
use super::first_return::difference;
use super::newton::Fixed;
use super::orbit::{Orbit, periodic_orbit, searched};
use super::phase_space::PhaseSpace;
use super::search_budget::SearchBudget;
use super::unclosed_motion::explained;
use crate::integrate::{Method, Settings};
use crate::system::State;

/// The most periods of the drive in which an orbit is searched for.
const MULTIPLES: u32 = 6;

/// A return this near, relative to the farthest, is tried first.
const NEAR: f64 = 0.1;

/// An orbit that comes back this near, relative to its size, before its period has ended closes there.
const SAME: f64 = 1e-9;

/// The periodic orbit near a start whose period is that of the drive or a small multiple of it; multiples after which the
/// motion returns near its start are tried first.
///
/// # Errors
/// Returns an error if there is none nearby, which says what the motion is instead; if the motion cannot be followed; or on
/// cancellation.
pub fn driven_orbit(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    start: &State,
    drive: f64,
) -> Result<Orbit, DynamicsError> {
    let found = nearest_driven_orbit(space, method, start, drive, &|_, _| ());
    found.map_err(|error| explained(error, space, method, start, &mut |_, _| ()))
}

/// Finds the orbit of [`driven_orbit`], without saying in an error what the motion is instead. `report` is given the
/// number of steps taken and its maximum.
///
/// # Errors
/// Returns an error if there is none nearby; if the motion cannot be followed; or on cancellation.
pub fn nearest_driven_orbit(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    start: &State,
    drive: f64,
    report: &dyn Fn(u64, u64),
) -> Result<Orbit, DynamicsError> {
    let budget = SearchBudget::of(method.0, report);
    let mut singular = None;
    let mut misses: Vec<(u32, f64)> = Vec::new();
    let mut state = start.clone();
    for count in 1..=MULTIPLES {
        let end = start.time + f64::from(count) * drive;
        state = end_state(space, method, &state, end)?;
        misses.push((count, difference(space, &state, start).norm()));
    }
    let farthest = misses.iter().map(|(_, miss)| *miss).fold(0.0, f64::max);
    misses.sort_by_key(|(count, miss)| (*miss > NEAR * farthest, *count));
    for (count, _) in &misses {
        let period = f64::from(*count) * drive;
        let wanted = (Some(period), Fixed::Period(period));
        match searched(space, method, start, wanted, &budget) {
            Ok(Err(_)) | Err(DynamicsError::Unsuited(_) | DynamicsError::Unclosed(_)) => {}
            Err(error @ DynamicsError::Singular(_)) => singular = Some(error),
            Ok(Ok(orbit)) => return shortest(space, method, orbit, (*count, drive)),
            Err(error) => return Err(error),
        }
    }
    if let Some(error) = singular {
        return Err(error);
    }
    let ended = budget.ended().map_or_else(String::new, |ended| format!("; {ended}"));
    Err(DynamicsError::Unclosed(format!(
        "no periodic orbit was found near the start with the period of the drive, {drive:.6}, or 2 to {MULTIPLES} times it: \
         begin nearer to one, where the motion has settled, or give the period of the orbit{ended}"
    )))
}

/// The same orbit over the fewest periods of the drive after which it closes, a part of those that are known.
fn shortest(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    orbit: Orbit,
    (count, drive): (u32, f64),
) -> Result<Orbit, DynamicsError> {
    let size = space.variables(&orbit.state).iter().fold(1.0_f64, |size, x| size.max(x.abs()));
    for part in (1..count).filter(|&part| count.is_multiple_of(part)) {
        let period = f64::from(part) * drive;
        let end = orbit.state.time + period;
        let after = end_state(space, method, &orbit.state, end)?;
        if difference(space, &after, &orbit.state).norm() <= SAME * size {
            return periodic_orbit(
                space,
                method,
                &orbit.state,
                Some(period),
                Fixed::Period(period),
            );
        }
    }
    Ok(orbit)
}
