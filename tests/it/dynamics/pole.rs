//! Where tangent vectors have no limit although the motion goes on: poles of coordinates, which steps lead up to or land
//! beyond; beside them places that are only narrow, against a closed form.

use std::fmt::Write as _;

use phaselab::dynamics::{Chaos, FlowMap, flow_map, lyapunov};
use phaselab::integrate::{Method, Settings, method_named};
use phaselab::system::MotionErrorKind;

use super::{Case, file, impulses, taylor};

/// A point on a sphere that moves along a meridian, and through a pole.
fn sphere(theta: f64, velocity: f64, more: &str) -> String {
    format!(
        "title = \"t\"\n[coordinates]\ntheta = {{ initial = {theta:?}, velocity = {velocity:?} }}\nphi = {{ initial = 0 }}\n\
         [lagrangian]\nL = \"1/2*(theta'^2 + sin(theta)^2*phi'^2) - cos(theta)\"\n{more}"
    )
}

fn by(name: &str, tolerance: Option<f64>) -> (&'static Method, Settings) {
    (method_named(name).unwrap(), Settings { step: None, tolerance })
}

fn map(case: &Case, method: (&'static Method, Settings), until: f64) -> FlowMap {
    flow_map(&case.space, method, &case.start, until, &mut |_| {}).unwrap()
}

/// At θ = π the angle has fewer digits than beside 0, and the last step lands beyond.
#[test]
fn a_pole_is_found_on_whichever_side_a_step_ends() {
    let cases = [
        ("dop853", None, 2.678, -1.0, 6.0),
        ("taylor", Some(1e-3), 1.8, -1.0, 6.0),
        ("taylor", None, 1.8, 1.0, 3.0),
        ("taylor", None, 1.0, -2.0, 3.0),
        ("dop853", Some(1e-6), 1.0, -2.0, 3.0),
    ];
    for (name, tolerance, theta, velocity, until) in cases {
        let case = file(&sphere(theta, velocity, ""), &[]);
        let found = map(&case, by(name, tolerance), until);
        let error = found.error.unwrap_or_else(|| panic!("{name} {theta}: {}", found.matrix));
        assert_eq!(error.kind, MotionErrorKind::NoDerivative, "{name} {theta}");
        let angle = case.space.variables(&found.state)[0];
        assert!(angle.sin().abs() < 1e-11, "{name} {theta}: {angle}");
    }
}

#[test]
fn a_pole_behind_an_impulse_is_none_of_the_motion() {
    let kick = "[[impulses]]\nname = \"kick\"\nat = [0.3]\nchange = { p_theta = \"0.1\" }\n";
    for name in ["taylor", "dop853"] {
        for (theta, velocity) in [(2.0, 1.0), (1.8, 1.0), (2.678, -1.0), (1.0, -2.0)] {
            let case = impulses::file(&sphere(theta, velocity, kick));
            let found = map(&case, by(name, None), 6.0);
            let kind = found.error.map(|error| error.kind);
            assert_eq!(kind, Some(MotionErrorKind::NoDerivative), "{name} {theta}");
        }
    }
}

#[test]
fn exponents_end_at_a_pole() {
    let kick = "[[impulses]]\nname = \"kick\"\nat = [0.3]\nchange = { p_theta = \"0.1\" }\n";
    for (theta, velocity) in [(2.0, 1.0), (2.678, -1.0), (1.0, -2.0)] {
        for case in [
            file(&sphere(theta, velocity, ""), &[]),
            impulses::file(&sphere(theta, velocity, kick)),
        ] {
            let found = lyapunov(&case.space, taylor(), &case.start, 6.0, &mut |_| {}).unwrap();
            assert_eq!(found.verdict, Chaos::Undecided);
            assert!(found.reason.contains("no limit"), "{theta}: {}", found.reason);
        }
    }
}

/// Where x passes 0 the rate of y is p/(x² + ε²), so that ∂y/∂p_y = (atan(x₁/ε) − atan(x₀/ε))/(ε v): steps become as short
/// as ε, and nothing is wrong.
#[test]
fn what_is_only_narrow_has_its_derivative() {
    let mut text = String::new();
    for width in [1e-3, 1e-6, 1e-9] {
        text.clear();
        write!(
            text,
            "title = \"t\"\n[coordinates]\nx = {{ initial = -0.7, velocity = 1 }}\ny = {{ initial = 0 }}\n\
             [lagrangian]\nL = \"1/2*x'^2 + 1/2*(x^2 + {:?})*y'^2\"\n",
            width * width
        )
        .unwrap();
        let case = file(&text, &[]);
        for name in ["taylor", "dop853"] {
            let found = map(&case, by(name, Some(1e-12)), 2.0);
            assert_eq!(found.error, None, "{name} {width}");
            let exact = ((1.3_f64 / width).atan() + (0.7_f64 / width).atan()) / width;
            let off = (found.matrix[(1, 3)] / exact - 1.0).abs();
            // x has as many digits there as 0.7
            assert!(off < 1e-9 + 1e-15 / width, "{name} {width}: {off:e}");
        }
    }
}

/// Next to a pole a motion that has some momentum about it has short steps of its own.
#[test]
fn a_motion_close_by_a_pole_has_its_derivative() {
    for momentum in ["1e-4", "1e-7"] {
        let text = sphere(1.0, -2.0, "").replace(
            "phi = { initial = 0 }",
            &format!("phi = {{ initial = 0, velocity = \"{momentum}/sin(1)^2\" }}"),
        );
        let case = file(&text, &[]);
        for name in ["taylor", "dop853"] {
            let found = map(&case, by(name, Some(1e-12)), 1.0);
            assert_eq!(found.error, None, "{name} {momentum}");
            // the azimuth turns by half a turn there
            let turned = case.space.variables(&found.state)[1];
            assert!((turned - std::f64::consts::PI).abs() < 1e-3, "{name} {momentum}: {turned}");
        }
    }
}

/// Where the digits of the time are as far apart as steps are long, these end the motion, and no pole.
#[test]
fn a_clock_that_stands_is_no_pole() {
    for name in ["taylor", "dop853"] {
        let late = file(&sphere(1.0, -1.0, "[run]\nstart = 1e15\n"), &[]);
        let found = map(&late, by(name, None), 1e15 + 100.0);
        let kind = found.error.map(|error| error.kind);
        assert_eq!(kind, Some(MotionErrorKind::ClockStands(0.125)), "{name}");
    }
}

/// Steps of fixed size, and those that follow their own errors, lead past a pole with vectors that mean nothing: the motion along the
/// meridian is regular, and neither this nor the opposite is said of it.
#[test]
fn exponents_of_steps_beyond_a_pole_tell_nothing() {
    for (theta, velocity) in [(2.0, 1.0), (2.678, -1.0), (1.0, -2.0), (0.5, 1.0)] {
        let case = file(&sphere(theta, velocity, ""), &[]);
        for (name, step) in [("dop853", None), ("gauss6", Some(0.01)), ("rk4", Some(0.01))] {
            let method = (method_named(name).unwrap(), Settings { step, tolerance: None });
            let found = lyapunov(&case.space, method, &case.start, 20.0, &mut |_| {}).unwrap();
            assert_eq!(found.verdict, Chaos::Undecided, "{name} {theta}: {}", found.reason);
            let says = found.reason.contains("pole") || found.reason.contains("no limit");
            assert!(says, "{name} {theta}: {}", found.reason);
        }
    }
    // beside the poles there is nothing to be said
    let around = sphere(2.0, 0.3, "")
        .replace("phi = { initial = 0 }", "phi = { initial = 0, velocity = 1.5 }");
    let case = file(&around, &[]);
    for (name, step) in [("dop853", None), ("gauss6", Some(0.05)), ("rk4", Some(0.01))] {
        let method = (method_named(name).unwrap(), Settings { step, tolerance: None });
        let found = lyapunov(&case.space, method, &case.start, 200.0, &mut |_| {}).unwrap();
        assert_eq!(found.verdict, Chaos::Regular, "{name}: {}", found.reason);
    }
}
