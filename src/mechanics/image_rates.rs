//! How the new variables of a map without a closed form change, as derivatives of the relations of the map: a derivation D of
//! the old variables and the time takes the new ones to ξ′ with Σ ∂R/∂ξ ξ′ + D R = 0.
//!
//! In: a derivation, an expression of old and new variables. Out: the same derivation with the new variables in it; an
//! expression in the variables of the generating function, which are independent, so that what vanishes is seen to vanish.
//! Never here: images of points.
//! Source: *The Principles of Dynamics*, § 3.2.1.

use std::collections::HashMap;

use super::chain::image_of_part;
use super::equations::{Equations, ImplicitMap, NoClosedForm};
use super::linear;
use super::valuation::Valuation;
use crate::expr::{Expr, Pool, Symbol};

impl Equations {
    /// The maps without a closed form on whose new variables an expression depends.
    fn implicit_maps_of(&self, e: Expr) -> Vec<ImplicitMap> {
        let all = self.supplements.maps.implicit.iter().map(|(map, _)| map);
        all.filter(|map| self.pool.depends_on_any(e, &map.new)).cloned().collect()
    }

    /// Whether an expression depends on the new variables of a map without a closed form.
    pub(super) fn has_images(&self, e: Expr) -> bool {
        !self.implicit_maps_of(e).is_empty()
    }

    /// The derivation of an expression that may depend on new variables of maps without a closed form; `seeds` has the images
    /// of all other symbols that change, the momenta among them.
    ///
    /// # Errors
    /// Returns an error if the derivatives of such a map are too long to be read.
    pub(super) fn derivation(
        &mut self,
        e: Expr,
        seeds: &[(Symbol, Expr)],
    ) -> Result<Expr, NoClosedForm> {
        let mut seeds = seeds.to_vec();
        for map in self.implicit_maps_of(e) {
            if map.own.is_empty() {
                self.rates_by_parts(&map, &mut seeds)?;
                continue;
            }
            let (unknowns, given): (Vec<Symbol>, Vec<Symbol>) =
                map.new.iter().copied().partition(|symbol| !map.own.contains(symbol));
            let relation_of = |own: &Symbol| map.own.iter().position(|known| known == own);
            // the relations that give old variables have only the new ones of the function in them
            let rows: Vec<usize> =
                (0..map.own.len()).filter(|&row| !map.new.contains(&map.own[row])).collect();
            let pool = &mut self.pool;
            let relations: Vec<Expr> = rows.iter().map(|&row| map.relations[row]).collect();
            let rates = rates_of(pool, &relations, &unknowns, &seeds)?;
            seeds.extend(unknowns.into_iter().zip(rates));
            // and the others give the rest of the new variables one by one
            let known = seeds.clone();
            for symbol in given {
                if let Some(row) = relation_of(&symbol) {
                    let change = pool.derivation(map.relations[row], &known);
                    seeds.push((symbol, pool.neg(change)));
                }
            }
        }
        Ok(self.pool.derivation(e, &seeds))
    }

    /// The rates of the new variables of maps one after the other, and of what lies between them.
    fn rates_by_parts(
        &mut self,
        map: &ImplicitMap,
        seeds: &mut Vec<(Symbol, Expr)>,
    ) -> Result<(), NoClosedForm> {
        let size = 2 * self.coordinates.len();
        let count = map.relations.len() / size;
        for (part, relations) in map.relations.chunks(size).enumerate() {
            let unknowns = &map.new[image_of_part(part, count, size)];
            let rates = rates_of(&mut self.pool, relations, unknowns, seeds)?;
            seeds.extend(unknowns.iter().copied().zip(rates));
        }
        Ok(())
    }

    /// A point of (q, p, t) with the images of the maps without a closed form, each on the branch of its image near the start
    /// if that leads there.
    pub fn with_images(&self, mut point: Valuation) -> Valuation {
        for (map, near_start) in &self.supplements.maps.implicit {
            if let Some(image) = map.search(&self.pool, &point, near_start.clone()) {
                point = point.with(map.new.iter().map(|&symbol| (symbol, image.at(symbol))));
            }
        }
        point
    }

    /// The value of an expression that may depend on new variables of maps without a closed form; `at` has those of all other
    /// symbols. `None` if it has none.
    pub fn value_with_images(&self, e: Expr, at: &dyn Fn(Symbol) -> f64) -> Option<f64> {
        let value = if self.has_images(e) {
            let used = self.supplements.maps.implicit.iter().flat_map(|(map, _)| &map.relations);
            let used: Vec<Expr> = used.copied().chain([e]).collect();
            let symbols = used.iter().flat_map(|&e| self.pool.symbols_of(e));
            let known = symbols.map(|symbol| (symbol, at(symbol))).filter(|(_, x)| !x.is_nan());
            let point = Valuation::default().with(known);
            self.with_images(point).value(&self.pool, e)
        } else {
            self.pool.evaluate(e, at)
        };
        Some(value).filter(|value| value.is_finite())
    }

    /// An expression of (q, p, t) and new variables, in terms of the variables of the generating function by which these are
    /// given.
    ///
    /// # Errors
    /// Returns an error if there are several such functions: their variables are not independent.
    pub(super) fn in_generating_variables(&mut self, e: Expr) -> Result<Expr, NoClosedForm> {
        let maps = self.implicit_maps_of(e);
        let map = match &maps[..] {
            [] => return Ok(e),
            [map] if map.own.is_empty() => {
                let why = "it contains new variables of a composition without a closed form";
                return Err(NoClosedForm(why.to_owned()));
            }
            [map] => map,
            _ => {
                let why = "it contains new variables of several maps without a closed form";
                return Err(NoClosedForm(why.to_owned()));
            }
        };
        let pool = &mut self.pool;
        let mut given = HashMap::new();
        for (&own, &relation) in map.own.iter().zip(&map.relations) {
            let variable = pool.variable(own);
            given.insert(own, pool.sub(variable, relation));
        }
        let e = pool.substitute(e, &given);
        Ok(pool.simplify(e))
    }
}

/// The rates of unknowns in relations that keep holding, where those of all else that changes are given.
fn rates_of(
    pool: &mut Pool,
    relations: &[Expr],
    unknowns: &[Symbol],
    seeds: &[(Symbol, Expr)],
) -> Result<Vec<Expr>, NoClosedForm> {
    let (mut matrix, mut right) = (Vec::new(), Vec::new());
    for &relation in relations {
        matrix.push(unknowns.iter().map(|&s| pool.derivative(relation, s)).collect());
        let change = pool.derivation(relation, seeds);
        right.push(pool.neg(change));
    }
    linear::solve(pool, &matrix, &right)?.x
}
