//! Steps: their number, their ends, the polynomial between them; trivial and impossible motions.

use super::{Run, near};
use phaselab::integrate::{METHODS, Settings};
use phaselab::system::{MotionErrorKind, State};

const OSCILLATOR: &str = r#"
title = "Oscillator"
[coordinates]
x = { initial = 1.0, velocity = 0.0 }
[lagrangian]
L = "1/2*x'^2 - 1/2*x^2"
"#;

const PENDULUM: &str = include_str!("../../../presets/pendulums/pendulum.toml");

#[test]
fn polynomial_motions_take_one_step() {
    for (l, end) in [("1/2*x'^2", [41.0, 0.4]), ("1/2*x'^2 - 2*x", [-9959.0, -199.6])] {
        let text = format!(
            "title = \"Free\"\n[coordinates]\nx = {{ initial = 1.0, velocity = 0.4 }}\n[lagrangian]\nL = \"{l}\"\n"
        );
        let mut run = Run::new(&text);
        assert_eq!(run.to(100.0), end);
        assert_eq!(run.steps, 1);
    }
}

#[test]
fn rest_stays_rest() {
    let mut run = Run::new(&OSCILLATOR.replace("initial = 1.0", "initial = 0.0"));
    assert_eq!(run.to(1e6), [0.0, 0.0]);
    assert!(run.steps <= 2);
}

#[test]
fn every_step_ends_before_its_limit_and_the_last_one_on_it() {
    let mut run = Run::new(OSCILLATOR);
    for limit in [0.1, 0.3, 10.0, 10.5] {
        while run.stepper.time() < limit {
            let before = run.stepper.time();
            run.stepper.step(limit).expect("regular");
            assert_eq!(run.stepper.interval(), (before, run.stepper.time()));
            assert!(run.stepper.time() > before && run.stepper.time() <= limit);
        }
        assert_eq!(run.stepper.time(), limit);
    }
    run.stepper.step(10.5).expect("nothing to do");
    near(&run.columns(), &[10.5_f64.cos(), -10.5_f64.sin()], 1.2e-16);
}

#[test]
fn a_step_is_a_good_part_of_the_radius_of_convergence() {
    // order 28: cos t is entire, and its series allows about a third of a period
    let mut run = Run::new(OSCILLATOR);
    run.to(200.0 * std::f64::consts::PI);
    assert!((200..350).contains(&run.steps), "{} steps for 100 periods", run.steps);
}

#[test]
fn inside_a_step_the_polynomial_is_as_good_as_at_its_end() {
    let mut run = Run::new(PENDULUM);
    let mut other = Run::new(PENDULUM);
    let mut state = run.stepper.state().clone();
    let mut time = 0.0;
    while time < 5.0 {
        time += 0.07;
        while run.stepper.time() < time {
            run.stepper.step(100.0).expect("regular");
        }
        run.stepper.at(time, &mut state).expect("it lies inside");
        assert_eq!(state.time, time);
        near(&state.values, &other.to(time), 8.9e-16);
    }
}

#[test]
fn there_and_back() {
    let mut run = Run::new(PENDULUM);
    let start = run.stepper.state().clone();
    run.to(7.3);
    let back = run.to(0.0);
    assert!(run.stepper.interval().0 > run.stepper.interval().1);
    near(&back, &start.values, 3e-16);
}

#[test]
fn units_of_time_and_length_do_not_matter() {
    // the same pendulum in seconds, in attoseconds and in ages of the universe
    let counts: Vec<u32> = [1.0, 1e-18, 4e17]
        .iter()
        .map(|unit: &f64| {
            let g = 9.81 / (unit * unit);
            let text = format!(
                "title = \"Pendulum\"\n[coordinates]\nx = {{ initial = 2.0, velocity = 0.0 }}\n[lagrangian]\nL = \"1/2*x'^2 + {g:e}*cos(x)\"\n"
            );
            let mut run = Run::new(&text);
            let state = run.to(3.332_338_678_543_657 * unit);
            // after five quarters of a period it hangs vertically
            assert!(state[0].abs() < 4e-15, "{state:?}");
            run.steps
        })
        .collect();
    assert!(counts.iter().all(|n| n.abs_diff(counts[0]) <= 2), "{counts:?}");
}

#[test]
fn a_looser_tolerance_costs_less_and_is_kept() {
    let exact = Run::new(PENDULUM).to(20.0);
    let mut last = (0, 0.0);
    for tolerance in [1e-15, 1e-12, 1e-9, 1e-6] {
        let mut run = Run::with(PENDULUM, Some(tolerance));
        let state = run.to(20.0);
        let error = (state[0] - exact[0]).abs().max((state[1] - exact[1]).abs());
        // 20 units of time, errors of the period grow linearly
        assert!(error < 400.0 * tolerance, "{tolerance:e}: {error:e}");
        // below 1e-13 it is the rounding of plain f64
        assert!(
            last.0 == 0 || error > 3.0 * last.1 || error < 1e-13,
            "{tolerance:e}: {error:e} after {:e}",
            last.1
        );
        last = (run.steps, error);
    }
}

#[test]
fn tolerances_out_of_range_are_refused() {
    let (_, system) = crate::system::compile(OSCILLATOR);
    for tolerance in [0.0, -1.0, 2.0, f64::NAN] {
        let settings = Settings { step: None, tolerance: Some(tolerance) };
        let outcome = (METHODS[0].make)(&system, &settings);
        let error = outcome.err().expect("out of range").to_string();
        assert!(error.starts_with("taylor cannot be used here: the tolerance"), "{error}");
    }
}

#[test]
fn a_collision_is_an_error_and_not_an_endless_loop() {
    let mut run = Run::new(
        "title = \"Fall into a centre\"\n[coordinates]\nr = { initial = 1.0, velocity = 0.0 }\n[lagrangian]\nL = \"1/2*r'^2 + 1/r\"\n",
    );
    let error = run.try_to(2.0).expect_err("it falls in");
    // the time of fall from rest: π/2 · √(r³/2)
    let fall = std::f64::consts::FRAC_PI_2 / 2.0_f64.sqrt();
    assert!((error.time - fall).abs() < 1e-9, "{error}");
    assert!(
        matches!(error.kind, MotionErrorKind::StepUnderflow(_) | MotionErrorKind::NotFinite(_)),
        "{error}"
    );
    assert!(run.steps < 2000);
}

#[test]
fn leaving_the_domain_of_a_function_is_an_error() {
    let mut run = Run::new(
        "title = \"To the edge of a logarithm\"\n[coordinates]\nx = { initial = 1.0, velocity = -1.0 }\n[hamiltonian]\nH = \"1/2*p_x^2 + x*ln(x)\"\n"
            .replace("velocity", "momentum")
            .as_str(),
    );
    let error = run.try_to(10.0).expect_err("the potential ends at x = 0");
    assert!(
        matches!(error.kind, MotionErrorKind::StepUnderflow(_) | MotionErrorKind::NotFinite(_)),
        "{error}"
    );
}

#[test]
fn what_is_felt_only_from_nearby_is_not_jumped_over() {
    // far outside the barrier exp(−x²) is exactly zero, and the motion free
    let mut run = Run::new(
        "title = \"Towards a barrier\"\n[coordinates]\nx = { initial = -40.0, velocity = 1.0 }\n[lagrangian]\nL = \"1/2*x'^2 - exp(-x^2)\"\n",
    );
    let state = run.to(100.0);
    assert!(state[0] < -40.0 && (state[1] + 1.0).abs() < 1e-15, "it is thrown back: {state:?}");
    // and likewise with a late impulse
    let mut run = Run::new(
        "title = \"A late push\"\n[coordinates]\nx = { initial = 0.0, velocity = 0.0 }\n[lagrangian]\nL = \"1/2*x'^2\"\nforces = { x = \"exp(-(t - 100)^2)\" }\n",
    );
    let state = run.to(200.0);
    near(&state[1..], &[std::f64::consts::PI.sqrt()], 4e-16);
    // and with an attraction that decreases as a high power
    let mut run = Run::new(
        "title = \"Towards a core\"\n[coordinates]\nx = { initial = -1000.0, velocity = 1.0 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/x^12\"\n",
    );
    let state = run.to(2000.0);
    assert!((state[1] + 1.0).abs() < 1e-15 && state[0] < -990.0, "{state:?}");
}

#[test]
fn a_motion_begins_again_from_any_form() {
    let mut run = Run::new(PENDULUM);
    let first: State = run.stepper.state().clone();
    let target = run.to(1.5);
    let canonical = run
        .system
        .convert(&first, phaselab::system::Form::Momentum, &run.parameters)
        .expect("regular");
    run.stepper.start(&canonical, &run.parameters).expect("regular");
    assert_eq!(run.stepper.interval(), (0.0, 0.0));
    assert_eq!(run.to(1.5), target);
}
