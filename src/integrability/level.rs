//! One level of the search: an ansatz, the null space of D on it, and what of it is not made of known constants.
//!
//! In: an ansatz at points over a prime field. Out: the dimension of the constants in it, and those that are new, each
//! with the least support. A rank modulo a prime at random points is at most the rank over the rationals, so that the
//! null space misses no constant. Which monomials are independent, and that the null space is made of what is known, is
//! decided by values at random points: a dependence that is seen at [`SPARE`] points more than its rank holds but for a
//! chance of at most (d/p)^`SPARE`, d the degree and p ≈ 2⁶² the prime (J. T. Schwartz, J. ACM 27 (1980) 701).
//! Never here: rationals.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::ansatz::{Ansatz, orders};
use super::atoms::Atoms;
use super::echelon::{Echelon, reduced};
use super::evaluator::ResidueEvaluator;
use super::law::{DrawnPoint, Law};
use super::random::Random;
use crate::expr::{Expr, Symbol};
use crate::num::{PrimeField, Residue};

/// Rows beyond the rank that have to add nothing.
const SPARE: usize = 12;

/// The number of points drawn in vain before the search is given up.
const TRIES: usize = 2_000;

/// The number of orders of columns in which sparse vectors are searched for.
const ORDERS: usize = 10;

/// Why a level has no answer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Broken {
    /// Time is over, or the work was cancelled.
    Over,
    /// No point was found at which everything has a value.
    NoPoint,
}

/// Where functions are evaluated: a law with its compiled expressions.
pub(super) struct Ground<'a> {
    pub(super) law: &'a Law,
    pub(super) evaluator: &'a ResidueEvaluator,
    pub(super) field: PrimeField,
    pub(super) constants: FxHashMap<Symbol, Residue>,
    /// What determines the values of functions of constants.
    pub(super) seed: u64,
    pub(super) is_over: &'a dyn Fn() -> bool,
}

impl Ground<'_> {
    /// The next point at which everything has a value.
    pub(super) fn draw(&self, random: &mut Random) -> Result<DrawnPoint, Broken> {
        for _ in 0..TRIES {
            if (self.is_over)() {
                return Err(Broken::Over);
            }
            let drawn =
                self.law.draw(self.evaluator, self.field, random, &self.constants, self.seed);
            if let Some(drawn) = drawn {
                return Ok(drawn);
            }
        }
        Err(Broken::NoPoint)
    }

    /// The null space of D on some columns, as vectors over them: that of each class of columns by itself.
    pub(super) fn null_space(
        &self,
        atoms: &Atoms,
        ansatz: &Ansatz,
        columns: &[usize],
        random: &mut Random,
    ) -> Result<Vec<Vec<Residue>>, Broken> {
        let mut classes: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
        for (place, &column) in columns.iter().enumerate() {
            classes.entry(ansatz.class(atoms, column)).or_default().push(place);
        }
        let mut basis = Vec::new();
        for places in classes.values() {
            let own: Vec<usize> = places.iter().map(|&place| columns[place]).collect();
            for vector in self.null_space_of_class(atoms, ansatz, &own, random)? {
                let mut whole = vec![Residue::ZERO; columns.len()];
                for (&place, x) in places.iter().zip(vector) {
                    whole[place] = x;
                }
                basis.push(whole);
            }
        }
        Ok(basis)
    }

    /// The same of columns that reflections change alike.
    fn null_space_of_class(
        &self,
        atoms: &Atoms,
        ansatz: &Ansatz,
        columns: &[usize],
        random: &mut Random,
    ) -> Result<Vec<Vec<Residue>>, Broken> {
        let mut echelon = Echelon::new(self.field, columns.len());
        let mut idle = 0;
        while idle < SPARE && echelon.rank() < columns.len() {
            let drawn = self.draw(random)?;
            let row = ansatz.row(atoms, self.evaluator, &drawn, columns);
            idle = if echelon.add(row.rates) { 0 } else { idle + 1 };
        }
        Ok(echelon.null_space())
    }

    /// The columns that are independent as functions on the variety, the constant left out.
    fn independent(
        &self,
        atoms: &Atoms,
        ansatz: &Ansatz,
        random: &mut Random,
    ) -> Result<Vec<usize>, Broken> {
        let all: Vec<usize> = (0..ansatz.columns.len()).collect();
        let mut echelon = Echelon::new(self.field, all.len());
        let mut idle = 0;
        while !atoms.free && idle < SPARE && echelon.rank() < all.len() {
            let drawn = self.draw(random)?;
            let row = ansatz.row(atoms, self.evaluator, &drawn, &all);
            idle = if echelon.add(row.values) { 0 } else { idle + 1 };
        }
        let constant = |c: usize| ansatz.expression_is_one(c);
        let is_included = |c: &usize| !constant(*c) && (atoms.free || echelon.leads(*c));
        Ok(all.into_iter().filter(is_included).collect())
    }
}

pub(super) struct LevelOutcome {
    /// The number of independent monomials.
    pub(super) size: usize,
    /// New constants of the motion: columns with their coefficients.
    pub(super) new: Vec<Vec<(usize, Residue)>>,
}

/// Searches one ansatz. `known` are the values of known constants at a point, and `products` which of their products
/// may lie in the ansatz.
pub(super) fn search(
    ground: &Ground<'_>,
    atoms: &Atoms,
    ansatz: &Ansatz,
    known: &[Expr],
    products: &[Vec<usize>],
    random: &mut Random,
) -> Result<LevelOutcome, Broken> {
    let field = ground.field;
    let columns = ground.independent(atoms, ansatz, random)?;
    let basis = ground.null_space(atoms, ansatz, &columns, random)?;
    let size = columns.len();
    if basis.is_empty() {
        return Ok(LevelOutcome { size, new: Vec::new() });
    }
    let mut candidates: Vec<Vec<(usize, Residue)>> = Vec::new();
    for order in orders(columns.len(), ORDERS) {
        if (ground.is_over)() {
            return Err(Broken::Over);
        }
        for row in reduced(field, &basis, &order) {
            let lead = row.iter().find(|x| !x.is_zero()).and_then(|&x| field.inverse(x));
            let Some(scale) = lead else { continue };
            let entries = row.iter().enumerate().filter(|(_, x)| !x.is_zero());
            let sparse: Vec<(usize, Residue)> =
                entries.map(|(i, &x)| (columns[i], field.mul(scale, x))).collect();
            if !candidates.contains(&sparse) {
                candidates.push(sparse);
            }
        }
    }
    candidates.sort_by_key(|v| (v.len(), v.iter().map(|(c, _)| *c).sum::<usize>()));
    let width = products.len() + candidates.len();
    let mut echelon = Echelon::new(field, width);
    let mut idle = 0;
    while idle < SPARE && echelon.rank() < width {
        let drawn = ground.draw(random)?;
        let values: Vec<Residue> =
            known.iter().map(|&e| ground.evaluator.value(&drawn.point, e)).collect();
        let product = |factors: &Vec<usize>| {
            factors.iter().fold(field.one(), |whole, &i| field.mul(whole, values[i]))
        };
        let mut row: Vec<Residue> = products.iter().map(product).collect();
        let monomials = ansatz.row(atoms, ground.evaluator, &drawn, &columns).values;
        let place: FxHashMap<usize, usize> =
            columns.iter().enumerate().map(|(i, &c)| (c, i)).collect();
        row.extend(candidates.iter().map(|v| {
            v.iter().fold(Residue::ZERO, |sum, &(c, x)| {
                field.add(sum, field.mul(x, monomials[place[&c]]))
            })
        }));
        idle = if echelon.add(row) { 0 } else { idle + 1 };
    }
    let is_new = |i: &usize| echelon.leads(products.len() + i);
    let new = (0..candidates.len()).filter(is_new).map(|i| candidates[i].clone()).collect();
    Ok(LevelOutcome { size, new })
}
