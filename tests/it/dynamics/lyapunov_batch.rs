//! The exponents of several motions side by side: the bits of each alone.

use phaselab::dynamics::{
    DynamicsError, Lyapunov, LyapunovOrbit, PhaseSpace, lyapunov, lyapunov_of_all,
};
use phaselab::integrate::{BatchPropagator, Method, Settings, method_named};
use phaselab::num::BATCH;

use super::{Case, case, case_in, method, taylor};
use crate::fixtures::{loaded, lowered};

/// Everything that was found of a motion, with its bits, or why nothing was.
fn reported(found: &Result<Lyapunov, DynamicsError>) -> String {
    match found {
        Err(why) => why.to_string(),
        Ok(found) => {
            let numbers = [&[found.time, found.megno, found.sum][..], &found.exponents];
            let numbers = [numbers.concat(), found.uncertainty.clone()].concat();
            let curve = found.curve.iter().flat_map(|(t, x)| [*t, *x]);
            let bits: Vec<u64> = numbers.into_iter().chain(curve).map(f64::to_bits).collect();
            let words = (&found.settled, found.removed, found.verdict, &found.reason);
            let error = found.error.as_ref().map(ToString::to_string);
            format!(
                "{bits:?} {words:?} {:?} {:?} {error:?}",
                found.pairing_residual, found.settings
            )
        }
    }
}

/// Motions that begin near that of a case, of different lengths, so that lanes are refilled at different steps.
fn near(case: &Case, count: usize, length: f64) -> Vec<LyapunovOrbit> {
    let one = |i: usize| {
        let mut start = case.start.clone();
        for (j, x) in start.values[..case.space.dimension()].iter_mut().enumerate() {
            let off = ((i * 37 + j * 11) % 101) as f64 / 101.0 - 0.5;
            *x += 0.05 * off * (1.0 + x.abs()) * f64::from(u8::from(i > 0));
        }
        let until = start.time + length * (1.0 + 0.25 * (i % 3) as f64);
        LyapunovOrbit { space: case.space.clone(), start, until }
    };
    (0..count).map(one).collect()
}

fn fast(tolerance: f64) -> (&'static Method, Settings) {
    (method_named("taylor").unwrap(), Settings { step: None, tolerance: Some(tolerance) })
}

fn agree(orbits: &[LyapunovOrbit], by: (&'static Method, Settings), name: &str) {
    let together = lyapunov_of_all(orbits, by);
    assert_eq!(together.len(), orbits.len());
    for (i, (orbit, together)) in orbits.iter().zip(&together).enumerate() {
        let alone = lyapunov(&orbit.space, by, &orbit.start, orbit.until, &mut |_| ());
        assert_eq!(reported(together), reported(&alone), "{name} {} {i}", by.0.name);
    }
}

fn goes_side_by_side(space: &PhaseSpace, (method, settings): (&'static Method, Settings)) -> bool {
    let system = space.system().without_marks().with_tangents(3);
    BatchPropagator::new(&system, method, settings).is_some()
}

#[test]
fn exponents_side_by_side_have_the_bits_that_they_have_alone() {
    for name in ["henon-heiles", "double-pendulum", "driven-damped-pendulum", "heavy-top"] {
        let loaded = loaded(name, 1);
        let parameters = loaded.model.parameter_values();
        let (model, equations) = (&loaded.model, &loaded.equations);
        let space = PhaseSpace::of((model, equations, &loaded.system), &parameters).unwrap();
        let start = loaded.system.initial(model.run.start, &parameters, &[]).unwrap();
        let case = Case { start: space.state(&start).unwrap(), space };
        assert!(goes_side_by_side(&case.space, fast(1e-15)), "{name}");
        let length = 6.0 * model.run.speed;
        for (count, tolerance) in [(2 * BATCH + 3, 1e-15), (3, 1e-10), (2, 1e-10)] {
            agree(&near(&case, count, length), fast(tolerance), name);
        }
    }
}

#[test]
fn so_have_they_by_equal_steps() {
    let henon = case(&loaded("henon-heiles", 1), &[], &[0.0, -0.25, 0.42081, 0.0]);
    for name in ["leapfrog", "yoshida6", "rk4", "symplectic-euler"] {
        let by = method(name, Some(0.05));
        assert!(goes_side_by_side(&henon.space, by), "{name}");
        agree(&near(&henon, BATCH + 2, 8.0), by, name);
    }
    // velocities that are not the momenta
    let pendulums = case(&loaded("double-pendulum", 1), &[], &[]);
    agree(&near(&pendulums, 3, 1.0), method("rk4", Some(0.02)), "double-pendulum");
    // where each would choose a step for itself, and by a method without lanes
    agree(&near(&henon, 4, 4.0), method("leapfrog", None), "henon-heiles");
    agree(&near(&henon, 4, 4.0), method("dop853", None), "henon-heiles");
    agree(&near(&henon, 4, 4.0), taylor(), "henon-heiles");
}

/// Motions that escape, begin at rest, end before they begin, or have parameters of their own, among others.
#[test]
fn a_motion_out_of_the_ordinary_changes_nothing_for_the_others() {
    let loaded = loaded("henon-heiles", 1);
    let case_at = |start: &[f64]| case(&loaded, &[], start);
    let mut orbits = near(&case_at(&[0.0, -0.25, 0.42081, 0.0]), BATCH + 1, 25.0);
    for (i, start) in
        [[0.0, 0.9, 0.0, 2.0], [0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.3, 0.0, 0.0, 1e-200]]
            .iter()
            .enumerate()
    {
        let Case { space, start } = case_at(start);
        orbits.insert(2 * i + 1, LyapunovOrbit { space, start, until: 30.0 });
    }
    orbits[4].until = -1.0;
    agree(&orbits, fast(1e-15), "henon-heiles");
}

#[test]
fn what_cannot_go_side_by_side_is_followed_alone() {
    let rod = "title = \"t\"\n[coordinates]\nx = { initial = 1 }\ny = { initial = 0, velocity = 1 }\n\
        [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - y\"\n\
        [[constraints]]\nname = \"rod\"\nexpression = \"x^2 + y^2 - 1\"\n";
    let kicked = "title = \"t\"\n[coordinates]\nq = { initial = 1, velocity = 0.3 }\n\
        [lagrangian]\nL = \"q'^2/2 - q^2/2\"\n\
        [[impulses]]\nname = \"kick\"\nevery = 1\nchange = { p_q = \"q\" }\n";
    for text in [rod, kicked] {
        let case = case_in(&lowered(text), &[], &[], PhaseSpace::on_constraints);
        let same: Vec<LyapunovOrbit> = (0..4).flat_map(|_| near(&case, 1, 2.0)).collect();
        agree(&same, fast(1e-12), text);
    }
}
