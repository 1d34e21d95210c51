//! The pane with the flow map: symplectic to rounding for the exact flow and a symplectic method, not for another one; and the
//! decay of its determinant under friction.

use phaselab::experiment::{Checkpoint, Command};
use phaselab::instrument::{Ink, Layer};

use crate::course::Course;
use crate::record::played;

#[test]
fn the_map_of_a_method_is_compared_with_the_exact_flow() {
    played(
        "back-to-the-start",
        "Open back-to-the-start\nSize 120x40\nSet eps = 0.5\nWait 3s\n\
         Assert flow.residual < 1e-13\nAssert flow.determinant > 0.9999999999\nAssert flow.determinant < 1.0000000001\n\
         Press :\nType \"method rk4\"\nPress Enter\nWait 1s\n\
         Assert flow.residual > 1e-10\nAssert flow.exact_residual < 1e-13\n\
         Press :\nType \"method leapfrog\"\nPress Enter\nWait 1s\n\
         Assert flow.residual < 1e-12\nAssert flow.expected = 1 within 1e-15\n",
    );
}

/// det M = exp(−c t/m), by closed form: at t = 3, with c/m = 0.4, e^(−1.2), to the time between two points.
#[test]
fn under_friction_the_determinant_decays() {
    played(
        "damped-oscillator",
        "Open damped-oscillator\nSize 120x40\nWait 3s\n\
         Assert flow.determinant > 0.300\nAssert flow.determinant < 0.312\n\
         Assert flow.expected > 0.300\nAssert flow.expected < 0.312\n",
    );
}

const OSCILLATOR: &str = "title = \"t\"\n[coordinates]\nq = { initial = 1.0, momentum = 0.0 }\n[parameters]\n\
                          w = { value = 1.0, min = 0.5, max = 5.0 }\n[hamiltonian]\nH = \"p_q^2/2 + w^2*q^2/2\"\n";

#[track_caller]
fn near(found: Option<f64>, expected: f64, within: f64) {
    let found = found.expect("a value");
    assert!((found - expected).abs() <= within, "{found} is not {expected} within {within}");
}

/// ω goes from 1 to 2 at t = 1: M of the recorded motion from there on is the closed form with ω = 2, over the time since then.
#[test]
fn after_a_change_the_map_is_that_of_the_motion_since_then() {
    let mut course = Course::showing("flow", OSCILLATOR);
    course.go(1.0);
    assert!(!course.legend().contains("since"), "{}", course.legend());
    course.set(0, 2.0);
    course.go(2.0001);
    let reported = course.legend();
    assert!(reported.contains("since t = 1, where w was changed"), "{reported}");
    assert!(reported.contains("M = (−0.4161 0.4546 | −1.819 −0.4161)"), "{reported}");
    // also in a session that is resumed
    let snapshot = course.experiment.snapshot();
    let (model, system) = (course.experiment.model(), course.experiment.system());
    let left = Checkpoint::of(model, system, &snapshot);
    let text = serde_json::to_string(&left).expect("text");
    let left: Checkpoint = serde_json::from_str(&text).expect("a checkpoint");
    let mut later = Course::showing("flow", OSCILLATOR);
    later.experiment.execute(Command::Restore(Box::new(left)));
    later.go(2.0002);
    assert_eq!(later.legend(), reported);
    // begun again it is one motion
    later.experiment.execute(Command::Reset);
    later.go(0.5);
    assert!(!later.legend().contains("since"), "{}", later.legend());
}

/// S = ½ (q p at the end − q p at the beginning) where L is quadratic; there is one path, the motion, in less than half a period.
#[test]
fn after_a_change_the_action_is_that_of_the_motion_since_then() {
    let (sin, cos) = (1.0_f64.sin(), 1.0_f64.cos());
    let (sin2, cos2) = (2.0_f64.sin(), 2.0_f64.cos());
    let (q, p) = (cos * cos2 - 0.5 * sin * sin2, -2.0 * cos * sin2 - sin * cos2);
    let action = 0.5 * (q * p + cos * sin);
    for (kind, word) in [("action", "value"), ("paths", "least"), ("paths", "greatest")] {
        let mut course = Course::showing(kind, OSCILLATOR);
        course.go(1.0);
        course.set(0, 2.0);
        course.go(2.01);
        near(course.measure(word), action, 1e-11);
        assert!(
            course.legend().contains("since t = 1, where w was changed"),
            "{}",
            course.legend()
        );
        assert!(kind != "paths" || course.legend().contains("the motion"), "{}", course.legend());
    }
    let mut course = Course::showing("action", OSCILLATOR);
    course.go(1.0);
    course.set(0, 2.0);
    course.go(2.01);
    near(course.measure("by_place"), p, 1e-11);
    near(course.measure("by_time"), -0.5 * p * p - 2.0 * q * q, 1e-11);
    assert!(course.legend().contains("= p, ∂S/∂t") && course.legend().contains("= −H"));
}

/// A method has a map of its own: after it is changed on the way M is that of the steps since then, here of `leapfrog`, whose
/// map of the oscillator in half a step of p, a step of q and half a step of p again is known.
#[test]
fn after_a_change_of_the_method_the_map_is_that_of_the_motion_since_then() {
    let (h, count) = (0.125_f64, 8);
    let own = [[1.0 - h * h / 2.0, h], [-h * (1.0 - h * h / 4.0), 1.0 - h * h / 2.0]];
    let mut power = [[1.0, 0.0], [0.0, 1.0]];
    for _ in 0..count {
        let entry = |i: usize, j: usize| (0..2).map(|k| own[i][k] * power[k][j]).sum::<f64>();
        power = [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]];
    }
    let mut course = Course::showing("flow", OSCILLATOR);
    course.go(1.0);
    course.experiment.execute(Command::Method("leapfrog".to_owned()));
    course.experiment.execute(Command::StepSize(h));
    course.go(2.01);
    let reported = course.legend();
    assert!(reported.contains("since t = 1, where the method was changed"), "{reported}");
    let written = |x: f64| phaselab::num::significant(x, 4, 1e-3..1e4).replace('-', "−");
    let [[a, b], [c, d]] = power.map(|row| row.map(written));
    assert!(reported.contains(&format!("M = ({a} {b} | {c} {d})")), "{reported}");
    // one that was chosen already is no change, nor is one before anything has moved
    course.experiment.execute(Command::Method("leapfrog".to_owned()));
    course.go(2.51);
    assert!(course.legend().contains("since t = 1,"), "{}", course.legend());
    let mut course = Course::showing("flow", OSCILLATOR);
    course.experiment.execute(Command::Method("leapfrog".to_owned()));
    course.go(1.0);
    assert!(!course.legend().contains("since"), "{}", course.legend());
}

/// Up to the event that ends a motion its map is that of the motion without it: (cos t, sin t | −sin t, cos t).
#[test]
fn a_motion_that_an_event_ends_has_its_map_until_then() {
    let text =
        format!("{OSCILLATOR}[[events]]\nname = \"end\"\nwhen = \"t - 3\"\naction = \"stop\"\n");
    let mut course = Course::showing("flow", &text);
    course.go(2.0001);
    let reported = course.legend();
    assert!(reported.contains("M = (−0.4161 0.9093 | −0.9093 −0.4161)"), "{reported}");
    near(course.measure("determinant"), 1.0, 1e-13);
}

/// An impulse carries the map on: p → p + k q at t = 1 and 2 has the derivative (1, 0 | k, 1), and one that halves p the determinant ½.
#[test]
fn an_impulse_carries_the_map_on() {
    let pushed = |change: &str| {
        format!(
            "{OSCILLATOR}[[impulses]]\nname = \"stroke\"\nat = [1.0, 2.0]\nchange = {{ p_q = \"{change}\" }}\n"
        )
    };
    let (sin, cos) = 1.0_f64.sin_cos();
    let turned = |[[a, b], [c, d]]: [[f64; 2]; 2]| {
        [[cos * a + sin * c, cos * b + sin * d], [cos * c - sin * a, cos * d - sin * b]]
    };
    let kicked = |[[a, b], [c, d]]: [[f64; 2]; 2]| [[a, b], [c + 3.0 * a, d + 3.0 * b]];
    let [[a, b], [c, d]] = turned(kicked(turned(kicked(turned([[1.0, 0.0], [0.0, 1.0]])))));
    let mut course = Course::showing("flow", &pushed("3*q"));
    course.go(3.0001);
    let written = |x: f64| phaselab::num::significant(x, 4, 1e-3..1e4).replace('-', "−");
    let [a, b, c, d] = [a, b, c, d].map(written);
    assert!(course.legend().contains(&format!("M = ({a} {b} | {c} {d})")), "{}", course.legend());
    near(course.measure("determinant"), 1.0, 1e-12);
    let mut course = Course::showing("flow", &pushed("-p_q/2"));
    for (time, expected) in [(0.95, 1.0), (1.5, 0.5), (1.95, 0.5), (2.5, 0.25)] {
        course.go(time);
        near(course.measure("determinant"), expected, 1e-12);
        near(course.measure("expected"), expected, 1e-12);
    }
}

/// Where the motion stands at the moment of a change, or before it, there is none that an action could be of.
#[test]
fn paused_at_a_change_there_is_no_path() {
    for kind in ["action", "abbreviated", "phase-action", "paths"] {
        let mut course = Course::showing(kind, OSCILLATOR);
        course.experiment.execute(Command::Play);
        course.go(1.0);
        course.experiment.execute(Command::Pause);
        course.set(0, 2.0);
        course.go(1.0);
        let said = "no motion yet since t = 1, where w was changed";
        assert_eq!(course.legend(), said, "{kind}");
        assert_eq!(course.measure(if kind == "paths" { "count" } else { "value" }), None);
        course.go(1.5);
        assert_ne!(course.legend(), said, "{kind}");
    }
}

/// H = ½ p² − a t q from (0, 0) at t = 0, a = 1, and a = 2 from t = 1 on: q = 2, p = 7/2 at t = 2.
#[test]
fn after_a_change_a_law_with_the_time_has_the_time_of_the_motion() {
    let text = "title = \"t\"\n[coordinates]\nq = { initial = 0.0, momentum = 0.0 }\n[parameters]\na = 1\n\
                [hamiltonian]\nH = \"p_q^2/2 - a*t*q\"\n";
    let mut course = Course::showing("action", text);
    course.go(1.0);
    course.set(0, 2.0);
    course.go(2.01);
    near(course.measure("by_place"), 3.5, 1e-11);
    near(course.measure("by_time"), 1.875, 1e-11);
}

/// A parameter that is set before anything has moved changes nothing on the way; one that changes what the file starts with does.
#[test]
fn a_change_at_the_start_is_none() {
    let mut course = Course::showing("flow", OSCILLATOR);
    course.set(0, 2.0);
    course.go(1.0);
    assert!(!course.legend().contains("since"), "{}", course.legend());
    let text = OSCILLATOR.replace("initial = 1.0", "initial = \"w\"");
    let mut course = Course::showing("flow", &text);
    course.set(0, 2.0);
    course.go(1.0);
    assert!(course.legend().contains("since t = 0, where w was changed"), "{}", course.legend());
}

/// ẍ = 2 x³ from x = ẋ = 1 is x = 1/(1 − t), and ends at t = 1: not before.
#[test]
fn why_a_map_ends_is_said_once_the_motion_is_there() {
    let text = "title = \"t\"\n[coordinates]\nq = { initial = 1, momentum = 1 }\n[hamiltonian]\nH = \"p_q^2/2 - q^4/2\"\n";
    let mut course = Course::showing("flow", text);
    course.go(0.5);
    let words = course.legend();
    assert_eq!(words.lines().count(), 3, "{words}");
    course.go(2.0);
    let words = course.legend();
    assert!(words.lines().count() > 3, "{words} at {}", course.experiment.time());
}

/// Under friction nothing of the exact flow is drawn, so that it is not computed.
#[test]
fn the_exact_flow_is_followed_where_it_is_drawn() {
    let mut course = Course::showing("flow", OSCILLATOR);
    course.experiment.execute(Command::Method("rk4".to_owned()));
    course.go(1.0);
    assert!(course.measure("exact_residual").is_some());
    let text = "title = \"t\"\n[coordinates]\nq = { initial = 1 }\n[lagrangian]\nL = \"q'^2/2 - q^2/2\"\n\
                dissipation = \"q'^2/10\"\n";
    let mut course = Course::showing("flow", text);
    course.experiment.execute(Command::Method("rk4".to_owned()));
    course.go(1.0);
    assert!(course.measure("determinant").is_some() && course.measure("exact_residual").is_none());
}

/// What only rounding leaves of ‖M𝕁Mᵀ − 𝕁‖ is said to be that, and drawn as a floor, not as a fence.
#[test]
fn rounding_is_a_floor() {
    let mut course = Course::showing("flow", OSCILLATOR);
    course.experiment.execute(Command::Method("leapfrog".to_owned()));
    course.go(3.0);
    let reported = course.legend();
    assert_eq!(reported.matches("at rounding (").count(), 2, "{reported}");
    assert!(reported.contains("of |M|²) by leapfrog"), "{reported}");
    let curves: Vec<Vec<[f64; 2]>> = (course.layers().into_iter())
        .filter_map(|layer| match layer {
            Layer::Line(points, stroke) if matches!(stroke.ink, Ink::Curve(_)) => Some(points),
            _ => None,
        })
        .collect();
    assert_eq!(curves.len(), 2);
    for curve in &curves {
        assert!(curve.len() > 100);
        let jump = curve.windows(2).map(|pair| (pair[1][1] - pair[0][1]).abs()).fold(0.0, f64::max);
        assert!(jump < 0.8, "{jump}");
        assert!(curve.iter().all(|at| at[1] > -16.0 && at[1] < -12.0), "{curve:?}");
    }
    course.experiment.execute(Command::Method("rk4".to_owned()));
    course.go(4.0);
    let reported = course.legend();
    assert!(reported.contains("by rk4, at rounding ("), "{reported}");
}

/// While it is paused a motion is varied, and true paths are searched for, up to the very time that is seen.
#[test]
fn a_paused_motion_is_varied_up_to_now() {
    for kind in ["action", "paths"] {
        let mut course = Course::showing(kind, OSCILLATOR);
        course.go(2.1234);
        assert!(format!("{}\n", course.legend()).contains("up to t = 2\n"), "{}", course.legend());
        course.experiment.execute(Command::Pause);
        course.go(2.1234);
        assert!(course.legend().contains("up to t = 2.1234"), "{}", course.legend());
    }
}

/// A ramp has its kinks at its times, whatever the state: M(30) of the slow oscillator as SciPy has it (DOP853, rtol 1e-13), and the
/// slopes of the action.
#[test]
fn a_law_with_a_ramp_has_its_flow_and_its_action() {
    let file = include_str!("../../presets/adiabatic/slow-oscillator.toml");
    let asked = ["flow", "system.toml", "--until=30", "--format=json"];
    let found = crate::cli::with_file(file, &asked).json();
    let text = found.to_string();
    let rows = found["matrix"].as_array().unwrap_or_else(|| panic!("{text}"));
    let entries: Vec<f64> = (rows.iter().flat_map(|row| row.as_array().expect("a row")))
        .map(|x| x.as_f64().expect("a number"))
        .collect();
    let known = [0.885851271751, -0.204651706579, 0.238526812879, 1.073752571128];
    assert_eq!(entries.len(), 4);
    for (found, known) in entries.iter().zip(known) {
        assert!((found - known).abs() < 1e-10, "{found} is not {known}");
    }
    let text = OSCILLATOR.to_owned()
        + "[[ramps]]\nparameter = \"w\"\nto = 2\nstart = 0.3\nduration = 1.1\nform = \"linear\"\n";
    let mut course = Course::showing("action", &text);
    course.go(2.01);
    let reported = course.legend();
    assert!(reported.contains("= p, ∂S/∂t") && reported.contains("= −H"), "{reported}");
    let mut course = Course::showing("flow", &text);
    course.go(2.01);
    near(course.measure("determinant"), 1.0, 1e-13);
    // a kink at a place of the state has no derivative there
    let mut course = Course::showing("flow", &OSCILLATOR.replace("w^2*q^2/2", "w*abs(q)"));
    course.go(0.5);
    assert!(course.legend().contains("kinks or jumps"), "{}", course.legend());
}
