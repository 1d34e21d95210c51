//! A motion and what is seen of it: the present, and every channel's value there.
//!
//! In: a state, parameters, times. Out: the state and every channel's value at the present. Never
//! here: rows, gauges, commands.

use super::gauges::{Gauges, Present};
use crate::integrate::{
    self, Method, MethodError, Occurrence, OccurrenceKind, Reached, Settings, Unstable,
};
use crate::mechanics::Valuation;
use crate::system::{MotionError, Observer, State, System, TermWatch};

/// A motion under way, observed.
pub(super) struct ObservedMotion {
    inner: integrate::Propagator,
    observer: Observer,
    values: Vec<f64>,
    residuals: Vec<[f64; 2]>,
    /// Of the motion, when the observer was made.
    holdings: u64,
    watch: Watch,
}

/// What looks at the motion after every step.
struct Watch {
    terms: TermWatch,
    /// When the channels are to be looked at next.
    next: f64,
    /// A number of (0, 1) that never comes back: the times of looks meet no period.
    golden: f64,
    /// A state on the way, and its channels.
    state: State,
    values: Vec<f64>,
}

impl Watch {
    fn of(system: &System, parameters: &[f64]) -> Watch {
        Watch {
            terms: system.term_watch(parameters),
            next: f64::NEG_INFINITY,
            golden: 0.5,
            state: State::new(0.0, system.form(), Vec::new()),
            values: vec![f64::NAN; system.channels().len()],
        }
    }

    /// The next of the numbers whose multiples of the golden section's are as evenly spread as can be (Weyl's sequence).
    fn turn(&mut self) -> f64 {
        self.golden = (self.golden + GOLDEN).fract();
        self.golden
    }
}

/// The golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

impl ObservedMotion {
    /// A motion that has yet to [begin](Motion::begin).
    pub(super) fn new(
        system: &System,
        method: &'static Method,
        settings: Settings,
        parameters: &[f64],
    ) -> Result<ObservedMotion, MethodError> {
        Ok(ObservedMotion {
            inner: integrate::Propagator::new(system, method, settings, parameters)?,
            observer: system.observer(parameters),
            values: vec![f64::NAN; system.channels().len()],
            residuals: Vec::new(),
            holdings: 0,
            watch: Watch::of(system, parameters),
        })
    }

    /// Takes another method or other settings; the motion has then to [go on](Motion::go_on) from
    /// its state.
    pub(super) fn change_method(
        &mut self,
        method: &'static Method,
        settings: Settings,
    ) -> Result<(), MethodError> {
        self.inner.change_method(method, settings)
    }

    /// Begins at a state.
    pub(super) fn begin(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        self.inner.begin(state, parameters)?;
        self.observer = self.inner.system().observer(parameters);
        self.watch = Watch::of(self.inner.system(), parameters);
        self.look()
    }

    /// Takes up a motion that began at `start` and was left at this state.
    pub(super) fn restore(
        &mut self,
        state: &State,
        parameters: &[f64],
        start: f64,
        released: &[usize],
    ) -> Result<(), MotionError> {
        self.inner.restore(state, parameters, start, released)?;
        self.observer = self.inner.system().observer(parameters);
        self.watch = Watch::of(self.inner.system(), parameters);
        self.look()
    }

    /// How far the present is from keeping each constraint.
    pub(super) fn residuals(&self) -> &[[f64; 2]] {
        &self.residuals
    }

    /// Goes on from a state at the present time.
    pub(super) fn go_on(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        self.inner.go_on(state, parameters)?;
        self.observer.set_parameters(parameters);
        self.watch.terms.set_parameters(parameters);
        self.look()
    }

    /// Moves the present on to `time`, in at most `budget` steps (which are taken off it), or to
    /// what happens before. No step reaches beyond `limit`, unless the method's step is fixed. The gauges look at every
    /// step; rows are `spacing` apart.
    pub(super) fn reach(
        &mut self,
        time: f64,
        limit: f64,
        budget: &mut u64,
        (gauges, spacing): (&mut Gauges, f64),
    ) -> Result<Reached, MotionError> {
        loop {
            let (before, mut one) = (self.inner.steps(), (*budget).min(1));
            let reached = self.inner.reach(time, limit, &mut one)?;
            if self.inner.steps() != before {
                *budget -= 1;
                self.look_at_step(gauges, spacing);
            }
            match &reached {
                Reached::Underway if *budget > 0 => continue,
                Reached::Happened(occurrence) => self.take_in(occurrence)?,
                Reached::There => self.look()?,
                Reached::Underway | Reached::Ended => {}
            }
            return Ok(reached);
        }
    }

    /// Has the gauges look at the last step: at its end, and where rows may lie farther apart than steps also within, if
    /// the method tells the states there as well as those at the ends. What cannot be looked at is passed over: it is
    /// met again where it is asked for.
    fn look_at_step(&mut self, gauges: &mut Gauges, spacing: f64) {
        let (begin, end) = self.inner.undisturbed();
        let whole = end == self.inner.computed().time;
        let steps = self.inner.steps();
        let sparse = (end - begin).abs() < spacing;
        let due = sparse && end >= self.watch.next;
        if due {
            self.watch.next = end + spacing * (0.5 + self.watch.turn());
        }
        // the state of a series is known within a step as at its end
        if sparse && self.inner.method().order.is_none() {
            let time = begin + self.watch.turn() * (end - begin);
            let Watch { terms, state, values, .. } = &mut self.watch;
            if self.inner.inside(time, state).is_ok() && terms.look(state) {
                if due && self.observer.observe(state, values).is_ok() {
                    gauges.look_on_the_way(time, steps, values, terms);
                }
                gauges.step(time, steps, terms, false);
            }
        }
        let (Watch { terms, values, .. }, state) = (&mut self.watch, self.inner.computed());
        if whole && terms.look(state) {
            if due
                && self.inner.method().order.is_some()
                && self.observer.observe(state, values).is_ok()
            {
                gauges.look_on_the_way(end, steps, values, terms);
            }
            gauges.step(end, steps, terms, !sparse);
        }
    }

    /// Strikes the present.
    pub(super) fn strike(&mut self, impulse: usize) -> Result<Occurrence, MotionError> {
        let occurrence = self.inner.apply_impulse_now(impulse)?;
        self.take_in(&occurrence)?;
        Ok(occurrence)
    }

    fn take_in(&mut self, occurrence: &Occurrence) -> Result<(), MotionError> {
        if matches!(occurrence.kind, OccurrenceKind::Release(_)) {
            self.take_observer();
        }
        self.look()
    }

    /// Looks with the constraints that are held now.
    fn take_observer(&mut self) {
        let parameters = self.observer.parameters().to_vec();
        self.observer = self.inner.system().observer(&parameters);
    }

    /// Moves the present to the end of what was computed before a fault.
    pub(super) fn reach_end(&mut self) -> Result<(), MotionError> {
        self.inner.reach_computed()?;
        self.look()
    }

    fn look(&mut self) -> Result<(), MotionError> {
        self.residuals = self.inner.residuals();
        if self.holdings != self.inner.holdings() {
            self.holdings = self.inner.holdings();
            self.take_observer();
        }
        let outcome = self.observer.observe(self.inner.state(), &mut self.values);
        outcome.map_err(|fault| self.inner.explained(fault))
    }

    /// Every channel's value just before the last impulse.
    pub(super) fn values_before(&mut self) -> Result<Vec<f64>, MotionError> {
        let mut values = vec![f64::NAN; self.values.len()];
        self.observer.observe(self.inner.before(), &mut values)?;
        Ok(values)
    }
}

/// What can be asked of it.
impl ObservedMotion {
    /// The system with all its constraints.
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

    /// Where its fixed step was found to lie beyond what is stable, if it was.
    pub(super) fn unstable(&self) -> Option<Unstable> {
        self.inner.unstable()
    }

    /// The present time.
    pub(super) fn time(&self) -> f64 {
        self.state().time
    }

    /// The present state.
    pub(super) fn state(&self) -> &State {
        self.inner.state()
    }

    /// Every channel's present value.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    pub(super) fn steps(&self) -> u64 {
        self.inner.steps()
    }

    pub(super) fn set_steps(&mut self, steps: u64) {
        self.inner.set_steps(steps);
    }

    /// Forgets what was, until it [begins](Motion::begin); the clock shows `time`.
    pub(super) fn forget(&mut self, time: f64) {
        self.values.fill(f64::NAN);
        self.inner.forget(time);
    }

    /// Whether there is a present.
    pub(super) fn has_begun(&self) -> bool {
        !self.state().values.is_empty()
    }

    /// Looks at the terms of what is conserved at the present.
    pub(super) fn look_at_terms(&mut self) {
        self.watch.terms.look(self.inner.state());
    }

    /// What the gauges look at, once the terms were [looked at](Motion::look_at_terms).
    pub(super) fn present<'a>(&'a self, constants: &'a Valuation) -> Present<'a> {
        let action = self.state().values.get(self.system().driven_len());
        Present {
            time: self.time(),
            steps: self.steps(),
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

    pub(super) fn step_size(&self) -> f64 {
        self.inner.step_size()
    }
}
