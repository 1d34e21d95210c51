//! Poisson brackets: [f, g] = Σ ∂f/∂q ∂g/∂p − ∂f/∂p ∂g/∂q, or {f, g} = ∇f · B ∇g where the file
//! gives the brackets B of its variables.
//!
//! In: two expressions, written as observables are. Out: their bracket as a function of (q, p, t),
//! and, where it is recognised, in terms of names that the file knows. Where the velocities are not
//! known in terms of the momenta, the value of the bracket at a point follows by the chain rule.
//! Constraints are ignored: the bracket is that of the phase space without them. Never here:
//! motion.
//! Source: *The Principles of Dynamics*, § 3.2.3.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};

use super::equations::{Equations, Flow, NoClosedForm};
use super::slope::zero_if_proved;
use crate::expr::{Expr, Rank, Symbol, Zero};
use crate::model::{Mechanics, Model};
use crate::num::{Number, math};

/// \[f, g\] as a function of (q, p, t), or of a Poisson system's variables and t.
///
/// The result is simplified, and exactly 0 where that is proved. `f` and `g` are written as
/// observables are, or are already such functions.
///
/// # Errors
/// Returns an error if f or g is not known as such a function.
pub fn bracket(
    model: &Model,
    equations: &mut Equations,
    f: Expr,
    g: Expr,
) -> Result<Expr, NoClosedForm> {
    let sum = unreduced_bracket(model, equations, f, g)?;
    let sum = equations.in_generating_variables(sum)?;
    let pool = &mut equations.pool;
    let sum = zero_if_proved(pool, sum);
    Ok(pool.simplify(sum))
}

/// \[f, g\] as [`bracket`] gives it, but to be evaluated: new variables of maps without a closed form stay in it, on the
/// branch that is followed.
///
/// # Errors
/// Returns an error if f or g is not known as a function of (q, p, t).
pub fn unreduced_bracket(
    model: &Model,
    equations: &mut Equations,
    f: Expr,
    g: Expr,
) -> Result<Expr, NoClosedForm> {
    let f = in_phase_space(equations, f)?;
    let g = in_phase_space(equations, g)?;
    let seeds = flow_of(model, equations, g)?;
    equations.derivation(f, &seeds)
}

/// An observable as a function of (q, p, t): velocities, accelerations, multipliers and the energy
/// are replaced by their expressions.
///
/// # Errors
/// Returns an error if one of these is not known in closed form, or if the action occurs in it.
pub fn in_phase_space(equations: &mut Equations, e: Expr) -> Result<Expr, NoClosedForm> {
    if equations.pool.depends(e, equations.symbols.action) {
        let why = "the action is an integral along the motion, not a function of its state";
        return Err(NoClosedForm(why.to_owned()));
    }
    let auxiliary: Vec<Symbol> = equations
        .supplements
        .auxiliary
        .iter()
        .flat_map(|auxiliary| auxiliary.symbols.clone())
        .collect();
    if equations.pool.depends_on_any(e, &auxiliary) {
        let why = "what is carried along beside the motion is not a function of its state";
        return Err(NoClosedForm(why.to_owned()));
    }
    if !equations.is_lagrangian() {
        return Ok(equations.open(e));
    }
    let mut e = e;
    if equations.pool.depends(e, equations.symbols.energy) {
        let energy = equations.hamiltonian().clone().unwrap_or(equations.energy);
        let energy = HashMap::from([(equations.symbols.energy, energy)]);
        e = equations.pool.substitute(e, &energy);
    }
    let mut e = equations.pool.substitute(e, &equations.attitude_map());
    let mut replacements = HashMap::new();
    let accelerations: Vec<Symbol> = equations.coordinates.iter().map(|c| c.acceleration).collect();
    if equations.pool.depends_on_any(e, &accelerations) {
        let solved = equations.solved().clone().map_err(|why| unknown("q″", "the state", &why))?;
        replacements.extend(accelerations.into_iter().zip(solved));
    }
    let multipliers: Vec<Symbol> = equations.constraints.iter().map(|c| c.multiplier).collect();
    if equations.pool.depends_on_any(e, &multipliers) {
        let known =
            equations.multipliers().clone().map_err(|why| unknown("λ", "the state", &why))?;
        replacements.extend(multipliers.into_iter().zip(known));
    }
    e = equations.pool.substitute(e, &replacements);
    let velocities: Vec<Symbol> = equations.coordinates.iter().map(|c| c.velocity).collect();
    if equations.pool.depends_on_any(e, &velocities) {
        let known = equations.velocities().clone().map_err(|why| unknown("q′", "p", &why))?;
        e = equations.pool.substitute(e, &velocities.into_iter().zip(known).collect());
    }
    Ok(e)
}

fn unknown(what: &str, by: &str, why: &NoClosedForm) -> NoClosedForm {
    NoClosedForm(format!("{what} is not known in terms of {by}: {why}"))
}

/// The derivation f ↦ \[f, g\]: the image of each variable of phase space.
///
/// # Errors
/// Returns an error if g contains new variables of a map whose derivatives are too long to be read.
fn flow_of(
    model: &Model,
    equations: &mut Equations,
    g: Expr,
) -> Result<Vec<(Symbol, Expr)>, NoClosedForm> {
    let coordinates = equations.coordinates.clone();
    let mut seeds = Vec::new();
    if let Mechanics::Poisson { brackets, .. } = &model.mechanics {
        let pool = &mut equations.pool;
        let slopes: Vec<Expr> =
            coordinates.iter().map(|c| pool.derivative(g, c.position)).collect();
        for (c, row) in coordinates.iter().zip(brackets) {
            let terms: Vec<Expr> =
                row.iter().zip(&slopes).map(|(&b, &slope)| pool.mul(b, slope)).collect();
            seeds.push((c.position, pool.sum(&terms)));
        }
    } else {
        for c in &coordinates {
            let by_q = equations.derivation(g, &[(c.position, Expr::ONE)])?;
            let by_p = equations.derivation(g, &[(c.momentum, Expr::ONE)])?;
            seeds.push((c.position, by_p));
            seeds.push((c.momentum, equations.pool.neg(by_q)));
        }
    }
    Ok(seeds)
}

/// \[f, g\] at points (q, q̇, t) of a Lagrangian system, by the chain rule. Only L needs to be
/// known in closed form.
#[derive(Clone, Debug)]
pub struct ChainRule {
    f: Slopes,
    g: Slopes,
    mass: Vec<Vec<Expr>>,
    /// ∂p_i/∂q_j at fixed velocities.
    momentum_slopes: Vec<Vec<Expr>>,
}

/// ∂/∂q at fixed q̇, and ∂/∂q̇.
#[derive(Clone, Debug)]
struct Slopes {
    positions: Vec<Expr>,
    velocities: Vec<Expr>,
}

impl ChainRule {
    /// Prepares the bracket of two observables.
    ///
    /// # Errors
    /// Returns an error if there is no Lagrangian, or if f or g is not known as a function of (q,
    /// q̇, t).
    pub fn of(equations: &mut Equations, f: Expr, g: Expr) -> Result<ChainRule, NoClosedForm> {
        let Flow::Lagrange { mass, .. } = equations.flow.clone() else {
            return Err(NoClosedForm("there is no Lagrangian to begin with".to_owned()));
        };
        let momenta = equations.momenta.clone();
        let momentum_slopes = momenta.iter().map(|&p| slopes(equations, p).positions).collect();
        let f = on_velocities(equations, f)?;
        let g = on_velocities(equations, g)?;
        let (f, g) = (slopes(equations, f), slopes(equations, g));
        Ok(ChainRule { f, g, mass, momentum_slopes })
    }

    /// The value of the bracket at a point; `at` gives the values of the symbols of q, q̇, t and
    /// the parameters. Returns `None` if ∂²L/∂q̇² is singular or something is not finite.
    ///
    /// With W = ∂p/∂q: ∂f/∂p = M⁻¹ ∂f/∂q̇, and ∂f/∂q at fixed p is ∂f/∂q − Wᵀ ∂f/∂p.
    pub fn value(&self, equations: &Equations, at: &dyn Fn(Symbol) -> f64) -> Option<f64> {
        let n = self.mass.len();
        let vector = |all: &[Expr]| DVector::from_fn(n, |i, _| equations.pool.evaluate(all[i], at));
        let matrix = |all: &[Vec<Expr>]| {
            DMatrix::from_fn(n, n, |i, j| equations.pool.evaluate(all[i][j], at))
        };
        let mass = matrix(&self.mass).full_piv_lu();
        let turned = matrix(&self.momentum_slopes).transpose();
        let in_phase_space = |slopes: &Slopes| {
            let by_p = mass.solve(&vector(&slopes.velocities))?;
            let by_q = vector(&slopes.positions) - &turned * &by_p;
            Some((by_q, by_p))
        };
        let (f_q, f_p) = in_phase_space(&self.f)?;
        let (g_q, g_p) = in_phase_space(&self.g)?;
        let value = f_q.dot(&g_p) - f_p.dot(&g_q);
        value.is_finite().then_some(value)
    }
}

/// An observable as a function of (q, q̇, t).
fn on_velocities(equations: &mut Equations, e: Expr) -> Result<Expr, NoClosedForm> {
    let mut e = equations.open(e);
    let accelerations: Vec<Symbol> = equations.coordinates.iter().map(|c| c.acceleration).collect();
    if equations.pool.depends_on_any(e, &accelerations) {
        let solved = equations.solved().clone().map_err(|why| unknown("q″", "the state", &why))?;
        e = equations.pool.substitute(e, &accelerations.into_iter().zip(solved).collect());
    }
    let mut others: Vec<Symbol> = equations.constraints.iter().map(|c| c.multiplier).collect();
    others.push(equations.symbols.action);
    others.extend(
        equations.supplements.auxiliary.iter().flat_map(|auxiliary| auxiliary.symbols.clone()),
    );
    if equations.pool.depends_on_any(e, &others) {
        return Err(NoClosedForm("it is not known as a function of q, q′ and t".to_owned()));
    }
    Ok(e)
}

fn slopes(equations: &mut Equations, e: Expr) -> Slopes {
    let (coordinates, pool) = (&equations.coordinates, &mut equations.pool);
    Slopes {
        positions: coordinates.iter().map(|c| pool.derivative(e, c.position)).collect(),
        velocities: coordinates.iter().map(|c| pool.derivative(e, c.velocity)).collect(),
    }
}

/// A bracket in terms of the names that the file knows.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Recognised {
    /// Zero, or parameters times names of observables, Casimirs and `energy`: −2 m energy L_z.
    pub expression: Expr,
    /// Whether that is proved, or only true to rounding.
    pub proof: Zero,
}

/// The largest number of names that are also tried in pairs.
const MOST_IN_PAIRS: usize = 16;

/// Recognises a function on phase space: as zero, as a declared observable, a Casimir or the
/// energy, or as the product of two of these, up to a factor made of parameters.
pub fn recognise(model: &Model, equations: &mut Equations, e: Expr) -> Option<Recognised> {
    match equations.pool.is_zero(e) {
        Zero::No | Zero::Unknown => {}
        proof => return Some(Recognised { expression: Expr::ZERO, proof }),
    }
    let constants = constants(model);
    if equations.pool.symbols_of(e).iter().all(|s| constants.contains(s)) {
        return None;
    }
    let known = names(model, equations);
    let mut candidates: Vec<(Expr, Expr)> = known.clone();
    if known.len() <= MOST_IN_PAIRS {
        for (i, &(name, a)) in known.iter().enumerate() {
            for &(other, b) in &known[i..] {
                let pool = &mut equations.pool;
                candidates.push((pool.mul(name, other), pool.mul(a, b)));
            }
        }
    }
    for (name, candidate) in candidates {
        let Some(factor) = common_factor(&constants, equations, e, candidate) else { continue };
        let pool = &mut equations.pool;
        let multiple = pool.mul(factor, candidate);
        let difference = pool.sub(e, multiple);
        let proof = pool.is_zero(difference);
        if matches!(proof, Zero::Proved | Zero::Numerically) {
            return Some(Recognised { expression: pool.mul(factor, name), proof });
        }
    }
    None
}

const ENERGY: &str = "energy";

/// The names by which a bracket may be reported, each with its function on phase space.
fn names(model: &Model, equations: &mut Equations) -> Vec<(Expr, Expr)> {
    let mut written: Vec<(String, Expr)> =
        model.observables.iter().map(|o| (o.name.clone(), o.expression)).collect();
    if let Mechanics::Poisson { casimirs, .. } = &model.mechanics {
        written.extend(casimirs.iter().map(|(name, e, _)| (name.clone(), *e)));
    }
    let energy = equations.pool.variable(equations.symbols.energy);
    written.push((ENERGY.to_owned(), energy));
    let mut known = Vec::new();
    for (name, e) in written {
        let Ok(opened) = in_phase_space(equations, e) else { continue };
        if equations.pool.as_number(opened).is_none() {
            let pool = &mut equations.pool;
            let symbol = pool.symbol(&name);
            let info = pool.symbol_info(symbol).clone();
            let shown = if name == ENERGY { "E" } else { info.unicode.as_str() };
            let latex = if name == ENERGY { "E" } else { info.latex.as_str() };
            // after the parameters
            pool.describe(symbol, shown, latex, Rank::Momentum);
            known.push((pool.variable(symbol), opened));
        }
    }
    known
}

/// The symbols that are constant along the motion: the parameters, and what follows from a body.
fn constants(model: &Model) -> Vec<Symbol> {
    let of_body = model.body.iter().flat_map(|body| body.names.all());
    model.parameters.iter().map(|p| p.symbol).chain(of_body).collect()
}

/// The monomial c Π (parameter)ⁿ, with c a small fraction, that `e` over `candidate` appears to be.
/// It is found from values, so a proof has to follow.
fn common_factor(
    constants: &[Symbol],
    equations: &mut Equations,
    e: Expr,
    candidate: Expr,
) -> Option<Expr> {
    let pool = &equations.pool;
    let value =
        |symbol: Symbol, turn: f64| 0.7 + 0.5 * math::sin(2.4 * symbol.index() as f64 + 1.7 * turn);
    let quotient = |turn: f64, doubled: Option<Symbol>| {
        let at = |symbol: Symbol| {
            let fixed = constants.contains(&symbol);
            let value = value(symbol, if fixed { 0.0 } else { turn });
            if doubled == Some(symbol) { 2.0 * value } else { value }
        };
        pool.evaluate(e, &at) / pool.evaluate(candidate, &at)
    };
    let first = quotient(1.0, None);
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(b.abs());
    if !first.is_finite()
        || first == 0.0
        || ![2.0, 3.0, 4.0].iter().all(|&turn| close(quotient(turn, None), first))
    {
        return None;
    }
    let mut factors: Vec<(Symbol, i64)> = Vec::new();
    let mut rest = first;
    for &symbol in constants {
        let doubled = quotient(1.0, Some(symbol)) / first;
        let power = math::log2(doubled).round();
        if !close(doubled, math::exp2(power)) {
            return None;
        }
        if power != 0.0 {
            factors.push((symbol, power as i64));
            rest /= math::powf(value(symbol, 0.0), power);
        }
    }
    let denominator = (1..=12_i64).find(|&d| {
        let n = rest * d as f64;
        n.round() != 0.0 && close(n, n.round()) && n.abs() < 1e6
    })?;
    let number = Number::ratio((rest * denominator as f64).round() as i128, denominator.into());
    let pool = &mut equations.pool;
    let factors: Vec<(Expr, Number)> =
        factors.into_iter().map(|(s, n)| (pool.variable(s), Number::integer(n))).collect();
    Some(pool.monomial(number, &factors))
}
