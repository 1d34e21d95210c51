//! Events and blows as numbers: the functions whose zeros are looked for, when blows fall, and what
//! they do to a state.
//!
//! In: a model's impulses and events. Out: values of `when`, times, states after a blow. Never
//! here: how zeros are found, and what follows from them.
//! Source of the blows: *The Principles of Dynamics*, § 1.3.3.

use std::sync::Arc;

use super::expansion::{self, Expansion};
use super::motion::Writer;
use super::program::Program;
use super::resolution::Resolution;
use super::series::Series;
use super::value::Values;
use super::watch;
use super::{Fault, FaultKind, Form, State, System};
use crate::expr::{Double, Expr, Symbol};
use crate::model::{Action, Direction, Model};

/// What may happen to a motion.
#[derive(Clone, Debug)]
pub struct Occasions {
    /// Events, in the order of the file.
    pub events: Vec<Trigger>,
    /// Impulses, in the order of the file.
    pub impulses: Vec<Blow>,
    /// Of (q, native rates, action, work): each event's function.
    when: Arc<Program>,
    /// Of the same: what tells how fast these functions change.
    pace: Arc<Program>,
    /// Of the same: Q̂ of every impulse.
    change: Arc<Program>,
    /// Of the parameters: the times of every impulse, its interval last (zero for none).
    schedule: Arc<Program>,
    /// Whether L is quadratic in the velocities.
    quadratic: bool,
}

/// An event without its function.
#[derive(Clone, Debug)]
pub struct Trigger {
    /// As in the file.
    pub name: String,
    /// Which crossings of zero count.
    pub direction: Direction,
    /// What follows.
    pub action: Action,
}

/// An impulse without its formulas.
#[derive(Clone, Debug)]
pub struct Blow {
    /// As in the file.
    pub name: String,
    /// What it is, in words.
    pub about: String,
    times: usize,
    /// Whether it strikes again and again.
    periodic: bool,
    /// Whether it falls at times of its own; one that does not waits for an event or a key.
    pub scheduled: bool,
}

/// When one impulse falls.
#[derive(Clone, PartialEq, Debug)]
pub struct Schedule {
    /// At these times.
    pub times: Vec<Double>,
    /// And at every multiple of this interval after the start.
    pub interval: Option<Double>,
    /// The interval as it was computed, which may be none: zero, negative or not finite.
    given: Double,
}

impl Schedule {
    /// The time of a blow beyond the last digit of an `f64`, by its nearest one.
    pub fn exactly(&self, start: f64, time: f64) -> Double {
        let periodic = || {
            let interval = self.interval?;
            let count = ((time - start) / interval.high).round();
            Some(Double::written(start) + interval * count)
        };
        let listed = self.times.iter().copied().find(|x| x.high == time);
        let found = listed.or_else(|| periodic().filter(|x| x.high == time));
        found.unwrap_or_else(|| Double::written(time))
    }
}

/// What a blow did.
#[derive(Clone, PartialEq, Debug)]
pub struct Struck {
    /// The state after it.
    pub after: State,
    /// Δp of each coordinate, or the jump of each variable.
    pub jump: Vec<f64>,
    /// Λ of each constraint.
    pub reaction: Vec<f64>,
}

impl Occasions {
    pub(super) fn of(model: &Model, writer: &mut Writer<'_>) -> Result<Occasions, Symbol> {
        let mut lowering = writer.lowering();
        let mut outputs = Vec::new();
        for impulse in &model.impulses {
            outputs.extend(lowering.lower_all(&impulse.times));
            outputs.push(lowering.lower(impulse.period.unwrap_or(Expr::ZERO)));
        }
        let schedule = lowering.finish(outputs)?;
        let functions = model.events.iter().map(|e| Some(e.when)).collect::<Vec<_>>();
        let changes = model.impulses.iter().flat_map(|i| i.change.iter().map(|&e| Some(e)));
        let changes: Vec<_> = changes.collect();
        Ok(Occasions {
            events: model
                .events
                .iter()
                .map(|e| Trigger { name: e.name.clone(), direction: e.direction, action: e.action })
                .collect(),
            impulses: model
                .impulses
                .iter()
                .map(|i| Blow {
                    name: i.name.clone(),
                    about: i.about.clone(),
                    times: i.times.len(),
                    periodic: i.period.is_some(),
                    scheduled: !i.times.is_empty() || i.period.is_some(),
                })
                .collect(),
            when: watch::program(writer, &functions)?,
            pace: expansion::program(writer, &functions)?,
            change: watch::program(writer, &changes)?,
            schedule,
            quadratic: writer.is_quadratic(),
        })
    }
}

/// Evaluates the events' functions of one system at one set of parameters.
#[derive(Clone, Debug)]
pub struct Triggers {
    system: System,
    parameters: Vec<f64>,
    quick: Values<f64>,
    exact: Values<Double>,
    resolution: Resolution,
    /// What expands the functions along a step whose series is known, once there was one.
    expansion: Option<Expansion>,
    rounded: Vec<f64>,
    inputs: Vec<Double>,
    /// The state looked at last, in the native form, where momenta alone do not tell it.
    near: Option<State>,
}

impl Triggers {
    /// Takes these parameters from now on.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        self.parameters.clear();
        self.parameters.extend_from_slice(parameters);
        let inputs = self.system.inputs(parameters);
        self.quick.set_parameters(&inputs);
        self.exact.set_parameters(&inputs);
        self.resolution.set_parameters(&inputs);
        self.expansion = None;
    }

    /// Expands the functions along a step whose series is known, about a time `x` after the series' origin, in its unit,
    /// and gives how far after it these expansions tell the functions but for a part `cut_off` of their size; `None`
    /// where there are none.
    pub fn expand(&mut self, series: &Series, x: f64, cut_off: f64) -> Option<f64> {
        let order = series.order();
        let (system, parameters) = (&self.system, &self.parameters);
        let expansion = self.expansion.take().filter(|known| known.order() == order);
        let expansion = self.expansion.insert(expansion.unwrap_or_else(|| {
            let occasions = system.occasions();
            let (program, functions) = (Arc::clone(&occasions.pace), occasions.events.len());
            let mut new = Expansion::new(system, program, functions, order);
            new.set_parameters(&system.inputs(parameters));
            new
        }));
        if !expansion.about(series, x) {
            return None;
        }
        Some(expansion.reach(cut_off)).filter(|reach| !reach.is_nan())
    }

    /// The coefficients of an event's function as it was last [expanded](Triggers::expand).
    pub fn expanded(&self, event: usize) -> Vec<f64> {
        self.expansion.iter().flat_map(|known| known.function(event)).collect()
    }

    /// The coefficients of what decides between the branches of the functions that were expanded.
    pub fn expanded_switches(&self) -> impl Iterator<Item = &[f64]> {
        self.expansion.iter().flat_map(Expansion::switches)
    }

    /// How far after a state the functions are so simple that looks at the ends, and at what these
    /// do not foretell, see every turn; infinite for polynomials, `None` where it cannot be told.
    /// `near` is some length of time that is not far from the motion's own.
    pub fn resolved(&mut self, state: &State, near: f64) -> Option<f64> {
        let form = self.system.form();
        if state.form == form {
            return self.resolution.after(state, near);
        }
        let own = self.system.convert(state, form, &self.parameters).ok()?;
        self.resolution.after(&own, near)
    }

    /// The inputs for a state, which may have either form.
    fn take_in(&mut self, state: &State) -> Result<(), Fault> {
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

    /// The value of every event's function at a state.
    pub fn look(&mut self, state: &State, out: &mut [f64]) -> Result<(), Fault> {
        self.take_in(state)?;
        for (rounded, x) in self.rounded.iter_mut().zip(&self.inputs) {
            *rounded = x.high;
        }
        let found = self.quick.evaluate(state.time, &self.rounded);
        found.map_err(|why| {
            let program = &self.system.occasions().when;
            self.system.singular(program, why, state.time, &state.values)
        })?;
        for (i, x) in out.iter_mut().enumerate() {
            *x = self.quick.output(i);
        }
        Ok(())
    }

    /// The value of one event's function, in all digits.
    pub fn exactly(&mut self, event: usize, state: &State) -> Result<Double, Fault> {
        self.take_in(state)?;
        let found = self.exact.evaluate(state.exact_time(), &self.inputs);
        found.map_err(|why| {
            let program = &self.system.occasions().when;
            self.system.singular(program, why, state.time, &state.values)
        })?;
        Ok(self.exact.output(event))
    }
}

impl System {
    /// What evaluates the events' functions; `None` where there are no events.
    pub fn triggers(&self, parameters: &[f64]) -> Option<Triggers> {
        let program = &self.occasions().when;
        if program.outputs() == 0 {
            return None;
        }
        let inputs = self.driven() + 2;
        let mut triggers = Triggers {
            system: self.clone(),
            parameters: parameters.to_vec(),
            quick: Values::new(Arc::clone(program)),
            exact: Values::new(Arc::clone(program)),
            resolution: Resolution::new(
                self,
                Arc::clone(&self.occasions().pace),
                self.occasions().events.len(),
            ),
            expansion: None,
            rounded: vec![0.0; inputs],
            inputs: vec![Double::ZERO; inputs],
            near: None,
        };
        triggers.set_parameters(parameters);
        Some(triggers)
    }

    /// When each impulse falls, at these parameters.
    pub fn schedule(&self, parameters: &[f64]) -> Vec<Schedule> {
        let occasions = self.occasions();
        let mut values: Values<Double> = Values::new(Arc::clone(&occasions.schedule));
        values.set_parameters(&self.inputs(parameters));
        let mut next = 0;
        let mut take = |count: usize| {
            next += count;
            (next - count..next).map(|i| values.output(i)).collect::<Vec<_>>()
        };
        let of = |blow: &Blow| {
            let times = take(blow.times);
            let given = take(1).first().copied().unwrap_or(Double::ZERO);
            let interval = Some(given).filter(|x| x.high > 0.0 && x.is_finite());
            Schedule { times, interval, given }
        };
        occasions.impulses.iter().map(of).collect()
    }

    /// The impulse whose interval is none at these parameters, if there is one, as a fault.
    ///
    /// # Errors
    /// The fault, at this time.
    pub fn check_intervals(&self, parameters: &[f64], time: f64) -> Result<(), Fault> {
        let schedule = self.schedule(parameters);
        for (blow, schedule) in self.occasions().impulses.iter().zip(schedule) {
            if let (true, None) = (blow.periodic, schedule.interval) {
                let kind = FaultKind::NoInterval(blow.name.clone(), schedule.given.high);
                return Err(Fault { time, kind, place: Vec::new() });
            }
        }
        Ok(())
    }

    /// Strikes a state in the system's own form: Δp = Q̂ + AᵀΛ̂ with A q̇ + A₀ = 0 after it, q kept.
    ///
    /// Where a state carries the work done on the motion, the blow's is added by its law,
    /// Δh = ½(q̇⁻ + q̇⁺)·Q̂ − Λ̂·A₀ for an L that is quadratic in q̇, else by the energies.
    pub fn strike_by(
        &self,
        impulse: usize,
        state: &State,
        parameters: &[f64],
    ) -> Result<Struck, Fault> {
        let n = self.degrees();
        let inputs = self.inputs(parameters);
        let program = &self.occasions().change;
        let mut values: Values<Double> = Values::new(Arc::clone(program));
        values.set_parameters(&inputs);
        let mut seen = vec![Double::ZERO; self.driven() + 2];
        self.inputs_of(state, &mut seen);
        let found = values.evaluate(state.exact_time(), &seen);
        found.map_err(|why| self.singular(program, why, state.time, &state.values))?;
        let blow: Vec<Double> = (0..n).map(|i| values.output(impulse * n + i)).collect();
        let mut after = state.clone();
        let mut reaction = vec![0.0; self.constraints()];
        let mut jump: Vec<f64> = blow.iter().map(|x| x.high).collect();
        match self.form() {
            Form::Variables => add(&mut after, 0, &blow),
            Form::Momentum => add(&mut after, n, &blow),
            Form::Velocity => {
                let before = self.convert(state, Form::Momentum, parameters)?;
                let target: Vec<Double> = (0..n).map(|i| before.exact(n + i) + blow[i]).collect();
                if self.constraints() > 0 {
                    (after, reaction) = self.strike(state, &target, parameters)?;
                    let struck = self.convert(&after, Form::Momentum, parameters)?;
                    for (i, x) in jump.iter_mut().enumerate() {
                        *x = (struck.exact(n + i) - before.exact(n + i)).high;
                    }
                } else {
                    let mut struck = before.clone();
                    for (i, &p) in target.iter().enumerate() {
                        struck.set(n + i, p);
                    }
                    after = self.convert_near(&struck, state, parameters)?;
                }
            }
        }
        self.check_finite(&after)?;
        self.add_work(state, &mut after, (&blow, &reaction), parameters)?;
        Ok(Struck { after, jump, reaction })
    }

    /// Adds to the work of a state what a blow did.
    fn add_work(
        &self,
        before: &State,
        after: &mut State,
        (blow, reaction): (&[Double], &[f64]),
        parameters: &[f64],
    ) -> Result<(), Fault> {
        let Some(place) = self.work_place() else { return Ok(()) };
        let n = self.degrees();
        let work = if self.occasions().quadratic && self.form() == Form::Velocity {
            let mut work = Double::ZERO;
            for (i, &q) in blow.iter().enumerate() {
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
fn add(state: &mut State, first: usize, change: &[Double]) {
    for (i, &x) in change.iter().enumerate() {
        state.set(first + i, state.exact(first + i) + x);
    }
}
