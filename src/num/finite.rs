//! Whether many numbers are finite, seen several at once.
//!
//! In: a list of numbers. Out: one answer. Never here: which of them is not.

use super::four_lanes::{FourLanes, LANES};

/// The number of sums that are kept apart.
const APART: usize = 4;

/// Whether all numbers are finite. To be inlined into a [`FourLaneKernel`](super::FourLaneKernel).
#[inline(always)]
pub fn all_finite<L: FourLanes>(lanes: L, numbers: &[f64]) -> bool {
    // zero times anything that is not finite is NaN, and so is every sum with it
    let zero = lanes.splat(0.0);
    let mut sums = [zero; APART];
    let (fours, rest) = numbers.as_chunks::<LANES>();
    let (groups, left) = fours.as_chunks::<APART>();
    for i in 0..groups.len() {
        for j in 0..APART {
            sums[j] = lanes.add(sums[j], lanes.mul(lanes.from_array(groups[i][j]), zero));
        }
    }
    for i in 0..left.len() {
        sums[i] = lanes.add(sums[i], lanes.mul(lanes.from_array(left[i]), zero));
    }
    let [a, b, c, d] = sums;
    let all = lanes.add(lanes.add(a, b), lanes.add(c, d));
    let mut sum = 0.0;
    for x in rest {
        sum += x * 0.0;
    }
    sum == 0.0 && lanes.equal(all, zero) == lanes.all_lanes()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::{FourLaneKernel, ScalarLanes, in_four_lanes};

    struct Finite<'a>(&'a [f64]);

    impl FourLaneKernel for Finite<'_> {
        type Output = bool;

        #[inline(always)]
        fn run<L: FourLanes, const FUSED: bool>(self, lanes: L) -> bool {
            all_finite(lanes, self.0)
        }
    }

    fn is_seen(numbers: &[f64]) -> bool {
        let plainly = all_finite(ScalarLanes, numbers);
        assert_eq!(in_four_lanes(Finite(numbers)), plainly);
        plainly
    }

    #[test]
    fn one_number_that_is_not_finite_is_seen_wherever_it_stands() {
        for length in 0..40 {
            assert!(is_seen(&vec![f64::MAX; length]));
            for place in 0..length {
                for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    let mut numbers = vec![1.0; length];
                    numbers[place] = bad;
                    assert!(!is_seen(&numbers), "{bad} at {place} of {length}");
                }
            }
        }
    }
}
