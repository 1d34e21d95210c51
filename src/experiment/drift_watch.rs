//! The drift of the energy of one motion among many, none of which is recorded.
//!
//! In: the state where it begins, those at the ends of its steps, and where it ends. Out: the values of all columns there,
//! and the gauges. Never here: rows, histories, the steps themselves.

use std::sync::Arc;

use super::gauges::{GaugeInputs, Gauges, by_rounding_of_state};
use super::snapshot::Gauge;
use crate::analysis::Errors;
use crate::mechanics::{Equations, Valuation};
use crate::model::Model;
use crate::system::{MotionError, Observer, State, System, TermSums, TermWatch};

/// What is watched of one motion.
#[derive(Clone)]
pub(super) struct DriftWatch {
    model: Arc<Model>,
    gauges: Gauges,
    observed: ObservedState,
}

/// What the gauges read of a state.
#[derive(Clone)]
struct ObservedState {
    system: System,
    terms: TermWatch,
    observer: Observer,
    constants: Valuation,
    values: Vec<f64>,
    steps: u64,
}

impl DriftWatch {
    /// A watch for motions of a system, of which each must [begin](DriftWatch::begin).
    pub(super) fn new(
        model: &Arc<Model>,
        equations: &Arc<Equations>,
        system: &System,
    ) -> DriftWatch {
        let parameters = model.parameter_values();
        DriftWatch {
            model: Arc::clone(model),
            gauges: Gauges::new(model, equations, system),
            observed: ObservedState {
                terms: system.term_watch(&parameters),
                observer: system.observer(&parameters),
                constants: Valuation::of_parameters(model, &parameters),
                values: vec![f64::NAN; system.channels().len()],
                steps: 0,
                system: system.clone(),
            },
        }
    }

    /// Begins at a state.
    ///
    /// # Errors
    /// Returns an error if the state cannot be observed.
    pub(super) fn begin(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        let DriftWatch { model, gauges, observed } = self;
        observed.terms.set_parameters(parameters);
        observed.observer.set_parameters(parameters);
        let body = observed.system.body_values(parameters);
        observed.constants = Valuation::of_parameters(model, parameters).with(body);
        observed.steps = 0;
        observed.observe(state)?;
        let now = observed.present(state);
        gauges.refer(&now);
        gauges.observe(&now);
        Ok(())
    }

    /// Observes the end of a step.
    pub(super) fn step(&mut self, state: &State) {
        let DriftWatch { gauges, observed, .. } = self;
        observed.steps += 1;
        if observed.terms.observe(state) {
            gauges.step(state.time, observed.steps, &observed.terms, true);
        }
    }

    /// The quantities that have terms: the place of each, the quantity, and what its terms were at rest.
    pub(super) fn summed(&self) -> impl Iterator<Item = (usize, usize, &[f64])> {
        self.gauges.summed()
    }

    /// Observes the end of a step at a time, for which the sums over the terms of the quantities at these places were evaluated
    /// elsewhere.
    pub(super) fn step_with<'a>(
        &mut self,
        time: f64,
        state: impl FnOnce() -> &'a State,
        sums: impl Iterator<Item = (usize, TermSums)>,
        work: f64,
    ) {
        let DriftWatch { gauges, observed, .. } = self;
        observed.steps += 1;
        let terms = &mut observed.terms;
        // the same for all quantities, of which few ask
        let (mut state, mut known) = (Some(state), None);
        let by_state = |quantity| {
            let observe = || state.take().is_some_and(|state| terms.observe(state()));
            let known = *known.get_or_insert_with(observe);
            known.then(|| by_rounding_of_state(terms, quantity))?
        };
        gauges.step_with((time, observed.steps), sums, work, by_state);
    }

    /// Ends at a state, and returns the value of every channel and the gauges there.
    ///
    /// # Errors
    /// Returns an error if the state cannot be observed.
    pub(super) fn end(&mut self, state: &State) -> Result<(&[f64], Arc<[Gauge]>), MotionError> {
        let DriftWatch { gauges, observed, .. } = self;
        observed.observe(state)?;
        let now = observed.present(state);
        gauges.observe(&now);
        Ok((&observed.values, gauges.show(&now)))
    }
}

impl ObservedState {
    fn observe(&mut self, state: &State) -> Result<(), MotionError> {
        self.terms.observe(state);
        self.observer.observe(state, &mut self.values)
    }

    /// What gauges are updated by, as an experiment does at its rows.
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
