//! Adjustable values: parameters and initial values, and their steps.
//!
//! In: a value and its range. Out: the value one step further. Never here: the lab, the list on the screen, or the
//! command that sets a value.

use crate::expr::Expr;
use crate::model::RangeSpacing;
use crate::num::{math, rounded};

/// One value that can be changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ValueId {
    /// The parameter of this index.
    Parameter(usize),
    /// The initial value of this index: coordinates first, then velocities or momenta.
    Initial(usize),
}

/// The description of a value.
#[derive(Clone, Debug, PartialEq)]
pub struct ValueInfo {
    /// The name as written: `theta0`.
    pub name: String,
    /// The name as shown: `θ₀`.
    pub shown: String,
    /// The unit, empty if unknown.
    pub unit: String,
    /// What it means, in words.
    pub about: String,
    /// The range of its slider, if it has one.
    pub range: Option<(f64, f64, RangeSpacing)>,
    /// Whether it changes with the time by itself.
    pub ramped: bool,
    /// What an initial value is in the file, where it follows parameters and was not changed.
    pub follows: Option<Expr>,
}

/// Moves a value by `sign · times` fine steps. About 200 of them make up the range or, without one, the value's
/// magnitude, which counts as at least 1.
pub(super) fn step(
    value: f64,
    range: Option<(f64, f64, RangeSpacing)>,
    sign: f64,
    times: f64,
) -> f64 {
    match range {
        Some((min, max, RangeSpacing::Log)) if min > 0.0 && value > 0.0 => {
            let factor = math::powf(max / min, times / 200.0);
            let moved = rounded(value * math::powf(factor, sign), 4);
            within(moved, value, min, max)
        }
        Some((min, max, _)) => {
            let fine = nice_step((max - min) / 200.0);
            within(rounded(value + sign * times * fine, 12), value, min, max)
        }
        None => {
            let fine = nice_step(value.abs().max(1.0) / 200.0);
            rounded(value + sign * times * fine, 12)
        }
    }
}

/// Clamps `moved` to the range; a typed value beyond the range may come nearer to it, but never moves farther away.
fn within(moved: f64, value: f64, min: f64, max: f64) -> f64 {
    moved.clamp(min.min(value), max.max(value))
}

/// Returns the nearest of 1, 2, 5 times a power of ten that exceeds `length` by at most a half.
pub(super) fn nice_step(length: f64) -> f64 {
    if !length.is_finite() || length <= 0.0 {
        return 1.0;
    }
    let power = math::powf(10.0, math::log10(length).floor());
    let digit = [1.0, 2.0, 5.0, 10.0].into_iter().rfind(|d| d * power <= length * 1.5);
    rounded(digit.unwrap_or(1.0) * power, 3)
}
