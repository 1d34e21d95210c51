//! Determining equations: linear conditions on unknown functions, each of which is a combination of the same monomials.
//!
//! In: the monomials, and what the conditions are at random points. Out: solutions modulo a prime, as sparse as they come, and
//! the functions of one. Never here: the conditions.

use super::ansatz::orders;
use super::echelon::{Echelon, reduced};
use super::formula::{cleared, content};
use super::random::Random;
use super::units::Unsupported;
use crate::expr::{Expr, Pool};
use crate::num::{Number, PRIMES, PrimeField, Residue};

/// The largest number of unknown coefficients.
pub(super) const MOST: usize = 1_500;

/// The reason where the budget of time is spent.
const RAN_OUT: &str = "the time allowed ran out";

/// Points beyond those that determine the rank, which have to add nothing.
const SPARE: usize = 12;

/// The bits by which a residue is longer than the fraction it is taken for.
const SPARE_BITS: u32 = 16;

/// The equations. A vector has the coefficients of one function behind those of the other.
pub(super) struct DeterminingEquations {
    pub(super) monomials: Vec<Expr>,
    pub(super) functions: usize,
    pub(super) field: PrimeField,
}

/// The monomials' values at a random point, and the conditions there on the coefficients.
pub(super) struct SampledConditions {
    pub(super) values: Vec<Residue>,
    pub(super) rows: Vec<Vec<Residue>>,
}

impl DeterminingEquations {
    pub(super) fn of(monomials: Vec<Expr>, functions: usize) -> DeterminingEquations {
        DeterminingEquations { monomials, functions, field: PrimeField::nth(0) }
    }

    pub(super) fn width(&self) -> usize {
        self.monomials.len() * self.functions
    }

    /// The field of the first prime modulo which a random point has values.
    ///
    /// # Errors
    /// Returns this error if there is none.
    pub(super) fn field_where(
        has_values: impl Fn(PrimeField, &mut Random) -> bool,
        error: &str,
    ) -> Result<PrimeField, Unsupported> {
        let works = |field: &PrimeField| {
            let mut random = Random::new(5);
            (0..40).any(|_| has_values(*field, &mut random))
        };
        let found = (0..PRIMES.len()).map(PrimeField::nth).find(works);
        found.ok_or_else(|| Unsupported(error.to_owned()))
    }

    /// All solutions in which the coefficients at `zeros` vanish, from conditions at no fewer than `least` points: the sparsest
    /// first, and not independent.
    pub(super) fn solutions(
        &self,
        draw: &mut dyn FnMut(&mut Random) -> Option<SampledConditions>,
        least: usize,
        zeros: &[usize],
        is_over: &dyn Fn() -> bool,
    ) -> Result<Vec<Vec<Residue>>, Unsupported> {
        let ran_out = || Err(Unsupported(RAN_OUT.to_owned()));
        let (m, width) = (self.monomials.len(), self.width());
        let mut random = Random::new(3);
        // monomials that depend on others as functions, such as cos² on sin², are left out
        let mut independent = Echelon::new(self.field, m);
        let mut echelon = Echelon::new(self.field, width);
        let (mut points, mut idle, mut tries) = (0, 0, 0);
        while idle < SPARE || points < least {
            tries += 1;
            if is_over() || tries > 100 * MOST {
                return ran_out();
            }
            let Some(SampledConditions { values, rows }) = draw(&mut random) else { continue };
            points += 1;
            let mut more = independent.add(values);
            for row in rows {
                more |= echelon.add(row);
            }
            idle = if more { 0 } else { idle + 1 };
        }
        let dependent = (0..width).filter(|k| !independent.leads(k % m));
        for k in dependent.chain(zeros.iter().copied()) {
            let mut row = vec![Residue::ZERO; width];
            row[k] = self.field.one();
            echelon.add(row);
        }
        let basis = echelon.null_space();
        let mut all: Vec<Vec<Residue>> = Vec::new();
        for order in orders(width, 6) {
            if is_over() {
                return ran_out();
            }
            all.extend(reduced(self.field, &basis, &order));
        }
        all.sort_by_key(|v| v.iter().filter(|x| !x.is_zero()).count());
        Ok(all)
    }

    /// The functions of a solution whose coefficients are short fractions, up to a factor by which the first `whole` have whole
    /// coefficients without a common divisor.
    pub(super) fn functions_of(
        &self,
        pool: &mut Pool,
        vector: &[Residue],
        whole: usize,
    ) -> Option<Vec<Expr>> {
        let lead = vector.iter().find(|x| !x.is_zero())?;
        let scale = self.field.inverse(*lead)?;
        let mut places = Vec::new();
        let mut coefficients = Vec::new();
        for (k, &x) in vector.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
            places.push(k);
            let fraction = self.field.fraction(self.field.mul(x, scale), SPARE_BITS)?;
            coefficients.push(pool.number(fraction));
        }
        let coefficients = cleared(pool, &coefficients);
        let m = self.monomials.len();
        let mut terms = vec![Vec::new(); self.functions];
        for (k, c) in places.into_iter().zip(coefficients) {
            terms[k / m].push(pool.mul(c, self.monomials[k % m]));
        }
        let sums: Vec<Expr> = terms.iter().map(|terms| pool.sum(terms)).collect();
        let common = content(pool, &sums[..whole]).recip();
        Some(sums.into_iter().map(|e| pool.linear(Number::ZERO, &[(common, e)])).collect())
    }
}
