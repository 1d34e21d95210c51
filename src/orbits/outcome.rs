//! The end of one run among many.
//!
//! In: a system, a start, an end in time. Out: the values of all columns there and the drift of the energy on the way,
//! those that a run of the same start has: it is the same experiment. Never here: rows on the way, files.

use std::sync::Arc;

use crate::ensemble::{OrbitStatus, Start};
use crate::experiment::{Experiment, Setup, Status};
use crate::integrate::Settings;
use crate::mechanics::Equations;
use crate::model::Model;
use crate::num::short;
use crate::system::System;

/// What all runs have in common.
#[derive(Clone)]
pub struct RunPlan {
    /// The model.
    pub model: Arc<Model>,
    /// Its equations.
    pub equations: Arc<Equations>,
    /// The compiled system.
    pub system: System,
    /// The method's name.
    pub method: String,
    /// Its step or tolerance.
    pub settings: Settings,
}

/// How a run ended, and where.
#[derive(Clone, PartialEq, Debug)]
pub struct Outcome {
    /// How it ended.
    pub status: OrbitStatus,
    /// Why, if that needs a sentence.
    pub message: Option<String>,
    /// The time at its end.
    pub time: f64,
    /// The value of every column there.
    pub values: Vec<f64>,
    /// The greatest drift of the energy, or of the energy less the work done, over all steps, relative to what moves; NaN
    /// if neither is monitored.
    pub energy_drift: f64,
}

/// The steps between two looks at the token.
const STEPS_PER_LOOK: u64 = 256;

/// The number of accurate looks at the gauges, besides those after every step.
const LOOKS: f64 = 64.0;

impl Outcome {
    /// A run that could not begin.
    pub fn refused(why: &impl ToString, columns: usize) -> Outcome {
        Outcome {
            status: OrbitStatus::Refused,
            message: Some(why.to_string()),
            time: f64::NAN,
            values: vec![f64::NAN; columns],
            energy_drift: f64::NAN,
        }
    }
}

impl RunPlan {
    /// The experiment of one run.
    fn experiment(&self, start: &Start, end: f64) -> Result<Experiment, String> {
        let length = if end > start.time { end - start.time } else { 1.0 };
        let setup = Setup {
            parameters: start.parameters.clone(),
            overrides: start.overrides.clone(),
            method: self.method.clone(),
            settings: self.settings,
            start: start.time,
            end: Some(end),
            spacing: length / LOOKS,
            ..Setup::of(&self.model)
        };
        Experiment::new(&self.model, &self.equations, &self.system, setup)
            .map_err(|why| why.to_string())
    }

    /// Runs to the end; `None` if it was cancelled.
    pub fn run(&self, start: &Start, end: f64) -> Option<Outcome> {
        let columns = self.system.columns();
        let mut experiment = match self.experiment(start, end) {
            Ok(experiment) => experiment,
            Err(why) => return Some(Outcome::refused(&why, columns)),
        };
        if let Status::Failed(failure) = experiment.status() {
            let cancelled = self.system.cancel().is_cancelled();
            return (!cancelled).then(|| Outcome::refused(&failure.message, columns));
        }
        experiment.only_count_occurrences();
        let (status, message) = loop {
            experiment.advance(end, STEPS_PER_LOOK);
            if self.system.cancel().is_cancelled() {
                return None;
            }
            match experiment.status() {
                Status::Failed(failure) => break (OrbitStatus::Faulted, Some(failure.message)),
                Status::Ended(name) => {
                    let time = short(experiment.time());
                    let message = format!("`{name}` ended the motion at t = {time}");
                    break (OrbitStatus::Stopped, Some(message));
                }
                Status::Running | Status::Paused if experiment.time() >= end => {
                    break (OrbitStatus::Completed, None);
                }
                Status::Running | Status::Paused => {}
            }
        };
        let gauges = experiment.snapshot().gauges;
        let gauge = |name: &str| gauges.iter().find(|gauge| gauge.name == name);
        let energy = gauge("energy ledger").or_else(|| gauge("energy"));
        Some(Outcome {
            status,
            message,
            time: experiment.time(),
            values: experiment.values()[..columns].to_vec(),
            energy_drift: energy.map_or(f64::NAN, |gauge| gauge.max_drift),
        })
    }
}
