//! What is said of how Hamilton's action changes with the ends of a motion: ∂S/∂q = p, ∂S/∂t = −H, with the other sign at the start.
//!
//! In: the slopes, and p and H. Out: lines of the legend. Never here: how the slopes are found (`dynamics`).
//! Source: *The Principles of Dynamics*, § 3.5.

use crate::dynamics::EndSlope;
use crate::num::significant;

/// The slopes of the action at the start and now agree with p and H if they are apart by less than this part of the size of
/// what is added up to them.
const AGREES: f64 = 1e-6;

/// How the action changes with its ends: now with the numbers, at the start whether it is as it should be.
pub(super) fn by_its_ends([start, now]: &[EndSlope; 2], name: &str) -> Vec<String> {
    let short = |x: f64| significant(x, 3, 1e-3..1e5).replace('-', "−");
    let sign = |slope: f64, expected: f64, size: f64| {
        if (slope - expected).abs() <= AGREES * size.max(expected.abs()) { "=" } else { "≠" }
    };
    vec![
        format!(
            "∂S/∂{name} = {} {} p, ∂S/∂t = {} {} −H",
            short(now.by_position),
            sign(now.by_position, now.momentum, now.sizes[0]),
            short(now.by_time),
            sign(now.by_time, -now.energy, now.sizes[1])
        ),
        format!(
            "at the start {} −p, {} H",
            sign(start.by_position, -start.momentum, start.sizes[0]),
            sign(start.by_time, start.energy, start.sizes[1])
        ),
    ]
}
