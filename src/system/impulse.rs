//! The impulses of a motion: their times, and their effect on a state.
//!
//! In: parameters, a state before an impulse. Out: times, the state after it, reactions. Never here: when a motion applies
//! them.
//!
//! Source: *The Principles of Dynamics*, § 1.3.3.

use std::sync::Arc;

use super::discontinuities::CompiledImpulse;
use super::value::Evaluator;
use super::{Form, MotionError, MotionErrorKind, State, System};
use crate::num::DoubleDouble;

/// When an impulse is applied.
#[derive(Clone, PartialEq, Debug)]
pub struct ImpulseTimes {
    /// Single times.
    pub times: Vec<DoubleDouble>,
    /// The interval at whose multiples after the start the impulse is applied, too.
    pub interval: Option<DoubleDouble>,
    /// The interval as computed, which may be invalid: zero, negative or not finite.
    given: DoubleDouble,
}

impl ImpulseTimes {
    /// The time of an impulse beyond the precision of an `f64`, given its nearest `f64`.
    pub fn exactly(&self, start: f64, time: f64) -> DoubleDouble {
        let periodic = || {
            let interval = self.interval?;
            let count = ((time - start) / interval.high).round();
            Some(DoubleDouble::from_decimal(start) + interval * count)
        };
        let listed = self.times.iter().copied().find(|x| x.high == time);
        let found = listed.or_else(|| periodic().filter(|x| x.high == time));
        found.unwrap_or_else(|| DoubleDouble::from_decimal(time))
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

impl System {
    /// The times of each impulse at these parameters.
    pub fn schedule(&self, parameters: &[f64]) -> Vec<ImpulseTimes> {
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
            ImpulseTimes { times, interval, given }
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
    ///
    /// # Errors
    /// Returns an error if no motion has the momenta after the impulse, or a number of it is not finite.
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
        let name = &self.discontinuities().impulses[impulse].name;
        let impulse: Vec<DoubleDouble> = (0..n).map(|i| values.output(impulse * n + i)).collect();
        let not_finite = || {
            let kind = MotionErrorKind::ImpulseNotFinite(name.clone());
            self.error(kind, state.time, &state.values)
        };
        if !impulse.iter().all(|x| x.is_finite()) {
            return Err(not_finite());
        }
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
                if !target.iter().all(|x| x.is_finite()) {
                    return Err(not_finite());
                }
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

    fn add_work(
        &self,
        before: &State,
        after: &mut State,
        (impulse, reaction): (&[DoubleDouble], &[f64]),
        parameters: &[f64],
    ) -> Result<(), MotionError> {
        let Some(place) = self.work_place() else { return Ok(()) };
        let n = self.degrees();
        let work = if self.discontinuities().is_quadratic() && self.form() == Form::Velocity {
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
