//! Where multipliers lie with respect to the unit circle, as far as rounding of their matrix lets it be known.
//!
//! In: multipliers, what rounding leaves of their matrix. Out: on it, outside, or 1. Never here: what follows for an orbit.

use crate::num::math;

/// A multiplier this close to the unit circle lies on it.
pub(super) const ON_CIRCLE: f64 = 1e-6;

/// A multiplier farther from 1 is none, whatever rounding leaves of it.
const NEAR_ONE: f64 = 1e-5;

/// (μ − 1)² of a double multiplier 1 is rounding of the matrix, up to this many times.
const TIMES: f64 = 100.0;

/// Whether a multiplier is 1 as far as rounding of the matrix lets it be known: of a double one half of the digits are lost.
pub(super) fn is_one([re, im]: [f64; 2], rounding: f64) -> bool {
    math::hypot(re - 1.0, im) <= (TIMES * rounding).sqrt().min(NEAR_ONE)
}

/// Whether no multiplier lies outside the unit circle but by what rounding of the matrix makes of 1.
pub(super) fn none_is_outside(multipliers: &[[f64; 2]], rounding: f64) -> bool {
    multipliers.iter().all(|&z| !is_outside(z) || is_one(z, rounding))
}

/// Whether a multiplier lies outside the unit circle.
pub(super) fn is_outside([re, im]: [f64; 2]) -> bool {
    math::hypot(re, im) > 1.0 + ON_CIRCLE
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Those of a proton in crossed fields, all of which are 1: √(1.2e-11) = 3.4e-6.
    #[test]
    fn what_rounding_makes_of_one_is_not_outside() {
        let off = [1.000_001_721_803_657, 1.261_323_960_354_561e-7];
        let multipliers = [off, [off[0], -off[1]], [1.0, 0.0], [0.999_998_278_194_624_4, 0.0]];
        assert!(none_is_outside(&multipliers, 1.176e-11));
        assert!(!none_is_outside(&multipliers, 1e-15));
        assert!(!none_is_outside(&[[1.001, 0.0], [1.0 / 1.001, 0.0]], 1.176e-11));
    }
}
