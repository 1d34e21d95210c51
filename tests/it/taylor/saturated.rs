//! Functions that saturate with arguments that overflow.

use super::{Run, near};

#[test]
fn functions_that_saturate_with_what_overflows_are_passed_for_ever() {
    for (v, at_ends) in [
        ("tanh(exp(x))", (0.0, 1.0)),
        ("1/(1 + exp(exp(x)))", (0.5, 0.0)),
        ("1/cosh(exp(x))", (1.0, 0.0)),
        ("tanh(sinh(x))", (-1.0, 1.0)),
        ("exp(exp(x))/(1 + exp(exp(x)))", (0.5, 1.0)),
        ("exp(-exp(2*x^3))", (1.0, 0.0)),
        ("tanh(exp(x + x^3/1000))", (0.0, 1.0)),
        ("tanh(exp(x^3))", (0.0, 1.0)),
    ] {
        let mut run = Run::new(&format!(
            "title = \"Far\"\n[coordinates]\nx = {{ initial = -50.0, velocity = 3.0 }}\n[lagrangian]\nL = \"1/2*x'^2 - {v}\"\n"
        ));
        let speed = (9.0_f64 + 2.0 * (at_ends.0 - at_ends.1)).sqrt();
        for time in [100.0, 300.0, 1e4, 1e9] {
            near(&run.to(time)[1..], &[speed], 1e-12);
        }
    }
}

/// What roots and inverse cosines make of 1 − tanh² u and 1 − (1 − e^u)² has no digits where these saturate, and is smooth there.
#[test]
fn functions_of_what_saturates_are_passed_for_ever() {
    use std::f64::consts::PI;
    for (v, at_ends) in [
        ("acos(tanh(sinh(x)))", (PI, 0.0)),
        ("sqrt(1 - tanh(sinh(x))^2)", (0.0, 0.0)),
        ("asin(tanh(x))", (-0.5 * PI, 0.5 * PI)),
        ("acos(tanh(x)^3)", (PI, 0.0)),
        ("acos(1/(1 + exp(-x)))", (0.5 * PI, 0.0)),
        ("acos(1 - exp(-x^2))", (0.0, 0.0)),
    ] {
        let mut run = Run::new(&format!(
            "title = \"Far\"\n[coordinates]\nx = {{ initial = -50.0, velocity = 3.0 }}\n[lagrangian]\nL = \"1/2*x'^2 - {v}\"\n"
        ));
        let speed = (9.0_f64 + 2.0 * (at_ends.0 - at_ends.1)).sqrt();
        for time in [100.0, 300.0, 1e4, 1e9] {
            near(&run.to(time)[1..], &[speed], 1e-12);
        }
    }
}
