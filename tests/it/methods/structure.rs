//! What a method preserves (the symplectic form, reversibility, energy), and which methods do not.

use nalgebra::DMatrix;
use phaselab::integrate::{METHODS, Method, Preserves, Stepper};
use phaselab::system::{Form, State};

use super::{
    Case, distance, double_pendulum, driven, entangled, fixed, heavy_top, henon_heiles, named,
    pendulum, quartic,
};
use crate::nonempty;

/// ‖M 𝕁 Mᵀ − 𝕁‖ of the map from the start to `time`, M by differences of order 4.
fn defect(case: &Case, method: &Method, step: f64, time: f64) -> f64 {
    let n = case.system.degrees();
    let start = case.system.convert(&case.start, Form::Momentum, &case.parameters);
    let start = start.expect("converts");
    let image = |i: usize, shift: f64| {
        let mut moved = Case {
            system: case.system.clone(),
            start: start.clone(),
            parameters: case.parameters.clone(),
        };
        moved.start.values[i] += shift;
        moved.run(method, step, time).values
    };
    let width = 2e-4;
    let mut m = DMatrix::zeros(2 * n, 2 * n);
    for i in 0..2 * n {
        let [far, near] = [2.0 * width, width].map(|d| (image(i, d), image(i, -d)));
        for j in 0..2 * n {
            m[(j, i)] = (8.0 * (near.0[j] - near.1[j]) - (far.0[j] - far.1[j])) / (12.0 * width);
        }
    }
    let form = DMatrix::from_fn(2 * n, 2 * n, |i, j| match (j == i + n, i == j + n) {
        (true, _) => 1.0,
        (_, true) => -1.0,
        _ => 0.0,
    });
    (&m * &form * m.transpose() - form).amax()
}

#[test]
fn the_symplectic_form_is_kept_by_those_who_say_so_and_by_no_other() {
    let step = 0.25;
    for case in [pendulum(), driven(), entangled(), quartic(), double_pendulum()] {
        for method in fixed().filter(|method| (method.fits)(&case.system).is_ok()) {
            let defect = defect(&case, method, step, 3.0);
            let name = method.name;
            match method.preserves {
                Preserves::Symplectic | Preserves::SymplecticReversible => {
                    assert!(defect < 1e-8, "{name}: {defect:e}");
                }
                Preserves::Nothing => assert!(defect > 1e-7, "{name}: {defect:e}"),
            }
        }
    }
}

#[test]
fn rk4_loses_the_form_as_fast_as_computed_elsewhere() {
    // 6.7e-6 by the variational equations, from the chaotic start of Hénon and Heiles
    let case = henon_heiles();
    let lost = defect(&case, named("rk4"), 0.1, 10.0);
    assert!((lost - 6.7e-6).abs() < 5e-8, "{lost:e}");
    let kept = defect(&case, named("leapfrog"), 0.1, 10.0);
    assert!(kept < 1e-9, "{kept:e}");
}

#[test]
fn symmetric_methods_find_the_way_back() {
    for case in [pendulum(), driven(), double_pendulum(), entangled()] {
        for method in fixed().filter(|method| (method.fits)(&case.system).is_ok()) {
            let mut stepper = case.stepper(method, 0.1);
            case.continue_to(stepper.as_mut(), 5.0);
            assert_eq!(stepper.time(), 5.0);
            let back = case.continue_to(stepper.as_mut(), 0.0);
            assert_eq!(stepper.time(), 0.0);
            let error = distance(&back, &case.start);
            match method.preserves {
                Preserves::SymplecticReversible => {
                    assert!(error < 3e-14, "{}: {error:e}", method.name);
                }
                Preserves::Symplectic | Preserves::Nothing => {
                    assert!(error > 1e-8, "{}: {error:e}", method.name);
                }
            }
        }
    }
}

#[test]
fn every_method_goes_backwards_from_the_start() {
    for method in METHODS {
        let case = driven();
        let before = case.run(method, 1e-3, -1.0);
        assert_eq!(before.time, -1.0);
        let error = distance(&before, &case.exact(-1.0));
        let allowed = if method.order == Some(1) { 2e-3 } else { 1e-6 };
        assert!(error < allowed, "{}: {error:e}", method.name);
    }
}

#[test]
fn a_look_between_steps_disturbs_nothing() {
    for case in [driven(), quartic()] {
        for method in fixed().filter(|method| (method.fits)(&case.system).is_ok()) {
            let (mut watched, mut alone) = (case.stepper(method, 0.1), case.stepper(method, 0.1));
            let mut state = case.start.clone();
            for _ in 0..50 {
                watched.step(100.0).expect("goes on");
                alone.step(100.0).expect("goes on");
                let (begin, end) = watched.interval();
                let time = 0.3 * begin + 0.7 * end;
                watched.at(time, &mut state).expect("inside");
                assert_eq!(state.time, time);
                assert_eq!(watched.state(), alone.state(), "{}", method.name);
            }
            let state = case.system.convert(&state, case.start.form, &case.parameters);
            let state = state.expect("converts");
            let error = distance(&state, &case.exact(state.time));
            let allowed = if method.order == Some(1) { 0.5 } else { 2e-2 };
            assert!(error < allowed, "{}: {error:e}", method.name);
        }
    }
}

#[test]
fn steps_are_counted_not_summed() {
    for method in nonempty(fixed()) {
        let mut stepper = pendulum().stepper(method, 0.1);
        for _ in 0..1000 {
            stepper.step(1e9).expect("goes on");
        }
        assert_eq!(stepper.time(), 100.0);
        assert_eq!(stepper.interval(), (99.9, 100.0));
    }
}

#[test]
fn energy_of_the_heavy_top_wanders_by_rounding_only() {
    let case = heavy_top();
    for name in ["gauss4", "gauss6"] {
        // so small a step that the method's own energy error is below rounding
        let step = if name == "gauss4" { 2e-4 } else { 5e-3 };
        let mut stepper = case.stepper(named(name), step);
        let first = energy(&case, stepper.as_ref());
        let mut most = 0.0_f64;
        for _ in 0..5000 {
            stepper.step(1e9).expect("goes on");
            most = most.max((energy(&case, stepper.as_ref()) / first - 1.0).abs());
        }
        assert!(most <= 2e-15, "{name}: {most:e}");
    }
}

/// The energy of a canonical state of the top, which `Observer` computes to the last digit.
fn energy(case: &Case, stepper: &dyn Stepper) -> f64 {
    let mut observer = case.system.observer(&case.parameters);
    let mut seen = vec![0.0; case.system.channels().len()];
    observer.observe(stepper.state(), &mut seen).expect("observes");
    let place = case.system.channels().iter().position(|c| c.name == "energy").expect("energy");
    seen[place]
}

#[test]
fn a_state_of_either_form_is_a_start() {
    let case = double_pendulum();
    let canonical = case.system.convert(&case.start, Form::Momentum, &[]).expect("converts");
    for name in ["gauss6", "rk4", "dop853"] {
        let ends: Vec<State> = [&case.start, &canonical]
            .map(|start| {
                let mut stepper = case.stepper(named(name), 0.01);
                stepper.start(start, &case.parameters).expect("starts");
                case.continue_to(stepper.as_mut(), 1.0)
            })
            .to_vec();
        assert!(distance(&ends[0], &ends[1]) < 1e-13, "{name}");
    }
}

/// Two double pendulums whose only difference is a column that shows the action.
#[test]
fn the_motion_is_the_same_whether_the_action_is_carried_or_not() {
    let text = crate::fixtures::catalog().find("double-pendulum").unwrap().text.clone();
    let shown = format!("{text}\n[[observables]]\nname = 'carried'\nexpression = 'action'\n");
    let end = |text: &str, method: &str| {
        let mut motion = crate::experiment::build(text, |setup| {
            method.clone_into(&mut setup.method);
        });
        crate::experiment::run(&mut motion, 1.0);
        ["theta1", "theta2"].map(|name| crate::experiment::value(&motion, name))
    };
    for method in ["taylor", "dop853"] {
        assert_eq!(end(&text, method), end(&shown, method), "{method}");
    }
}
