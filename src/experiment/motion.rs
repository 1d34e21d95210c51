//! A motion and what is seen of it: the stepper runs ahead by whole steps, the present follows at
//! the times asked for.
//!
//! In: a state, parameters, times. Out: the state and every channel's value at the present. Never
//! here: rows, gauges, commands.

use super::gauges::Present;
use crate::expr::Symbol;
use crate::integrate::{Method, Refusal, Settings, Stepper};
use crate::system::{Fault, Keeper, Observer, State, System};

/// A motion under way.
pub(super) struct Motion {
    system: System,
    method: &'static Method,
    settings: Settings,
    stepper: Box<dyn Stepper>,
    observer: Observer,
    /// Puts states back on the constraints, where there are any.
    keeper: Option<Keeper>,
    state: State,
    values: Vec<f64>,
    steps: u64,
}

impl Motion {
    /// A motion that has yet to [begin](Motion::begin).
    pub(super) fn new(
        system: &System,
        method: &'static Method,
        settings: Settings,
        parameters: &[f64],
    ) -> Result<Motion, Refusal> {
        let stepper = (method.make)(system, &settings)?;
        let state = State::new(0.0, system.form(), Vec::new());
        let values = vec![f64::NAN; system.channels().len()];
        let observer = system.observer(parameters);
        let keeper = system.keeper(parameters);
        let system = system.clone();
        Ok(Motion { system, method, settings, stepper, observer, keeper, state, values, steps: 0 })
    }

    /// Takes another method or other settings; the motion has then to [begin](Motion::begin) anew
    /// from its state.
    pub(super) fn change_method(
        &mut self,
        method: &'static Method,
        settings: Settings,
    ) -> Result<(), Refusal> {
        self.stepper = (method.make)(&self.system, &settings)?;
        self.method = method;
        self.settings = settings;
        Ok(())
    }

    /// Begins at a state.
    pub(super) fn begin(&mut self, state: &State, parameters: &[f64]) -> Result<(), Fault> {
        self.state = state.clone();
        self.observer.set_parameters(parameters);
        if let Some(keeper) = &mut self.keeper {
            keeper.set_parameters(parameters);
        }
        self.observer.observe(&self.state, &mut self.values)?;
        self.stepper.start(state, parameters)
    }

    /// Moves the present on to `time`, in at most `budget` steps (which are taken off it). `false`
    /// where they did not suffice; the present then stays. No step reaches beyond `limit`, unless
    /// the method's step is fixed.
    pub(super) fn reach(&mut self, time: f64, limit: f64, budget: &mut u64) -> Result<bool, Fault> {
        while self.stepper.time() < time {
            if *budget == 0 {
                return Ok(false);
            }
            *budget -= 1;
            self.stepper.step(limit)?;
            self.steps += 1;
            if let Some(keeper) = &mut self.keeper {
                self.state.copy_from(self.stepper.state());
                keeper.project(&mut self.state)?;
                self.stepper.settle(&self.state);
            }
        }
        self.look(time)?;
        Ok(true)
    }

    /// Moves the present to the end of what was computed before a fault.
    pub(super) fn reach_end(&mut self) -> Result<(), Fault> {
        self.look(self.stepper.time())
    }

    fn look(&mut self, time: f64) -> Result<(), Fault> {
        let (begin, end) = self.stepper.interval();
        if time == end || begin == end {
            self.state.copy_from(self.stepper.state());
        } else {
            self.stepper.at(time, &mut self.state)?;
            if let Some(keeper) = &mut self.keeper {
                keeper.project(&mut self.state)?;
            }
        }
        self.observer.observe(&self.state, &mut self.values)
    }
}

/// What can be asked of it.
impl Motion {
    pub(super) fn system(&self) -> &System {
        &self.system
    }

    pub(super) fn method(&self) -> &'static Method {
        self.method
    }

    pub(super) fn settings(&self) -> Settings {
        self.settings
    }

    /// The present time.
    pub(super) fn time(&self) -> f64 {
        self.state.time
    }

    /// The present state.
    pub(super) fn state(&self) -> &State {
        &self.state
    }

    /// Every channel's present value.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    pub(super) fn steps(&self) -> u64 {
        self.steps
    }

    /// Forgets what was, until it [begins](Motion::begin); the clock shows `time`.
    pub(super) fn forget(&mut self, time: f64) {
        self.steps = 0;
        self.values.fill(f64::NAN);
        self.state = State::new(time, self.system.form(), Vec::new());
    }

    /// Whether there is a present.
    pub(super) fn has_begun(&self) -> bool {
        !self.state.values.is_empty()
    }

    /// What the gauges look at.
    pub(super) fn present<'a>(&'a self, parameter: &'a dyn Fn(Symbol) -> f64) -> Present<'a> {
        Present {
            time: self.state.time,
            steps: self.steps,
            values: &self.values,
            action: self.state.values.get(self.system.moving()).copied().unwrap_or(f64::NAN),
            parameter,
        }
    }

    pub(super) fn step_size(&self) -> f64 {
        self.stepper.step_size()
    }
}
