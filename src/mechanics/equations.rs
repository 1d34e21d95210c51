//! What follows from a law of motion: the equations and everything derived with them.

use std::collections::HashMap;
use std::sync::Arc;

use super::rigid_body::{RigidBody, Tensor};
use super::structure::{Holonomy, Separation};
use crate::expr::{Expr, Pool, Symbol};
use crate::model::{CommonSymbols, Model, Point, TransformationLaw};
use crate::num::Number;

/// Everything derived from one model.
///
/// What takes elimination (q̈ and λ solved for, the Legendre transform, the test whether H
/// separates) is found when it is first asked for, by the method of the same name as the field, or
/// all at once by [`Equations::find_closed_forms`]. Until then the field holds an error that says
/// so. No motion needs these forms: it is integrated from M and f.
///
/// All expressions live in `pool`. Unless noted otherwise they are functions of (q, q̇, t) for a
/// Lagrangian system and of (q, p, t) for a Hamiltonian one.
#[derive(Clone, Debug)]
pub struct Equations {
    /// The model's pool, with the derived expressions added.
    pub pool: Pool,
    /// The four symbols of each coordinate.
    pub coordinates: Vec<CoordinateSymbols>,
    /// Time, `energy` and `action`.
    pub symbols: CommonSymbols,
    /// p_i: ∂L/∂q̇_i for a Lagrangian, the symbol p_i itself for a Hamiltonian; empty for brackets.
    pub momenta: Vec<Expr>,
    /// The equations of motion in the form in which they are integrated.
    pub flow: Flow,
    /// L or H, as given.
    pub law: Expr,
    /// L, as given or obtained from H by the inverse Legendre transform; see
    /// [`Equations::lagrangian`].
    pub lagrangian: Result<Expr, NoClosedForm>,
    /// H(q, p, t), as given or obtained from L; see [`Equations::hamiltonian`].
    pub hamiltonian: Result<Expr, NoClosedForm>,
    /// q̇(q, p, t), where it exists in closed form, for a Lagrangian system; ∂H/∂p for a
    /// Hamiltonian one; see [`Equations::velocities`].
    pub velocities: Result<Vec<Expr>, NoClosedForm>,
    /// Jacobi's h = Σ q̇ ∂L/∂q̇ − L, or H.
    pub energy: Expr,
    /// The rate of change of the energy: −∂L/∂t − q̇·∂F/∂q̇ + q̇·Q − Σ λ_β A_β, or ∂H/∂t + Σ force
    /// ∂H/∂p.
    ///
    /// It is exactly zero where energy is conserved. Its integral is the other side of the energy
    /// balance.
    pub energy_rate: Expr,
    /// d(action)/dt = L (for a Hamiltonian system Σ p ∂H/∂p − H).
    pub action_rate: Expr,
    /// q̈ as a function of (q, q̇, t), solved symbolically (Lagrangian), or q̇ then ṗ
    /// (Hamiltonian); see [`Equations::solved`].
    pub solved: Result<Vec<Expr>, NoClosedForm>,
    /// The constraints on the motion.
    pub constraints: Vec<ConstraintRow>,
    /// λ of each constraint as a function of (q, q̇, t), solved symbolically; see
    /// [`Equations::multipliers`].
    pub multipliers: Result<Vec<Expr>, NoClosedForm>,
    /// The cyclic coordinates, by index.
    pub cyclic: Vec<usize>,
    /// The conserved quantities, each with its reason.
    pub conserved: Vec<Conserved>,
    /// H = T(p) + V(q, t), if H separates in this way and no force acts, which splitting methods
    /// need; see [`Equations::separable`].
    pub separable: Result<Separable, NoClosedForm>,
    /// Which of the closed forms have not been searched for yet.
    pub(super) pending: Pending,
    /// What acts beside the law, so that the motion does not follow from H alone.
    pub(super) beside: Option<&'static str>,
    /// What accompanies the equations of motion.
    pub supplements: Supplements,
}

/// A transformation as relations between the old and the new variables.
#[derive(Clone, Debug)]
pub struct ImplicitMap {
    /// Q…, then P…; of maps one after the other then what lies between them.
    pub new: Vec<Symbol>,
    /// Expressions of (q, p, t) and these that vanish, as many as there are of these.
    pub relations: Vec<Expr>,
    /// Their derivatives with respect to the new variables, a row for each relation.
    pub by_new: Vec<Vec<Expr>>,
    /// The variable that each relation gives, as itself less the relation, in terms of those of the generating function; of
    /// an explicit map the new variables; of maps one after the other none.
    pub own: Vec<Symbol>,
}

/// What is integrated, drawn or derived alongside the equations of motion without affecting them.
#[derive(Clone, Debug, Default)]
pub struct Supplements {
    /// Numbers that are integrated alongside the motion and do not act on it.
    pub auxiliary: Vec<Auxiliary>,
    /// The vakonomic comparison motion, if the file asks for it.
    pub vakonomic: Option<Vakonomic>,
    /// The particles of each frame, as seen from it.
    pub frames: Vec<Vec<Apparent>>,
    /// The body of the file, assembled from its pieces.
    pub body: Option<RigidBody>,
    /// The attitude matrix of the body, if it follows from Euler's angles.
    pub attitude: Option<Tensor>,
    /// The maps of transformations.
    pub maps: TransformationMaps,
    /// q̇ as columns show it, if that is not what the state moves by.
    pub shown_velocities: Option<Vec<Expr>>,
    /// The symbols of the attitude matrix, by rows.
    pub attitude_symbols: Option<[[Symbol; 3]; 3]>,
    /// Of each constraint whether it is holonomic.
    pub holonomy: Vec<Holonomy>,
    /// Whether Hamilton–Jacobi separates in the file's coordinates, once that has been determined.
    pub separation: Option<Separation>,
    /// The law and what follows from it with ramped parameters by their names, if there are any.
    pub named_ramps: Option<Arc<NamedRamps>>,
    /// The law from which that is derived, until it has been.
    pub law_with_ramps_named: Option<Arc<Model>>,
    /// Where parameters keep their names: of each, and of its rates, the rate.
    pub ramp_rates: Vec<(Symbol, Expr)>,
    /// The file's values of the parameters and of what follows from a body, as exact numbers.
    pub constants: Vec<(Symbol, Number)>,
}

/// The maps of the transformations of a file, as far as they are known.
#[derive(Clone, Debug, Default)]
pub struct TransformationMaps {
    /// For each transformation its new variables as functions of (q, p, t), if they can be written down.
    pub written: Vec<Option<Vec<(Symbol, Expr)>>>,
    /// The laws of the transformations, those made of others written out where that is possible, else as chains.
    pub laws: Vec<TransformationLaw>,
    /// New variables of transformations and constants of the complete integral, as functions of
    /// (q, p, t), as far as they can be written down.
    pub new_variables: Vec<(Symbol, Expr)>,
    /// The transformations that cannot be written down, whose new variables other expressions may use, each with the
    /// image of a point near the start.
    pub implicit: Vec<(ImplicitMap, Vec<f64>)>,
}

/// A law whose parameters change with the time, and what follows from it, with these parameters and their rates as symbols.
#[derive(Clone, Debug)]
pub struct NamedRamps {
    /// The model, with the parameters by name.
    pub model: Model,
    /// What follows from it.
    pub equations: Equations,
}

impl Supplements {
    /// Returns supplements that are empty except for the symbols of the model's attitude.
    pub(super) fn of(model: &Model) -> Supplements {
        let attitude_symbols = model.attitude.as_ref().map(|a| a.matrix);
        Supplements { attitude_symbols, ..Supplements::default() }
    }
}

/// The symbols of a coordinate, its rates and its momentum.
#[derive(Clone, Copy, Debug)]
pub struct CoordinateSymbols {
    /// q.
    pub position: Symbol,
    /// q̇.
    pub velocity: Symbol,
    /// q̈.
    pub acceleration: Symbol,
    /// p.
    pub momentum: Symbol,
}

/// One constraint Σ A_α q̇_α + A = 0 in the form that the equations of motion need.
#[derive(Clone, Debug)]
pub struct ConstraintRow {
    /// Its name in the file.
    pub name: String,
    /// λ; the force on each coordinate is λ A_α.
    pub multiplier: Symbol,
    /// A_α(q, t): ∂f/∂q_α of a holonomic constraint.
    pub row: Vec<Expr>,
    /// A(q, t): ∂f/∂t of a holonomic constraint.
    pub rate: Expr,
    /// γ(q, q̇, t) of A q̈ = γ, the time derivative of the constraint.
    pub bias: Expr,
    /// f(q, t), if the constraint is holonomic.
    pub position: Option<Expr>,
}

/// Numbers that are integrated alongside the motion: functions of the state, of themselves and of
/// t.
#[derive(Clone, Debug)]
pub struct Auxiliary {
    /// Their symbols, in the order in which a state carries them.
    pub symbols: Vec<Symbol>,
    /// Their rates of change.
    pub rates: AuxiliaryRates,
    /// Their initial values, in terms of the initial state and the parameters.
    pub initial: AuxiliaryRates,
}

/// One expression for each number: first explicit ones, then the solution of linear equations.
#[derive(Clone, Debug)]
pub struct AuxiliaryRates {
    /// The explicit expressions.
    pub plain: Vec<Expr>,
    /// The matrix of the linear equations for the others.
    pub matrix: Vec<Vec<Expr>>,
    /// The right-hand side of these equations.
    pub right: Vec<Expr>,
}

/// The vakonomic comparison motion.
#[derive(Clone, Debug)]
pub struct Vakonomic {
    /// The first of its numbers among the auxiliary ones, its first coordinate.
    pub first: Option<Symbol>,
    /// L with the constraints substituted into it.
    pub lagrangian: Result<Expr, NoClosedForm>,
}

/// The equations of motion in the form in which they are integrated.
#[derive(Clone, Debug)]
pub enum Flow {
    /// M q̈ = f + Aᵀλ.
    Lagrange {
        /// M_ij = ∂²L/∂q̇_i ∂q̇_j, symmetric.
        mass: Vec<Vec<Expr>>,
        /// f = ∂L/∂q − (∂²L/∂q̇∂q) q̇ − ∂²L/∂q̇∂t − ∂F/∂q̇ + Q.
        force: Vec<Expr>,
        /// ṗ as a function of (q, q̇, t) and the multipliers' symbols: ∂L/∂q − ∂F/∂q̇ + Q + Aᵀλ.
        momentum_rates: Vec<Expr>,
    },
    /// q̇ = ∂H/∂p, ṗ = −∂H/∂q + force.
    Hamilton {
        /// q̇.
        velocities: Vec<Expr>,
        /// ṗ.
        momentum_rates: Vec<Expr>,
    },
    /// ẋ = {x, H} + force.
    Poisson {
        /// ẋ.
        rates: Vec<Expr>,
    },
}

impl Flow {
    /// The expressions by which the motion is integrated.
    pub fn expressions(&self) -> Vec<Expr> {
        match self {
            Flow::Lagrange { mass, force, .. } => [&mass.concat()[..], force].concat(),
            Flow::Hamilton { velocities, momentum_rates } => {
                [&velocities[..], momentum_rates].concat()
            }
            Flow::Poisson { rates } => rates.clone(),
        }
    }
}

/// The largest number of nodes at which a solved or transformed expression is still reported.
pub const CLOSED_FORM_LIMIT: u64 = 10_000;

/// A particle as seen from a frame.
#[derive(Clone, Debug)]
pub struct Apparent {
    /// r', its position.
    pub at: Point,
    /// v', its velocity in the frame.
    pub velocity: Point,
    /// −m ω×(ω×r').
    pub centrifugal: Point,
    /// −2m ω×v'.
    pub coriolis: Point,
    /// −m ω'×r'; zero if the frame rotates uniformly.
    pub euler: Point,
    /// −m R(−α) o''; zero if the origin is not accelerated.
    pub dragging: Point,
}

/// A conserved quantity.
#[derive(Clone, Debug)]
pub struct Conserved {
    /// `energy`, `p_phi`, or an observable's name.
    pub name: String,
    /// The quantity as a function of the state.
    pub expression: Expr,
    /// Why it is conserved.
    pub reason: Reason,
}

/// Why a quantity is conserved.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Reason {
    /// ∂L/∂q_i = 0 and no force acts on q_i. Carries the coordinate's display name.
    Cyclic(String),
    /// ∂H/∂p_i = 0, so that q_i stays: the dual of a cyclic coordinate. Carries the momentum's display name.
    AbsentMomentum(String),
    /// ∂L/∂t = 0 (or ∂H/∂t = 0, according to the letter) and nothing dissipates or drives.
    TimeTranslation(char),
    /// A common translation of these coordinates changes nothing. Carries their display names.
    Translation(String),
    /// A common rotation of these angles changes nothing. Carries their display names.
    CommonRotation(String),
    /// A rotation of all points about this axis changes nothing.
    Rotation(char),
    /// It has zero bracket with everything, and no force changes it.
    Casimir,
    /// dG/dt = 0 along the motion, proved symbolically.
    Proved,
    /// The same, for a Hamiltonian motion on which nothing else acts: \[G, H\] + ∂G/∂t = 0.
    Commutes,
    /// dG/dt = 0 wherever the constraints are satisfied, proved symbolically.
    ProvedOnConstraints,
    /// dG/dt = 0 to rounding at points of all magnitudes. No proof was found, but nothing in the
    /// rate could escape a few points.
    Numerically,
    /// Its rate vanishes at the present values of the parameters, proved symbolically. Carries the sentence that names them.
    AtValues(String),
    /// The file declares it; the numerical drift shows how well it holds.
    Declared,
    /// The file declares it of its own motion: its rate is known not to vanish elsewhere.
    OfThisMotion,
    /// Conserved for this reason, except that an impulse of the file changes it.
    BetweenImpulses(Box<Reason>),
}

/// H = T(p) + V(q, t).
#[derive(Clone, Debug)]
pub struct Separable {
    /// ∂T/∂p, in p only.
    pub velocities: Vec<Expr>,
    /// −∂V/∂q, in q and t only.
    pub momentum_rates: Vec<Expr>,
}

/// The closed forms that have not been searched for yet.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Pending {
    /// q̈ and λ.
    pub(super) solved: bool,
    /// H and q̇(q, p, t) of a Lagrangian system, L of a Hamiltonian one.
    pub(super) transform: bool,
    /// H = T(p) + V(q, t).
    pub(super) separable: bool,
}

/// Why something does not exist in closed form, as a sentence for the user.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{0}")]
pub struct NoClosedForm(pub String);

impl NoClosedForm {
    /// The error in the place of a closed form that has not been searched for yet.
    pub(super) fn pending() -> NoClosedForm {
        NoClosedForm("it has not been derived yet".to_owned())
    }
}

impl Equations {
    /// The file's values of the parameters, to be substituted for their symbols.
    pub(super) fn parameter_values(&mut self) -> HashMap<Symbol, Expr> {
        let constants = self.supplements.constants.clone();
        constants.into_iter().map(|(s, n)| (s, self.pool.number(n))).collect()
    }

    /// Does something that may be done without, as an [attempt](Pool::attempt) of the pool. Nothing else of the equations
    /// may change by it.
    pub(super) fn attempt<T>(
        &mut self,
        allowance: u64,
        find: impl FnOnce(&mut Equations) -> Option<T>,
    ) -> Option<T> {
        let attempt = self.pool.begin(allowance);
        let found = find(self);
        if self.pool.end(attempt) { found } else { None }
    }

    /// Returns whether the state consists of positions and velocities (Lagrangian) rather than
    /// momenta.
    pub fn is_lagrangian(&self) -> bool {
        matches!(self.flow, Flow::Lagrange { .. })
    }
}

impl CoordinateSymbols {
    /// The symbols of a model's coordinates, in order.
    pub fn of(model: &Model) -> Vec<CoordinateSymbols> {
        let symbols = |c: &crate::model::Coordinate| CoordinateSymbols {
            position: c.position,
            velocity: c.velocity,
            acceleration: c.acceleration,
            momentum: c.momentum,
        };
        model.coordinates.iter().map(symbols).collect()
    }
}

impl Reason {
    /// Returns whether it is proved, not merely declared or found numerically.
    pub fn is_proved(&self) -> bool {
        match self {
            Reason::Declared | Reason::OfThisMotion | Reason::Numerically => false,
            Reason::BetweenImpulses(reason) => reason.is_proved(),
            _ => true,
        }
    }

    /// Returns whether it rests on the file's declaration alone.
    pub fn is_declared(&self) -> bool {
        match self {
            Reason::Declared | Reason::OfThisMotion => true,
            Reason::BetweenImpulses(reason) => reason.is_declared(),
            _ => false,
        }
    }
}

impl std::fmt::Display for Reason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Reason::Cyclic(name) => write!(f, "cyclic {name}"),
            Reason::AbsentMomentum(name) => write!(f, "∂H/∂{name} = 0"),
            Reason::TimeTranslation(law) => write!(f, "∂{law}/∂t = 0"),
            Reason::Translation(names) => write!(f, "translation of {names}"),
            Reason::Rotation(axis) => write!(f, "rotation about {axis}"),
            Reason::Casimir => f.write_str("Casimir, B ∇C = 0"),
            Reason::CommonRotation(names) => write!(f, "rotation of {names} together"),
            Reason::Proved => f.write_str("dG/dt = 0, proved"),
            Reason::Commutes => f.write_str("[G,H] + ∂G/∂t = 0, proved"),
            Reason::ProvedOnConstraints => f.write_str("dG/dt = 0 on the constraints, proved"),
            Reason::Numerically => f.write_str("checked numerically"),
            Reason::AtValues(given) => f.write_str(given),
            Reason::Declared => f.write_str("stated by the file"),
            Reason::OfThisMotion => f.write_str("stated by the file, along this motion only"),
            Reason::BetweenImpulses(reason) => write!(f, "{reason}, between impulses"),
        }
    }
}
