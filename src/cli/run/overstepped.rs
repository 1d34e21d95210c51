//! Whether a method has stepped over a place where the motion ends, such as a pole of a force.
//!
//! In: the setup of a run in which a conserved quantity has drifted. Out: why the motion by series ends before the run does. Never here:
//! rows.

use std::sync::Arc;

use crate::experiment::{AdvanceOutcome, Experiment, Setup, Status};
use crate::integrate::{Method, Settings};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::system::System;

/// The method that finds where a motion ends.
const BY_SERIES: &str = "taylor";

/// It is followed for as many steps as the run has taken, since each of its own leads farther (at loose tolerances
/// about as far), and for so many more to a singularity.
const MORE_STEPS: u64 = 2000;

const MOST_STEPS: u64 = 20_000;

/// Whether a method may not see where a motion ends.
pub(super) fn may_step_over(method: &Method) -> bool {
    method.name != BY_SERIES
}

/// Why the motion ends before the time that the setup asks for; `None` if it does not, or not within some number of steps.
pub(super) fn end_of_motion(
    (model, equations, system): (&Arc<Model>, &Arc<Equations>, &System),
    setup: &Setup,
    steps: u64,
) -> Option<String> {
    let end = setup.end?;
    let settings = Settings { step: None, tolerance: None };
    let by_series = Setup { method: BY_SERIES.to_owned(), settings, ..setup.clone() };
    let mut motion = Experiment::new(model, equations, system, by_series).ok()?;
    motion.forget_past();
    motion.only_count_occurrences();
    let most = (steps + MORE_STEPS).min(MOST_STEPS);
    if motion.advance(end, most) != AdvanceOutcome::Stuck {
        return None;
    }
    match motion.status() {
        Status::Failed(error) if error.time < end && error.ends_motion => Some(error.message),
        _ => None,
    }
}
