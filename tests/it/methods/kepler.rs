//! Kepler's problem of eccentricity 0.6 in equal steps from the pericentre: energy errors compared with
//! an independent computation with the same methods.

use phaselab::system::State;

use super::{kepler, named};

/// Errors over some periods.
struct Drift {
    /// max |ΔE/E| over all steps.
    energy: f64,
    /// |ΔL| at the end.
    momentum: f64,
    /// The rotation of the direction of the pericentre.
    turn: f64,
}

fn drift(method: &str, steps: u32, periods: u32) -> Drift {
    let case = kepler(0.6);
    let mut stepper = case.stepper(named(method), std::f64::consts::TAU / f64::from(steps));
    let mut most = 0.0_f64;
    for _ in 0..steps * periods {
        stepper.step(1e9).expect("goes on");
        most = most.max((energy(stepper.state()) / energy(&case.start) - 1.0).abs());
    }
    let end = stepper.state();
    Drift { energy: most, momentum: (spin(end) - spin(&case.start)).abs(), turn: pericentre(end) }
}

fn energy(state: &State) -> f64 {
    let [x, y, px, py] = state.values[..4] else { panic!("four numbers") };
    0.5 * (px * px + py * py) - 1.0 / x.hypot(y)
}

fn spin(state: &State) -> f64 {
    let [x, y, px, py] = state.values[..4] else { panic!("four numbers") };
    x * py - y * px
}

/// The angle of the Runge–Lenz vector.
fn pericentre(state: &State) -> f64 {
    let [x, y, px, py] = state.values[..4] else { panic!("four numbers") };
    let (l, r) = (spin(state), x.hypot(y));
    (-px * l - y / r).atan2(py * l - x / r)
}

/// Asserts equality to the digits given.
fn check(found: f64, digits: &str) {
    let expected: f64 = digits.parse().expect("a number");
    let places = digits.split('e').next().map_or(0, |mantissa| mantissa.len() - 2);
    let unit = 10f64.powi(expected.log10().floor() as i32 - places as i32);
    assert!((found - expected).abs() <= 0.6 * unit, "{found:e} is not {digits}");
}

#[test]
fn a_hundred_steps_a_period() {
    check(drift("leapfrog", 100, 10).energy, "2.989e-2");
    check(drift("leapfrog", 100, 1000).energy, "2.989e-2");
    check(drift("yoshida4", 100, 10).energy, "1.404e-3");
    check(drift("yoshida4", 100, 1000).energy, "1.404e-3");
    check(drift("rk4", 100, 10).energy, "2.195e-3");
    check(drift("rk4", 100, 1000).energy, "2.293e-1");
}

#[test]
fn four_hundred_steps_a_period() {
    let leapfrog = drift("leapfrog", 400, 1000);
    check(leapfrog.energy, "1.831e-3");
    assert!(leapfrog.momentum < 1.2e-13);
    // a correct energy does not imply a correct orbit
    assert!((leapfrog.turn + 1.61).abs() < 0.01, "{}", leapfrog.turn);
    let fourth = drift("yoshida4", 400, 1000);
    check(fourth.energy, "6.074e-6");
    assert!(fourth.momentum < 1.2e-13);
    check(drift("rk4", 400, 10).energy, "2.368e-6");
    let classic = drift("rk4", 400, 1000);
    check(classic.energy, "2.083e-4");
    check(classic.momentum, "1.9e-5");
}
