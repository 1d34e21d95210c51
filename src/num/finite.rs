//! Whether many numbers are finite, seen several at once.
//!
//! In: a list of numbers. Out: one answer. Never here: which of them is not.

/// Whether all numbers are finite. To be inlined into a [`Kernel`](super::Kernel).
#[inline(always)]
pub fn all_finite(numbers: &[f64]) -> bool {
    // without an end before the last, several are seen at once
    let mut finite = true;
    for x in numbers {
        finite &= x.is_finite();
    }
    finite
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_number_that_is_not_finite_is_seen_wherever_it_stands() {
        for length in 0..40 {
            assert!(all_finite(&vec![f64::MAX; length]));
            for place in 0..length {
                for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    let mut numbers = vec![1.0; length];
                    numbers[place] = bad;
                    assert!(!all_finite(&numbers), "{bad} at {place} of {length}");
                }
            }
        }
    }
}
