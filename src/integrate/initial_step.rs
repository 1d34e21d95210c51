//! The time scale of a motion, from which a first or a fixed step is derived.
//!
//! A Taylor series of modest accuracy runs ahead for a while. The length of its steps depends only
//! on the motion, not on units or on the size or zero of any coordinate.

use super::method::Settings;
use super::taylor;
use crate::num::math;
use crate::system::{Side, State, System};

/// The tolerance of the series that runs ahead; its steps are then near an eighth of a period.
const TOLERANCE: f64 = 1e-9;

/// The number of steps that it considers ahead.
const AHEAD: usize = 48;

/// The number of steps at the default tolerance, which is tighter.
const A_FEW: usize = 4;

/// Steps shorter than this part of the longest one are ignored: near a singularity they shrink
/// without end and are not representative.
const SHORTEST: f64 = 1e-4;

/// Longer than every time scale, in any units; the square of a distance covered in it is a number.
const FAR: f64 = 1e150;

/// Over a longer time than this, in the shortest times in which velocity and acceleration at the start change
/// anything, a velocity on a kink is nothing beside what forces do there; and in the longest of these times, no step is as long.
const SOON: f64 = 1e6;

/// Over longer times than the first of these the squares of what a parabola covers between two kinks are no numbers;
/// but so many of the longest of these times must be ahead.
const LATE: (f64, f64) = (1e140, 1e10);

/// The order of the series from which these times follow.
const ORDER: usize = 4;

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
    let limits = limits(system, state, parameters);
    let modest = ahead(system, state, parameters, limits, (Some(TOLERANCE), AHEAD));
    let exact = ahead(system, state, parameters, limits, (None, A_FEW));
    match (modest, exact) {
        (Some(modest), Some(exact)) if modest < BY_ROUNDING * exact => exact,
        (Some(modest), _) => modest,
        (None, exact) => exact.unwrap_or(UNKNOWN),
    }
}

/// The limits of the first step and of the later ones. They follow from what the numbers of the motion do at the start, with
/// kinks on either side of all of them; without kinks the first one only says in which unit of time to begin, far beyond the
/// step: in the longest that there is, series leave the range of numbers, and are computed in a wider one over and over.
fn limits(system: &System, state: &State, parameters: &[f64]) -> (f64, f64) {
    let Ok(state) = system.convert(state, system.form(), parameters) else { return (FAR, FAR) };
    let mut series = system.series(ORDER, 0);
    series.set_parameters(&system.inputs(parameters));
    let (mut shortest, mut longest) = (FAR, 0.0_f64);
    for side in [Side::Positive, Side::Negative] {
        (0..series.switches()).for_each(|switch| series.set_side(switch, side));
        if series.build(&state).is_err() {
            continue;
        }
        for i in 0..series.inputs() {
            let c = series.coefficients(i);
            let Some(bend) = (2..c.len()).find(|&k| c[k] != 0.0) else { continue };
            for k in [0, 1] {
                let part = math::powf((c[k] / c[bend]).abs(), 1.0 / (bend - k) as f64);
                if part > 0.0 && part < FAR {
                    (shortest, longest) = (shortest.min(part), longest.max(part));
                }
            }
        }
    }
    let after = |time: f64| (state.time + time).min(FAR);
    if series.switches() == 0 {
        return (if longest > 0.0 { after(SOON * longest) } else { FAR }, FAR);
    }
    (after(SOON * shortest), after((LATE.0 * shortest).max(LATE.1 * longest)))
}

/// The same for the steps at one tolerance.
fn ahead(
    system: &System,
    state: &State,
    parameters: &[f64],
    (soon, far): (f64, f64),
    (tolerance, count): (Option<f64>, usize),
) -> Option<f64> {
    let mut ahead = (taylor::METHOD.make)(system, &Settings { step: None, tolerance }).ok()?;
    let mut steps = Vec::with_capacity(count);
    ahead.start(state, parameters).ok()?;
    let mut limit = soon;
    while steps.len() < count
        && !system.cancel().is_cancelled()
        && ahead.step(limit).is_ok()
        && ahead.time() < far
    {
        // one that was ended by its limit says nothing
        if ahead.time() != limit {
            steps.push(ahead.step_size());
        }
        limit = far;
    }
    let longest = steps.iter().copied().fold(0.0, f64::max);
    // a motion that comes to rest may do so in no time
    steps.retain(|step| *step > 0.0 && *step >= SHORTEST * longest);
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 4).copied()
}
