//! The effect of each command.

use phaselab::experiment::{Command, Experiment, Status};
use phaselab::system::InitialOverride;

use super::{build, gauge, run, shipped, value};

/// The index of a parameter.
fn parameter(experiment: &Experiment, name: &str) -> usize {
    experiment.model().parameter(name).expect("a parameter")
}

fn set(experiment: &mut Experiment, name: &str, value: f64) {
    let index = parameter(experiment, name);
    experiment.execute(Command::Parameter { index, value });
}

/// Every channel's value, bit by bit.
fn bits(experiment: &Experiment) -> Vec<u64> {
    experiment.values().iter().map(|x| x.to_bits()).collect()
}

#[test]
fn a_parameter_keeps_q_and_p_and_the_velocity_jumps() {
    let mut top = shipped("heavy-top");
    run(&mut top, 1.3);
    let names = ["theta", "phi", "psi", "p_theta", "p_phi", "p_psi"];
    let before = names.map(|name| value(&top, name));
    let (rate, energy) = (value(&top, "psi'"), value(&top, "energy"));
    set(&mut top, "I3", 0.8);
    for (name, before) in names.into_iter().zip(before) {
        let after = value(&top, name);
        assert!((after - before).abs() <= 4e-16 * before.abs(), "{name}: {before} to {after}");
    }
    assert_eq!(top.time(), 1.3);
    assert!((value(&top, "psi'") - rate).abs() > 1.0);
    assert!((value(&top, "energy") - energy).abs() > 1.0);
}

#[test]
fn gauges_start_anew_after_a_parameter_and_say_by_how_much_the_energy_jumped() {
    let mut pendulum = shipped("pendulum");
    run(&mut pendulum, 2.0);
    let before = value(&pendulum, "energy");
    set(&mut pendulum, "g", 12.0);
    run(&mut pendulum, 4.0);
    let snapshot = pendulum.snapshot();
    let energy = gauge(&snapshot, "energy");
    assert_eq!((energy.reference_time, energy.drift), (2.0, 0.0));
    assert!((energy.reference - before).abs() > 0.1);
    let notice = snapshot.notices.last().expect("the jump is reported");
    assert!(notice.starts_with("g: energy jumped by "), "{notice}");
    assert!(notice.ends_with("q and p kept; press r to restart"), "{notice}");
}

#[test]
fn a_parameter_turned_on_and_on_is_reported_once() {
    let mut pendulum = shipped("pendulum");
    for k in 0..50 {
        run(&mut pendulum, 0.01 * f64::from(k + 1));
        set(&mut pendulum, "g", 9.81 + 0.01 * f64::from(k + 1));
    }
    assert_eq!(pendulum.snapshot().notices.len(), 1);
    set(&mut pendulum, "m", 2.0);
    assert_eq!(pendulum.snapshot().notices.len(), 2);
}

/// One change is one jump, however fast the motion is and whether it runs; two changes are two, however close they are.
#[test]
fn the_jump_of_energy_is_that_of_all_steps_of_a_change() {
    for speed in [1.0, f64::INFINITY] {
        for pause in [0.0, 0.5] {
            let mut pendulum = shipped("pendulum");
            pendulum.execute(Command::Speed(speed));
            run(&mut pendulum, 1.0);
            let index = parameter(&pendulum, "g");
            let mut last = pendulum.model().parameters[index].value;
            let mut expected = 0.0;
            for (step, value_of_g) in [10.0, 11.0, 12.0].into_iter().enumerate() {
                // the mass and the length are 1
                expected -= value(&pendulum, "theta").cos() * (value_of_g - last);
                last = value_of_g;
                pendulum.execute(match step {
                    0 => Command::Parameter { index, value: value_of_g },
                    _ => Command::MoveParameter { index, value: value_of_g },
                });
                let until = pendulum.time() + pause;
                run(&mut pendulum, until);
            }
            let said = |pendulum: &Experiment| pendulum.snapshot().notices.last().cloned();
            let jump = |by: f64| {
                let sign = if by < 0.0 { '−' } else { '+' };
                format!("g: energy jumped by {sign}{};", phaselab::num::short(by.abs()))
            };
            let notice = said(&pendulum).expect("the jump is reported");
            assert!(notice.starts_with(&jump(expected)), "{expected} is expected: {notice}");
            let next = -value(&pendulum, "theta").cos();
            set(&mut pendulum, "g", 13.0);
            let notice = said(&pendulum).expect("the jump is reported");
            assert!(notice.starts_with(&jump(next)), "{next} is expected: {notice}");
            if pause == 0.0 {
                pendulum.execute(Command::MoveParameter { index, value: last });
                assert_eq!(said(&pendulum), None, "it is as it was");
            }
        }
    }
}

#[test]
fn a_parameter_and_back_changes_nothing() {
    let mut one = shipped("double-pendulum");
    let mut other = shipped("double-pendulum");
    run(&mut one, 1.0);
    run(&mut other, 1.0);
    let g = one.model().parameters[parameter(&one, "g")].value;
    set(&mut one, "g", 3.0);
    set(&mut one, "g", g);
    assert_eq!(bits(&one), bits(&other));
    run(&mut one, 2.0);
    run(&mut other, 2.0);
    for (a, b) in one.values().iter().zip(other.values()) {
        assert!((a - b).abs() <= 1e-12 * (1.0 + a.abs()) || a.is_nan(), "{a} {b}");
    }
}

#[test]
fn a_reset_is_the_beginning_again_bit_by_bit() {
    let mut system = shipped("henon-heiles");
    let first = bits(&system);
    run(&mut system, 7.0);
    let later = bits(&system);
    system.execute(Command::Reset);
    assert_eq!((system.time(), bits(&system)), (0.0, first));
    assert_eq!(system.snapshot().trail.len(), 1);
    run(&mut system, 7.0);
    assert_eq!(bits(&system), later);
}

#[test]
fn a_reset_keeps_parameters_and_a_full_reset_does_not() {
    let mut pendulum = shipped("pendulum");
    let first = bits(&pendulum);
    set(&mut pendulum, "theta0", 1.0);
    assert_eq!(value(&pendulum, "theta"), 2.0, "the state is left alone");
    assert_eq!(pendulum.snapshot().initial[0], 1.0, "the next reset takes it");
    pendulum.execute(Command::Initial { index: 1, value: 0.5 });
    assert_eq!((value(&pendulum, "theta"), value(&pendulum, "theta'")), (1.0, 0.5));
    pendulum.execute(Command::Reset);
    assert_eq!((value(&pendulum, "theta"), value(&pendulum, "theta'")), (1.0, 0.5));
    pendulum.execute(Command::FullReset);
    assert_eq!(bits(&pendulum), first);
}

#[test]
fn an_initial_value_starts_again_from_it() {
    let mut system = shipped("henon-heiles");
    run(&mut system, 3.0);
    system.execute(Command::Initial { index: 3, value: 0.125 });
    assert_eq!((system.time(), value(&system, "p_y")), (0.0, 0.125));
    assert_eq!(system.snapshot().initial[3], 0.125);
    system.execute(Command::Initial { index: 3, value: 0.25 });
    assert_eq!(system.snapshot().initial[3], 0.25);
    system.execute(Command::Initial { index: 99, value: 0.0 });
    system.execute(Command::Initial { index: 0, value: f64::NAN });
    assert_eq!(system.snapshot().initial[3], 0.25);
    assert_eq!(system.snapshot().notices.len(), 2);
}

#[test]
fn a_single_step_is_a_frame_at_the_present_speed() {
    let mut pendulum = shipped("pendulum");
    assert_eq!(pendulum.status(), Status::Running);
    pendulum.execute(Command::Speed(3.0));
    pendulum.execute(Command::Step(1));
    assert_eq!(pendulum.status(), Status::Paused);
    assert!((pendulum.time() - 0.05).abs() < 1e-15);
    pendulum.execute(Command::Speed(f64::INFINITY));
    pendulum.execute(Command::Step(6));
    assert!((pendulum.time() - 0.15).abs() < 1e-15, "at the file's speed: {}", pendulum.time());
    pendulum.execute(Command::Play);
    assert_eq!(pendulum.status(), Status::Running);
}

#[test]
fn what_makes_no_sense_is_reported_and_changes_nothing() {
    let mut pendulum = shipped("pendulum");
    run(&mut pendulum, 1.0);
    let before = bits(&pendulum);
    let wrong = [
        Command::Speed(0.0),
        Command::Speed(f64::NAN),
        Command::Parameter { index: 0, value: f64::INFINITY },
        Command::StepSize(-1.0),
        Command::Tolerance(0.0),
        Command::Method("eular".to_owned()),
    ];
    for (k, command) in wrong.into_iter().enumerate() {
        pendulum.execute(command.clone());
        assert_eq!(pendulum.snapshot().notices.len(), k + 1, "{command:?}");
    }
    pendulum.execute(Command::Parameter { index: 99, value: 1.0 });
    assert_eq!((bits(&pendulum), pendulum.speed()), (before, 1.0));
}

#[test]
fn a_reference_is_taken_when_asked_for() {
    let mut pendulum = shipped("damped-pendulum");
    run(&mut pendulum, 3.0);
    pendulum.execute(Command::Reference);
    let energy = gauge(&pendulum.snapshot(), "energy");
    assert_eq!((energy.reference_time, energy.drift, energy.max_drift), (3.0, 0.0, 0.0));
    run(&mut pendulum, 4.0);
    assert!(gauge(&pendulum.snapshot(), "energy").drift > 1e-3);
}

/// Reaches the centre at π/(2√2) = 1.1107… if k = 1; never if k is negative.
const FALL: &str = r#"
title = "A fall"
[coordinates]
x = { initial = "h" }
[parameters]
k = 1.0
h = 1.0
[lagrangian]
L = "1/2*x'^2 + k/x"
"#;

fn error(experiment: &Experiment) -> Option<f64> {
    match experiment.status() {
        Status::Failed(error) => {
            assert!(!error.message.is_empty());
            Some(error.time)
        }
        _ => None,
    }
}

#[test]
fn an_error_is_data_and_a_reset_goes_on() {
    let mut fall = build(FALL, |_| ());
    assert_ne!(fall.advance(3.0, u64::MAX), phaselab::experiment::AdvanceOutcome::Arrived);
    let time = error(&fall).expect("it falls into the centre");
    assert!((time - std::f64::consts::PI / 8.0_f64.sqrt()).abs() < 1e-6, "{time}");
    let snapshot = fall.snapshot();
    assert!(snapshot.values.iter().take(4).all(|x| x.is_finite()), "the last good state is shown");
    assert!(snapshot.trail.len() > 50, "and the way there");
    fall.execute(Command::Reset);
    assert_eq!((error(&fall), fall.time()), (None, 0.0));
    run(&mut fall, 0.5);
}

#[test]
fn a_parameter_can_lead_out_of_an_error() {
    // pushed ever harder towards x = k, beyond which the force is undefined
    let mut system = build(&FALL.replace("+ k/x", "- sqrt(k - x/2)"), |_| ());
    system.advance(9.0, u64::MAX);
    let time = error(&system).expect("it comes to the wall");
    let (x, p) = (value(&system, "x"), value(&system, "p_x"));
    assert!((x - 2.0).abs() < 1e-6, "{x}");
    set(&mut system, "k", 10.0);
    assert_eq!((error(&system), value(&system, "x"), value(&system, "p_x")), (None, x, p));
    run(&mut system, time + 1.0);
}

#[test]
fn a_motion_that_cannot_begin_waits_for_better_values() {
    let text = FALL.replace("1/2*x'^2", "1/2*k*x'^2").replace("k = 1.0", "k = 0.0");
    let given = InitialOverride::Momentum(0, 3.0);
    let mut system = build(&text, |setup| setup.overrides.push(given));
    assert!(error(&system).is_some());
    assert!(system.snapshot().values.iter().all(|x| x.is_nan()));
    assert!(system.snapshot().trail.is_empty());
    set(&mut system, "k", 2.0);
    assert_eq!((error(&system), value(&system, "x'"), value(&system, "p_x")), (None, 1.5, 3.0));
    assert_eq!(system.snapshot().initial[..], [1.0, 1.5]);
    run(&mut system, 0.5);
}

#[test]
fn a_reset_into_an_error_is_not_mistaken_for_the_motion_before() {
    let mut system = build(&FALL.replace("\"h\"", "\"sqrt(h)\""), |_| ());
    run(&mut system, 0.5);
    set(&mut system, "h", -1.0);
    assert_eq!(error(&system), None, "the motion goes on");
    system.execute(Command::Reset);
    assert!(error(&system).is_some());
    set(&mut system, "k", 2.0);
    assert!(error(&system).is_some(), "there is still nothing to begin with");
    set(&mut system, "h", 1.0);
    assert_eq!((error(&system), system.time(), value(&system, "x")), (None, 0.0, 1.0));
}
