//! States moved back onto the constraints.
//!
//! In: states near the constraints. Out: the nearest states on them, residuals, directions. Never here: which constraints
//! are enforced, and the constraint forces along the motion, which are outputs of the programs.

use std::sync::Arc;

use super::active_set::ActiveSet;
use super::conditions::Conditions;
use super::constraint_programs::GIVEN_WITHIN;
use super::constraint_span::ConstraintSpan;
use super::error::{MotionError, MotionErrorKind};
use super::projection::{Projection, ProjectionError};
use super::value::Evaluator;
use super::{State, System};
use crate::num::DoubleDouble;

/// Where the sine between the constraints' directions is smaller than this, a failure is attributed
/// to a singular configuration nearby: near a regular one corrections converge from much farther
/// away.
const NEARLY_SINGULAR: f64 = 1e-3;

/// The space of the constraints' directions at a state, with its orientation.
#[derive(Clone, PartialEq, Debug)]
pub struct ConstraintDirections(ConstraintSpan);

impl ConstraintDirections {
    /// The cosine of the angle between two spaces of directions. It changes smoothly along a
    /// motion, and jumps from 1 to −1 where the motion passes a singular configuration.
    pub fn cosine(&self, other: &ConstraintDirections) -> f64 {
        self.0.cosine(&other.0)
    }
}

/// Projects the states of one system onto its constraints, at one set of parameters. It owns its
/// registers.
#[derive(Clone, Debug)]
pub struct ConstraintProjector {
    pub(super) system: System,
    pub(super) projection: Projection,
    pub(super) numbers: Vec<DoubleDouble>,
}

impl ConstraintProjector {
    /// Takes other values, in the order of the model, for all evaluations to come.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        self.projection.set_parameters(&self.system.inputs(parameters));
    }

    /// Takes the values that constraints on the velocities keep constant, and the turns of angles in others, from a state
    /// where a motion begins or continues.
    pub fn take_levels(&mut self, state: &State) {
        self.load(state);
        let conditions = self.projection.conditions();
        conditions.observe(state.exact_time(), &self.numbers);
        conditions.take_levels();
    }

    pub(super) fn load(&mut self, state: &State) {
        for (i, x) in self.numbers.iter_mut().enumerate() {
            *x = state.exact(i);
        }
    }

    /// Moves a state (q, q̇) back onto the constraints by the least amount, measured by the mass
    /// matrix.
    ///
    /// # Errors
    /// Returns an error if no state nearby satisfies them, or if their directions are dependent.
    pub fn project(&mut self, state: &mut State) -> Result<(), MotionError> {
        self.load(state);
        let outcome = self.projection.project(state.exact_time(), &mut self.numbers);
        if let Err(why) = outcome {
            let singular = self.is_nearly_singular(state, None);
            let why = if singular { ProjectionError::Singular } else { why };
            return Err(self.system.lost(why, state));
        }
        // a constraint that was redundant at the start may have come to contradict the others
        let ActiveSet { active, enforced } = self.system.active_set();
        let conditions = self.projection.conditions();
        let velocities = &self.numbers[self.system.degrees()..];
        for k in (0..active.len()).filter(|&k| active[k] && !enforced[k]) {
            let off = conditions.position(k).relative();
            let off = off.max(conditions.velocity(k, velocities).relative());
            if off.is_nan() || off > GIVEN_WITHIN {
                return Err(self.system.lost(ProjectionError::Contradicts(k), state));
            }
        }
        conditions.take_turns();
        for (i, &x) in self.numbers.iter().enumerate() {
            state.set(i, x);
        }
        Ok(())
    }

    /// Whether a state lies at or near a singular configuration of the constraints: their
    /// directions are nearly dependent, or one nearly vanishes relative to its size at another
    /// state.
    pub fn is_nearly_singular(&mut self, state: &State, beside: Option<&State>) -> bool {
        let beside = beside.and_then(|beside| self.directions(beside, None));
        let Some(here) = self.directions(state, beside.as_ref()) else { return true };
        let shrunk =
            |beside: ConstraintDirections| here.0.volume() < NEARLY_SINGULAR * beside.0.volume();
        let enforced = self.system.active_set().enforced.clone();
        self.projection.conditions().independence(&enforced) < NEARLY_SINGULAR
            || beside.is_some_and(shrunk)
    }

    /// The directions of the constraints at a state, in the units of `like` if it is given. Returns
    /// `None` at a singular configuration.
    pub fn directions(
        &mut self,
        state: &State,
        like: Option<&ConstraintDirections>,
    ) -> Option<ConstraintDirections> {
        self.directions_at(state, 0, like)
    }

    /// The directions of the constraints as [`ConstraintProjector::directions`] gives them, where the coordinates of the
    /// state begin at an index, as those of a comparison motion.
    pub fn directions_at(
        &mut self,
        state: &State,
        first: usize,
        like: Option<&ConstraintDirections>,
    ) -> Option<ConstraintDirections> {
        for (i, x) in self.numbers.iter_mut().enumerate() {
            *x = state.exact(first + i);
        }
        let enforced = self.system.active_set().enforced.clone();
        let conditions = self.projection.conditions();
        conditions.observe(state.exact_time(), &self.numbers);
        let units = like.map(|like| like.0.units());
        conditions.span(&enforced, units).map(ConstraintDirections)
    }

    /// The residuals of each constraint at a state (q, q̇), relative to the size of its terms: of
    /// f(q, t) if it is holonomic (else zero), and of A q̇ + A₀. Released constraints count as
    /// zero.
    pub fn residuals(&mut self, state: &State) -> Vec<[f64; 2]> {
        self.load(state);
        let n = self.system.degrees();
        let active = self.system.active_set().active.clone();
        let conditions = self.projection.conditions();
        conditions.observe(state.exact_time(), &self.numbers);
        let residual = |k: usize| {
            if active[k] {
                let position = conditions.position(k).relative();
                [position, conditions.velocity(k, &self.numbers[n..2 * n]).relative()]
            } else {
                [0.0; 2]
            }
        };
        (0..active.len()).map(residual).collect()
    }
}

impl ConstraintProjector {
    /// The constraints that are enforced, and whether they keep a function of the coordinates constant.
    pub(super) fn enforced(&self) -> Vec<(usize, bool)> {
        let Some(constrained) = self.system.constrained() else { return Vec::new() };
        let programs = &constrained.programs;
        let enforced = self.system.active_set().enforced.iter().enumerate();
        let rows = enforced.filter(|(_, on)| **on);
        rows.map(|(k, _)| (k, programs.holonomic[k] || programs.integrated[k])).collect()
    }
}

impl System {
    /// The projector onto the constraints, or `None` if there are none.
    pub fn projector(&self, parameters: &[f64]) -> Option<ConstraintProjector> {
        let conditions = Conditions::new(&self.constrained()?.programs, self.constraints());
        let momenta = Evaluator::new(Arc::clone(&self.shared.legendre));
        let projection = Projection::new(conditions, momenta, &self.active_set().enforced);
        let numbers = vec![DoubleDouble::ZERO; self.moving()];
        let mut projector = ConstraintProjector { system: self.clone(), projection, numbers };
        projector.set_parameters(parameters);
        Some(projector)
    }

    pub(super) fn lost(&self, why: ProjectionError, state: &State) -> MotionError {
        let kind = match (why, self.constrained()) {
            (ProjectionError::Lost(k), Some(c)) => {
                MotionErrorKind::ConstraintLost(c.names[k].clone())
            }
            (ProjectionError::Contradicts(k), Some(c)) => {
                MotionErrorKind::ConstraintContradicts(c.names[k].clone())
            }
            (ProjectionError::Singular, _) | (_, None) => {
                MotionErrorKind::SingularConstraints(None)
            }
        };
        self.error(kind, state.time, &state.values)
    }
}
