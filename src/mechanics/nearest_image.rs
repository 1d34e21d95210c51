//! Which of several images of a point a generating function means: the one on the branch of a map that is known.
//!
//! In: the relations of a map, a point. Out: what the image is near to, and whether a written solution has it. Never here:
//! where the relations come from, motion.
//!
//! Where F is regular at q = p = Q = P = 0 and gives a map there, with det ∂²F/∂old∂new ≠ 0, its second derivatives give a linear
//! map: the identity of F2 = qP + …, the exchange Q = p, P = −q of F1 = qQ + …. The branch meant is the one on which Newton's
//! method ends from the image under that map. If the function as a whole has none, each pair may have its own; else the types
//! that may be near the identity, F2 and F3, are taken to be near it.
//! Source: *The Principles of Dynamics*, § 3.2.1.

use nalgebra::{DMatrix, DVector};

use super::canonical::{PhaseMap, WITNESSES};
use super::determinant::scaled_determinant;
use super::implicit_map::{guesses, matrix_at};
use super::isolate::Solution;
use super::valuation::Valuation;
use crate::expr::{Expr, Pool, Symbol};

/// A matrix with rows and columns of size 1 is singular if its determinant is smaller.
const SINGULAR: f64 = 1e-9;

/// The relative difference of a solution and an image that may be rounding.
const ROUNDING: f64 = 1e-7;

/// Relations with their derivatives by some old variables and by as many new ones.
pub(super) struct Linearized<'a> {
    pub(super) relations: Vec<Expr>,
    pub(super) by_old: Vec<Vec<Expr>>,
    pub(super) by_new: Vec<Vec<Expr>>,
    pub(super) old: &'a [Symbol],
    pub(super) new: &'a [Symbol],
}

impl Linearized<'_> {
    /// The image of a point under the relations linearised where these old and new variables are zero; `None` where they are not
    /// regular there.
    pub(super) fn image(&self, pool: &Pool, point: &Valuation) -> Option<Vec<f64>> {
        let zeros = self.old.iter().chain(self.new).map(|&symbol| (symbol, 0.0));
        let origin = point.clone().with(zeros);
        let (by_old, by_new) =
            (matrix_at(pool, &self.by_old, &origin), matrix_at(pool, &self.by_new, &origin));
        let is_regular = |matrix: &DMatrix<f64>| scaled_determinant(matrix.clone()) > SINGULAR;
        if !is_regular(&by_old) || !is_regular(&by_new) {
            return None;
        }
        let values = |symbols: &[Symbol]| {
            DVector::from_iterator(symbols.len(), symbols.iter().map(|&s| point.at(s)))
        };
        let at_origin = self.relations.iter().map(|&e| origin.value(pool, e));
        let left = DVector::from_iterator(self.relations.len(), at_origin);
        let image = -by_new.full_piv_lu().solve(&(left + by_old * values(self.old)))?;
        image.iter().all(|x| x.is_finite()).then(|| image.iter().copied().collect())
    }
}

impl PhaseMap {
    /// What each new variable is near to at a point, by a map near this one; `None` where nothing is known.
    fn near_to(&self, pool: &Pool, point: &Valuation) -> Vec<Option<f64>> {
        let own: Vec<f64> = self.old.iter().map(|&s| point.at(s)).collect();
        let n = own.len() / 2;
        if self.is_explicit() || !self.parts.is_empty() {
            return vec![None; own.len()];
        }
        let all: Vec<usize> = (0..n).collect();
        if let Some(image) = self.linear_image(pool, point, &all) {
            return image.into_iter().map(Some).collect();
        }
        let new = self.implicit.new.iter().copied().zip(own.iter().copied());
        let beside = point.clone().with(new.collect::<Vec<_>>());
        let mut known = vec![None; own.len()];
        for k in 0..n {
            let same = || self.near_identity[k].then(|| vec![own[k], own[n + k]]);
            if let Some(image) = self.linear_image(pool, &beside, &[k]).or_else(same) {
                (known[k], known[n + k]) = (Some(image[0]), Some(image[1]));
            }
        }
        known
    }

    /// The image of a point under the map linearised in some of the pairs where they are zero: Q…, then P… of these.
    fn linear_image(&self, pool: &Pool, point: &Valuation, pairs: &[usize]) -> Option<Vec<f64>> {
        let n = self.old.len() / 2;
        let columns: Vec<usize> =
            pairs.iter().copied().chain(pairs.iter().map(|k| n + k)).collect();
        let rows = || pairs.iter().flat_map(|k| [2 * k, 2 * k + 1]);
        let part = |of: &[Vec<Expr>]| -> Vec<Vec<Expr>> {
            rows().map(|row| columns.iter().map(|&column| of[row][column]).collect()).collect()
        };
        let of = |symbols: &[Symbol]| -> Vec<Symbol> {
            columns.iter().map(|&column| symbols[column]).collect()
        };
        let (old, new) = (of(&self.old), of(&self.implicit.new));
        let linearized = Linearized {
            relations: rows().map(|row| self.implicit.relations[row]).collect(),
            by_old: part(&self.by_old),
            by_new: part(&self.implicit.by_new),
            old: &old,
            new: &new,
        };
        linearized.image(pool, point)
    }

    /// Numbers that the image of a point may be near to, the most likely first; none where nothing is known.
    fn beginnings(&self, pool: &Pool, point: &Valuation) -> Vec<Vec<f64>> {
        let known = self.near_to(pool, point);
        if known.iter().all(Option::is_some) {
            return vec![known.into_iter().flatten().collect()];
        }
        if known.iter().all(Option::is_none) {
            return Vec::new();
        }
        let own: Vec<f64> = self.old.iter().map(|&s| point.at(s)).collect();
        let or_else = |others: &[f64]| -> Vec<f64> {
            known.iter().zip(others).map(|(known, &other)| known.unwrap_or(other)).collect()
        };
        let others = guesses(own.len()).map(|guess| or_else(&guess));
        std::iter::once(or_else(&own)).chain(others).collect()
    }

    /// The point with the image that is meant where a map near this one is known.
    pub(super) fn nearest(&self, pool: &Pool, point: &Valuation) -> Option<Valuation> {
        self.beginnings(pool, point).into_iter().find_map(|values| {
            let values = self.implicit.new.iter().copied().zip(values);
            self.implicit.newton(pool, point.clone().with(values.collect::<Vec<_>>()))
        })
    }

    /// The images that are meant at the first of some points; `None` if no map near this one is known.
    pub(super) fn nearest_images<'a>(
        &self,
        pool: &Pool,
        points: &'a [Valuation],
    ) -> Option<NearestImages<'a>> {
        let points = &points[..WITNESSES.min(points.len())];
        let near_to: Vec<Vec<Option<f64>>> =
            points.iter().map(|point| self.near_to(pool, point)).collect();
        let is_known = |k: &usize| near_to.iter().all(|near| near[*k].is_some());
        let known: Vec<Symbol> =
            (0..self.old.len()).filter(is_known).map(|k| self.implicit.new[k]).collect();
        if known.is_empty() {
            return None;
        }
        let images: Vec<Option<Valuation>> =
            points.iter().map(|point| self.nearest(pool, point)).collect();
        let found = images.iter().any(Option::is_some);
        found.then_some(NearestImages { points, images, known })
    }
}

/// Points with the images that are meant, and the new variables of which that is known.
pub(super) struct NearestImages<'a> {
    points: &'a [Valuation],
    images: Vec<Option<Valuation>>,
    known: Vec<Symbol>,
}

impl NearestImages<'_> {
    /// Whether a solution has these images at most of the points.
    pub(super) fn are_those_of(&self, pool: &Pool, found: &Solution) -> bool {
        let same = |point: &Valuation, image: &Valuation| {
            found
                .iter()
                .filter(|(s, _)| self.known.contains(s))
                .all(|&(s, e)| point.agrees(pool, e, image.at(s), ROUNDING))
        };
        let both = self.points.iter().zip(&self.images);
        let both = both.filter_map(|(point, image)| Some((point, image.as_ref()?)));
        let (right, wrong): (Vec<_>, Vec<_>) = both.partition(|(point, image)| same(point, image));
        right.len() > wrong.len()
    }
}
