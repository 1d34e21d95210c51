//! How two new variables depend on the old ones: what of their map is written, and what is solved for.
//!
//! In: equations. Out: facts of the map. Never here: grids, drawing.

use crate::expr::Symbol;
use crate::mechanics::{Equations, ImplicitMap};
use crate::model::Model;

/// The map of two new variables, if it is known by relations only.
pub(super) fn implicit(equations: &Equations, new: [Symbol; 2]) -> Option<&ImplicitMap> {
    let maps = equations.supplements.maps.implicit.iter();
    maps.map(|(map, _)| map).find(|map| map.new.contains(&new[0]))
}

/// Whether two new variables of a transformation are others at another time.
pub(super) fn depends_on_time(
    equations: &Equations,
    model: &Model,
    (place, new): (Option<usize>, [Symbol; 2]),
) -> bool {
    let known = place.and_then(|place| equations.supplements.maps.written.get(place));
    let forwards = known.and_then(Option::as_ref).into_iter().flatten();
    let written = forwards.filter(|(s, _)| new.contains(s)).map(|(_, e)| *e);
    let relations = implicit(equations, new).into_iter().flat_map(|map| &map.relations);
    let mut all = written.chain(relations.copied());
    all.any(|e| equations.pool.depends(e, model.symbols.time))
}
