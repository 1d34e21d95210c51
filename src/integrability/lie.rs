//! Lie point symmetries of the equations of motion: changes of time and coordinates that take solutions to solutions,
//! whether or not they come from the Lagrangian.
//!
//! In: a model with accelerations q̈ = F(q, q̇, t). Out: generators ξ ∂_t + Σ η^i ∂_i, those of Noether first. The condition
//! η^{i(2)} = (ξ ∂_t + η^j ∂_j + η^{j(1)} ∂/∂q̇^j) F^i, with η^{(1)} = D η − q̇ D ξ, η^{(2)} = D η^{(1)} − q̈ D ξ and D along the
//! motion, is linear in the coefficients of ξ and η; it is solved modulo a prime over the same monomials as Noether's, and
//! each solution is proved symbolically. Never here: what is constant.
//! Source: P. J. Olver, *Applications of Lie Groups to Differential Equations*, § 2.3.

use std::collections::HashMap;

use rustc_hash::FxHashMap;

use super::determining_equations::{DeterminingEquations, MOST, SampledConditions};
use super::echelon::Echelon;
use super::evaluator::ResidueEvaluator;
use super::explicit_motion::{ExplicitMotion, accelerations};
use super::naming::name_of;
use super::noether::{DEGREE, Symmetries, words};
use super::ramps;
use super::random::Random;
use super::stand_in;
use super::transformations::{generators_of, products};
use super::units::Unsupported;
use super::varied_lagrangian::{Symmetry, VariedLagrangian};
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{Equations, is_changed_by_impulse};
use crate::model::Model;
use crate::num::{Number, PrimeField, Residue};

/// The points at which symmetries are compared as functions.
const COMPARED: usize = 40;

/// A symmetry of the equations of motion.
#[derive(Clone, Debug)]
pub struct PointSymmetry {
    /// What it is called.
    pub name: String,
    /// ξ, the change of time.
    pub time: Expr,
    /// η, the change of each coordinate.
    pub coordinates: Vec<Expr>,
    /// Whether it is one of Noether's: it changes L dt by a total derivative. `None` where neither answer is proved, or
    /// there is no Lagrangian that is the whole law.
    pub noether: Option<bool>,
    /// Whether it is so for all values of the parameters, and not only at the current ones.
    pub for_all_parameters: bool,
    /// Of a scaling t → λ^a t, q_i → λ^{b_i} q_i: a and the b_i.
    pub scaling: Option<Vec<Number>>,
}

/// The symmetries of the equations that were found, Noether's first, and where. All of them are proved.
pub type PointSymmetries = Symmetries<PointSymmetry>;

/// Searches for Lie point symmetries of the equations of motion, at the parameters' values. `noether` are those that come
/// from the Lagrangian, if they are known; those that are met here, as their gauge terms are of higher degree, are added.
///
/// # Errors
/// Returns an error if there are constraints, the equations cannot be solved for the accelerations, or they have a function
/// that cannot be evaluated modulo a prime.
pub fn point_symmetries(
    model: &Model,
    equations: &mut Equations,
    noether: Option<&mut Symmetries>,
    is_over: &dyn Fn() -> bool,
) -> Result<PointSymmetries, Unsupported> {
    if !model.constraints.is_empty() {
        let why = "symmetries of equations under constraints are not searched for";
        return Err(Unsupported(why.to_owned()));
    }
    ramps::refuse(model)?;
    let symbolic = accelerations(equations)?;
    let values: HashMap<Symbol, Expr> = stand_in::constants(model, equations)
        .into_iter()
        .map(|(s, n)| (s, equations.pool.number(n)))
        .collect();
    let lagrangian = equations.lagrangian().clone().ok();
    let (generic, by_names) = (stand_in::has_stand_ins(model, equations), lagrangian);
    let pool = &mut equations.pool;
    let here: Vec<Expr> = symbolic.iter().map(|&e| pool.substitute(e, &values)).collect();
    let law = match lagrangian {
        Some(law) => pool.substitute(law, &values),
        None => pool.sum(&here),
    };
    let time = equations.symbols.time;
    let (positions, velocities): (Vec<Symbol>, Vec<Symbol>) =
        equations.coordinates.iter().map(|c| (c.position, c.velocity)).unzip();
    let moving: Vec<Symbol> = positions.iter().chain(&velocities).chain([&time]).copied().collect();
    if here.iter().any(|&e| pool.may_have_kink(e, &moving)) {
        return Err(Unsupported("the equations of motion have kinks".to_owned()));
    }
    let generators = generators_of(pool, law, time, &positions, &velocities);
    let (degree, monomials) = products(pool, &generators, DEGREE, MOST / (positions.len() + 2));
    let first: Vec<(Expr, Vec<Expr>)> = noether
        .as_deref()
        .iter()
        .flat_map(|known| &known.found)
        .filter(|s| s.proved)
        .map(|s| (s.time, s.coordinates.clone()))
        .collect();
    let mut problem = LieProblem {
        conditions: DeterminingEquations::of(monomials, positions.len() + 1),
        motion: ExplicitMotion::of(pool, time, positions, velocities, here.clone()),
        overgeneral: false,
    };
    let solved = problem.solve(pool, &first, is_over)?;
    let motion = problem.motion.clone();
    let named = (symbolic != here).then(|| {
        let ExplicitMotion { time, positions, velocities, .. } = motion.clone();
        ExplicitMotion::of(pool, time, positions, velocities, symbolic)
    });
    let proved = noether.as_deref().map_or(&[][..], |known| &known.found);
    let mut answer = PointSymmetries {
        found: of_noether(pool, &motion, proved),
        searched: String::new(),
        complete: !problem.overgeneral && !generic,
        unwritten: 0,
        unfinished: 0,
    };
    problem.write(pool, (solved, named.as_ref()), generic, is_over, &mut answer);
    if let Some(noether) = noether {
        let ExplicitMotion { time, positions, velocities, .. } = motion.clone();
        let varied = VariedLagrangian::of(&mut equations.pool, law, time, positions, velocities);
        let mut laws: Vec<VariedLagrangian> = Vec::new();
        laws.extend(by_names.map(|named| varied.with(&mut equations.pool, named)));
        // what holds for stand-ins need not hold for the values
        laws.extend((!generic).then(|| varied.clone()));
        let others = answer.found.split_off(first.len());
        let others = with_charges((model, equations), (&varied, &laws), noether, others, is_over);
        answer.found.extend(others);
    }
    let pool = &mut equations.pool;
    let shown = match by_names {
        Some(law) if generic => {
            generators_of(pool, law, motion.time, &motion.positions, &motion.velocities)
        }
        _ => generators,
    };
    let searched = words(pool, &shown, degree);
    answer.searched = format!("changes of time and coordinates that are {searched}");
    Ok(answer)
}

/// Those that are proved to come from the Lagrangian.
fn of_noether(pool: &mut Pool, motion: &ExplicitMotion, known: &[Symmetry]) -> Vec<PointSymmetry> {
    let point_symmetry = |s: &Symmetry| PointSymmetry {
        name: s.name.clone(),
        time: s.time,
        coordinates: s.coordinates.clone(),
        noether: Some(true),
        for_all_parameters: s.for_all_parameters,
        scaling: motion.scaling(pool, s.time, &s.coordinates),
    };
    known.iter().filter(|s| s.proved).map(point_symmetry).collect()
}

/// Finds out which of these symmetries leave the action stationary, and adds each of those with its constant to `noether`. Returns them
/// all, those first that do.
fn with_charges(
    (model, equations): (&Model, &mut Equations),
    (varied, laws): (&VariedLagrangian, &[VariedLagrangian]),
    noether: &mut Symmetries,
    symmetries: Vec<PointSymmetry>,
    is_over: &dyn Fn() -> bool,
) -> Vec<PointSymmetry> {
    let (mut found, mut others) = (Vec::new(), Vec::new());
    for mut symmetry in symmetries {
        if is_over() {
            others.push(symmetry);
            continue;
        }
        let change = varied.change(&mut equations.pool, symmetry.time, &symmetry.coordinates);
        symmetry.noether = equations.gauge(change, Expr::ZERO).total_derivative;
        let is_noether = symmetry.noether == Some(true);
        let charge = is_noether.then(|| charge(equations, laws, &symmetry)).flatten();
        let Some(mut charge) = charge else {
            others.push(symmetry);
            continue;
        };
        charge.between_impulses = is_changed_by_impulse(equations, model, charge.conserved);
        let is_other = |s: &Symmetry| {
            s.proved || (s.time, &s.coordinates) != (symmetry.time, &symmetry.coordinates)
        };
        noether.found.retain(is_other);
        noether.found.push(charge);
        found.push(symmetry);
    }
    found.extend(others);
    found
}

/// A symmetry of one of some Lagrangians with its gauge term and constant, the first of them for all values of the parameters.
fn charge(
    equations: &mut Equations,
    laws: &[VariedLagrangian],
    symmetry: &PointSymmetry,
) -> Option<Symmetry> {
    let (xi, eta) = (symmetry.time, &symmetry.coordinates);
    laws.iter().enumerate().find_map(|(k, law)| {
        let change = law.change(&mut equations.pool, xi, eta);
        let gauge = equations.gauge(change, Expr::ZERO).function?;
        let found = law.symmetry(&mut equations.pool, xi, eta.clone(), gauge);
        found.proved.then_some(Symmetry { for_all_parameters: k == 0, ..found })
    })
}

/// The condition on the coefficients of ξ and η.
struct LieProblem {
    motion: ExplicitMotion,
    conditions: DeterminingEquations,
    overgeneral: bool,
}

impl LieProblem {
    /// Adds the solutions that can be written, and counts the others. `named` is the motion with the parameters by their names, if it
    /// has any; those that are `generic` may be stand-ins for other values.
    fn write(
        &mut self,
        pool: &mut Pool,
        (solutions, named): (Vec<Vec<Residue>>, Option<&ExplicitMotion>),
        generic: bool,
        is_over: &dyn Fn() -> bool,
        answer: &mut PointSymmetries,
    ) {
        for vector in solutions {
            if is_over() {
                answer.complete = false;
                answer.unfinished += 1;
                continue;
            }
            let exact = self.exact(pool, &vector);
            let motion = &self.motion;
            // for stand-ins it need not be one for the values that they are for
            let symmetry = exact.and_then(|(xi, eta)| {
                let by_name = named.is_none_or(|named| named.is_symmetry(pool, xi, &eta));
                let is_one = by_name || (!generic && motion.is_symmetry(pool, xi, &eta));
                is_one.then_some((xi, eta, by_name))
            });
            let Some((xi, eta, by_name)) = symmetry else {
                answer.complete = false;
                answer.unwritten += usize::from(!generic);
                continue;
            };
            answer.found.push(PointSymmetry {
                name: name_of(pool, motion.time, &motion.positions, xi, &eta),
                scaling: motion.scaling(pool, xi, &eta),
                time: xi,
                coordinates: eta,
                noether: None,
                for_all_parameters: by_name,
            });
        }
    }

    /// The solutions modulo a prime that are not combinations of the `first` ones, as sparse as they come.
    fn solve(
        &mut self,
        pool: &mut Pool,
        first: &[(Expr, Vec<Expr>)],
        is_over: &dyn Fn() -> bool,
    ) -> Result<Vec<Vec<Residue>>, Unsupported> {
        let motion = self.motion.clone();
        let (n, m) = (motion.positions.len(), self.conditions.monomials.len());
        let seeds = motion.first(pool);
        let moved: Vec<Expr> =
            self.conditions.monomials.iter().map(|&e| pool.derivation(e, &seeds)).collect();
        let mut roots = [self.conditions.monomials.clone(), moved.clone()].concat();
        roots.extend(&motion.accelerations);
        for (by_time, by_position, by_velocity) in &motion.slopes {
            roots.push(*by_time);
            roots.extend(by_position.iter().chain(by_velocity));
        }
        roots.extend(first.iter().flat_map(|(xi, eta)| [xi].into_iter().chain(eta)));
        let moving: Vec<Symbol> = motion
            .positions
            .iter()
            .chain(&motion.velocities)
            .chain([&motion.time])
            .copied()
            .collect();
        let evaluator = ResidueEvaluator::new(pool, &roots, &moving)?;
        self.overgeneral = evaluator.overgeneral;
        let why = "no point was found at which the accelerations have values modulo a prime";
        let has_values = |field, random: &mut Random| {
            self.rows(&evaluator, &moved, first, field, random).is_some()
        };
        let field = DeterminingEquations::field_where(has_values, why)?;
        self.conditions.field = field;
        let mut points: Vec<(Vec<Residue>, Vec<Residue>)> = Vec::new();
        let mut draw = |random: &mut Random| {
            let (sampled, known) = self.rows(&evaluator, &moved, first, field, random)?;
            if points.len() < COMPARED {
                points.push((sampled.values.clone(), known));
            }
            Some(sampled)
        };
        let mut solutions = self.conditions.solutions(&mut draw, COMPARED, &[], is_over)?;
        // as functions at the points: those known first
        let mut chosen = Echelon::new(field, COMPARED * (n + 1));
        for (s, _) in first.iter().enumerate() {
            let row = points.iter().flat_map(|(_, known)| &known[s * (n + 1)..][..=n]);
            chosen.add(row.copied().collect());
        }
        solutions.retain(|vector| {
            let row = points.iter().flat_map(|(values, _)| {
                vector.chunks_exact(m).map(move |coefficients| {
                    let terms = coefficients.iter().zip(values);
                    terms.fold(Residue::ZERO, |sum, (&c, &x)| field.add(sum, field.mul(c, x)))
                })
            });
            chosen.add(row.collect())
        });
        Ok(solutions)
    }

    /// The monomials' values at a random point, the conditions there on the coefficients of ξ and of each η, and the values
    /// of the `first` symmetries.
    fn rows(
        &self,
        evaluator: &ResidueEvaluator,
        moved: &[Expr],
        first: &[(Expr, Vec<Expr>)],
        field: PrimeField,
        random: &mut Random,
    ) -> Option<(SampledConditions, Vec<Residue>)> {
        let motion = &self.motion;
        let mut state: FxHashMap<Symbol, Residue> = FxHashMap::default();
        let moving = motion.positions.iter().chain(&motion.velocities).chain([&motion.time]);
        evaluator.draw(field, random, moving.copied(), &mut state);
        let point = evaluator.point(field, random, 7, &|s| state.get(&s).copied())?;
        let value = |e: Expr| evaluator.value(&point, e);
        let speeds: Vec<Residue> = motion.velocities.iter().map(|v| state[v]).collect();
        let forces: Vec<Residue> = motion.accelerations.iter().map(|&f| value(f)).collect();
        let seed = |s: Symbol| {
            if s == motion.time {
                field.one()
            } else if let Some(k) = motion.positions.iter().position(|&q| q == s) {
                speeds[k]
            } else {
                motion.velocities.iter().position(|&v| v == s).map_or(Residue::ZERO, |k| forces[k])
            }
        };
        let rates = evaluator.rates(&point, &seed)?;
        let values: Vec<Residue> = self.conditions.monomials.iter().map(|&e| value(e)).collect();
        let slopes: Vec<Residue> = moved.iter().map(|&e| value(e)).collect();
        let bends: Vec<Residue> = moved.iter().map(|&e| evaluator.rate(&rates, e)).collect();
        let combined = |a: Residue, b: Residue, c: Residue| {
            let each = values.iter().zip(&slopes).zip(&bends);
            each.map(move |((&m, &d), &dd)| {
                let sum = field.add(field.mul(m, a), field.mul(d, b));
                field.add(sum, field.mul(dd, c))
            })
        };
        let mut rows = Vec::new();
        for (i, (by_time, by_position, by_velocity)) in motion.slopes.iter().enumerate() {
            let mut row = Vec::new();
            // ξ: −F_t m + (Σ q̇ ∂F/∂q̇ − 2F) Dm − q̇ D²m
            let mut across = Residue::ZERO;
            for (&v, &e) in speeds.iter().zip(by_velocity) {
                across = field.add(across, field.mul(v, value(e)));
            }
            let twice = field.add(forces[i], forces[i]);
            row.extend(combined(
                field.neg(value(*by_time)),
                field.sub(across, twice),
                field.neg(speeds[i]),
            ));
            // η^k: δ D²m − ∂F/∂q̇ Dm − ∂F/∂q m
            for k in 0..speeds.len() {
                let own = if k == i { field.one() } else { Residue::ZERO };
                row.extend(combined(
                    field.neg(value(by_position[k])),
                    field.neg(value(by_velocity[k])),
                    own,
                ));
            }
            rows.push(row);
        }
        let known = first.iter().flat_map(|(xi, eta)| [xi].into_iter().chain(eta));
        let known = known.map(|&e| value(e)).collect();
        Some((SampledConditions { values, rows }, known))
    }

    /// ξ and η with rational coefficients.
    fn exact(&self, pool: &mut Pool, vector: &[Residue]) -> Option<(Expr, Vec<Expr>)> {
        let mut all = self.conditions.functions_of(pool, vector, self.conditions.functions)?;
        let eta = all.split_off(1);
        Some((all[0], eta))
    }
}
