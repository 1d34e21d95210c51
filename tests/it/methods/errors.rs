//! What a method cannot do, and how it reports that.

use phaselab::diagnostic::Document;
use phaselab::experiment::{Prepared, Status};
use phaselab::integrate::{METHODS, Settings, Stepping};
use phaselab::system::{Form, MotionErrorKind};

use crate::build::{dissipative, hamiltonian, lagrangian};
use crate::nonempty;
use crate::system::compile;

use super::{Case, case, double_pendulum, fixed, named, pendulum, quartic};

/// The reason why a method refuses a system.
fn method_error(case: &Case, name: &str) -> String {
    let method = named(name);
    let why = (method.fits)(&case.system).expect_err("does not fit");
    let made = (method.make)(&case.system, &Settings::default()).err();
    assert_eq!(made.as_ref(), Some(&why));
    why.to_string()
}

#[test]
fn splitting_refuses_what_does_not_split_and_says_why() {
    let polar = hamiltonian(&["r", "phi"], &[], "p_r^2/2 + p_phi^2/(2*r^2) - 1/r");
    assert_eq!(
        method_error(&case(polar, Form::Momentum, &[1.0, 0.0, 0.0, 1.0]), "leapfrog"),
        "leapfrog cannot be used here: H is not of the form T(p) + V(q, t): ∂²H/∂p_phi∂r does \
         not vanish"
    );
    let damped = dissipative(&["x"], &["c"], "1/2*x'^2 - 1/2*x^2", "1/2*c*x'^2", &["0"]);
    assert_eq!(
        method_error(&case(damped, Form::Velocity, &[1.0, 0.0]), "yoshida4"),
        "yoshida4 cannot be used here: a force acts that does not come from H"
    );
    assert_eq!(
        method_error(&quartic(), "yoshida8"),
        "yoshida8 cannot be used here: there is no H in closed form: L is not quadratic in the \
         velocities"
    );
    let growing = hamiltonian(&["x"], &[], "p_x^2*exp(t)/2 + x^2/2");
    assert_eq!(
        method_error(&case(growing, Form::Momentum, &[1.0, 0.0]), "yoshida6"),
        "yoshida6 cannot be used here: H is not of the form T(p) + V(q, t): ∂²H/∂p_x∂t does not \
         vanish"
    );
}

#[test]
fn a_lagrangian_that_splits_is_accepted() {
    let l = "1/2*x'^2 + x'*y' + y'^2 - 1/4*x^4 - x*y";
    let case = case(lagrangian(&["x", "y"], &[], l), Form::Velocity, &[0.5, 0.2, 0.1, -0.3]);
    for method in METHODS {
        assert_eq!((method.fits)(&case.system), Ok(()), "{}", method.name);
    }
}

#[test]
fn settings_without_sense_are_refused() {
    let message = |name: &str, settings: Settings| {
        let made = (named(name).make)(&pendulum().system, &settings);
        made.err().expect("refused").to_string()
    };
    for (step, shown) in [(0.0, "0"), (-0.1, "-0.1"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        for method in fixed() {
            assert_eq!(
                message(method.name, Settings { step: Some(step), tolerance: None }),
                format!("{} cannot be used here: the step {shown} is not above zero", method.name)
            );
        }
    }
    // beyond which times cannot be counted
    for (step, shown) in [(1.1e290, "1.1e290"), (1e307, "1e307")] {
        for method in fixed() {
            assert_eq!(
                message(method.name, Settings { step: Some(step), tolerance: None }),
                format!(
                    "{} cannot be used here: the step {shown} is longer than 1e290",
                    method.name
                )
            );
        }
    }
    for method in fixed() {
        let settings = Settings { step: Some(1e290), tolerance: None };
        assert!((method.make)(&pendulum().system, &settings).is_ok(), "{}", method.name);
    }
    assert_eq!(
        message("dop853", Settings { step: None, tolerance: Some(1e-18) }),
        "dop853 cannot be used here: the tolerance 1e-18 is not between 1e-15 and 1"
    );
}

/// The message of a method that cannot continue; the previous state is retained and finite.
fn error(case: &Case, name: &str, step: f64, until: f64) -> String {
    let mut stepper = case.stepper(named(name), step);
    let mut steps = 0;
    loop {
        let before = stepper.state().clone();
        if let Err(error) = stepper.step(until) {
            assert_eq!(stepper.state(), &before, "{name}");
            assert!(stepper.state().is_finite());
            return error.to_string();
        }
        steps += 1;
        assert!(stepper.time() < until && steps < 100_000, "{name} arrived");
    }
}

#[test]
fn an_implicit_step_too_long_to_be_solved_is_an_error() {
    for name in ["gauss4", "gauss6"] {
        assert_eq!(
            error(&double_pendulum(), name, 5.0, 100.0),
            "the implicit step of size 5e0 was not solved at t = 0, x = 0.9, y = -0.4: try a \
             smaller step"
        );
    }
}

#[test]
fn a_pole_is_an_error() {
    // x = t − 1 arrives at a pole
    let h = "p_x + 1/x";
    let case = case(hamiltonian(&["x"], &[], h), Form::Momentum, &[-1.0, 0.0]);
    assert_eq!(
        error(&case, "rk4", 0.125, 2.0),
        "p_x is no longer finite at t = 1, x = 0: a collision, a pole, or a value \
         outside a function"
    );
    let message = error(&case, "dop853", 0.0, 2.0);
    assert!(
        message.starts_with("the step became too small to move the clock at t = "),
        "{message}"
    );
}

#[test]
fn a_singular_mass_matrix_is_an_error() {
    let l = "1/2*x^2*x'^2 + 1/2*y'^2 + x";
    let case = case(lagrangian(&["x", "y"], &[], l), Form::Velocity, &[0.0, 0.0, 0.0, 0.0]);
    for method in METHODS.iter().filter(|method| (method.fits)(&case.system).is_ok()) {
        let settings = match method.stepping {
            Stepping::Fixed => Settings { step: Some(0.1), tolerance: None },
            Stepping::Adaptive => Settings::default(),
        };
        let mut stepper = (method.make)(&case.system, &settings).expect("fits");
        let outcome = stepper.start(&case.start, &[]).and_then(|()| stepper.step(1.0));
        let message = outcome.expect_err("an error").to_string();
        assert_eq!(
            message,
            "the mass matrix is singular at t = 0, x = 0: a chart singularity or a degenerate \
             Lagrangian",
            "{}",
            method.name
        );
    }
}

/// A stage of a step that is too long lies far from the motion, where the mass underflows.
#[test]
fn a_mass_that_vanishes_within_a_fixed_step_is_blamed_on_the_step() {
    let text = "title = \"Steep\"\n[coordinates]\nr = { initial = 0.992, velocity = -0.41 }\n\
                [lagrangian]\nL = \"1/2*exp(0.819*r)*r'^2 - 3*exp(5*(r + 5))\"\n\
                [run]\nmethod = \"rk4\"\nstep = 1.25\n";
    let mut ready = Prepared::of(&Document::new("steep.toml", text.to_owned())).expect("a file");
    ready.experiment.advance(5.0, u64::MAX);
    let Status::Failed(error) = ready.experiment.status() else { panic!("it runs") };
    assert!(
        error.message.contains("t = 0.625")
            && error.message.ends_with("try a smaller step, unless a chart singularity lies there"),
        "{}",
        error.message
    );
}

#[test]
fn a_number_that_is_zero_but_for_rounding_does_not_stop_dop853() {
    // the force on z vanishes identically, but not in the last digits
    let h = "(p_x^2 + p_z^2)/2 - cos(x) + z*(tanh(2*x)*(1 + tanh(x)^2) - 2*tanh(x))";
    let case = case(hamiltonian(&["x", "z"], &[], h), Form::Momentum, &[1.2, 0.0, 0.5, 0.0]);
    let mut stepper = case.stepper_with(named("dop853"), Settings::default());
    let mut steps = 0;
    while stepper.time() < 20.0 {
        stepper.step(20.0).expect("goes on");
        steps += 1;
        assert!(steps < 400, "at {}", stepper.time());
    }
    assert!(steps < 400, "{steps} steps");
    assert!(stepper.state().values[1].abs() < 1e-12);
}

/// A pulse long before its time, where e^u is below the range of normal numbers and has few digits.
#[test]
fn a_force_without_digits_does_not_stop_dop853() {
    let l = "1/2*x'^2 - 1/2*1e6*x^2 + 1e6*x*exp(-((t - 0.03)/0.001)^2)";
    let case = case(lagrangian(&["x"], &[], l), Form::Velocity, &[0.8, 0.0]);
    let mut stepper = case.stepper_with(named("dop853"), Settings::default());
    let mut steps = 0;
    while stepper.time() < 0.005 {
        stepper.step(0.005).expect("goes on");
        steps += 1;
        assert!(steps < 400, "at {}", stepper.time());
    }
    assert!((stepper.state().values[0] - 0.8 * 5.0_f64.cos()).abs() < 1e-11);
}

#[test]
fn every_method_stops_where_somebody_asks() {
    for method in METHODS.iter().filter(|method| method.name != "taylor") {
        let case = pendulum();
        let mut stepper = case.stepper(method, 0.01);
        stepper.step(1.0).expect("goes on");
        case.system.cancel().cancel();
        let error = stepper.step(1.0).expect_err("stops");
        assert_eq!(error.kind, MotionErrorKind::Cancelled, "{}", method.name);
    }
}

#[test]
fn steps_that_cannot_be_counted_to_the_end_are_refused_at_once() {
    for method in nonempty(fixed()) {
        let mut stepper = pendulum().stepper(method, 1e-300);
        let message = stepper.step(10.0).expect_err("too many").to_string();
        assert!(
            message.starts_with(
                "steps of size 1e-300 from t = 0 are too many to be counted up to t = 10"
            ),
            "{}: {message}",
            method.name
        );
        // integers up to 2⁵³ are exact
        let step = 10.0 / 9.0e15;
        pendulum().stepper(method, step).step(10.0).expect("goes on");
        let step = 10.0 / 9.1e15;
        pendulum().stepper(method, step).step(10.0).expect_err("too many");
    }
}

#[test]
fn steps_do_not_vanish_before_a_singularity() {
    // a particle reaches the centre at t = π/√8; the step fits the motion up to there
    let fall = case(hamiltonian(&["x"], &[], "p_x^2/2 - 1/x"), Form::Momentum, &[1.0, 0.0]);
    let stepper = fall.stepper_with(named("rk4"), Settings::default());
    assert!(stepper.step_size() > 1e-7, "{:e}", stepper.step_size());
}

/// A force on y that jumps where x = sin t passes ½: until then y and its rate are 0, and no step is short enough for a
/// part of them.
#[test]
fn a_number_that_begins_to_move_at_a_kink_does_not_stop_an_adaptive_method() {
    let l = "1/2*x'^2 + 1/2*y'^2 - 1/2*x^2";
    let model = dissipative(&["x", "y"], &[], l, "0", &["0", "1 + sign(x - 1/2)"]);
    let case = case(model, Form::Velocity, &[0.0, 0.0, 1.0, 0.0]);
    let way = 2.0 * std::f64::consts::PI / 3.0;
    let rest = 3.0 - 5.0 * std::f64::consts::PI / 6.0;
    for (name, within) in [("taylor", 1e-14), ("dop853", 1e-11)] {
        let state = case.run(named(name), 0.01, 3.0);
        let expected = [3.0_f64.sin(), way * way + 2.0 * way * rest, 3.0_f64.cos(), 2.0 * way];
        for (found, expected) in state.values.iter().zip(expected) {
            assert!((found - expected).abs() < within, "{name}: {found}, not {expected}");
        }
    }
}

/// A number that decays below the range of `f64`, where its digits no longer follow its size, is solved for all the same: x'' = −x − x'
/// is e^{−t/2} in size.
#[test]
fn implicit_methods_follow_a_decay_to_zero() {
    let text = "title = \"Damped\"\n[coordinates]\nx = { initial = 1 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n\
                dissipation = \"x'^2/2\"\n";
    let (model, system) = compile(text);
    let start = system.initial(0.0, &model.parameter_values(), &[]).unwrap();
    let case = Case { system, start, parameters: model.parameter_values() };
    for name in ["gauss4", "gauss6"] {
        let state = case.run(named(name), 0.1, 1600.0);
        assert!(state.values[..2].iter().all(|x| x.abs() < 1e-300), "{name}: {:?}", state.values);
    }
}
