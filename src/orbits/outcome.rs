//! The end of one run among many.
//!
//! In: a system, a start, an end in time. Out: the values of all columns there, those that a run of the same start has, and
//! the drift of the energy on the way. Orbits that need nothing but steps are followed side by side, the others each as
//! an experiment; which of the two depends on the orbit alone, and at which states the gauges are evaluated depends on the system alone. Never here:
//! rows on the way, files.

use std::sync::Arc;

use serde::{Deserialize, Deserializer, Serialize};

use crate::ensemble::{OrbitStatus, Start};
use crate::experiment::{DriftWatchBatch, Experiment, Gauge, Setup, Status, energy_drift};
use crate::integrate::{
    BatchPropagator, Follower, LaneStatus, OrbitCourse, Settings, method_named, side_by_side,
};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::num::short;
use crate::system::{State, System};

/// What all runs have in common.
#[derive(Clone)]
pub struct RunPlan {
    /// The model.
    pub model: Arc<Model>,
    /// What was derived from the model.
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
pub struct RunOutcome {
    /// How it ended.
    pub status: OrbitStatus,
    /// Why, if that needs a sentence.
    pub message: Option<String>,
    /// The time at its end.
    pub time: f64,
    /// The value of every column there.
    pub values: Vec<f64>,
    /// The greatest drift of the energy, or of the energy less the work done, relative to what moves: over the ends of all
    /// steps, of systems that do not go side by side at other times too; NaN if neither is monitored.
    pub energy_drift: f64,
    /// The quantity that is conserved by the law of motion and has left its value, if there is any; the one with the greatest
    /// drift.
    pub departed: Option<Departed>,
}

/// A conserved quantity that has left its value.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Departed {
    /// As its gauge is called.
    pub name: String,
    /// Its greatest drift, relative to what moves.
    #[serde(deserialize_with = "unbounded")]
    pub drift: f64,
}

/// JSON has no infinity, and serde_json writes `null` for it.
fn unbounded<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::INFINITY))
}

/// The steps between two checks of the token.
const STEPS_PER_CHECK: u64 = 256;

/// The number of accurate observations of the gauges, besides those after every step.
const OBSERVATIONS: f64 = 64.0;

impl RunOutcome {
    /// A run that could not begin.
    pub fn refused(why: &impl ToString, columns: usize) -> RunOutcome {
        RunOutcome {
            status: OrbitStatus::Refused,
            message: Some(why.to_string()),
            time: f64::NAN,
            values: vec![f64::NAN; columns],
            energy_drift: f64::NAN,
            departed: None,
        }
    }

    fn ended(
        (status, message): (OrbitStatus, Option<String>),
        time: f64,
        values: &[f64],
        gauges: &[Gauge],
    ) -> RunOutcome {
        let departed = Gauge::departed(gauges);
        RunOutcome {
            status,
            message,
            time,
            values: values.to_vec(),
            energy_drift: energy_drift(gauges),
            departed: departed.map(|g| Departed { name: g.name.clone(), drift: g.max_drift }),
        }
    }
}

impl RunPlan {
    fn experiment(&self, start: &Start, end: f64) -> Result<Experiment, String> {
        let length = if end > start.time { end - start.time } else { 1.0 };
        let only_ends = self.is_side_by_side();
        let setup = Setup {
            parameters: start.parameters.clone(),
            overrides: start.overrides.clone(),
            method: self.method.clone(),
            settings: self.settings,
            start: start.time,
            end: Some(end),
            // one row, that of the start
            spacing: if only_ends { 2.0 * length } else { length / OBSERVATIONS },
            ..Setup::of(&self.model)
        };
        let mut experiment = Experiment::new(&self.model, &self.equations, &self.system, setup)
            .map_err(|why| why.to_string())?;
        if only_ends {
            experiment.observe_ends_only();
        }
        Ok(experiment)
    }

    /// Runs to the end, alone; `None` if it was cancelled.
    pub fn run(&self, start: &Start, end: f64) -> Option<RunOutcome> {
        let columns = self.system.columns();
        let mut experiment = match self.experiment(start, end) {
            Ok(experiment) => experiment,
            Err(why) => return Some(RunOutcome::refused(&why, columns)),
        };
        if let Status::Failed(error) = experiment.status() {
            let cancelled = self.system.cancel().is_cancelled();
            return (!cancelled).then(|| RunOutcome::refused(&error.message, columns));
        }
        experiment.only_count_occurrences();
        experiment.forget_past();
        let (status, message) = loop {
            experiment.advance(end, STEPS_PER_CHECK);
            if self.system.cancel().is_cancelled() {
                return None;
            }
            match experiment.status() {
                Status::Failed(error) => break (OrbitStatus::Failed, Some(error.message)),
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
        let values = &experiment.values()[..columns];
        Some(RunOutcome::ended((status, message), experiment.time(), values, &gauges))
    }
}

impl RunPlan {
    /// Whether they are followed side by side.
    pub fn is_side_by_side(&self) -> bool {
        self.batch().is_some()
    }

    /// Follows several runs to their ends and hands each to `done` as soon as it is over. One that is cancelled is not.
    pub fn run_all(&self, runs: &[(&Start, f64)], mut done: impl FnMut(usize, RunOutcome)) {
        let alone = |i: usize, done: &mut dyn FnMut(usize, RunOutcome)| {
            let (start, end) = runs[i];
            self.run(start, end).into_iter().for_each(|outcome| done(i, outcome));
        };
        let Some(mut batch) = self.batch() else {
            (0..runs.len()).for_each(|i| alone(i, &mut done));
            return;
        };
        let (model, equations, system) = (&self.model, &self.equations, &self.system);
        let mut together = RunTogether {
            plan: self,
            runs,
            watches: DriftWatchBatch::new(model, equations, system, batch.form()),
            last: State::new(0.0, batch.form(), Vec::new()),
            alone: Vec::new(),
            done: &mut done,
        };
        side_by_side(&mut batch, runs.len(), &mut together);
        let left = together.alone;
        for i in left {
            alone(i, &mut done);
        }
    }

    /// Room for runs side by side, where they need nothing but steps.
    fn batch(&self) -> Option<BatchPropagator> {
        let method = method_named(&self.method)?;
        BatchPropagator::new(&self.system.without_marks(), method, self.settings)
    }
}

/// Runs that are followed side by side.
struct RunTogether<'a, D: FnMut(usize, RunOutcome)> {
    plan: &'a RunPlan,
    runs: &'a [(&'a Start, f64)],
    watches: DriftWatchBatch,
    last: State,
    alone: Vec<usize>,
    done: &'a mut D,
}

impl<D: FnMut(usize, RunOutcome)> Follower for RunTogether<'_, D> {
    fn begin(&mut self, orbit: usize, lane: usize, batch: &mut BatchPropagator) -> OrbitCourse {
        let (start, end) = self.runs[orbit];
        let parameters = &start.parameters;
        let regular = start.time < end
            && start.state(&self.plan.system).is_ok_and(|state| {
                self.watches.begin(lane, &state, parameters).is_ok()
                    && batch.begin(lane, &state, parameters) == LaneStatus::Underway
            });
        if regular {
            return OrbitCourse::Until(end);
        }
        self.leave(orbit);
        OrbitCourse::Over
    }

    fn observe_all(&mut self, batch: &mut BatchPropagator) {
        self.watches.step(batch);
    }

    fn observe(&mut self, orbit: usize, lane: usize, batch: &mut BatchPropagator) -> OrbitCourse {
        let (_, end) = self.runs[orbit];
        if batch.time(lane) < end {
            return OrbitCourse::Until(end);
        }
        // a method of fixed step may have passed the end
        batch.at(lane, end, &mut self.last);
        match self.watches.end(lane, &self.last) {
            Ok((values, gauges)) => {
                let values = &values[..self.plan.system.columns()];
                let how = (OrbitStatus::Completed, None);
                (self.done)(orbit, RunOutcome::ended(how, end, values, &gauges));
            }
            Err(_) => self.leave(orbit),
        }
        OrbitCourse::Over
    }

    fn leave(&mut self, orbit: usize) {
        self.alone.push(orbit);
    }
}
