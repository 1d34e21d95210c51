//! A motion and its observed values: the current state and the value of every channel there.
//!
//! In: a state, parameters, times. Out: the current state and the value of every channel. Never here: rows, gauges,
//! commands, and how it advances (`advance`).

mod advance;

use super::gauges::GaugeInputs;
use super::step_log::StepLog;
use super::step_sampler::StepSampler;
use crate::analysis::Errors;
use crate::integrate::{
    self, Method, MethodError, NarrowPassage, Occurrence, OccurrenceKind, Preserves, Settings,
    Unstable,
};
use crate::mechanics::Valuation;
use crate::system::{MotionError, Observer, State, System};

pub(super) struct ObservedMotion {
    pub(super) inner: integrate::Propagator,
    observer: Observer,
    values: Vec<f64>,
    /// The channels that had no value at some state that was observed since the last row.
    lost: Vec<bool>,
    residuals: Vec<[f64; 2]>,
    /// The motion's count of constraint changes when the observer was made.
    active_set_changes: u64,
    pub(super) watch: StepSampler,
    /// A state within a step.
    inside: State,
    pub(super) log: StepLog,
    /// −1 if the system is run backwards, so that the clock of its states is −t; otherwise 1.
    pub(super) sign: f64,
}

/// One of so many equal steps is logged.
pub(super) const EQUAL_STEPS: u64 = 8;

impl ObservedMotion {
    /// A motion that has yet to [begin](ObservedMotion::begin).
    pub(super) fn new(
        system: &System,
        method: &'static Method,
        settings: Settings,
        parameters: &[f64],
    ) -> Result<ObservedMotion, MethodError> {
        Ok(ObservedMotion {
            sign: if system.is_backwards() { -1.0 } else { 1.0 },
            inner: integrate::Propagator::new(system, method, settings, parameters)?,
            observer: system.observer(parameters),
            values: vec![f64::NAN; system.channels().len()],
            lost: vec![false; system.channels().len()],
            residuals: Vec::new(),
            active_set_changes: 0,
            watch: StepSampler::of(system, parameters),
            inside: State::new(0.0, system.form(), Vec::new()),
            log: StepLog::default(),
        })
    }

    /// Remembers no states between steps from now on: the motion cannot be carried back.
    pub(super) fn forget_past(&mut self) {
        self.log.turn_off();
    }

    /// Another motion of the same system, with which times of the past are [visited](ObservedMotion::go_to).
    pub(super) fn another(&self, parameters: &[f64]) -> Result<ObservedMotion, MethodError> {
        ObservedMotion::new(self.inner.whole(), self.method(), self.settings(), parameters)
    }

    /// Changes the method or its settings; the motion must then [continue](ObservedMotion::continue_from) from its state.
    pub(super) fn change_method(
        &mut self,
        method: &'static Method,
        settings: Settings,
    ) -> Result<(), MethodError> {
        self.inner.change_method(method, settings)
    }

    pub(super) fn begin(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        self.log.clear();
        self.inner.begin(state, parameters)?;
        self.observer = self.inner.system().observer(parameters);
        self.watch = StepSampler::of(self.inner.system(), parameters);
        self.log_state();
        self.observe()
    }

    /// Resumes a motion that began at `start` from this state, with these constraints released and, if steps are fixed and it
    /// is known, with this step.
    pub(super) fn restore(
        &mut self,
        (state, step): (&State, Option<f64>),
        parameters: &[f64],
        (start, released): (f64, &[usize]),
    ) -> Result<(), MotionError> {
        self.log.clear();
        match step {
            Some(step) => {
                let begun = (start, released);
                self.inner.restore_with_step_and_parameters((state, step), parameters, begun)?;
            }
            None => self.inner.restore(state, parameters, start, released)?,
        }
        self.observer = self.inner.system().observer(parameters);
        self.watch = StepSampler::of(self.inner.system(), parameters);
        self.log_state();
        self.observe()
    }

    /// Begins at a state of its clock in which the motion was already, with these constraints released and, if steps are
    /// fixed, with this step.
    pub(super) fn begin_turned(
        &mut self,
        state: &State,
        step: f64,
        released: &[usize],
    ) -> Result<(), MotionError> {
        self.log.clear();
        self.inner.restore_with_step(state, step, (state.time, released))?;
        self.watch.pending = false;
        self.take_observer();
        self.log_state();
        self.observe()
    }

    pub(super) fn residuals(&self) -> &[[f64; 2]] {
        &self.residuals
    }

    /// Continues from a state at the current time.
    pub(super) fn continue_from(
        &mut self,
        state: &State,
        parameters: &[f64],
    ) -> Result<(), MotionError> {
        self.log.clear();
        self.inner.continue_from(state, parameters)?;
        self.watch.pending = false;
        self.log_state();
        self.observer.set_parameters(parameters);
        self.watch.set_parameters(parameters);
        self.observe()
    }

    /// Logs the current state, from which the next step begins.
    pub(super) fn log_state(&mut self) {
        let (steps, step) = (self.inner.steps(), self.inner.step_size().abs());
        self.log.push(self.inner.state(), steps, step);
    }

    pub(super) fn impulses(&self) -> u64 {
        self.log.impulses()
    }

    /// Applies an impulse now.
    pub(super) fn apply_impulse(&mut self, impulse: usize) -> Result<Occurrence, MotionError> {
        let occurrence = self.inner.apply_impulse_now(impulse)?;
        self.record(&occurrence)?;
        Ok(occurrence)
    }

    fn record(&mut self, occurrence: &Occurrence) -> Result<(), MotionError> {
        match occurrence.kind {
            OccurrenceKind::Release(_) => {
                self.take_observer();
                self.log.clear();
                self.log_state();
            }
            OccurrenceKind::Impulse { .. } => {
                self.log.note_impulse();
                self.log_state();
            }
            OccurrenceKind::StepInTime => self.log_state(),
            OccurrenceKind::Mark | OccurrenceKind::Crossing(_) | OccurrenceKind::Stop => {}
        }
        self.observe()
    }

    /// Makes an observer with the currently active constraints.
    pub(super) fn take_observer(&mut self) {
        let parameters = self.observer.parameters().to_vec();
        self.observer = self.inner.system().observer(&parameters);
    }

    /// Advances to the end of what was computed before an error.
    pub(super) fn reach_end(&mut self) -> Result<(), MotionError> {
        self.inner.reach_computed()?;
        self.observe()
    }

    pub(super) fn observe(&mut self) -> Result<(), MotionError> {
        self.residuals = self.inner.residuals();
        if self.active_set_changes != self.inner.active_set_changes() {
            self.active_set_changes = self.inner.active_set_changes();
            self.take_observer();
        }
        let outcome = self.observer.observe(self.inner.state(), &mut self.values);
        mark_lost(&mut self.lost, &self.values);
        outcome.map_err(|error| self.inner.explained(error))
    }

    /// The current values but for those of channels that had none at some state since this was last asked: a row that
    /// parts what lies before it from what comes. `None` if no channel has a value again.
    pub(super) fn parting(&mut self) -> Option<Vec<f64>> {
        let mut gaps = None;
        for (k, lost) in self.lost.iter_mut().enumerate() {
            if std::mem::take(lost) && !self.values[k].is_nan() {
                gaps.get_or_insert_with(|| self.values.clone())[k] = f64::NAN;
            }
        }
        gaps
    }

    pub(super) fn dated(&self, error: MotionError) -> MotionError {
        MotionError { time: self.sign * error.time, ..error }
    }

    /// The value of every channel just before the last impulse.
    pub(super) fn values_before(&mut self) -> Result<Vec<f64>, MotionError> {
        let mut values = vec![f64::NAN; self.values.len()];
        self.observer.observe(self.inner.before(), &mut values)?;
        Ok(values)
    }
}

/// Marks the channels that have no value.
fn mark_lost(lost: &mut [bool], values: &[f64]) {
    for (lost, value) in lost.iter_mut().zip(values) {
        *lost |= value.is_nan();
    }
}

impl ObservedMotion {
    pub(super) fn whole(&self) -> &System {
        self.inner.whole()
    }

    pub(super) fn system(&self) -> &System {
        self.inner.system()
    }

    pub(super) fn method(&self) -> &'static Method {
        self.inner.method()
    }

    pub(super) fn settings(&self) -> Settings {
        self.inner.settings()
    }

    /// The tolerance in use, if the method has one.
    pub(super) fn tolerance(&self) -> Option<f64> {
        self.inner.tolerance()
    }

    /// Where the fixed step was found to be beyond the stability limit, if it was.
    pub(super) fn unstable(&self) -> Option<Unstable> {
        self.inner.unstable()
    }

    /// −1 if the motion runs backwards, otherwise 1.
    pub(super) fn sign(&self) -> f64 {
        self.sign
    }

    pub(super) fn time(&self) -> f64 {
        self.sign * self.clock()
    }

    /// The time, or −t if the motion runs backwards: it never decreases along the way.
    pub(super) fn clock(&self) -> f64 {
        self.state().time
    }

    /// The current state, at its time.
    pub(super) fn dated_state(&self) -> State {
        let mut state = self.state().clone();
        (state.time, state.time_carry) = (self.sign * state.time, self.sign * state.time_carry);
        state
    }

    /// The current state, whose time is the clock.
    pub(super) fn state(&self) -> &State {
        self.inner.state()
    }

    /// The current value of every channel.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    pub(super) fn steps(&self) -> u64 {
        self.inner.steps()
    }

    /// The clock at the end of the last step; that of the current state may lie before it.
    pub(super) fn computed(&self) -> f64 {
        self.inner.computed().time
    }

    pub(super) fn set_steps(&mut self, steps: u64) {
        self.inner.set_steps(steps);
    }

    /// Discards the motion until it [begins](ObservedMotion::begin) again; its clock is at `time`.
    pub(super) fn forget(&mut self, time: f64) {
        self.values.fill(f64::NAN);
        self.inner.forget(time);
    }

    pub(super) fn has_begun(&self) -> bool {
        !self.state().values.is_empty()
    }

    /// Evaluates the terms of the conserved quantities in the current state.
    pub(super) fn observe_terms(&mut self) {
        self.watch.terms.observe(self.inner.state());
    }

    /// The values that the gauges read, once the terms have been [evaluated](ObservedMotion::observe_terms).
    pub(super) fn present<'a>(&'a self, constants: &'a Valuation) -> GaugeInputs<'a> {
        let action = self.state().values.get(self.system().driven_len());
        GaugeInputs {
            time: self.time(),
            steps: self.steps(),
            errors: match self.method().preserves {
                Preserves::Nothing => Errors::Accumulated,
                Preserves::Symplectic | Preserves::SymplecticReversible => Errors::OfState,
            },
            values: &self.values,
            residuals: &self.residuals,
            terms: &self.watch.terms,
            system: self.system(),
            action: action.copied().unwrap_or(f64::NAN),
            constants,
        }
    }

    /// How often a singular configuration of the constraints was passed, and when first.
    pub(super) fn singular_passages(&self) -> (u64, Option<f64>) {
        self.inner.singular_passages()
    }

    /// The first singular configuration that the comparison motion passed: when, and its coordinates there.
    pub(super) fn comparison_passage(&self) -> Option<(f64, Vec<(String, f64)>)> {
        self.inner.comparison_passage()
    }

    /// The first event whose impulse did not turn the motion back, and when.
    pub(super) fn passed_event(&self) -> Option<(&str, f64)> {
        self.inner.passed_event()
    }

    /// The events whose functions are zero all along but for rounding, and since when.
    pub(super) fn vanishing_events(&self) -> impl Iterator<Item = (&str, f64)> {
        self.inner.vanishing_events()
    }

    /// The first step that has passed a narrow place of the law.
    pub(super) fn narrow_passage(&self) -> Option<NarrowPassage> {
        self.inner.narrow_passage()
    }

    pub(super) fn step_size(&self) -> f64 {
        self.inner.step_size()
    }
}
