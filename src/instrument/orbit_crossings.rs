//! Where a periodic orbit crosses the surfaces of section of a file.
//!
//! In: an orbit that was closed. Out: its [`PeriodicPoints`]. Never here: how it is closed, what is drawn.

use super::{PeriodicPoints, Physics};
use crate::dynamics::Orbit;
use crate::ensemble::{SectionPlan, crossings_from};
use crate::integrate::Method;

/// An orbit is followed for its period and this part of it, so that a crossing at which it begins is found at its end.
const BEYOND: f64 = 1e-6;

/// Follows an orbit once around for each surface of the file.
pub(super) fn periodic_points(
    physics: Physics<'_>,
    method: &'static Method,
    orbit: &Orbit,
    parameters: &[f64],
) -> PeriodicPoints {
    let surface = |section: usize| {
        let plan = SectionPlan {
            event: physics.model.event_of_section(section),
            count: None,
            until: Some(orbit.state.time + orbit.period * (1.0 + BEYOND)),
            idle: 0,
            all_channels: true,
        };
        let method = (method, orbit.settings);
        let found = crossings_from(physics.system, method, &orbit.state, parameters, &plan).rows;
        once_around(found, orbit.period)
    };
    PeriodicPoints {
        parameters: parameters.to_vec(),
        energy: orbit.energy,
        stable: orbit.is_stable(),
        surfaces: (0..physics.model.sections.len()).map(surface).collect(),
    }
}

/// The crossings of one period, without the last where it is the first one again.
fn once_around(mut rows: Vec<Vec<f64>>, period: f64) -> Vec<Vec<f64>> {
    if let [first, .., last] = &rows[..]
        && last[0] - first[0] >= (1.0 - BEYOND) * period
    {
        rows.pop();
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A period later it is the same crossing, however its time is rounded; a little before it is another one.
    #[test]
    fn a_crossing_is_the_first_one_again_to_a_millionth_of_the_period() {
        let count = |last: f64| once_around(vec![vec![0.5], vec![1.0], vec![last]], 2.0).len();
        for (early, found) in [(-1e-7, 2), (0.0, 2), (0.9e-6, 2), (1.1e-6, 3), (1e-3, 3)] {
            assert_eq!(count(0.5 + 2.0 * (1.0 - early)), found, "{early}");
        }
        assert_eq!(once_around(vec![vec![0.5]], 2.0).len(), 1);
    }
}
