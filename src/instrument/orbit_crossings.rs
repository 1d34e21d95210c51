//! Where a periodic orbit crosses the surfaces of section of a file.
//!
//! In: an orbit that was closed. Out: its [`PeriodicPoints`]. Never here: how it is closed, what is drawn.

use super::{PeriodicPoints, Physics};
use crate::dynamics::Orbit;
use crate::ensemble::{SectionPlan, crossings_from};
use crate::integrate::Method;
use crate::model::Event;

/// An orbit is followed for its period and this part of it, so that a crossing at which it begins is found at its end.
const BEYOND: f64 = 1e-6;

/// Follows an orbit once around for each surface of the file.
pub(super) fn periodic_points(
    physics: Physics<'_>,
    method: &'static Method,
    orbit: &Orbit,
    parameters: &[f64],
) -> PeriodicPoints {
    let surface = |event: &Event| {
        let plan = SectionPlan {
            event: event.name.clone(),
            count: None,
            until: Some(orbit.state.time + orbit.period * (1.0 + BEYOND)),
            idle: 0,
            all_channels: true,
        };
        let method = (method, orbit.settings);
        let mut found =
            crossings_from(physics.system, method, &orbit.state, parameters, &plan).rows;
        // the first one again
        let round = (1.0 - BEYOND) * orbit.period;
        let is_closed = match &found[..] {
            [first, .., last] => last[0] - first[0] >= round,
            _ => false,
        };
        if is_closed {
            found.pop();
        }
        found
    };
    PeriodicPoints {
        parameters: parameters.to_vec(),
        energy: orbit.energy,
        stable: orbit.is_stable(),
        surfaces: physics.model.sections.iter().map(surface).collect(),
    }
}
