//! The surface on which constraints hold the coordinates, at one place.
//!
//! In: a state near it. Out: how far the state is from the surface of each holonomic constraint, and the row A of every
//! constraint that is enforced. Never here: motions, and what holds elsewhere on the surface.

use super::State;
use super::projector::ConstraintProjector;

/// One constraint A q̇ + A₀ = 0 at one place.
#[derive(Clone, Debug)]
pub struct SurfaceRow {
    /// A.
    pub row: Vec<f64>,
    /// A₀: what velocities it asks for where nothing else moves.
    pub rate: f64,
    /// How far the state is from its surface, f less its level, whose derivatives are A; `None` of a constraint that is not
    /// holonomic.
    pub distance: Option<f64>,
}

impl ConstraintProjector {
    /// The constraints that are enforced, at a state. What a constraint on the velocities keeps constant has the level that was
    /// taken last ([`ConstraintProjector::take_levels`]).
    pub fn surface(&mut self, state: &State) -> Vec<SurfaceRow> {
        self.load(state);
        let enforced = self.enforced();
        let degrees = self.numbers.len() / 2;
        let conditions = self.projection.conditions();
        conditions.observe(state.exact_time(), &self.numbers);
        let rows = enforced.into_iter().map(|(k, holonomic)| SurfaceRow {
            row: (0..degrees).map(|i| conditions.entry(k, i).high).collect(),
            rate: conditions.rate(k).high,
            distance: holonomic.then(|| conditions.position(k).value.high),
        });
        rows.collect()
    }
}
