//! Checks whether the method that a file names can begin the motion: the claims are checked with the default method, which
//! passes what others do not.
//!
//! In: a model and its system. Out: the outcome of a first step, and a diagnostic at the method's place where it fails.
//! Never here: the motion after its first step.

use crate::diagnostic::Diagnostic;
use crate::integrate::{Propagator, Settings, method_named};
use crate::model::Model;
use crate::system::{MotionError, State, System};

/// The duration of the motion if the file does not specify it.
pub(super) const LENGTH: f64 = 10.0;

/// The outcome of a first step from a state by the method that the file names, if it names one that fits.
pub(super) fn first_step(
    model: &Model,
    system: &System,
    state: &State,
    parameters: &[f64],
) -> Option<Result<(), MotionError>> {
    let run = &model.run;
    let method = method_named(&run.method).filter(|_| run.method != "auto")?;
    let settings = Settings { step: run.step, tolerance: run.tolerance };
    let mut course = Propagator::new(system, method, settings, parameters).ok()?;
    let end = run.until.unwrap_or(run.start + LENGTH);
    let begun = course.begin(state, parameters);
    let outcome = begun.and_then(|()| course.reach(end, end, &mut 1).map(|_| ()));
    Some(outcome.map_err(|error| course.explained(error)))
}

/// Why the method that the file names cannot begin, if the motion itself can.
pub(super) fn diagnostic(model: &Model, system: &System) -> Option<Diagnostic> {
    let parameters = model.parameter_values();
    let state = system.initial(model.run.start, &parameters, &[]).ok()?;
    let error = first_step(model, system, &state, &parameters)?.err()?;
    let place = model.run.method_place.clone().unwrap_or_else(|| model.law_place.clone());
    let name = &model.run.method;
    let message = format!("the method `{name}` cannot begin this motion: {error}");
    (error.time == model.run.start).then(|| Diagnostic::error(place, message))
}
