//! How fast a motion changes, in its own unit of time: the ground for a first or a fixed step.
//!
//! A Taylor series of modest accuracy runs ahead for a while. How long its steps are depends on
//! nothing but the motion: on no unit, and on no coordinate's size or zero.

use super::method::Settings;
use super::taylor;
use crate::system::{State, System};

/// The accuracy of the series that runs ahead; its steps are then near an eighth of a period.
const TOLERANCE: f64 = 1e-9;

/// How many steps it looks ahead.
const AHEAD: usize = 48;

/// Beyond every time scale there is.
const FAR: f64 = 1e20;

/// The pace where there is no telling: nothing changes, or only as a polynomial in time.
const UNKNOWN: f64 = 1.0;

/// A step length that three in four steps of the motion ahead exceed, or else 1.
pub(super) fn of(system: &System, state: &State, parameters: &[f64]) -> f64 {
    let settings = Settings { step: None, tolerance: Some(TOLERANCE) };
    let Ok(mut ahead) = (taylor::METHOD.make)(system, &settings) else { return UNKNOWN };
    let mut steps = Vec::with_capacity(AHEAD);
    if ahead.start(state, parameters).is_ok() {
        while steps.len() < AHEAD && ahead.step(FAR).is_ok() && ahead.time() < FAR {
            steps.push(ahead.step_size());
        }
    }
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 4).copied().unwrap_or(UNKNOWN)
}
