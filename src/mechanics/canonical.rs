//! Transformations (q, p) → (Q, P): both directions where they can be written down, a point and
//! its image where they cannot, and whether they are canonical.
//!
//! In: a transformation of a model. Out: a [`PhaseMap`] and its [`CanonicalVerdict`]. Its matrix
//! M = ∂(Q, P)/∂(q, p) follows from second derivatives of the law, so that M 𝕁 Mᵀ − 𝕁 is at
//! rounding where the map is canonical. Never here: motion.
//! Source: *The Principles of Dynamics*, §§ 3.2.1, 3.3.

use std::collections::HashMap;

use nalgebra::DMatrix;

use super::conjugate_root::with_values_at;
use super::equations::{Equations, ImplicitMap};
use super::implicit_map::matrix_at;
use super::isolate::{self, Solution, tidy};
use super::sampling::TRIES;
use super::slope::relations_with_common_roots;
use super::valuation::Valuation;
use crate::expr::{Expr, Pool, Symbol};
use crate::model::{Model, Transformation, TransformationLaw};
use crate::num::Number;

/// The points at which a written solution has to hold, and the points tried for them.
pub(super) const WITNESSES: usize = 8;
const TRIED_POINTS: u64 = 64;

/// A map and its inverse lead back to a value up to this part of it, which may be rounding.
pub(super) const LEADS_BACK: f64 = 1e-7;

/// The steps of the pool that each may take of what is searched for of a transformation: the map, its inverse, K, each
/// generating function.
pub(super) const ALLOWANCE: u64 = 1_000_000;

/// A transformation as relations between the old and the new variables.
#[derive(Clone, Debug)]
pub struct PhaseMap {
    /// As written in the file.
    pub name: String,
    /// q…, then p….
    pub old: Vec<Symbol>,
    /// The relations between them and the new variables.
    pub implicit: ImplicitMap,
    /// ∂F/∂t at fixed variables of the generating function; `None` if the map is explicit, or a chain with a part of which it is
    /// not known.
    pub function_rate: Option<Expr>,
    /// The new variables as functions of the old and t, if they can be written down.
    pub forwards: Option<Solution>,
    /// The pairs whose generating function has an old and a new variable of different kinds, F2 or F3: they may be near the
    /// identity where nothing else is known.
    pub(super) near_identity: Vec<bool>,
    /// Those that it is made of one after the other, if it cannot be written as one, and whether they are inverted.
    pub(super) parts: Vec<(PhaseMap, bool)>,
    pub(super) by_old: Vec<Vec<Expr>>,
}

impl PhaseMap {
    pub(super) fn relations(pool: &mut Pool, model: &Model, given: &Transformation) -> PhaseMap {
        let pairs = model.coordinates.iter().zip(&given.new);
        let half = |k: usize| given.new.iter().map(move |pair| pair[k]);
        let new: Vec<Symbol> = half(0).chain(half(1)).collect();
        let old: Vec<Symbol> = model
            .coordinates
            .iter()
            .map(|c| c.position)
            .chain(model.coordinates.iter().map(|c| c.momentum))
            .collect();
        if let TransformationLaw::Chain(parts) = &given.law {
            return PhaseMap::chain(pool, model, given, parts);
        }
        let mut relations = Vec::new();
        let mut all_own = Vec::new();
        let mut function_rate = None;
        let mut near_identity = vec![false; given.new.len()];
        match &given.law {
            TransformationLaw::Explicit { positions, momenta } => {
                for (&symbol, &e) in new.iter().zip(positions.iter().chain(momenta)) {
                    let variable = pool.variable(symbol);
                    all_own.push(symbol);
                    relations.push(pool.sub(variable, e));
                }
            }
            // made of others: its law is looked up before
            TransformationLaw::Inverse(_)
            | TransformationLaw::Composition(_)
            | TransformationLaw::Chain(_) => {}
            TransformationLaw::Generating { types, function } => {
                for ((c, &[position, momentum]), of) in pairs.zip(types) {
                    // the two that F does not depend on are its slopes, with a sign
                    let (own, slope, sign) = if of.has_position() {
                        (c.momentum, c.position, Number::MINUS_ONE)
                    } else {
                        (c.position, c.momentum, Number::ONE)
                    };
                    let derivative = pool.derivative(*function, slope);
                    all_own.push(own);
                    let own = pool.variable(own);
                    relations
                        .push(pool.linear(Number::ZERO, &[(Number::ONE, own), (sign, derivative)]));
                    let (own, slope, sign) = if of.has_new_position() {
                        (momentum, position, Number::ONE)
                    } else {
                        (position, momentum, Number::MINUS_ONE)
                    };
                    let derivative = pool.derivative(*function, slope);
                    all_own.push(own);
                    let own = pool.variable(own);
                    relations
                        .push(pool.linear(Number::ZERO, &[(Number::ONE, own), (sign, derivative)]));
                }
                near_identity =
                    types.iter().map(|of| of.has_position() != of.has_new_position()).collect();
                function_rate = Some(pool.derivative(*function, model.symbols.time));
            }
        }
        let mut jacobian = |of: &[Symbol]| -> Vec<Vec<Expr>> {
            let row = |pool: &mut Pool, e| of.iter().map(|&s| pool.derivative(e, s)).collect();
            relations.iter().map(|&e| row(pool, e)).collect()
        };
        let (by_new, by_old) = (jacobian(&new), jacobian(&old));
        let name = given.name.clone();
        PhaseMap {
            name,
            old,
            implicit: ImplicitMap { new, relations, by_new, own: all_own },
            function_rate,
            forwards: None,
            near_identity,
            parts: Vec::new(),
            by_old,
        }
    }

    /// Whether the map is given by the new variables themselves.
    pub fn is_explicit(&self) -> bool {
        self.function_rate.is_none() && self.parts.is_empty()
    }

    /// Q…, then P….
    pub fn new_variables(&self) -> &[Symbol] {
        &self.implicit.new[..self.old.len()]
    }

    /// Finds the new variables as functions of the old ones, if they can be written down.
    pub(super) fn find_forwards(
        &self,
        model: &Model,
        equations: &mut Equations,
    ) -> Option<Solution> {
        if !self.parts.is_empty() {
            return None;
        }
        equations.attempt(ALLOWANCE, |equations| self.forwards_by_solving(model, equations))
    }

    fn forwards_by_solving(&self, model: &Model, equations: &mut Equations) -> Option<Solution> {
        let points: Vec<Valuation> =
            (0..TRIED_POINTS).map(|n| Valuation::near_start(model, equations, n)).collect();
        let (relations, new) = (self.implicit.relations.clone(), self.implicit.new.clone());
        // the branch that a map near this one leads to comes first
        if let Some(images) = self.nearest_images(&equations.pool, &points) {
            let pool = &mut equations.pool;
            let mut near = |pool: &mut Pool, found: &Solution| images.are_those_of(pool, found);
            if let Some(found) = isolate::solve(pool, &relations, &new, &mut near) {
                let zeros = self.old.iter().map(|&symbol| (symbol, 0.0));
                let origin = points[0].clone().with(zeros.collect::<Vec<_>>());
                return Some(with_values_at(pool, found, &origin));
            }
        }
        let accept = |pool: &mut Pool, found: &Solution, strict: bool| {
            let (mut right, mut wrong) = (0, 0);
            for point in &points {
                let image: Vec<(Symbol, f64)> =
                    found.iter().map(|&(s, e)| (s, point.value(pool, e))).collect();
                let at = point.clone().with(image);
                match self.implicit.holds(pool, &at) {
                    Some(true) => right += 1,
                    Some(false) => wrong += 1,
                    None => {}
                }
                if right + wrong == WITNESSES {
                    break;
                }
            }
            right > 0 && if strict { wrong == 0 } else { wrong <= right }
        };
        let pool = &mut equations.pool;
        let opened =
            relations_with_common_roots(pool, &self.implicit.relations, &self.implicit.own);
        let forms = [(&relations, true), (&relations, false), (&opened, true), (&opened, false)];
        forms.into_iter().find_map(|(relations, everywhere)| {
            let mut test = |pool: &mut Pool, found: &Solution| accept(pool, found, everywhere);
            isolate::solve(pool, relations, &new, &mut test)
        })
    }

    /// The old variables as functions of the new ones and t, if they can be written down.
    pub fn backwards(&self, model: &Model, equations: &mut Equations) -> Option<Solution> {
        if !self.parts.is_empty() {
            return None;
        }
        equations.attempt(ALLOWANCE, |equations| self.backwards_by_solving(model, equations))
    }

    fn backwards_by_solving(&self, model: &Model, equations: &mut Equations) -> Option<Solution> {
        let images = self.images(model, equations, WITNESSES);
        let beside = (0..WITNESSES as u64).map(|n| Valuation::beside_start(model, equations, n));
        let beside: Vec<Valuation> =
            beside.filter_map(|point| self.image(&equations.pool, &point)).collect();
        let accept = |pool: &mut Pool, found: &Solution, strict: bool| {
            let back = |at: &Valuation| {
                found.iter().all(|&(symbol, e)| at.agrees(pool, e, at.at(symbol), LEADS_BACK))
            };
            let right = images.iter().filter(|at| back(at)).count();
            // a branch is that of the start, of which points as far away as the largest coordinate may not be
            let is_of_start =
                if beside.is_empty() { 2 * right >= images.len() } else { beside.iter().all(back) };
            right > 0 && if strict { right == images.len() } else { is_of_start }
        };
        let pool = &mut equations.pool;
        if let Some(found) = self.inverse_of_linear(pool).filter(|found| accept(pool, found, true))
        {
            return Some(found);
        }
        let open = |pool: &mut Pool, e: Expr| {
            let e = pool.open_tangents(e);
            pool.simplify(e)
        };
        let relations: Vec<Expr> = self.implicit.relations.iter().map(|&e| open(pool, e)).collect();
        let opened =
            relations_with_common_roots(pool, &self.implicit.relations, &self.implicit.own);
        // a solution that holds everywhere, else a branch
        let forms = [(&relations, true), (&relations, false), (&opened, true), (&opened, false)];
        forms.into_iter().find_map(|(relations, everywhere)| {
            let mut test = |pool: &mut Pool, found: &Solution| accept(pool, found, everywhere);
            isolate::solve(pool, relations, &self.old, &mut test)
        })
    }

    /// A point with its image, if one is found by what is written down or by Newton's method.
    pub fn image(&self, pool: &Pool, point: &Valuation) -> Option<Valuation> {
        if let Some(forwards) = &self.forwards {
            let image: Vec<(Symbol, f64)> =
                forwards.iter().map(|&(s, e)| (s, point.value(pool, e))).collect();
            let at = point.clone().with(image);
            if self.implicit.holds(pool, &at) == Some(true) {
                return Some(self.implicit.newton(pool, at.clone()).unwrap_or(at));
            }
        }
        if !self.parts.is_empty() {
            return self.image_by_parts(pool, point);
        }
        let same = self.old.iter().map(|&s| point.at(s)).collect();
        self.nearest(pool, point).or_else(|| self.implicit.search(pool, point, same))
    }

    /// M = ∂(Q, P)/∂(q, p) at a point with its image; `None` where the map breaks down.
    pub fn tangent(&self, pool: &Pool, at: &Valuation) -> Option<DMatrix<f64>> {
        let by_old = matrix_at(pool, &self.by_old, at);
        let tangent = -matrix_at(pool, &self.implicit.by_new, at).full_piv_lu().solve(&by_old)?;
        // what lies between the parts of a chain is solved for as well
        let tangent = tangent.rows(0, self.old.len()).into_owned();
        tangent.iter().all(|x| x.is_finite()).then_some(tangent)
    }

    pub(super) fn images(
        &self,
        model: &Model,
        equations: &Equations,
        most: usize,
    ) -> Vec<Valuation> {
        let points = (0..TRIES).map(|n| Valuation::near_start(model, equations, n));
        // where a tenth of the points has no image, none of the others will
        let mut failed = 0;
        let found = points.map_while(|point| {
            (failed < 40).then(|| {
                let image = self.image(&equations.pool, &point);
                failed += usize::from(image.is_none());
                image
            })
        });
        found.flatten().take(most).collect()
    }
}

/// Values put into an expression, which must leave none of these symbols.
pub(super) fn free_of(
    pool: &mut Pool,
    e: Expr,
    values: &Solution,
    symbols: &[Symbol],
) -> Option<Expr> {
    let map: HashMap<Symbol, Expr> = values.iter().copied().collect();
    let e = tidy(pool, e, &map);
    (!pool.depends_on_any(e, symbols)).then_some(e)
}

#[cfg(test)]
mod tests {
    use super::ALLOWANCE;
    use crate::expr::Pool;

    /// Whether so many squares can be asked for within an allowance.
    fn suffices(allowance: u64, squares: u64) -> bool {
        let mut pool = Pool::new();
        let x = pool.named("x");
        let asked = |pool: &mut Pool| {
            (0..squares).for_each(|_| {
                pool.powi(x, 2);
            });
            Some(())
        };
        pool.attempt(allowance, asked).is_some()
    }

    #[test]
    fn a_transformation_is_searched_for_in_a_million_steps() {
        let of_a_thousand =
            (1..=1000).take_while(|&squares| suffices(1000, squares)).count() as u64;
        assert!((1..1000).contains(&of_a_thousand));
        assert!(suffices(ALLOWANCE, 990 * of_a_thousand));
        assert!(!suffices(ALLOWANCE, 1010 * (of_a_thousand + 1)));
    }
}
