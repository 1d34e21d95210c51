//! What follows from a law of motion.

use super::frames::Apparent;
use super::rigid_body::{RigidBody, Tensor};
use crate::expr::{Expr, Pool, Symbol};
use crate::model::{CommonSymbols, Model};

/// Everything derived from one model. All expressions live in `pool`; they are functions of
/// (q, q̇, t) for a Lagrangian system and of (q, p, t) for a Hamiltonian one, unless said
/// otherwise.
#[derive(Clone, Debug)]
pub struct Equations {
    /// The model's pool, grown by what was derived.
    pub pool: Pool,
    /// The four symbols of each coordinate.
    pub coordinates: Vec<CoordinateSymbols>,
    /// Time, `energy` and `action`.
    pub symbols: CommonSymbols,
    /// p_i: ∂L/∂q̇_i for a Lagrangian, the symbol p_i itself for a Hamiltonian; none for brackets.
    pub momenta: Vec<Expr>,
    /// The equations of motion in the form they are integrated in.
    pub flow: Flow,
    /// L, given or found from H by the inverse Legendre transform.
    pub lagrangian: Result<Expr, NoClosedForm>,
    /// H(q, p, t), given or found from L.
    pub hamiltonian: Result<Expr, NoClosedForm>,
    /// For a Lagrangian system q̇(q, p, t) where it exists in closed form; for a Hamiltonian one
    /// ∂H/∂p.
    pub velocities: Result<Vec<Expr>, NoClosedForm>,
    /// Jacobi's h = Σ q̇ ∂L/∂q̇ − L, or H.
    pub energy: Expr,
    /// dh/dt by its law: −∂L/∂t − q̇·∂F/∂q̇ + q̇·Q − Σ λ_β A_β, or ∂H/∂t + Σ force ∂H/∂p. Exactly zero where
    /// energy is conserved; its integral is the energy ledger's other side.
    pub energy_rate: Expr,
    /// d(action)/dt = L (for a Hamiltonian system Σ p ∂H/∂p − H).
    pub action_rate: Expr,
    /// q̈ as a function of (q, q̇, t), solved symbolically (Lagrangian); q̇ then ṗ (Hamiltonian).
    pub solved: Result<Vec<Expr>, NoClosedForm>,
    /// What the motion is held to.
    pub constraints: Vec<ConstraintRow>,
    /// λ of each constraint as a function of (q, q̇, t), solved symbolically.
    pub multipliers: Result<Vec<Expr>, NoClosedForm>,
    /// The cyclic coordinates, by index.
    pub cyclic: Vec<usize>,
    /// What is conserved, and why.
    pub conserved: Vec<Conserved>,
    /// H = T(p) + V(q, t) where it splits so and no force acts: what splitting methods need.
    pub separable: Result<Separable, NoClosedForm>,
    /// What goes beside the motion.
    pub supplements: Supplements,
}

/// What is integrated, seen or known beside the equations of motion, and has no part in them.
#[derive(Clone, Debug, Default)]
pub struct Supplements {
    /// Numbers that are integrated beside the motion and do not act on it.
    pub auxiliary: Vec<Auxiliary>,
    /// The wrong mechanics beside the right, where the file asks for it.
    pub vakonomic: Option<Vakonomic>,
    /// The particles of each frame, as seen from it.
    pub frames: Vec<Vec<Apparent>>,
    /// The body of the file, put together.
    pub body: Option<RigidBody>,
    /// The matrix of its attitude, where that follows from Euler's angles.
    pub attitude: Option<Tensor>,
    /// The symbols of the matrix, by rows.
    pub attitude_symbols: Option<[[Symbol; 3]; 3]>,
}

impl Supplements {
    /// Nothing yet, but for the symbols that the model's attitude has.
    pub(super) fn of(model: &Model) -> Supplements {
        let attitude_symbols = model.attitude.as_ref().map(|a| a.matrix);
        Supplements { attitude_symbols, ..Supplements::default() }
    }
}

/// The symbols of one coordinate.
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

/// One constraint Σ A_α q̇_α + A = 0 as the equations of motion need it.
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
    /// γ(q, q̇, t) of A q̈ = γ, which follows by d/dt.
    pub bias: Expr,
    /// f(q, t), where the constraint is holonomic.
    pub position: Option<Expr>,
}

/// Numbers that are integrated beside the motion: functions of the state, of themselves and of t.
#[derive(Clone, Debug)]
pub struct Auxiliary {
    /// What they are called, in the order in which a state carries them.
    pub symbols: Vec<Symbol>,
    /// Their rates of change.
    pub rates: AuxiliaryRates,
    /// Their values at the start, of the state there and the parameters.
    pub initial: AuxiliaryRates,
}

/// As many expressions as there are numbers: some as they stand, then the solution of linear
/// equations.
#[derive(Clone, Debug)]
pub struct AuxiliaryRates {
    /// The first ones.
    pub plain: Vec<Expr>,
    /// The matrix of the others.
    pub matrix: Vec<Vec<Expr>>,
    /// Its right side.
    pub right: Vec<Expr>,
}

/// The wrong mechanics beside the right.
#[derive(Clone, Debug)]
pub struct Vakonomic {
    /// L with the constraints put into it.
    pub lagrangian: Result<Expr, NoClosedForm>,
}

/// The equations of motion as they are integrated.
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

/// Something conserved.
#[derive(Clone, Debug)]
pub struct Conserved {
    /// `energy`, `p_phi`, or an observable's name.
    pub name: String,
    /// As a function of the state.
    pub expression: Expr,
    /// Why.
    pub reason: Reason,
}

/// Why something is conserved.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Reason {
    /// ∂L/∂q_i = 0 and no force on it; holds the coordinate's shown name.
    Cyclic(String),
    /// ∂L/∂t = 0 (or ∂H/∂t = 0, as the letter says) and nothing dissipates or drives.
    TimeTranslation(char),
    /// Moving these coordinates together changes nothing; holds their shown names.
    Translation(String),
    /// Turning these angles together changes nothing; holds their shown names.
    CommonRotation(String),
    /// Turning all points about this axis changes nothing.
    Rotation(char),
    /// It has zero bracket with everything, and no force changes it.
    Casimir,
    /// dG/dt = 0 along the motion, proved symbolically.
    Proved,
    /// The same where the motion is Hamilton's and nothing else acts: \[G, H\] + ∂G/∂t = 0.
    Commutes,
    /// dG/dt = 0 wherever the constraints hold, proved symbolically.
    ProvedOnConstraints,
    /// dG/dt = 0 to rounding at points of all magnitudes, no proof found, and nothing in it that a
    /// few points might not show.
    Numerically,
    /// The file says so; the drift is what there is to see.
    Declared,
    /// For this reason, but an impulse of the file changes it.
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

/// Why something does not exist in closed form, as a sentence for the user.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{0}")]
pub struct NoClosedForm(pub String);

impl Equations {
    /// Whether the state holds velocities (Lagrangian) or momenta (Hamiltonian).
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
    /// Whether it is proved: not the file's word, nor only values.
    pub fn is_proved(&self) -> bool {
        match self {
            Reason::Declared | Reason::Numerically => false,
            Reason::BetweenImpulses(reason) => reason.is_proved(),
            _ => true,
        }
    }

    /// Whether there is only the file's word for it.
    pub fn is_declared(&self) -> bool {
        match self {
            Reason::Declared => true,
            Reason::BetweenImpulses(reason) => reason.is_declared(),
            _ => false,
        }
    }
}

impl std::fmt::Display for Reason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Reason::Cyclic(name) => write!(f, "cyclic {name}"),
            Reason::TimeTranslation(law) => write!(f, "∂{law}/∂t = 0"),
            Reason::Translation(names) => write!(f, "translation of {names}"),
            Reason::Rotation(axis) => write!(f, "rotation about {axis}"),
            Reason::Casimir => f.write_str("Casimir, B ∇C = 0"),
            Reason::CommonRotation(names) => write!(f, "rotation of {names} together"),
            Reason::Proved => f.write_str("dG/dt = 0 proved symbolically"),
            Reason::Commutes => f.write_str("[G,H] + ∂G/∂t = 0 proved symbolically"),
            Reason::ProvedOnConstraints => {
                f.write_str("dG/dt = 0 on the constraints, proved symbolically")
            }
            Reason::Numerically => f.write_str("checked numerically"),
            Reason::Declared => f.write_str("declared"),
            Reason::BetweenImpulses(reason) => write!(f, "{reason}, between impulses"),
        }
    }
}
