//! Whether a function generates a map.
//!
//! In: a function of the variables of its type, the map as functions of the old variables, points. Out: the function in its
//! shortest form, and whether its relations are proved. Never here: where the function comes from.

use std::collections::HashMap;

use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::mechanics::canonical::PhaseMap;
use crate::mechanics::collected::collected;
use crate::mechanics::isolate::{self, Solution};
use crate::mechanics::valuation::Valuation;
use crate::model::{GeneratingType, Model, Transformation, TransformationLaw};

/// A relation holds at a point if what is left of it is less than this part of its terms.
const VANISHES: f64 = 1e-9;

/// Whether a function gives a map.
pub(super) struct FunctionTest<'a> {
    pub(super) model: &'a Model,
    pub(super) given: &'a Transformation,
    pub(super) types: &'a [GeneratingType],
    /// The old and the new variables.
    pub(super) variables: Vec<Symbol>,
    /// The new variables as functions of the old ones.
    pub(super) map: HashMap<Symbol, Expr>,
    pub(super) points: &'a [Valuation],
}

impl FunctionTest<'_> {
    /// The function that has this value with the unknowns solved for, if it gives the map, and whether that is proved.
    pub(super) fn function(
        &self,
        pool: &mut Pool,
        value: Expr,
        unknowns: &[Symbol],
        solution: &Solution,
    ) -> Option<(Expr, bool)> {
        let put: HashMap<Symbol, Expr> = solution.iter().copied().collect();
        let function = isolate::tidy(pool, value, &put);
        let simplified = pool.simplify(function);
        // what comes together by itself may be shorter than what is multiplied out
        let plain = pool.substitute(value, &put);
        let shorter = pool.weight(plain) < pool.weight(simplified);
        let function = if shorter { plain } else { simplified };
        let function = collected(pool, function, &self.variables);
        if pool.depends_on_any(function, unknowns) {
            return None;
        }
        let relations = self.relations(pool, function);
        let mut right = 0;
        for at in self.points {
            for &e in &relations {
                let (left, size) = pool.evaluate_with_size(e, &|s| at.at(s));
                if left.is_finite() && left.abs() > VANISHES * size {
                    return None;
                }
                right += usize::from(left.is_finite());
            }
        }
        if right < 2 * relations.len() {
            return None;
        }
        let proved = relations.iter().all(|&e| {
            let e = pool.substitute(e, &self.map);
            pool.is_zero(e) == Zero::Proved
        });
        Some((function, proved))
    }

    /// What vanishes where a function gives the map.
    fn relations(&self, pool: &mut Pool, function: Expr) -> Vec<Expr> {
        let law = TransformationLaw::Generating { types: self.types.to_vec(), function };
        let transformation = Transformation { law, ..self.given.clone() };
        PhaseMap::relations(pool, self.model, &transformation).implicit.relations
    }
}
