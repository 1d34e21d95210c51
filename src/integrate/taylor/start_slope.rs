//! Which terms of a switch are certain where a motion begins on its surface.
//!
//! Where a motion begins there is no step before it to compare with, and the end of the run says nothing about the motion.
//! But its numbers are given, so a term counts, however small, if its sign does not depend on their last digits. The
//! series is built a second time from numbers that differ by a little, and a term that changes by no more than a part of
//! itself is certain.
//!
//! In: the numbers at the start, and those before an impulse. Out: the numbers beside them, and the first certain term of
//! a switch. Never here: which side a motion takes.

use crate::num::DoubleDouble;
use crate::system::State;

/// The last digits of a number, relative to its size: those that an `f64` may have lost in a few operations.
const LAST_DIGITS: f64 = 1e-15;

/// A term is certain if it changes by less than this part of itself.
const CERTAIN: f64 = 0.125;

/// The sizes of the numbers at a start: after an impulse those before it count as well, since the small difference of two
/// numbers has the error of both.
pub(super) fn sizes(start: &State, before: &State) -> Vec<f64> {
    start.values.iter().zip(&before.values).map(|(a, b)| a.abs().max(b.abs())).collect()
}

/// Sets numbers to zero of which an impulse has left nothing but rounding.
pub(super) fn clear_rounding(start: &mut State, before: &State) {
    for (i, &earlier) in before.values.iter().enumerate() {
        if start.values[i].abs() <= LAST_DIGITS * earlier.abs() {
            start.set(i, DoubleDouble::ZERO);
        }
    }
}

/// A state whose numbers differ from those of another by their last digits, each by another part of them, so that the
/// changes do not cancel.
pub(super) fn beside(state: &State, sizes: &[f64]) -> State {
    let mut beside = state.clone();
    let golden = 0.618_033_988_749_894_9;
    for (i, size) in sizes.iter().enumerate() {
        let part = 1.0 + (golden * (i + 1) as f64).fract();
        beside.set(i, state.exact(i) + DoubleDouble::from(LAST_DIGITS * size * part));
    }
    beside
}

/// The first term beyond the constant one whose sign does not depend on the last digits.
pub(super) fn first_certain(switch: &[f64], beside: &[f64]) -> Option<usize> {
    let certain =
        |&k: &usize| switch[k] != 0.0 && (switch[k] - beside[k]).abs() <= CERTAIN * switch[k].abs();
    (1..switch.len()).find(certain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_term_is_certain_if_it_changes_by_less_than_an_eighth() {
        assert_eq!(first_certain(&[0.0, 1e-200, -1.0], &[0.0, 1.12e-200, -1.0]), Some(1));
        assert_eq!(first_certain(&[0.0, 1e-200, -1.0], &[0.0, 1.13e-200, -1.0]), Some(2));
        assert_eq!(first_certain(&[1.0, 0.0, 0.0], &[1.0, 0.0, 1e-9]), None);
    }
}
