//! The Hamiltonian in new variables: K = H + ∂F/∂t, or c H + R for a map of valence c that is
//! given explicitly, with ∂(Q, P)/∂t = 𝕁 ∂R/∂(Q, P).
//!
//! In: a map that is canonical up to its valence. Out: K(Q, P, t), or why it cannot be written
//! down. Never here: whether the map is canonical.
//! Source: *The Principles of Dynamics*, §§ 3.2, 3.3.

use std::collections::HashMap;

use super::canonical::{PhaseMap, free_of};
use super::canonical_verdict::CanonicalVerdict;
use super::collected::collected;
use super::equations::{CLOSED_FORM_LIMIT, Equations, NoClosedForm};
use super::group::phase_maps;
use super::isolate::Solution;
use super::slope::with_common_roots;
use super::valuation::Valuation;
use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::model::{Model, TransformationLaw};
use crate::num::Number;

/// The greatest degree in the old variables of what follows from an explicit map with time.
const HIGHEST: i64 = 12;

/// The points at which what was found without solving must agree with H + ∂F/∂t, and how closely.
const POINTS: usize = 20;
const SAME: f64 = 1e-9;

impl PhaseMap {
    /// K as a function of the new variables and t.
    ///
    /// # Errors
    /// Returns an error if the map is not canonical up to a valence, H has no closed form, or the
    /// old variables cannot be eliminated.
    pub fn new_hamiltonian(
        &self,
        model: &Model,
        equations: &mut Equations,
        verdict: &CanonicalVerdict,
        backwards: Option<&Solution>,
    ) -> Result<Expr, NoClosedForm> {
        if !verdict.canonical && verdict.valence.is_none() {
            return Err(NoClosedForm("the transformation is not canonical".to_owned()));
        }
        let hamiltonian = equations.hamiltonian().clone()?;
        let found = self.transformed(model, equations, (hamiltonian, verdict), backwards);
        // by one part after the other less is to be eliminated at once
        match (self.hamiltonian_by_parts(model, equations, hamiltonian), found) {
            (Some(parts), Ok(e)) if equations.pool.weight(e) <= equations.pool.weight(parts) => {
                Ok(e)
            }
            (Some(parts), _) => Ok(parts),
            (None, found) => found,
        }
    }

    /// K of a map that is made of others, as the new Hamiltonian of each of them in turn, where the values agree.
    fn hamiltonian_by_parts(
        &self,
        model: &Model,
        equations: &mut Equations,
        hamiltonian: Expr,
    ) -> Option<Expr> {
        let own = model.transformations.iter().find(|given| given.name == self.name)?;
        let TransformationLaw::Composition(parts) = &own.law else { return None };
        let maps = phase_maps(model, equations);
        let parts: Vec<&PhaseMap> = parts
            .iter()
            .map(|&k| maps.iter().find(|map| map.name == model.transformations[k].name))
            .collect::<Option<_>>()?;
        let renamed = |pool: &mut Pool, e: Expr, from: &[Symbol], to: &[Symbol]| {
            let pairs = from.iter().zip(to);
            let map = pairs.map(|(&from, &to)| (from, pool.variable(to))).collect();
            pool.substitute(e, &map)
        };
        let points: Vec<Valuation> =
            (0..POINTS as u64).map(|n| Valuation::near_start(model, equations, n)).collect();
        // the value of the new Hamiltonian, and the size of its terms
        let mut values: Vec<Option<(Valuation, [f64; 2])>> = points
            .iter()
            .map(|at| Some((at.clone(), sized(&equations.pool, hamiltonian, at))))
            .collect();
        let mut e = hamiltonian;
        for map in parts {
            let verdict = map.verdict(model, equations);
            let backwards = map.backwards(model, equations)?;
            e = map.transformed(model, equations, (e, &verdict), Some(&backwards)).ok()?;
            let pool = &mut equations.pool;
            e = renamed(pool, e, &map.implicit.new, &map.old);
            let rate = match map.function_rate {
                Some(rate) => rate,
                None => map.rate_of_explicit(pool, model.symbols.time).ok()?,
            };
            let valence = verdict.valence.unwrap_or(Expr::ONE);
            for known in &mut values {
                *known = known.take().and_then(|(at, [value, size])| {
                    let image = map.image(pool, &at)?;
                    let valence = at.value(pool, valence);
                    let [own, own_size] = sized(pool, rate, &image);
                    let value = [valence * value + own, valence.abs() * size + own_size];
                    let new = map.implicit.new.iter().map(|&s| image.at(s));
                    let next = map.old.iter().copied().zip(new).collect::<Vec<_>>();
                    Some((at.with(next), value))
                });
            }
        }
        let pool = &mut equations.pool;
        let known = values.iter().flatten().map(|(at, value)| (sized(pool, e, at), *value));
        let known: Vec<_> = known.filter(|(found, _)| found[0].is_finite()).collect();
        let agrees = |&([found, its], [value, size]): &([f64; 2], [f64; 2])| {
            (found - value).abs() <= SAME * size.max(its)
        };
        let agrees = !known.is_empty() && known.iter().all(agrees);
        agrees.then(|| renamed(pool, e, &self.old, &self.implicit.new))
    }

    /// A Hamiltonian of the old variables as a function of the new ones and t.
    fn transformed(
        &self,
        model: &Model,
        equations: &mut Equations,
        (hamiltonian, verdict): (Expr, &CanonicalVerdict),
        backwards: Option<&Solution>,
    ) -> Result<Expr, NoClosedForm> {
        let no = |why: &str| Err(NoClosedForm(why.to_owned()));
        if !verdict.canonical && verdict.valence.is_none() {
            return no("the transformation is not canonical");
        }
        let time = model.symbols.time;
        let pool = &mut equations.pool;
        let rate = match self.function_rate {
            Some(rate) => rate,
            None if self.parts.is_empty() => self.rate_of_explicit(pool, time)?,
            None => return no("∂F/∂t of one of its parts is not known"),
        };
        let valence = verdict.valence.unwrap_or(Expr::ONE);
        let scaled = pool.mul(valence, hamiltonian);
        let e = pool.add(scaled, rate);
        let e = match backwards {
            Some(backwards) => free_of(pool, e, backwards, &self.old)
                .ok_or("the old variables cannot be eliminated"),
            None => Err("no expression of the old variables in terms of the new ones was found"),
        };
        let e = match e {
            Ok(e) => e,
            Err(why) => match self.separated(model, equations, hamiltonian) {
                Some(known) => return Ok(known),
                None => return no(why),
            },
        };
        let pool = &mut equations.pool;
        let e = pool.simplify_terms(e);
        let e = collected(pool, e, &self.implicit.new);
        if pool.weight(e) > CLOSED_FORM_LIMIT {
            return Err(NoClosedForm(format!("K has more than {CLOSED_FORM_LIMIT} nodes")));
        }
        Ok(e)
    }

    /// K as a function of the old variables and t, which needs no inverse: c H + R of a map that is given explicitly, H + ∂F/∂t
    /// of another where no new variable is in ∂F/∂t.
    pub fn hamiltonian_in_old(
        &self,
        model: &Model,
        equations: &mut Equations,
        verdict: &CanonicalVerdict,
    ) -> Option<Expr> {
        let known = verdict.canonical || verdict.valence.is_some();
        let hamiltonian = equations.hamiltonian().clone().ok().filter(|_| known)?;
        let pool = &mut equations.pool;
        let rate = match self.function_rate {
            Some(rate) => Some(rate).filter(|&rate| !pool.depends_on_any(rate, &self.implicit.new)),
            None if self.parts.is_empty() => self.rate_of_explicit(pool, model.symbols.time).ok(),
            None => None,
        }?;
        let scaled = pool.mul(verdict.valence.unwrap_or(Expr::ONE), hamiltonian);
        let e = pool.add(scaled, rate);
        let e = pool.simplify_terms(e);
        (pool.weight(e) <= CLOSED_FORM_LIMIT).then_some(e)
    }

    /// K as H(q, ∂F/∂q, t) + ∂F/∂t where the old variables drop out of it, as they do where F is found by Hamilton and Jacobi:
    /// then nothing has to be solved for.
    fn separated(
        &self,
        model: &Model,
        equations: &mut Equations,
        hamiltonian: Expr,
    ) -> Option<Expr> {
        let rate = self.function_rate.filter(|_| self.parts.is_empty())?;
        let images = self.images(model, equations, POINTS);
        let pool = &mut equations.pool;
        let slopes = self.implicit.relations.iter().zip(&self.implicit.own);
        let mut map = HashMap::new();
        // every other relation gives an old variable as a slope of F
        for (&relation, &own) in slopes.step_by(2) {
            let rest = pool.substitute(relation, &HashMap::from([(own, Expr::ZERO)]));
            map.insert(own, pool.neg(rest));
        }
        let law = pool.add(hamiltonian, rate);
        let mixed = pool.substitute(law, &map);
        let mixed = pool.open_quotients(mixed);
        let rest: Vec<Symbol> =
            self.old.iter().copied().filter(|old| !map.contains_key(old)).collect();
        for &old in &rest {
            let slope = pool.derivative(mixed, old);
            // without a proof the values below decide, at points of different q
            if pool.is_zero(slope) == Zero::No {
                return None;
            }
        }
        // what does not depend on them is what it is where they are zero
        let zero: HashMap<Symbol, Expr> = rest.iter().map(|&old| (old, Expr::ZERO)).collect();
        let mut there = zero.clone();
        for (own, slope) in map {
            let slope = pool.substitute(slope, &zero);
            there.insert(own, with_common_roots(pool, slope));
        }
        let free = pool.substitute(law, &there);
        let free = pool.simplify(free);
        let agrees = |at: &Valuation| {
            let ([found, its], [expected, size]) = (sized(pool, free, at), sized(pool, law, at));
            (found - expected).abs() <= SAME * size.max(its)
        };
        let known = !images.is_empty() && images.iter().all(agrees);
        (known && !pool.depends_on_any(free, &self.old)).then_some(free)
    }

    /// R(q, p, t): its slopes by the old variables are w = Σ (∂Q_i/∂t ∂P_i − ∂P_i/∂t ∂Q_i), and
    /// R = ∫₀¹ w(s η)·η ds, which is written down where w is a polynomial.
    pub(super) fn rate_of_explicit(
        &self,
        pool: &mut Pool,
        time: Symbol,
    ) -> Result<Expr, NoClosedForm> {
        let n = self.implicit.new.len() / 2;
        // the relations are Q − Q(q, p, t)
        let rates: Vec<Expr> =
            self.implicit.relations.iter().map(|&e| pool.derivative(e, time)).collect();
        if rates.iter().all(|&rate| rate == Expr::ZERO) {
            return Ok(Expr::ZERO);
        }
        let mut slopes = Vec::new();
        for k in 0..2 * n {
            let mut terms = Vec::new();
            for i in 0..n {
                let by_momentum = pool.derivative(self.implicit.relations[n + i], self.old[k]);
                let by_position = pool.derivative(self.implicit.relations[i], self.old[k]);
                terms.push((Number::ONE, pool.mul(rates[i], by_momentum)));
                terms.push((Number::MINUS_ONE, pool.mul(rates[n + i], by_position)));
            }
            let slope = pool.linear(Number::ZERO, &terms);
            slopes.push(pool.simplify(slope));
        }
        let s = pool.symbol("part of the way");
        let scale = pool.variable(s);
        let mut terms = Vec::new();
        for (&slope, &variable) in slopes.iter().zip(&self.old) {
            let variable = pool.variable(variable);
            terms.push((Number::ONE, pool.mul(slope, variable)));
        }
        let along = pool.linear(Number::ZERO, &terms);
        let mut map = HashMap::new();
        for &variable in &self.old {
            let value = pool.variable(variable);
            map.insert(variable, pool.mul(scale, value));
        }
        // w(s η)·η s, divided by s again below
        let mut rest = pool.substitute(along, &map);
        let at_zero = HashMap::from([(s, Expr::ZERO)]);
        let mut parts = Vec::new();
        let mut factorial = Number::ONE;
        for degree in 1..=HIGHEST {
            rest = pool.derivative(rest, s);
            rest = pool.simplify(rest);
            if rest == Expr::ZERO || pool.is_zero(rest) == Zero::Proved {
                let total = pool.linear(Number::ZERO, &parts);
                let total = pool.simplify(total);
                // what does not change along a ray from the origin is not in the integral
                for (&slope, &variable) in slopes.iter().zip(&self.old) {
                    let own = pool.derivative(total, variable);
                    let difference = pool.sub(own, slope);
                    if pool.is_zero(difference) == Zero::No {
                        return Err(NoClosedForm(
                            "∂(Q, P)/∂t is that of a function which is not regular at the origin, and is not searched for"
                                .to_owned(),
                        ));
                    }
                }
                return Ok(total);
            }
            factorial = factorial * Number::integer(degree);
            let coefficient = pool.substitute(rest, &at_zero);
            let weight = (factorial * Number::integer(degree)).recip();
            parts.push((weight, coefficient));
        }
        Err(NoClosedForm(
            "∂(Q, P)/∂t is not a polynomial in q and p, and its integral is not searched for"
                .to_owned(),
        ))
    }
}

/// The value of an expression at a point, and the size of its terms.
fn sized(pool: &Pool, e: Expr, at: &Valuation) -> [f64; 2] {
    let (value, size) = pool.evaluate_with_size(e, &|symbol| at.at(symbol));
    [value, size]
}
