//! A motion with all that happens to it: steps, constraints that are kept, blows at their times,
//! events where they are found.
//!
//! In: a system, a method, a state. Out: states at the times asked for, and [`Happening`]s. Never
//! here: rows, gauges, what can be seen of a state.

mod happening;
mod watch;

use super::calendar::Calendar;
use super::crossing::{Crossings, Found};
use super::haste::Haste;
use super::{Method, Refusal, Settings, Stepper, Unstable};
use crate::expr::Double;
use crate::system::{Branch, Fault, FaultKind, Form, Keeper, State, System};
pub use happening::{Happening, Kind};
use watch::Watch;

/// How far a motion came.
#[derive(Clone, PartialEq, Debug)]
pub enum Reached {
    /// To the time asked for.
    There,
    /// Not so far: the steps allowed were taken.
    Underway,
    /// To something that happened on the way; the state is the one after it.
    Happened(Happening),
    /// Not so far: an event has ended the motion.
    Ended,
}

/// A motion under way.
pub struct Motion {
    /// As compiled, with all its constraints.
    whole: System,
    /// With those that still hold.
    system: System,
    method: &'static Method,
    settings: Settings,
    stepper: Box<dyn Stepper>,
    keeper: Option<Keeper>,
    crossings: Option<Crossings>,
    calendar: Calendar,
    parameters: Vec<f64>,
    start: f64,
    /// The present.
    state: State,
    /// The state before the last blow.
    before: State,
    /// Where the motion last went on from, in the system's own form: velocities that momenta alone
    /// do not tell are looked for near it.
    near: State,
    /// Up to here the last step holds no event that is not known.
    clear: f64,
    /// How many steps in a row did not move the clock.
    stalled: u32,
    /// What happens there.
    waiting: Option<Found>,
    /// Of each event.
    haste: Vec<Haste>,
    watch: Watch,
    /// Where velocities are one of several that belong to the momenta: what tells their branch.
    branch: Option<Branch>,
    /// How often other constraints were held of those that repeat each other.
    holdings: u64,
    ended: bool,
    steps: u64,
}

impl Motion {
    /// A motion that has yet to [begin](Motion::begin).
    ///
    /// # Errors
    /// Where the method does not fit the system.
    pub fn new(
        system: &System,
        method: &'static Method,
        settings: Settings,
        parameters: &[f64],
    ) -> Result<Motion, Refusal> {
        let stepper = (method.make)(system, &settings)?;
        let blank = State::new(0.0, system.form(), Vec::new());
        let mut motion = Motion {
            whole: system.clone(),
            system: system.clone(),
            method,
            settings,
            stepper,
            keeper: None,
            crossings: None,
            calendar: Calendar::default(),
            parameters: parameters.to_vec(),
            start: 0.0,
            state: blank.clone(),
            before: blank.clone(),
            near: blank,
            clear: 0.0,
            waiting: None,
            stalled: 0,
            haste: vec![Haste::NONE; system.occasions().events.len()],
            watch: Watch::default(),
            branch: None,
            holdings: 0,
            ended: false,
            steps: 0,
        };
        motion.take_system();
        Ok(motion)
    }

    /// Takes what depends on which constraints hold anew.
    fn take_system(&mut self) {
        self.keeper = self.system.keeper(&self.parameters);
        let triggers = self.system.triggers(&self.parameters);
        let directions = self.system.occasions().events.iter().map(|e| e.direction).collect();
        let blank = State::new(0.0, self.system.form(), Vec::new());
        self.crossings = triggers.map(|t| Crossings::new(t, directions, blank));
        self.calendar.reschedule(self.system.schedule(&self.parameters));
    }

    /// Begins anew at a state: with all constraints, and no event behind it.
    ///
    /// # Errors
    /// Where the motion cannot begin there.
    pub fn begin(&mut self, state: &State, parameters: &[f64]) -> Result<(), Fault> {
        self.system.check_intervals(parameters, state.time)?;
        self.start = state.time;
        self.ended = false;
        self.forget_passages();
        self.calendar.begin(state.time);
        self.haste.fill(Haste::NONE);
        self.parameters = parameters.to_vec();
        self.system = self.whole.hold_all(state, parameters);
        // a step asked for was taken before, so the method still fits
        if let Ok(stepper) = (self.method.make)(&self.system, &self.settings) {
            self.stepper = stepper;
        }
        self.take_system();
        self.resume(state)?;
        self.system.check_energy(&self.own()?, parameters)
    }

    /// Goes on from another state at the present time, or with other parameters: constraints that
    /// were let go stay so.
    ///
    /// # Errors
    /// Where the motion cannot go on from there.
    pub fn go_on(&mut self, state: &State, parameters: &[f64]) -> Result<(), Fault> {
        if parameters != self.parameters {
            self.system.check_intervals(parameters, state.time)?;
            self.parameters = parameters.to_vec();
            self.calendar.reschedule(self.system.schedule(parameters));
            if let Some(keeper) = &mut self.keeper {
                keeper.set_parameters(parameters);
            }
            if let Some(crossings) = &mut self.crossings {
                crossings.set_parameters(parameters);
                crossings.forget();
            }
        }
        self.resume(state)
    }

    /// Takes up a motion that began at `start` and was left at this state, with these constraints
    /// let go and all that happens at its time behind it. The state stays as it is, to the last
    /// bit, if it has the form that the method works in.
    ///
    /// # Errors
    /// Where the motion cannot go on from there.
    pub fn take_up(
        &mut self,
        state: &State,
        parameters: &[f64],
        start: f64,
        released: &[usize],
    ) -> Result<(), Fault> {
        self.begin(state, parameters)?;
        for &constraint in released {
            let own = self.own()?;
            self.release(constraint, &own)?;
        }
        self.start = start;
        self.calendar.begin(start);
        self.calendar.pass(state.time);
        self.state.copy_from(state);
        self.stepper.start(state, &self.parameters)
    }

    /// Takes another method or other settings, and goes on from the present state by it.
    ///
    /// # Errors
    /// Where the method does not fit the system; all stays as it was.
    pub fn change_method(
        &mut self,
        method: &'static Method,
        settings: Settings,
    ) -> Result<(), Refusal> {
        self.stepper = (method.make)(&self.system, &settings)?;
        self.method = method;
        self.settings = settings;
        Ok(())
    }

    fn resume(&mut self, state: &State) -> Result<(), Fault> {
        if state.form == self.system.form() {
            self.state.copy_from(state);
        } else {
            self.state = self.to_own(state)?;
        }
        self.near.copy_from(&self.state);
        self.clear = state.time;
        self.waiting = None;
        if let Some(crossings) = &mut self.crossings {
            crossings.turn();
        }
        self.watch_from_here();
        self.branch = self.system.branch(&self.state, &self.parameters);
        self.stepper.start(&self.state, &self.parameters)
    }

    /// A fault where a step has led to velocities on another branch: p = ∂L/∂q̇ turns back between.
    fn check_branch(&mut self) -> Result<(), Fault> {
        let Some(branch) = &mut self.branch else { return Ok(()) };
        if branch.holds(self.stepper.state()) {
            return Ok(());
        }
        let (begin, _) = self.stepper.interval();
        let state = self.stepper.state();
        Err(self.system.fault(FaultKind::BranchLeft, begin, &state.values))
    }

    /// Where constraints repeat each other, those are held that depend on each other least.
    fn hold_anew(&mut self) -> Result<(), Fault> {
        let state = self.stepper.state();
        let Some(system) = self.system.hold_better(state, &self.parameters) else { return Ok(()) };
        let state = state.clone();
        self.holdings += 1;
        self.take_holding(system, &state)
    }

    /// Moves the present on to `time`, in at most `budget` steps (which are taken off it), or to
    /// what happens before. No step reaches beyond `limit`, unless the method's step is fixed. What
    /// happens at `time` itself has happened when it is reached.
    ///
    /// # Errors
    /// Where the motion cannot go on.
    pub fn reach(&mut self, time: f64, limit: f64, budget: &mut u64) -> Result<Reached, Fault> {
        self.go_to(time, limit, budget).map_err(|fault| self.explained(fault))
    }

    fn go_to(&mut self, time: f64, limit: f64, budget: &mut u64) -> Result<Reached, Fault> {
        loop {
            if self.ended {
                return Ok(Reached::Ended);
            }
            if self.clear <= time {
                let due = self.calendar.due(self.clear);
                if self.waiting.is_some() || due.is_some() {
                    // what happens may happen without end
                    if *budget == 0 {
                        return Ok(Reached::Underway);
                    }
                    *budget -= 1;
                    self.note_passages(self.clear);
                }
                if let Some(found) = self.waiting.take() {
                    return self.meet(found).map(Reached::Happened);
                }
                if let Some(impulse) = due {
                    return self.fall(impulse).map(Reached::Happened);
                }
            }
            if self.clear >= time {
                self.look(time)?;
                self.note_passages(time);
                return Ok(Reached::There);
            }
            if *budget == 0 {
                return Ok(Reached::Underway);
            }
            *budget -= 1;
            if self.stepper.time() <= self.clear
                && let Err(fault) = self.step(limit)
            {
                self.note_passages(self.clear);
                return Err(fault);
            }
            self.scan()?;
        }
    }

    fn step(&mut self, limit: f64) -> Result<(), Fault> {
        let limit = self.calendar.next(self.clear).map_or(limit, |blow| blow.min(limit));
        let before = self.stepper.state().exact_time();
        if self.calendar.stands_still(before.high) {
            return Err(stands_still(before.high));
        }
        self.note_regular();
        self.hold_anew()?;
        self.stepper.step(limit)?;
        let moved = (self.stepper.state().exact_time() - before).high > 0.0;
        self.stalled = if moved { 0 } else { self.stalled + 1 };
        if self.stalled > MOST_STALLED {
            return Err(stands_still(before.high));
        }
        self.steps += 1;
        self.check_branch()?;
        if self.keeper.is_some() || self.system.attitude_place().is_some() {
            self.before.copy_from(self.stepper.state());
            if let Some(keeper) = &mut self.keeper {
                keeper.project(&mut self.before)?;
            }
            self.system.orthonormalise(&mut self.before);
            self.stepper.settle(&self.before);
            self.watch_step();
        }
        Ok(())
    }

    /// Looks for events in what was computed beyond `clear`, up to the next blow, as far as the
    /// functions are simple.
    fn scan(&mut self) -> Result<(), Fault> {
        let end = self.stepper.time();
        let mut end = self.calendar.next(self.clear).map_or(end, |blow| blow.min(end));
        if let Some(crossings) = &mut self.crossings {
            end = crossings.stretch(self.stepper.as_mut(), self.clear, end)?;
            self.waiting = crossings.first(self.stepper.as_mut(), self.clear, end)?;
        }
        self.clear = self.waiting.map_or(end, |found| found.exact.high);
        Ok(())
    }

    /// The present becomes the state at a time within the last step.
    fn look(&mut self, time: f64) -> Result<(), Fault> {
        let (begin, end) = self.stepper.interval();
        if time == end || begin == end {
            self.state.copy_from(self.stepper.state());
        } else {
            self.stepper.at(time, &mut self.state)?;
            if let (Some(keeper), Form::Velocity) = (&mut self.keeper, self.state.form) {
                keeper.project(&mut self.state)?;
            }
        }
        Ok(())
    }

    /// The present becomes the state at a time of something that happens, known beyond the last
    /// digit of an `f64`.
    fn look_exactly(&mut self, time: Double) -> Result<(), Fault> {
        let (begin, end) = self.stepper.interval();
        if begin == end {
            self.state.copy_from(self.stepper.state());
            return Ok(());
        }
        self.stepper.at_exactly(time, &mut self.state)?;
        if let (Some(keeper), Form::Velocity) = (&mut self.keeper, self.state.form) {
            keeper.project(&mut self.state)?;
        }
        Ok(())
    }

    /// The present in the system's own form.
    fn own(&self) -> Result<State, Fault> {
        self.to_own(&self.state)
    }

    fn to_own(&self, state: &State) -> Result<State, Fault> {
        if self.near.values.is_empty() {
            self.system.convert(state, self.system.form(), &self.parameters)
        } else {
            self.system.convert_near(state, &self.near, &self.parameters)
        }
    }
}

/// A step on a kink may only choose a side, or find that the motion is at rest; so many in a row lead nowhere.
const MOST_STALLED: u32 = 128;

/// The clock has no digits left for what is to come.
fn stands_still(time: f64) -> Fault {
    let kind = FaultKind::ClockStands(super::clock::spacing(time));
    Fault { time, kind, place: Vec::new() }
}

/// What can be asked of it.
impl Motion {
    /// The system with all its constraints.
    pub fn whole(&self) -> &System {
        &self.whole
    }

    /// The system, without the constraints that were let go.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// How often the [system](Motion::system) has come to hold others of constraints that repeat
    /// each other: who looks at its states looks anew then.
    pub fn holdings(&self) -> u64 {
        self.holdings
    }

    /// The method.
    pub fn method(&self) -> &'static Method {
        self.method
    }

    /// Its step or tolerance.
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// The present state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The state just before the last blow or release.
    pub fn before(&self) -> &State {
        &self.before
    }

    /// The state at the end of the last step; the present may lie before it.
    pub fn computed(&self) -> &State {
        self.stepper.state()
    }

    /// The part of the last step in which nothing happens.
    pub fn undisturbed(&self) -> (f64, f64) {
        let (begin, end) = self.stepper.interval();
        (begin, end.min(self.clear))
    }

    /// The state at a time within the last step, as the method tells it: not put back on constraints.
    ///
    /// # Errors
    /// Where it cannot be told.
    pub fn inside(&mut self, time: f64, out: &mut State) -> Result<(), Fault> {
        self.stepper.at(time, out)
    }

    /// Moves the present to the end of what was computed.
    ///
    /// # Errors
    /// Where it cannot be told.
    pub fn reach_computed(&mut self) -> Result<(), Fault> {
        self.look(self.clear)
    }

    /// The steps taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The step last taken.
    pub fn step_size(&self) -> f64 {
        self.stepper.step_size()
    }

    /// Where the method's fixed step was found to lie beyond its stability, if it was.
    pub fn unstable(&self) -> Option<Unstable> {
        self.stepper.unstable()
    }

    /// How far the present is from keeping each constraint: position and velocity, measured by the
    /// size of their terms.
    pub fn residuals(&mut self) -> Vec<[f64; 2]> {
        match (&mut self.keeper, self.state.form) {
            (Some(keeper), Form::Velocity) => keeper.residuals(&self.state),
            _ => Vec::new(),
        }
    }

    /// Counts on from so many steps.
    pub fn set_steps(&mut self, steps: u64) {
        self.steps = steps;
    }

    /// Forgets the count of steps; the clock shows `time`.
    pub fn forget(&mut self, time: f64) {
        self.steps = 0;
        self.state = State::new(time, self.system.form(), Vec::new());
    }
}
