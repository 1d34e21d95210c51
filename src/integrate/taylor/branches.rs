//! Branches of roots: a series follows √a through a zero of a to where it would be negative, while
//! the true root turns back. This module locates such points, and checks whether a step has left
//! the intended branch.

use super::super::roots::{first_crossing, refined, value_and_slope};
use super::last_orders::{BEFORE, FAINT, LAST};
use crate::num::{
    DoubleDouble, FourLaneKernel, FourLanes, LANES, in_four_lanes, padded, square_root,
};
use crate::system::{ExactRates, Series};

/// A root this small relative to the terms of its series is zero; the rest is rounding.
const ZERO: f64 = 3e-15;

/// The tolerated deviation of a root from its series at the end of a step, relative to its largest
/// term.
const STRAYED: f64 = 1e-6;

/// The terms after the first may be this part of it where a series keeps off zero; the rest is for what is truncated.
const OFF_ZERO: f64 = 0.9;

/// A root whose values along a step stay above this part of their largest does not pass zero.
const CLEAR: f64 = 0.2;

/// A root that passes zero.
pub(super) struct Passing {
    guard: usize,
    /// The time after the series' origin, in its unit.
    pub(super) after: DoubleDouble,
}

impl Passing {
    /// The same at another time.
    pub(super) fn at(&self, after: DoubleDouble) -> Passing {
        Passing { guard: self.guard, after }
    }
}

/// The first of the other roots that passes zero behind one, and before `end`.
pub(super) fn first_behind(series: &Series, one: &Passing, end: f64) -> Option<Passing> {
    let passes_behind = |guard: usize| {
        let after = polish(series, guard, passes(series.guard(guard), end)?);
        (after.high > one.after.high).then_some(Passing { guard, after })
    };
    let others = (0..series.guards()).filter(|&i| i != one.guard && series.guard_passes(i));
    let found = others.filter_map(passes_behind);
    found.min_by(|a, b| a.after.high.total_cmp(&b.after.high))
}

/// The first root that passes zero before `end`.
pub(super) fn first(series: &Series, end: f64) -> Option<Passing> {
    let mut found: Option<(usize, f64)> = None;
    for i in (0..series.guards()).filter(|&i| series.guard_passes(i)) {
        let end = found.map_or(end, |(_, x)| x);
        if let Some(x) = passes(series.guard(i), end) {
            found = Some((i, x));
        }
    }
    let (guard, x) = found?;
    Some(Passing { guard, after: polish(series, guard, x) })
}

/// The first zero of the argument of a power whose square root is followed beyond the step that the
/// series allows, as an extrapolation to a point very close.
pub(super) fn predicted(series: &Series, end: f64) -> Option<f64> {
    let mut first: Option<f64> = None;
    let powers = (0..series.guards()).filter(|&i| !series.guard_passes(i));
    for under in powers.filter_map(|i| series.guard_under(i)) {
        let end = first.unwrap_or(end);
        if let Some(x) = passes(&square_root(under), end) {
            first = Some(x);
        }
    }
    first
}

/// Whether the root that passes is exactly zero at a state where the rates have been evaluated, and
/// does not only come near. Its change in the time `within` counts as zero.
pub(super) fn is_exact(
    series: &Series,
    passing: &Passing,
    rates: &ExactRates,
    within: f64,
) -> bool {
    let (coefficients, after) = (series.guard(passing.guard), passing.after.high);
    let size = largest_term(coefficients, after);
    let (_, slope) = value_and_slope(coefficients, after);
    let value = rates.guard(passing.guard);
    value.is_nan() || is_zero(value, size, slope * within)
}

/// Whether a root is zero, beside terms of this size and its change in a time that does not count.
fn is_zero(value: f64, size: f64, change: f64) -> bool {
    value <= (ZERO * size).max(change.abs())
}

/// Whether some root may deviate from its series a time `after` the origin, in its unit: its argument may come to zero
/// before.
pub(super) fn may_stray(series: &Series, after: f64) -> bool {
    (0..series.guards()).filter(|&i| series.guard_has_branches(i)).any(|i| {
        series.guard_argument(i).is_none_or(|argument| !keeps_off_zero(argument, after.abs()))
    })
}

/// Whether a series surely has no zero up to this distance from the origin, in any direction of the complex plane: all its
/// other terms together are less than the first. A root of it is the same branch there. Nothing is known of a series whose
/// last terms vanish, which may end before its first.
fn keeps_off_zero(c: &[f64], distance: f64) -> bool {
    let Some(own) = c.first().map(|c| c.abs()) else { return false };
    let ends = c.iter().skip(1).rev().take(LAST + BEFORE).all(|c| c.abs() < FAINT);
    if ends || own < FAINT {
        return false;
    }
    in_four_lanes(OtherTerms { c, distance }) < OFF_ZERO * own
}

/// The sizes of all terms but the first at a distance, summed.
struct OtherTerms<'a> {
    c: &'a [f64],
    distance: f64,
}

impl FourLaneKernel for OtherTerms<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<L: FourLanes, const FUSED: bool>(self, lanes: L) -> f64 {
        let OtherTerms { c, distance } = self;
        let square = distance * distance;
        // four sums side by side, each in powers of the fourth power
        let fourth = lanes.splat(square * square);
        let (chunks, rest) = c.as_chunks::<LANES>();
        let mut sums = lanes.abs(lanes.from_array(padded(rest, 0.0)));
        for i in (0..chunks.len()).rev() {
            sums = lanes.add(lanes.mul(sums, fourth), lanes.abs(lanes.from_array(chunks[i])));
        }
        let [zeroth, first, second, third] = lanes.to_array(sums);
        let own = c[0].abs();
        (zeroth - own) + distance * first + square * (second + distance * third)
    }
}

/// Whether some root deviates from its series a time `after` the origin, in its unit, at a state
/// where the rates have been evaluated.
pub(super) fn strayed(series: &Series, after: f64, rates: &ExactRates) -> bool {
    (0..series.guards()).filter(|&i| series.guard_has_branches(i)).any(|i| {
        let coefficients = series.guard(i);
        let (predicted, _) = value_and_slope(coefficients, after);
        let size = largest_term(coefficients, after);
        let value = rates.guard(i);
        // a NaN has strayed
        let agrees = (value - predicted).abs() <= STRAYED * size.max(value.abs());
        predicted.is_finite() && !agrees
    })
}

fn largest_term(coefficients: &[f64], x: f64) -> f64 {
    let powers = std::iter::successors(Some(1.0), |power| Some(power * x));
    coefficients.iter().zip(powers).fold(0.0, |m: f64, (c, power)| m.max((c * power).abs()))
}

/// The point where a root becomes negative, if it does.
fn passes(root: &[f64], end: f64) -> Option<f64> {
    if root[0].is_nan() || root[0] <= 0.0 {
        return None;
    }
    let (mut least, mut most) = (root[0], root[0]);
    for part in [0.25, 0.5, 0.75, 1.0] {
        let (value, _) = value_and_slope(root, part * end);
        least = least.min(value);
        most = most.max(value);
    }
    if least > CLEAR * most { None } else { first_crossing(root, end) }
}

/// Refines a zero to the precision of the series' lowest orders.
fn polish(series: &Series, guard: usize, x: f64) -> DoubleDouble {
    refined(series.guard(guard), x, |x| series.guard_after(guard, x))
}

#[cfg(test)]
mod tests {
    use super::{is_zero, keeps_off_zero, passes};
    use crate::num::math;

    #[test]
    fn a_series_keeps_off_zero_where_its_other_terms_are_below_nine_tenths_of_the_first() {
        // 1/(1 − t/2): the others are the first at t = 1, and nine tenths of it at 18/19
        let geometric: Vec<f64> = (0..60).map(|k| math::powi(0.5, k)).collect();
        assert!(keeps_off_zero(&geometric, 18.0 / 19.0 - 1e-9));
        assert!(!keeps_off_zero(&geometric, 18.0 / 19.0 + 1e-9));
        // of any length and sign: 1 − t − t² − …
        for length in 2..12 {
            let c: Vec<f64> = (0..length).map(|k| if k == 0 { 1.0 } else { -1.0 }).collect();
            let others = |t: f64| (1..length).map(|k| math::powi(t, k)).sum::<f64>();
            for t in [0.1, 0.3, 0.45, 0.5, 0.6, 0.89, 0.91] {
                assert_eq!(keeps_off_zero(&c, t), others(t) < 0.9, "{length} {t}");
            }
        }
        // one that may go on where it is not known, or has lost digits, does not, nor what is not finite, or nothing
        let ending: Vec<f64> =
            (0..28).map(|k| if k < 18 { math::powi(0.1, k) } else { 0.0 }).collect();
        assert!(!keeps_off_zero(&ending, 0.5) && keeps_off_zero(&ending[..27], 0.5));
        assert!(!keeps_off_zero(&[1e-291, 1e-292], 0.1) && keeps_off_zero(&[1e-289, 1e-290], 0.1));
        assert!(!keeps_off_zero(&[1.0, f64::NAN], 0.1));
        assert!(!keeps_off_zero(&[0.0, 0.0], 0.1));
        assert!(!keeps_off_zero(&[], 0.1));
    }

    #[test]
    fn a_root_is_zero_to_the_rounding_of_its_terms_or_within_the_time_that_does_not_count() {
        for (value, size, change, zero) in [
            (0.0, 0.0, 0.0, true),
            (2.9e-15, 1.0, 0.0, true),
            (3.1e-15, 1.0, 0.0, false),
            (2.9e-5, 1e10, 0.0, true),
            (3.1e-5, 1e10, 0.0, false),
            (0.9e-7, 1.0, -1e-7, true),
            (1.1e-7, 1.0, 1e-7, false),
        ] {
            assert_eq!(is_zero(value, size, change), zero, "{value:e} of {size:e}, {change:e}");
        }
    }

    #[test]
    fn a_root_that_stays_above_a_fifth_of_its_largest_is_not_searched() {
        // 1 − 4 d t (1 − t) has its least value 1 − d at ½, where one of the samples is; a root
        // just beside a sample is found where the values fall below a fifth
        let dips = |d: f64| passes(&[1.0, -4.0 * d, 4.0 * d], 1.0).is_some();
        assert!(dips(1.01));
        assert!(!dips(0.99));
        // 1 − t/e meets zero at e: sampled up to 1 and up to 0.79 of it
        let falls = |e: f64, least: f64| passes(&[1.0, -1.0 / e], least).is_some();
        assert!(falls(0.99, 1.0));
        // a narrow dip between two samples, whose values there are 0.19 and 0.21 of the largest
        let narrow = |at: f64| {
            // (t − 0.375)² / w² − ε, above zero at 0.25 and 0.5
            let (w, e) = (0.125 / (at + 1e-3_f64).sqrt(), 1e-3);
            let c = 1.0 / (w * w);
            passes(&[c * 0.375 * 0.375 - e, -0.75 * c, c], 1.0).is_some()
        };
        assert!(narrow(0.1));
    }
}
