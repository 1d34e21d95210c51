//! The search for constants of the motion: ansätze of growing degree, within limits.
//!
//! In: a model and its equations, limits. Out: [`Invariants`]: what is found, how far it is proved, and word for word
//! what was searched. Never here: clocks; the caller says when time is over.
//! Source: J. Hietarinta, *Direct methods for the search of the second invariant*, Physics Reports 147 (1987) 87.

use std::collections::HashMap;

use rustc_hash::FxHashMap;

use super::ansatz::Ansatz;
use super::atoms::Atoms;
use super::coefficients::{Lift, rationals};
use super::evaluator::ResidueEvaluator;
use super::formula::{cleared, combination, words};
use super::invariants::{Constant, EXHAUSTED, Invariants, Limits, Proof, Searched};
use super::known::{self, KnownConstant, products};
use super::law::Law;
use super::level::{self, Broken, Ground};
use super::quadratic::with_root;
use super::ramps;
use super::random::Random;
use super::scope::{SearchScope, constants_of};
use super::stand_in;
use super::units::Unsupported;
use super::vanishing::vanishes;
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{Class, Equations, class_of, is_changed_by_impulse};
use crate::model::Model;
use crate::num::{PRIMES, PrimeField, Residue};

/// The largest number of monomials in an ansatz, so that its matrix stays below 20 MB.
pub const SIZE_LIMIT: usize = 1_500;

/// The degree up to which is searched where none is given.
const DEGREE: u32 = 6;

/// What determines the values of functions of constants.
const SEED: u64 = 7;

/// The largest number of products of known constants that are compared with what is found.
const MOST_PRODUCTS: usize = 600;

/// Searches for the constants of the motion that do not contain the time.
///
/// # Errors
/// Returns an error if the law has a function that cannot be evaluated modulo a prime, such as one with a kink.
pub fn invariants(
    model: &Model,
    equations: &mut Equations,
    limits: &Limits<'_>,
) -> Result<Invariants, Unsupported> {
    let mut search = Search::of(model, equations, limits)?;
    let mut answer = Invariants {
        driven: search.law.is_driven(&equations.pool),
        known: search.known.clone(),
        ..Invariants::default()
    };
    let outcome = search.levels(model, equations, &mut answer);
    match outcome {
        Ok(()) => {}
        Err(Broken::Over) => {
            answer.ended.get_or_insert_with(|| "the time allowed ran out".to_owned());
        }
        Err(Broken::NoPoint) => {
            let why = "at none of the points that were tried has everything an exact value";
            answer.ended = Some(why.to_owned());
            answer.none_up_to = None;
        }
    }
    search.judge(equations, &mut answer);
    for constant in &mut answer.found {
        constant.between_impulses = is_changed_by_impulse(equations, model, constant.expression);
    }
    Ok(answer)
}

struct Search<'a> {
    limits: &'a Limits<'a>,
    /// The law with symbols, and with the parameters' values put in.
    symbolic: Law,
    law: Law,
    values: HashMap<Symbol, Expr>,
    /// Whether some of these are stand-ins.
    generic: bool,
    parameters: Vec<Symbol>,
    scope: SearchScope,
    known: Vec<KnownConstant>,
    field: PrimeField,
    random: Random,
}

/// What has come of a null vector modulo a prime.
enum NullVector {
    Constant(Constant),
    /// It belongs to the stand-ins of numbers, and perhaps not to these.
    OfStandIns,
    /// Its coefficients are no short fractions.
    NotExact,
}

impl<'a> Search<'a> {
    fn of(
        model: &Model,
        equations: &mut Equations,
        limits: &'a Limits<'a>,
    ) -> Result<Search<'a>, Unsupported> {
        ramps::refuse(model)?;
        let symbolic = Law::of(model, equations);
        let constants = stand_in::constants(model, equations);
        let generic = stand_in::has_stand_ins(model, equations);
        let pool = &mut equations.pool;
        let values: HashMap<Symbol, Expr> =
            constants.iter().map(|&(s, n)| (s, pool.number(n))).collect();
        let law = symbolic.substituted(pool, &values);
        if pool.is_full() {
            return Err(Unsupported("the equations are too large".to_owned()));
        }
        let evaluator = ResidueEvaluator::new(pool, &law.expressions(), &law.moving())?;
        for e in symbolic.expressions() {
            if equations.has_kink_on_constraints(e) {
                let why =
                    "no search is made through a root that may have a kink on the constraints";
                return Err(Unsupported(why.to_owned()));
            }
        }
        let known = known::of(equations, &law, &values);
        let scope = SearchScope::of(model, law.clone());
        let mut random = Random::new(1);
        let mut works = |n: &usize| {
            let field = PrimeField::nth(*n);
            let none = FxHashMap::default();
            (0..40).any(|_| law.draw(&evaluator, field, &mut random, &none, SEED).is_some())
        };
        let field = (0..PRIMES.len()).find(|n| works(n)).map(PrimeField::nth);
        let Some(field) = field else {
            let why = "no search was made: at none of the points that were tried has the law, with its constraints, an exact value";
            return Err(Unsupported(why.to_owned()));
        };
        let parameters = constants.iter().map(|(s, _)| *s).collect();
        Ok(Search {
            limits,
            symbolic,
            law,
            values,
            generic,
            parameters,
            scope,
            known,
            field,
            random,
        })
    }

    /// Goes through the ansätze, by degree.
    fn levels(
        &mut self,
        model: &Model,
        equations: &mut Equations,
        answer: &mut Invariants,
    ) -> Result<(), Broken> {
        let families = self.scope.families(model, &equations.pool);
        let mut unbroken = true;
        for degree in 1..=self.limits.degree.unwrap_or(DEGREE) {
            for (i, &family) in families.iter().enumerate() {
                let atoms = Atoms::of(&mut equations.pool, &self.law, &self.scope.angles, family);
                let (mut complete, mut related) = (false, false);
                for extra in self.scope.extras(degree) {
                    let bounds = self.scope.bounds(&mut equations.pool, &atoms, degree, extra);
                    let Some(ansatz) = Ansatz::new(&atoms, bounds, SIZE_LIMIT) else { continue };
                    let (size, overgeneral) =
                        self.level(model, equations, answer, &atoms, &ansatz)?;
                    (complete, related) = (true, overgeneral);
                    answer.searched.retain(|s| (s.degree, s.standard) != (degree, i == 0) || i > 0);
                    let shown = self.shown(&mut equations.pool, &atoms);
                    let pool = &equations.pool;
                    let words =
                        |print: &dyn Fn(Expr) -> String| words(&self.law, &shown, &ansatz, print);
                    let (family, shown) = (words(&|e| pool.text(e)), words(&|e| pool.unicode(e)));
                    answer.searched.push(Searched {
                        degree,
                        family,
                        shown,
                        size,
                        standard: i == 0,
                    });
                    if self.is_exhausted(equations, answer) {
                        answer.ended = Some(EXHAUSTED.to_owned());
                        return Ok(());
                    }
                }
                if i == 0 {
                    unbroken &= complete && !related && !self.generic;
                    if unbroken {
                        answer.none_up_to = Some(degree);
                    }
                    if !complete {
                        let why = format!(
                            "an ansatz of degree {degree} has more than {SIZE_LIMIT} monomials"
                        );
                        answer.ended = Some(why);
                        return Ok(());
                    }
                }
            }
        }
        Ok(())
    }

    /// The generators as they are shown: with the parameters' names where their values are stand-ins.
    fn shown(&self, pool: &mut Pool, atoms: &Atoms) -> Atoms {
        if self.generic {
            let named = Atoms::of(pool, &self.symbolic, &self.scope.angles, atoms.family);
            if named.coefficients.len() == atoms.coefficients.len() {
                return named;
            }
        }
        atoms.clone()
    }

    fn highest_degree(&self, ansatz: &Ansatz) -> u32 {
        let degree = ansatz.bounds.iter().map(|&(k, _)| k).max().unwrap_or(0);
        if self.law.positions == 0 { ansatz.bounds[0].1 } else { degree }
    }

    /// One ansatz: what is new in it is made exact, proved, and added.
    fn level(
        &mut self,
        model: &Model,
        equations: &mut Equations,
        answer: &mut Invariants,
        atoms: &Atoms,
        ansatz: &Ansatz,
    ) -> Result<(usize, bool), Broken> {
        let known: Vec<(Expr, u32)> = answer
            .known
            .iter()
            .map(|k| (k.here, if k.is_polynomial { k.degree } else { 0 }))
            .chain(answer.found.iter().map(|c| (c.here, c.degree)))
            .collect();
        let functions: Vec<Expr> = known.iter().map(|(e, _)| *e).collect();
        let degrees: Vec<u32> = known.iter().map(|(_, d)| *d).collect();
        let mut products = products(&degrees, self.highest_degree(ansatz), MOST_PRODUCTS);
        products.push(Vec::new());
        let mut roots = self.law.expressions();
        roots.extend(&functions);
        roots.extend(&atoms.momenta);
        roots.extend(atoms.coefficients.iter().map(|g| g.expression));
        let Ok(evaluator) = ResidueEvaluator::new(&mut equations.pool, &roots, &self.law.moving())
        else {
            return Err(Broken::NoPoint);
        };
        let law = self.law.clone();
        let ground = Ground {
            law: &law,
            evaluator: &evaluator,
            field: self.field,
            constants: FxHashMap::default(),
            seed: SEED,
            is_over: self.limits.is_over,
        };
        let random = &mut self.random;
        let level = level::search(&ground, atoms, ansatz, &functions, &products, random)?;
        for vector in level.new {
            let shape = (atoms, ansatz);
            match self.constant(model, equations, &ground, shape, &vector) {
                NullVector::Constant(constant) => answer.found.push(constant),
                // it need not be one for the values that the stand-ins are for
                NullVector::OfStandIns => {}
                NullVector::NotExact => {
                    answer.ended = Some(
                        "a constant of the motion has coefficients that are not short fractions"
                            .to_owned(),
                    );
                    return Err(Broken::Over);
                }
            }
        }
        Ok((level.size, evaluator.overgeneral))
    }

    /// The constant whose coefficients are a null vector modulo a prime.
    fn constant(
        &mut self,
        model: &Model,
        equations: &mut Equations,
        ground: &Ground<'_>,
        (atoms, ansatz): (&Atoms, &Ansatz),
        vector: &[(usize, Residue)],
    ) -> NullVector {
        let shape = (atoms, ansatz);
        let exact = rationals(ground, shape, vector, &mut self.random);
        let pool = &mut equations.pool;
        let exact: Option<Vec<Expr>> = match exact {
            Some(all) => Some(all.into_iter().map(|n| pool.number(n)).collect()),
            None => with_root(pool, ground, shape, vector, &mut self.random),
        };
        let columns: Vec<usize> = vector.iter().map(|(c, _)| *c).collect();
        let degree = if self.law.positions == 0 {
            ansatz.total(&columns)
        } else {
            let degrees = columns.iter().map(|&c| ansatz.degree(c));
            degrees.max().unwrap_or_else(|| self.highest_degree(ansatz))
        };
        let named = self.named(model, equations, shape, &columns);
        let here = exact.map(|exact| {
            let pool = &mut equations.pool;
            let exact = cleared(pool, &exact);
            combination(pool, atoms, ansatz, &columns, &exact)
        });
        let (expression, here, proof) = match (named, here) {
            (Some(named), _) => {
                (named, equations.pool.substitute(named, &self.values), Proof::Proved)
            }
            (None, Some(_)) if self.generic => return NullVector::OfStandIns,
            (None, Some(here)) => (here, here, self.proof_here(model, equations, here)),
            (None, None) => return NullVector::NotExact,
        };
        let (independent, between_impulses) = (false, false);
        NullVector::Constant(Constant {
            expression,
            degree,
            proof,
            independent,
            between_impulses,
            here,
        })
    }

    /// The same constant with the parameters' names, if it is one for all their values.
    fn named(
        &mut self,
        model: &Model,
        equations: &mut Equations,
        (numeric, ansatz): (&Atoms, &Ansatz),
        columns: &[usize],
    ) -> Option<Expr> {
        let pool = &mut equations.pool;
        let used = self.symbolic.expressions();
        let parameters: Vec<Symbol> = self
            .parameters
            .iter()
            .copied()
            .filter(|&s| used.iter().any(|&e| pool.depends(e, s)))
            .collect();
        let constants = constants_of(pool, &self.symbolic, &parameters);
        let atoms = Atoms::of(pool, &self.symbolic, &self.scope.angles, numeric.family);
        if atoms.coefficients.len() != numeric.coefficients.len() {
            return None;
        }
        for (a, b) in atoms.coefficients.iter().zip(&numeric.coefficients) {
            if pool.substitute(a.expression, &self.values) != b.expression {
                return None;
            }
        }
        let mut roots = self.symbolic.expressions();
        roots.extend(&atoms.momenta);
        roots.extend(atoms.coefficients.iter().map(|g| g.expression));
        roots.extend(constants.iter().map(|(e, _)| *e));
        let evaluator = ResidueEvaluator::new(pool, &roots, &self.law.moving()).ok()?;
        let lift = Lift {
            law: &self.symbolic,
            evaluator: &evaluator,
            atoms: &atoms,
            ansatz,
            columns: columns.to_vec(),
            parameters: &parameters,
            constants: &constants,
            is_over: self.limits.is_over,
        };
        let coefficients = lift.coefficients(pool, self.field, &mut self.random)?;
        let expression = combination(pool, &atoms, ansatz, columns, &coefficients);
        let positions = &self.law.variables[..self.law.positions];
        let proved = match self.symbolic.rate(pool, expression) {
            Some(rate) => vanishes(pool, positions, rate),
            None => class_of(model, equations, "", expression).class == Class::Proved,
        };
        proved.then_some(expression)
    }

    /// The proof of a constant for the current values of the parameters.
    fn proof_here(&self, model: &Model, equations: &mut Equations, here: Expr) -> Proof {
        let positions = &self.law.variables[..self.law.positions];
        let proved = match self.law.rate(&mut equations.pool, here) {
            Some(rate) => vanishes(&mut equations.pool, positions, rate),
            None => match class_of(model, equations, "", here).class {
                Class::Proved => return Proof::Proved,
                class => class == Class::AtTheseParameters,
            },
        };
        let with_parameters = self.symbolic.expressions() != self.law.expressions();
        match (proved, with_parameters) {
            (true, true) => Proof::AtTheseParameters,
            (true, false) => Proof::Proved,
            (false, _) => Proof::Unproved,
        }
    }

    /// Fills in which constants are independent, and the dimension.
    fn judge(&mut self, equations: &mut Equations, answer: &mut Invariants) {
        let functions: Vec<Expr> = answer
            .known
            .iter()
            .map(|k| k.here)
            .chain(answer.found.iter().map(|c| c.here))
            .collect();
        let mut roots = self.law.expressions();
        roots.extend(&functions);
        for &s in &self.law.variables {
            roots.push(equations.pool.variable(s));
        }
        let Ok(evaluator) = ResidueEvaluator::new(&mut equations.pool, &roots, &self.law.moving())
        else {
            return;
        };
        let ground = Ground {
            law: &self.law,
            evaluator: &evaluator,
            field: self.field,
            constants: FxHashMap::default(),
            seed: SEED,
            is_over: &|| false,
        };
        let Ok(drawn) = ground.draw(&mut self.random) else { return };
        answer.dimension = self.law.dimension(&evaluator, &drawn.point);
        let Some(independent) = self.law.independent(&evaluator, &drawn.point, &functions) else {
            return;
        };
        let (known, found) = independent.split_at(answer.known.len());
        answer.known_independent = known.to_vec();
        for (constant, &independent) in answer.found.iter_mut().zip(found) {
            // rounded relations would make functions of others independent
            constant.independent = independent && !evaluator.inexact;
        }
    }

    /// Whether as many independent constants are there as an autonomous motion can have.
    fn is_exhausted(&mut self, equations: &mut Equations, answer: &mut Invariants) -> bool {
        self.judge(equations, answer);
        !answer.driven && answer.dimension > 0 && answer.independent() + 1 >= answer.dimension
    }
}
