//! Numbers formatted for people.

use phaselab::view::glyphs::Glyphs;
use phaselab::view::number::{brief, drift, drift_in, readable, with_minus_signs, with_powers};
use proptest::prelude::*;

#[test]
fn exponents_in_a_text_become_powers_of_ten() {
    for (text, unicode) in [
        ("y alone 3e−16, p alone −12", "y alone 3×10⁻¹⁶, p alone −12"),
        ("1.5e-7", "1.5×10⁻⁷"),
        ("J = 2e12 of 3", "J = 2×10¹² of 3"),
        ("e₁ e1 3e 1e−x 2e3a least e-3 x2e5", "e₁ e1 3e 1e−x 2e3a least e-3 x2e5"),
        ("", ""),
    ] {
        assert_eq!(with_powers(text, Glyphs::Braille), unicode);
        assert_eq!(with_powers(text, Glyphs::Ascii), text);
    }
}

#[test]
fn readable_numbers_keep_their_digits() {
    let check = |value: f64, unicode: &str, ascii: &str| {
        assert_eq!(readable(value, 4, Glyphs::Braille), unicode);
        assert_eq!(readable(value, 4, Glyphs::Ascii), ascii);
    };
    check(0.0, "0", "0");
    check(1.0, "1.000", "1.000");
    check(-12.3456, "−12.35", "-12.35");
    check(123.44, "123.4", "123.4");
    check(9.9996, "10.00", "10.00");
    check(12345.6, "12346", "12346");
    check(0.001_234_6, "0.001235", "0.001235");
    check(-1.2346e-12, "−1.235×10⁻¹²", "-1.235e-12");
    check(6.022e23, "6.022×10²³", "6.022e23");
    check(f64::INFINITY, "∞", "inf");
    check(f64::NEG_INFINITY, "−∞", "-inf");
    check(f64::NAN, "NaN", "NaN");
}

#[test]
fn brief_numbers_have_no_zeros_to_spare() {
    let check = |value: f64, text: &str| assert_eq!(brief(value, 6, Glyphs::Ascii), text);
    check(1.0, "1");
    check(0.25, "0.25");
    check(100.0, "100");
    check(1e-9, "1e-9");
    check(-2.50e10, "-2.5e10");
    check(0.1 + 0.2, "0.3");
}

#[test]
fn drifts_are_two_digits_and_an_exponent() {
    assert_eq!(drift(3.14e-16, Glyphs::Ascii), "3.1e-16");
    assert_eq!(drift(3.14e-16, Glyphs::Braille), "3.1×10⁻¹⁶");
    assert_eq!(drift_in(3.14e-16, 8, Glyphs::Braille), "3×10⁻¹⁶");
    assert_eq!(with_minus_signs("λ = -18.72 N/m, 3e-5", Glyphs::Braille), "λ = −18.72 N/m, 3e-5");
    assert_eq!(with_minus_signs("a-1, x-ray, -2", Glyphs::Braille), "a-1, x-ray, −2");
    assert_eq!(drift(-0.02, Glyphs::Ascii), "-2.0e-2");
    assert_eq!(drift(0.0, Glyphs::Ascii), "0");
    assert_eq!(drift(f64::NAN, Glyphs::Ascii), "unknown");
}

proptest! {
    #[test]
    fn any_number_is_short_and_reads_back(value in any::<f64>(), significant in 1_usize..=17) {
        for text in [readable(value, significant, Glyphs::Ascii), brief(value, significant, Glyphs::Ascii)] {
            prop_assert!(text.is_ascii() && text.len() <= significant + 8, "{text}");
            if value.is_finite() {
                let read: f64 = text.parse().unwrap();
                let slack = value.abs() * 10_f64.powi(1 - significant as i32) * 0.51;
                prop_assert!(read.is_infinite() || (read - value).abs() <= slack.max(f64::MIN_POSITIVE), "{text}");
            }
        }
        prop_assert!(drift(value, Glyphs::Ascii).len() <= 9);
    }
}
