//! What follows from a law of motion, in the order in which it is reported: the one report behind the text, the typeset
//! fragment, the object for programs and the page on the screen.
//!
//! In: a model and its equations. Out: sections of lines, each an expression with what stands left of it; reasons where
//! there is none. Never here: how any of it is written.

use super::conservation::{Classed, classes};
use super::constrain::with_reactions;
use super::domain::widened;
use super::equations::{ConstraintRow, Equations, Flow, NoClosedForm, Reason};
use super::invariants::casimir_rate;
use super::rigid_body::{RigidBody, body_values, matrix, principal};
use crate::expr::{Expr, Symbol};
use crate::model::{BodyNames, Constraint, Impulse, Mechanics, Model};
use crate::num::DoubleDouble;

/// What stands left of the sign of equality.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Left {
    /// A letter with a fixed meaning: `L`, `H`, `F`, `E`.
    Letter(&'static str),
    /// A symbol of the system.
    Symbol(Symbol),
    /// The rate of change of a symbol that has none for it.
    Rate(Symbol),
    /// What acts on a variable beside the law: `Q` for a force, `f` for what is added to a rate.
    Added(char, Symbol),
    /// The bracket of two variables.
    Bracket(Symbol, Symbol),
    /// By how much an impulse changes a symbol.
    Jump(Symbol),
}

/// An equation to be reported.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Line {
    /// What it is.
    pub left: Left,
    /// What it equals.
    pub right: Expr,
}

impl Line {
    fn of((left, right): (Left, Expr)) -> Line {
        Line { left, right }
    }

    fn named(symbol: Symbol, right: Expr) -> Line {
        Line { left: Left::Symbol(symbol), right }
    }
}

/// A constraint with its multiplier.
#[derive(Clone, Copy, Debug)]
pub struct Constrained<'a> {
    /// As in the file.
    pub constraint: &'a Constraint,
    /// In terms of the velocities.
    pub row: &'a ConstraintRow,
    /// λ, where it is known in closed form.
    pub multiplier: Option<Expr>,
}

/// The force of one constraint on one coordinate: a factor times its multiplier.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Reaction {
    /// The coordinate.
    pub on: Symbol,
    /// The factor.
    pub factor: Expr,
    /// The multiplier.
    pub multiplier: Symbol,
}

/// An impulse.
#[derive(Clone, Debug)]
pub struct ImpulseReport<'a> {
    /// As in the file.
    pub impulse: &'a Impulse,
    /// What it changes.
    pub changes: Vec<Line>,
}

/// What a conserved quantity is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Constant<'a> {
    /// A momentum.
    Momentum(Symbol),
    /// The energy.
    Energy,
    /// A Casimir of this name.
    Casimir(&'a str),
    /// Something else of this name.
    Other(&'a str),
}

/// Something conserved.
#[derive(Clone, Copy, Debug)]
pub struct Kept<'a> {
    /// What.
    pub constant: Constant<'a>,
    /// As a function of the state.
    pub expression: Expr,
    /// Why.
    pub reason: &'a Reason,
}

/// A body in numbers, at the file's parameters.
#[derive(Clone, Debug)]
pub struct BodyNumbers {
    /// Its mass.
    pub mass: f64,
    /// Its centre of mass.
    pub centre: [f64; 3],
    /// Its inertia about the point it turns about.
    pub inertia: [[f64; 3]; 3],
    /// The principal moments.
    pub moments: [f64; 3],
    /// The principal axes, one a row, in the order of the moments.
    pub axes: [[f64; 3]; 3],
}

/// The body of a file.
#[derive(Clone, Debug)]
pub struct BodyReport {
    /// Mass, centre of mass, inertia.
    pub lines: Vec<Line>,
    /// What the principal moments are called.
    pub moments: [Symbol; 3],
    names: BodyNames,
}

/// The report.
#[derive(Clone, Debug)]
pub struct Report<'a> {
    /// What the file says.
    pub model: &'a Model,
    /// What follows from it.
    pub equations: &'a Equations,
    /// The body, if there is one.
    pub body: Option<BodyReport>,
    /// L or H.
    pub law: Line,
    /// What must not be below zero where the law holds, though no root is left to say so.
    pub domain: Vec<Expr>,
    /// Rayleigh's function, if there is one.
    pub dissipation: Option<Line>,
    /// What acts beside the law.
    pub forces: Vec<Line>,
    /// The brackets that do not vanish.
    pub brackets: Vec<Line>,
    /// The Casimirs, by name.
    pub casimirs: Vec<(&'a str, Expr)>,
    /// The constraints.
    pub constraints: Vec<Constrained<'a>>,
    /// Their multipliers, or why these have no closed form.
    pub multipliers: Result<Vec<Line>, &'a NoClosedForm>,
    /// What the constraints do to the coordinates.
    pub reactions: Vec<Reaction>,
    /// The impulses.
    pub impulses: Vec<ImpulseReport<'a>>,
    /// The momenta.
    pub momenta: Vec<Line>,
    /// What the equations of motion are solved for.
    pub rates: Vec<Left>,
    /// The equations of motion, solved, or why they are not.
    pub motion: Result<Vec<Line>, &'a NoClosedForm>,
    /// H, or why it has no closed form.
    pub hamiltonian: Result<Line, &'a NoClosedForm>,
    /// The energy.
    pub energy: Line,
    /// The law of its change.
    pub energy_rate: Expr,
    /// Coordinates that do not occur.
    pub cyclic: Vec<Symbol>,
    /// What is conserved, and why.
    pub conserved: Vec<Kept<'a>>,
}

impl<'a> Report<'a> {
    /// The report on a system.
    pub fn of(model: &'a Model, equations: &'a Equations) -> Report<'a> {
        let coordinates = &model.coordinates;
        let (name, law) = model.mechanics.function();
        let dissipation = model.mechanics.dissipation();
        let letter = if model.is_poisson() { 'f' } else { 'Q' };
        let forces = coordinates.iter().zip(model.mechanics.forces());
        let forces = forces.filter(|(_, force)| **force != Expr::ZERO);
        let position = |i: usize| coordinates[i].position;
        let brackets = model.mechanics.brackets().into_iter();
        let casimirs = match &model.mechanics {
            Mechanics::Poisson { casimirs, .. } => &casimirs[..],
            Mechanics::Lagrangian { .. } | Mechanics::Hamiltonian { .. } => &[],
        };
        let solved = equations.multipliers.as_ref();
        let rows = equations.constraints.iter();
        let constraints = model.constraints.iter().zip(rows.clone()).enumerate();
        let momenta = coordinates.iter().zip(&equations.momenta);
        let rates = rates(model);
        let motion = equations.solved.as_ref();
        Report {
            model,
            equations,
            body: BodyReport::of(model, equations),
            law: Line { left: Left::Letter(name), right: law },
            domain: widened(model, equations),
            dissipation: (dissipation != Expr::ZERO)
                .then_some(Line { left: Left::Letter("F"), right: dissipation }),
            forces: forces.map(|(c, &e)| Line::of((Left::Added(letter, c.position), e))).collect(),
            brackets: brackets
                .map(|(i, j, e)| Line::of((Left::Bracket(position(i), position(j)), e)))
                .collect(),
            casimirs: casimirs.iter().map(|(name, e, _)| (name.as_str(), *e)).collect(),
            constraints: constraints
                .map(|(k, (constraint, row))| {
                    let multiplier = solved.ok().map(|solved| solved[k]);
                    Constrained { constraint, row, multiplier }
                })
                .collect(),
            multipliers: solved.map(|solved| {
                rows.clone().zip(solved).map(|(row, &e)| Line::named(row.multiplier, e)).collect()
            }),
            reactions: rows.flat_map(|row| reactions(equations, row)).collect(),
            impulses: model
                .impulses
                .iter()
                .map(|impulse| ImpulseReport::of(model, impulse))
                .collect(),
            momenta: momenta.map(|(c, &p)| Line::named(c.momentum, p)).collect(),
            motion: motion
                .map(|solved| rates.iter().copied().zip(solved.iter().copied()).map(Line::of))
                .map(Iterator::collect),
            rates,
            hamiltonian: equations
                .hamiltonian
                .as_ref()
                .map(|&h| Line { left: Left::Letter("H"), right: h }),
            energy: Line { left: Left::Letter("E"), right: equations.energy },
            energy_rate: equations.energy_rate,
            cyclic: equations.cyclic.iter().map(|&i| position(i)).collect(),
            conserved: kept(model, equations),
        }
    }

    /// The mass matrix and the forces of M q̈ = f, where L is the law.
    pub fn unsolved(&self) -> Option<(&'a [Vec<Expr>], &'a [Expr])> {
        match &self.equations.flow {
            Flow::Lagrange { mass, force, .. } => Some((mass, force)),
            Flow::Hamilton { .. } | Flow::Poisson { .. } => None,
        }
    }
}

/// What takes longer to find, and is reported only in full.
#[derive(Clone, Debug)]
pub struct Further {
    /// Whether the observables are conserved.
    pub classes: Vec<Classed>,
    /// What the mass matrix times the accelerations, or the rates, are equal to: with the forces of constraints.
    pub right_hand_side: Vec<Expr>,
    /// The rate of change of each Casimir.
    pub casimir_rates: Vec<Expr>,
}

impl Further {
    /// Finds it; the equations' pool grows.
    pub fn of(model: &Model, equations: &mut Equations) -> Further {
        let classes = classes(model, equations);
        let flow = equations.flow.clone();
        let right_hand_side = match &flow {
            Flow::Lagrange { force, .. } => {
                let rows = equations.constraints.clone();
                with_reactions(&mut equations.pool, &rows, force)
            }
            Flow::Hamilton { velocities, momentum_rates } => {
                [velocities.as_slice(), momentum_rates].concat()
            }
            Flow::Poisson { rates } => rates.clone(),
        };
        let casimir_rates = match &model.mechanics {
            Mechanics::Poisson { casimirs, forces, .. } => {
                casimirs.iter().map(|(_, e, _)| casimir_rate(equations, *e, forces)).collect()
            }
            Mechanics::Lagrangian { .. } | Mechanics::Hamiltonian { .. } => Vec::new(),
        };
        Further { classes, right_hand_side, casimir_rates }
    }
}

/// q̈, or q̇ and then ṗ.
fn rates(model: &Model) -> Vec<Left> {
    let all = model.coordinates.iter();
    if model.is_lagrangian() {
        return all.map(|c| Left::Symbol(c.acceleration)).collect();
    }
    let velocities = all.clone().map(|c| Left::Symbol(c.velocity));
    velocities.chain(all.map(|c| Left::Rate(c.momentum))).collect()
}

fn reactions<'e>(
    equations: &'e Equations,
    row: &'e ConstraintRow,
) -> impl Iterator<Item = Reaction> + 'e {
    let acting = equations.coordinates.iter().zip(&row.row).filter(|(_, a)| **a != Expr::ZERO);
    acting.map(|(c, &factor)| Reaction { on: c.position, factor, multiplier: row.multiplier })
}

fn kept<'a>(model: &Model, equations: &'a Equations) -> Vec<Kept<'a>> {
    let all = equations.conserved.iter().map(|conserved| {
        let name = conserved.name.as_str();
        let mut coordinates = model.coordinates.iter();
        let momentum = coordinates.find(|c| name.strip_prefix("p_") == Some(c.name.as_str()));
        let constant = match momentum {
            Some(c) => Constant::Momentum(c.momentum),
            None if name == "energy" => Constant::Energy,
            None if conserved.reason == Reason::Casimir => Constant::Casimir(name),
            None => Constant::Other(name),
        };
        Kept { constant, expression: conserved.expression, reason: &conserved.reason }
    });
    all.collect()
}

impl<'a> ImpulseReport<'a> {
    fn of(model: &Model, impulse: &'a Impulse) -> ImpulseReport<'a> {
        let changes = model.coordinates.iter().zip(&impulse.change);
        let changes = changes.filter(|(_, e)| **e != Expr::ZERO).map(|(c, &e)| {
            let moved = if model.is_poisson() { c.position } else { c.momentum };
            Line { left: Left::Jump(moved), right: e }
        });
        ImpulseReport { impulse, changes: changes.collect() }
    }
}

impl BodyReport {
    fn of(model: &Model, equations: &Equations) -> Option<BodyReport> {
        let names = model.body.as_ref()?.names;
        let whole: &RigidBody = equations.supplements.body.as_ref()?;
        let named = [(names.mass, whole.mass)].into_iter();
        let named = named.chain(names.centre.into_iter().zip(whole.centre));
        let named = named.chain(names.inertia.into_iter().zip(whole.inertia));
        let lines = named.map(|(symbol, e)| Line::named(symbol, e)).collect();
        Some(BodyReport { lines, moments: names.principal, names })
    }

    /// In numbers, at the file's parameters.
    pub fn numbers(&self, model: &Model, equations: &Equations) -> BodyNumbers {
        let (names, whole) = (self.names, equations.supplements.body.as_ref());
        let values = body_values(model, &equations.pool, whole, &model.parameter_values());
        let value = |symbol| {
            let found = values.iter().find(|(s, _)| *s == symbol);
            found.map_or(f64::NAN, |(_, value)| *value)
        };
        let inertia = names.inertia.map(value);
        let (_, axes) = principal(&inertia.map(DoubleDouble::from));
        BodyNumbers {
            mass: value(names.mass),
            centre: names.centre.map(value),
            inertia: matrix(&inertia),
            moments: names.principal.map(value),
            axes,
        }
    }
}
