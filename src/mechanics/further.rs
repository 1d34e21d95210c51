//! What of a report takes longer to find: the classes of observables, transformations and generators, the Hamilton–Jacobi
//! equation.
//!
//! In: a model and its equations, whose pool grows. Out: [`Further`]. Never here: how any of it is written.

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
use super::isolate::Solution;
use crate::expr::Expr;
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
    /// The transformations.
    pub transformations: Vec<TransformationReport>,
    /// The generators of infinitesimal transformations.
    pub generators: Vec<GeneratorReport>,
    /// The complete integral.
    pub hamilton_jacobi: Option<HamiltonJacobi>,
}

/// A transformation of the file.
#[derive(Clone, Debug)]
pub struct TransformationReport {
    /// The map.
    pub map: PhaseMap,
    /// Whether it is canonical.
    pub verdict: CanonicalVerdict,
    /// The old variables in terms of the new, if that can be written down.
    pub backwards: Option<Solution>,
    /// K(Q, P, t), or why there is none.
    pub hamiltonian: Result<Expr, NoClosedForm>,
    /// K as a function of (q, p, t), of an explicit map whose K(Q, P, t) is not known.
    pub hamiltonian_in_old: Option<Expr>,
    /// Its generating functions of each type, if it is canonical and they can be searched for.
    pub functions: Vec<GeneratingFunction>,
}

/// A generator of the file.
#[derive(Clone, Debug)]
pub struct GeneratorReport {
    /// Its name.
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
            report.functions = report.map.generating_functions(model, equations, &given);
        }
        report
    };
    maps.into_iter().map(report).collect()
}

impl TransformationReport {
    /// The report on the transformation of a name but for its generating functions, if its law can be written down; the
    /// equations' pool grows.
    pub fn named(model: &Model, equations: &mut Equations, name: &str) -> Option<Self> {
        let maps = written_maps(model, equations);
        let (_, map) = maps.into_iter().find(|(_, map)| map.name == name)?;
        Some(Self::of(model, equations, map))
    }

    /// What is said of a canonical map of which no generating functions were found.
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
        let hamiltonian = equations.attempt(ALLOWANCE, |equations| {
            Some(map.new_hamiltonian(model, equations, &verdict, backwards.as_ref()))
        });
        let too_long = || Err(NoClosedForm("what follows on the way to it is too long".to_owned()));
        let hamiltonian = hamiltonian.unwrap_or_else(too_long);
        let hamiltonian_in_old = match &hamiltonian {
            Ok(_) => None,
            Err(_) => equations
                .attempt(ALLOWANCE, |equations| map.hamiltonian_in_old(model, equations, &verdict)),
        };
        let functions = Vec::new();
        TransformationReport { map, verdict, backwards, hamiltonian, hamiltonian_in_old, functions }
    }
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
    /// Computes them; the equations' pool grows.
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
