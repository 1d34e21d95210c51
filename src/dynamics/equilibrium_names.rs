//! The names of equilibria: those that the file gives, by the places near which it says they are.
//!
//! In: equilibria, the names of the model. Out: each with its name, if it has one. Never here: how they are found.

use super::equilibrium::Equilibrium;
use crate::mechanics::Valuation;
use crate::model::Model;
use crate::num::math;

/// A place of one name alone is that of an equilibrium up to this part of what is as far as the place or the equilibrium, and of
/// a period up to half as much.
const ALONE: f64 = 0.5;

/// Rounding, as a part of where the motion begins.
const ROUNDING: f64 = 1e-7;

/// Gives equilibria the names of the file. A name belongs to the equilibrium nearest to its place, provided that this is
/// nearer than halfway to the place of any other name. A name that has no other beside it needs an equilibrium nearer
/// than halfway to the next equilibrium, and not far away. Coordinates with a period are compared within it.
pub fn name_equilibria(model: &Model, parameters: &[f64], found: &mut [Equilibrium]) {
    let known = Valuation::of_parameters(model, parameters);
    let value = |e| known.value(&model.pool, e);
    let places: Vec<Vec<(usize, f64)>> = (model.equilibria.iter())
        .map(|one| one.near.iter().map(|&(i, e)| (i, value(e))).collect())
        .collect();
    let periods: Vec<Option<f64>> = model.coordinates.iter().map(|c| c.period.map(value)).collect();
    let apart = |i: usize, a: f64, b: f64| match periods.get(i).copied().flatten() {
        Some(period) => a - b - period * ((a - b) / period).round(),
        None => a - b,
    };
    let away = |place: &[(usize, f64)], one: &Equilibrium| {
        let parts = place
            .iter()
            .map(|&(i, x)| one.variables.get(i).map_or(f64::INFINITY, |&at| apart(i, at, x)));
        parts.fold(0.0, math::hypot)
    };
    // as far as they name the same variables
    let between = |a: &[(usize, f64)], b: &[(usize, f64)]| {
        let both = a.iter().filter_map(|&(i, x)| Some((i, x, b.iter().find(|(j, _)| *j == i)?.1)));
        both.map(|(i, x, y)| apart(i, x, y)).fold(0.0, math::hypot)
    };
    let least = |distances: &mut dyn Iterator<Item = (usize, f64)>| {
        let known = distances.filter(|(_, distance)| distance.is_finite());
        known.min_by(|a, b| a.1.total_cmp(&b.1))
    };
    let initial: Vec<f64> = model.coordinates.iter().map(|c| value(c.initial)).collect();
    let is_near = |place: &[(usize, f64)], one: &Equilibrium| {
        let [mut distance, mut from, mut to, mut begun] = [0.0; 4];
        for &(i, x) in place {
            let Some(&at) = one.variables.get(i) else { return false };
            match periods.get(i).copied().flatten() {
                Some(period) if apart(i, at, x).abs() > 0.5 * ALONE * period.abs() => return false,
                Some(_) => {}
                None => {
                    distance = math::hypot(distance, at - x);
                    (from, to) = (math::hypot(from, x), math::hypot(to, at));
                    begun = math::hypot(begun, initial.get(i).copied().unwrap_or(0.0));
                }
            }
        }
        distance <= (ALONE * f64::max(from, to)).max(ROUNDING * begun)
    };
    for (name, place) in places.iter().enumerate() {
        let nearest = least(&mut found.iter().map(|one| away(place, one)).enumerate());
        let Some((nearest, distance)) = nearest else { continue };
        let own = least(&mut places.iter().map(|other| away(other, &found[nearest])).enumerate());
        let others = places.iter().enumerate().filter(|(other, _)| *other != name);
        let halfway = others.map(|(_, other)| 0.5 * between(place, other)).filter(|d| *d > 0.0);
        let halfway = halfway.fold(f64::INFINITY, f64::min);
        let clear = if halfway.is_finite() {
            halfway > distance
        } else {
            let rest = found.iter().enumerate().filter(|(other, _)| *other != nearest);
            let next = rest.map(|(_, one)| away(place, one)).fold(f64::INFINITY, f64::min);
            0.5 * next > distance && is_near(place, &found[nearest])
        };
        if own.is_some_and(|(own, _)| own == name) && clear {
            found[nearest].name.clone_from(&model.equilibria[name].name);
        }
    }
}
