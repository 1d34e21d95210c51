//! Lagrangians that differ by a total derivative, and those that do not.

use phaselab::expr::Expr;
use phaselab::mechanics::{self, GaugeDifference};

use crate::build::{lagrangian, read, sample};

/// Compares two Lagrangians; a function that is found has the difference as its rate along random velocities, by
/// differences.
fn compare(coordinates: &[&str], first: &str, second: &str) -> (GaugeDifference, Option<String>) {
    let mut model = lagrangian(coordinates, &["m", "k", "b"], first);
    let second = read(&mut model, second);
    let mut equations = mechanics::derive(&model).expect("derivable");
    let first = equations.law;
    let gauge = equations.gauge(first, second);
    let pool = &equations.pool;
    if let Some(f) = gauge.function {
        for seed in 0..10 {
            let at = sample(seed);
            let value = |h: f64| {
                pool.evaluate(f, &|s| {
                    let moved = equations.coordinates.iter().find(|c| c.position == s);
                    if s == equations.symbols.time {
                        at(s) + h
                    } else {
                        at(s) + moved.map_or(0.0, |c| h * at(c.velocity))
                    }
                })
            };
            let h = 1e-5;
            let slope = (value(h) - value(-h)) / (2.0 * h);
            let right = pool.evaluate(gauge.difference, &at);
            assert!((slope - right).abs() < 1e-7 * (1.0 + right.abs()), "{slope} is not {right}");
        }
    }
    let text = gauge.function.map(|f: Expr| pool.text(f));
    (gauge, text)
}

#[test]
fn total_derivatives_are_recognised_with_their_functions() {
    let oscillator = "1/2*m*x'^2 - 1/2*k*x^2";
    let with = |extra: &str| compare(&["x"], oscillator, &format!("{oscillator} + {extra}"));
    let (gauge, f) = with("2*x*x'");
    assert_eq!(gauge.total_derivative, Some(true));
    assert_eq!(f.as_deref(), Some("-x^2"));
    // d(t x)/dt, d(sin(x) t²)/dt, a function of the time, a constant, nothing
    for extra in ["x + t*x'", "t^2*cos(x)*x' + 2*t*sin(x)", "cos(t)", "k", "0"] {
        let (gauge, f) = with(extra);
        assert_eq!(gauge.total_derivative, Some(true), "{extra}");
        assert!(f.is_some(), "{extra}");
    }
    // a gauge of the vector potential: B x y' and ½ B (x y' − y x')
    let symmetric = "1/2*(x'^2 + y'^2) + 1/2*b*(x*y' - y*x')";
    let landau = "1/2*(x'^2 + y'^2) + b*x*y'";
    let (gauge, f) = compare(&["x", "y"], symmetric, landau);
    assert_eq!(gauge.total_derivative, Some(true));
    assert_eq!(f.as_deref(), Some("-1/2*b*x*y"));
    // in a frame that moves: ½m(x' + v)² and ½mx'²
    let (gauge, _) = compare(&["x"], "1/2*m*(x' + b)^2", "1/2*m*x'^2");
    assert_eq!(gauge.total_derivative, Some(true));
    // a total derivative whose function is not elementary
    let (gauge, _) = compare(&["x"], "1/2*x'^2 + exp(-x^2)*x'", "1/2*x'^2");
    assert_eq!(gauge.total_derivative, Some(true));
}

#[test]
fn other_differences_are_refuted() {
    let oscillator = "1/2*m*x'^2 - 1/2*k*x^2";
    for extra in ["x'^2", "x", "x*x'*t", "t*x'", "1e-9*x^2", "x'^3"] {
        let (gauge, f) = compare(&["x"], oscillator, &format!("{oscillator} + {extra}"));
        assert_eq!(gauge.total_derivative, Some(false), "{extra}");
        assert!(f.is_none());
    }
    // twice L has the same motion, but not as a gauge
    let (gauge, _) = compare(&["x"], oscillator, "m*x'^2 - k*x^2");
    assert_eq!(gauge.total_derivative, Some(false));
    // another field
    let (gauge, _) =
        compare(&["x", "y"], "1/2*(x'^2 + y'^2) + b*x*y'", "1/2*(x'^2 + y'^2) - b*x*y'");
    assert_eq!(gauge.total_derivative, Some(false));
}

#[test]
fn a_step_of_the_potential_is_no_gauge() {
    // its slope vanishes on both sides, and the step reflects what is slow
    let (gauge, _) = compare(&["x"], "1/2*x'^2 - sign(x)", "1/2*x'^2");
    assert_ne!(gauge.total_derivative, Some(true));
    let (gauge, _) = compare(&["x"], "1/2*x'^2 - x/abs(x)", "1/2*x'^2");
    assert_ne!(gauge.total_derivative, Some(true));
}
