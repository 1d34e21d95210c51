//! Classifies the file's observables: conserved by proof, conserved to rounding, or not conserved,
//! and at what rate they change.
//!
//! In: the observables. Out: a [`Classed`] for each; *unknown* is a possible answer. Where the
//! accelerations are not known in closed form, they are solved for numerically at points near the
//! start.
//! Never here: the motion.
//! Source: *The Principles of Dynamics*, §§ 1.4.2, 3.2.3: df/dt = \[f, H\] + ∂f/∂t.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};

use super::equations::{Equations, Flow, NoClosedForm};
use super::sampling::{POINTS, TRIES};
use super::valuation::Valuation;
use crate::expr::{Expr, Symbol, Zero};
use crate::model::Model;
use crate::num::{Number, math};

/// An observable and its conservation class.
#[derive(Clone, Debug)]
pub struct Classed {
    /// Its name in the file.
    pub name: String,
    /// Whether it is conserved.
    pub class: Class,
    /// Its rate of change as a function of the state; 0 if that is proved.
    pub rate: Result<Expr, NoClosedForm>,
}

/// Whether an observable is conserved.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Class {
    /// Its rate is proved to vanish.
    Proved,
    /// Its rate vanishes to rounding at all points tried, and nothing in it could hide between
    /// them.
    Numerically,
    /// Its rate is proved to vanish at the file's values of the parameters, but not at others.
    AtTheseParameters,
    /// Its rate does not vanish.
    Changing,
    /// Neither is known, or its rate could not be computed.
    Unknown,
}

impl Class {
    /// Whether it is conserved, by proof or numerically.
    pub fn is_conserved(self) -> bool {
        matches!(self, Class::Proved | Class::Numerically | Class::AtTheseParameters)
    }
}

impl std::fmt::Display for Class {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Class::Proved => "conserved (proved)",
            Class::Numerically => "conserved (to rounding)",
            Class::AtTheseParameters => "conserved (proved at these parameters)",
            Class::Changing => "not conserved",
            Class::Unknown => "not known",
        })
    }
}

/// Classifies every declared observable.
pub fn classes(model: &Model, equations: &mut Equations) -> Vec<Classed> {
    let observables = model.observables.iter();
    observables.map(|o| class_of(model, equations, &o.name, o.expression)).collect()
}

/// Classifies an expression, written as an observable is.
pub fn class_of(model: &Model, equations: &mut Equations, name: &str, observable: Expr) -> Classed {
    let name = name.to_owned();
    let Some(rate) = equations.rate_of(observable) else {
        let (class, why) = at_points(model, equations, observable);
        return Classed { name, class, rate: Err(why) };
    };
    let rate = equations.pool.simplify(rate);
    if equations.may_jump(observable) {
        return Classed { name, class: Class::Unknown, rate: Ok(rate) };
    }
    let class = match equations.is_conserved(observable) {
        Some(Zero::Proved) => return Classed { name, class: Class::Proved, rate: Ok(Expr::ZERO) },
        Some(Zero::Numerically) => Class::Numerically,
        // the rate may vanish where the constraints are satisfied, and only there
        _ if !equations.constraints.is_empty() => by_values(model, equations, rate),
        zero => at_parameters(model, equations, rate, zero == Some(Zero::No)),
    };
    Classed { name, class, rate: Ok(rate) }
}

/// Classifies a rate that does not vanish for all values of the parameters, or is not known to; it
/// may vanish at the file's own values.
fn at_parameters(model: &Model, equations: &mut Equations, rate: Expr, refuted: bool) -> Class {
    let values = model.parameters.iter().filter_map(|p| {
        let value = Number::Real(p.value).canonical();
        value.is_finite().then_some((p.symbol, value))
    });
    let values: Vec<(Symbol, Number)> = values.collect();
    let pool = &mut equations.pool;
    let values = values.into_iter().map(|(s, n)| (s, pool.number(n))).collect();
    let here = pool.substitute(rate, &values);
    match pool.is_zero(here) {
        Zero::Proved => Class::AtTheseParameters,
        Zero::No => Class::Changing,
        Zero::Numerically => Class::Unknown,
        Zero::Unknown if refuted && here == rate => Class::Changing,
        Zero::Unknown => match by_values(model, equations, rate) {
            Class::Changing => Class::Changing,
            _ => Class::Unknown,
        },
    }
}

/// Classifies by values of the rate, which may contain accelerations and multipliers, at points
/// near the start that satisfy the constraints.
fn by_values(model: &Model, equations: &Equations, rate: Expr) -> Class {
    let mut seen = 0;
    for n in 0..TRIES {
        let Some(point) = Valuation::on_constraints(model, equations, n) else { continue };
        let Some(solved) = solved_at(equations, &point) else { continue };
        let at = |s: Symbol| match s {
            s if s == equations.symbols.action => 0.0,
            s => solved.get(&s).copied().unwrap_or_else(|| point.at(s)),
        };
        // the point satisfies the constraints, and the accelerations their equations, to rounding
        match equations.pool.vanishes_at(rate, SLACK, &at) {
            Some(false) => return Class::Changing,
            Some(true) => seen += 1,
            None => {}
        }
        if seen == POINTS {
            break;
        }
    }
    if seen == POINTS && !equations.pool.may_hide(rate) {
        Class::Numerically
    } else {
        Class::Unknown
    }
}

/// The relative error allowed in quantities that are solved for at a point.
const SLACK: f64 = 1e-10;

/// Classifies by the rate's values, and returns why there is no formula for the rate.
fn at_points(model: &Model, equations: &mut Equations, observable: Expr) -> (Class, NoClosedForm) {
    let why = match equations.solved() {
        Err(why) => NoClosedForm(format!("q″ is not known in closed form: {why}")),
        Ok(_) => NoClosedForm("what it is made of is not known in closed form".to_owned()),
    };
    let opened = equations.open(observable);
    let accelerations = equations.coordinates.iter().map(|c| c.acceleration);
    let multipliers = equations.constraints.iter().map(|c| c.multiplier);
    let auxiliary =
        equations.supplements.auxiliary.iter().flat_map(|auxiliary| auxiliary.symbols.clone());
    let unknown: Vec<Symbol> = accelerations.chain(multipliers).chain(auxiliary).collect();
    if !equations.is_lagrangian() || equations.pool.depends_on_any(opened, &unknown) {
        return (Class::Unknown, why);
    }
    // dg/dt in the symbols of q̈
    let mut seeds = equations.by_time();
    seeds.push((equations.symbols.action, equations.action_rate));
    for c in equations.coordinates.clone() {
        seeds.push((c.position, equations.pool.variable(c.velocity)));
        seeds.push((c.velocity, equations.pool.variable(c.acceleration)));
    }
    let rate = equations.pool.derivation(opened, &seeds);
    (by_values(model, equations, rate), why)
}

/// q̈ and λ at a point, from M q̈ − Aᵀλ = f and A q̈ = γ. If constraints are redundant, λ is the
/// solution of least norm.
fn solved_at(equations: &Equations, point: &Valuation) -> Option<HashMap<Symbol, f64>> {
    let Flow::Lagrange { mass, force, .. } = &equations.flow else { return Some(HashMap::new()) };
    let (n, rows) = (force.len(), &equations.constraints);
    let all = n + rows.len();
    let value = |e| equations.pool.evaluate(e, &|s| point.at(s));
    let matrix = DMatrix::from_fn(all, all, |i, j| match (i < n, j < n) {
        (true, true) => value(mass[i][j]),
        (true, false) => -value(rows[j - n].row[i]),
        (false, true) => value(rows[i - n].row[j]),
        (false, false) => 0.0,
    });
    let right =
        DVector::from_fn(all, |i, _| if i < n { value(force[i]) } else { value(rows[i - n].bias) });
    if !matrix.iter().chain(right.iter()).all(|x| x.is_finite()) {
        return None;
    }
    let solved = solve(matrix, right, rows.is_empty())?;
    let accelerations = equations.coordinates.iter().map(|c| c.acceleration);
    let symbols = accelerations.chain(rows.iter().map(|c| c.multiplier));
    Some(symbols.zip(solved.iter().copied()).collect())
}

/// The number of passes that bring rows and columns to the same size.
const ROUNDS: usize = 8;

/// Solves equations whose rows and columns have units of their own, and so any sizes. The solution
/// is the least-squares one unless the matrix has to be `regular`.
fn solve(mut matrix: DMatrix<f64>, mut right: DVector<f64>, regular: bool) -> Option<DVector<f64>> {
    let n = right.len();
    let mut columns = vec![1.0; n];
    // powers of two, so that nothing is rounded
    let factor = |size: f64| {
        if size > 0.0 { math::exp2(-(math::log2(size) / 2.0).round()) } else { 1.0 }
    };
    for _ in 0..ROUNDS {
        let below: Vec<f64> = (0..n).map(|i| factor(matrix.row(i).amax())).collect();
        let across: Vec<f64> = (0..n).map(|j| factor(matrix.column(j).amax())).collect();
        for i in 0..n {
            right[i] *= below[i];
            columns[i] *= across[i];
            for j in 0..n {
                matrix[(i, j)] *= below[i] * across[j];
            }
        }
    }
    let scaled = if regular {
        matrix.full_piv_lu().solve(&right)?
    } else {
        let scale = matrix.amax();
        matrix.svd(true, true).solve(&right, 1e-10 * scale).ok()?
    };
    Some(DVector::from_fn(n, |j, _| scaled[j] * columns[j]))
}
