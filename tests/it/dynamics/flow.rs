//! The flow map.

use phaselab::dynamics::{DynamicsError, FlowMap, PhaseSpace, flow_course, flow_map};

use super::{Case, file, method, preset, taylor};
use crate::fixtures::loaded;

const OSCILLATOR: &str = "title = \"t\"\n[coordinates]\nx = { initial = 0.3, momentum = 0.7 }\n\
                          [parameters]\nk = 4.0\nm = 0.25\n\
                          [hamiltonian]\nH = \"p_x^2/(2*m) + 1/2*k*x^2\"\n";

/// The same with friction −γ p, γ = 0.3.
const DAMPED: &str = "title = \"t\"\n[coordinates]\nx = { initial = 0.3, momentum = 0.7 }\n\
                      [hamiltonian]\nH = \"1/2*p_x^2 + 1/4*x^4\"\nforces = { x = \"-0.3*p_x\" }\n";

fn map(case: &Case, until: f64) -> FlowMap {
    map_by(case, ("taylor", None), until)
}

fn map_by(case: &Case, (name, step): (&str, Option<f64>), until: f64) -> FlowMap {
    flow_map(&case.space, method(name, step), &case.start, until, &mut |_| {}).unwrap()
}

#[test]
fn the_flow_of_an_oscillator_is_a_rotation() {
    // ω = 4, m ω = 1
    for until in [0.1, 2.7, -1.3] {
        let found = map(&file(OSCILLATOR, &[]), until);
        let (sin, cos) = (4.0 * until).sin_cos();
        for (place, wanted) in [((0, 0), cos), ((0, 1), sin), ((1, 0), -sin), ((1, 1), cos)] {
            assert!((found.matrix[place] - wanted).abs() < 4e-15, "{place:?} at {until}");
        }
        assert_eq!(found.time, until);
        assert!(found.symplectic_residual.unwrap() < 2e-15);
        assert!((found.determinant.unwrap() - 1.0).abs() < 2e-15);
        assert_eq!(found.determinant_expected.unwrap(), 1.0);
    }
}

#[test]
fn the_map_of_a_whole_time_is_the_product_of_its_parts() {
    for name in
        ["henon-heiles", "double-pendulum", "heavy-top", "damped-pendulum", "free-rigid-body"]
    {
        let whole = map(&preset(name, &[], &[]), 2.0);
        let case = preset(name, &[], &[]);
        let first = map(&case, 0.8);
        let second = Case { start: first.state.clone(), space: case.space };
        let second = map(&second, 2.0);
        let off = (&second.matrix * &first.matrix - &whole.matrix).amax();
        assert!(off < 2e-14 * whole.matrix.norm() * second.matrix.norm(), "{name}: {off:e}");
    }
}

#[test]
fn friction_shrinks_volumes_as_its_divergence_says() {
    // a method's own map differs by its error
    for (name, step, within) in
        [("taylor", None, 1e-14), ("dop853", None, 1e-10), ("rk4", Some(0.01), 1e-8)]
    {
        let found = map_by(&file(DAMPED, &[]), (name, step), 4.0);
        let wanted = (-0.3_f64 * 4.0).exp();
        assert!((found.determinant_expected.unwrap() - wanted).abs() < 1e-14, "{name}");
        assert!(
            (found.determinant.unwrap() - wanted).abs() < within,
            "{name}: {}",
            found.determinant.unwrap()
        );
        assert!(found.symplectic_residual.unwrap() > 0.1, "{name}");
    }
    // a force that grows with the velocity: the divergence depends on the motion
    let text = DAMPED.replace("-0.3*p_x", "-0.3*p_x^3");
    let found = map(&file(&text, &[]), 4.0);
    assert!((found.determinant.unwrap() - found.determinant_expected.unwrap()).abs() < 1e-14);
    assert!(found.determinant.unwrap() < 0.9);
}

#[test]
fn a_map_that_is_not_symplectic_is_recognised_by_its_residual() {
    // the residuals at t = 50 as an independent program found them: Verlet 3.4e-13, RK4 2.0e-4
    let case = preset("henon-heiles", &[], &[0.0, -0.25, 0.42081, 0.0]);
    let residual = |name: &str, step: f64| {
        map_by(&case, (name, Some(step)), 50.0).symplectic_residual.unwrap()
    };
    let coarse = residual("rk4", 0.1);
    assert!((1.9e-4..2.1e-4).contains(&coarse), "{coarse:e}");
    let order = (coarse / residual("rk4", 0.05)).log2();
    assert!((4.5..5.5).contains(&order), "{order}");
    // what the steps before have rounded is amplified by the flow after them, where M itself is small again, too
    for name in ["leapfrog", "yoshida4", "gauss4", "symplectic-euler"] {
        let found = map_by(&case, (name, Some(0.1)), 50.0);
        let residual = found.symplectic_residual.unwrap();
        assert!(residual < found.symplectic_rounding.unwrap(), "{name}: {residual:e}");
    }
    let euler = map_by(&case, ("symplectic-euler", Some(0.1)), 50.0);
    let rounding = euler.symplectic_rounding.unwrap();
    assert!((1e-14..3e-13).contains(&rounding), "{rounding:e}");
    let exact = map(&case, 50.0);
    assert!(exact.symplectic_residual.unwrap() < exact.symplectic_rounding.unwrap());
}

#[test]
fn what_rounding_may_leave_has_the_units_of_the_residual() {
    // an electron on a spring in SI units: M has entries of 1e-15 and 1e15, those of M𝕁Mᵀ with 𝕁 none
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 1e-10 }\n[parameters]\nm = 9.1e-31\nk = 1e2\n\
                [hamiltonian]\nH = \"p_x^2/(2*m) + 1/2*k*x^2\"\n";
    let found = map(&file(text, &[]), 2e-16);
    assert!(found.matrix.amax() > 1e13, "{}", found.matrix);
    let (residual, rounding) =
        (found.symplectic_residual.unwrap(), found.symplectic_rounding.unwrap());
    assert!(residual <= rounding && rounding < 1e-15, "{residual:e} {rounding:e}");
}

#[test]
fn what_has_no_derivative_somewhere_is_refused() {
    for (name, why) in
        [("pendulum-rod", "constraints"), ("bouncing-ball", "events"), ("kicked-rotor", "impulses")]
    {
        let loaded = loaded(name, 1);
        let (model, equations) = (&loaded.model, &loaded.equations);
        let space = PhaseSpace::of((model, equations, &loaded.system), &model.parameter_values());
        let Err(DynamicsError::Unsuited(said)) = space else { panic!("{name} is let pass") };
        assert!(said.contains(why), "{name}: {said}");
    }
}

#[test]
fn a_motion_that_ends_early_has_the_map_so_far() {
    // a fall into a centre: r = (1 − 3t)^(2/3)… the rates end at t ≈ 1.1
    let text = "title = \"t\"\n[coordinates]\nr = { initial = 1.0, momentum = 0.0 }\n\
                [hamiltonian]\nH = \"1/2*p_r^2 - 1/r\"\n";
    let case = file(text, &[]);
    let found = flow_map(&case.space, taylor(), &case.start, 3.0, &mut |_| {}).unwrap();
    assert!(found.error.is_some() && found.time > 1.0 && found.time < 1.2, "{}", found.time);
}

/// The map at several times of one motion is the map at each of them, and that of the forced damped pendulum is heyoka's.
#[test]
fn the_course_of_a_flow_map_has_the_map_at_each_time() {
    let forced = "title = \"t\"\n[coordinates]\nx = { initial = 0.2, velocity = 0.3 }\n\
                  [lagrangian]\nL = \"1/2*x'^2 + cos(x) + x*cos(t)\"\ndissipation = \"0.2*x'^2\"\n";
    let case = file(forced, &[]);
    let times = [0.0, 0.4, 1.7, 3.0];
    let course = |case: &Case, by: (&str, Option<f64>), times: &[f64]| {
        let found =
            flow_course(&case.space, method(by.0, by.1), &case.start, times, &mut |_| {}).unwrap();
        assert!(found.1.is_none());
        found.0
    };
    let found = course(&case, ("taylor", None), &times);
    assert_eq!(found.len(), 4);
    for (moment, time) in found.iter().zip(times) {
        assert_eq!(moment.time, time);
        let alone = map(&case, time);
        let off = (&moment.matrix - &alone.matrix).amax();
        assert!(off < 1e-14, "{off} at {time}");
        assert!((moment.determinant_expected - (-0.4 * time).exp()).abs() < 1e-14);
        assert!((moment.determinant - moment.determinant_expected).abs() < 1e-14);
    }
    // heyoka.py, var_ode_sys, recomputed
    let heyoka =
        [[-0.425477996842754, 0.419836489925857], [-0.191718183438907, -0.518719944062857]];
    for (i, row) in heyoka.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            assert!((found[3].matrix[(i, j)] - entry).abs() < 2e-14, "{i} {j}");
        }
    }
    // of a method of fixed step the moments are at the ends of its steps, and are its own map
    let pendulum = preset("symplectic-euler", &[], &[1.2, 0.5]);
    for (name, is_symplectic) in [("rk4", false), ("leapfrog", true)] {
        let moments = course(&pendulum, (name, Some(0.2)), &[1.0, 5.05, 10.0]);
        let ends: Vec<f64> = moments.iter().map(|moment| moment.time).collect();
        assert!((ends[1] - 5.2).abs() < 1e-12, "{ends:?}");
        let alone = map_by(&pendulum, (name, Some(0.2)), ends[1]);
        assert!((&moments[1].matrix - &alone.matrix).amax() < 1e-13);
        let residual = moments[2].symplectic_residual.unwrap();
        assert!((residual < 1e-13) == is_symplectic, "{name}: {residual}");
    }
}
