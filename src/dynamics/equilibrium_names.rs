//! The names of equilibria: those that the file gives, by the places near which it says they are.
//!
//! In: equilibria, the names of the model. Out: each with its name, if it has one. Never here: how they are found.

use super::equilibrium::Equilibrium;
use crate::mechanics::Valuation;
use crate::model::Model;
use crate::num::math;

/// Names the equilibria that are nearest to the places of names, each of which is nearest to its own: of those that are missing
/// no other gets the name.
pub fn name_equilibria(model: &Model, parameters: &[f64], found: &mut [Equilibrium]) {
    let known = Valuation::of_parameters(model, parameters);
    let places: Vec<Vec<(usize, f64)>> = (model.equilibria.iter())
        .map(|one| one.near.iter().map(|&(i, e)| (i, known.value(&model.pool, e))).collect())
        .collect();
    let away = |place: &[(usize, f64)], one: &Equilibrium| {
        let apart =
            place.iter().map(|&(i, x)| one.variables.get(i).map_or(f64::INFINITY, |at| at - x));
        apart.fold(0.0, math::hypot)
    };
    let least = |distances: &mut dyn Iterator<Item = (usize, f64)>| {
        let known = distances.filter(|(_, distance)| distance.is_finite());
        known.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, _)| index)
    };
    for (name, place) in places.iter().enumerate() {
        let nearest = least(&mut found.iter().map(|one| away(place, one)).enumerate());
        let Some(nearest) = nearest else { continue };
        let own = least(&mut places.iter().map(|other| away(other, &found[nearest])).enumerate());
        if own == Some(name) {
            found[nearest].name.clone_from(&model.equilibria[name].name);
        }
    }
}
