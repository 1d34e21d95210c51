//! The phase space of a system: its canonical variables (q, p), or the variables of its brackets,
//! at one set of parameters.
//!
//! In: a model, its equations, a compiled system, parameters. Out: what is known of its motions before any is followed. Never
//! here: which systems are unsuited.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::drive::{acts, coordinate_period, drive_period};
use super::error::DynamicsError;
use super::even_powers::has_one_strict_minimum;
use super::levels::Levels;
use super::passivity::never_adds_energy;
use super::unsuited::{
    acts_by_the_clock, refuse, refuse_acts, refuse_acts_but, refuse_constraints,
};
use crate::cancel::Cancel;
use crate::expr::Expr;
use crate::mechanics::Equations;
use crate::model::{EventAction, Mechanics, Model};
use crate::system::{Form, MotionError, State, System};

/// Why nothing is asked of a system whose constraints allow no displacement.
pub(super) const NOTHING_MOVES: &str = "the constraints leave nothing that could move";

/// A model, what was derived from it, and the compiled system.
pub type CompiledLaw<'a> = (&'a Model, &'a Equations, &'a System);

/// A system in canonical variables.
#[derive(Clone, Debug)]
pub struct PhaseSpace {
    system: System,
    parameters: Vec<f64>,
    names: Vec<String>,
    unforced: bool,
    hamiltonian: bool,
    autonomous: bool,
    conservative: bool,
    /// Whether the energy is known to grow nowhere.
    passive: bool,
    /// The period of the drive, of a law that depends on time.
    drive: Option<f64>,
    jumps: bool,
    constrained: bool,
    periods: Vec<Option<f64>>,
    /// The period of the law in each coordinate.
    turns: Vec<Option<f64>>,
    cyclic: Vec<usize>,
    /// Whether the form of V, or H, shows one strict minimum.
    has_one_strict_minimum: bool,
    /// The functions whose level sets hold motions that are given by brackets.
    levels: Option<Arc<Levels>>,
}

impl PhaseSpace {
    /// The phase space of a compiled system at these parameters.
    ///
    /// # Errors
    /// Returns an error if the motion has no derivative everywhere, is subject to constraints, or
    /// impulses act on it.
    pub fn of(law: CompiledLaw<'_>, parameters: &[f64]) -> Result<PhaseSpace, DynamicsError> {
        refuse_acts(law.2)?;
        PhaseSpace::through_impulses(law, parameters)
    }

    /// The phase space of a system whose events do nothing but end the motion; here the motion continues past them.
    ///
    /// # Errors
    /// Returns an error if the motion has no derivative everywhere, is subject to constraints, or impulses act on it.
    pub fn without_end(
        law: CompiledLaw<'_>,
        parameters: &[f64],
    ) -> Result<PhaseSpace, DynamicsError> {
        refuse_acts_but(law.2, |action| action == EventAction::Stop)?;
        refuse_constraints(law.2)?;
        PhaseSpace::read(law, parameters, false)
    }

    /// The phase space of a system that may be subject to constraints, and on whose motion no impulses act.
    ///
    /// # Errors
    /// Returns an error if the motion has no derivative everywhere, or impulses act on it.
    pub fn without_impulses(
        law: CompiledLaw<'_>,
        parameters: &[f64],
    ) -> Result<PhaseSpace, DynamicsError> {
        refuse_acts(law.2)?;
        PhaseSpace::read(law, parameters, false)
    }

    /// The phase space of a system that may be subject to constraints. Its variables are then not independent: the states
    /// are those that satisfy the constraints, and the displacements those of [`PhaseSpace::allowed_displacements`].
    /// Without constraints, impulses may act on the motion.
    ///
    /// # Errors
    /// Returns an error if the motion has no derivative everywhere else, or if impulses or events act on a motion that is
    /// subject to constraints.
    pub fn on_constraints(
        law: CompiledLaw<'_>,
        parameters: &[f64],
    ) -> Result<PhaseSpace, DynamicsError> {
        if law.2.constraints() > 0 {
            refuse_acts(law.2)?;
        }
        PhaseSpace::read(law, parameters, refuse_acts(law.2).is_err())
    }

    /// The phase space of a system on whose motion impulses may act, at their times or caused by
    /// events. Between them it may be Hamilton's; over them it counts as neither Hamilton's nor
    /// conservative.
    ///
    /// # Errors
    /// Returns an error if the motion has no derivative everywhere else, or is subject to constraints.
    pub fn through_impulses(
        law: CompiledLaw<'_>,
        parameters: &[f64],
    ) -> Result<PhaseSpace, DynamicsError> {
        refuse_constraints(law.2)?;
        PhaseSpace::read(law, parameters, refuse_acts(law.2).is_err())
    }

    fn read(
        (model, equations, system): CompiledLaw<'_>,
        parameters: &[f64],
        jumps: bool,
    ) -> Result<PhaseSpace, DynamicsError> {
        refuse(system)?;
        let n = system.degrees();
        let channels = system.channels();
        let (names, degrees): (Vec<String>, _) = if system.form() == Form::Variables {
            (channels[..n].iter().map(|c| c.name.clone()).collect(), n)
        } else {
            let q = channels[..n].iter();
            (q.chain(&channels[2 * n..3 * n]).map(|c| c.name.clone()).collect(), n)
        };
        let none = |forces: &[Expr]| forces.iter().all(|&force| force == Expr::ZERO);
        let unforced = match &model.mechanics {
            Mechanics::Lagrangian { dissipation, forces, .. } => {
                *dissipation == Expr::ZERO && none(forces)
            }
            Mechanics::Hamiltonian { forces, .. } | Mechanics::Poisson { forces, .. } => {
                none(forces)
            }
        };
        let timeless = !system.without_tangents().exact_rates().depends_on_time();
        let moving = acts(model).iter().any(|&e| equations.pool.depends(e, model.symbols.time));
        let autonomous = timeless && !acts_by_the_clock(system) && !moving;
        let mut periods: Vec<Option<f64>> =
            (0..degrees).map(|i| system.period(i, parameters)).collect();
        let mut turns = periods.clone();
        for (i, turn) in turns.iter_mut().enumerate().filter(|(i, _)| !equations.cyclic.contains(i))
        {
            *turn = turn.or_else(|| coordinate_period(model, equations, parameters, i));
        }
        turns.resize(names.len(), None);
        periods.resize(names.len(), None);
        let conservative = autonomous && !jumps && equations.energy_rate == Expr::ZERO;
        let levels = if jumps { None } else { Levels::of(model, equations, conservative)? };
        let passive = autonomous && !jumps && never_adds_energy(model, equations, parameters);
        Ok(PhaseSpace {
            levels: levels.map(Arc::new),
            system: system.without_tangents(),
            parameters: parameters.to_vec(),
            names,
            unforced,
            hamiltonian: unforced && !model.is_poisson() && !jumps && system.is_holonomic(),
            autonomous,
            jumps,
            constrained: system.constraints() > 0,
            drive: (!autonomous)
                .then(|| drive_period(model, equations, system, parameters))
                .flatten(),
            conservative,
            passive: conservative || passive,
            has_one_strict_minimum: equations.cyclic.is_empty()
                && system.constraints() == 0
                && has_one_strict_minimum(model, equations, parameters),
            periods,
            turns,
            cyclic: equations
                .cyclic
                .iter()
                .copied()
                .filter(|&i| !in_a_constraint(equations, i))
                .collect(),
        })
    }

    /// The compiled law.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// The values that it is at, in the order of the model.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// The same space at other parameters, at which neither the period of the drive is known nor what friction does.
    #[must_use]
    pub fn at_parameters(&self, parameters: &[f64]) -> PhaseSpace {
        let drive = self.drive.filter(|_| parameters == self.parameters);
        let passive = self.conservative || self.passive && parameters == self.parameters;
        let has_one_strict_minimum = self.has_one_strict_minimum && parameters == self.parameters;
        let parameters = parameters.to_vec();
        PhaseSpace { parameters, passive, drive, has_one_strict_minimum, ..self.clone() }
    }

    /// The same space, whose motions are followed until this token is set.
    #[must_use]
    pub fn with_cancel(&self, cancel: &Cancel) -> PhaseSpace {
        PhaseSpace { system: self.system.with_cancel(cancel.clone()), ..self.clone() }
    }

    /// The period of the drive, where the law depends on time by sines and cosines of a t + b, or impulses act at equal
    /// intervals, that have a common one.
    pub fn drive(&self) -> Option<f64> {
        self.drive
    }

    /// The names of the variables: coordinates, then momenta; or the variables of brackets.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The number of variables.
    pub fn dimension(&self) -> usize {
        self.names.len()
    }

    /// The form of its states.
    pub fn form(&self) -> Form {
        if self.system.form() == Form::Variables { Form::Variables } else { Form::Momentum }
    }

    /// Whether its variables are canonical and the motion is Hamilton's, without other forces.
    pub fn is_hamiltonian(&self) -> bool {
        self.hamiltonian
    }

    /// Whether no forces act but those of L, H or the brackets.
    pub(super) fn is_unforced(&self) -> bool {
        self.unforced
    }

    /// Whether the law of motion is the same at all times.
    pub fn is_autonomous(&self) -> bool {
        self.autonomous
    }

    /// Whether the energy is conserved at all times.
    pub fn is_conservative(&self) -> bool {
        self.conservative
    }

    /// Whether the energy is conserved or falls: the form of its rate shows that it grows at no state.
    pub fn is_passive(&self) -> bool {
        self.passive
    }

    /// Whether the form of V, or H, shows that it has one strict minimum, which is then the only equilibrium.
    pub(super) fn has_one_strict_minimum(&self) -> bool {
        self.has_one_strict_minimum
    }

    /// Whether periodic orbits come in families over the energy: it is conserved, and its gradient is known.
    pub fn has_energy_levels(&self) -> bool {
        self.autonomous
            && (self.hamiltonian || self.levels.as_ref().is_some_and(|levels| levels.has_energy()))
    }

    /// The functions whose level sets hold motions that are given by brackets.
    pub(super) fn levels(&self) -> Option<&Levels> {
        self.levels.as_deref()
    }

    /// Whether impulses may act on the motion, or events end it.
    pub fn has_jumps(&self) -> bool {
        self.jumps
    }

    /// Whether constraints hold the motion, so that not all displacements are allowed.
    pub fn is_constrained(&self) -> bool {
        self.constrained
    }

    /// The displacements of a state that the constraints allow, in the variables of this space: the projection onto them,
    /// and their dimension. Without constraints all are.
    ///
    /// # Errors
    /// Returns an error where the constraints or the mass matrix are singular.
    pub fn allowed_displacements(
        &self,
        state: &State,
    ) -> Result<(DMatrix<f64>, usize), MotionError> {
        let n = self.dimension();
        if !self.constrained {
            return Ok((DMatrix::identity(n, n), n));
        }
        let found = self.system.allowed_displacements(state, &self.parameters)?;
        Ok((DMatrix::from_row_slice(n, n, &found.matrix), found.dimension))
    }

    /// The cyclic coordinates, by index.
    pub fn cyclic(&self) -> &[usize] {
        &self.cyclic
    }

    /// The period of each variable, if it has one.
    pub fn periods(&self) -> &[Option<f64>] {
        &self.periods
    }

    /// The period of the law in each variable: its own, or what the sines and cosines have in common by which alone it enters.
    pub fn turns(&self) -> &[Option<f64>] {
        &self.turns
    }

    /// A state in the variables of this space.
    ///
    /// # Errors
    /// Returns an error if the velocities have no momenta.
    pub fn state(&self, state: &State) -> Result<State, MotionError> {
        self.system.convert(state, self.form(), &self.parameters)
    }

    /// A state at these variables. The auxiliary numbers are those of `like`.
    pub fn state_at(&self, like: &State, variables: &[f64]) -> State {
        let mut state = like.clone();
        for (i, &x) in variables.iter().enumerate() {
            state.values[i] = x;
            state.carry[i] = 0.0;
        }
        state
    }

    /// The variables of a state.
    pub fn variables<'a>(&self, state: &'a State) -> &'a [f64] {
        &state.values[..self.dimension()]
    }
}

/// Whether a constraint depends on a coordinate, which L may lack.
fn in_a_constraint(equations: &Equations, coordinate: usize) -> bool {
    let position = equations.coordinates[coordinate].position;
    let mut entries = equations.constraints.iter().flat_map(|one| &one.row);
    entries.any(|&entry| equations.pool.depends(entry, position))
}
