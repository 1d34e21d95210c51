//! Events whose function vanishes to a higher order, or at a kink: every crossing once, at its time, and no touch.
//!
//! The motion is x = sin t, which passes ½ at π/6, 5π/6 and so on, and 0 at the multiples of π.

use std::f64::consts::{PI, TAU};

use crate::experiment::{build, run, value};

/// The times of an event up to t = 10, with rows at this spacing.
fn times(when: &str, method: &str, spacing: f64) -> Vec<f64> {
    let text = format!(
        "title = \"Oscillator\"\n[coordinates]\nx = {{ initial = 0, velocity = 1 }}\n[lagrangian]\n\
         L = \"1/2*x'^2 - 1/2*x^2\"\n[[events]]\nname = \"e\"\nwhen = \"{when}\"\naction = \"mark\"\n\
         direction = \"either\"\n"
    );
    let mut oscillator = build(&text, |setup| {
        method.clone_into(&mut setup.method);
        let is_fixed = ["rk4", "leapfrog", "gauss4"].contains(&method);
        setup.settings.step = is_fixed.then_some(1e-2);
        setup.spacing = spacing;
    });
    run(&mut oscillator, 10.0);
    oscillator.occurrences().iter().map(|h| h.time).collect()
}

/// Whether these are the times, each to within so much.
fn near(found: &[f64], expected: &[f64], within: f64) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < within)
}

const HALVES: [f64; 4] = [PI / 6.0, 5.0 * PI / 6.0, TAU + PI / 6.0, TAU + 5.0 * PI / 6.0];

#[test]
fn a_root_of_a_higher_order_is_passed_once_and_at_its_time() {
    let half = ["(x-1/2)^3", "(x-1/2)^5", "(x-1/2)*abs(x-1/2)", "max(x-1/2,0)^2-max(1/2-x,0)^2"];
    let zero = ["x-sin(x)", "tan(x)-x", "x^3", "x^5", "x*abs(x)"];
    let zeros = [PI, TAU, 3.0 * PI];
    let cases = half.map(|f| (f, &HALVES[..])).into_iter().chain(zero.map(|f| (f, &zeros[..])));
    for (when, expected) in cases {
        for spacing in [10.0, 0.1] {
            let found = times(when, "taylor", spacing);
            assert!(near(&found, expected, 2e-15 * 10.0), "{when}: {found:?}");
            let found = times(when, "dop853", spacing);
            assert!(near(&found, expected, 1e-12), "dop853, {when}: {found:?}");
        }
    }
    // a root that not even thirty digits of the terms resolve: ∛1e-32
    let found = times("exp(x)-1-x-x^2/2", "taylor", 10.0);
    assert!(near(&found, &zeros, 1e-9), "{found:?}");
}

#[test]
fn what_only_touches_zero_is_no_event() {
    for when in ["abs(x-1/2)", "max(x-1/2,0)", "(x-1/2)^2", "(x-1/2)^4", "sqrt((x-1/2)^2)"] {
        for method in ["taylor", "dop853"] {
            assert!(times(when, method, 10.0).is_empty(), "{method}, {when}");
        }
    }
}

#[test]
fn both_of_two_crossings_a_billionth_apart_are_found() {
    for (method, within) in
        [("taylor", 1e-14), ("dop853", 1e-12), ("gauss4", 1e-6), ("rk4", 1e-6), ("leapfrog", 1e-3)]
    {
        let found = times("abs(x-1/2)-1e-9", method, 10.0);
        let pairs = found.chunks(2).map(|pair| 0.5 * (pair[0] + pair[pair.len() - 1]));
        assert!(near(&pairs.collect::<Vec<f64>>(), &HALVES, within + 1e-14), "{method}: {found:?}");
        for pair in found.chunks(2) {
            // 2e-9 at the speed cos π/6
            let gap = (pair[1] - pair[0]) / (2e-9 / (PI / 6.0).cos());
            assert!((gap - 1.0).abs() < 1e-3, "{method}: {found:?}");
        }
    }
}

/// The floor y = 0 is also where y³ vanishes.
#[test]
fn a_ball_bounces_where_the_cube_of_its_height_vanishes() {
    let height = |when: &str| {
        let mut ball = build(
            &format!(
                "title = \"Ball\"\n[coordinates]\ny = {{ initial = 1 }}\n[lagrangian]\nL = \"1/2*y'^2 - 9.81*y\"\n\
                 [[impulses]]\nname = \"hit\"\nchange = {{ p_y = \"-2*y'\" }}\n[[events]]\nname = \"floor\"\n\
                 when = \"{when}\"\ndirection = \"falling\"\naction = \"impulse:hit\"\n"
            ),
            |_| (),
        );
        run(&mut ball, 10.0);
        value(&ball, "y")
    };
    let (first, third) = (height("y"), height("y^3"));
    assert!((first - third).abs() < 1e-12, "{first} and {third}");
}
