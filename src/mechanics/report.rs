//! The report on a system: everything that follows from a law of motion, in reporting order. The
//! text, the LaTeX fragment, the JSON object and the page on the screen are all written from it.
//!
//! In: a model and its equations. Out: sections of lines, each an expression with its left-hand
//! side, or the reason why there is none. Never here: how any of it is written.

use super::domain::widened;
use super::equations::{ConstraintRow, Equations, Flow, NoClosedForm, Reason};
use super::rigid_body::{RigidBody, body_values, matrix, principal};
use super::structure::{Holonomy, Separation};
use crate::expr::{Expr, Symbol};
use crate::model::{BodyNames, Constraint, Impulse, Mechanics, Model};
use crate::num::DoubleDouble;

/// The left-hand side of a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum LeftSide {
    /// A letter with a fixed meaning: `L`, `H`, `F`, `E`.
    Letter(&'static str),
    /// A symbol of the system.
    Symbol(Symbol),
    /// The rate of change of a symbol that has no symbol for its rate.
    Rate(Symbol),
    /// What acts on a variable in addition to the law: `Q` for a force, `f` for a term added to a
    /// rate.
    Added(char, Symbol),
    /// The bracket of two variables.
    Bracket(Symbol, Symbol),
    /// The jump of a symbol under an impulse.
    Jump(Symbol),
}

/// An equation with its two sides, for all renderers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ReportedEquation {
    /// The left-hand side.
    pub left: LeftSide,
    /// The right-hand side.
    pub right: Expr,
}

impl ReportedEquation {
    fn of((left, right): (LeftSide, Expr)) -> ReportedEquation {
        ReportedEquation { left, right }
    }

    fn named(symbol: Symbol, right: Expr) -> ReportedEquation {
        ReportedEquation { left: LeftSide::Symbol(symbol), right }
    }
}

/// A constraint with its multiplier.
#[derive(Clone, Copy, Debug)]
pub struct ConstraintReport<'a> {
    /// The constraint as the file gives it.
    pub constraint: &'a Constraint,
    /// The constraint in terms of the velocities.
    pub row: &'a ConstraintRow,
    /// λ, if it is known in closed form.
    pub multiplier: Option<Expr>,
    /// Whether it is holonomic.
    pub holonomy: &'a Holonomy,
}

/// The force of one constraint on one coordinate: a factor times the multiplier.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Reaction {
    /// The coordinate.
    pub on: Symbol,
    /// What λ is multiplied by.
    pub factor: Expr,
    /// λ of the constraint.
    pub multiplier: Symbol,
}

/// The change of each momentum by an impulse.
#[derive(Clone, Debug)]
pub struct ImpulseReport<'a> {
    /// The impulse as the file gives it.
    pub impulse: &'a Impulse,
    /// The jumps it causes.
    pub changes: Vec<ReportedEquation>,
}

/// The kind of a conserved quantity.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ConservedKind<'a> {
    /// The momentum of this symbol.
    Momentum(Symbol),
    /// H, or the energy function of L.
    Energy,
    /// The Casimir of this name.
    Casimir(&'a str),
    /// Another quantity of this name.
    Other(&'a str),
}

/// A conserved quantity.
#[derive(Clone, Copy, Debug)]
pub struct ConservedReport<'a> {
    /// Its kind.
    pub constant: ConservedKind<'a>,
    /// The quantity as a function of the state.
    pub expression: Expr,
    /// Why it is conserved.
    pub reason: &'a Reason,
}

/// A body in numbers, at the file's values of the parameters.
#[derive(Clone, Debug)]
pub struct BodyNumbers {
    /// Of all pieces together.
    pub mass: f64,
    /// Its centre of mass.
    pub centre: [f64; 3],
    /// Its inertia about the point about which it rotates.
    pub inertia: [[f64; 3]; 3],
    /// The principal moments.
    pub moments: [f64; 3],
    /// The principal axes, one per row, in the order of the moments.
    pub axes: [[f64; 3]; 3],
}

/// The body of a file.
#[derive(Clone, Debug)]
pub struct BodyReport {
    /// Mass, centre of mass, inertia.
    pub lines: Vec<ReportedEquation>,
    /// The symbols of the principal moments.
    pub moments: [Symbol; 3],
    names: BodyNames,
}

/// A derivation in the order in which it is presented, for any renderer.
#[derive(Clone, Debug)]
pub struct Report<'a> {
    /// The model that the file describes.
    pub model: &'a Model,
    /// The equations derived from the model.
    pub equations: &'a Equations,
    /// Its lines, if the file has a `[body]`.
    pub body: Option<BodyReport>,
    /// The law: L or H.
    pub law: ReportedEquation,
    /// Expressions that must not be negative for the law to hold, although no root of them remains.
    pub domain: Vec<Expr>,
    /// Rayleigh's function, if there is one.
    pub dissipation: Option<ReportedEquation>,
    /// The forces that act in addition to the law.
    pub forces: Vec<ReportedEquation>,
    /// The brackets that do not vanish.
    pub brackets: Vec<ReportedEquation>,
    /// The Casimirs, by name.
    pub casimirs: Vec<(&'a str, Expr)>,
    /// The constraints.
    pub constraints: Vec<ConstraintReport<'a>>,
    /// Their multipliers, or why these have no closed form.
    pub multipliers: Result<Vec<ReportedEquation>, &'a NoClosedForm>,
    /// The forces of the constraints on the coordinates.
    pub reactions: Vec<Reaction>,
    /// The jumps that the file's impulses cause.
    pub impulses: Vec<ImpulseReport<'a>>,
    /// Each momentum in terms of coordinates and velocities.
    pub momenta: Vec<ReportedEquation>,
    /// The quantities for which the equations of motion are solved.
    pub rates: Vec<LeftSide>,
    /// The solved equations of motion, or why they have no closed form.
    pub motion: Result<Vec<ReportedEquation>, &'a NoClosedForm>,
    /// H, or why it has no closed form.
    pub hamiltonian: Result<ReportedEquation, &'a NoClosedForm>,
    /// The energy function in terms of the state.
    pub energy: ReportedEquation,
    /// The rate of change of the energy.
    pub energy_rate: Expr,
    /// The cyclic coordinates.
    pub cyclic: Vec<Symbol>,
    /// The conserved quantities, each with its reason.
    pub conserved: Vec<ConservedReport<'a>>,
    /// Whether Hamilton–Jacobi separates in the file's coordinates, once that has been determined.
    pub separation: Option<&'a Separation>,
}

impl<'a> Report<'a> {
    /// Compiles the report on a system as one reads it: with the names of parameters that change with the time.
    pub fn readable(model: &'a Model, equations: &'a Equations) -> Report<'a> {
        match equations.supplements.named_ramps.as_deref() {
            Some(named) => Report::of(&named.model, &named.equations),
            None => Report::of(model, equations),
        }
    }

    /// Compiles the report on a system.
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
        let holonomy = &equations.supplements.holonomy;
        let constraints = model.constraints.iter().zip(rows.clone()).enumerate();
        let momenta = coordinates.iter().zip(&equations.momenta);
        let rates = rates(model);
        let motion = equations.solved.as_ref();
        Report {
            model,
            equations,
            body: BodyReport::of(model, equations),
            law: ReportedEquation { left: LeftSide::Letter(name), right: law },
            domain: widened(model, equations),
            dissipation: (dissipation != Expr::ZERO)
                .then_some(ReportedEquation { left: LeftSide::Letter("F"), right: dissipation }),
            forces: forces
                .map(|(c, &e)| ReportedEquation::of((LeftSide::Added(letter, c.position), e)))
                .collect(),
            brackets: brackets
                .map(|(i, j, e)| {
                    ReportedEquation::of((LeftSide::Bracket(position(i), position(j)), e))
                })
                .collect(),
            casimirs: casimirs.iter().map(|(name, e, _)| (name.as_str(), *e)).collect(),
            constraints: constraints
                .map(|(k, (constraint, row))| {
                    let multiplier = solved.ok().map(|solved| solved[k]);
                    ConstraintReport { constraint, row, multiplier, holonomy: &holonomy[k] }
                })
                .collect(),
            multipliers: solved.map(|solved| {
                rows.clone()
                    .zip(solved)
                    .map(|(row, &e)| ReportedEquation::named(row.multiplier, e))
                    .collect()
            }),
            reactions: rows.flat_map(|row| reactions(equations, row)).collect(),
            impulses: model
                .impulses
                .iter()
                .map(|impulse| ImpulseReport::of(model, impulse))
                .collect(),
            momenta: momenta.map(|(c, &p)| ReportedEquation::named(c.momentum, p)).collect(),
            motion: motion
                .map(|solved| {
                    rates.iter().copied().zip(solved.iter().copied()).map(ReportedEquation::of)
                })
                .map(Iterator::collect),
            rates,
            hamiltonian: equations
                .hamiltonian
                .as_ref()
                .map(|&h| ReportedEquation { left: LeftSide::Letter("H"), right: h }),
            energy: ReportedEquation { left: LeftSide::Letter("E"), right: equations.energy },
            energy_rate: equations.energy_rate,
            cyclic: equations.cyclic.iter().map(|&i| position(i)).collect(),
            conserved: conserved(model, equations),
            separation: equations.supplements.separation.as_ref(),
        }
    }

    /// The mass matrix and the forces of M q̈ = f, if the law is a Lagrangian.
    pub fn unsolved(&self) -> Option<(&'a [Vec<Expr>], &'a [Expr])> {
        match &self.equations.flow {
            Flow::Lagrange { mass, force, .. } => Some((mass, force)),
            Flow::Hamilton { .. } | Flow::Poisson { .. } => None,
        }
    }
}

/// Left-hand sides of the equations of motion: q̈, or q̇ and then ṗ.
fn rates(model: &Model) -> Vec<LeftSide> {
    let all = model.coordinates.iter();
    if model.is_lagrangian() {
        return all.map(|c| LeftSide::Symbol(c.acceleration)).collect();
    }
    let velocities = all.clone().map(|c| LeftSide::Symbol(c.velocity));
    velocities.chain(all.map(|c| LeftSide::Rate(c.momentum))).collect()
}

fn reactions<'e>(
    equations: &'e Equations,
    row: &'e ConstraintRow,
) -> impl Iterator<Item = Reaction> + 'e {
    let acting = equations.coordinates.iter().zip(&row.row).filter(|(_, a)| **a != Expr::ZERO);
    acting.map(|(c, &factor)| Reaction { on: c.position, factor, multiplier: row.multiplier })
}

fn conserved<'a>(model: &Model, equations: &'a Equations) -> Vec<ConservedReport<'a>> {
    let all = equations.conserved.iter().map(|conserved| {
        let name = conserved.name.as_str();
        let mut coordinates = model.coordinates.iter();
        let momentum = coordinates.find(|c| name.strip_prefix("p_") == Some(c.name.as_str()));
        let constant = match momentum {
            Some(c) => ConservedKind::Momentum(c.momentum),
            None if name == "energy" => ConservedKind::Energy,
            None if conserved.reason == Reason::Casimir => ConservedKind::Casimir(name),
            None => ConservedKind::Other(name),
        };
        ConservedReport { constant, expression: conserved.expression, reason: &conserved.reason }
    });
    all.collect()
}

impl<'a> ImpulseReport<'a> {
    fn of(model: &Model, impulse: &'a Impulse) -> ImpulseReport<'a> {
        let changes = model.coordinates.iter().zip(&impulse.change);
        let changes = changes.filter(|(_, e)| **e != Expr::ZERO).map(|(c, &e)| {
            let moved = if model.is_poisson() { c.position } else { c.momentum };
            ReportedEquation { left: LeftSide::Jump(moved), right: e }
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
        let lines = named.map(|(symbol, e)| ReportedEquation::named(symbol, e)).collect();
        Some(BodyReport { lines, moments: names.principal, names })
    }

    /// The body in numbers, at the file's values of the parameters.
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
