//! The time scale of a motion, from which a first or a fixed step is derived.
//!
//! A Taylor series of modest accuracy runs ahead for a while. The length of its steps depends only
//! on the motion, not on units or on the size or zero of any coordinate.

use super::method::Settings;
use super::taylor;
use crate::system::{State, System};

/// The tolerance of the series that runs ahead; its steps are then near an eighth of a period.
const TOLERANCE: f64 = 1e-9;

/// The number of steps it looks ahead.
const AHEAD: usize = 48;

/// The number of steps at the default tolerance, which is tighter.
const A_FEW: usize = 4;

/// Steps shorter than this part of the longest one are ignored: near a singularity they shrink
/// without end and are not representative.
const SHORTEST: f64 = 1e-4;

/// Longer than every time scale, in any units; the square of a distance covered in it is a number.
const FAR: f64 = 1e150;

/// The time scale if it is undetermined: nothing changes, or only as a polynomial in time.
const UNKNOWN: f64 = 1.0;

/// If the steps of modest accuracy are shorter than this part of the most accurate ones, which
/// carry more digits, rounding has shortened them, by a number that is zero but for rounding.
const BY_ROUNDING: f64 = 1e-3;

/// Returns a step length that three in four steps of the motion ahead exceed, or else 1.
pub(super) fn of(system: &System, state: &State, parameters: &[f64]) -> f64 {
    // tangent vectors have no time scale of their own
    let plain = system.without_tangents();
    let (state, system) = (&plain.extended(state, system), &plain);
    let modest = ahead(system, state, parameters, (Some(TOLERANCE), AHEAD));
    let exact = ahead(system, state, parameters, (None, A_FEW));
    match (modest, exact) {
        (Some(modest), Some(exact)) if modest < BY_ROUNDING * exact => exact,
        (Some(modest), _) => modest,
        (None, exact) => exact.unwrap_or(UNKNOWN),
    }
}

/// The same for the steps at one tolerance.
fn ahead(
    system: &System,
    state: &State,
    parameters: &[f64],
    (tolerance, count): (Option<f64>, usize),
) -> Option<f64> {
    let mut ahead = (taylor::METHOD.make)(system, &Settings { step: None, tolerance }).ok()?;
    let mut steps = Vec::with_capacity(count);
    ahead.start(state, parameters).ok()?;
    while steps.len() < count
        && !system.cancel().is_cancelled()
        && ahead.step(FAR).is_ok()
        && ahead.time() < FAR
    {
        steps.push(ahead.step_size());
    }
    let longest = steps.iter().copied().fold(0.0, f64::max);
    // a motion that comes to rest may do so in no time
    steps.retain(|step| *step > 0.0 && *step >= SHORTEST * longest);
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 4).copied()
}
