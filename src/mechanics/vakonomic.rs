//! The vakonomic comparison motion: the constraints are substituted into L before it is varied,
//! which gives the wrong mechanics for nonholonomic constraints.
//!
//! In: the equations of a constrained motion. Out: the equations of the comparison motion, in its
//! own symbols. Never here: a change of the true equations.
//!
//! Solving c_β(q, q̇, t) = 0 for some velocities and varying the shorter L amounts to varying
//! L + Σ μ_β c_β with μ a function of time (the vakonomic problem):
//!
//!   M q̈ + Aᵀ μ̇ = f − Σ_β μ_β (dA_β/dt − ∂c_β/∂q),   A q̈ = γ,
//!
//! starting from the μ for which the momenta of the eliminated coordinates vanish. For holonomic
//! constraints both motions agree; for others they differ (J. I. Neimark, N. A. Fufaev, Dynamics of
//! Nonholonomic Systems, ch. III §5; V. I. Arnold, V. V. Kozlov, A. I. Neishtadt, Mathematical
//! Aspects of Classical and Celestial Mechanics, §1.4).

use std::collections::HashMap;

use super::equations::{Auxiliary, AuxiliaryRates, Equations, Flow, NoClosedForm, Vakonomic};
use super::linear;
use super::structure_error::StructureError;
use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::model::{Comparison, Model};
use crate::num::Number;

/// The comparison motion of a constrained motion, integrated alongside it.
pub(super) fn vakonomic(
    equations: &mut Equations,
    model: &Model,
    comparison: &Comparison,
) -> Vakonomic {
    let Flow::Lagrange { mass, force, .. } = equations.flow.clone() else {
        return Vakonomic {
            first: None,
            lagrangian: Err(NoClosedForm("there is no Lagrangian".to_owned())),
        };
    };
    let rows = equations.constraints.clone();
    let (n, m) = (equations.coordinates.len(), rows.len());
    let pool = &mut equations.pool;
    let mu: Vec<Symbol> = rows
        .iter()
        .map(|row| pool.symbol(&format!("mu {}", pool.symbol_info(row.multiplier).name.clone())))
        .collect();
    let mut drift = vec![(model.symbols.time, Expr::ONE)];
    for c in &equations.coordinates {
        let v = pool.variable(c.velocity);
        drift.push((c.position, v));
    }

    // f_α − Σ_β μ_β (dA_βα/dt − ∂c_β/∂q_α)
    let mut right = Vec::new();
    for (i, &f) in force.iter().enumerate() {
        let mut terms = vec![(Number::ONE, f)];
        for (row, &mu) in rows.iter().zip(&mu) {
            let auxiliary = pool.derivation(row.row[i], &drift);
            let mut gradient = vec![pool.derivative(row.rate, equations.coordinates[i].position)];
            for (c, &a) in equations.coordinates.iter().zip(&row.row) {
                let slope = pool.derivative(a, equations.coordinates[i].position);
                let v = pool.variable(c.velocity);
                gradient.push(pool.mul(slope, v));
            }
            let gradient = pool.sum(&gradient);
            let turned = pool.sub(auxiliary, gradient);
            let mu = pool.variable(mu);
            terms.push((Number::MINUS_ONE, pool.mul(mu, turned)));
        }
        right.push(pool.linear(Number::ZERO, &terms));
    }
    right.extend(rows.iter().map(|row| row.bias));
    let mut matrix = mass.clone();
    for (i, row) in matrix.iter_mut().enumerate() {
        row.extend(rows.iter().map(|c| c.row[i]));
    }
    for c in &rows {
        matrix.push(c.row.iter().copied().chain((0..m).map(|_| Expr::ZERO)).collect());
    }

    // the initial μ: ∂L/∂q̇_e + Σ_β μ_β A_βe = 0
    let start_matrix: Vec<Vec<Expr>> =
        comparison.eliminate.iter().map(|&e| rows.iter().map(|row| row.row[e]).collect()).collect();
    let start_right: Vec<Expr> =
        comparison.eliminate.iter().map(|&e| pool.neg(equations.momenta[e])).collect();

    // the comparison motion's equations are written in its own symbols
    let mut own: HashMap<Symbol, Expr> = HashMap::new();
    for (c, &(position, velocity)) in equations.coordinates.iter().zip(&comparison.symbols) {
        own.insert(c.position, pool.variable(position));
        own.insert(c.velocity, pool.variable(velocity));
    }
    let right: Vec<Expr> = right.into_iter().map(|e| pool.substitute(e, &own)).collect();
    let matrix: Vec<Vec<Expr>> = matrix
        .into_iter()
        .map(|row| row.into_iter().map(|e| pool.substitute(e, &own)).collect())
        .collect();

    let positions = comparison.symbols.iter().map(|pair| pair.0);
    let velocities = comparison.symbols.iter().map(|pair| pair.1);
    let symbols: Vec<Symbol> = positions.chain(velocities.clone()).chain(mu).collect();
    let state = equations.coordinates.iter().map(|c| c.position);
    let state: Vec<Symbol> =
        state.chain(equations.coordinates.iter().map(|c| c.velocity)).collect();
    let mut initial: Vec<Expr> = state.into_iter().map(|s| pool.variable(s)).collect();
    initial.truncate(2 * n);
    let rates = velocities.map(|v| pool.variable(v)).collect();
    equations.supplements.auxiliary.push(Auxiliary {
        symbols,
        rates: AuxiliaryRates { plain: rates, matrix, right },
        initial: AuxiliaryRates { plain: initial, matrix: start_matrix, right: start_right },
    });
    let lagrangian = shortened(equations, model, comparison);
    Vakonomic { first: comparison.symbols.first().map(|pair| pair.0), lagrangian }
}

/// The error of a comparison whose constraints cannot be solved for the velocities that are to be eliminated: one of them has none of
/// these, or none of them has one.
pub(super) fn structure_errors(model: &Model, equations: &Equations) -> Option<StructureError> {
    let comparison = model.comparison.as_ref()?;
    let rows = &equations.constraints;
    let mut pool = equations.pool.clone();
    let mut is_there = |e: Expr| pool.is_zero(e) != Zero::Proved;
    let has: Vec<Vec<bool>> =
        rows.iter().map(|row| row.row.iter().map(|&e| is_there(e)).collect()).collect();
    let has = |k: usize, e: usize| has[k][e];
    let eliminated = &comparison.eliminate;
    if rows.len() != eliminated.len() {
        return None;
    }
    let velocity = |e: usize| format!("{}'", model.coordinates[e].name);
    let all: Vec<String> = eliminated.iter().map(|&e| velocity(e)).collect();
    let bare = (0..rows.len()).find(|&k| !eliminated.iter().any(|&e| has(k, e)));
    let absent = eliminated.iter().find(|&&e| !(0..rows.len()).any(|k| has(k, e)));
    let message = match (bare, absent) {
        (Some(k), _) => {
            let name = &model.constraints[k].name;
            format!(
                "the constraint `{name}` cannot be solved for {}, which it has not",
                all.join(", ")
            )
        }
        (None, Some(&e)) => format!("no constraint can be solved for {}", velocity(e)),
        (None, None) => return None,
    };
    let could = (0..model.coordinates.len()).filter(|&e| (0..rows.len()).any(|k| has(k, e)));
    let could: Vec<String> = could.map(|e| format!("`{}`", model.coordinates[e].name)).collect();
    let help = format!("the constraints have the velocities of {}", could.join(", "));
    Some(StructureError { place: Some(comparison.place.clone()), message, help })
}

/// L with the eliminated velocities substituted from the constraints.
fn shortened(
    equations: &mut Equations,
    model: &Model,
    comparison: &Comparison,
) -> Result<Expr, NoClosedForm> {
    let (_, lagrangian) = model.mechanics.function();
    let rows = equations.constraints.clone();
    let pool: &mut Pool = &mut equations.pool;
    let eliminated = &comparison.eliminate;
    let mut right = Vec::new();
    for row in &rows {
        let mut terms = vec![(Number::MINUS_ONE, row.rate)];
        for (i, c) in equations.coordinates.iter().enumerate() {
            if !eliminated.contains(&i) {
                let v = pool.variable(c.velocity);
                terms.push((Number::MINUS_ONE, pool.mul(row.row[i], v)));
            }
        }
        right.push(pool.linear(Number::ZERO, &terms));
    }
    let matrix: Vec<Vec<Expr>> =
        rows.iter().map(|row| eliminated.iter().map(|&e| row.row[e]).collect()).collect();
    let solved = linear::solve(pool, &matrix, &right)?.x?;
    let symbols = eliminated.iter().map(|&e| equations.coordinates[e].velocity);
    let replaced: HashMap<Symbol, Expr> = symbols.zip(solved).collect();
    let shorter = pool.substitute(lagrangian, &replaced);
    Ok(pool.simplify(shorter))
}
