//! What each command does to an experiment, and what is reported to the user.
//!
//! A parameter that jumps preserves q and p, not q̇ (L jumps, ∂L/∂q̇ does not): *The Principles of
//! Dynamics*, § 1.3.3 with no impulse.

use std::sync::Arc;

use super::companion_motion::CompanionChange;
use super::gauges::Gauges;
use super::last_change::LastChange;
use super::setup::{choose_method, with_override};
use super::{Command, Experiment, FoundConstant, MethodNotFound};
use crate::integrate::{Method, Settings, Stepping};
use crate::num::short;
use crate::system::{self, ChannelKind, Form, State};

/// A frame on the screen, in seconds.
pub(super) const FRAME: f64 = 1.0 / 60.0;

/// The most integrator steps for one single step by the user.
const SINGLE_STEP_BUDGET: u64 = 20_000;

impl Experiment {
    /// Executes a command. A command that cannot be executed is reported in a notice.
    pub fn execute(&mut self, command: Command) {
        if self.scrubs(&command) {
            return;
        }
        match command {
            Command::ScrubTo(time) => self.scrub_to(time),
            Command::Reverse => self.reverse(),
            Command::Play => self.run.running = true,
            Command::Pause => self.run.running = false,
            Command::Step(count) => self.step(count),
            Command::StepBack(count) => self.step_back(count),
            Command::Speed(speed) if speed > 0.0 => self.setup.speed = speed,
            Command::Speed(speed) => {
                self.notify(format!("a speed must be above zero; {speed} is not"));
            }
            Command::Parameter { index, value } => {
                self.changes.end_jump();
                self.change_parameter(index, value);
            }
            Command::MoveParameter { index, value } => self.change_parameter(index, value),
            Command::Initial { index, value } => self.change_initial(index, value),
            Command::Start(overrides) => {
                self.setup.overrides = overrides;
                self.restart();
            }
            Command::ApplyImpulse(index) => self.apply_impulse(index),
            Command::Reset => self.restart(),
            Command::FullReset => {
                self.setup.parameters = self.model.parameter_values();
                self.setup.overrides.clear();
                self.restart();
            }
            Command::Method(name) => self.take_method(&name, self.motion.settings()),
            Command::StepSize(step) => self.change_step(step),
            Command::Tolerance(tolerance) => self.change_tolerance(tolerance),
            Command::Restore(checkpoint) => self.restore(&checkpoint),
            Command::Follow(found) => self.follow(&found),
            Command::ForgetCrossings => {
                self.log.crossings.clear();
                self.companions.forget_crossings();
            }
            Command::AddStart(given) => self.add_start(given),
            Command::AddNeighbour => self.add_neighbour(),
            Command::Pin => self.pin(),
            Command::ClearCompanions => {
                self.companions.clear();
                self.reversal.echo = None;
            }
            Command::Settings(settings) => self.change_method(self.motion.method(), settings),
            Command::Reference => {
                self.gauge(Gauges::refer);
                self.notify(format!("the gauges measure from t = {}", short(self.time())));
            }
        }
    }

    /// Adds a notice for the user.
    pub fn notify(&mut self, notice: String) {
        self.notices.push(notice);
    }

    fn follow(&mut self, found: &[FoundConstant]) {
        self.gauges.follow(found, &self.model);
        if self.motion.has_begun() {
            self.gauge(Gauges::refer_found);
        }
    }

    fn apply_impulse(&mut self, index: usize) {
        let known = index < self.system().discontinuities().impulses.len();
        if !known
            || !self.motion.has_begun()
            || self.run.error.is_some()
            || self.run.ended.is_some()
        {
            return;
        }
        match self.motion.apply_impulse(index).and_then(|occurrence| self.note(occurrence)) {
            Ok(sentence) => {
                self.changed_here("the momentum".to_owned());
                self.notify(sentence);
            }
            Err(error) => self.run.error = Some(self.motion.dated(error).into()),
        }
    }

    fn step(&mut self, count: u32) {
        self.run.running = false;
        let speed =
            if self.setup.speed.is_finite() { self.setup.speed } else { self.model.run.speed };
        let time = self.clock() + f64::from(count) * FRAME * speed;
        self.advance(time, SINGLE_STEP_BUDGET);
    }

    fn change_parameter(&mut self, index: usize, value: f64) {
        let Some(parameter) = self.model.parameters.get(index) else { return };
        let name = parameter.shown.clone();
        if !value.is_finite() {
            return self.notify(format!("{name} cannot be {value}"));
        }
        let old = self.setup.parameters.clone();
        self.setup.parameters[index] = value;
        // what crossed before belongs to another system, and so does the run before time was reversed
        self.log.crossings.clear();
        self.reversal.echo = None;
        if !self.motion.has_begun() {
            return self.restart();
        }
        let initial = self.initial_state();
        self.show_initial(initial.as_ref().ok());
        let before = self.energy();
        let new = &self.setup.parameters;
        let state = self.system().change_parameters(self.motion.state(), &old, new);
        self.continue_from(state);
        // at the start it may be the motion of the file with this value
        self.changed_unless_at(initial.ok().as_ref(), name.clone());
        self.pass(&CompanionChange::Parameters(self.setup.parameters.clone()));
        self.gauge(Gauges::refer);
        let jump = self.energy() - before;
        self.report_jump(index, jump, 1e-12 * before.abs());
    }

    /// From here on the motion follows another law, unless it still stands in its first state.
    fn changed_unless_at(&mut self, first: Option<&State>, what: String) {
        let (state, moving) = (self.motion.state(), ..self.system().moving());
        let is_start = first.is_some_and(|first| {
            first.time == state.time
                && first.form == state.form
                && first.values[moving] == state.values[moving]
        });
        if is_start { self.changes.last = None } else { self.changed_here(what) }
    }

    /// From its current state on the motion follows another law, or continues from another state.
    pub(super) fn changed_here(&mut self, what: String) {
        let state = Arc::new(self.motion.dated_state());
        self.changes.last = Some(Arc::new(LastChange { what, state }));
    }

    /// Reports a jump in energy beyond its rounding, and what did not jump. The steps in which a parameter is changed
    /// are one jump.
    fn report_jump(&mut self, index: usize, jump: f64, rounding: f64) {
        let by = self.changes.add_jump(index, jump);
        let lead = format!("{}: energy jumped by", self.model.parameters[index].shown);
        self.notices.withdraw(&lead);
        if by.abs() <= rounding {
            return;
        }
        let sign = if by < 0.0 { '−' } else { '+' };
        let by = short(by.abs());
        let unchanged = match self.motion.state().form {
            Form::Variables => "the state",
            Form::Velocity | Form::Momentum => "q and p",
        };
        self.notify(format!("{lead} {sign}{by}; {unchanged} kept; press r to restart"));
    }

    fn energy(&self) -> f64 {
        self.energy_of(self.motion.values())
    }

    pub(super) fn energy_of(&self, values: &[f64]) -> f64 {
        let kinds = self.system().channels().iter().map(|c| c.kind);
        let place = kinds.into_iter().position(|kind| kind == ChannelKind::Energy);
        place.map_or(f64::NAN, |i| values[i])
    }

    /// Σ |p q̇| among the values of all channels: the size of the energy's terms, however near to zero their sum is.
    pub(super) fn motion_of(&self, values: &[f64]) -> f64 {
        let channels = self.system().channels();
        let value = |kind| channels.iter().position(|c| c.kind == kind).map(|i| values[i]);
        let product = |i| {
            let (p, v) = (ChannelKind::Momentum(i), ChannelKind::Velocity(i));
            value(p).zip(value(v)).map_or(0.0, |(p, v)| (p * v).abs())
        };
        (0..self.system().moving()).map(product).sum()
    }

    fn change_initial(&mut self, index: usize, value: f64) {
        if index >= self.system().moving() || !value.is_finite() {
            return self.notify(format!("an initial value cannot be {value}"));
        }
        self.setup.overrides = with_override(self.system(), &self.setup.overrides, index, value);
        self.restart();
    }

    fn change_step(&mut self, step: f64) {
        if !(step > 0.0 && step.is_finite()) {
            return self.notify(format!("a step must be above zero; {step} is not"));
        }
        if self.motion.method().stepping == Stepping::Adaptive {
            let name = self.motion.method().name;
            return self
                .notify(format!("{name} chooses its steps itself; its tolerance can be set"));
        }
        let settings = Settings { step: Some(step), ..self.motion.settings() };
        self.change_method(self.motion.method(), settings);
    }

    fn change_tolerance(&mut self, tolerance: f64) {
        if !(tolerance > 0.0 && tolerance < 1.0) {
            return self
                .notify(format!("a tolerance must lie between 0 and 1; {tolerance} does not"));
        }
        if self.motion.method().stepping == Stepping::Fixed {
            let name = self.motion.method().name;
            return self.notify(format!("{name} has no tolerance; its step can be set"));
        }
        let settings = Settings { tolerance: Some(tolerance), ..self.motion.settings() };
        self.change_method(self.motion.method(), settings);
    }

    /// Selects a method by name, or reports why it cannot be used.
    pub(super) fn take_method(&mut self, name: &str, settings: Settings) {
        match choose_method(self.system(), name) {
            Ok(method) => self.change_method(method, settings),
            Err(why) => self.notify(why.to_string()),
        }
    }

    /// Continues from the current state with another method. The gauges take a new reference,
    /// because earlier drift is not due to the new method.
    fn change_method(&mut self, method: &'static Method, settings: Settings) {
        let is_same =
            (self.motion.method().name, self.motion.settings()) == (method.name, settings);
        if let Err(error) = self.motion.change_method(method, settings) {
            return self.notify(MethodNotFound::from(error).to_string());
        }
        self.setup.settings = settings;
        method.name.clone_into(&mut self.setup.method);
        if !self.motion.has_begun() {
            return self.restart();
        }
        self.continue_from(Ok(self.motion.state().clone()));
        // where the law was changed at this very time, that is what is said of it
        let time = self.motion.state().time;
        let is_known = self.changes.last.as_ref().is_some_and(|last| last.state.time == time);
        if !is_same && !is_known {
            let initial = self.initial_state();
            self.changed_unless_at(initial.ok().as_ref(), "the method".to_owned());
        }
        self.pass(&CompanionChange::Method(self.motion.method(), self.motion.settings()));
        self.gauge(Gauges::refer);
    }

    /// Continues from a state, or fails if there is none.
    fn continue_from(&mut self, state: Result<State, system::MotionError>) {
        let begun =
            state.and_then(|state| self.motion.continue_from(&state, &self.setup.parameters));
        self.run.error = begun.err().map(|error| self.motion.dated(error).into());
    }
}
