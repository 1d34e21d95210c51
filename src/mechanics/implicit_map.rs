//! Points and their images under a map that is known by relations between old and new variables.
//!
//! In: an [`ImplicitMap`], a point, what its image may be near to. Out: the image by Newton's method. Never here: where the
//! relations come from, motion.
//! Source: *The Principles of Dynamics*, § 3.2.1; images beside known ones by deflation: P. E. Farrell, Á. Birkisson, S. W. Funke,
//! SIAM J. Sci. Comput. 37 (2015) A2026.

use nalgebra::{DMatrix, DVector};

use super::equations::ImplicitMap;
use super::valuation::Valuation;
use crate::expr::{Expr, Pool};

/// Relations hold at a point if what is left of them is this small relative to their terms.
const HOLDS: f64 = 1e-9;

/// An image is near another if Newton's first step misses it by less than this part of the step.
const NEAR: f64 = 0.5;

/// Numbers of several sizes.
const SIZES: [f64; 7] = [0.7, -0.6, 1.9, 0.1, -1.7, 5.0, 30.0];

/// Images are the same if they differ by less than this part of their size.
const SAME: f64 = 1e-6;

/// The steps of Newton's method with known images taken out, and the guesses that it begins with.
const DEFLATED: usize = 30;
const BEGINNINGS: usize = 8;

/// Multiples of a known image that may be near another.
const FACTORS: [f64; 4] = [1.0, -1.0, 2.0, -0.5];

/// First guesses of `n` unknown numbers for Newton's method, of several sizes and signs.
pub fn guesses(n: usize) -> impl Iterator<Item = Vec<f64>> {
    let row = SIZES.len();
    (0..3 * row).map(move |k| (0..n).map(|i| SIZES[(k + i * (k / row + 1)) % row]).collect())
}

impl ImplicitMap {
    /// Whether the relations hold at a point; `None` if they have no values there.
    pub(super) fn holds(&self, pool: &Pool, at: &Valuation) -> Option<bool> {
        let mut all = true;
        for &e in &self.relations {
            let (value, size) = pool.evaluate_with_size(e, &|s| at.at(s));
            if !value.is_finite() {
                return None;
            }
            all &= value.abs() <= HOLDS * size.max(f64::MIN_POSITIVE);
        }
        Some(all)
    }

    /// A point with an image, on whichever branch one is found from a first guess, then from others.
    pub fn search(&self, pool: &Pool, point: &Valuation, first: Vec<f64>) -> Option<Valuation> {
        std::iter::once(first).chain(guesses(self.new.len())).find_map(|guess| {
            let at = point.clone().with(self.new.iter().copied().zip(guess));
            self.newton(pool, at)
        })
    }

    /// A point with each of its images that are found, each once and at most so many: from first guesses of several sizes and
    /// from multiples of the image that it has, then with those that are known taken out of the relations, until nothing
    /// more is found.
    pub fn images(&self, pool: &Pool, at: &Valuation, most: usize) -> Vec<Valuation> {
        let own: Vec<f64> = self.new.iter().map(|&s| at.at(s)).collect();
        let n = FACTORS.len();
        let multiples = (0..n * n).map(|k| {
            let factor =
                |i: usize| if i.is_multiple_of(2) { FACTORS[k % n] } else { FACTORS[k / n] };
            own.iter().enumerate().map(|(i, x)| x * factor(i)).collect::<Vec<f64>>()
        });
        let all: Vec<Vec<f64>> = multiples.chain(guesses(self.new.len())).collect();
        let with = |guess: &[f64]| at.clone().with(self.new.iter().copied().zip(guess.to_vec()));
        let mut found: Vec<Valuation> = Vec::new();
        for guess in &all {
            if found.len() == most {
                return found;
            }
            let image = self.newton(pool, with(guess));
            found.extend(image.filter(|image| self.is_new(image, &found)));
        }
        for guess in guesses(self.new.len()).take(BEGINNINGS) {
            while found.len() < most
                && let Some(image) = self.deflated(pool, with(&guess), &found)
            {
                found.push(image);
            }
        }
        found
    }

    /// Whether an image is none of those known.
    fn is_new(&self, image: &Valuation, known: &[Valuation]) -> bool {
        known.iter().all(|other| {
            self.new.iter().any(|&s| {
                let (a, b) = (image.at(s), other.at(s));
                (a - b).abs() > SAME * (1.0 + a.abs().max(b.abs()))
            })
        })
    }

    /// An image beside the known ones: Newton's method on the relations times Π (1 + 1/|x − xᵢ|²), which repels it from them.
    fn deflated(&self, pool: &Pool, mut at: Valuation, known: &[Valuation]) -> Option<Valuation> {
        for _ in 0..DEFLATED {
            let left = DVector::from_iterator(
                self.new.len(),
                self.relations.iter().map(|&e| at.value(pool, e)),
            );
            let step = matrix_at(pool, &self.by_new, &at).full_piv_lu().solve(&left)?;
            if !step.iter().all(|x| x.is_finite()) {
                return None;
            }
            // the gradient of the logarithm of the product along the step: the step is as before, but for its length
            let slope: f64 = known
                .iter()
                .map(|other| {
                    let apart = self.new.iter().map(|&s| at.at(s) - other.at(s));
                    let (square, along) =
                        apart.zip(step.iter()).fold((0.0, 0.0), |(square, along), (x, d)| {
                            (square + x * x, along + x * d)
                        });
                    -2.0 * along / (square * (square + 1.0))
                })
                .sum();
            let length = 1.0 / (1.0 + slope);
            let size = self.new.iter().map(|&s| at.at(s).abs()).fold(1.0, f64::max);
            let settled = step.amax() <= 1e-10 * size;
            let values: Vec<_> = self
                .new
                .iter()
                .zip(step.iter())
                .map(|(&s, d)| (s, at.at(s) - length * d))
                .collect();
            if settled || !values.iter().all(|(_, x)| x.is_finite()) {
                break;
            }
            at = at.with(values);
        }
        self.newton(pool, at).filter(|image| self.is_new(image, known))
    }

    /// A point with its image on the branch of a near image, which the valuation has as values of the new variables;
    /// `None` where that branch has ended.
    pub fn near(&self, pool: &Pool, near: Valuation) -> Option<Valuation> {
        let before: Vec<f64> = self.new.iter().map(|&s| near.at(s)).collect();
        let left = DVector::from_iterator(
            before.len(),
            self.relations.iter().map(|&e| near.value(pool, e)),
        );
        let step = matrix_at(pool, &self.by_new, &near).full_piv_lu().solve(&left)?;
        let image = self.newton(pool, near)?;
        let off = self.new.iter().zip(before.iter().zip(step.iter()));
        // next to a caustic the first step leads far away, and the image is elsewhere
        let missed = off.map(|(&s, (x, d))| (image.at(s) - (x - d)).abs()).fold(0.0, f64::max);
        (missed <= NEAR * step.amax() || step.amax() <= HOLDS).then_some(image)
    }

    /// The image of a point by Newton's method from a guess.
    pub(super) fn newton(&self, pool: &Pool, mut at: Valuation) -> Option<Valuation> {
        const MOST: usize = 60;
        // nothing is found where so many steps leave more than half of the residual: at a double root each leaves a quarter
        const STALLED: usize = 8;
        let n = self.new.len();
        let residual = |at: &Valuation| {
            DVector::from_iterator(n, self.relations.iter().map(|&e| at.value(pool, e)))
        };
        let mut left = residual(&at);
        let mut before = f64::INFINITY;
        for count in 0..MOST {
            if count % STALLED == 0 {
                if left.norm() > 0.5 * before {
                    break;
                }
                before = left.norm();
            }
            if !left.iter().all(|x| x.is_finite()) {
                return None;
            }
            let step = matrix_at(pool, &self.by_new, &at).full_piv_lu().solve(&left)?;
            let (mut part, mut moved) = (1.0, None);
            for _ in 0..12 {
                let values =
                    self.new.iter().zip(step.iter()).map(|(&s, d)| (s, at.at(s) - part * d));
                let trial = at.clone().with(values.collect::<Vec<_>>());
                let after = residual(&trial);
                if after.iter().all(|x| x.is_finite())
                    && (after.norm() < left.norm() || step.norm() < 1e-12)
                {
                    moved = Some((trial, after));
                    break;
                }
                part *= 0.5;
            }
            let size = self.new.iter().map(|&s| at.at(s).abs()).fold(1.0, f64::max);
            let small = step.amax() <= 1e-14 * size;
            match moved {
                Some((trial, after)) => (at, left) = (trial, after),
                None => return (self.holds(pool, &at) == Some(true)).then_some(at),
            }
            if small {
                break;
            }
        }
        (self.holds(pool, &at) == Some(true)).then_some(at)
    }
}

pub(super) fn matrix_at(pool: &Pool, of: &[Vec<Expr>], at: &Valuation) -> DMatrix<f64> {
    let columns = of.first().map_or(0, Vec::len);
    DMatrix::from_fn(of.len(), columns, |i, j| at.value(pool, of[i][j]))
}

/// The largest entry of |M 𝕁 Mᵀ − 𝕁|.
pub(super) fn departure(matrix: &DMatrix<f64>) -> f64 {
    let size = matrix.nrows();
    let n = size / 2;
    let unit =
        DMatrix::from_fn(size, size, |i, j| f64::from(i8::from(j == i + n) - i8::from(i == j + n)));
    (matrix * &unit * matrix.transpose() - unit).amax()
}
