//! Whether a motion closes: it comes back to where it began, within rounding, and is periodic.
//!
//! In: a motion whose way is known. Out: the first time after which it is back. Never here: the search for an orbit near it.

use nalgebra::{DMatrix, DVector};

use super::carrier::Carrier;
use super::error::DynamicsError;
use super::excursion::Excursion;
use super::flow_direction::FlowDirection;
use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Settings};
use crate::num::bisect;
use crate::system::State;

/// A motion has closed where each variable is as near its start as this part of the way it goes, or of its size.
const OF_WAY: f64 = 1e-9;
const OF_SIZE: f64 = 1e-13;

/// The halvings of a step in which it passes its start.
const HALVINGS: u32 = 60;

/// The time after which the motion of this way is back at its start, until a time at the latest; nothing if it is not, or cannot be
/// followed.
///
/// # Errors
/// Returns an error if it is cancelled.
pub(super) fn closing(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    way: &Excursion,
    until: f64,
) -> Result<Option<f64>, DynamicsError> {
    match followed(space, (method, settings), way, until) {
        Err(error) if error.is_cancelled() => Err(error),
        Err(_) => Ok(None),
        Ok(found) => Ok(found),
    }
}

fn followed(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    way: &Excursion,
    until: f64,
) -> Result<Option<f64>, DynamicsError> {
    let start = way.start();
    let drive = if space.is_autonomous() { None } else { space.drive() };
    if drive.is_none() && !space.is_autonomous() {
        return Ok(None);
    }
    let mut carrier = Carrier::new(space, method, settings, 0)?;
    carrier.start(start, &DMatrix::zeros(space.dimension(), 0))?;
    let rates = FlowDirection::new(space).at(start)?;
    let mut behind = false;
    let mut driven = 1.0;
    while carrier.is_before(until, true) {
        carrier.step(until)?;
        let (begin, end) = carrier.interval();
        if let Some(period) = drive {
            while start.time + driven * period <= end {
                let time = start.time + driven * period;
                let (state, _) = carrier.at(time.max(begin))?;
                if is_back(space, way, &state) {
                    return Ok(Some(time - start.time));
                }
                driven += 1.0;
            }
            continue;
        }
        let (state, _) = carrier.at(end)?;
        let ahead = along(space, way, (&state, &rates)) >= 0.0;
        if behind && ahead {
            let [_, high] = bisect([begin, end], HALVINGS, |middle| {
                let (state, _) = carrier.at(middle)?;
                Ok::<_, DynamicsError>(along(space, way, (&state, &rates)) < 0.0)
            })?;
            let (state, _) = carrier.at(high)?;
            if is_back(space, way, &state) {
                return Ok(Some(high - start.time));
            }
        }
        behind = !ahead;
    }
    Ok(None)
}

/// How far a state lies from the start in the direction in which the motion leaves it, each variable as a part of its way.
fn along(space: &PhaseSpace, way: &Excursion, (state, rates): (&State, &DVector<f64>)) -> f64 {
    let parts = way.apart(space, state).into_iter().zip(rates);
    let moved = parts.filter(|(part, _)| part.extent > 0.0);
    moved.map(|(part, rate)| part.distance / part.extent * (rate / part.extent)).sum()
}

/// Whether a state is the start, within rounding.
fn is_back(space: &PhaseSpace, way: &Excursion, state: &State) -> bool {
    way.apart(space, state)
        .iter()
        .all(|part| part.distance.abs() <= (OF_WAY * part.extent).max(OF_SIZE * part.size))
}
