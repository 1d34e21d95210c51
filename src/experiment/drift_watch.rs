//! The drift of the energy of one motion among many, none of which is recorded.
//!
//! In: the state where it begins, those at the ends of its steps, and where it ends. Out: the values of all columns there,
//! and the gauges. Never here: rows, histories, the steps themselves.

use std::sync::Arc;

use super::gauges::{GaugeInputs, Gauges};
use super::snapshot::Gauge;
use crate::analysis::Errors;
use crate::mechanics::{Equations, Valuation};
use crate::model::Model;
use crate::system::{MotionError, Observer, State, System, TermWatch};

/// What is watched of one motion.
#[derive(Clone)]
pub struct DriftWatch {
    model: Arc<Model>,
    system: System,
    gauges: Gauges,
    terms: TermWatch,
    observer: Observer,
    constants: Valuation,
    values: Vec<f64>,
    steps: u64,
}

impl DriftWatch {
    /// A watch for motions of a system, of which each must [begin](DriftWatch::begin).
    pub fn new(model: &Arc<Model>, equations: &Arc<Equations>, system: &System) -> DriftWatch {
        let parameters = model.parameter_values();
        DriftWatch {
            model: Arc::clone(model),
            gauges: Gauges::new(model, equations, system),
            terms: system.term_watch(&parameters),
            observer: system.observer(&parameters),
            constants: Valuation::of_parameters(model, &parameters),
            values: vec![f64::NAN; system.channels().len()],
            steps: 0,
            system: system.clone(),
        }
    }

    /// Begins at a state.
    ///
    /// # Errors
    /// Returns an error if the state cannot be observed.
    pub fn begin(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        self.terms.set_parameters(parameters);
        self.observer.set_parameters(parameters);
        let body = self.system.body_values(parameters);
        self.constants = Valuation::of_parameters(&self.model, parameters).with(body);
        self.steps = 0;
        self.observe(state)?;
        self.update_gauges(state, |gauges, now| {
            gauges.refer(now);
            gauges.sample(now, false);
        });
        Ok(())
    }

    /// Observes the end of a step.
    pub fn step(&mut self, state: &State) {
        self.steps += 1;
        if self.terms.observe(state) {
            self.gauges.step(state.time, self.steps, &self.terms, true);
        }
    }

    /// Observes the end of a step, whose terms and work were evaluated elsewhere.
    pub fn step_with(&mut self, time: f64, terms: impl Iterator<Item = f64>, work: f64) {
        self.steps += 1;
        self.terms.take(terms, work);
        self.gauges.step(time, self.steps, &self.terms, true);
    }

    /// Ends at a state, and returns the value of every channel and the gauges there.
    ///
    /// # Errors
    /// Returns an error if the state cannot be observed.
    pub fn end(&mut self, state: &State) -> Result<(&[f64], Arc<[Gauge]>), MotionError> {
        self.observe(state)?;
        self.update_gauges(state, Gauges::observe);
        let gauges = self.gauges.show(&self.present(state));
        Ok((&self.values, gauges))
    }

    /// Updates the gauges by the state that was observed, as an experiment does at its rows.
    fn update_gauges(&mut self, state: &State, update: impl FnOnce(&mut Gauges, &GaugeInputs<'_>)) {
        let mut gauges = self.gauges.clone();
        update(&mut gauges, &self.present(state));
        self.gauges = gauges;
    }

    fn observe(&mut self, state: &State) -> Result<(), MotionError> {
        self.terms.observe(state);
        self.observer.observe(state, &mut self.values)
    }

    fn present<'a>(&'a self, state: &State) -> GaugeInputs<'a> {
        GaugeInputs {
            time: state.time,
            steps: self.steps,
            errors: Errors::Accumulated,
            values: &self.values,
            residuals: &[],
            action: state.values.get(self.system.driven_len()).copied().unwrap_or(f64::NAN),
            terms: &self.terms,
            system: &self.system,
            constants: &self.constants,
        }
    }
}
