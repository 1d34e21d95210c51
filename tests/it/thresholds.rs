//! Thresholds, tested by their decisions: a case just inside and one just outside.

use std::fmt::Write as _;

use phaselab::analysis::{History, Verdict};
use phaselab::diagnostic::Document;
use phaselab::mechanics::derive;
use phaselab::system::System;

/// The number of redundant constraints, of two in the plane whose directions differ by this angle.
fn redundant(angle: &str) -> usize {
    let mut text = "title = \"Two rails\"\n[coordinates]\n".to_owned();
    for name in ["x", "y"] {
        let _ = writeln!(text, "{name} = {{ initial = 0 }}");
    }
    let _ = writeln!(
        text,
        "[lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n\
         [[constraints]]\nname = \"one\"\nexpression = \"x + y\"\n\
         [[constraints]]\nname = \"other\"\nexpression = \"x + y + {angle}*(x - y)\"\n\
         [run]\nuntil = 1"
    );
    let model = Document::new("rails.toml", text).read().unwrap().model;
    let equations = derive(&model).unwrap();
    let system = System::compile(&model, &equations, &[]).unwrap();
    system.redundant().len()
}

#[test]
fn rows_are_independent_beyond_a_billionth() {
    assert_eq!(redundant("0.0000000015"), 0);
    assert_eq!(redundant("0.0000000007"), 1);
}

/// The verdict on a signal from 0 to 1, of which 64 intervals are kept, where `floor` is explained by rounding.
fn verdict(floor: f64, signal: impl Fn(f64) -> f64) -> &'static str {
    let mut history = History::new();
    let count = 8192_u32;
    for k in 0..=count {
        let time = f64::from(k) / f64::from(count);
        history.push(time, signal(time));
    }
    Verdict::of(&history, 0.0, floor).word()
}

/// An oscillation of amplitude 1 from peak to peak, of four samples.
fn oscillation(time: f64) -> f64 {
    if (time * 8192.0).round() % 4.0 < 2.0 { 0.5 } else { -0.5 }
}

/// Asserts that the signal with the first number is bounded, and with the second secular.
fn turns(floor: f64, [within, beyond]: [f64; 2], signal: impl Fn(f64, f64) -> f64) {
    assert_eq!(verdict(floor, |time| signal(within, time)), "bounded", "{within}");
    assert_eq!(verdict(floor, |time| signal(beyond, time)), "secular", "{beyond}");
}

#[test]
fn a_level_is_left_by_more_than_one_and_a_fifth_of_the_swing() {
    turns(1e-9, [1.15, 1.25], |jump, time| oscillation(time) + if time < 0.5 { 0.0 } else { jump });
}

#[test]
fn a_level_is_left_by_eight_times_the_rounding() {
    turns(1.0, [7.5, 8.5], |jump, time| if time < 0.5 { 0.0 } else { jump });
}

#[test]
fn a_trend_is_a_hundredth_of_the_swing() {
    // between the means of the first and the last quarter lie three quarters of the time
    turns(1e-9, [0.009, 0.012], |rise, time| oscillation(time) + rise * time / 0.75);
}

#[test]
fn extremes_rise_with_a_trend_by_a_fifth_of_it() {
    // the rest of the rise is that of the share of time spent above
    turns(1e-9, [0.17, 0.23], |along, time| {
        let above = 64.0 * (0.4 + 0.25 * time * (1.0 - along));
        let wave = if (time * 8192.0).round() % 64.0 < above { 0.5 } else { -0.5 };
        wave + 0.25 * along * time
    });
}

#[test]
fn every_part_of_a_trend_has_a_third_of_its_share() {
    // between the second and the third of five parts the rise has this slope, elsewhere 1: 2 s/(1 + s) of an even one
    turns(1e-9, [0.19, 0.23], |slope, time| {
        let slow = time.clamp(0.2, 0.6) - 0.2;
        oscillation(time) + 0.5 * (time - slow + slope * slow)
    });
}

#[test]
fn a_trend_is_clear_of_six_standard_errors() {
    // the means of neighbouring intervals differ by 1, a quarter has 16 of them
    let error = 0.5 / 16.0_f64.sqrt();
    turns(1e-9, [5.4, 6.3], |errors, time| {
        let scatter = if (time * 64.0).floor() % 2.0 == 0.0 { 0.5 } else { -0.5 };
        scatter + errors * error * time / 0.75
    });
}
