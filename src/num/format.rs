//! Numbers in sentences: rounded for reading, not for parsing back.
//!
//! In: any `f64`. Out: short ASCII text. Never here: numbers that are used in computations again,
//! the glyphs of a screen.

use std::ops::Range;

/// A number with at most this many significant digits and without trailing zeros; with a power of
/// ten if its magnitude lies outside a range.
pub fn significant(x: f64, digits: usize, plain: Range<f64>) -> String {
    let text = format!("{x:.*e}", digits.max(1) - 1);
    let rounded: f64 = text.parse().unwrap_or(x);
    if rounded == 0.0 || plain.contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// A number in a sentence: four significant digits.
pub fn short(x: f64) -> String {
    significant(x, 4, 1e-4..1e6)
}

#[cfg(test)]
mod tests {
    use super::{short, significant};

    #[test]
    fn a_number_is_as_short_as_its_digits_let_it_be() {
        let check = |x: f64, text: &str| assert_eq!(short(x), text);
        check(0.0, "0");
        check(1.0, "1");
        check(-0.123_456, "-0.1235");
        check(999_960.0, "1e6");
        check(0.000_099_999, "0.0001");
        check(6.022e23, "6.022e23");
        check(f64::NAN, "NaN");
        assert_eq!(significant(1_234_567.0, 6, 1e-4..1e7), "1234570");
        assert_eq!(significant(1e-30, 4, 0.0..f64::INFINITY), format!("{}", 1e-30));
    }
}
