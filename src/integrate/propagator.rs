//! A motion with all that happens to it: steps, constraints that are kept, impulses at their times,
//! events where they are found.
//!
//! In: a system, a method, a state. Out: states at the times asked for, and [`Occurrence`]s. Never
//! here: rows, gauges, what can be seen of a state.

mod constraint_watch;
mod occurrence;

use super::event_location::EventLocator;
use super::impulse_schedule::ImpulseSchedule;
use super::located_event::LocatedEvent;
use super::zeno::AccumulationDetector;
use super::{Method, MethodError, Settings, Stepper, Unstable};
use crate::num::DoubleDouble;
use crate::system::{
    Branch, ConstraintProjector, Form, MotionError, MotionErrorKind, State, System,
};
use constraint_watch::Watch;
pub use occurrence::{Occurrence, OccurrenceKind};

/// How far a motion came.
#[derive(Clone, PartialEq, Debug)]
pub enum Reached {
    /// To the time asked for.
    There,
    /// Not so far: the steps allowed were taken.
    Underway,
    /// To something that happened on the way; the state is the one after it.
    Happened(Occurrence),
    /// Not so far: an event has ended the motion.
    Ended,
}

/// A motion under way.
pub struct Propagator {
    /// As compiled, with all its constraints.
    whole: System,
    /// With those that still hold.
    system: System,
    method: &'static Method,
    settings: Settings,
    stepper: Box<dyn Stepper>,
    projector: Option<ConstraintProjector>,
    crossings: Option<EventLocator>,
    impulse_schedule: ImpulseSchedule,
    parameters: Vec<f64>,
    start: f64,
    /// The present.
    state: State,
    /// The state before the last impulse.
    before: State,
    /// Where the motion last went on from, in the system's own form: velocities that momenta alone
    /// do not tell are looked for near it.
    near: State,
    /// Up to here the last step holds no event that is not known.
    clear: f64,
    /// How many steps in a row did not move the clock.
    stalled: u32,
    /// What happens there.
    waiting: Option<LocatedEvent>,
    /// Of each event.
    accumulation: Vec<AccumulationDetector>,
    watch: Watch,
    /// Where velocities are one of several that belong to the momenta: what tells their branch.
    branch: Option<Branch>,
    /// How often other constraints were held of those that repeat each other.
    holdings: u64,
    ended: bool,
    steps: u64,
}

impl Propagator {
    /// A motion that has yet to [begin](Motion::begin).
    ///
    /// # Errors
    /// Where the method does not fit the system.
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
            crossings: None,
            impulse_schedule: ImpulseSchedule::default(),
            parameters: parameters.to_vec(),
            start: 0.0,
            state: blank.clone(),
            before: blank.clone(),
            near: blank,
            clear: 0.0,
            waiting: None,
            stalled: 0,
            accumulation: vec![AccumulationDetector::NONE; system.discontinuities().events.len()],
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
        self.projector = self.system.projector(&self.parameters);
        let event_functions = self.system.event_functions(&self.parameters);
        let directions = self.system.discontinuities().events.iter().map(|e| e.direction).collect();
        let blank = State::new(0.0, self.system.form(), Vec::new());
        self.crossings = event_functions.map(|t| EventLocator::new(t, directions, blank));
        self.impulse_schedule.reschedule(self.system.schedule(&self.parameters));
    }

    /// Begins anew at a state: with all constraints, and no event behind it.
    ///
    /// # Errors
    /// Where the motion cannot begin there.
    pub fn begin(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        self.system.check_intervals(parameters, state.time)?;
        self.start = state.time;
        self.ended = false;
        self.forget_passages();
        self.impulse_schedule.begin(state.time);
        self.accumulation.fill(AccumulationDetector::NONE);
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
    pub fn go_on(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        if parameters != self.parameters {
            self.system.check_intervals(parameters, state.time)?;
            self.parameters = parameters.to_vec();
            self.impulse_schedule.reschedule(self.system.schedule(parameters));
            if let Some(projector) = &mut self.projector {
                projector.set_parameters(parameters);
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
    pub fn restore(
        &mut self,
        state: &State,
        parameters: &[f64],
        start: f64,
        released: &[usize],
    ) -> Result<(), MotionError> {
        self.begin(state, parameters)?;
        for &constraint in released {
            let own = self.own()?;
            self.release(constraint, &own)?;
        }
        self.start = start;
        self.impulse_schedule.begin(start);
        self.impulse_schedule.pass(state.time);
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
    ) -> Result<(), MethodError> {
        self.stepper = (method.make)(&self.system, &settings)?;
        self.method = method;
        self.settings = settings;
        Ok(())
    }

    fn resume(&mut self, state: &State) -> Result<(), MotionError> {
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
    fn check_branch(&mut self) -> Result<(), MotionError> {
        let Some(branch) = &mut self.branch else { return Ok(()) };
        if branch.holds(self.stepper.state()) {
            return Ok(());
        }
        let (begin, _) = self.stepper.interval();
        let state = self.stepper.state();
        Err(self.system.fault(MotionErrorKind::BranchLeft, begin, &state.values))
    }

    /// Where constraints repeat each other, those are held that depend on each other least.
    fn hold_anew(&mut self) -> Result<(), MotionError> {
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
    pub fn reach(
        &mut self,
        time: f64,
        limit: f64,
        budget: &mut u64,
    ) -> Result<Reached, MotionError> {
        self.go_to(time, limit, budget).map_err(|fault| self.explained(fault))
    }

    fn go_to(&mut self, time: f64, limit: f64, budget: &mut u64) -> Result<Reached, MotionError> {
        loop {
            if self.ended {
                return Ok(Reached::Ended);
            }
            if self.clear <= time {
                let due = self.impulse_schedule.due(self.clear);
                if self.waiting.is_some() || due.is_some() {
                    // what happens may happen without end
                    if *budget == 0 {
                        return Ok(Reached::Underway);
                    }
                    *budget -= 1;
                    self.note_passages(self.clear);
                }
                if let Some(found) = self.waiting.take() {
                    return self.on_event(found).map(Reached::Happened);
                }
                if let Some(impulse) = due {
                    return self.apply_scheduled(impulse).map(Reached::Happened);
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

    fn step(&mut self, limit: f64) -> Result<(), MotionError> {
        let limit =
            self.impulse_schedule.next(self.clear).map_or(limit, |impulse| impulse.min(limit));
        let before = self.stepper.state().exact_time();
        if self.impulse_schedule.stands_still(before.high) {
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
        if self.projector.is_some() || self.system.attitude_place().is_some() {
            self.before.copy_from(self.stepper.state());
            if let Some(projector) = &mut self.projector {
                projector.project(&mut self.before)?;
            }
            self.system.orthonormalise(&mut self.before);
            self.stepper.replace_state(&self.before);
            self.watch_step();
        }
        Ok(())
    }

    /// Looks for events in what was computed beyond `clear`, up to the next impulse, as far as the
    /// functions can be followed in one go.
    fn scan(&mut self) -> Result<(), MotionError> {
        let end = self.stepper.time();
        let mut end =
            self.impulse_schedule.next(self.clear).map_or(end, |impulse| impulse.min(end));
        if let Some(crossings) = &mut self.crossings {
            (self.waiting, end) = crossings.scan(self.stepper.as_mut(), self.clear, end)?;
        }
        self.clear = self.waiting.map_or(end, |found| found.exact.high);
        Ok(())
    }

    /// The present becomes the state at a time within the last step.
    fn look(&mut self, time: f64) -> Result<(), MotionError> {
        let (begin, end) = self.stepper.interval();
        if time == end || begin == end {
            self.state.copy_from(self.stepper.state());
        } else {
            self.stepper.at(time, &mut self.state)?;
            if let (Some(projector), Form::Velocity) = (&mut self.projector, self.state.form) {
                projector.project(&mut self.state)?;
            }
        }
        Ok(())
    }

    /// The present becomes the state at a time of something that happens, known beyond the last
    /// digit of an `f64`.
    fn look_exactly(&mut self, time: DoubleDouble) -> Result<(), MotionError> {
        let (begin, end) = self.stepper.interval();
        if begin == end {
            self.state.copy_from(self.stepper.state());
            return Ok(());
        }
        self.stepper.at_exactly(time, &mut self.state)?;
        if let (Some(projector), Form::Velocity) = (&mut self.projector, self.state.form) {
            projector.project(&mut self.state)?;
        }
        Ok(())
    }

    /// The present in the system's own form.
    fn own(&self) -> Result<State, MotionError> {
        self.to_own(&self.state)
    }

    fn to_own(&self, state: &State) -> Result<State, MotionError> {
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
fn stands_still(time: f64) -> MotionError {
    let kind = MotionErrorKind::ClockStands(super::clock::spacing(time));
    MotionError { time, kind, place: Vec::new() }
}

/// What can be asked of it.
impl Propagator {
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

    /// The state just before the last impulse or release.
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
    /// Where it cannot be reported.
    pub fn inside(&mut self, time: f64, out: &mut State) -> Result<(), MotionError> {
        self.stepper.at(time, out)
    }

    /// Moves the present to the end of what was computed.
    ///
    /// # Errors
    /// Where it cannot be reported.
    pub fn reach_computed(&mut self) -> Result<(), MotionError> {
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
        match (&mut self.projector, self.state.form) {
            (Some(projector), Form::Velocity) => projector.residuals(&self.state),
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
