//! The constraints of a compiled system: which are enforced, and states that satisfy them.
//!
//! In: states, impulses, requests to release a constraint. Out: states on the constraints,
//! reactions, residuals. Never here: the constraint forces along the motion, which are outputs of
//! the programs.

use super::conditions::{Conditions, ConstraintSpan, Programs};
use super::consistent_initial::{self, InconsistentStart, KnownVelocity};
use super::error::{MotionError, MotionErrorKind};
use super::inertia::Inertia;
use super::kkt::ConstraintSystem;
use super::projection::{Projection, ProjectionError};
use super::rhs::ProgramBuilder;
use super::value::Evaluator;
use super::{Form, State, System};
use crate::expr::{Expr, Symbol};
use crate::model::{Action, Model};
use crate::num::DoubleDouble;

/// What is known of the constraints before any state.
#[derive(Clone, Debug)]
pub(super) struct Constrained {
    programs: Programs,
    pub(super) names: Vec<String>,
    /// Whether any constraint involves each coordinate's velocity.
    touched: Vec<bool>,
    /// Whether the programs take two switches for each constraint.
    pub(super) switched: bool,
}

/// Which constraints are enforced.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(super) struct ActiveSet {
    /// The constraints that have not been released.
    active: Vec<bool>,
    /// The active constraints whose multipliers are solved for. The others depend on these.
    enforced: Vec<bool>,
}

impl ActiveSet {
    /// The switches of the programs: enforced and active, for each constraint.
    pub(super) fn switches(&self, count: usize) -> impl Iterator<Item = DoubleDouble> {
        let number = |on: bool| if on { DoubleDouble::ONE } else { DoubleDouble::ZERO };
        (0..count).flat_map(move |k| [number(self.enforced[k]), number(self.active[k])])
    }
}

impl Constrained {
    /// Evaluates the constraints at the file's initial state and makes `builder` write their
    /// multipliers accordingly.
    pub(super) fn of(
        model: &Model,
        builder: &mut ProgramBuilder<'_>,
        inertia: Option<&Inertia>,
    ) -> Result<Option<(Constrained, ActiveSet)>, Symbol> {
        let rows = &builder.equations.constraints;
        if rows.is_empty() {
            // the mass matrix alone
            builder.kkt = ConstraintSystem::of(&mut builder.pool, builder.equations, false, false);
            return Ok(None);
        }
        let programs = Programs::of(builder)?;
        let enforced = independent_at_start(model, builder, &programs, inertia)?;
        let redundant = enforced.contains(&false);
        let released = model.events.iter().any(|e| matches!(e.action, Action::Release(_)));
        let switched = redundant || released;
        let kkt = ConstraintSystem::of(&mut builder.pool, builder.equations, switched, redundant);
        builder.parameters.extend(kkt.switches.iter().flat_map(|s| [s.held, s.active]));
        builder.kkt = kkt;
        let constrained = Constrained {
            programs,
            touched: (0..model.coordinates.len())
                .map(|i| rows.iter().any(|row| row.row[i] != Expr::ZERO))
                .collect(),
            names: rows.iter().map(|row| row.name.clone()).collect(),
            switched,
        };
        let active = vec![true; rows.len()];
        Ok(Some((constrained, ActiveSet { active, enforced })))
    }
}

/// Returns which constraints are independent of those before them at the file's initial state.
fn independent_at_start(
    model: &Model,
    builder: &mut ProgramBuilder<'_>,
    programs: &Programs,
    inertia: Option<&Inertia>,
) -> Result<Vec<bool>, Symbol> {
    let count = builder.equations.constraints.len();
    let mut lowering = builder.lowering();
    let outputs = model.coordinates.iter().map(|c| lowering.lower(c.initial)).collect();
    let start = lowering.finish(outputs)?;
    let mut parameters: Vec<DoubleDouble> =
        model.parameters.iter().map(|p| DoubleDouble::written(p.value)).collect();
    if let Some(inertia) = inertia {
        parameters.extend(inertia.values(&parameters));
    }
    let mut values: Evaluator<DoubleDouble> = Evaluator::new(start);
    values.set_parameters(&parameters);
    let positions: Vec<DoubleDouble> =
        (0..model.coordinates.len()).map(|i| values.output(i)).collect();
    let mut conditions = Conditions::new(programs, count);
    conditions.set_parameters(&parameters);
    conditions.look(DoubleDouble::written(model.run.start), &positions);
    Ok(conditions.independent(&vec![true; count]))
}

/// Where the sine between the constraints' directions is smaller than this, a failure is attributed
/// to a singular configuration nearby: near a regular one corrections converge from much farther
/// away.
const NEARLY_SINGULAR: f64 = 1e-3;

/// If the orthogonal components of the enforced rows fall below this, another choice among the
/// redundant constraints is tried …
const DEPENDENT: f64 = 0.03;

/// … and taken if its components are larger by this factor.
const GAINED: f64 = 4.0;

/// The space of the constraints' directions at a state, with its orientation.
#[derive(Clone, PartialEq, Debug)]
pub struct Directions(ConstraintSpan);

impl Directions {
    /// The cosine of the angle between two spaces of directions. It changes smoothly along a
    /// motion, and jumps from 1 to −1 where the motion passes a singular configuration.
    pub fn cosine(&self, other: &Directions) -> f64 {
        self.0.cosine(&other.0)
    }
}

/// Projects the states of one system onto its constraints, at one set of parameters. It owns its
/// registers.
#[derive(Clone, Debug)]
pub struct ConstraintProjector {
    system: System,
    projection: Projection,
    numbers: Vec<DoubleDouble>,
}

impl ConstraintProjector {
    /// Sets the parameters.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        self.projection.set_parameters(&self.system.inputs(parameters));
    }

    /// Takes what the constraints on the velocities keep constant from a state where a motion begins
    /// or goes on.
    pub fn take_levels(&mut self, state: &State) {
        self.load(state);
        let conditions = self.projection.conditions();
        conditions.look(state.exact_time(), &self.numbers);
        conditions.take_levels();
    }

    fn load(&mut self, state: &State) {
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
        let ActiveSet { active, enforced } = self.system.holding();
        let conditions = self.projection.conditions();
        let velocities = &self.numbers[self.system.degrees()..];
        for k in (0..active.len()).filter(|&k| active[k] && !enforced[k]) {
            let off = conditions.position(k).relative();
            let off = off.max(conditions.velocity(k, velocities).relative());
            if off.is_nan() || off > consistent_initial::GIVEN_WITHIN {
                return Err(self.system.lost(ProjectionError::Parted(k), state));
            }
        }
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
        let shrunk = |beside: Directions| here.0.volume() < NEARLY_SINGULAR * beside.0.volume();
        let enforced = self.system.holding().enforced.clone();
        self.projection.conditions().independence(&enforced) < NEARLY_SINGULAR
            || beside.is_some_and(shrunk)
    }

    /// The directions of the constraints at a state, in the units of `like` if it is given. Returns
    /// `None` at a singular configuration.
    pub fn directions(&mut self, state: &State, like: Option<&Directions>) -> Option<Directions> {
        self.load(state);
        let enforced = self.system.holding().enforced.clone();
        let conditions = self.projection.conditions();
        conditions.look(state.exact_time(), &self.numbers);
        let units = like.map(|like| like.0.units());
        conditions.span(&enforced, units).map(Directions)
    }

    /// The residuals of each constraint at a state (q, q̇), relative to the size of its terms: of
    /// f(q, t) if it is holonomic (else zero), and of A q̇ + A₀. Released constraints count as
    /// zero.
    pub fn residuals(&mut self, state: &State) -> Vec<[f64; 2]> {
        self.load(state);
        let n = self.system.degrees();
        let active = self.system.holding().active.clone();
        let conditions = self.projection.conditions();
        conditions.look(state.exact_time(), &self.numbers);
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

impl System {
    /// The number of constraints.
    pub fn constraints(&self) -> usize {
        self.constrained().map_or(0, |c| c.names.len())
    }

    /// The names of the constraints that depend on those before them at the file's initial state.
    /// Their multipliers are those of least norm.
    pub fn redundant(&self) -> Vec<&str> {
        let Some(constrained) = self.constrained() else { return Vec::new() };
        let ActiveSet { active, enforced } = self.holding();
        let names = constrained.names.iter().enumerate();
        names.filter(|&(k, _)| active[k] && !enforced[k]).map(|(_, name)| name.as_str()).collect()
    }

    /// Whether a constraint has been released.
    pub fn is_released(&self, constraint: usize) -> bool {
        self.holding().active.get(constraint).is_some_and(|active| !active)
    }

    /// The same system without one of its constraints, from this state on.
    #[must_use]
    pub fn release(&self, constraint: usize, state: &State, parameters: &[f64]) -> System {
        let mut active = self.holding().active.clone();
        let Some(place) = active.get_mut(constraint) else { return self.clone() };
        *place = false;
        self.enforcing(active, state, parameters)
    }

    /// The same system with all its constraints.
    #[must_use]
    pub fn hold_all(&self, state: &State, parameters: &[f64]) -> System {
        self.enforcing(vec![true; self.constraints()], state, parameters)
    }

    fn enforcing(&self, active: Vec<bool>, state: &State, parameters: &[f64]) -> System {
        let Some(conditions) = self.conditions(parameters, state) else { return self.clone() };
        let enforced = conditions.independent(&active);
        self.with_holding(ActiveSet { active, enforced })
    }

    /// The same system with another choice of enforced constraints, if the current ones have become
    /// dependent and others have not. Returns `None` if no choice is better.
    #[must_use]
    pub fn hold_better(&self, state: &State, parameters: &[f64]) -> Option<System> {
        let ActiveSet { active, enforced } = self.holding();
        if active == enforced {
            return None;
        }
        let conditions = self.conditions(parameters, state)?;
        let now = conditions.strength(active, enforced);
        if now > DEPENDENT {
            return None;
        }
        let count = enforced.iter().filter(|&&enforced| enforced).count();
        let better = conditions.most_independent(active, count)?;
        let gained = conditions.strength(active, &better) > GAINED * now;
        let active = active.clone();
        gained.then(|| self.with_holding(ActiveSet { active, enforced: better }))
    }

    fn conditions(&self, parameters: &[f64], state: &State) -> Option<Conditions> {
        let constrained = self.constrained()?;
        let mut conditions = Conditions::new(&constrained.programs, self.constraints());
        conditions.set_parameters(&self.inputs(parameters));
        let positions: Vec<DoubleDouble> = (0..self.degrees()).map(|i| state.exact(i)).collect();
        conditions.look(state.exact_time(), &positions);
        Some(conditions)
    }

    /// The projector onto the constraints, or `None` if there are none.
    pub fn projector(&self, parameters: &[f64]) -> Option<ConstraintProjector> {
        let conditions = Conditions::new(&self.constrained()?.programs, self.constraints());
        let momenta = Evaluator::new(self.legendre_program());
        let projection = Projection::new(conditions, momenta, &self.holding().enforced);
        let numbers = vec![DoubleDouble::ZERO; self.moving()];
        let mut projector = ConstraintProjector { system: self.clone(), projection, numbers };
        projector.set_parameters(parameters);
        Some(projector)
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
        let ActiveSet { active, enforced } = self.holding();
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
            self.fault(kind, state.time, &state.values)
        };
        for k in 0..self.constraints() {
            let part = conditions.position(k).missed();
            if part.is_nan() || part > consistent_initial::GIVEN_WITHIN {
                return Err(missed(k, part));
            }
        }
        if conditions.independence(&self.holding().enforced) == 0.0 {
            return Err(self.lost(ProjectionError::Singular, &state));
        }
        let mut momenta = Evaluator::new(self.legendre_program());
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
            InconsistentStart::Missed(k, part) => missed(k, part),
            InconsistentStart::Free(free) => {
                let n = self.degrees();
                let names = free.iter().map(|i| self.channels()[n + i].name.clone()).collect();
                let kind = MotionErrorKind::FreeVelocities(names);
                MotionError { time: state.time, kind, place: Vec::new() }
            }
            InconsistentStart::Contradiction => {
                self.fault(MotionErrorKind::Contradiction, state.time, &state.values)
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

    fn lost(&self, why: ProjectionError, state: &State) -> MotionError {
        let kind = match (why, self.constrained()) {
            (ProjectionError::Lost(k), Some(c)) => {
                MotionErrorKind::ConstraintLost(c.names[k].clone())
            }
            (ProjectionError::Parted(k), Some(c)) => {
                MotionErrorKind::ConstraintParted(c.names[k].clone())
            }
            (ProjectionError::Singular, _) | (_, None) => {
                MotionErrorKind::SingularConstraints(None)
            }
        };
        self.fault(kind, state.time, &state.values)
    }
}
