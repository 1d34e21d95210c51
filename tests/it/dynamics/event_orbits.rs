//! Periodic orbits over impulses that events cause, against closed forms.

use std::f64::consts::TAU;

use phaselab::dynamics::{Fixed, Orbit, driven_orbit, periodic_orbit};
use phaselab::num::math;

use super::impulses::file;
use super::taylor;

#[track_caller]
fn near(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within, "{found} is not {expected} within {within}");
}

/// A ball over a floor at y = A sin ω t, which returns it with restitution e; it begins at the floor.
fn ball(amplitude: f64, omega: f64, restitution: f64, momentum: f64, time: f64) -> String {
    let height = amplitude * math::sin(omega * time);
    // a floor at rest is none that moves by nothing: time is not in its law
    let (floor, speed) = match amplitude {
        0.0 => ("0", "0"),
        _ => ("A*sin(w*t)", "A*w*cos(w*t)"),
    };
    format!(
        "title = \"t\"\n[coordinates]\ny = {{ initial = {height:?}, momentum = {momentum:?} }}\n\
         [parameters]\nA = {amplitude:?}\nw = {omega:?}\ne = {restitution:?}\n\
         [hamiltonian]\nH = \"1/2*p_y^2 + y\"\n\
         [[impulses]]\nname = \"bounce\"\nchange = {{ p_y = \"-(1 + e)*(p_y - {speed})\" }}\n\
         [[events]]\nname = \"floor\"\nwhen = \"y - {floor}\"\ndirection = \"falling\"\n\
         action = \"impulse:bounce\"\n[run]\nstart = {time:?}\n"
    )
}

/// The trace and determinant of the monodromy matrix.
fn of(orbit: &Orbit) -> (f64, f64) {
    (orbit.monodromy.trace(), orbit.monodromy.determinant())
}

/// On a floor at rest an elastic ball returns after 2 v/g, and by M = [[−1, 0], [2g/v, −1]] · [[1, T], [0, 1]] of
/// trace 2 and determinant 1.
#[test]
fn an_elastic_ball_on_a_floor_at_rest_returns_after_two_v_over_g() {
    let mut case = file(&ball(0.0, 1.0, 1.0, 0.7, 0.0));
    // in the air, on its way down
    case.start.values[..2].copy_from_slice(&[0.3, -0.2]);
    let orbit = periodic_orbit(&case.space, taylor(), &case.start, None, Fixed::Nothing).unwrap();
    let speed = (2.0 * orbit.energy).sqrt();
    near(orbit.energy, 0.32, 0.05);
    near(orbit.period, 2.0 * speed, 1e-12);
    let (trace, determinant) = of(&orbit);
    near(trace, 2.0, 1e-10);
    near(determinant, 1.0, 1e-11);
    assert!(orbit.stable && orbit.closure < 1e-12);
}

/// A ball on a vibrating floor of restitution e that bounces once in each period T = 2π/ω: it flies with ±gT/2, so that the
/// floor moves with Aω cos φ = (gT/2)(1 − e)/(1 + e) where it is hit, and the linear map has determinant e² and trace
/// (1 + e)² (1 − Aω² sin φ/g) − 2e (P. J. Holmes, J. Sound Vib. 84 (1982) 173, without his small amplitude).
#[test]
fn a_ball_on_a_vibrating_floor_has_the_orbit_of_period_one_in_closed_form() {
    let (omega, e) = (TAU, 0.5);
    for amplitude in [0.028, 0.031, 0.04, 0.05] {
        let floor = 0.5 * (1.0 - e) / (1.0 + e);
        let phase = math::acos(floor / (amplitude * omega));
        let pull = amplitude * omega * omega * math::sin(phase);
        let expected = ((1.0 + e) * (1.0 + e) * (1.0 - pull) - 2.0 * e, e * e);
        // a third of the way after the bounce, and off
        let later = phase / omega + 0.3;
        let mut case = file(&ball(amplitude, omega, e, 0.5, 0.0));
        case.start.time = later;
        let height = amplitude * math::sin(phase) + 0.5 * 0.3 - 0.045;
        case.start.values[..2].copy_from_slice(&[height + 0.0004, 0.2 - 0.0007]);
        assert!(!case.space.is_autonomous());
        let drive = case.space.drive().unwrap();
        near(drive, 1.0, 1e-14);
        let orbit = driven_orbit(&case.space, taylor(), &case.start, drive).unwrap();
        near(orbit.state.values[0], height, 1e-10);
        near(orbit.state.values[1], 0.2, 1e-10);
        let (trace, determinant) = of(&orbit);
        near(trace, expected.0, 1e-8);
        near(determinant, expected.1, 1e-9);
        // stable while |tr| < 1 + det
        assert_eq!(orbit.stable, expected.0.abs() < 1.0 + expected.1, "{amplitude}");
    }
}

/// A particle between walls at 0 and a returns after 2a/v; without force M = [[1, T], [0, 1]].
#[test]
fn a_particle_between_two_walls_returns_after_twice_the_distance() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 0.4, momentum = 1.7 }\n\
        [hamiltonian]\nH = \"1/2*p_x^2\"\n\
        [[impulses]]\nname = \"back\"\nchange = { p_x = \"-2*p_x\" }\n\
        [[events]]\nname = \"left\"\nwhen = \"x\"\ndirection = \"falling\"\naction = \"impulse:back\"\n\
        [[events]]\nname = \"right\"\nwhen = \"x - 1.5\"\ndirection = \"rising\"\naction = \"impulse:back\"\n";
    let case = file(text);
    let orbit = periodic_orbit(&case.space, taylor(), &case.start, None, Fixed::Nothing).unwrap();
    let speed = orbit.state.values[1].abs();
    near(orbit.period, 3.0 / speed, 1e-12);
    near(orbit.monodromy[(0, 1)].abs(), orbit.period, 1e-10);
    let (trace, determinant) = of(&orbit);
    near(trace, 2.0, 1e-12);
    near(determinant, 1.0, 1e-12);
}

/// Each bounce on a floor at rest takes energy: nothing closes.
#[test]
fn a_ball_that_loses_energy_has_no_orbit() {
    let mut case = file(&ball(0.0, 1.0, 0.8, 0.7, 0.0));
    case.start.values[..2].copy_from_slice(&[0.3, -0.2]);
    let found = periodic_orbit(&case.space, taylor(), &case.start, None, Fixed::Nothing);
    let why = found.unwrap_err().to_string();
    assert!(why.contains("no periodic orbit"), "{why}");
}
