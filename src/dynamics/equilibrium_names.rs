//! The names of equilibria: those that the file gives, by the places near which it says they are.
//!
//! In: equilibria, the names of the model. Out: each with its name, if it has one. Never here: how they are found.

use super::equilibrium::Equilibrium;
use crate::mechanics::Valuation;
use crate::model::Model;
use crate::num::math;

/// Names the equilibria that are nearest to the places of names, each of which is nearest to its own and nearer than halfway to
/// another place: of those that are missing no other gets the name. Coordinates with a period are compared within it.
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
    for (name, place) in places.iter().enumerate() {
        let nearest = least(&mut found.iter().map(|one| away(place, one)).enumerate());
        let Some((nearest, distance)) = nearest else { continue };
        let own = least(&mut places.iter().map(|other| away(other, &found[nearest])).enumerate());
        let others = places.iter().enumerate().filter(|(other, _)| *other != name);
        let halfway = others.map(|(_, other)| 0.5 * between(place, other)).filter(|d| *d > 0.0);
        if own.is_some_and(|(own, _)| own == name)
            && halfway.fold(f64::INFINITY, f64::min) > distance
        {
            found[nearest].name.clone_from(&model.equilibria[name].name);
        }
    }
}
