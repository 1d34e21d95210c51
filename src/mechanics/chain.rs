//! Transformations applied one after the other that cannot be written as one: the relations of all of them together, of which what
//! lies between them is unknown too.
//!
//! In: their laws. Out: a [`PhaseMap`], whose M is the product of theirs, by the chain rule. Never here: whether it is canonical.
//! Source: *The Principles of Dynamics*, § 3.2.

use std::collections::HashMap;
use std::ops::Range;

use super::canonical::PhaseMap;
use super::equations::ImplicitMap;
use super::group::in_order;
use super::nearest_image::Linearized;
use super::valuation::Valuation;
use crate::expr::{Expr, Pool, Symbol};
use crate::model::{ChainPart, Model, Transformation};

/// Where among all unknowns of maps one after the other, each of so many variables, those are that a part gives: the last one gives
/// the new variables, which come first.
pub(super) fn image_of_part(part: usize, count: usize, size: usize) -> Range<usize> {
    let place = if part + 1 == count { 0 } else { part + 1 };
    place * size..(place + 1) * size
}

impl PhaseMap {
    /// The relations of several transformations one after the other.
    pub(super) fn chain(
        pool: &mut Pool,
        model: &Model,
        given: &Transformation,
        parts: &[ChainPart],
    ) -> PhaseMap {
        let positions = model.coordinates.iter().map(|c| c.position);
        let old: Vec<Symbol> =
            positions.chain(model.coordinates.iter().map(|c| c.momentum)).collect();
        let mut between: Vec<Symbol> = Vec::new();
        let mut new = in_order(&given.new);
        let (mut relations, mut rate) = (Vec::new(), Some(Expr::ZERO));
        let mut maps = Vec::new();
        let mut from = old.clone();
        for (k, ChainPart { of, inverted }) in parts.iter().enumerate() {
            let map = PhaseMap::relations(pool, model, of);
            let to: Vec<Symbol> = if k + 1 == parts.len() {
                new.clone()
            } else {
                let name = |i: usize| format!("{i} of `{}` after {} parts", given.name, k + 1);
                let all: Vec<Symbol> = (0..old.len()).map(|i| pool.symbol(&name(i))).collect();
                between.extend(&all);
                all
            };
            let [theirs, images] = if *inverted { [&to, &from] } else { [&from, &to] };
            let mut put: HashMap<Symbol, Expr> = HashMap::new();
            for (symbols, by) in [(&map.old, theirs), (&map.implicit.new, images)] {
                for (&symbol, &by) in symbols.iter().zip(by) {
                    put.insert(symbol, pool.variable(by));
                }
            }
            relations.extend(map.implicit.relations.iter().map(|&e| pool.substitute(e, &put)));
            let own = match map.function_rate {
                Some(own) => Some(own),
                None => map.rate_of_explicit(pool, model.symbols.time).ok(),
            };
            // K = c H + R, with the H that the parts before have given
            let valence = map.proved_valence(pool);
            rate = rate.zip(own).zip(valence).map(|((before, own), valence)| {
                let own = pool.substitute(own, &put);
                if *inverted {
                    let difference = pool.sub(before, own);
                    pool.div(difference, valence)
                } else {
                    let before = pool.mul(valence, before);
                    pool.add(before, own)
                }
            });
            maps.push((map, *inverted));
            from = to;
        }
        new.extend(between);
        let mut jacobian = |of: &[Symbol]| -> Vec<Vec<Expr>> {
            let row = |pool: &mut Pool, e| of.iter().map(|&s| pool.derivative(e, s)).collect();
            relations.iter().map(|&e| row(pool, e)).collect()
        };
        let (by_new, by_old) = (jacobian(&new), jacobian(&old));
        PhaseMap {
            name: given.name.clone(),
            old,
            implicit: ImplicitMap { new, relations, by_new, own: Vec::new() },
            function_rate: rate,
            forwards: None,
            near_identity: Vec::new(),
            parts: maps,
            by_old,
        }
    }

    /// A point with its image under one part after the other.
    pub(super) fn image_by_parts(&self, pool: &Pool, point: &Valuation) -> Option<Valuation> {
        let (count, size) = (self.parts.len(), self.old.len());
        let mut at = point.clone();
        let mut from: Vec<f64> = self.old.iter().map(|&s| point.at(s)).collect();
        for part in 0..count {
            let rows = part * size..(part + 1) * size;
            let columns = image_of_part(part, count, size);
            let own_rows = &self.implicit.by_new[rows.clone()];
            let own = ImplicitMap {
                new: self.implicit.new[columns.clone()].to_vec(),
                relations: self.implicit.relations[rows].to_vec(),
                by_new: own_rows.iter().map(|row| row[columns.clone()].to_vec()).collect(),
                own: Vec::new(),
            };
            // a part near a linear map is solved from the image under that
            let by_old = if part == 0 {
                self.by_old[..size].to_vec()
            } else {
                let before = image_of_part(part - 1, count, size);
                own_rows.iter().map(|row| row[before.clone()].to_vec()).collect()
            };
            let symbols = if part == 0 {
                &self.old[..]
            } else {
                &self.implicit.new[image_of_part(part - 1, count, size)]
            };
            let linearized = Linearized {
                relations: own.relations.clone(),
                by_old,
                by_new: own.by_new.clone(),
                old: symbols,
                new: &own.new,
            };
            let first = linearized.image(pool, &at).unwrap_or(from);
            at = own.search(pool, &at, first)?;
            from = own.new.iter().map(|&s| at.at(s)).collect();
        }
        Some(at)
    }
}
