//! What of a report takes longer to find: the classes of observables, transformations and generators, the Hamilton–Jacobi
//! equation.
//!
//! In: a model and its equations, whose pool grows. Out: [`Further`]. Never here: how any of it is written.

use std::collections::HashMap;

use super::bracket::{bracket, in_phase_space};
use super::canonical::{ALLOWANCE, PhaseMap};
use super::canonical_verdict::CanonicalVerdict;
use super::conservation::{Classed, class_of, classes};
use super::constrain::with_reactions;
use super::equations::{Equations, Flow, NoClosedForm};
use super::generating::GeneratingFunction;
use super::group::written_maps;
use super::hamilton_jacobi::HamiltonJacobi;
use super::invariants::casimir_rate;
use super::isolate::{Solution, tidy};
use crate::expr::{Expr, Symbol};
use crate::model::{Mechanics, Model, Transformation};

/// Results that take longer to find and appear only in the full report.
#[derive(Clone, Debug)]
pub struct Further {
    /// Whether each observable is conserved.
    pub classes: Vec<Classed>,
    /// The right-hand side of the equations of motion, with the forces of constraint.
    pub right_hand_side: Vec<Expr>,
    /// The rate of change of each Casimir.
    pub casimir_rates: Vec<Expr>,
    /// In the order of the file.
    pub transformations: Vec<TransformationReport>,
    /// The generators of infinitesimal transformations.
    pub generators: Vec<GeneratorReport>,
    /// The complete integral.
    pub hamilton_jacobi: Option<HamiltonJacobi>,
}

/// A transformation of the file.
#[derive(Clone, Debug)]
pub struct TransformationReport {
    /// The relations between old and new variables.
    pub map: PhaseMap,
    /// Whether it is canonical.
    pub verdict: CanonicalVerdict,
    /// Of a map that is canonical at some values of the parameters alone: those of which K and the generating functions are, as
    /// functions of the others.
    pub canonical_where: Solution,
    /// The old variables in terms of the new, if that can be written down.
    pub backwards: Option<Solution>,
    /// Whether that, and K which follows from it, holds near the start alone.
    pub is_local: bool,
    /// K(Q, P, t), or why there is none.
    pub hamiltonian: Result<Expr, NoClosedForm>,
    /// K as a function of (q, p, t), of an explicit map whose K(Q, P, t) is not known, or near the start alone.
    pub hamiltonian_in_old: Option<Expr>,
    /// Its generating functions of each type, if it is canonical and they can be searched for.
    pub functions: Vec<GeneratingFunction>,
}

/// A generator of the file.
#[derive(Clone, Debug)]
pub struct GeneratorReport {
    /// As the file calls it.
    pub name: String,
    /// G, as far as possible as a function of (q, p, t).
    pub expression: Expr,
    /// [H, G], or why it has no closed form.
    pub bracket: Result<Expr, NoClosedForm>,
    /// Whether G is conserved along the motion.
    pub conserved: bool,
}

fn transformations(model: &Model, equations: &mut Equations) -> Vec<TransformationReport> {
    let maps = written_maps(model, equations);
    let report = |(given, map): (Transformation, PhaseMap)| {
        let mut report = TransformationReport::of(model, equations, map);
        if report.verdict.canonical {
            let map = report.map.at_parameters(&mut equations.pool, &report.canonical_where);
            report.functions = map.generating_functions(model, equations, &given);
        }
        report
    };
    maps.into_iter().map(report).collect()
}

impl TransformationReport {
    /// The report on the transformation of this name without its generating functions, if its map can be written down;
    /// the equations' pool grows.
    pub fn named(model: &Model, equations: &mut Equations, name: &str) -> Option<Self> {
        let maps = written_maps(model, equations);
        let (_, map) = maps.into_iter().find(|(_, map)| map.name == name)?;
        Some(Self::of(model, equations, map))
    }

    /// The sentence about a canonical map of which no generating functions were found.
    pub fn without_functions(&self) -> &'static str {
        if self.map.is_explicit() || !self.map.parts.is_empty() {
            "Its generating functions are not known in closed form."
        } else {
            "Of its generating functions only that of the file is known in closed form."
        }
    }

    fn of(model: &Model, equations: &mut Equations, map: PhaseMap) -> Self {
        // it stays, whatever becomes of K
        let _ = equations.hamiltonian();
        let verdict = map.verdict(model, equations);
        let backwards = map.backwards(model, equations);
        let is_local = backwards
            .as_ref()
            .is_some_and(|inverse| map.is_inverse_local(model, equations, inverse));
        let canonical_where = map.canonical_where(model, equations, &verdict);
        let (hamiltonian, hamiltonian_in_old) = new_hamiltonians(
            model,
            equations,
            (&map, &verdict),
            (backwards.as_ref(), is_local),
            &canonical_where,
        );
        let functions = Vec::new();
        TransformationReport {
            map,
            verdict,
            canonical_where,
            backwards,
            is_local,
            hamiltonian,
            hamiltonian_in_old,
            functions,
        }
    }
}

/// K(Q, P, t), and without it or where it is known near the start alone K(q, p, t), of a map with some parameters as functions of the others.
fn new_hamiltonians(
    model: &Model,
    equations: &mut Equations,
    (map, verdict): (&PhaseMap, &CanonicalVerdict),
    (backwards, is_local): (Option<&Solution>, bool),
    parameters: &Solution,
) -> (Result<Expr, NoClosedForm>, Option<Expr>) {
    let (mut verdict, mut backwards) = (verdict.clone(), backwards.cloned());
    let map = map.at_parameters(&mut equations.pool, parameters);
    let values: HashMap<Symbol, Expr> = parameters.iter().copied().collect();
    if !values.is_empty() {
        verdict.valence = None;
        for (_, e) in backwards.iter_mut().flatten() {
            *e = tidy(&mut equations.pool, *e, &values);
        }
    }
    let found = equations.attempt(ALLOWANCE, |equations| {
        let e = map.new_hamiltonian(model, equations, &verdict, backwards.as_ref());
        Some(e.map(|e| tidy(&mut equations.pool, e, &values)))
    });
    let too_long = || Err(NoClosedForm("what follows on the way to it is too long".to_owned()));
    let found = found.unwrap_or_else(too_long);
    let in_old = match &found {
        Ok(_) if !is_local => None,
        _ => equations
            .attempt(ALLOWANCE, |equations| map.hamiltonian_in_old(model, equations, &verdict)),
    };
    (found, in_old)
}

fn generators(model: &Model, equations: &mut Equations) -> Vec<GeneratorReport> {
    let mut all = Vec::new();
    for generator in &model.generators {
        let hamiltonian = equations.hamiltonian().clone();
        let bracket = hamiltonian.and_then(|h| bracket(model, equations, h, generator.expression));
        let name = generator.name.clone();
        let class = class_of(model, equations, &name, generator.expression).class;
        let expression = in_phase_space(equations, generator.expression);
        let expression = expression.unwrap_or(generator.expression);
        all.push(GeneratorReport { name, expression, bracket, conserved: class.is_conserved() });
    }
    all
}

impl Further {
    /// Derives these results; the equations' pool grows.
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
        Further {
            classes,
            right_hand_side,
            casimir_rates,
            transformations: transformations(model, equations),
            generators: generators(model, equations),
            hamilton_jacobi: HamiltonJacobi::of(model, equations),
        }
    }
}
