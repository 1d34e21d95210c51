//! A system as its file describes it, with every name resolved.
//!
//! In: what `preset` has checked. Out: a [`Model`]. Never here: text, and what is derived from the
//! model.

use super::body::{Attitude, Body, Comparison, Frame};
use super::claim::{Expect, Observable};
use super::constraint::Constraint;
use super::coordinate::Coordinate;
use super::occurrence::{Impulse, MotionEvent};
use super::parameter::Parameter;
use super::picture::{SpacePicture, View};
use super::ramped::Ramped;
use super::transformation::{CompleteIntegral, Generator, Transformation};
use crate::diagnostic::SourceRange;
use crate::expr::{Expr, Pool, Symbol};

/// A checked mechanical system, as a file describes it.
#[derive(Clone, Debug)]
pub struct Model {
    /// Title, notes and source of the system.
    pub info: Info,
    /// The pool that holds all expressions of the model.
    pub pool: Pool,
    /// Time, `energy` and `action`.
    pub symbols: CommonSymbols,
    /// The generalised coordinates, in order.
    pub coordinates: Vec<Coordinate>,
    /// The parameters, in order.
    pub parameters: Vec<Parameter>,
    /// The parameters that change with the time, which stand in no expression but those of initial values.
    pub ramped: Ramped,
    /// The same model with these parameters as symbols that have rates, for a law that can be read; see [`Ramped::keep`].
    pub with_ramps_named: Option<Box<Model>>,
    /// Definitions, in order. They are already substituted wherever they are used, and are stored
    /// for display.
    pub definitions: Vec<(String, Expr)>,
    /// The law of motion.
    pub mechanics: Mechanics,
    /// The constraints on the motion; for a Lagrangian only.
    pub constraints: Vec<Constraint>,
    /// In the order of the file.
    pub impulses: Vec<Impulse>,
    /// The events: crossings to be located.
    pub events: Vec<MotionEvent>,
    /// The surfaces of section of the views, in their order: crossings to be located and recorded, without effect on
    /// the motion and no part of what happens in it.
    pub sections: Vec<MotionEvent>,
    /// The body assembled from pieces.
    pub body: Option<Body>,
    /// The attitude of a body.
    pub attitude: Option<Attitude>,
    /// The vakonomic comparison motion.
    pub comparison: Option<Comparison>,
    /// Transformations of phase space.
    pub transformations: Vec<Transformation>,
    /// Generators of infinitesimal transformations.
    pub generators: Vec<Generator>,
    /// The names of equilibria.
    pub equilibria: Vec<NamedEquilibrium>,
    /// A complete integral of the Hamilton–Jacobi equation.
    pub complete_integral: Option<CompleteIntegral>,
    /// Frames from which a picture may be seen.
    pub frames: Vec<Frame>,
    /// The place of its law, L or H, in the file.
    pub law_place: SourceRange,
    /// The observables of the file.
    pub observables: Vec<Observable>,
    /// The file's claims about its own motion.
    pub expect: Expect,
    /// The panes that the screen opens with.
    pub views: Vec<View>,
    /// The picture of the system in space.
    pub picture: SpacePicture,
    /// The default settings of a run.
    pub run: RunSettings,
}

/// A name of an equilibrium, with coordinates near which it is, by index, in terms of parameters.
#[derive(Clone, Debug)]
pub struct NamedEquilibrium {
    /// As written in the file.
    pub name: String,
    /// The coordinates.
    pub near: Vec<(usize, Expr)>,
}

/// The descriptive texts of a file.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Info {
    /// As lists and headers show it.
    pub title: String,
    /// A one-line description.
    pub summary: String,
    /// The book, section or paper it is taken from.
    pub source: String,
    /// Its place in the notes, `2.3`.
    pub chapter: String,
    /// Its topics; the picker lists it under the first one.
    pub topics: Vec<String>,
    /// What to observe, in a few short paragraphs.
    pub notes: String,
}

/// The symbols common to all models.
#[derive(Clone, Copy, Debug)]
pub struct CommonSymbols {
    /// `t`.
    pub time: Symbol,
    /// `energy`: Jacobi's h, or H. It may be used in what is observed of a motion: observables, events, sections.
    pub energy: Symbol,
    /// `action`: ∫ L dt from the start. It may be used where the energy may be.
    pub action: Symbol,
}

/// The law of motion as the file gives it.
#[derive(Clone, Debug)]
pub enum Mechanics {
    /// d/dt(∂L/∂q̇) − ∂L/∂q + ∂F/∂q̇ = Q.
    Lagrangian {
        /// L(q, q̇, t).
        lagrangian: Expr,
        /// Rayleigh's function F(q, q̇, t); zero if there is none.
        dissipation: Expr,
        /// The generalised force on each coordinate; zero if there is none.
        forces: Vec<Expr>,
    },
    /// q̇ = ∂H/∂p, ṗ = −∂H/∂q + force.
    Hamiltonian {
        /// H(q, p, t).
        hamiltonian: Expr,
        /// The force added to each ṗ; zero if there is none.
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
        /// The force added to each ẋ; zero if there is none.
        forces: Vec<Expr>,
        /// The place of the brackets in the file.
        place: SourceRange,
    },
}

impl Mechanics {
    /// The letter `L` or `H`, and the function.
    pub fn function(&self) -> (&'static str, Expr) {
        match self {
            Mechanics::Lagrangian { lagrangian, .. } => ("L", *lagrangian),
            Mechanics::Hamiltonian { hamiltonian, .. } | Mechanics::Poisson { hamiltonian, .. } => {
                ("H", *hamiltonian)
            }
        }
    }

    /// Every expression of the law, to be rewritten.
    pub fn expressions_mut(&mut self) -> Vec<&mut Expr> {
        match self {
            Mechanics::Lagrangian { lagrangian, dissipation, forces } => {
                [lagrangian, dissipation].into_iter().chain(forces).collect()
            }
            Mechanics::Hamiltonian { hamiltonian, forces } => {
                std::iter::once(hamiltonian).chain(forces).collect()
            }
            Mechanics::Poisson { hamiltonian, brackets, casimirs, forces, .. } => {
                let casimirs = casimirs.iter_mut().map(|casimir| &mut casimir.1);
                let brackets = brackets.iter_mut().flatten();
                std::iter::once(hamiltonian).chain(brackets).chain(casimirs).chain(forces).collect()
            }
        }
    }

    /// Rayleigh's function; zero if there is none.
    pub fn dissipation(&self) -> Expr {
        match self {
            Mechanics::Lagrangian { dissipation, .. } => *dissipation,
            Mechanics::Hamiltonian { .. } | Mechanics::Poisson { .. } => Expr::ZERO,
        }
    }

    /// The nonvanishing brackets {x_i, x_j}, i < j; empty for canonical coordinates and momenta.
    pub fn brackets(&self) -> Vec<(usize, usize, Expr)> {
        let Mechanics::Poisson { brackets, .. } = self else { return Vec::new() };
        let rows = brackets.iter().enumerate();
        let all = rows.flat_map(|(i, row)| row.iter().enumerate().map(move |(j, &e)| (i, j, e)));
        all.filter(|&(i, j, e)| i < j && e != Expr::ZERO).collect()
    }

    /// The forces on each coordinate or variable.
    pub fn forces(&self) -> &[Expr] {
        match self {
            Mechanics::Lagrangian { forces, .. }
            | Mechanics::Hamiltonian { forces, .. }
            | Mechanics::Poisson { forces, .. } => forces,
        }
    }
}

/// The settings of a run, which the user may override.
#[derive(Clone, Debug)]
pub struct RunSettings {
    /// The method's name, or `auto`.
    pub method: String,
    /// The place of the method in the file, for checks that need the table of methods.
    pub method_place: Option<SourceRange>,
    /// Simulated seconds per second of the wall clock.
    pub speed: f64,
    /// The initial time.
    pub start: f64,
    /// The final time.
    pub until: Option<f64>,
    /// The step of a fixed-step method.
    pub step: Option<f64>,
    /// The relative tolerance of an adaptive method.
    pub tolerance: Option<f64>,
    /// The place of the tolerance or the step in the file, for checks that depend on the method.
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
    /// Leaves out the pictures and their surfaces of section, whose crossings would be located for nobody.
    pub fn leave_views_out(&mut self) {
        self.views.clear();
        self.sections.clear();
    }

    /// The events of the file, then the surfaces of section: the order of those of a compiled system.
    pub fn located_events(&self) -> impl Iterator<Item = &MotionEvent> {
        self.events.iter().chain(&self.sections)
    }

    /// The index of a surface of section among them.
    pub fn event_of_section(&self, section: usize) -> usize {
        self.events.len() + section
    }

    /// Creates an empty model that has only `t`, `energy` and `action`; `preset` fills it.
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
            ramped: Ramped::default(),
            with_ramps_named: None,
            definitions: Vec::new(),
            mechanics: Mechanics::Lagrangian {
                lagrangian: Expr::ZERO,
                dissipation: Expr::ZERO,
                forces: Vec::new(),
            },
            constraints: Vec::new(),
            impulses: Vec::new(),
            events: Vec::new(),
            sections: Vec::new(),
            body: None,
            attitude: None,
            comparison: None,
            transformations: Vec::new(),
            generators: Vec::new(),
            equilibria: Vec::new(),
            complete_integral: None,
            frames: Vec::new(),
            observables: Vec::new(),
            expect: Expect::default(),
            views: Vec::new(),
            picture: SpacePicture::default(),
            run: RunSettings::default(),
        }
    }

    /// Returns whether the file gives a Lagrangian (and so initial velocities).
    pub fn is_lagrangian(&self) -> bool {
        matches!(self.mechanics, Mechanics::Lagrangian { .. })
    }

    /// Returns whether the file gives brackets of variables that are not canonical.
    pub fn is_poisson(&self) -> bool {
        matches!(self.mechanics, Mechanics::Poisson { .. })
    }

    /// The dimension of phase space: two for each coordinate, one for each variable of a Poisson
    /// system.
    pub fn moving(&self) -> usize {
        if self.is_poisson() { self.coordinates.len() } else { 2 * self.coordinates.len() }
    }

    /// Sets the values of all parameters, in their order.
    pub fn set_parameters(&mut self, values: &[f64]) {
        self.parameters.iter_mut().zip(values).for_each(|(p, &value)| p.value = value);
    }

    /// The index of the coordinate with this name.
    pub fn coordinate(&self, name: &str) -> Option<usize> {
        self.coordinates.iter().position(|c| c.name == name)
    }

    /// The index of the parameter with this name.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|p| p.name == name)
    }

    /// The new variables that other expressions may use, by name: those that belong to one
    /// transformation only, what transformations lack of being canonical, and the constants of the complete integral.
    pub fn new_variables(&self) -> Vec<(String, Symbol)> {
        let all: Vec<Symbol> = self.transformations.iter().flat_map(|t| t.new.concat()).collect();
        let once = all.iter().filter(|s| all.iter().filter(|other| other == s).count() == 1);
        let named = once.map(|&s| (self.pool.symbol_info(s).name.clone(), s));
        let constants = self.complete_integral.iter().flat_map(|s| &s.constants);
        let constants = constants.flat_map(|c| [c.symbol, c.conjugate]);
        let others = constants.chain(self.transformations.iter().filter_map(|t| t.residual));
        let others = others.map(|s| (self.pool.symbol_info(s).name.clone(), s));
        named.chain(others).collect()
    }

    /// The name of a new variable of a transformation: with that of the transformation where others have the same variable.
    pub fn new_variable_name(&self, law: &Transformation, symbol: Symbol) -> String {
        let name = &self.pool.symbol_info(symbol).name;
        let all = self.transformations.iter().flat_map(|law| law.new.iter().flatten());
        if all.filter(|&&other| other == symbol).count() == 1 {
            name.clone()
        } else {
            format!("{name} of {}", law.name)
        }
    }

    /// The parameters' values as the file gives them.
    pub fn parameter_values(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.value).collect()
    }
}
