//! Which of the file's observables are conserved: proved, to rounding, or not, and at what rate.
//!
//! In: the observables. Out: a [`Classed`] for each. Where the accelerations are not known in
//! closed form they are solved for at points near the start. Never here: the motion.
//! Source: *The Principles of Dynamics*, §§ 1.4.2, 3.2.3: df/dt = \[f, H\] + ∂f/∂t.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};

use super::equations::{Equations, Flow, WhyNot};
use super::nearby::{POINTS, Point, TRIES};
use crate::expr::{Expr, Symbol, Zero};
use crate::model::Model;

/// An observable and what the motion does to it.
#[derive(Clone, Debug)]
pub struct Classed {
    /// Its name in the file.
    pub name: String,
    /// Whether it is conserved.
    pub class: Class,
    /// Its rate of change, a function of the state; 0 where that is proved.
    pub rate: Result<Expr, WhyNot>,
}

/// Whether an observable is conserved.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Class {
    /// Its rate vanishes by proof.
    Proved,
    /// Its rate vanishes to rounding wherever it was looked at.
    Numerically,
    /// It changes.
    Changing,
    /// Its rate could not be had at all.
    Unknown,
}

impl Class {
    /// Whether it is conserved, however that is known.
    pub fn is_conserved(self) -> bool {
        matches!(self, Class::Proved | Class::Numerically)
    }
}

impl std::fmt::Display for Class {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Class::Proved => "conserved (proved)",
            Class::Numerically => "conserved (to rounding)",
            Class::Changing => "not conserved",
            Class::Unknown => "not known",
        })
    }
}

/// The class of every declared observable.
pub fn classes(model: &Model, equations: &mut Equations) -> Vec<Classed> {
    let observables = model.observables.iter();
    observables.map(|o| classed(model, equations, &o.name, o.expression)).collect()
}

fn classed(model: &Model, equations: &mut Equations, name: &str, observable: Expr) -> Classed {
    let name = name.to_owned();
    let Some(rate) = equations.rate_of(observable) else {
        let (class, why) = at_points(model, equations, observable);
        return Classed { name, class, rate: Err(why) };
    };
    let (class, rate) = match equations.pool.is_zero(rate) {
        Zero::Proved => (Class::Proved, Expr::ZERO),
        Zero::Numerically => (Class::Numerically, rate),
        // it may vanish where the constraints hold, and only there
        Zero::No if !equations.constraints.is_empty() => {
            (by_values(model, equations, rate), equations.pool.simplify(rate))
        }
        Zero::No => (Class::Changing, equations.pool.simplify(rate)),
    };
    Classed { name, class, rate: Ok(rate) }
}

/// The class by values of the rate, which may hold accelerations and multipliers, at points near
/// the start that obey the constraints.
fn by_values(model: &Model, equations: &Equations, rate: Expr) -> Class {
    let mut seen = 0;
    for n in 0..TRIES {
        let Some(point) = Point::on_constraints(model, equations, n) else { continue };
        let Some(solved) = solved_at(equations, &point) else { continue };
        let at = |s: Symbol| match s {
            s if s == equations.symbols.action => 0.0,
            s => solved.get(&s).copied().unwrap_or_else(|| point.at(s)),
        };
        let (value, size) = equations.pool.evaluate_with_size(rate, &at);
        if !value.is_finite() || !size.is_finite() {
            continue;
        }
        if value.abs() > 1e-10 * size.max(1e-3) {
            return Class::Changing;
        }
        seen += 1;
        if seen == POINTS {
            return Class::Numerically;
        }
    }
    Class::Unknown
}

/// The class by the rate's values, and why there is no formula for it.
fn at_points(model: &Model, equations: &mut Equations, observable: Expr) -> (Class, WhyNot) {
    let why = match &equations.solved {
        Err(why) => WhyNot(format!("q̈ is not known in closed form: {why}")),
        Ok(_) => WhyNot("what it is made of is not known in closed form".to_owned()),
    };
    let opened = equations.open(observable);
    let accelerations = equations.coordinates.iter().map(|c| c.acceleration);
    let multipliers = equations.constraints.iter().map(|c| c.multiplier);
    let carried = equations.beside.carried.iter().flat_map(|carried| carried.symbols.clone());
    let unknown: Vec<Symbol> = accelerations.chain(multipliers).chain(carried).collect();
    if !equations.is_lagrangian() || equations.pool.depends_on_any(opened, &unknown) {
        return (Class::Unknown, why);
    }
    // dg/dt in the symbols of q̈
    let mut seeds = vec![
        (equations.symbols.time, Expr::ONE),
        (equations.symbols.action, equations.action_rate),
    ];
    for c in equations.coordinates.clone() {
        seeds.push((c.position, equations.pool.variable(c.velocity)));
        seeds.push((c.velocity, equations.pool.variable(c.acceleration)));
    }
    let rate = equations.pool.derivation(opened, &seeds);
    (by_values(model, equations, rate), why)
}

/// q̈ and λ at a point, from M q̈ − Aᵀλ = f and A q̈ = γ; λ of least norm where constraints repeat
/// each other.
fn solved_at(equations: &Equations, point: &Point) -> Option<HashMap<Symbol, f64>> {
    let Flow::Lagrange { mass, force, .. } = &equations.flow else { return None };
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
    let solved = if rows.is_empty() {
        matrix.full_piv_lu().solve(&right)?
    } else {
        let scale = matrix.amax();
        matrix.svd(true, true).solve(&right, 1e-12 * scale).ok()?
    };
    let accelerations = equations.coordinates.iter().map(|c| c.acceleration);
    let symbols = accelerations.chain(rows.iter().map(|c| c.multiplier));
    Some(symbols.zip(solved.iter().copied()).collect())
}
