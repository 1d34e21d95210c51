//! Numbers as text: rounded for reading, or so that they read back.
//!
//! In: any `f64`. Out: ASCII text, or the number that a rounded text stands for. Never here: the glyphs of a screen.

use std::fmt::Write as _;
use std::ops::Range;

/// A number with at most this many significant digits and without trailing zeros; with a power of
/// ten if its magnitude lies outside a range.
pub fn significant(x: f64, digits: usize, plain: Range<f64>) -> String {
    let rounded = rounded(x, digits);
    if rounded == 0.0 || plain.contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// A number rounded to this many significant digits (1 to 17): 17476 to two is 17000.
pub fn rounded(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits.clamp(1, 17) - 1).parse().unwrap_or(x)
}

/// A number without loss and no longer than so many characters if it can be; with a power of ten otherwise.
pub fn no_longer_than(x: f64, most: usize) -> String {
    let plain = x.to_string();
    if plain.len() <= most { plain } else { format!("{x:e}").replace("e0", "") }
}

/// The shortest decimal that reads back to the same `f64`: `0.1`, `2.0`, `1e-9`. Returns `None` if
/// the number is not finite.
pub fn shortest(x: f64) -> Option<String> {
    x.is_finite().then(|| {
        let mut text = String::new();
        push_shortest(&mut text, x);
        text
    })
}

/// Appends [`shortest`]; nothing if the number is not finite.
pub fn push_shortest(out: &mut String, x: f64) {
    if x.is_finite() && !(1e-5..1e-4).contains(&x.abs()) {
        // elsewhere the two agree, and this one is several times as fast
        out.push_str(ryu::Buffer::new().format_finite(x));
    } else if x.is_finite() {
        // in the middle of the two ranges of powers of ten, writing to a String cannot fail
        let _ = write!(out, "{x:?}");
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
    use super::{no_longer_than, rounded, short, shortest, significant, to_its_error};

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
    fn a_number_is_rounded_to_digits_and_not_to_places() {
        for (x, digits, to) in
            [(17_476.0, 2, 17_000.0), (0.009_996, 3, 0.01), (-2.5e-300, 1, -2e-300), (0.1, 99, 0.1)]
        {
            assert_eq!(rounded(x, digits), to);
        }
        assert!(rounded(f64::NAN, 3).is_nan());
    }

    #[test]
    fn a_number_is_the_shortest_that_reads_back() {
        let edges = [0.0, -0.0, 1.0, 0.1, 1e-4, 1e15, 1e16, 1e17, 1e-5, f64::MAX, 5e-324, 1e300];
        let around = edges.into_iter().flat_map(|x| [x, x.next_up(), x.next_down(), -x]);
        let mut seed = 7_u64;
        let random = (0..50_000).map(|k| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let any = f64::from_bits(seed);
            if k % 2 == 0 {
                any
            } else {
                (seed >> 20) as f64 / [1.0, 1e6, 1e12, 1e18][(seed % 4) as usize]
            }
        });
        for x in around.chain(random).filter(|x| x.is_finite()) {
            let (text, other) = (shortest(x).expect("finite"), format!("{x:?}"));
            assert_eq!(text.parse::<f64>().map(f64::to_bits), Ok(x.to_bits()), "{text}");
            // of two shortest decimals that are equally near, either may be taken
            assert_eq!(text.len(), other.len(), "{text} {other}");
        }
        for x in [0.0, -0.0, 1.0, 0.1, -2.5e-3, 1e15, 1e16, 1e-5, f64::MAX, 5e-324] {
            assert_eq!(shortest(x), Some(format!("{x:?}")));
        }
        assert_eq!((shortest(f64::NAN), shortest(f64::INFINITY)), (None, None));
    }

    #[test]
    fn a_number_is_written_without_loss_and_with_a_power_of_ten_where_it_would_be_long() {
        for x in [0.1, 2.0, 1e-9, 1e16, 123_456.789, f64::MIN_POSITIVE] {
            assert_eq!(no_longer_than(x, 12).parse::<f64>().map(f64::to_bits), Ok(x.to_bits()));
        }
        assert_eq!(no_longer_than(0.25, 12), "0.25");
        assert_eq!(no_longer_than(1e-30, 12), "1e-30");
        assert_eq!(no_longer_than(1.234_567_890_123, 12), "1.234567890123");
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
