//! Warnings about the limits of a method, before a run or after it.

use crate::claims;
use crate::cli::stderr;
use crate::experiment::Experiment;
use crate::integrate::{METHODS, Method, Settings};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::printable;
use crate::system::System;

/// Warns before the run about a law with a step, and about a method that ignores the kinks of the motion.
pub(super) fn before(model: &Model, system: &System, equations: &Equations, method: &Method) {
    let law = if equations.is_lagrangian() { "L" } else { "H" };
    if let Some(angle) = equations.law_cut_at_a_place() {
        let angle = equations.pool.text(angle);
        stderr::report(&format!(
            "{law} jumps at the cut of {angle}, where the angle goes from pi to -pi and the force is an impulse that no \
             derivative shows: the motion crosses it without the impulse; an angle that is a coordinate has no cut"
        ));
    } else if equations.has_impulses_at_steps() {
        stderr::report(&format!(
            "{law} has a step, where the force is an impulse that no derivative shows: the motion crosses it without the impulse; \
             make the step a steep slope, as with tanh, or give the impulse as an event"
        ));
    }
    if !equations.momentum_steps().is_empty() {
        stderr::report(
            "L has a step in time in its momenta, which keep their values there while the velocities jump",
        );
    }
    if equations.momenta_jump_at_poles() {
        stderr::report(
            "L has a step in time in its momenta at a pole, where the motion keeps the velocities; make the step a steep slope, as \
             with tanh, or write H",
        );
    }
    // steps end there
    let steps = equations.steps_in_time();
    let keeps_accuracy = method.stays_within_steps || !equations.momentum_rates_switch_at(&steps);
    let located = if keeps_accuracy { &steps[..] } else { &[] };
    let has_kinks = system.has_kinks() && model.has_kinks_beside_smooth_ramps(located);
    if (has_kinks || model.has_folded_angles()) && !method.locates_kinks {
        let others: Vec<&str> =
            METHODS.iter().filter(|m| m.locates_kinks).map(|m| m.name).collect();
        stderr::report(&format!(
            "{} steps over the kinks of this motion and loses accuracy there; {} locates them",
            method.name,
            others.join(", ")
        ));
    }
}

/// Warns before the run about a start from which more than one motion follows, and about what no motion from it sees.
pub(super) fn of_start(
    model: &Model,
    equations: &Equations,
    system: &System,
    by: (&'static Method, Settings),
    experiment: &Experiment,
) {
    let snapshot = experiment.snapshot();
    let start = (&*snapshot.state, &*snapshot.setup.parameters);
    if let Some(warning) = claims::unresolved_feature((model, equations, system), start.0, start.1)
    {
        stderr::report(&warning.message);
    }
    if let Some(sentence) = claims::several_starts(model, system, start, by) {
        stderr::report(&sentence);
    }
}

/// Warns after the run about a fixed step beyond the stability limit, and about events that can no longer happen.
pub(super) fn after(experiment: &Experiment) {
    for name in without_value(experiment) {
        stderr::report(&format!(
            "at the end the function of the event `{}` has no value; an event is where it changes its sign",
            printable::quoted(&name)
        ));
    }
    if let Some(sentence) = experiment.unstable() {
        stderr::report(&sentence);
    }
}

/// The events whose functions have no value at the current state, as that of √y below the floor.
fn without_value(experiment: &Experiment) -> Vec<String> {
    let (snapshot, system) = (experiment.snapshot(), experiment.system());
    let events = &experiment.model().events;
    let Some(mut functions) = system.event_functions(&snapshot.parameters) else {
        return Vec::new();
    };
    let count = events.len() + experiment.model().sections.len();
    let mut values = vec![0.0; count];
    // a motion that has not begun has no state
    let has_begun = snapshot.state.is_finite() && !snapshot.state.values.is_empty();
    if !has_begun || functions.observe(&snapshot.state, &mut values).is_err() {
        return Vec::new();
    }
    let without = events.iter().zip(values).filter(|(_, value)| value.is_nan());
    without.map(|(event, _)| event.name.clone()).collect()
}
