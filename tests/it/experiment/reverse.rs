//! Time reversed: motions return to where they began as far as their exponent lets them, and friction gives back.

use phaselab::experiment::{AdvanceOutcome, Command, Experiment, Status};
use phaselab::num::math;

use super::{PLENTY, build, run, shipped, value};

/// Runs to a time and back to the start, and returns how far from it the motion comes.
fn there_and_back(experiment: &mut Experiment, time: f64) -> f64 {
    let start = experiment.time();
    run(experiment, time);
    experiment.execute(Command::Play);
    experiment.execute(Command::Reverse);
    assert!(experiment.is_backwards(), "{:?}", experiment.snapshot().notices);
    assert_eq!(experiment.advance(f64::INFINITY, PLENTY), AdvanceOutcome::Ended);
    let seen = experiment.snapshot();
    assert_eq!((seen.time, &seen.status), (start, &Status::Paused));
    assert!(seen.backwards && seen.trail.rows().all(|row| row[0] >= start));
    let times: Vec<f64> = seen.trail.rows().map(|row| row[0]).collect();
    assert!(
        times.windows(2).all(|pair| pair[1] < pair[0]) && times[0] >= time && times[0] < time + 0.1
    );
    seen.returned.expect("it has returned").error.expect("it was at the start")
}

#[test]
fn a_pendulum_returns_to_its_start_to_the_last_digits_by_every_kind_of_method() {
    for method in ["taylor", "gauss6", "leapfrog", "yoshida4"] {
        let mut experiment = shipped("pendulum");
        experiment.execute(Command::Method(method.to_owned()));
        let named = experiment.snapshot().method.name;
        let begin = experiment.values().to_vec();
        let error = there_and_back(&mut experiment, 20.0);
        assert!(error < 1e-13, "{named}: {error:e}");
        let off = begin.iter().zip(experiment.values()).map(|(a, b)| (a - b).abs());
        let off = off.filter(|x| x.is_finite()).fold(0.0, f64::max);
        assert!(off < 1e-12, "{named}: {off:e}");
    }
    // a method that is not reversible does not come back so well, and the error says so
    let mut experiment = shipped("pendulum");
    experiment.execute(Command::Method("rk4".to_owned()));
    let error = there_and_back(&mut experiment, 20.0);
    assert!(error > 1e-9 && error < 1e-2, "{error:e}");
}

/// The error of the way back is that of a step, grown as a neighbour's distance grows.
#[test]
fn a_chaotic_motion_returns_to_the_error_of_a_step_times_the_growth_of_neighbours() {
    let mut experiment = shipped("henon-heiles");
    // in the chaotic sea at E = 1/8
    experiment.execute(Command::Start(chaotic()));
    experiment.execute(Command::Tolerance(1e-10));
    experiment.execute(Command::AddNeighbour);
    let time = 200.0;
    run(&mut experiment, time);
    while experiment.is_behind() {
        experiment.advance(time, PLENTY);
    }
    let seen = experiment.snapshot();
    let points = seen.separations[0].1.points();
    let grown = points[points.len() - 1][1] - points[0][1];
    assert!(grown > 5.0 && grown < 17.0, "it is chaotic, and the distance still small: {grown}");
    experiment.execute(Command::Reverse);
    experiment.execute(Command::Play);
    experiment.advance(f64::INFINITY, PLENTY);
    let returned = experiment.snapshot().returned.expect("it has returned");
    let (error, expected) =
        (returned.error.expect("at the start"), returned.step_error * math::exp(grown));
    // a hundred steps and more, each with its error; the method keeps the last terms of a step below ε/100
    // (`step_size`), and the direction of an error is not the neighbour's
    assert!(error < 1e2 * expected && error > 1e-4 * expected, "{error:e} {expected:e}");
    // more accurate steps come back as much better
    experiment.execute(Command::Tolerance(1e-13));
    experiment.execute(Command::Reset);
    let better = there_and_back(&mut experiment, time);
    assert!(better < 0.02 * error && better > 1e-5 * error, "{better:e} {error:e}");
    // a regular motion of the same system comes back almost exactly
    let mut regular = shipped("henon-heiles");
    let small = there_and_back(&mut regular, 50.0);
    assert!(small < 1e-11, "{small:e}");
}

fn chaotic() -> Vec<phaselab::system::InitialOverride> {
    use phaselab::system::InitialOverride::{Momentum, Position};
    // p_x from E = 1/8 at x = 0, y = −0.25, p_y = 0
    let (y, e) = (-0.25_f64, 0.125);
    let px = (2.0 * (e - 0.5 * y * y + y * y * y / 3.0)).sqrt();
    vec![Position(0, 0.0), Position(1, y), Momentum(0, px), Momentum(1, 0.0)]
}

const DAMPED: &str = r#"
title = "Damped oscillator"
summary = "x'' + 2 g x' + x = 0"

[coordinates]
x = { initial = 1.0, velocity = 0.0 }

[parameters]
g = { value = 0.1 }

[lagrangian]
L = "x'^2/2 - x^2/2"
dissipation = "g*x'^2"
"#;

#[test]
fn a_damped_oscillator_grows_backwards_as_its_closed_form_says() {
    let mut experiment = build(DAMPED, |_| ());
    experiment.execute(Command::Reverse);
    assert!(experiment.is_backwards());
    let (g, w) = (0.1_f64, (1.0_f64 - 0.01).sqrt());
    for back in [1.0, 5.0, 20.0] {
        experiment.advance(back, PLENTY);
        assert_eq!(experiment.time(), -back);
        let t = -back;
        // x(0) = 1, x'(0) = 0
        let x = math::exp(-g * t) * (math::cos(w * t) + g / w * math::sin(w * t));
        let v = -math::exp(-g * t) / w * math::sin(w * t);
        let size = math::exp(g * back);
        assert!((value(&experiment, "x") - x).abs() < 1e-13 * size, "{back}");
        // velocities are those of the forward motion
        assert!((value(&experiment, "x'") - v).abs() < 1e-13 * size, "{back}");
    }
    // the work of friction is given back
    let balance = super::gauge(&experiment.snapshot(), "energy balance");
    assert!(balance.drift < 1e-11, "{}", balance.drift);
}

/// Time itself is the law's: a driven motion meets the same force at the same time.
#[test]
fn driven_constrained_rolling_and_turning_motions_return() {
    for (name, time, least) in [
        ("duffing", 10.0, 1e-9),
        ("heavy-top", 3.0, 1e-11),
        ("double-pendulum", 2.0, 1e-9),
        ("driven-damped-pendulum", 10.0, 1e-8),
        ("restricted-three-body", 1.0, 1e-9),
    ] {
        let error = there_and_back(&mut shipped(name), time);
        assert!(error < least, "{name}: {error:e}");
    }
}

#[test]
fn a_run_that_is_reversed_twice_goes_on_and_reset_leads_forwards() {
    let mut experiment = shipped("pendulum");
    run(&mut experiment, 5.0);
    experiment.execute(Command::Reverse);
    assert_eq!(experiment.advance(-2.0, PLENTY), AdvanceOutcome::Arrived);
    assert_eq!(experiment.time(), 2.0);
    experiment.execute(Command::Reverse);
    assert!(!experiment.is_backwards());
    run(&mut experiment, 4.0);
    let mut alone = shipped("pendulum");
    run(&mut alone, 4.0);
    let off = alone.values().iter().zip(experiment.values()).map(|(a, b)| (a - b).abs());
    assert!(off.filter(|x| x.is_finite()).fold(0.0, f64::max) < 1e-12);
    experiment.execute(Command::Reverse);
    experiment.execute(Command::Reset);
    assert!(!experiment.is_backwards() && experiment.snapshot().returned.is_none());
    run(&mut experiment, 4.0);
    assert_eq!(experiment.values(), alone.values());
}

#[test]
fn the_run_before_is_shown_where_it_was_and_another_law_makes_an_end_of_it() {
    let mut experiment = shipped("henon-heiles");
    run(&mut experiment, 8.0);
    experiment.execute(Command::Reverse);
    experiment.advance(-3.0, PLENTY);
    let seen = experiment.snapshot();
    let before = &seen.companions[0];
    assert_eq!(before.origin.word(), "run before");
    // where it was looked at last is the newest row
    assert_eq!(before.time, seen.trail.rows().next_back().unwrap()[0]);
    let mut alone = shipped("henon-heiles");
    run(&mut alone, before.time);
    let pairs = alone.values().iter().zip(before.values.iter());
    assert!(pairs.filter(|(a, _)| a.is_finite()).all(|(a, b)| (a - b).abs() < 1e-14));
    // its way is shown until then, and what came after is undone already
    let newest = before.trail.rows().next_back().unwrap()[0];
    assert!(newest <= before.time && before.time - newest < 0.1, "{newest} {}", before.time);
    // where the way back is looked at again, so is the run before
    experiment.execute(Command::ScrubTo(5.5));
    let seen = experiment.snapshot();
    let before = &seen.companions[0];
    assert_eq!((seen.time, before.time), (5.5, 5.5));
    let mut pairs = seen.values.iter().zip(before.values.iter()).filter(|(a, _)| a.is_finite());
    assert!(pairs.all(|(a, b)| (a - b).abs() < 1e-10));
    experiment.execute(Command::ScrubTo(f64::NEG_INFINITY));
    experiment.execute(Command::Parameter { index: 0, value: 1.5 });
    assert!(experiment.snapshot().returned.is_none() && experiment.is_backwards());
    experiment.execute(Command::AddNeighbour);
    assert_eq!(
        experiment.snapshot().notices.last().unwrap(),
        "motions are added while time runs forwards"
    );
}

#[test]
fn what_cannot_be_undone_is_said() {
    for (name, word) in [("bouncing-ball", "jump"), ("kicked-rotor", "jump")] {
        let mut experiment = shipped(name);
        run(&mut experiment, 0.1);
        experiment.execute(Command::Reverse);
        assert!(!experiment.is_backwards());
        let said = experiment.snapshot().notices.last().unwrap().clone();
        assert!(said.starts_with("time is not reversed here") && said.contains(word), "{said}");
    }
    let dry = DAMPED.replace("g*x'^2", "g*abs(x')");
    let mut experiment = build(&dry, |_| ());
    run(&mut experiment, 0.1);
    experiment.execute(Command::Reverse);
    assert!(!experiment.is_backwards());
    assert!(experiment.snapshot().notices.last().unwrap().contains("dry friction"));
}
