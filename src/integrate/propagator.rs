//! A motion with all its occurrences: steps, constraints, impulses at their times, events where
//! they are located.
//!
//! In: a system, a method, a state. Out: states at the requested times, and [`Occurrence`]s. Never
//! here: rows, gauges, observables of a state.

mod advance;
mod comparison_watch;
mod constraint_watch;
mod corner_watch;
mod domain;
mod narrow_watch;
mod occurrence;
mod occurrence_search;
mod passed_event;
mod passed_event_watch;
mod singular_mass;
mod singularity_record;
mod step_in_time;
mod trial;
mod vanishing_event_watch;

use super::narrow_place::PassedPlaces;
use super::passed_poles::PassedPoles;
use super::{Method, MethodError, Settings, Stepper, Stepping, Unstable};
use crate::num::DoubleDouble;
use crate::system::{ConstraintProjector, Form, MotionError, State, StepsInTime, System};
use domain::MotionDomain;
pub use narrow_watch::{NarrowPassage, NarrowPlace};
pub use occurrence::{Occurrence, OccurrenceKind};
use occurrence_search::OccurrenceSearch;
use passed_event::PassedEvents;
use singularity_record::SingularityRecord;

/// The outcome of advancing a motion.
#[derive(Clone, PartialEq, Debug)]
pub enum Reached {
    /// To the requested time.
    Arrived,
    /// Less far: the step budget was used up.
    OutOfBudget,
    /// To an occurrence on the way; the state is the one after it.
    Occurred(Occurrence),
    /// Less far: an event has ended the motion.
    Ended,
}

/// A motion in progress.
pub struct Propagator {
    /// The system as compiled, with all its constraints.
    whole: System,
    system: System,
    method: &'static Method,
    settings: Settings,
    stepper: Box<dyn Stepper>,
    projector: Option<ConstraintProjector>,
    search: OccurrenceSearch,
    parameters: Vec<f64>,
    state: State,
    /// The state before the last impulse.
    before: State,
    /// The state at which the motion last started or continued, in the system's native form.
    /// Velocities that momenta alone do not determine are searched for near it.
    near: State,
    /// The number of steps in a row that did not advance the time.
    stalled: u32,
    watch: SingularityRecord,
    passed: PassedEvents,
    domain: MotionDomain,
    /// The number of changes of the enforced constraints among redundant ones.
    active_set_changes: u64,
    ended: bool,
    narrow: Option<PassedPlaces>,
    poles: Option<PassedPoles>,
    narrow_passage: Option<NarrowPassage>,
    /// The last impulse, and the event that caused it.
    impulse: Option<(usize, Option<usize>)>,
    steps: u64,
    steps_in_time: Option<StepsInTime>,
    /// The time just after the last step in time of the law, or just after the start at one.
    crossed: Option<DoubleDouble>,
    /// Whether nothing acts on the motion but its law, and nothing is watched.
    is_free: bool,
}

impl Propagator {
    /// Creates a motion that must then [begin](Propagator::begin).
    ///
    /// # Errors
    /// Returns an error if the method does not fit the system.
    pub fn new(
        system: &System,
        method: &'static Method,
        settings: Settings,
        parameters: &[f64],
    ) -> Result<Propagator, MethodError> {
        let stepper = (method.make)(system, &settings)?;
        let blank = State::new(0.0, system.form(), Vec::new());
        let mut motion = Propagator {
            whole: system.clone(),
            system: system.clone(),
            method,
            settings,
            stepper,
            projector: None,
            search: OccurrenceSearch::default(),
            parameters: parameters.to_vec(),
            state: blank.clone(),
            before: blank.clone(),
            near: blank,
            stalled: 0,
            watch: SingularityRecord::default(),
            passed: PassedEvents::default(),
            domain: MotionDomain::default(),
            active_set_changes: 0,
            ended: false,
            narrow: None,
            poles: None,
            narrow_passage: None,
            impulse: None,
            steps: 0,
            steps_in_time: None,
            crossed: None,
            is_free: false,
        };
        motion.take_system();
        Ok(motion)
    }

    /// Updates everything that depends on the enforced constraints.
    fn take_system(&mut self) {
        self.is_free = false;
        self.projector = self.system.projector(&self.parameters);
        self.steps_in_time = self.system.steps_in_time(&self.parameters);
        self.search.take_system(&self.system, &self.parameters);
    }

    /// Begins again at a state, with all constraints and no earlier events.
    ///
    /// # Errors
    /// Returns an error if the motion cannot begin there.
    pub fn begin(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        self.system.check_intervals(parameters, state.time)?;
        self.ended = false;
        self.crossed = None;
        self.forget_passages();
        self.passed = PassedEvents::default();
        self.narrow_passage = None;
        self.search.begin(state.time, self.whole.discontinuities().events.len());
        self.parameters = parameters.to_vec();
        self.system = self.whole.activate_all(state, parameters);
        // a step was requested before, so the method still fits
        if let Ok(stepper) = (self.method.make)(&self.system, &self.settings) {
            self.stepper = stepper;
        }
        self.take_system();
        self.resume(state)?;
        self.system.check_energy(&self.native_state()?, parameters)
    }

    /// Continues from another state at the current time, or with other parameters. Released
    /// constraints stay released.
    ///
    /// # Errors
    /// Returns an error if the motion cannot continue from there.
    pub fn continue_from(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        if parameters != self.parameters {
            self.system.check_intervals(parameters, state.time)?;
            self.parameters = parameters.to_vec();
            self.search.set_parameters(&self.system, parameters);
            self.steps_in_time = self.system.steps_in_time(parameters);
            if let Some(projector) = &mut self.projector {
                projector.set_parameters(parameters);
            }
        }
        self.resume(state)
    }

    /// Restores a motion that began at `start` and was left at this state, with these constraints
    /// released and all occurrences at its time in the past. The state is kept to the last bit if
    /// it has the form that the method works in.
    ///
    /// # Errors
    /// Returns an error if the motion cannot continue from there.
    pub fn restore(
        &mut self,
        state: &State,
        parameters: &[f64],
        start: f64,
        released: &[usize],
    ) -> Result<(), MotionError> {
        self.begin(state, parameters)?;
        for &constraint in released {
            let native_state = self.native_state()?;
            self.release(constraint, &native_state)?;
        }
        self.search.restore(start, state.time);
        // one that was at a step in time is behind it now
        if self.state.exact_time() == state.exact_time() {
            self.state.copy_from(state);
        }
        self.stepper.start(&self.state, &self.parameters)
    }

    /// Restores a motion that began at `start` and was left at this state, with this step if steps are fixed: until the next
    /// impulse, after which a step that was not set is chosen as it always is.
    ///
    /// # Errors
    /// Returns an error if the motion cannot continue from there.
    pub fn restore_with_step(
        &mut self,
        state: &State,
        step: f64,
        (start, released): (f64, &[usize]),
    ) -> Result<(), MotionError> {
        let parameters = self.parameters.clone();
        self.restore_with_step_and_parameters((state, step), &parameters, (start, released))
    }

    /// Restores a motion as [`Propagator::restore_with_step`] does, at these parameters.
    ///
    /// # Errors
    /// Returns an error if the motion cannot continue from there.
    pub fn restore_with_step_and_parameters(
        &mut self,
        (state, step): (&State, f64),
        parameters: &[f64],
        (start, released): (f64, &[usize]),
    ) -> Result<(), MotionError> {
        let settings = self.settings;
        if self.method.stepping == Stepping::Fixed {
            // as if it were set: no other is searched for
            self.settings.step = Some(step);
        }
        let outcome = self.restore(state, parameters, start, released);
        self.settings = settings;
        outcome?;
        if self.method.stepping == Stepping::Fixed && settings.step.is_none() {
            if let Ok(stepper) = (self.method.make)(&self.system, &settings) {
                self.stepper = stepper;
            }
            self.stepper.start_with_step(&self.state, &self.parameters, step)?;
        }
        Ok(())
    }

    /// Changes the method or its settings, and continues from the current state.
    ///
    /// # Errors
    /// Returns an error if the method does not fit the system. The motion is then unchanged.
    pub fn change_method(
        &mut self,
        method: &'static Method,
        settings: Settings,
    ) -> Result<(), MethodError> {
        self.stepper = (method.make)(&self.system, &settings)?;
        self.method = method;
        self.settings = settings;
        Ok(())
    }

    fn resume(&mut self, state: &State) -> Result<(), MotionError> {
        self.is_free = false;
        if state.form == self.system.form() {
            self.state.copy_from(state);
        } else {
            self.state = self.to_native(state)?;
        }
        self.begin_after_step_in_time()?;
        if let (Some(projector), Form::Velocity) = (&mut self.projector, self.state.form) {
            projector.take_levels(&self.state);
        }
        self.near.copy_from(&self.state);
        self.search.continue_from(state.time);
        self.watch_from_here();
        self.domain = MotionDomain::around(&self.system, &self.state, &self.parameters);
        self.stepper.start(&self.state, &self.parameters)?;
        self.watch_narrow_places()?;
        self.find_vanishing_events()?;
        self.is_free = self.finds_nothing_but_law();
        Ok(())
    }

    /// Whether nothing acts on the motion but its law, and nothing is watched.
    fn finds_nothing_but_law(&self) -> bool {
        self.whole.constraints() == 0
            && self.projector.is_none()
            && self.domain.is_unbounded()
            && self.system.attitude_place().is_none()
            && self.search.is_empty()
            && self.narrow.is_none()
            && self.poles.is_none()
    }

    /// The current state in the system's native form.
    fn native_state(&self) -> Result<State, MotionError> {
        self.to_native(&self.state)
    }

    fn to_native(&self, state: &State) -> Result<State, MotionError> {
        if self.near.values.is_empty() || self.system.tangents() > 0 {
            self.system.convert(state, self.system.form(), &self.parameters)
        } else {
            self.system.convert_near(state, &self.near, &self.parameters)
        }
    }
}

impl Propagator {
    /// The system with all its constraints.
    pub fn whole(&self) -> &System {
        &self.whole
    }

    /// The system without the released constraints.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// The number of times the [system](Propagator::system) has changed which of its redundant
    /// constraints it enforces. Observers of its states must be created again when it changes.
    pub fn active_set_changes(&self) -> u64 {
        self.active_set_changes
    }

    /// The row of the table by which steps are taken.
    pub fn method(&self) -> &'static Method {
        self.method
    }

    /// Its step or tolerance.
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// The last impulse by its index, and the event that caused it, if it was one.
    pub fn last_impulse(&self) -> Option<(usize, Option<usize>)> {
        self.impulse
    }

    /// The current state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The state just before the last impulse or release.
    pub fn before(&self) -> &State {
        &self.before
    }

    /// The state at the end of the last step; the current state may lie before it.
    pub fn computed(&self) -> &State {
        self.stepper.state()
    }

    /// The part of the last step that is free of occurrences.
    pub fn undisturbed(&self) -> (f64, f64) {
        let (begin, end) = self.stepper.interval();
        (begin, end.min(self.search.clear))
    }

    /// Whether an event or an impulse is to happen at the end of the part of the last step that is free of occurrences.
    pub fn awaits_occurrence(&self) -> bool {
        self.search.waiting.is_some() || self.search.due().is_some()
    }

    /// Writes the state at a time within the last step into `out`, as the method gives it, that is
    /// not projected onto the constraints.
    ///
    /// # Errors
    /// Returns an error if the state cannot be evaluated.
    pub fn inside(&mut self, time: f64, out: &mut State) -> Result<(), MotionError> {
        self.stepper.at(time, out)
    }

    /// Writes the state at a time within the last step into `out`, as [`Propagator::inside`] does, for a time that need
    /// not be read as a decimal number.
    ///
    /// # Errors
    /// Returns an error if the state cannot be evaluated.
    pub fn anywhere_inside(&mut self, time: f64, out: &mut State) -> Result<(), MotionError> {
        self.stepper.at_exactly(DoubleDouble::from(time), out)
    }

    /// Advances the current state to the end of the last step.
    ///
    /// # Errors
    /// Returns an error if the state cannot be evaluated.
    pub fn reach_computed(&mut self) -> Result<(), MotionError> {
        self.move_to(self.search.clear)
    }

    /// The number of steps taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The size of the last step.
    pub fn step_size(&self) -> f64 {
        self.stepper.step_size()
    }

    /// The tolerance in use, if the method has one.
    pub fn tolerance(&self) -> Option<f64> {
        self.stepper.tolerance()
    }

    /// The instability of the method's fixed step, if one was found.
    pub fn unstable(&self) -> Option<Unstable> {
        self.stepper.unstable()
    }

    /// The residuals of each constraint at the current state, position and velocity, relative to
    /// the size of their terms.
    pub fn residuals(&mut self) -> Vec<[f64; 2]> {
        match (&mut self.projector, self.state.form) {
            (Some(projector), Form::Velocity) => projector.residuals(&self.state),
            _ => Vec::new(),
        }
    }

    /// Sets the number of steps taken.
    pub fn set_steps(&mut self, steps: u64) {
        self.steps = steps;
    }

    /// Resets the number of steps, and replaces the state by an empty one at `time`.
    pub fn forget(&mut self, time: f64) {
        self.steps = 0;
        self.state = State::new(time, self.system.form(), Vec::new());
    }
}
