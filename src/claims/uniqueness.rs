//! Starts from which more than one motion follows.
//!
//! In: a model, its system, a state, a method. Out: a sentence that says so, and which motion the method follows. Never here: what
//! makes a motion one of several.

use std::cmp::Ordering;

use crate::diagnostic::Diagnostic;
use crate::integrate::{
    Method, Propagator, Settings, SeveralMotions, method_named, several_motions,
};
use crate::model::Model;
use crate::num::short;
use crate::system::{State, System};

use super::own_method::LENGTH;

/// The steps after which a motion that leaves its start has left it: the first may only choose a side.
const STEPS: u64 = 4;

/// Says that the motion from a state is not unique, and which one a method follows.
pub fn several_starts(
    model: &Model,
    system: &System,
    (state, parameters): (&State, &[f64]),
    by: (&'static Method, Settings),
) -> Option<String> {
    let found = several_motions(system, state, parameters)?;
    sentence(model, system, (state, parameters), by, found)
}

/// The sentence about a start of several motions.
fn sentence(
    model: &Model,
    system: &System,
    (state, parameters): (&State, &[f64]),
    by: (&'static Method, Settings),
    found: SeveralMotions,
) -> Option<String> {
    let coordinate = model.coordinates.get(found.coordinate)?;
    let (name, x) = (&coordinate.name, state.values[found.coordinate]);
    let sides = match found.sides {
        [true, true] => "to both sides".to_owned(),
        [true, false] => format!("to smaller {name}"),
        [false, _] => format!("to larger {name}"),
    };
    // a motion that is not followed may have no force there
    let y = followed(model, system, (state, parameters), by, found.coordinate)?;
    let followed = match y.partial_cmp(&x)? {
        Ordering::Greater => format!("leaves at once to larger {name}"),
        Ordering::Less => format!("leaves at once to smaller {name}"),
        Ordering::Equal => "stays at rest".to_owned(),
    };
    Some(format!(
        "the motion from rest at {name} = {} is not unique: it may stay there for any time, since the force that drives it away \
         {sides} is not smooth there: the one followed here {followed}",
        short(x)
    ))
}

/// Where a motion is after its first steps.
fn followed(
    model: &Model,
    system: &System,
    (state, parameters): (&State, &[f64]),
    (method, settings): (&'static Method, Settings),
    coordinate: usize,
) -> Option<f64> {
    let mut motion = Propagator::new(system, method, settings, parameters).ok()?;
    motion.begin(state, parameters).ok()?;
    let end = model.run.until.filter(|end| *end > state.time).unwrap_or(state.time + LENGTH);
    motion.reach_unexplained(end, end, &mut { STEPS }).ok()?;
    motion.computed().values.get(coordinate).copied()
}

/// A warning of a start of a file that is not the start of one motion only.
pub(super) fn diagnostic(model: &Model, system: &System) -> Option<Diagnostic> {
    let parameters = model.parameter_values();
    let state = system.initial(model.run.start, &parameters, &[]).ok()?;
    let run = &model.run;
    let by = match method_named(&run.method) {
        Some(method) => (method, Settings { step: run.step, tolerance: run.tolerance }),
        None => (method_named("taylor")?, Settings::default()),
    };
    let found = several_motions(system, &state, &parameters)?;
    let message = sentence(model, system, (&state, &parameters), by, found)?;
    let place = model.coordinates.get(found.coordinate)?.place.clone();
    Some(Diagnostic::warning(place, message))
}
