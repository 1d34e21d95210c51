//! Checks before the first row that the resolution of the time is sufficient for the steps of a run
//! up to its end.
//!
//! In: an experiment at its start, the end. Out: an error, if a run would never end. Never here:
//! rows.

use super::times::Times;
use crate::cli::error::CommandError;
use crate::experiment::{Experiment, Status};
use crate::integrate::{Method, Propagator, Reached, Stepping, spacing};
use crate::system::System;

/// The number of trial steps, in two halves, if the first step is too short.
const TRIAL: u64 = 1000;

/// Steps that grow by this factor from the first half to the second may become long enough.
const GROWING: f64 = 2.0;

/// Refuses a run whose steps or impulses are below the resolution of the time at its end.
pub(super) fn check(
    system: &System,
    method: &'static Method,
    experiment: &Experiment,
    times: &Times,
) -> Result<(), CommandError> {
    let far = times.start().abs().max(times.end().abs());
    let finest = spacing(far);
    let refuse = |what: &str, length: f64| {
        let message = format!(
            "the clock cannot tell {what} {length:e} apart at t = {far:e}: its digits are \
             {finest:e} apart there"
        );
        Err(CommandError::WrongUse(message))
    };
    let snapshot = experiment.snapshot();
    let setup = &snapshot.setup;
    let impulses = &system.discontinuities().impulses;
    for (impulse, schedule) in impulses.iter().zip(system.schedule(&setup.parameters)) {
        if let Some(interval) = schedule.interval.filter(|interval| interval.high < finest) {
            return refuse(&format!("times of `{}`", impulse.name), interval.high);
        }
    }
    if let (Stepping::Fixed, Some(step)) = (method.stepping, setup.settings.step) {
        return if step < finest { refuse("steps of", step) } else { Ok(()) };
    }
    // an invalid start is reported when the run begins
    if matches!(experiment.status(), Status::Failed(_)) {
        return Ok(());
    }
    let Ok(mut motion) = Propagator::new(system, method, setup.settings, &setup.parameters) else {
        return Ok(());
    };
    if motion.begin(&snapshot.state, &setup.parameters).is_err() {
        return Ok(());
    }
    let end = times.end();
    let mut longest = |steps: u64| {
        let mut longest = 0.0_f64;
        for _ in 0..steps {
            match motion.reach(end, end, &mut 1) {
                Ok(Reached::OutOfBudget | Reached::Occurred(_)) => {}
                Ok(Reached::Arrived | Reached::Ended) | Err(_) => return None,
            }
            longest = longest.max(motion.step_size().abs());
        }
        Some(longest).filter(|&step| step < finest)
    };
    let Some(first) = longest(1) else { return Ok(()) };
    let (Some(early), Some(late)) = (longest(TRIAL), longest(TRIAL)) else { return Ok(()) };
    if late > GROWING * early.max(first) { Ok(()) } else { refuse("steps of", late) }
}
