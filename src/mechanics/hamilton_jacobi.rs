//! A complete integral S(q, α, t) of H(q, ∂S/∂q, t) + ∂S/∂t = 0: whether it is one, the momenta
//! ∂S/∂q, and β = ∂S/∂α, which are constant along the motion as the α are.
//!
//! In: S as a file gives it. Out: a [`HamiltonJacobi`]. Never here: motion.
//! Source: *The Principles of Dynamics*, § 3.5.

use std::collections::HashMap;

use super::determinant::singular;
use super::equations::{Equations, NoClosedForm};
use super::isolate::{self, Solution, tidy};
use super::sampling::{ANY_POINTS, POINTS};
use super::slope::{self, tidy_derivative};
use super::valuation::Valuation;
use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::model::{CompleteIntegral, Model};
use crate::num::significant;

/// What is left of the equation counts as zero below this, relative to its terms.
const SOLVES: f64 = 1e-10;

/// The same far from the start.
const SOLVES_FAR: f64 = 1e-6;

/// The numbers tried for the constants, relative to the energy at the point.
const TRIED: [f64; 6] = [1.0, 0.7, 1.6, 2.9, -0.8, 0.3];

/// A complete integral with what follows from it.
#[derive(Clone, Debug)]
pub struct HamiltonJacobi {
    /// The largest value of |H(q, ∂S/∂q, t) + ∂S/∂t| at points near the start and far from it, 0 if that is
    /// proved; `None` if it has no value at any of them, or H has no closed form.
    pub residual: Option<f64>,
    /// Whether S solves the equation and det ∂²S/∂q∂α does not vanish.
    pub complete: bool,
    /// ∂S/∂q of each coordinate, in its order.
    pub momenta: Vec<Expr>,
    /// ∂S/∂α of each constant.
    pub beta: Vec<Expr>,
    /// Why it is not complete.
    pub why: Option<String>,
}

/// Finds α(q, p, t) and β(q, p, t), so that they may be watched along the motion.
pub(super) fn find(equations: &mut Equations, model: &Model) {
    let Some(integral) = &model.complete_integral else { return };
    let unknowns: Vec<Symbol> = integral.constants.iter().map(|c| c.symbol).collect();
    let pool = &mut equations.pool;
    let mut relations = Vec::new();
    for c in &model.coordinates {
        let slope = tidy_derivative(pool, integral.function, c.position);
        let momentum = pool.variable(c.momentum);
        relations.push(pool.sub(momentum, slope));
    }
    // −∂S/∂t is the value of H, often a constant itself
    let rate = tidy_derivative(pool, integral.function, model.symbols.time);
    if pool.depends_on_any(rate, &unknowns)
        && let Ok(hamiltonian) = equations.hamiltonian().clone()
    {
        relations.push(equations.pool.add(hamiltonian, rate));
    }
    let points: Vec<Valuation> =
        (0..2 * POINTS as u64).map(|n| Valuation::near_start(model, equations, n)).collect();
    let mut accept = |pool: &mut Pool, found: &Solution| {
        let (mut right, mut wrong) = (0, 0);
        for point in &points {
            let values: Vec<(Symbol, f64)> =
                found.iter().map(|&(s, e)| (s, point.value(pool, e))).collect();
            let at = point.clone().with(values);
            let sizes: Vec<(f64, f64)> =
                relations.iter().map(|&e| pool.evaluate_with_size(e, &|s| at.at(s))).collect();
            if sizes.iter().any(|(value, _)| !value.is_finite()) {
                continue;
            }
            let holds = sizes.iter().all(|(value, size)| value.abs() <= 1e-9 * size.max(1e-300));
            if holds { right += 1 } else { wrong += 1 }
        }
        // S is one branch: p has its sign on part of the orbit only
        right > 0 && 3 * right >= wrong
    };
    let found = isolate::solve(&mut equations.pool, &relations, &unknowns, &mut accept);
    let Some(found) = found else { return };
    let map: HashMap<Symbol, Expr> = found.iter().copied().collect();
    let pool = &mut equations.pool;
    let mut known: Solution = found;
    for constant in &integral.constants {
        let beta = pool.derivative(integral.function, constant.symbol);
        let beta = tidy(pool, beta, &map);
        known.push((constant.conjugate, beta));
    }
    equations.supplements.maps.new_variables.extend(known);
}

impl HamiltonJacobi {
    /// Checks the complete integral of a model.
    pub fn of(model: &Model, equations: &mut Equations) -> Option<HamiltonJacobi> {
        let integral = model.complete_integral.as_ref()?;
        let pool = &mut equations.pool;
        let s = integral.function;
        let momenta: Vec<Expr> =
            model.coordinates.iter().map(|c| tidy_derivative(pool, s, c.position)).collect();
        let beta: Vec<Expr> =
            integral.constants.iter().map(|c| tidy_derivative(pool, s, c.symbol)).collect();
        let (residual, mut why) = match remainder(model, equations, s, &momenta) {
            Ok(Remainder { value, part, solves }) => {
                let unsolved = || {
                    let part = significant(100.0 * part, 3, 1e-3..1e4);
                    format!(
                        "S does not solve H(q, ∂S/∂q, t) + ∂S/∂t = 0: up to {part} % of its terms are left"
                    )
                };
                let unknown = "S has no value at the points tried".to_owned();
                let why = match value {
                    None => Some(unknown),
                    Some(_) => (!solves).then(unsolved),
                };
                (value, why)
            }
            Err(no) => (None, Some(format!("H is not known: {no}"))),
        };
        // what S has too many or too few of is said beside what it does not solve
        let lacks = not_complete(model, equations, integral, (&momenta, &beta));
        why = match (why, lacks) {
            (Some(why), Some(lacks)) => Some(format!("{why}; {lacks}")),
            (why, lacks) => why.or(lacks),
        };
        let shown = |equations: &mut Equations, all: Vec<Expr>| {
            all.into_iter().map(|e| with_common_roots(model, equations, e)).collect()
        };
        let (momenta, beta) = (shown(equations, momenta), shown(equations, beta));
        Some(HamiltonJacobi { residual, complete: why.is_none(), momenta, beta, why })
    }
}

/// A slope of S in which roots that differ by a factor are the same root, where that is shorter, and where it has the same
/// values at points near the start, with the constants that the motion has there.
fn with_common_roots(model: &Model, equations: &mut Equations, e: Expr) -> Expr {
    let pool = &mut equations.pool;
    let opened = slope::with_common_roots(pool, e);
    if pool.weight(opened) >= pool.weight(e) {
        return e;
    }
    let known = &equations.supplements.maps.new_variables;
    let mut seen = 0;
    for n in 0..2 * POINTS as u64 {
        let point = Valuation::near_start(model, equations, n);
        let own: Vec<(Symbol, f64)> =
            known.iter().map(|&(s, e)| (s, point.value(&equations.pool, e))).collect();
        let at = point.with(own);
        let [was, is] = [e, opened].map(|e| at.value(&equations.pool, e));
        if was.is_finite() {
            if (was - is).abs() > 1e-9 * (1.0 + was.abs()) {
                return e;
            }
            seen += 1;
        }
    }
    if seen > 0 { opened } else { e }
}

struct Remainder {
    /// The largest value; `None` if there is none.
    value: Option<f64>,
    /// Its part of the size of the terms of H and of ∂S/∂t, before those that are alike have combined.
    part: f64,
    solves: bool,
}

fn remainder(
    model: &Model,
    equations: &mut Equations,
    s: Expr,
    momenta: &[Expr],
) -> Result<Remainder, NoClosedForm> {
    let hamiltonian = equations.hamiltonian().clone()?;
    let map: HashMap<Symbol, Expr> =
        model.coordinates.iter().map(|c| c.momentum).zip(momenta.iter().copied()).collect();
    let pool = &mut equations.pool;
    let energy = pool.substitute(hamiltonian, &map);
    let rate = pool.derivative(s, model.symbols.time);
    let left = pool.add(energy, rate);
    if pool.is_zero(left) == Zero::Proved {
        return Ok(Remainder { value: Some(0.0), part: 0.0, solves: true });
    }
    let (mut largest, mut relative, mut seen) = (0.0_f64, 0.0_f64, 0);
    let mut of_terms = 0.0_f64;
    // what solves the equation near the start may not do so far from it, beyond a kink
    let near = (0..200).map(|n| (false, n));
    for (is_far, n) in near.chain((0..ANY_POINTS).map(|n| (true, n))) {
        if !is_far && seen >= POINTS {
            continue;
        }
        let point = if is_far {
            Valuation::at_any_distance(model, equations, n)
        } else {
            Valuation::near_start(model, equations, n)
        };
        for at in with_constants(model, equations, &point, hamiltonian) {
            let (value, size) = equations.pool.evaluate_with_size(left, &|s| at.at(s));
            if value.is_finite() {
                let part = value.abs() / size.max(f64::MIN_POSITIVE);
                if counts(part, is_far) {
                    largest = largest.max(value.abs());
                    relative = relative.max(part);
                    let sizes = [energy, rate, left].map(|e| at.size(&equations.pool, e));
                    let size = sizes[2].max(sizes[0] + sizes[1]);
                    of_terms = of_terms.max(value.abs() / size.max(f64::MIN_POSITIVE));
                }
                seen += 1;
                break;
            }
        }
    }
    let value = (seen > 0).then_some(largest);
    Ok(Remainder { value, part: of_terms, solves: is_solved(relative) })
}

/// Whether what is left at a point, as a part of the terms, is left of the equation: far away what cancels within the terms is not.
fn counts(part: f64, is_far: bool) -> bool {
    !is_far || part > SOLVES_FAR
}

/// Whether the equation is solved if no more than this part of its terms is left anywhere.
fn is_solved(part: f64) -> bool {
    part < SOLVES
}

/// A point with numbers for the constants: those that its motion has, and others.
fn with_constants(
    model: &Model,
    equations: &Equations,
    point: &Valuation,
    hamiltonian: Expr,
) -> Vec<Valuation> {
    let (pool, known) = (&equations.pool, &equations.supplements.maps.new_variables);
    let constants = model.complete_integral.iter().flat_map(|s| &s.constants);
    let constants: Vec<Symbol> = constants.map(|c| c.symbol).collect();
    let scale = point.value(pool, hamiltonian).abs().max(0.1);
    // with more constants than coordinates some follow from the equation that is to be checked
    let has_own = constants.len() == model.coordinates.len();
    let tried = (0..TRIED.len()).map(|k| {
        let values = constants.iter().enumerate().map(|(i, &c)| {
            let own = known.iter().find(|(s, _)| *s == c).filter(|_| k == 0 && has_own);
            let own = own.map(|&(_, e)| point.value(pool, e));
            (c, own.unwrap_or(TRIED[(k + i) % TRIED.len()] * scale / (1.0 + i as f64)))
        });
        point.clone().with(values.collect::<Vec<_>>())
    });
    tried.collect()
}

/// Why a function S is not complete, whether it solves the equation or not.
fn not_complete(
    model: &Model,
    equations: &mut Equations,
    integral: &CompleteIntegral,
    (momenta, beta): (&[Expr], &[Expr]),
) -> Option<String> {
    let (constants, coordinates) = (integral.constants.len(), model.coordinates.len());
    if constants != coordinates {
        return Some(format!(
            "a complete integral has as many constants as coordinates: {coordinates}, not \
             {constants}"
        ));
    }
    let hamiltonian = equations.hamiltonian().clone().unwrap_or(Expr::ZERO);
    let pool = &mut equations.pool;
    let mut variables: Vec<Symbol> = model.coordinates.iter().map(|c| c.position).collect();
    variables.push(model.symbols.time);
    let mut matrix = Vec::new();
    for (constant, &beta) in integral.constants.iter().zip(beta) {
        let row: Vec<Expr> =
            momenta.iter().map(|&p| tidy_derivative(pool, p, constant.symbol)).collect();
        let name = &constant.name;
        if !pool.depends_on_any(beta, &variables) {
            return Some(format!(
                "`{name}` is an additive constant: ∂S/∂{name} is the same everywhere"
            ));
        }
        if row.iter().all(|&e| e == Expr::ZERO) {
            return Some(format!("no momentum ∂S/∂q depends on `{name}`"));
        }
        matrix.push(row);
    }
    let points: Vec<Valuation> = (0..POINTS as u64)
        .flat_map(|n| {
            let point = Valuation::near_start(model, equations, n);
            with_constants(model, equations, &point, hamiltonian)
        })
        .collect();
    singular(&equations.pool, &matrix, &points).then(|| {
        "the determinant of ∂²S/∂q∂α vanishes: the constants are not independent".to_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_equation_is_solved_to_1e_10_of_its_terms_and_far_away_to_1e_6() {
        assert!(is_solved(0.9e-10) && !is_solved(1.1e-10));
        assert!(counts(1.1e-6, true) && !counts(0.9e-6, true));
        assert!(counts(1e-16, false));
    }
}
