//! Events and impulses as numbers: the functions whose zeros are located, the times of the
//! impulses, and their effect on a state.
//!
//! In: a model's impulses and events. Out: values of `when`, times, states after an impulse. Never
//! here: how zeros are found, and what follows from them.
//!
//! Source of the impulses: *The Principles of Dynamics*, § 1.3.3.

use std::sync::Arc;

use super::expansion::{self, Expansion};
use super::observables;
use super::program::Program;
use super::resolution::Resolution;
use super::rhs::ProgramBuilder;
use super::series::Series;
use super::value::Evaluator;
use super::{Form, MotionError, MotionErrorKind, State, System};
use crate::expr::{Expr, Symbol};
use crate::model::{Action, Direction, Model};
use crate::num::DoubleDouble;

/// The events and impulses of a motion.
#[derive(Clone, Debug)]
pub struct Discontinuities {
    /// Events, in the order of the file.
    pub events: Vec<CompiledEvent>,
    /// Impulses, in the order of the file.
    pub impulses: Vec<CompiledImpulse>,
    /// The functions of the events, of (q, native rates, action, work).
    pub(super) when: Arc<Program>,
    /// Quantities that show how fast these functions change, of the same inputs.
    variation: Arc<Program>,
    /// Q̂ of every impulse, of the same inputs.
    pub(super) change: Arc<Program>,
    /// The times of every impulse, followed by its interval (zero for none), as functions of the
    /// parameters.
    schedule: Arc<Program>,
    /// Whether L is quadratic in the velocities.
    quadratic: bool,
}

/// An event without its function.
#[derive(Clone, Debug)]
pub struct CompiledEvent {
    /// The name in the file.
    pub name: String,
    /// The direction in which zeros count.
    pub direction: Direction,
    /// The action that an event triggers.
    pub action: Action,
}

/// An impulse without its formulas.
#[derive(Clone, Debug)]
pub struct CompiledImpulse {
    /// The name in the file.
    pub name: String,
    /// The description in words.
    pub about: String,
    times: usize,
    /// Whether the impulse recurs.
    periodic: bool,
    /// Whether the impulse is applied at scheduled times. If not, an event or a key triggers it.
    pub scheduled: bool,
}

/// The times of one impulse.
#[derive(Clone, PartialEq, Debug)]
pub struct Schedule {
    /// Single times.
    pub times: Vec<DoubleDouble>,
    /// The interval at whose multiples after the start the impulse is applied, too.
    pub interval: Option<DoubleDouble>,
    /// The interval as computed, which may be invalid: zero, negative or not finite.
    given: DoubleDouble,
}

impl Schedule {
    /// The time of an impulse beyond the precision of an `f64`, given its nearest `f64`.
    pub fn exactly(&self, start: f64, time: f64) -> DoubleDouble {
        let periodic = || {
            let interval = self.interval?;
            let count = ((time - start) / interval.high).round();
            Some(DoubleDouble::written(start) + interval * count)
        };
        let listed = self.times.iter().copied().find(|x| x.high == time);
        let found = listed.or_else(|| periodic().filter(|x| x.high == time));
        found.unwrap_or_else(|| DoubleDouble::written(time))
    }
}

/// The effect of an impulse.
#[derive(Clone, PartialEq, Debug)]
pub struct ImpulseOutcome {
    /// The state after it.
    pub after: State,
    /// Δp of each coordinate, or the jump of each variable.
    pub jump: Vec<f64>,
    /// Λ of each constraint.
    pub reaction: Vec<f64>,
}

impl Discontinuities {
    /// Whether L is quadratic in the velocities.
    pub(super) fn is_quadratic(&self) -> bool {
        self.quadratic
    }

    pub(super) fn of(
        model: &Model,
        builder: &mut ProgramBuilder<'_>,
    ) -> Result<Discontinuities, Symbol> {
        let mut lowering = builder.lowering();
        let mut outputs = Vec::new();
        for impulse in &model.impulses {
            outputs.extend(lowering.lower_all(&impulse.times));
            outputs.push(lowering.lower(impulse.period.unwrap_or(Expr::ZERO)));
        }
        let schedule = lowering.finish(outputs)?;
        let located = || model.events.iter().chain(&model.sections);
        let functions = located().map(|e| Some(e.when)).collect::<Vec<_>>();
        let changes = model.impulses.iter().flat_map(|i| i.change.iter().map(|&e| Some(e)));
        let changes: Vec<_> = changes.collect();
        Ok(Discontinuities {
            events: located()
                .map(|e| CompiledEvent {
                    name: e.name.clone(),
                    direction: if builder.backwards { e.direction.reversed() } else { e.direction },
                    action: e.action,
                })
                .collect(),
            impulses: model
                .impulses
                .iter()
                .map(|i| CompiledImpulse {
                    name: i.name.clone(),
                    about: i.about.clone(),
                    times: i.times.len(),
                    periodic: i.period.is_some(),
                    scheduled: !i.times.is_empty() || i.period.is_some(),
                })
                .collect(),
            when: observables::program(builder, &functions)?,
            variation: expansion::program(builder, &functions)?,
            change: observables::program(builder, &changes)?,
            schedule,
            quadratic: builder.equations.is_quadratic(),
        })
    }
}

/// Evaluates the events' functions of one system at one set of parameters.
#[derive(Clone, Debug)]
pub struct EventFunctions {
    system: System,
    parameters: Vec<f64>,
    quick: Evaluator<f64>,
    exact: Evaluator<DoubleDouble>,
    resolution: Resolution,
    /// Expands the functions along a step whose series is known. Created at the first such step.
    expansion: Option<Expansion>,
    rounded: Vec<f64>,
    inputs: Vec<DoubleDouble>,
    /// The last state evaluated, in the native form, if momenta alone do not determine it.
    near: Option<State>,
}

impl EventFunctions {
    /// Sets the parameters.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        self.parameters.clear();
        self.parameters.extend_from_slice(parameters);
        let inputs = self.system.inputs(parameters);
        self.quick.set_parameters(&inputs);
        self.exact.set_parameters(&inputs);
        self.resolution.set_parameters(&inputs);
        self.expansion = None;
    }

    /// Expands the functions along a step whose series is known, about a time `x` after the series'
    /// origin, in its unit. Returns how far beyond it, up to `whole`, the expansions represent the
    /// functions up to a part `cut_off` of their size, or `None` if there are none.
    pub fn expand(&mut self, series: &Series, x: f64, (cut_off, whole): (f64, f64)) -> Option<f64> {
        let order = series.order();
        let (system, parameters) = (&self.system, &self.parameters);
        let expansion = self.expansion.take().filter(|known| known.order() == order);
        let expansion = self.expansion.insert(expansion.unwrap_or_else(|| {
            let discontinuities = system.discontinuities();
            let (program, functions) =
                (Arc::clone(&discontinuities.variation), discontinuities.events.len());
            let mut new = Expansion::new(system, program, functions, order);
            new.set_parameters(&system.inputs(parameters));
            new
        }));
        if !expansion.about(series, x) {
            return None;
        }
        Some(expansion.reach(cut_off, whole)).filter(|reach| !reach.is_nan())
    }

    /// The coefficients of an event's function from the last [expansion](EventFunctions::expand).
    pub fn expanded(&self, event: usize) -> Vec<f64> {
        self.expansion.as_ref().map_or_else(Vec::new, |known| known.function(event).to_vec())
    }

    /// The coefficients of the switches of the expanded functions.
    pub fn expanded_switches(&self) -> impl Iterator<Item = &[f64]> {
        self.expansion.iter().flat_map(Expansion::switches)
    }

    /// The time after a state over which the functions are simple enough that samples at the ends,
    /// and at the points where these do not predict them, detect every turning point. It is
    /// infinite for polynomials, and `None` if it cannot be estimated. `near` is a time comparable
    /// to the time scale of the motion.
    pub fn resolved(&mut self, state: &State, near: f64) -> Option<f64> {
        let form = self.system.form();
        if state.form == form {
            return self.resolution.after(state, near);
        }
        let own = self.system.convert(state, form, &self.parameters).ok()?;
        self.resolution.after(&own, near)
    }

    /// Sets the inputs from a state, which may have either form.
    fn take_in(&mut self, state: &State) -> Result<(), MotionError> {
        let form = self.system.form();
        if state.form == form {
            self.system.inputs_of(state, &mut self.inputs);
        } else {
            let own = match &self.near {
                Some(near) => self.system.convert_near(state, near, &self.parameters)?,
                None => self.system.convert(state, form, &self.parameters)?,
            };
            self.system.inputs_of(&own, &mut self.inputs);
            self.near = Some(own).filter(|_| self.system.has_branches());
        }
        Ok(())
    }

    /// Evaluates every event's function at a state.
    pub fn look(&mut self, state: &State, out: &mut [f64]) -> Result<(), MotionError> {
        self.take_in(state)?;
        for (rounded, x) in self.rounded.iter_mut().zip(&self.inputs) {
            *rounded = x.high;
        }
        let found = self.quick.evaluate(state.time, &self.rounded);
        found.map_err(|why| {
            let program = &self.system.discontinuities().when;
            self.system.singular(program, why, state.time, &state.values)
        })?;
        for (i, x) in out.iter_mut().enumerate() {
            *x = self.quick.output(i);
        }
        Ok(())
    }

    /// The value of one event's function, in double-double.
    pub fn exactly(&mut self, event: usize, state: &State) -> Result<DoubleDouble, MotionError> {
        self.take_in(state)?;
        let found = self.exact.evaluate(state.exact_time(), &self.inputs);
        found.map_err(|why| {
            let program = &self.system.discontinuities().when;
            self.system.singular(program, why, state.time, &state.values)
        })?;
        Ok(self.exact.output(event))
    }
}

impl System {
    /// The same system for motions of which nobody asks when the events and crossings happen that
    /// change nothing; they are located only where others are.
    #[must_use]
    pub fn without_marks(&self) -> System {
        let mark =
            |event: &CompiledEvent| matches!(event.action, Action::Mark | Action::Section(_));
        let mut system = self.clone();
        system.unmarked = self.discontinuities().events.iter().all(mark);
        system
    }

    /// Whether there are events to be located.
    pub(super) fn locates_events(&self) -> bool {
        !self.unmarked && !self.discontinuities().events.is_empty()
    }

    /// Returns the evaluator of the events' functions, or `None` if there are no events.
    pub fn event_functions(&self, parameters: &[f64]) -> Option<EventFunctions> {
        if !self.locates_events() {
            return None;
        }
        let program = &self.discontinuities().when;
        let inputs = self.motion_len() + 2;
        let mut event_functions = EventFunctions {
            system: self.clone(),
            parameters: parameters.to_vec(),
            quick: Evaluator::new(Arc::clone(program)),
            exact: Evaluator::new(Arc::clone(program)),
            resolution: Resolution::new(
                self,
                Arc::clone(&self.discontinuities().variation),
                self.discontinuities().events.len(),
            ),
            expansion: None,
            rounded: vec![0.0; inputs],
            inputs: vec![DoubleDouble::ZERO; inputs],
            near: None,
        };
        event_functions.set_parameters(parameters);
        Some(event_functions)
    }

    /// The times of each impulse at these parameters.
    pub fn schedule(&self, parameters: &[f64]) -> Vec<Schedule> {
        let discontinuities = self.discontinuities();
        let mut values: Evaluator<DoubleDouble> =
            Evaluator::new(Arc::clone(&discontinuities.schedule));
        values.set_parameters(&self.inputs(parameters));
        let mut next = 0;
        let mut take = |count: usize| {
            next += count;
            (next - count..next).map(|i| values.output(i)).collect::<Vec<_>>()
        };
        let of = |impulse: &CompiledImpulse| {
            let times = take(impulse.times);
            let given = take(1).first().copied().unwrap_or(DoubleDouble::ZERO);
            let interval = Some(given).filter(|x| x.high > 0.0 && x.is_finite());
            Schedule { times, interval, given }
        };
        discontinuities.impulses.iter().map(of).collect()
    }

    /// Checks the intervals of the impulses at these parameters.
    ///
    /// # Errors
    /// Returns an error at this time if an interval is zero, negative or not finite.
    pub fn check_intervals(&self, parameters: &[f64], time: f64) -> Result<(), MotionError> {
        let schedule = self.schedule(parameters);
        for (impulse, schedule) in self.discontinuities().impulses.iter().zip(schedule) {
            if let (true, None) = (impulse.periodic, schedule.interval) {
                let kind = MotionErrorKind::NoInterval(impulse.name.clone(), schedule.given.high);
                return Err(MotionError { time, kind, place: Vec::new() });
            }
        }
        Ok(())
    }

    /// Applies an impulse to a state in the system's native form: Δp = Q̂ + AᵀΛ̂ with A q̇ + A₀ = 0
    /// after it and q unchanged.
    ///
    /// If a state carries the work done on the motion, the impulse's work is added by its law, Δh =
    /// ½(q̇⁻ + q̇⁺)·Q̂ − Λ̂·A₀ for an L that is quadratic in q̇, and from the energies otherwise.
    pub fn apply_impulse(
        &self,
        impulse: usize,
        state: &State,
        parameters: &[f64],
    ) -> Result<ImpulseOutcome, MotionError> {
        let n = self.degrees();
        let inputs = self.inputs(parameters);
        let program = &self.discontinuities().change;
        let mut values: Evaluator<DoubleDouble> = Evaluator::new(Arc::clone(program));
        values.set_parameters(&inputs);
        let mut seen = vec![DoubleDouble::ZERO; self.motion_len() + 2];
        self.inputs_of(state, &mut seen);
        let found = values.evaluate(state.exact_time(), &seen);
        found.map_err(|why| self.singular(program, why, state.time, &state.values))?;
        let impulse: Vec<DoubleDouble> = (0..n).map(|i| values.output(impulse * n + i)).collect();
        let mut after = state.clone();
        let mut reaction = vec![0.0; self.constraints()];
        let mut jump: Vec<f64> = impulse.iter().map(|x| x.high).collect();
        match self.form() {
            Form::Variables => add(&mut after, 0, &impulse),
            Form::Momentum => add(&mut after, n, &impulse),
            Form::Velocity => {
                let before = self.convert(state, Form::Momentum, parameters)?;
                let target: Vec<DoubleDouble> =
                    (0..n).map(|i| before.exact(n + i) + impulse[i]).collect();
                if self.constraints() > 0 {
                    (after, reaction) = self.impulse_outcome(state, &target, parameters)?;
                    let after_impulse = self.convert(&after, Form::Momentum, parameters)?;
                    for (i, x) in jump.iter_mut().enumerate() {
                        *x = (after_impulse.exact(n + i) - before.exact(n + i)).high;
                    }
                } else {
                    let mut after_impulse = before.clone();
                    for (i, &p) in target.iter().enumerate() {
                        after_impulse.set(n + i, p);
                    }
                    after = self.convert_near(&after_impulse, state, parameters)?;
                }
            }
        }
        self.check_finite(&after)?;
        self.add_work(state, &mut after, (&impulse, &reaction), parameters)?;
        Ok(ImpulseOutcome { after, jump, reaction })
    }

    /// Adds the work of an impulse to the work of a state.
    fn add_work(
        &self,
        before: &State,
        after: &mut State,
        (impulse, reaction): (&[DoubleDouble], &[f64]),
        parameters: &[f64],
    ) -> Result<(), MotionError> {
        let Some(place) = self.work_place() else { return Ok(()) };
        let n = self.degrees();
        let work = if self.discontinuities().quadratic && self.form() == Form::Velocity {
            let mut work = DoubleDouble::ZERO;
            for (i, &q) in impulse.iter().enumerate() {
                work = work + (before.exact(n + i) + after.exact(n + i)) * q * 0.5;
            }
            let rates = self.constraint_rates(before, parameters);
            rates.iter().zip(reaction).fold(work, |work, (&a, &x)| work - a * x)
        } else {
            self.energy_of(after, parameters)? - self.energy_of(before, parameters)?
        };
        after.set(place, before.exact(place) + work);
        Ok(())
    }
}

/// Adds to the numbers of a state from `first` on.
fn add(state: &mut State, first: usize, change: &[DoubleDouble]) {
    for (i, &x) in change.iter().enumerate() {
        state.set(first + i, state.exact(first + i) + x);
    }
}
