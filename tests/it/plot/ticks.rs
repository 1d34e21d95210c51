//! Ticks: round numbers in few digits, all distinct.

use std::f64::consts::{PI, TAU};

use phaselab::view::glyphs::Glyphs;
use phaselab::view::plot::Scale;
use phaselab::view::plot::ticks::{Ticks, nice_range};
use proptest::prelude::*;

/// Checks the labels of a scale, and the power of ten taken out.
fn check(scale: Scale, most: usize, exponent: i32, labels: &[&str]) {
    let ticks = Ticks::of(&scale, most, Glyphs::Braille);
    let found: Vec<_> = ticks.marks.iter().map(|tick| tick.label.as_str()).collect();
    assert_eq!((found.as_slice(), ticks.exponent), (labels, exponent), "{scale:?}");
}

#[test]
fn linear() {
    check(Scale::linear(0.0, 10.0), 6, 0, &["0", "2", "4", "6", "8", "10"]);
    check(Scale::linear(0.0, 10.0), 5, 0, &["0", "5", "10"]);
    check(Scale::linear(-1.0, 1.0), 5, 0, &["−1.0", "−0.5", "0", "0.5", "1.0"]);
    check(Scale::linear(0.03, 0.13), 6, 0, &["0.04", "0.06", "0.08", "0.10", "0.12"]);
    check(Scale::linear(0.0, 20_000.0), 3, 0, &["0", "10000", "20000"]);
    check(Scale::linear(0.0, 1.0), 1, 0, &["0"]);
    // one tick would not show the scale of the axis
    check(Scale::linear(-0.45, 0.45), 3, 0, &["−0.4", "0", "0.4"]);
    check(Scale::linear(-0.45, 0.45), 2, 0, &["−0.4", "0.4"]);
    check(Scale::linear(0.9, 2.9), 2, 0, &["1", "2"]);
    check(Scale::linear(0.0, 1.0), 0, 0, &[]);
}

#[test]
fn a_common_power_of_ten_is_taken_out() {
    check(Scale::linear(0.0, 4e-6), 5, -6, &["0", "1", "2", "3", "4"]);
    check(Scale::linear(-2e7, 2e7), 5, 7, &["−2", "−1", "0", "1", "2"]);
    check(Scale::linear(-2.4e-4, 2.4e-4), 3, -4, &["−2", "0", "2"]);
    check(Scale::linear(0.0, 2.4e-4), 5, -5, &["0", "5", "10", "15", "20"]);
    // a step that is small beside the values
    check(Scale::linear(1.00009e-3, 1.00031e-3), 3, -5, &["100.01", "100.02", "100.03"]);
    check(Scale::linear(0.0, 5e-300), 3, -300, &["0", "2", "4"]);
}

#[test]
fn a_small_range_far_from_zero_has_the_digits_it_needs() {
    check(Scale::linear(999.9, 1000.1), 3, 0, &["999.9", "1000.0", "1000.1"]);
}

#[test]
fn angles() {
    check(Scale::turn(), 5, 0, &["−π", "−π/2", "0", "π/2", "π"]);
    check(Scale::turn(), 3, 0, &["−π", "0", "π"]);
    check(Scale::linear(0.0, PI).angle(), 5, 0, &["0", "π/4", "π/2", "3π/4", "π"]);
    check(Scale::linear(0.0, 2.0 * TAU).angle(), 5, 0, &["0", "π", "2π", "3π", "4π"]);
    check(Scale::linear(0.0, 0.5).angle(), 3, 0, &["0", "0.2", "0.4"]);
    let ascii = Ticks::of(&Scale::turn(), 5, Glyphs::Ascii);
    let labels: Vec<_> = ascii.marks.iter().map(|tick| tick.label.as_str()).collect();
    assert_eq!(labels, ["-pi", "-pi/2", "0", "pi/2", "pi"]);
}

#[test]
fn logarithmic() {
    check(Scale::log(0.01, 100.0), 6, 0, &["0.01", "0.1", "1", "10", "100"]);
    check(Scale::log(1.0, 100.0), 7, 0, &["1", "2", "5", "10", "20", "50", "100"]);
    check(Scale::log(1e-16, 1e-4), 5, 0, &["10⁻¹⁵", "10⁻¹²", "10⁻⁹", "10⁻⁶"]);
    check(Scale::log(2.0, 4.0), 5, 0, &["2.0", "2.5", "3.0", "3.5", "4.0"]);
    let ascii = Ticks::of(&Scale::log(1e-9, 1e-6), 4, Glyphs::Ascii);
    assert_eq!(ascii.marks[0].label, "1e-9");
}

#[test]
fn nice_ranges_hold_the_data_and_stay_put() {
    assert_eq!(nice_range(0.0, 9.3), (0.0, 10.0), "data from zero up keep zero as the end");
    assert_eq!(nice_range(0.0, 9.4), nice_range(0.0, 9.3));
    assert_eq!(nice_range(5.0, 5.0), nice_range(2.5, 7.5));
    assert_eq!(nice_range(0.0, 0.0), nice_range(-1.0, 1.0));
    assert_eq!(nice_range(f64::NAN, f64::INFINITY), nice_range(0.0, 0.0));
}

/// Whether a step is 1, 2 or 5 times a power of ten.
fn is_nice(step: f64) -> bool {
    let mantissa = step / 10_f64.powf(step.log10().floor());
    [1.0, 2.0, 5.0, 10.0].iter().any(|nice| (mantissa / nice - 1.0).abs() < 1e-6)
}

proptest! {
    #[test]
    fn ticks_are_nice_inside_few_and_told_apart(
        middle in -1e6..1e6_f64,
        size in -9.0..9.0_f64,
        most in 2_usize..20,
    ) {
        let half = 10_f64.powf(size);
        let scale = Scale::linear(middle - half, middle + half);
        let ticks = Ticks::of(&scale, most, Glyphs::Ascii);
        prop_assert!(ticks.marks.len() <= most);
        if half > middle.abs() * 1e-8 {
            prop_assert!(ticks.marks.len() * 6 >= most, "{} of {most}", ticks.marks.len());
            prop_assert!(ticks.marks.len() >= 2);
        }
        for tick in &ticks.marks {
            prop_assert!((scale.lo..=scale.hi).contains(&tick.value));
            let read: f64 = format!("{}e{}", tick.label, ticks.exponent).parse().unwrap();
            prop_assert!((read - tick.value).abs() <= tick.value.abs() * 1e-15, "{tick:?}");
        }
        for pair in ticks.marks.windows(2) {
            prop_assert!(pair[0].label != pair[1].label);
            if half > middle.abs() * 1e-6 && ticks.marks.len() > 3 {
                prop_assert!(is_nice(pair[1].value - pair[0].value), "{pair:?}");
            }
        }
    }

    #[test]
    fn any_range_has_ticks_or_none(
        lo in any::<f64>(), hi in any::<f64>(), most in 0_usize..100,
    ) {
        let scales = [Scale::linear(lo, hi), Scale::log(lo, hi), Scale::linear(lo, hi).angle()];
        for scale in scales {
            let ticks = Ticks::of(&scale, most, Glyphs::Ascii);
            prop_assert!(ticks.marks.len() <= most.max(1));
            prop_assert!(ticks.marks.iter().all(|tick| tick.label.is_ascii() && tick.label.len() < 24));
        }
        let (low, high) = nice_range(lo, hi);
        prop_assert!(low < high && low.is_finite() && high.is_finite());
        if lo.is_finite() && hi.is_finite() {
            prop_assert!(low <= lo.min(hi) && high >= lo.max(hi));
        }
    }
}
