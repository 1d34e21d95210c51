//! Noether's symmetries of a Lagrangian: transformations of time and coordinates that change L dt by a total derivative
//! only, and what is constant because of each.
//!
//! In: a model with its Lagrangian. Out: generators ξ ∂_t + Σ η^i ∂_i with their gauge terms f and constants. The
//! condition ξ L_t + η^i L_{q^i} + (D_t η^i − q̇^i D_t ξ) L_{q̇^i} + L D_t ξ = D_t f is linear in the coefficients of ξ, η,
//! f; it is solved modulo a prime over monomials in t, q and what the law is made of, and each solution is proved
//! symbolically. Never here: other symmetries of the equations.
//! Source: E. Noether, *Invariante Variationsprobleme* (1918); *The Principles of Dynamics*, § 1.4.2.

use std::collections::HashMap;

use rustc_hash::FxHashMap;

use super::determining_equations::{DeterminingEquations, MOST, SampledConditions};
use super::echelon::Echelon;
use super::evaluator::ResidueEvaluator;
use super::ramps;
use super::random::Random;
use super::stand_in;
use super::transformations::{generators_of, products};
use super::units::Unsupported;
use super::varied_lagrangian::{Symmetry, VariedLagrangian};
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{Equations, is_changed_by_impulse};
use crate::model::Model;
use crate::num::{PrimeField, Residue};

/// The greatest degree of ξ, η and f in t, q and the other functions.
pub(super) const DEGREE: u32 = 3;

/// The symmetries that were found, and where.
#[derive(Clone, Debug)]
pub struct Symmetries<S = Symmetry> {
    /// A basis of them.
    pub found: Vec<S>,
    /// What was searched, in words.
    pub searched: String,
    /// Whether their number is proved: the ansatz has no others, but for a chance far below 2⁻⁵⁰⁰ that a dependence of
    /// monomials is seen at random points and does not hold.
    pub complete: bool,
    /// How many more there are whose coefficients are no short fractions, or that are not proved, so that they are not written.
    pub unwritten: usize,
    /// How many more there are that were not written when the time ran out.
    pub unfinished: usize,
}

/// Searches for Noether's symmetries of a Lagrangian, at the parameters' values.
///
/// # Errors
/// Returns an error if there is no Lagrangian, something besides it acts, or it has a function that cannot be
/// evaluated modulo a prime.
pub fn symmetries(
    model: &Model,
    equations: &mut Equations,
    is_over: &dyn Fn() -> bool,
) -> Result<Symmetries, Unsupported> {
    let refused = |why: &str| Err(Unsupported(why.to_owned()));
    let Ok(lagrangian) = equations.lagrangian().clone() else {
        return refused("there is no Lagrangian in closed form");
    };
    if !model.constraints.is_empty() {
        return refused("symmetries of a Lagrangian under constraints are not searched for");
    }
    let forces = model.mechanics.forces();
    if model.mechanics.dissipation() != Expr::ZERO || forces.iter().any(|&f| f != Expr::ZERO) {
        return refused(
            "friction or forces act beside the Lagrangian, whose symmetries then give no constants",
        );
    }
    ramps::refuse(model)?;
    let values: HashMap<Symbol, Expr> = stand_in::constants(model, equations)
        .into_iter()
        .map(|(s, n)| (s, equations.pool.number(n)))
        .collect();
    let pool = &mut equations.pool;
    let symbolic = lagrangian;
    let lagrangian = pool.substitute(lagrangian, &values);
    let time = equations.symbols.time;
    let (positions, velocities): (Vec<Symbol>, Vec<Symbol>) =
        equations.coordinates.iter().map(|c| (c.position, c.velocity)).unzip();
    let law = VariedLagrangian::of(pool, lagrangian, time, positions, velocities);
    let mut problem = NoetherProblem::of(pool, law);
    let vectors = problem.solve(pool, is_over)?;
    let mut found: Vec<Symmetry> = Vec::new();
    // those that occur in L
    let generic = symbolic != lagrangian && stand_in::has_stand_ins(model, equations);
    let pool = &mut equations.pool;
    let mut complete = !problem.overgeneral && !generic;
    let (mut unwritten, mut unfinished) = (0, 0);
    // the same changes with the parameters' names, where they are symmetries for all their values
    let named = (symbolic != lagrangian).then(|| problem.law.with(pool, symbolic));
    let mut other_gauge: Vec<(Expr, Vec<Expr>)> = Vec::new();
    for vector in vectors {
        if is_over() {
            (complete, unfinished) = (false, unfinished + 1);
            continue;
        }
        let solution = problem.exact(pool, &vector);
        let by_name = named.as_ref().zip(solution.clone());
        let by_name = by_name.map(|(named, (xi, eta, f))| named.symmetry(pool, xi, eta, f));
        match (by_name.filter(|symmetry| symmetry.proved), solution) {
            (Some(symmetry), _) => found.push(symmetry),
            // it need not be one for the values that the stand-ins are for
            (None, Some((xi, eta, _))) if generic => other_gauge.push((xi, eta)),
            (None, Some((xi, eta, f))) => {
                let symmetry = problem.law.symmetry(pool, xi, eta, f);
                found.push(Symmetry { for_all_parameters: named.is_none(), ..symmetry });
            }
            (None, None) => (complete, unwritten) = (false, unwritten + usize::from(!generic)),
        }
    }
    for (xi, eta) in other_gauge {
        // of a boost only the gauge term has the masses
        let Some(named) = named.as_ref().filter(|_| !is_over()) else {
            (complete, unfinished) = (false, unfinished + 1);
            continue;
        };
        let change = named.change(&mut equations.pool, xi, &eta);
        let gauge = equations.gauge(change, Expr::ZERO).function;
        let symmetry = gauge.map(|f| named.symmetry(&mut equations.pool, xi, eta, f));
        found.extend(symmetry.filter(|symmetry| symmetry.proved));
    }
    let pool = &mut equations.pool;
    complete &= found.iter().all(|s| s.proved);
    found.sort_by_key(|s| {
        let rest = s.coordinates.iter().chain([&s.time, &s.gauge]);
        rest.map(|&e| pool.weight(e)).sum::<u64>()
    });
    let shown = if generic {
        generators_of(pool, symbolic, time, &problem.law.positions, &problem.law.velocities)
    } else {
        problem.generators.clone()
    };
    let searched = words(pool, &shown, problem.degree);
    let searched = format!("changes of time and coordinates, and gauge terms, that are {searched}");
    for symmetry in &mut found {
        symmetry.between_impulses = is_changed_by_impulse(equations, model, symmetry.conserved);
    }
    Ok(Symmetries { found, searched, complete, unwritten, unfinished })
}

/// The condition on the coefficients of ξ, η and f.
struct NoetherProblem {
    law: VariedLagrangian,
    /// What ξ, η and f are polynomials in.
    generators: Vec<Expr>,
    /// The degree of the highest monomial.
    degree: u32,
    conditions: DeterminingEquations,
    /// Whether points are more general than the motion, so that a symmetry may have been missed.
    overgeneral: bool,
}

impl NoetherProblem {
    fn of(pool: &mut Pool, law: VariedLagrangian) -> NoetherProblem {
        let VariedLagrangian { time, positions, velocities, lagrangian, .. } = &law;
        let generators = generators_of(pool, *lagrangian, *time, positions, velocities);
        let (degree, monomials) = products(pool, &generators, DEGREE, MOST / (positions.len() + 2));
        let conditions = DeterminingEquations::of(monomials, positions.len() + 2);
        NoetherProblem { law, generators, degree, conditions, overgeneral: false }
    }

    /// The solutions modulo a prime, without those that are gauge alone, as sparse as they come.
    fn solve(
        &mut self,
        pool: &mut Pool,
        is_over: &dyn Fn() -> bool,
    ) -> Result<Vec<Vec<Residue>>, Unsupported> {
        let mut roots = self.conditions.monomials.clone();
        roots.extend([self.law.lagrangian, self.law.slopes.0]);
        roots.extend(self.law.slopes.1.iter().chain(&self.law.slopes.2));
        let moving: Vec<Symbol> = self
            .law
            .positions
            .iter()
            .chain(&self.law.velocities)
            .chain([&self.law.time])
            .copied()
            .collect();
        let evaluator = ResidueEvaluator::new(pool, &roots, &moving)?;
        self.overgeneral = evaluator.overgeneral;
        let why = "no search was made: at none of the points that were tried has the Lagrangian an exact value";
        let has_values = |field, random: &mut Random| self.row(&evaluator, field, random).is_some();
        self.conditions.field = DeterminingEquations::field_where(has_values, why)?;
        // f = 1 is no symmetry
        let constant = self.conditions.width() - self.conditions.monomials.len();
        let mut draw = |random: &mut Random| self.row(&evaluator, self.conditions.field, random);
        let mut solutions = self.conditions.solutions(&mut draw, 0, &[constant], is_over)?;
        let mut chosen = Echelon::new(self.conditions.field, self.conditions.width());
        solutions.retain(|vector| chosen.add(vector.clone()));
        Ok(solutions)
    }

    /// The monomials' values at a random point, and the condition there for each unknown coefficient: of ξ, of each η,
    /// of f.
    fn row(
        &self,
        evaluator: &ResidueEvaluator,
        field: PrimeField,
        random: &mut Random,
    ) -> Option<SampledConditions> {
        let mut state: FxHashMap<Symbol, Residue> = FxHashMap::default();
        let moving = self.law.positions.iter().chain(&self.law.velocities).chain([&self.law.time]);
        evaluator.draw(field, random, moving.copied(), &mut state);
        let point = evaluator.point(field, random, 7, &|s| state.get(&s).copied())?;
        let velocity = |s: Symbol| {
            let k = self.law.positions.iter().position(|&q| q == s);
            k.map(|k| state[&self.law.velocities[k]])
        };
        let seed = |s: Symbol| {
            if s == self.law.time { field.one() } else { velocity(s).unwrap_or_default() }
        };
        let rates = evaluator.rates(&point, &seed)?;
        let value = |e: Expr| evaluator.value(&point, e);
        let (by_time, by_position, by_velocity) = &self.law.slopes;
        let mut momentum = Residue::ZERO;
        for (k, &p) in by_velocity.iter().enumerate() {
            momentum = field.add(momentum, field.mul(state[&self.law.velocities[k]], value(p)));
        }
        // L − Σ q̇ p
        let rest = field.sub(value(self.law.lagrangian), momentum);
        let values: Vec<Residue> = self.conditions.monomials.iter().map(|&e| value(e)).collect();
        let moved: Vec<Residue> =
            self.conditions.monomials.iter().map(|&e| evaluator.rate(&rates, e)).collect();
        let mut row = Vec::new();
        let term = |a: Residue, b: Residue| {
            values
                .iter()
                .zip(&moved)
                .map(move |(&m, &d)| field.add(field.mul(m, a), field.mul(d, b)))
        };
        row.extend(term(value(*by_time), rest));
        for (&q, &p) in by_position.iter().zip(by_velocity) {
            row.extend(term(value(q), value(p)));
        }
        row.extend(moved.iter().map(|&d| field.neg(d)));
        Some(SampledConditions { values, rows: vec![row] })
    }

    /// ξ, η and f of a solution with rational coefficients.
    fn exact(&self, pool: &mut Pool, vector: &[Residue]) -> Option<(Expr, Vec<Expr>, Expr)> {
        let n = self.law.positions.len();
        // f may need a denominator that the changes do not have
        let all = self.conditions.functions_of(pool, vector, n + 1)?;
        Some((all[0], all[1..=n].to_vec(), all[n + 1]))
    }
}

/// What was searched: polynomials of a degree in these functions.
pub(super) fn words(pool: &Pool, generators: &[Expr], degree: u32) -> String {
    let all: Vec<String> = generators.iter().map(|&e| pool.text(e)).collect();
    format!("polynomials of degree up to {degree} in {}", all.join(", "))
}
