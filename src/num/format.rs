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

/// A number with the digits that its error leaves, and at most so many.
pub fn to_its_error(x: f64, error: f64, most: usize, plain: Range<f64>) -> String {
    let place = |x: f64| format!("{:e}", x.abs()).split_once('e')?.1.parse::<i32>().ok();
    let digits = match (place(x), place(error)) {
        (Some(first), Some(last)) if error > 0.0 => usize::try_from(first - last + 1).unwrap_or(1),
        _ => most,
    };
    significant(x, digits.clamp(1, most), plain)
}

/// A number in a sentence: four significant digits.
pub fn short(x: f64) -> String {
    significant(x, 4, 1e-4..1e6)
}

#[cfg(test)]
mod tests {
    use super::{short, significant, to_its_error};

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

    #[test]
    fn a_number_has_no_digit_beyond_its_error() {
        for (x, error, most, written) in [
            (0.920_604_232_837, 3e-9, 12, "0.920604233"),
            (0.920_604_232_837, 0.02, 12, "0.92"),
            (1.618_033_988_749, 4e-4, 12, "1.618"),
            (-123.456, 40.0, 12, "-120"),
            (0.5, 3.0, 12, "0.5"),
            (1.0 / 3.0, 0.0, 8, "0.33333333"),
            (1.0 / 3.0, f64::NAN, 8, "0.33333333"),
        ] {
            assert_eq!(to_its_error(x, error, most, 1e-4..1e6), written);
        }
    }
}
