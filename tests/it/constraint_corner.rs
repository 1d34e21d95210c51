//! Corners of constraints, which end a motion that would need an impulse there.

use phaselab::experiment::{AdvanceOutcome, Experiment, Status};

use crate::experiment::{PLENTY, build, run, value};

/// A particle in the plane under a constraint, with its coordinates and velocities at the start.
fn under(constraint: &str, [x, y, u, v]: [f64; 4], method: &str) -> Experiment {
    let text = format!(
        "title = \"A corner\"\n[coordinates]\nx = {{ initial = {x:?}, velocity = {u:?} }}\n\
         y = {{ initial = {y:?}, velocity = {v:?} }}\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n\
         [[constraints]]\nname = \"c\"\nexpression = \"{constraint}\"\n"
    );
    build(&text, |setup| {
        method.clone_into(&mut setup.method);
        setup.settings.step = (method == "rk4").then_some(0.013);
    })
}

/// Why and when a motion ends.
fn end(mut motion: Experiment) -> (String, f64) {
    assert_ne!(motion.advance(5.0, PLENTY), AdvanceOutcome::Arrived);
    match motion.status() {
        Status::Failed(error) => (error.message, error.time),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_motion_ends_at_a_corner_of_its_constraint() {
    for (constraint, y, v) in [
        ("y - abs(x)", 1.0, -1.0),
        ("y - max(x, -x)", 1.0, -1.0),
        ("y - acos(cos(x))", 1.0, -1.0),
        // however flat it is
        ("y - 1e-7*abs(x)", 1e-7, -1e-7),
    ] {
        for method in ["taylor", "dop853", "rk4"] {
            // steps of other methods find the kinks of switches alone
            if constraint.contains("acos") && method != "taylor" {
                continue;
            }
            let (message, time) = end(under(constraint, [-1.0, y, 1.0, v], method));
            let said = "comes to a corner of the constraint `c` at t = ";
            assert!(message.contains(said), "{constraint} {method}: {message}");
            assert!((time - 1.0).abs() < 1e-9, "{constraint} {method}: {time}");
        }
    }
}

/// A direction that is continuous has no corner, and one that is not is none of a motion that stays on one side.
#[test]
fn a_motion_that_needs_no_impulse_passes_a_kink_of_its_constraint() {
    for method in ["taylor", "dop853", "rk4"] {
        let mut motion = under("y - x*abs(x)", [-1.0, -1.0, 1.0, 2.0], method);
        run(&mut motion, 2.0);
        let (u, v) = (value(&motion, "x'"), value(&motion, "y'"));
        // equal steps do not end on the kink of the second derivative
        let error = if method == "rk4" { 1e-3 } else { 1e-4 };
        assert!((u * u + v * v - 5.0).abs() < error, "{method}: {u} {v}");
        assert!(value(&motion, "x") > 0.0, "{method}");
        let mut motion = under("y - abs(x)", [1.0, 1.0, 1.0, 1.0], method);
        run(&mut motion, 2.0);
        assert!((value(&motion, "x") - 3.0).abs() < 1e-9, "{method}");
    }
}

/// A wall that turns back at once has one direction, along which it acts.
#[test]
fn a_constraint_whose_rate_alone_jumps_is_followed() {
    let mut motion = under("x - abs(t - 1)", [1.0, 0.0, -1.0, 0.5], "taylor");
    run(&mut motion, 3.0);
    let found = ["x", "x'", "y", "y'"].map(|name| value(&motion, name));
    for (found, expected) in found.into_iter().zip([2.0, 1.0, 1.5, 0.5]) {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
}
