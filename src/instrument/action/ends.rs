//! What is said of how Hamilton's action changes with the ends of a motion: ∂S/∂q = p, ∂S/∂t = −H, with the other sign at the start.
//!
//! In: the slopes, and p and H. Out: lines of the legend. Never here: how the slopes are found (`dynamics`).
//! Source: *The Principles of Dynamics*, § 3.5.

use crate::dynamics::EndSlope;
use crate::num::significant;

/// The slopes of the action at the start and now are p and H if they are apart by no more than so many times what is
/// known of their integrals.
const TIMES: f64 = 16.0;

/// The slopes are nearly p and H if they are apart by less than this part of the size of what is added up: a method
/// that is not exact leaves more.
const NEAR: f64 = 1e-6;

/// They are nearly so as well if they are apart by no more than so many times what the method is wrong by, up to this
/// part of the size.
const OF_METHOD: f64 = 4.0;
const NEAR_BY_METHOD: f64 = 1e-2;

/// How a slope and what it should be compare: the sizes of its terms, the error of its integral, and that of the method.
fn sign([slope, expected]: [f64; 2], size: f64, [error, of_method]: [f64; 2]) -> &'static str {
    let off = (slope - expected).abs();
    let size = size.max(expected.abs());
    if off <= TIMES * error {
        "="
    } else if off <= NEAR * size || off <= (OF_METHOD * of_method).min(NEAR_BY_METHOD * size) {
        "≈"
    } else {
        "≠"
    }
}

/// How the action changes with its ends: now with the numbers, at the start whether it is as it should be.
pub(super) fn by_its_ends(
    [start, now]: &[EndSlope; 2],
    [of_momentum, of_energy]: [f64; 2],
    name: &str,
) -> Vec<String> {
    let short = |x: f64| significant(x, 3, 1e-3..1e5).replace('-', "−");
    vec![
        format!(
            "∂S/∂{name} = {} {} p, ∂S/∂t = {} {} −H",
            short(now.by_position),
            sign([now.by_position, now.momentum], now.sizes[0], [now.errors[0], of_momentum]),
            short(now.by_time),
            sign([now.by_time, -now.energy], now.sizes[1], [now.errors[1], of_energy])
        ),
        format!(
            "at the start ∂S/∂{name} {} −p, ∂S/∂t {} H",
            sign(
                [start.by_position, -start.momentum],
                start.sizes[0],
                [start.errors[0], of_momentum]
            ),
            sign([start.by_time, start.energy], start.sizes[1], [start.errors[1], of_energy])
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of terms of size 2 whose integral is known to 1e-12: a momentum that is off by 1e-7 is not said to be equal.
    #[test]
    fn what_is_equal_follows_what_the_integral_reaches() {
        let of = |off: f64, error| sign([1.0 + off, 1.0], 2.0, [error, 0.0]);
        for (off, error, word) in [
            (1.5e-11, 1e-12, "="),
            (1.7e-11, 1e-12, "≈"),
            (1e-7, 1e-12, "≈"),
            (1.9e-6, 1e-12, "≈"),
            (2.1e-6, 1e-12, "≠"),
            (1.5e-8, 1e-9, "="),
            (1.7e-8, 1e-9, "≈"),
            (f64::NAN, 1e-12, "≠"),
        ] {
            assert_eq!(of(off, error), word, "{off} {error}");
            assert_eq!(of(-off, error), word, "{off} {error}");
        }
    }
}
