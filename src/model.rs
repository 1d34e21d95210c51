//! A checked system: every name resolved, nothing left to guess, nothing yet derived.
//!
//! In: what `preset` read and checked. Out: one [`Model`], the input of `mechanics`. Its
//! expressions live in its own [`Pool`]. Never here: files, spans of TOML, equations of motion.

mod body;
mod claim;
mod constraint;
mod coordinate;
mod occurrence;
mod parameter;
mod picture;
mod scope;
mod unit;

use crate::expr::{Expr, Pool, Symbol};

pub use body::{Attitude, AttitudeSource, Body, BodyNames, Comparison, Frame, Piece, Solid, Turn};
pub use claim::{
    Expect, ExpectedBracket, ExpectedCount, ExpectedEvent, ExpectedValue, Observable, SourceRange,
};
pub use constraint::{Constraint, multiplier_name};
pub use coordinate::Coordinate;
pub use occurrence::{Action, Direction, Event, Impulse};
pub use parameter::{Parameter, Scale};
pub use picture::{Channel, Point, Shape, View, ViewKind};
pub use scope::{Allowed, Scope};

/// A mechanical system as a file describes it, checked.
#[derive(Clone, Debug)]
pub struct Model {
    /// Title, notes and where the system comes from.
    pub info: Info,
    /// Where all expressions of the model live.
    pub pool: Pool,
    /// Time, `energy` and `action`.
    pub symbols: CommonSymbols,
    /// The generalised coordinates, in order.
    pub coordinates: Vec<Coordinate>,
    /// The parameters, in order.
    pub parameters: Vec<Parameter>,
    /// Definitions, in order, already opened in every expression that uses them: kept to be shown.
    pub definitions: Vec<(String, Expr)>,
    /// What makes it move.
    pub mechanics: Mechanics,
    /// What the motion is held to; beside a Lagrangian only.
    pub constraints: Vec<Constraint>,
    /// Impulses.
    pub impulses: Vec<Impulse>,
    /// Crossings to be located.
    pub events: Vec<Event>,
    /// A body put together from pieces.
    pub body: Option<Body>,
    /// How a body stands.
    pub attitude: Option<Attitude>,
    /// The wrong mechanics beside the right.
    pub comparison: Option<Comparison>,
    /// Frames a picture may be seen from.
    pub frames: Vec<Frame>,
    /// Where its law, L or H, stands in the file.
    pub law_place: SourceRange,
    /// What the file wants to be watched.
    pub observables: Vec<Observable>,
    /// What the file claims of itself.
    pub expect: Expect,
    /// What the screen opens with.
    pub views: Vec<View>,
    /// The picture of the thing itself.
    pub space: Vec<Shape>,
    /// How it is run where nobody says otherwise.
    pub run: RunSettings,
}

/// What a file says about itself in words.
#[derive(Clone, Debug, Default)]
pub struct Info {
    /// The title.
    pub title: String,
    /// One line on what it is.
    pub summary: String,
    /// The book, section or paper it comes from.
    pub source: String,
    /// Its place in the notes, `2.3`.
    pub chapter: String,
    /// What it is about, the first one its home in the picker.
    pub topics: Vec<String>,
    /// What to look for, a few short paragraphs.
    pub notes: String,
}

/// The symbols every model has.
#[derive(Clone, Copy, Debug)]
pub struct CommonSymbols {
    /// `t`.
    pub time: Symbol,
    /// `energy`: Jacobi's h, or H. Stands in observables only.
    pub energy: Symbol,
    /// `action`: ∫ L dt from the start. Stands in observables only.
    pub action: Symbol,
}

/// The law of motion as given.
#[derive(Clone, Debug)]
pub enum Mechanics {
    /// d/dt(∂L/∂q̇) − ∂L/∂q + ∂F/∂q̇ = Q.
    Lagrangian {
        /// L(q, q̇, t).
        lagrangian: Expr,
        /// Rayleigh's function F(q, q̇, t); zero where there is none.
        dissipation: Expr,
        /// The generalised force on each coordinate; zero where there is none.
        forces: Vec<Expr>,
    },
    /// q̇ = ∂H/∂p, ṗ = −∂H/∂q + force.
    Hamiltonian {
        /// H(q, p, t).
        hamiltonian: Expr,
        /// What is added to each ṗ; zero where there is none.
        forces: Vec<Expr>,
    },
    /// ẋ = {x, H} + force. The variables are the model's coordinates; they have no momenta.
    Poisson {
        /// H(x, t).
        hamiltonian: Expr,
        /// {x_i, x_j}, antisymmetric, of (x, t).
        brackets: Vec<Vec<Expr>>,
        /// Name, expression and place of each Casimir.
        casimirs: Vec<(String, Expr, SourceRange)>,
        /// What is added to each ẋ; zero where there is none.
        forces: Vec<Expr>,
        /// Where the brackets stand in the file.
        place: SourceRange,
    },
}

impl Mechanics {
    /// `L` or `H`, and the function.
    pub fn function(&self) -> (&'static str, Expr) {
        match self {
            Mechanics::Lagrangian { lagrangian, .. } => ("L", *lagrangian),
            Mechanics::Hamiltonian { hamiltonian, .. } | Mechanics::Poisson { hamiltonian, .. } => {
                ("H", *hamiltonian)
            }
        }
    }

    /// Rayleigh's function, zero where there is none.
    pub fn dissipation(&self) -> Expr {
        match self {
            Mechanics::Lagrangian { dissipation, .. } => *dissipation,
            Mechanics::Hamiltonian { .. } | Mechanics::Poisson { .. } => Expr::ZERO,
        }
    }

    /// The brackets {x_i, x_j}, i < j, that do not vanish; none where there are coordinates and
    /// momenta.
    pub fn brackets(&self) -> Vec<(usize, usize, Expr)> {
        let Mechanics::Poisson { brackets, .. } = self else { return Vec::new() };
        let rows = brackets.iter().enumerate();
        let all = rows.flat_map(|(i, row)| row.iter().enumerate().map(move |(j, &e)| (i, j, e)));
        all.filter(|&(i, j, e)| i < j && e != Expr::ZERO).collect()
    }

    /// What acts beside it on each coordinate or variable.
    pub fn forces(&self) -> &[Expr] {
        match self {
            Mechanics::Lagrangian { forces, .. }
            | Mechanics::Hamiltonian { forces, .. }
            | Mechanics::Poisson { forces, .. } => forces,
        }
    }
}

/// How a system is run where nobody says otherwise.
#[derive(Clone, Debug)]
pub struct RunSettings {
    /// The method's name, or `auto`.
    pub method: String,
    /// Where the file names it, for whoever knows the methods.
    pub method_place: Option<SourceRange>,
    /// Simulated seconds per second of the wall clock.
    pub speed: f64,
    /// The time of the initial values.
    pub start: f64,
    /// When a run ends.
    pub until: Option<f64>,
    /// The step of a method of fixed step.
    pub step: Option<f64>,
    /// The relative tolerance of an adaptive method.
    pub tolerance: Option<f64>,
    /// Where the file gives the tolerance or the step, for whoever knows what a method takes.
    pub settings_place: Option<SourceRange>,
}

impl Default for RunSettings {
    fn default() -> Self {
        RunSettings {
            method: "auto".to_owned(),
            method_place: None,
            speed: 1.0,
            start: 0.0,
            until: None,
            step: None,
            tolerance: None,
            settings_place: None,
        }
    }
}

impl Model {
    /// An empty model that knows `t`, `energy` and `action`; `preset` fills it.
    pub fn new(title: &str) -> Model {
        let mut pool = Pool::new();
        let symbols = CommonSymbols {
            time: pool.symbol("t"),
            energy: pool.symbol("energy"),
            action: pool.symbol("action"),
        };
        pool.describe(symbols.time, "t", "t", crate::expr::Rank::Variable);
        Model {
            law_place: 0..0,
            info: Info { title: title.to_owned(), ..Info::default() },
            pool,
            symbols,
            coordinates: Vec::new(),
            parameters: Vec::new(),
            definitions: Vec::new(),
            mechanics: Mechanics::Lagrangian {
                lagrangian: Expr::ZERO,
                dissipation: Expr::ZERO,
                forces: Vec::new(),
            },
            constraints: Vec::new(),
            impulses: Vec::new(),
            events: Vec::new(),
            body: None,
            attitude: None,
            comparison: None,
            frames: Vec::new(),
            observables: Vec::new(),
            expect: Expect::default(),
            views: Vec::new(),
            space: Vec::new(),
            run: RunSettings::default(),
        }
    }

    /// Whether the file gives a Lagrangian (and so velocities at the start).
    pub fn is_lagrangian(&self) -> bool {
        matches!(self.mechanics, Mechanics::Lagrangian { .. })
    }

    /// Whether the file gives brackets of variables that are no coordinates and momenta.
    pub fn is_poisson(&self) -> bool {
        matches!(self.mechanics, Mechanics::Poisson { .. })
    }

    /// How many numbers say where a motion is: two of each coordinate, one of each variable.
    pub fn moving(&self) -> usize {
        if self.is_poisson() { self.coordinates.len() } else { 2 * self.coordinates.len() }
    }

    /// The coordinate of a name.
    pub fn coordinate(&self, name: &str) -> Option<usize> {
        self.coordinates.iter().position(|c| c.name == name)
    }

    /// The parameter of a name.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|p| p.name == name)
    }

    /// The parameters' values as the file gives them.
    pub fn parameter_values(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.value).collect()
    }
}
