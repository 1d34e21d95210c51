//! Orders of convergence on nonlinear problems, with a lower and an upper bound: a method that is
//! better than stated has not been understood.

use phaselab::integrate::{METHODS, Method, Settings, Stepping};
use phaselab::system::Form;

use crate::build::lagrangian;
use crate::nonempty;

use super::{
    Case, case, distance, double_pendulum, driven, entangled, fixed, heavy_top, named, pendulum,
    quartic,
};

/// The slopes of the error over two halvings of the step.
fn slopes(case: &Case, method: &Method, step: f64, time: f64) -> [f64; 2] {
    let exact = case.exact(time);
    let errors =
        [1.0, 0.5, 0.25].map(|part| distance(&case.run(method, step * part, time), &exact));
    [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()]
}

fn check(case: &Case, method: &Method, step: f64, time: f64) {
    let order = f64::from(method.order.expect("an order"));
    for slope in slopes(case, method, step, time) {
        let name = method.name;
        assert!(slope > order - 0.3 && slope < order + 0.5, "{name}: {slope} for {order}");
    }
}

/// A step at which the errors are well above rounding.
fn step_for(method: &Method) -> f64 {
    match method.order.expect("an order") {
        1 => 0.002,
        2 => 0.02,
        4 => 0.05,
        6 => 0.1,
        _ => 0.2,
    }
}

#[test]
fn on_the_pendulum() {
    for method in nonempty(fixed()) {
        check(&pendulum(), method, step_for(method), 4.0);
    }
}

#[test]
fn where_time_is_explicit() {
    for method in nonempty(fixed()) {
        check(&driven(), method, step_for(method), 4.0);
    }
}

#[test]
fn where_h_does_not_separate() {
    for name in ["rk4", "symplectic-euler", "gauss4", "gauss6"] {
        check(&entangled(), named(name), step_for(named(name)), 2.0);
    }
}

#[test]
fn on_the_double_pendulum() {
    for name in ["rk4", "symplectic-euler", "gauss4", "gauss6"] {
        check(&double_pendulum(), named(name), step_for(named(name)), 2.0);
    }
}

#[test]
fn where_momenta_are_solved_for_velocities() {
    for name in ["rk4", "symplectic-euler", "gauss4", "gauss6"] {
        check(&quartic(), named(name), step_for(named(name)), 4.0);
    }
}

#[test]
fn dop853_follows_its_tolerance() {
    for case in [pendulum(), driven(), entangled(), double_pendulum(), quartic(), heavy_top()] {
        let exact = case.exact(3.0);
        let size = exact.values.iter().map(|x| x.abs()).fold(1.0, f64::max);
        let error = |tolerance: f64| {
            let settings = Settings { step: None, tolerance: Some(tolerance) };
            let mut stepper = case.stepper_with(named("dop853"), settings);
            distance(&case.continue_to(stepper.as_mut(), 3.0), &exact) / size
        };
        for tolerance in [1e-5, 1e-7, 1e-9, 1e-11] {
            let error = error(tolerance);
            let part = error / tolerance;
            assert!(part < 100.0 && part > 1e-4, "{error:e} at {tolerance:e}");
        }
        assert!(error(1e-13) < 1e-12);
    }
}

#[test]
fn dop853_is_known_inside_its_steps() {
    let case = driven();
    let settings = Settings { step: None, tolerance: Some(1e-9) };
    let mut stepper = case.stepper_with(named("dop853"), settings);
    let mut state = case.start.clone();
    let mut steps = 0;
    while stepper.time() < 10.0 {
        stepper.step(10.0).expect("goes on");
        let (begin, end) = stepper.interval();
        for part in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let time = begin + part * (end - begin);
            stepper.at(time, &mut state).expect("inside");
            let error = distance(&state, &case.exact(time));
            assert!(error < 1e-7, "{error:e} at {time}");
        }
        steps += 1;
    }
    assert!(steps < 60, "{steps} steps");
}

/// The error of a thousand steps of length 1e-3.
fn allowed(method: &Method) -> f64 {
    match method.order {
        Some(1) => 5e-3,
        Some(2) => 1e-6,
        _ => 2e-12,
    }
}

#[test]
fn small_steps_agree_with_the_series() {
    let exact = double_pendulum().exact(1.0);
    for method in METHODS.iter().filter(|method| (method.fits)(&double_pendulum().system).is_ok()) {
        let error = distance(&double_pendulum().run(method, 1e-3, 1.0), &exact);
        assert!(error < allowed(method), "{}: {error:e}", method.name);
    }
    let exact = driven().exact(1.0);
    for method in METHODS {
        let error = distance(&driven().run(method, 1e-3, 1.0), &exact);
        assert!(error < allowed(method), "{}: {error:e}", method.name);
    }
}

#[test]
fn the_step_is_the_motions_own_where_none_is_asked_for() {
    for method in METHODS.iter().filter(|method| method.stepping == Stepping::Fixed) {
        let stepper = pendulum().stepper_with(method, Settings::default());
        let period = 2.0 * std::f64::consts::PI;
        let steps = period / stepper.step_size();
        assert!(steps > 50.0 && steps < 300.0, "{}: {steps} steps a period", method.name);
    }
}

#[test]
fn dop853_leaves_a_kink_at_its_tolerance() {
    // |x| written three ways, from x = 0: x(t) = v t ∓ k t²/2 on the side to which it moves
    let (k, t): (f64, f64) = (0.229, 0.5);
    for kink in ["0.229*abs(x)", "0.229*(x^2)^0.5", "0.229*max(x, -x)"] {
        for v in [0.904_f64, -0.904] {
            let l = format!("1/2*x'^2 - {kink}");
            let case = case(lagrangian(&["x"], &[], &l), Form::Velocity, &[0.0, v]);
            let settings = Settings { step: None, tolerance: Some(1e-11) };
            let mut stepper = case.stepper_with(named("dop853"), settings);
            while stepper.time() != t {
                stepper.step(t).unwrap();
            }
            let expected = v * t - v.signum() * k * t * t / 2.0;
            let found = stepper.state().values[0];
            assert!((found - expected).abs() < 1e-9, "{kink}, {v}: {found} for {expected}");
        }
    }
}

/// A ball between soft walls, x″ = ∓ω² times how deep it is in one: a free flight, half a period of the oscillator, and back. The
/// first tries at a wall lead far beyond it; what rounding does there must not count where the motion is.
#[test]
fn dop853_keeps_to_its_tolerance_at_a_steep_wall() {
    for (strength, v) in [(1e6_f64, 1.3), (1e8, 1.1)] {
        let omega = (2.0 * strength).sqrt();
        let exact = |t: f64| {
            let (flight, contact) = (2.0 / v, std::f64::consts::PI / omega);
            let since = t - 1.0 / v;
            let contacts = (since / (flight + contact)).floor();
            let after = since - contacts * (flight + contact);
            let side = if contacts % 2.0 == 0.0 { 1.0 } else { -1.0 };
            if after < contact {
                side * (1.0 + v / omega * (omega * after).sin())
            } else {
                side * (1.0 - v * (after - contact))
            }
        };
        let l = format!("1/2*x'^2 - {strength:e}*max(0, abs(x) - 1)^2");
        let case = case(lagrangian(&["x"], &[], &l), Form::Velocity, &[0.0, v]);
        for tolerance in [1e-4, 1e-6, 1e-9, 1e-12] {
            let settings = Settings { step: None, tolerance: Some(tolerance) };
            let mut stepper = case.stepper_with(named("dop853"), settings);
            let (mut steps, mut worst) = (0, 0.0_f64);
            for t in (1..=30).map(f64::from) {
                while stepper.time() != t {
                    stepper.step(t).expect("goes on");
                    steps += 1;
                }
                worst = worst.max((stepper.state().values[0] - exact(t)).abs());
            }
            // below that the last digits of |x| − 1, which are multiplied by ω², decide
            let reached = tolerance.max(1e-11);
            assert!(worst < 3e4 * reached, "{strength:e} at {tolerance:e}: {worst:e}");
            assert!(steps < 20_000, "{strength:e} at {tolerance:e}: {steps} steps");
        }
    }
}
