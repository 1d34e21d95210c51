//! Which series keep their sign over a step, seen from the sizes of their terms alone.
//!
//! In: the coefficients of a function about the beginning of a step. Out: whether the first term outweighs all others of
//! the opposite sign together, and the truncated series represents the function. Never here: where a function changes its
//! sign.

use crate::num::{Analytic, BATCH, Batch, math};

/// The number of last orders that enter the estimate: those of even and of odd functions vanish in
/// turn.
pub(super) const LAST: usize = 3;

/// The argument of an exponential may change by this amount.
const FARTHEST_ARGUMENT: f64 = 3.0;

/// It may also change by this part of itself: far out in the tail nothing happens.
const PART_OF_ARGUMENT: f64 = 0.5;

/// The first term must outweigh the others by this part of it.
const MARGIN: f64 = 1e-3;

/// The first term must be more than this part of all terms, so that no rounding counts.
const LEAST: f64 = 1e-9;

/// Whether a series keeps the sign of its first term up to a time, in its unit, and represents its function up to a part
/// `cut_off` of it. May be false where it does.
pub(super) fn keeps_sign(c: &[f64], cut_off: f64, time: f64) -> bool {
    let (first, last) = (c[0].abs(), c.len() - LAST);
    let (mut against, mut all, mut largest, mut power) = (0.0, first, first, 1f64.copysign(c[0]));
    let mut represented = true;
    for (k, x) in c.iter().enumerate().skip(1) {
        power *= time;
        let term = x * power;
        let size = term.abs();
        represented &= k < last || size <= cut_off * largest;
        largest = f64::max(largest, size);
        all += size;
        against += size - term;
    }
    represented && 0.5 * against < (1.0 - MARGIN) * first && LEAST * all < first
}

/// The last two terms, if they are larger than the two before by more than this factor, rise to what comes after them.
const GROWING: f64 = 10.0;

/// Whether the last terms of a series at a time, in its unit, by which it is judged how far it represents its function, show
/// nothing of what comes after them: they vanish, or grow, as about a time near zero those of cos t⁴ do.
pub(super) fn shows_no_end(c: &[f64], time: f64) -> bool {
    let end = c.len();
    if c[end - LAST..].iter().all(|x| *x == 0.0) {
        return true;
    }
    // in units of the last power
    let largest = |orders: std::ops::Range<usize>| {
        let term = |k: usize| c[k].abs() / math::powi(time, (end - 1 - k) as i32);
        orders.map(term).fold(0.0, f64::max)
    };
    time.is_finite() && largest(end - 2..end) > GROWING * largest(end - 4..end - 2)
}

/// The opposite of [`shows_no_end`] in each lane: one or zero. To be inlined into a kernel.
#[inline(always)]
pub(super) fn shows_end(c: &[Batch], time: Batch) -> Batch {
    let end = c.len();
    let all = c[end - LAST..].iter().fold(Batch::ZERO, |sum, x| sum + x.abs());
    // in units of the lowest of these powers
    let (mut before, mut last, mut power) = (Batch::ZERO, Batch::ZERO, Batch::ONE);
    for x in &c[end - 4..end - 2] {
        before = before.larger(x.abs() * power);
        power = power * time;
    }
    for x in &c[end - 2..] {
        last = last.larger(x.abs() * power);
        power = power * time;
    }
    all.is_above(Batch::ZERO) * last.is_at_most(before * GROWING)
}

/// How far the argument of an exponential may change.
#[inline(always)]
pub(super) fn bound(argument: f64) -> f64 {
    0.5 * FARTHEST_ARGUMENT.max(PART_OF_ARGUMENT * argument.abs())
}

/// Whether the argument of an exponential stays in one range of its values up to a time.
pub(super) fn stays(c: &[f64], time: f64) -> bool {
    let bound = bound(c[0]);
    let powers = std::iter::successors(Some(time), |power| Some(power * time));
    c[1..].iter().zip(powers).all(|(x, power)| x.abs() * power <= bound)
}

/// [`keeps_sign`] in each lane: one or zero. To be inlined into a kernel.
#[inline(always)]
pub(super) fn signs_unchanged(c: &[Batch], cut_off: f64, time: Batch) -> Batch {
    let (first, last) = (c[0].abs(), c.len() - LAST);
    let (mut against, mut all, mut largest) = (Batch::ZERO, first, first);
    let mut power = c[0].where_below(0.0, -Batch::ONE, Batch::ONE);
    let mut represented = Batch::ONE;
    for (k, x) in c.iter().enumerate().skip(1) {
        power = power * time;
        let term = *x * power;
        let size = term.abs();
        if k >= last {
            represented = represented * size.is_at_most(largest * cut_off);
        }
        largest = largest.larger(size);
        all = all + size;
        against = against + (size - term);
    }
    let outweighs = (first * (1.0 - MARGIN)).is_above(against * 0.5);
    represented * outweighs * first.is_above(all * LEAST)
}

/// [`stays`] in each lane: one or zero. To be inlined into a kernel.
#[inline(always)]
pub(super) fn stay(c: &[Batch], time: Batch) -> Batch {
    let mut bounds = Batch::ZERO;
    for lane in 0..BATCH {
        bounds.0[lane] = bound(c[0].0[lane]);
    }
    let (mut power, mut all) = (Batch::ONE, Batch::ONE);
    for x in &c[1..] {
        power = power * time;
        all = all * (x.abs() * power).is_at_most(bounds);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUT_OFF: f64 = 1e-13;

    /// In one lane, and in all of them.
    fn both(c: &[f64], time: f64) -> [bool; 2] {
        let several: Vec<Batch> = c.iter().map(|&x| Batch::splat(x)).collect();
        let unchanged = signs_unchanged(&several, CUT_OFF, Batch::splat(time));
        [keeps_sign(c, CUT_OFF, time), unchanged == Batch::ONE]
    }

    #[test]
    fn the_first_term_must_outweigh_all_others_of_the_opposite_sign() {
        // 1 − x − x² changes its sign at 0.618
        let c = [1.0, -1.0, -1.0, 0.0, 0.0, 0.0];
        for (time, unchanged) in [(0.617, true), (0.619, false), (0.0, true), (f64::NAN, false)] {
            assert_eq!(both(&c, time), [unchanged; 2], "{time}");
            assert_eq!(both(&c.map(|c| -c), time), [unchanged; 2], "{time}");
        }
        // 1 + 5 x − x² moves away from zero, and 1 − 5 x + 9 x² only comes near it
        assert_eq!(both(&[1.0, 5.0, -1.0, 0.0, 0.0, 0.0], 0.9), [true; 2]);
        assert_eq!(both(&[1.0, -5.0, 9.0, 0.0, 0.0, 0.0], 0.9), [false; 2]);
        assert_eq!(both(&[0.0; 6], 1.0), [false; 2]);
        assert_eq!(both(&[1.0, f64::NAN, 0.0, 0.0, 0.0, 0.0], 0.1), [false; 2]);
    }

    #[test]
    fn last_terms_that_vanish_or_grow_show_no_end() {
        let even = [1.0, 0.0, -0.5, 0.0, 0.04, 0.0, -1e-3, 0.0, 2e-5];
        let cases = [
            (even, 1.0, false),
            // so far away its terms do not fall any more
            (even, 30.0, true),
            ([1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], 1.0, true),
            ([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-30, 1e-20], 1.0, true),
            // those of cos t⁴ a little after 0
            ([1.0, 1e3, 1e9, 1e20, 1e33, 1e-13, 1e-8, 1e-3, 1e2], 0.04, true),
            ([1.0; 9], 3.1, false),
            ([1.0; 9], 3.2, true),
        ];
        for (c, time, none) in cases {
            let several: Vec<Batch> = c.iter().map(|&x| Batch::splat(x)).collect();
            assert_eq!(shows_no_end(&c, time), none, "{c:?} at {time}");
            let ends = shows_end(&several, Batch::splat(time)) == Batch::ONE;
            assert_eq!(ends, !none, "{c:?} at {time} in lanes");
        }
    }

    #[test]
    fn a_first_term_that_may_be_rounding_shows_nothing() {
        for (first, unchanged) in [(2e-9, true), (0.5e-9, false)] {
            assert_eq!(both(&[first, 1.0, 0.0, 0.0, 0.0, 0.0], 1.0), [unchanged; 2], "{first}");
        }
    }

    #[test]
    fn a_series_that_is_cut_off_too_early_shows_nothing() {
        for (last, unchanged) in [(0.9e-13, true), (1.1e-13, false)] {
            assert_eq!(both(&[1.0, 0.1, 0.0, 0.0, 0.0, last], 1.0), [unchanged; 2], "{last}");
            assert_eq!(both(&[1.0, 0.1, 0.0, last, 0.0, 0.0], 1.0), [unchanged; 2], "{last}");
        }
    }

    #[test]
    fn an_argument_may_move_by_half_of_three_or_a_quarter_of_itself() {
        for (argument, change, within) in
            [(0.0, 1.4, true), (0.0, 1.6, false), (-40.0, 9.9, true), (-40.0, 10.1, false)]
        {
            let c = [argument, change, 0.0];
            let several = c.map(Batch::splat);
            assert_eq!(stays(&c, 1.0), within, "{argument} {change}");
            assert_eq!(stay(&several, Batch::ONE) == Batch::ONE, within, "{argument} {change}");
        }
    }
}
