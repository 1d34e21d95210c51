//! The speeds that keys step through: 1, 2, 5 times powers of ten, and unlimited.
//!
//! In: a speed in simulated seconds per second. Out: the next one. Never here: pacing.

use crate::num::math;

/// The slowest and the fastest limited speed, as powers of ten.
const ENDS: [i32; 2] = [-3, 3];

/// Returns the next faster speed; after the last one it is infinite.
pub(super) fn faster(speed: f64) -> f64 {
    steps().find(|step| *step > speed * (1.0 + 1e-9)).unwrap_or(f64::INFINITY)
}

/// Returns the next slower speed, or the slowest itself.
pub(super) fn slower(speed: f64) -> f64 {
    let slowest = math::powi(10.0, ENDS[0]);
    steps().filter(|step| *step < speed * (1.0 - 1e-9)).last().unwrap_or(slowest)
}

fn steps() -> impl Iterator<Item = f64> {
    let decade = |e: i32| {
        [1.0, 2.0, 5.0].map(|digit| {
            if e < 0 { digit / math::powi(10.0, -e) } else { digit * math::powi(10.0, e) }
        })
    };
    (ENDS[0]..ENDS[1]).flat_map(decade).chain([math::powi(10.0, ENDS[1])])
}
