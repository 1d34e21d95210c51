//! A system under constraints: which of them are enforced, consistent initial states, and impulses.
//!
//! In: states, impulses, requests to release a constraint. Out: systems with another active set, states on the
//! constraints, reactions. Never here: how a state is projected.

use std::sync::Arc;

use super::active_set::ActiveSet;
use super::conditions::Conditions;
use super::consistent_initial::{self, InconsistentStart, KnownVelocity};
use super::constraint_programs::GIVEN_WITHIN;
use super::error::{MotionError, MotionErrorKind};
use super::projection::ProjectionError;
use super::value::Evaluator;
use super::{Form, State, System};
use crate::num::DoubleDouble;

/// If the orthogonal components of the enforced rows fall below this, another choice among the redundant constraints
/// is tried.
const DEPENDENT: f64 = 0.03;

/// Another choice is taken if its orthogonal components are larger by this factor.
const GAINED: f64 = 4.0;

impl System {
    /// The number of constraints.
    pub fn constraints(&self) -> usize {
        self.constrained().map_or(0, |c| c.names.len())
    }

    /// The names of the constraints that depend on those before them at the file's initial state.
    /// Their multipliers are those of least norm.
    pub fn redundant(&self) -> Vec<&str> {
        let Some(constrained) = self.constrained() else { return Vec::new() };
        let ActiveSet { active, enforced } = self.active_set();
        let names = constrained.names.iter().enumerate();
        names.filter(|&(k, _)| active[k] && !enforced[k]).map(|(_, name)| name.as_str()).collect()
    }

    /// Whether a constraint has been released.
    pub fn is_released(&self, constraint: usize) -> bool {
        self.active_set().active.get(constraint).is_some_and(|active| !active)
    }

    /// The same system without one of its constraints, from this state on.
    #[must_use]
    pub fn release(&self, constraint: usize, state: &State, parameters: &[f64]) -> System {
        let mut active = self.active_set().active.clone();
        let Some(place) = active.get_mut(constraint) else { return self.clone() };
        *place = false;
        self.enforcing(active, state, parameters)
    }

    /// The same system with all its constraints.
    #[must_use]
    pub fn activate_all(&self, state: &State, parameters: &[f64]) -> System {
        self.enforcing(vec![true; self.constraints()], state, parameters)
    }

    fn enforcing(&self, active: Vec<bool>, state: &State, parameters: &[f64]) -> System {
        let Some(conditions) = self.conditions(parameters, state) else { return self.clone() };
        let enforced = conditions.independent(&active);
        self.with_active_set(ActiveSet { active, enforced })
    }

    /// The same system with another choice of enforced constraints, if the current ones have become
    /// dependent and others have not. Returns `None` if no choice is better.
    #[must_use]
    pub fn enforce_more_independent(&self, state: &State, parameters: &[f64]) -> Option<System> {
        let ActiveSet { active, enforced } = self.active_set();
        // most systems have no constraints; this is asked before every step
        if active.is_empty() || active == enforced {
            return None;
        }
        let conditions = self.conditions(parameters, state)?;
        let now = conditions.strength(active, enforced);
        if !is_weak(now) {
            return None;
        }
        let count = enforced.iter().filter(|&&enforced| enforced).count();
        let better = conditions.most_independent(active, count)?;
        let gained = is_stronger(conditions.strength(active, &better), now);
        let active = active.clone();
        gained.then(|| self.with_active_set(ActiveSet { active, enforced: better }))
    }

    pub(super) fn conditions(&self, parameters: &[f64], state: &State) -> Option<Conditions> {
        let constrained = self.constrained()?;
        let mut conditions = Conditions::new(&constrained.programs, self.constraints());
        conditions.set_parameters(&self.inputs(parameters));
        let positions: Vec<DoubleDouble> = (0..self.degrees()).map(|i| state.exact(i)).collect();
        conditions.observe(state.exact_time(), &positions);
        Some(conditions)
    }

    /// A₀ of each constraint at a state.
    pub(super) fn constraint_rates(&self, state: &State, parameters: &[f64]) -> Vec<DoubleDouble> {
        let conditions = self.conditions(parameters, state);
        conditions.map_or(Vec::new(), |c| (0..c.count()).map(|k| c.rate(k)).collect())
    }

    /// The state determined by the momenta `target` and the constraints, and the reactions Λ of the
    /// constraints (empty if there are none). q is unchanged, and q̇ of `state` is the first guess.
    pub(super) fn impulse_outcome(
        &self,
        state: &State,
        target: &[DoubleDouble],
        parameters: &[f64],
    ) -> Result<(State, Vec<f64>), MotionError> {
        let Some(mut projector) = self.projector(parameters) else {
            return Ok((state.clone(), vec![]));
        };
        projector.load(state);
        let outcome = projector.projection.impulse_outcome(
            state.exact_time(),
            &mut projector.numbers,
            target,
        );
        let reactions =
            outcome.map_err(|why| self.unsolved(why, state.time, &projector.numbers))?;
        let ActiveSet { active, enforced } = self.active_set();
        let reactions = projector.projection.conditions().least(active, enforced, reactions);
        let mut after = state.clone();
        after.form = Form::Velocity;
        for (i, &x) in projector.numbers.iter().enumerate() {
            after.set(i, x);
        }
        Ok((after, reactions.iter().map(|x| x.high).collect()))
    }

    /// The velocities of an initial state under constraints, from what is known of them.
    pub(super) fn begin_on_constraints(
        &self,
        mut state: State,
        known: &[KnownVelocity],
        parameters: &[f64],
    ) -> Result<State, MotionError> {
        let Some(constrained) = self.constrained() else { return Ok(state) };
        let Some(conditions) = self.conditions(parameters, &state) else { return Ok(state) };
        let missed = |k: usize, part: f64| {
            let kind = MotionErrorKind::ConstraintMissed(constrained.names[k].clone(), part);
            self.error(kind, state.time, &state.values)
        };
        for k in 0..self.constraints() {
            let part = conditions.position(k).missed();
            if part.is_nan() || part > GIVEN_WITHIN {
                return Err(missed(k, part));
            }
        }
        if conditions.independence(&self.active_set().enforced) == 0.0 {
            return Err(self.lost(ProjectionError::Singular, &state));
        }
        let mut momenta = Evaluator::new(Arc::clone(&self.shared.legendre));
        momenta.set_parameters(&self.inputs(parameters));
        let mut numbers: Vec<DoubleDouble> = (0..self.moving()).map(|i| state.exact(i)).collect();
        let time = state.exact_time();
        // a coordinate that no constraint involves starts at rest, as it would without constraints
        let known: Vec<KnownVelocity> = known
            .iter()
            .zip(&constrained.touched)
            .map(|(&known, &touched)| match known {
                KnownVelocity::LeftOut if !touched => KnownVelocity::InitialOverride,
                other => other,
            })
            .collect();
        let found =
            consistent_initial::begin(&conditions, &mut momenta, time, &mut numbers, &known);
        found.map_err(|why| match why {
            InconsistentStart::Missed(k, part) => {
                let (n, name) = (self.degrees(), constrained.names[k].clone());
                let kind = if self.active_set().enforced[k] {
                    MotionErrorKind::VelocitiesMissed(name, part)
                } else {
                    MotionErrorKind::ConstraintInconsistent(name, part)
                };
                let named = self.channels()[n..2 * n].iter().zip(&numbers[n..]);
                let place = named.map(|(c, x)| (c.shown.clone(), x.high)).take(4).collect();
                MotionError { time: state.time, kind, place }
            }
            InconsistentStart::Free(free) => {
                let n = self.degrees();
                let names = free.iter().map(|i| self.channels()[n + i].name.clone()).collect();
                let kind = MotionErrorKind::FreeVelocities(names);
                MotionError { time: state.time, kind, place: Vec::new() }
            }
            InconsistentStart::Contradiction => {
                self.error(MotionErrorKind::Contradiction, state.time, &state.values)
            }
            InconsistentStart::LegendreError(why) => self.unsolved(why, state.time, &numbers),
        })?;
        for (i, &x) in numbers.iter().enumerate() {
            state.set(i, x);
        }
        if let Some(mut projector) = self.projector(parameters) {
            projector.project(&mut state)?;
        }
        Ok(state)
    }
}

/// Whether enforced rows with these orthogonal components have become so dependent that another choice is tried.
fn is_weak(strength: f64) -> bool {
    strength <= DEPENDENT
}

/// Whether another choice is so much more independent that it is taken.
fn is_stronger(other: f64, now: f64) -> bool {
    other > GAINED * now
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_choice_is_tried_below_a_thirtieth_and_taken_from_four_times_as_much_on() {
        assert!(is_weak(0.029) && !is_weak(0.031));
        assert!(is_stronger(0.041, 0.01) && !is_stronger(0.039, 0.01));
    }
}
