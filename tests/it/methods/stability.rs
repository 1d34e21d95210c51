//! Fixed steps beyond the stability limit are reported, and only these.

use phaselab::integrate::{Method, Settings, Stepper};
use phaselab::system::Form;

use crate::build::{dissipative, hamiltonian, lagrangian};
use crate::nonempty;

use super::{Case, case, double_pendulum, fixed, heavy_top, named, pendulum};

/// An oscillator of mass m and frequency w, started at amplitude a.
fn oscillator(mass: f64, w: f64, a: f64) -> Case {
    let h = format!("p_q^2/(2*{mass:e}) + {mass:e}*{w:e}^2*q^2/2");
    case(hamiltonian(&["q"], &[], &h), Form::Momentum, &[a, 0.0])
}

/// Takes a number of steps; returns the largest number of the state on the way.
fn go(stepper: &mut dyn Stepper, steps: usize) -> f64 {
    let mut largest = 0.0_f64;
    for _ in 0..steps {
        if stepper.step(1e9).is_err() || stepper.state().values[0].abs() > 1e30 {
            return f64::INFINITY;
        }
        largest = largest.max(stepper.state().values[0].abs());
    }
    largest
}

fn limit(case: &Case, method: &Method, step: f64) -> Option<f64> {
    let mut stepper = case.stepper(method, step);
    let _ = stepper.step(1e6 * step);
    stepper.unstable().map(|found| found.limit)
}

#[test]
fn the_reported_limit_is_where_amplitudes_begin_to_grow() {
    let case = oscillator(1.0, 1.0, 1.0);
    for name in ["leapfrog", "symplectic-euler", "yoshida4", "yoshida6", "yoshida8", "rk4"] {
        let method = named(name);
        let limit = limit(&case, method, 5.0).unwrap_or_else(|| panic!("{name}"));
        assert!(go(case.stepper(method, 0.98 * limit).as_mut(), 4000) < 30.0, "{name} {limit}");
        let mut beyond = case.stepper(method, 1.02 * limit);
        assert!(go(beyond.as_mut(), 4000) > 1e3, "{name} {limit}");
        let reported = beyond.unstable().unwrap_or_else(|| panic!("{name}"));
        assert_eq!((reported.time, reported.step), (0.0, 1.02 * limit));
        let mut within = case.stepper(method, 0.98 * limit);
        go(within.as_mut(), 600);
        assert_eq!(within.unstable(), None, "{name}");
    }
}

#[test]
fn known_limits_are_met() {
    // 2 for the leapfrog and its conjugate; 2√2 on the imaginary axis and 2.785… on the real one for rk4
    let case = oscillator(1.0, 1.0, 1.0);
    let near = |found: Option<f64>, wanted: f64| {
        let found = found.expect("reported");
        assert!((found / wanted - 1.0).abs() < 0.02, "{found} for {wanted}");
    };
    near(limit(&case, named("leapfrog"), 2.3), 2.0);
    near(limit(&case, named("symplectic-euler"), 2.3), 2.0);
    near(limit(&case, named("rk4"), 3.0), 8_f64.sqrt());
    let damped = dissipative(&["x"], &[], "1/2*x'^2 - 1/2*x^2", "500*x'^2", &["0"]);
    let damped = self::case(damped, Form::Velocity, &[1.0, 0.0]);
    near(limit(&damped, named("rk4"), 0.003), 2.785e-3);
    assert_eq!(limit(&damped, named("rk4"), 0.0027), None);
}

#[test]
fn units_do_not_matter() {
    // an electron in an atom, in SI units
    let case = oscillator(9.1e-31, 1e16, 1e-10);
    let found = limit(&case, named("leapfrog"), 2.2e-16).expect("reported");
    assert!((found / 2e-16 - 1.0).abs() < 0.02, "{found:e}");
    assert_eq!(limit(&case, named("leapfrog"), 1.9e-16), None);
}

#[test]
fn what_grows_by_itself_is_not_caused_by_the_method() {
    let saddle = case(hamiltonian(&["q"], &[], "p_q^2/2 - q^2/2"), Form::Momentum, &[1.0, 0.2]);
    let growing = lagrangian(&["x"], &[], "exp(-t/50)*(x'^2 - x^2)/2");
    let growing = case(growing, Form::Velocity, &[1.0, 0.0]);
    for (case, name, step) in
        [(&saddle, "leapfrog", 0.5), (&saddle, "rk4", 0.5), (&growing, "rk4", 0.5)]
    {
        assert_eq!(limit(case, named(name), step), None, "{name}");
    }
}

#[test]
fn steps_where_none_are_asked_for_are_stable() {
    for case in [pendulum(), double_pendulum(), heavy_top()] {
        for method in nonempty(fixed().filter(|method| (method.fits)(&case.system).is_ok())) {
            let mut stepper = case.stepper_with(method, Settings::default());
            for _ in 0..600 {
                stepper.step(1e6).expect("goes on");
            }
            assert_eq!(stepper.unstable(), None, "{}", method.name);
        }
    }
}
