//! Constants of the motion that complete a set in involution, made of those that are known and found.
//!
//! In: constants with their brackets, and a set of them that commute. Out: polynomials of the second degree in the
//! constants, with rational coefficients, that commute with the set and are independent of it, each proved. A central
//! force has L_x, L_y and L_z, of which no two commute: L_z and L_x² + L_y² do. Never here: the search for constants.
//!
//! \[Σ c m, G\] = 0 for monomials m of the constants is linear in c: rows are random points modulo a prime, where the
//! bracket of two monomials follows from those of their factors by Leibniz' rule. What the null space says is a guess
//! until the bracket is proved to vanish.

use std::collections::HashMap;

use rustc_hash::FxHashMap;

use super::ansatz::orders;
use super::echelon::{Echelon, reduced};
use super::evaluator::ResidueEvaluator;
use super::law::Law;
use super::random::Random;
use super::stand_in;
use super::vanishing::vanishes;
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::num::{Number, PRIMES, PrimeField, Residue};

const MOST_MONOMIALS: usize = 150;

/// The number of combinations that are tried.
const MOST_TRIED: usize = 40;

/// The number of orders of monomials in which short combinations are searched for.
const ORDERS: usize = 6;

/// Rows beyond the rank that have to add nothing.
const SPARE: usize = 8;

/// The number of points drawn in vain before the search is given up.
const TRIES: usize = 400;

/// Bits by which a fraction has to be smaller than one by chance.
const SPARE_BITS: u32 = 24;

/// What determines the values of functions of constants.
const SEED: u64 = 11;

/// A polynomial in constants of the motion: coefficients, and the indices of the factors.
type ConstantPolynomial = Vec<(Number, Vec<usize>)>;

/// A constant of the motion made of others, that commutes with a set.
#[derive(Clone, Debug)]
pub struct Commuting {
    /// As a function of the state, with the parameters' names.
    pub expression: Expr,
    /// Its coefficients, and the indices of the constants that are multiplied.
    pub terms: Vec<(Number, Vec<usize>)>,
    /// Whether it commutes for all values of the parameters, and not only for the current ones.
    pub for_all_parameters: bool,
}

impl Commuting {
    /// The polynomial with the names of the constants: `I1^2 + I2^2`.
    pub(super) fn in_names(&self, names: &[String]) -> String {
        let mut text = String::new();
        for (k, (c, factors)) in self.terms.iter().enumerate() {
            let negative = *c < Number::ZERO;
            text.push_str(match (k, negative) {
                (0, false) => "",
                (0, true) => "-",
                (_, false) => " + ",
                (_, true) => " - ",
            });
            let size = if negative { -*c } else { *c };
            match size {
                Number::Rational(1, 1) => {}
                Number::Rational(n, 1) => text.push_str(&format!("{n}*")),
                Number::Rational(n, d) => text.push_str(&format!("{n}/{d}*")),
                Number::Real(x) => text.push_str(&format!("{x}*")),
            }
            let name = |i: usize| {
                let name = &names[i];
                if name.contains(' ') { format!("({name})") } else { name.clone() }
            };
            text.push_str(&match factors[..] {
                [i, j] if i == j => format!("{}^2", name(i)),
                [i, j] => format!("{}*{}", name(i), name(j)),
                _ => factors.iter().map(|&i| name(i)).collect::<Vec<_>>().join("*"),
            });
        }
        text
    }
}

/// Constants of the motion, as functions of the state, with the parameters' names and with their values put in.
pub(super) struct Given<'a> {
    pub(super) functions: &'a [(Expr, Expr)],
    pub(super) brackets: &'a [Vec<Option<Expr>>],
    pub(super) proved: &'a [bool],
}

/// Completes a set of commuting constants, given by their indices, to one of `wanted`, as far as that is possible.
pub(super) fn completed(
    model: &Model,
    equations: &mut Equations,
    given: &Given<'_>,
    chosen: &[usize],
    wanted: usize,
) -> Vec<Commuting> {
    if chosen.len() >= wanted {
        return Vec::new();
    }
    let mut found = Vec::new();
    let symbolic: Vec<Expr> = given.functions.iter().map(|(f, _)| *f).collect();
    let Some(mut work) = InvolutionSearch::of(model, equations, given, chosen) else {
        return found;
    };
    while work.set.len() < wanted {
        let Some(next) = work.next(&mut equations.pool) else { break };
        let for_all_parameters = work.set.iter().all(|member| {
            let (pool, positions) = (&mut equations.pool, work.positions());
            let bracket = bracket(pool, &next, member, &symbolic, &work.brackets);
            vanishes(pool, positions, bracket)
        });
        let expression = polynomial(&mut equations.pool, &next, &symbolic);
        found.push(Commuting { expression, terms: next.clone(), for_all_parameters });
        work.set.push(next);
    }
    found
}

struct InvolutionSearch {
    law: Law,
    field: PrimeField,
    random: Random,
    functions: Vec<Expr>,
    /// Brackets with the parameters' names, and with their values put in.
    brackets: Vec<Vec<Expr>>,
    here: Vec<Vec<Expr>>,
    /// The constants whose products are taken.
    usable: Vec<usize>,
    set: Vec<ConstantPolynomial>,
}

impl InvolutionSearch {
    fn of(
        model: &Model,
        equations: &mut Equations,
        given: &Given<'_>,
        chosen: &[usize],
    ) -> Option<InvolutionSearch> {
        let all: Vec<usize> = (0..given.functions.len()).collect();
        let has_brackets = |&i: &usize| all.iter().all(|&j| given.brackets[i][j].is_some());
        let usable: Vec<usize> =
            all.iter().copied().filter(|i| given.proved[*i] && has_brackets(i)).collect();
        if !chosen.iter().all(|i| usable.contains(i)) {
            return None;
        }
        let symbolic = Law::of(model, equations);
        let constants = stand_in::constants(model, equations);
        let pool = &mut equations.pool;
        let values: HashMap<Symbol, Expr> =
            constants.iter().map(|&(s, n)| (s, pool.number(n))).collect();
        let law = symbolic.substituted(pool, &values);
        let brackets: Vec<Vec<Expr>> = given
            .brackets
            .iter()
            .map(|row| row.iter().map(|e| e.unwrap_or(Expr::ZERO)).collect())
            .collect();
        let here: Vec<Vec<Expr>> = brackets
            .iter()
            .map(|row| row.iter().map(|&e| pool.substitute(e, &values)).collect())
            .collect();
        let functions: Vec<Expr> = given.functions.iter().map(|(_, here)| *here).collect();
        let mut random = Random::new(3);
        let evaluator =
            ResidueEvaluator::new(pool, &roots(&law, &functions, &here), &law.moving()).ok()?;
        let none = FxHashMap::default();
        let field = (0..PRIMES.len()).map(PrimeField::nth).find(|field| {
            (0..40).any(|_| law.draw(&evaluator, *field, &mut random, &none, SEED).is_some())
        })?;
        let set = chosen.iter().map(|&i| vec![(Number::ONE, vec![i])]).collect();
        Some(InvolutionSearch { law, field, random, functions, brackets, here, usable, set })
    }

    /// A constant that commutes with the set and is independent of it, with the parameters' values put in.
    fn next(&mut self, pool: &mut Pool) -> Option<ConstantPolynomial> {
        let monomials = self.monomials();
        let null = self.null_space(pool, &monomials)?;
        let mut candidates: Vec<ConstantPolynomial> = Vec::new();
        for order in orders(monomials.len(), ORDERS) {
            for row in reduced(self.field, &null, &order) {
                let terms = row.iter().zip(&monomials).filter(|(x, _)| !x.is_zero());
                let exact = terms.map(|(&x, monomial)| {
                    Some((self.field.fraction(x, SPARE_BITS)?, monomial.clone()))
                });
                let Some(candidate) = exact.collect::<Option<ConstantPolynomial>>() else {
                    continue;
                };
                if !candidates.contains(&candidate) {
                    candidates.push(candidate);
                }
            }
        }
        candidates
            .sort_by_key(|c| (c.len(), c.iter().map(|(_, factors)| factors.len()).sum::<usize>()));
        candidates.truncate(MOST_TRIED);
        candidates.into_iter().find(|candidate| {
            let positions = self.positions().to_vec();
            self.is_independent(pool, candidate)
                && self.set.iter().all(|member| {
                    let bracket = bracket(pool, candidate, member, &self.functions, &self.here);
                    vanishes(pool, &positions, bracket)
                })
        })
    }

    fn positions(&self) -> &[Symbol] {
        &self.law.variables[..self.law.positions]
    }

    /// The constants and their products in pairs.
    fn monomials(&self) -> Vec<Vec<usize>> {
        let mut all: Vec<Vec<usize>> = self.usable.iter().map(|&i| vec![i]).collect();
        for (k, &i) in self.usable.iter().enumerate() {
            all.extend(self.usable[k..].iter().map(|&j| vec![i, j]));
        }
        all.truncate(MOST_MONOMIALS);
        all
    }

    /// The combinations of monomials that commute with the set.
    fn null_space(
        &mut self,
        pool: &mut Pool,
        monomials: &[Vec<usize>],
    ) -> Option<Vec<Vec<Residue>>> {
        let roots = roots(&self.law, &self.functions, &self.here);
        let evaluator = ResidueEvaluator::new(pool, &roots, &self.law.moving()).ok()?;
        let field = self.field;
        let mut echelon = Echelon::new(field, monomials.len());
        let (mut idle, mut vain) = (0, 0);
        let none = FxHashMap::default();
        while idle < SPARE * self.set.len() && echelon.rank() < monomials.len() {
            let drawn = self.law.draw(&evaluator, field, &mut self.random, &none, SEED);
            let Some(drawn) = drawn else {
                vain += 1;
                if vain > TRIES {
                    return None;
                }
                continue;
            };
            let value = |e: &Expr| evaluator.value(&drawn.point, *e);
            let values: Vec<Residue> = self.functions.iter().map(value).collect();
            let brackets: Vec<Vec<Residue>> =
                self.here.iter().map(|row| row.iter().map(value).collect()).collect();
            for member in &self.set {
                let row = monomials.iter().map(|monomial| {
                    leibniz(monomial, member).into_iter().try_fold(
                        Residue::ZERO,
                        |sum, (c, i, j, rest)| {
                            let term = rest.iter().fold(
                                field.mul(field.number(c)?, brackets[i][j]),
                                |product, &k| field.mul(product, values[k]),
                            );
                            Some(field.add(sum, term))
                        },
                    )
                });
                let row = row.collect::<Option<Vec<_>>>()?;
                idle = if echelon.add(row) { 0 } else { idle + 1 };
            }
        }
        Some(echelon.null_space())
    }

    fn is_independent(&mut self, pool: &mut Pool, candidate: &ConstantPolynomial) -> bool {
        let members: Vec<ConstantPolynomial> =
            self.set.iter().chain([candidate]).cloned().collect();
        let members: Vec<Expr> =
            members.iter().map(|member| polynomial(pool, member, &self.functions)).collect();
        let mut roots = roots(&self.law, &members, &[]);
        roots.extend(self.law.variables.iter().map(|&s| pool.variable(s)));
        let Ok(evaluator) = ResidueEvaluator::new(pool, &roots, &self.law.moving()) else {
            return false;
        };
        let none = FxHashMap::default();
        let drawn = (0..TRIES)
            .find_map(|_| self.law.draw(&evaluator, self.field, &mut self.random, &none, SEED));
        let independent =
            drawn.and_then(|drawn| self.law.independent(&evaluator, &drawn.point, &members));
        independent.is_some_and(|all| all.last() == Some(&true))
    }
}

fn bracket(
    pool: &mut Pool,
    first: &ConstantPolynomial,
    second: &ConstantPolynomial,
    functions: &[Expr],
    brackets: &[Vec<Expr>],
) -> Expr {
    let mut terms = Vec::new();
    for (c, monomial) in first {
        for (k, i, j, rest) in leibniz(monomial, second) {
            let product = rest.iter().fold(brackets[i][j], |e, &r| pool.mul(e, functions[r]));
            terms.push(pool.scale(*c * k, product));
        }
    }
    pool.sum(&terms)
}

/// The bracket of a monomial with a polynomial by Leibniz' rule: terms c \[i, j\] · Π rest, as (c, i, j, rest).
fn leibniz(
    monomial: &[usize],
    with: &ConstantPolynomial,
) -> Vec<(Number, usize, usize, Vec<usize>)> {
    let without = |all: &[usize], k: usize| -> Vec<usize> {
        all.iter().enumerate().filter(|(n, _)| *n != k).map(|(_, &i)| i).collect()
    };
    let mut terms = Vec::new();
    for (c, other) in with {
        for (a, &i) in monomial.iter().enumerate() {
            for (b, &j) in other.iter().enumerate() {
                terms.push((*c, i, j, [without(monomial, a), without(other, b)].concat()));
            }
        }
    }
    terms
}

fn polynomial(pool: &mut Pool, terms: &ConstantPolynomial, functions: &[Expr]) -> Expr {
    let terms: Vec<Expr> = terms
        .iter()
        .map(|(c, factors)| {
            let product =
                factors.iter().fold(Expr::ONE, |product, &i| pool.mul(product, functions[i]));
            pool.scale(*c, product)
        })
        .collect();
    pool.sum(&terms)
}

/// What is evaluated: the law, functions, and brackets.
fn roots(law: &Law, functions: &[Expr], brackets: &[Vec<Expr>]) -> Vec<Expr> {
    let mut roots = law.expressions();
    roots.extend(functions);
    roots.extend(brackets.concat());
    roots
}
