//! The resolution of a time in `f64`.
//!
//! In: a time. Out: the distance to the next representable one, and how many of these an interval needs. Never here: steps.

/// The minimal length of an interval on which events are searched for, in spacings of time.
pub(super) const DIGITS: f64 = 16.0;

/// Returns the distance from a time to the next representable one.
pub fn spacing(time: f64) -> f64 {
    let size = time.abs();
    size.next_up() - size
}

#[cfg(test)]
mod tests {
    use super::spacing;

    #[test]
    fn the_digits_of_a_clock_become_coarser_with_time() {
        assert_eq!(spacing(1.0), f64::EPSILON);
        assert_eq!(spacing(-1e17), 16.0);
        assert_eq!(spacing(0.0), 5e-324);
    }
}
