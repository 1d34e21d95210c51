//! Impulses and events: their times and effects, and that none is missed or invented.

use phaselab::experiment::{AdvanceOutcome, Command, Experiment, Status};
use phaselab::integrate::OccurrenceKind;

use crate::experiment::{PLENTY, build, gauge, run, value};

const FREE: &str = r#"
title = 'a test'
[coordinates]
x = { initial = 0.0, velocity = 1.0 }
[lagrangian]
L = "1/2*x'^2"
"#;

fn file(text: &str) -> Experiment {
    build(text, |_| ())
}

/// Names and times of the occurrences.
fn passed(experiment: &Experiment) -> Vec<(String, f64)> {
    experiment.occurrences().iter().map(|h| (h.name.clone(), h.time)).collect()
}

fn times(experiment: &Experiment, name: &str) -> Vec<f64> {
    passed(experiment).into_iter().filter(|(n, _)| n == name).map(|(_, t)| t).collect()
}

#[test]
fn the_kicked_rotor_is_the_standard_map_to_rounding() {
    // Chirikov, Phys. Rep. 52 (1979) 263: p' = p + K sin θ, θ' = θ + p'
    let text = "
title = 'kicked rotor'
[coordinates]
theta = { initial = 1.0, velocity = 0.3 }
[parameters]
K = 0.9
[lagrangian]
L = \"1/2*theta'^2\"
[[impulses]]
name = 'kick'
every = 1.0
change = { p_theta = 'K*sin(theta)' }
";
    for method in ["taylor", "gauss4", "rk4"] {
        let mut rotor = build(text, |setup| {
            method.clone_into(&mut setup.method);
            setup.settings.step = (method != "taylor").then_some(0.25);
        });
        let (mut theta, mut p) = (1.0_f64, 0.3_f64);
        for n in 1..=30 {
            theta += p;
            p += 0.9 * theta.sin();
            run(&mut rotor, f64::from(n));
            // the map itself magnifies rounding: K = 0.9, thirty times
            let within = 4e-15 * 1.5_f64.powi(n);
            assert!((value(&rotor, "theta") - theta).abs() < within, "{method}: θ after {n}");
            assert!((value(&rotor, "p_theta") - p).abs() < within, "{method}: p after {n}");
        }
        let kicks = times(&rotor, "kick");
        assert_eq!(kicks, (1..=30).map(f64::from).collect::<Vec<_>>(), "{method}");
    }
}

#[test]
fn an_impulse_changes_p_and_not_q_and_gives_the_energy_its_law_says() {
    let text = "
title = 'a struck pendulum that is damped'
[coordinates]
theta = { initial = 0.4 }
[lagrangian]
L = \"1/2*theta'^2 + cos(theta)\"
dissipation = \"0.05*theta'^2\"
[[impulses]]
name = 'impulse'
at = [2.0, 2.0000000001]
change = { p_theta = '0.7' }
[[impulses]]
name = 'second'
at = 2.0
change = { p_theta = \"-2*theta'\" }
";
    let mut after_impulse = file(text);
    run(&mut after_impulse, 1.999_999_999_999);
    let (theta, rate) = (value(&after_impulse, "theta"), value(&after_impulse, "theta'"));
    run(&mut after_impulse, 2.0);
    // they are applied in the order of the file, each to the state that the previous one left
    assert!((value(&after_impulse, "theta") - theta).abs() < 1e-11);
    assert!((value(&after_impulse, "theta'") + (rate + 0.7)).abs() < 1e-11);
    let names: Vec<_> = passed(&after_impulse).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["impulse", "second"]);
    run(&mut after_impulse, 12.0);
    assert_eq!(times(&after_impulse, "impulse"), [2.0, 2.000_000_000_1]);
    let snapshot = after_impulse.snapshot();
    assert!(gauge(&snapshot, "energy balance").max_drift < 1e-14, "impulses included");
}

#[test]
fn impulses_are_counted_from_the_start_in_decimals() {
    let text = format!(
        "{FREE}
[[impulses]]
name = 'tick'
every = 0.1
change = {{ p_x = '1' }}
[run]
start = 0.05
"
    );
    let mut ticks = file(&text);
    run(&mut ticks, 1.05);
    let expected: Vec<f64> =
        (1..=10).map(|n| format!("{:.2}", 0.05 + 0.1 * f64::from(n)).parse().unwrap()).collect();
    assert_eq!(times(&ticks, "tick"), expected);
    assert_eq!(value(&ticks, "x'"), 11.0);
}

#[test]
fn an_impulse_under_a_constraint_has_its_reaction() {
    // an impulse on one end of a dumbbell of two unit masses, along the rod and across it: along it both
    // move together, so half of the impulse is taken up by the rod; across it only one of them moves
    let text = "
title = 'dumbbell'
[coordinates]
x1 = { initial = 0.0, velocity = 0.0 }
y1 = { initial = 0.0, velocity = 0.0 }
x2 = { initial = 2.0, velocity = 0.0 }
y2 = { initial = 0.0, velocity = 0.0 }
[lagrangian]
L = \"1/2*(x1'^2 + y1'^2 + x2'^2 + y2'^2)\"
[[constraints]]
name = 'rod'
expression = '(x1 - x2)^2 + (y1 - y2)^2 - 4'
[[impulses]]
name = 'impulse'
at = 1.0
change = { p_x1 = '3', p_y1 = '1' }
";
    let mut dumbbell = file(text);
    run(&mut dumbbell, 1.0);
    let found = ["x1'", "y1'", "x2'", "y2'"].map(|name| value(&dumbbell, name));
    for (found, right) in found.into_iter().zip([1.5, 1.0, 1.5, 0.0]) {
        assert!((found - right).abs() < 1e-15, "{found} is not {right}");
    }
    // p_x2 = Λ ∂f/∂x2 = Λ · 2 (x2 − x1)
    let OccurrenceKind::Impulse { jump, reaction } =
        &dumbbell.occurrences().iter().next().unwrap().kind
    else {
        panic!("no impulse")
    };
    assert!((reaction[0] - 1.5 / 4.0).abs() < 1e-15, "{reaction:?}");
    assert!((jump[0] - 1.5).abs() < 1e-15 && (jump[2] - 1.5).abs() < 1e-15, "{jump:?}");
}

/// A ball dropped from rest at x = 1 with g = 2.
const BALL: &str = "
title = 'ball'
[coordinates]
x = { initial = 1.0, velocity = 0.0 }
[parameters]
e = 0.8
[lagrangian]
L = \"1/2*x'^2 - 2*x\"
[[impulses]]
name = 'floor'
change = { p_x = \"-(1 + e)*x'\" }
[[events]]
name = 'bounce'
when = 'x'
direction = 'falling'
action = 'impulse:floor'
";

#[test]
fn a_ball_bounces_at_the_times_of_its_parabolas() {
    // from rest at h = 1 with g = 2: the first bounce at 1, then after 2 e, 2 e², …
    let mut ball = file(BALL);
    run(&mut ball, 7.0);
    let mut time = 1.0;
    for (n, found) in times(&ball, "bounce").into_iter().enumerate() {
        assert!((found - time).abs() < 1e-14 * (1.0 + n as f64), "bounce {n}: {found}, {time}");
        time += 2.0 * 0.8_f64.powi(n as i32 + 1);
    }
    assert_eq!(times(&ball, "bounce").len(), 7);
    // Σ ends at t = 1 + 2 e/(1 − e) = 9, and the motion cannot continue beyond
    let progress = ball.advance(10.0, PLENTY);
    assert_eq!(progress, AdvanceOutcome::Stuck);
    let Status::Failed(error) = ball.status() else { panic!("it went on") };
    assert!((error.time - 9.0).abs() < 1e-6, "{}", error.time);
    assert!(error.message.contains("accumulates"), "{}", error.message);
    assert!(value(&ball, "x").abs() < 1e-9, "it did not fall through the floor");
}

#[test]
fn a_particle_leaves_the_sphere_at_two_thirds_and_flies_on() {
    // The Principles of Dynamics, § 1.3.2: from rest at θ₀, cos θ = ⅔ cos θ₀
    let text = "
title = 'sphere'
[coordinates]
x = { initial = 'sin(0.3)', velocity = 0.0 }
z = { initial = 'cos(0.3)', velocity = 0.0 }
[lagrangian]
L = \"1/2*(x'^2 + z'^2) - z\"
[[constraints]]
name = 'sphere'
expression = 'x^2 + z^2 - 1'
[[events]]
name = 'lift-off'
when = 'lambda_sphere'
direction = 'falling'
action = 'release:sphere'
";
    let mut particle = file(text);
    run(&mut particle, 3.0);
    let lift_off = times(&particle, "lift-off");
    assert_eq!(lift_off.len(), 1);
    assert_eq!(value(&particle, "lambda_sphere"), 0.0);
    // the reaction is zero from then on, and the event that waited for it is over
    assert_eq!(particle.vanishing_events(), Vec::<String>::new());
    // it returns at that time, by the parabola
    let back = 3.0 - lift_off[0];
    let z = value(&particle, "z") - value(&particle, "z'") * back - 0.5 * back * back;
    let cosine = 2.0 / 3.0 * 0.3_f64.cos();
    assert!((z - cosine).abs() < 1e-14, "{z} is not {cosine}");
    assert!((value(&particle, "energy") - 0.3_f64.cos()).abs() < 1e-15);
    // after a reset it is on the sphere again
    particle.execute(Command::Reset);
    run(&mut particle, 0.5);
    assert!(value(&particle, "lambda_sphere") > 0.0);
    assert!(particle.occurrences().is_empty());
}

#[test]
fn events_are_located_to_the_last_digits_and_in_their_direction() {
    let text = "
title = 'oscillator'
[coordinates]
x = { initial = 1.0, velocity = 0.0 }
[lagrangian]
L = \"3/2*x'^2 - 3/2*x^2\"
[[events]]
name = 'down'
when = 'x'
direction = 'falling'
[[events]]
name = 'either'
when = 'x'
[[events]]
name = 'top'
when = \"x'\"
direction = 'falling'
[[events]]
name = 'speed'
when = \"x' - sqrt(0.5)\"
direction = 'rising'
";
    let pi = std::f64::consts::PI;
    for (method, step, within) in
        [("taylor", None, 4e-15), ("dop853", None, 1e-12), ("leapfrog", Some(1e-3), 1e-4)]
    {
        let mut oscillator = build(text, |setup| {
            method.clone_into(&mut setup.method);
            setup.settings.step = step;
        });
        run(&mut oscillator, 40.0);
        let check = |name: &str, first: f64, every: f64, count: usize| {
            let found = times(&oscillator, name);
            assert_eq!(found.len(), count, "{method}: {name} {found:?}");
            for (n, time) in found.into_iter().enumerate() {
                let right = first + every * n as f64;
                let error = (time - right).abs();
                assert!(error < within * (1.0 + right), "{method}: {name} {n} off by {error:e}");
            }
        };
        check("down", pi / 2.0, 2.0 * pi, 7);
        check("either", pi / 2.0, pi, 13);
        check("speed", 1.25 * pi, 2.0 * pi, 6);
        // it is at rest at the start, and does not fire there
        check("top", 2.0 * pi, 2.0 * pi, 6);
    }
}

#[test]
fn fast_functions_are_not_stepped_over_and_touches_are_not_crossings() {
    let text = format!(
        "{FREE}
[[events]]
name = 'fast'
when = 'sin(50*t)'
direction = 'rising'
[[events]]
name = 'close pair'
when = '(t - 3)^2 - 1e-8'
[[events]]
name = 'touch'
when = '(t - 5)^2'
[[events]]
name = 'line'
when = 'x - 7'
[[events]]
name = 'never'
when = 'x^2 + 1'
"
    );
    let mut free = file(&text);
    run(&mut free, 10.0);
    let turn = 2.0 * std::f64::consts::PI / 50.0;
    let fast = times(&free, "fast");
    assert_eq!(fast.len(), 79, "{fast:?}");
    for (n, time) in fast.iter().enumerate() {
        assert!((time - turn * (n + 1) as f64).abs() < 1e-13);
    }
    let pair = times(&free, "close pair");
    assert_eq!(pair.len(), 2, "{pair:?}");
    assert!((pair[0] - 2.9999).abs() < 1e-11 && (pair[1] - 3.0001).abs() < 1e-11);
    assert!(times(&free, "touch").is_empty());
    assert_eq!(times(&free, "line"), [7.0]);
    assert!(times(&free, "never").is_empty());
}

/// The times of one event of a free motion, x = t.
fn of_free(when: &str, until: f64, method: &str, step: Option<f64>) -> Vec<f64> {
    let text = format!("{FREE}\n[[events]]\nname = 'e'\nwhen = '{when}'\n");
    let mut free = build(&text, |setup| {
        method.clone_into(&mut setup.method);
        setup.settings.step = step;
        setup.end = Some(until);
        setup.spacing = until;
    });
    run(&mut free, until);
    times(&free, "e")
}

#[test]
fn a_function_that_swings_thousands_of_times_within_a_step_loses_and_doubles_nothing() {
    // the motion is a polynomial: one step reaches the end
    let pi = std::f64::consts::PI;
    for (method, step) in [("taylor", None), ("dop853", None), ("leapfrog", Some(500.0))] {
        for when in ["sin(10*t)", "sin(10*x)"] {
            let found = of_free(when, 5000.0, method, step);
            assert_eq!(found.len(), 15_915, "{method}: {when}");
            for (n, time) in found.iter().enumerate() {
                let right = pi * (n + 1) as f64 / 10.0;
                // the time has two digits fewer there; dop853 sums its steps
                let within = if method == "taylor" { 2e-12 } else { 1e-11 };
                assert!((time - right).abs() < within, "{method}: {when}: {time} for {right}");
            }
        }
    }
}

#[test]
fn what_is_narrow_or_small_within_a_long_step_is_found() {
    // a bell of width 1e-2 after five hundred units of nothing
    let half = 2.0_f64.ln().sqrt() / 100.0;
    let bell = of_free("exp(-1e4*(t - 500)^2) - 0.5", 1000.0, "taylor", None);
    assert_eq!(bell.len(), 2, "{bell:?}");
    assert!((bell[0] - 500.0 + half).abs() < 1e-12 && (bell[1] - 500.0 - half).abs() < 1e-12);
    // a rational function with the same property, and a step of tanh
    let rational = of_free("1/(1 + 1e8*(x - 500)^2) - 0.5", 1000.0, "taylor", None);
    assert_eq!(rational.len(), 2, "{rational:?}");
    let step = of_free("tanh(1e3*(t - 321)) + tanh(1e3*(654 - t)) - 1", 1000.0, "taylor", None);
    assert_eq!(step.len(), 2, "{step:?}");
    // a ripple visible only near zero: g' = 1 + 10 cos(10⁴ t) changes sign twice per ripple
    let ripple = of_free("t - 5 + 0.001*sin(1e4*t)", 10.0, "taylor", None);
    let g = |t: f64| t - 5.0 + 0.001 * (1e4 * t).sin();
    let fine = (0..=400_000).map(|k| g(4.998 + 1e-8 * f64::from(k)).signum());
    let mut last = -1.0;
    let crossings = fine.filter(|&s| std::mem::replace(&mut last, s) != s).count();
    assert!(crossings > 3);
    assert_eq!(ripple.len(), crossings);
    // a function whose slope is zero except at its jumps
    assert_eq!(of_free("sign(sin(10*t + 1)) - 0.5", 100.0, "taylor", None).len(), 318);
    assert_eq!(of_free("abs(sin(10*x)) - 0.5", 100.0, "taylor", None).len(), 637);
    assert_eq!(of_free("max(sin(10*x), cos(10*x), 0.9) - 0.95", 100.0, "taylor", None).len(), 637);
}

#[test]
fn every_pair_of_a_fast_swing_is_found() {
    // each top of the sine is above the level for nine thousandths of a turn
    let found = of_free("sin(1e3*t) - 0.99999", 5.0, "taylor", None);
    assert_eq!(found.len(), 2 * 796);
    let half = 0.99999_f64.acos();
    for (n, pair) in found.chunks(2).enumerate() {
        let top = std::f64::consts::PI * (0.5 + 2.0 * n as f64);
        let right = [top - half, top + half].map(|angle| angle / 1e3);
        assert!((pair[0] - right[0]).abs() < 1e-12, "{n}: {pair:?}");
        assert!((pair[1] - right[1]).abs() < 1e-12, "{n}: {pair:?}");
    }
}

#[test]
fn a_pole_is_no_crossing() {
    let pi = std::f64::consts::PI;
    for (method, step) in [("taylor", None), ("dop853", None), ("rk4", Some(0.3))] {
        let check = |when: &str, right: &[f64]| {
            let found = of_free(when, 10.0, method, step);
            let near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-11;
            let same = found.len() == right.len() && found.iter().zip(right).all(near);
            assert!(same, "{method}: {when}: {found:?}");
        };
        check("1/(t - 5)", &[]);
        check("1/(x - pi)^3 + 1", &[pi - 1.0]);
        check("tan(x)", &[pi, 2.0 * pi, 3.0 * pi]);
        check("sign(x - 5)", &[5.0]);
    }
}

#[test]
fn a_function_faster_than_the_clock_is_an_error() {
    // at t = 10⁴ the digits of the clock are 1.8e-12 apart
    for (speed, reported) in [("1e10", false), ("1e13", true)] {
        let text = format!(
            "{FREE}\n[[events]]\nname = 'e'\nwhen = 'sin({speed}*(t - 10000))'\n[run]\nstart = 10000.0\n"
        );
        let mut free = file(&text);
        free.advance(10_000.000_001, 10_000);
        assert_eq!(
            matches!(free.status(), Status::Failed(_)),
            reported,
            "{speed}: {:?}",
            free.status()
        );
    }
}

#[test]
fn an_event_may_end_the_motion() {
    let text = format!("{FREE}[[events]]\nname = 'far'\nwhen = 'x - 2'\naction = 'stop'\n");
    let mut free = file(&text);
    assert_eq!(free.advance(5.0, PLENTY), AdvanceOutcome::Ended);
    assert_eq!(free.status(), Status::Ended("far".to_owned()));
    assert_eq!((free.time(), value(&free, "x")), (2.0, 2.0));
    free.execute(Command::Reset);
    run(&mut free, 1.5);
    assert_eq!(free.status(), Status::Running);
}

#[test]
fn an_impulse_waits_for_its_key() {
    let text =
        format!("{FREE}[[impulses]]\nname = 'push'\nchange = {{ p_x = '2' }}\nabout = 'a push'\n");
    let mut free = file(&text);
    run(&mut free, 3.0);
    assert!(free.occurrences().is_empty());
    free.execute(Command::ApplyImpulse(0));
    free.execute(Command::ApplyImpulse(7));
    assert_eq!((value(&free, "x"), value(&free, "x'")), (3.0, 3.0));
    run(&mut free, 4.0);
    assert_eq!(value(&free, "x"), 6.0);
    assert_eq!(passed(&free), [("push".to_owned(), 3.0)]);
    let snapshot = free.snapshot();
    assert!(snapshot.notices.last().is_some_and(|n| n.contains("push")), "{:?}", snapshot.notices);
    assert!(gauge(&snapshot, "energy").max_drift < 1e-15, "it is told from the impulse");
    assert!(gauge(&snapshot, "p_x").reason.ends_with(", between impulses"));
}

#[test]
fn what_happens_is_reported_once_and_forgotten_at_a_reset() {
    let mut ball = file(BALL);
    run(&mut ball, 4.0);
    let reported = ball.snapshot().notices;
    assert_eq!(reported.len(), 1, "{reported:?}");
    assert!(reported[0].starts_with("bounce at t = 1:"), "{reported:?}");
    assert!(reported[0].contains("energy −"), "a bounce takes energy: {reported:?}");
    ball.execute(Command::Reset);
    assert!(ball.snapshot().notices.is_empty());
    run(&mut ball, 1.5);
    assert_eq!(ball.snapshot().notices.len(), 1, "and reported again of the new motion");
}

/// An impulse may change a momentum and leave the energy as it was.
#[test]
fn an_impulse_without_work_says_that_the_energy_is_unchanged() {
    for (change, said) in [
        ("-2*x'", "push at t = 1: energy unchanged"),
        ("1", "push at t = 1: energy +1.5"),
        ("-0.5", "push at t = 1: energy −0.375"),
    ] {
        let text = format!(
            "{FREE}[[impulses]]\nname = 'push'\nat = [1.0]\nchange = {{ p_x = \"{change}\" }}\n"
        );
        let mut free = file(&text);
        run(&mut free, 2.0);
        assert_eq!(*free.snapshot().notices, [said.to_owned()], "{change}");
    }
}

/// Where the energy itself is zero, rounding is measured by what it is made of.
#[test]
fn a_turn_at_no_energy_leaves_it_unchanged() {
    let text = "title = 't'\n[coordinates]\nx = { initial = 0.0, velocity = 1.1 }\ny = { initial = 1.0, velocity = 0.3 }\n\
                [lagrangian]\nL = \"1/2*(x'^2 + y'^2) + 0.65\"\n[[impulses]]\nname = 'turn'\nat = [1.0]\n\
                change = { p_x = \"0.7*cos(1.234) - x'\", p_y = \"sqrt(1.3 - (0.7*cos(1.234))^2) - y'\" }\n";
    let mut turned = file(text);
    run(&mut turned, 2.0);
    assert_eq!(*turned.snapshot().notices, ["turn at t = 1: energy unchanged".to_owned()]);
}

/// A pendulum in x, y with a rod, started at the bottom.
const ROD: &str = "
title = 'rod'
[coordinates]
x = { initial = 0.6, velocity = 0.8 }
y = { initial = -0.8 }
[parameters]
m = 1.3
[lagrangian]
L = \"1/2*m*(x'^2 + y'^2) - m*y\"
[[constraints]]
name = 'rod'
expression = 'x^2 + y^2 - 1'
";

#[test]
fn an_impulse_may_bring_a_constrained_body_to_rest() {
    let text = format!(
        "{ROD}[[impulses]]\nname = 'halt'\nat = 0.3\nchange = {{ p_x = \"-m*x'\", p_y = \"-m*y'\" }}\n"
    );
    let mut halted = file(&text);
    run(&mut halted, 0.3);
    assert!(value(&halted, "x'").abs() < 1e-16 && value(&halted, "y'").abs() < 1e-16);
    run(&mut halted, 2.0);
    let energy = gauge(&halted.snapshot(), "energy balance");
    assert!(energy.max_drift < 1e-14, "{}", energy.max_drift);
}

#[test]
fn an_impulse_on_a_relativistic_particle_on_a_wire_is_always_answered() {
    // along the wire p = v/√(1 − v²) grows without bound, so every impulse has its velocity
    for (px, py) in [(2.0, 0.6), (2.0, 1.0), (0.0, 5.0), (5.0, 0.0), (-3.0, 0.2)] {
        let text = format!(
            "title = 'wire'
[coordinates]
x = {{ initial = 0.0, velocity = 0.3 }}
y = {{ initial = 0.0 }}
[lagrangian]
L = \"-sqrt(1 - x'^2 - y'^2) - 0.1*y\"
[[constraints]]
name = 'wire'
expression = 'y - 0.5*x'
[[impulses]]
name = 'impulse'
at = 1.0
change = {{ p_x = '{px}', p_y = '{py}' }}
"
        );
        let mut wire = file(&text);
        run(&mut wire, 0.999_999_999_999);
        let along = |e: &Experiment| value(e, "p_x") + 0.5 * value(e, "p_y");
        let before = along(&wire);
        run(&mut wire, 1.0);
        let after = along(&wire);
        assert!((after - before - px - 0.5 * py).abs() < 1e-11, "{px}, {py}");
        assert!((value(&wire, "y'") - 0.5 * value(&wire, "x'")).abs() < 1e-15);
    }
}

#[test]
fn an_impulse_falls_again_after_a_reset() {
    let text = format!("{FREE}[[impulses]]\nname = 'kick'\nat = [2.0]\nchange = {{ p_x = '1' }}\n");
    let mut free = file(&text);
    for _ in 0..2 {
        run(&mut free, 5.0);
        assert_eq!((value(&free, "x"), times(&free, "kick").len()), (8.0, 1));
        free.execute(Command::Reset);
    }
}

#[test]
fn an_event_where_the_run_or_a_impulse_has_its_time_is_not_late() {
    let text = format!(
        "{FREE}[[events]]\nname = 'wall'\nwhen = 'x - 1'\naction = 'impulse:back'\n\
         [[impulses]]\nname = 'back'\nchange = {{ p_x = \"-2*x'\" }}\n\
         [[impulses]]\nname = 'push'\nat = 1.0\nchange = {{ p_x = '-0.5' }}\n"
    );
    let mut free = file(&text);
    run(&mut free, 1.0);
    assert_eq!(value(&free, "x'"), -1.5, "the wall turns it back, then it is pushed");
    let names: Vec<_> = passed(&free).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["wall", "push"]);
    run(&mut free, 3.0);
    assert_eq!((value(&free, "x"), free.occurrences().count()), (-2.0, 2));
    let text = format!("{FREE}[[events]]\nname = 'far'\nwhen = 'x - 2'\naction = 'stop'\n");
    let mut free = file(&text);
    free.advance(2.0, PLENTY);
    assert_eq!(free.status(), Status::Ended("far".to_owned()));
}

#[test]
fn a_release_does_not_swallow_what_happens_beside_it() {
    let text = "
title = 'beside'
[coordinates]
x = { initial = 0.0, velocity = 1.0 }
y = { initial = 0.0 }
[lagrangian]
L = \"1/2*(x'^2 + y'^2)\"
[[constraints]]
name = 'line'
expression = 'y - x'
[[impulses]]
name = 'back'
change = { p_x = \"-2*x'\" }
[[events]]
name = 'mark'
when = 'y - 0.7'
[[events]]
name = 'let go'
when = 'x - 0.7'
direction = 'rising'
action = 'release:line'
[[events]]
name = 'wall'
when = 'x - 0.7'
direction = 'rising'
action = 'impulse:back'
[[events]]
name = 'soon'
when = 't - 0.70000000000001'
";
    let mut beside = file(text);
    run(&mut beside, 1.0);
    let mut names: Vec<_> = passed(&beside).into_iter().map(|(name, _)| name).collect();
    names.sort();
    assert_eq!(names, ["let go", "mark", "soon", "wall"]);
    assert!((value(&beside, "x") - 0.4).abs() < 1e-13, "{}", value(&beside, "x"));
    assert!((value(&beside, "y") - 1.0).abs() < 1e-13);
}

/// An impulse after which nothing moves any more: e^v − 1 comes to nothing by cancellation, so that the residual of what it
/// should be is rounding beside numbers that are no longer seen.
#[test]
fn an_impulse_may_stop_a_motion_whose_momentum_is_no_polynomial() {
    let momenta: [(&str, fn(f64) -> f64); 4] = [
        ("exp(x') - x'", |v| v.exp() - 1.0),
        ("cosh(x') + x'*0.3", |v| v.sinh() + 0.3),
        ("-sqrt(1 - x'^2)", |v| v / (1.0 - v * v).sqrt()),
        ("exp(-3*x')/3 + x'", |v| 1.0 - (-3.0 * v).exp()),
    ];
    for (law, momentum) in momenta {
        for velocity in [0.6, -0.45] {
            let change = momentum(0.0) - momentum(velocity);
            let text = format!(
                "title = 'stopped'\n[coordinates]\nx = {{ initial = 0, velocity = {velocity} }}\n[lagrangian]\n\
                 L = \"{law}\"\n[[impulses]]\nname = 'stop'\nat = 0.5\nchange = {{ p_x = '{change:?}' }}\n"
            );
            let mut body = file(&text);
            run(&mut body, 1.0);
            let (x, v) = (value(&body, "x"), value(&body, "x'"));
            assert!(v.abs() < 1e-15, "{law} from {velocity}: {v:e}");
            assert!((x - 0.5 * velocity).abs() < 1e-15, "{law} from {velocity}: {x}");
        }
    }
}

/// Near t = 0 the terms of cos t⁴ are eight orders apart, so that a series may end in nothing but zeros though the function
/// goes on.
#[test]
fn events_whose_series_have_gaps_are_all_found() {
    use std::f64::consts::PI;
    let half_turns = |power: i32, end: f64| -> Vec<f64> {
        let last = (end.powi(power) / PI - 0.5).floor() as i32;
        (0..=last).map(|n| ((f64::from(n) + 0.5) * PI).powf(1.0 / f64::from(power))).collect()
    };
    let alone = [
        ("t^40 - 2", vec![2.0_f64.powf(1.0 / 40.0)]),
        ("x^30 - 3", vec![3.0_f64.powf(1.0 / 30.0)]),
        ("exp(-t^12) - 1/2", vec![2.0_f64.ln().powf(1.0 / 12.0)]),
    ];
    let turning = [("cos(t^3)", 3), ("cos(t^4)", 4), ("cos(x^8)", 8)];
    for end in [1.5, 3.0, 4.5] {
        let turning = turning.iter().map(|&(when, power)| (when, half_turns(power, end)));
        for (when, expected) in turning.chain(alone.clone()) {
            // cos(x⁸) swings some 20,000 times up to 3, and half a million up to 4.5
            if expected.len() > 1000 {
                continue;
            }
            let mut free = file(&format!("{FREE}[[events]]\nname = 'zero'\nwhen = \"{when}\"\n"));
            run(&mut free, end);
            let found = times(&free, "zero");
            assert_eq!(found.len(), expected.len(), "{when} to {end}: {found:?}");
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-14 * expected, "{when}: {found} {expected}");
            }
        }
    }
}

/// Roots and inverse functions have kinks that no name shows: √(y²) is |y|, and its series goes on as −y. Beside a `max`, whose
/// kink is another one, the hidden ones count as well: the times are those of sign changes of the closed form.
#[test]
fn functions_with_hidden_kinks_beside_others_vanish_where_their_closed_forms_do() {
    const LAW: &str = "title = 'a test'\n[coordinates]\nx = { initial = 1.3 }\n\
        y = { initial = \"sin(0.3)\", velocity = \"0.7*cos(0.3)\" }\n\
        [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - 1/2*(x^2 + 0.49*y^2)\"\n";
    type Function = fn(f64, f64) -> f64;
    let cases: [(&str, Function); 11] = [
        ("max(x, y) - acos(cos(2*x)) - 0.29", |x, y| x.max(y) - (2.0 * x).cos().acos() - 0.29),
        ("asin(sin(2*y)) - sqrt((x - y)^2) + 0.48", |x, y| {
            (2.0 * y).sin().asin() - (x - y).abs() + 0.48
        }),
        ("sqrt(max(x - 0.3, 0)^2 + y^2) - y + 0.47", |x, y| (x - 0.3).max(0.0).hypot(y) - y + 0.47),
        ("acos(cos(2*x)) + (max(y, 0)^2)^0.5 - 0.31", |x, y| {
            (2.0 * x).cos().acos() + y.max(0.0) - 0.31
        }),
        ("sqrt(max(x - 0.4, 0)^2 + y^2) - 0.5", |x, y| (x - 0.4).max(0.0).hypot(y) - 0.5),
        ("sqrt(max(abs(x) - 0.4, 0)^2 + y^2) - 0.5", |x, y| {
            (x.abs() - 0.4).max(0.0).hypot(y) - 0.5
        }),
        ("(max(x - 0.4, 0)^2 + y^2)^1.5 - 0.1", |x, y| (x - 0.4).max(0.0).hypot(y).powi(3) - 0.1),
        ("max(asin(sin(2*x)), -0.5) + 0.1*y - 0.3", |x, y| {
            (2.0 * x).sin().asin().max(-0.5) + 0.1 * y - 0.3
        }),
        ("min(acos(cos(2*x*y)), x) - 0.2", |x, y| (2.0 * x * y).cos().acos().min(x) - 0.2),
        ("atan(tan(2*x)) - 0.3", |x, _| (2.0 * x).tan().atan() - 0.3),
        ("abs(x) + (min(x, 0.2)^2*y^2)^0.5 - 0.7", |x, y| x.abs() + (x.min(0.2) * y).abs() - 0.7),
    ];
    let end = 40.0;
    for (when, function) in cases {
        let at = |t: f64| function(1.3 * t.cos(), (0.7 * t + 0.3).sin());
        let samples = 100_000_u32;
        let place = |k: u32| end * f64::from(k) / f64::from(samples);
        let mut expected = Vec::new();
        for k in 0..samples {
            let (mut a, mut b) = (place(k), place(k + 1));
            if at(a) * at(b) >= 0.0 {
                continue;
            }
            for _ in 0..60 {
                let middle = f64::midpoint(a, b);
                if at(a) * at(middle) <= 0.0 {
                    b = middle;
                } else {
                    a = middle;
                }
            }
            // a jump is no crossing
            if at(b).abs() < 1e-9 {
                expected.push(b);
            }
        }
        let text = format!("{LAW}[[events]]\nname = 'zero'\nwhen = \"{when}\"\n");
        for spacing in [0.5, end] {
            let mut motion = build(&text, |setup| {
                (setup.end, setup.spacing) = (Some(end), spacing);
            });
            run(&mut motion, end);
            let found = times(&motion, "zero");
            assert_eq!(found.len(), expected.len(), "{when}: {found:?} for {expected:?}");
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-11, "{when}: {found} for {expected}");
            }
        }
    }
}

/// A ball in a stadium, whose wall is a distance of 1 from a segment, flies from wall to wall.
#[test]
fn a_ball_does_not_leave_the_stadium() {
    let text = "title = 'a stadium'\n[coordinates]\nx = { initial = 0.3, velocity = -0.28 }\n\
        y = { initial = 0.2, velocity = 0.96 }\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n[[events]]\n\
        name = 'wall'\nwhen = \"sqrt(max(abs(x) - 1, 0)^2 + y^2) - 1\"\ndirection = 'rising'\n\
        action = 'impulse:mirror'\n[[impulses]]\nname = 'mirror'\nchange = { p_y = \"-2*y'\" }\n";
    let mut ball = file(text);
    run(&mut ball, 4.0);
    // between the straight walls: y = 0.2 + 0.96 t, folded at ±1
    let found = times(&ball, "wall");
    let expected = [0.8 / 0.96, 2.8 / 0.96];
    assert_eq!(found.len(), 2, "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-13, "{found} for {expected}");
    }
    assert!((value(&ball, "y") - 0.04).abs() < 1e-13, "{}", value(&ball, "y"));
}

/// One kink within another one, max(|x| − 1, 0), over steps of free motion that are longer than the whole flight: no ball leaves
/// the stadium, wherever the output stands.
#[test]
fn no_wall_is_missed_behind_a_kink_within_a_kink() {
    let text = "title = 'a stadium'\n[coordinates]\nx = { initial = 0.3, velocity = -0.28 }\n\
        y = { initial = 0.2, velocity = 0.96 }\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n[definitions]\n\
        d = \"max(abs(x) - 1, 0)*sign(x)\"\nv = \"2*(d*x' + y*y')/(d^2 + y^2)\"\n[[events]]\nname = 'wall'\n\
        when = \"d^2 + y^2 - 1\"\ndirection = 'rising'\naction = 'impulse:mirror'\n[[impulses]]\n\
        name = 'mirror'\nchange = { p_x = \"-d*v\", p_y = \"-y*v\" }\n";
    let end = 60.0;
    let mut places = Vec::new();
    // without an end a step of free flight reaches as far as numbers do
    for (end_of_run, spacing) in [(Some(end), 0.5), (Some(end), end), (None, 0.5)] {
        let mut ball = build(text, |setup| (setup.end, setup.spacing) = (end_of_run, spacing));
        run(&mut ball, end);
        let (x, y) = (value(&ball, "x"), value(&ball, "y"));
        let from_segment = (x.abs() - 1.0).max(0.0).hypot(y);
        assert!(from_segment <= 1.0, "outside at ({x}, {y}) with rows every {spacing}");
        places.push(times(&ball, "wall").len());
    }
    // the mean free path of a plane billiard is π A/P, here π (4 + π)/(4 + 2π) = 2.18
    assert!(places.iter().all(|count| *count == places[0]), "{places:?}");
    assert!((20..40).contains(&places[0]), "{places:?} impacts");
}

/// A zero of one function on the kink of another is one event, however close to it the step is cut.
#[test]
fn an_event_on_a_kink_of_another_one_happens_once() {
    let text = "title = 'a test'\n[coordinates]\nx = { initial = -0.3, velocity = 0.28 }\n\
        y = { initial = 0.2, velocity = 0.1 }\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n\
        [[events]]\nname = 'wall'\nwhen = \"max(abs(x) - 1, 0)^2 + y^2 - 1\"\n\
        [[events]]\nname = 'middle'\nwhen = \"x\"\n[[events]]\nname = 'diagonal'\nwhen = \"x - y\"\n\
        [[events]]\nname = 'largest'\nwhen = \"max(abs(x), abs(y)) - 0.5\"\n";
    let mut flight = file(text);
    run(&mut flight, 10.0);
    for (name, time) in [("middle", 0.3 / 0.28), ("diagonal", 0.5 / 0.18), ("largest", 0.8 / 0.28)]
    {
        let found = times(&flight, name);
        assert_eq!(found.len(), 1, "{name}: {found:?}");
        assert!((found[0] - time).abs() < 1e-14, "{name}: {} for {time}", found[0]);
    }
}

/// L = 1/2 x'^2 with x' = 1: the action is t/2.
#[test]
fn an_event_on_the_action_happens_whether_or_not_a_column_shows_the_action() {
    let text = format!(
        "{FREE}[[events]]\nname = 'stop'\nwhen = 'action - 1'\naction = 'impulse:back'\n\
         [[impulses]]\nname = 'back'\nchange = {{ p_x = \"-2*x'\" }}\n\
         [[events]]\nname = 'end'\nwhen = 'action - 2'\naction = 'stop'\n"
    );
    for method in ["taylor", "gauss4", "rk4", "dop853"] {
        let mut free = build(&text, |setup| {
            method.clone_into(&mut setup.method);
            setup.settings.step = matches!(method, "gauss4" | "rk4").then_some(0.25);
        });
        assert_eq!(free.advance(9.0, PLENTY), AdvanceOutcome::Ended, "{method}");
        assert!((free.time() - 4.0).abs() < 1e-12, "{method}: {}", free.time());
        assert!(value(&free, "x").abs() < 1e-12, "{method}: it turned at x = 2");
    }
}

/// A mark at the time of two impulses comes between them in neither order, and no row is in the middle.
#[test]
fn a_mark_at_the_time_of_two_impulses_leaves_the_state_after_both() {
    let back = "[[events]]\nname = 'wall'\nwhen = 'x - 2'\ndirection = 'rising'\naction = 'impulse:back'\n\
         [[impulses]]\nname = 'back'\nchange = { p_x = \"-2*x'\" }\n\
         [[impulses]]\nname = 'push'\nat = 2.0\nchange = { p_x = '-0.5' }\n";
    let mark = "[[events]]\nname = 'mark'\nwhen = '(x - 2)*(x - 3)'\n";
    for method in ["taylor", "rk4", "dop853"] {
        for text in
            [format!("{FREE}{back}"), format!("{FREE}{back}{mark}"), format!("{FREE}{mark}{back}")]
        {
            for rows in [&[1.0, 2.0, 3.0][..], &[3.0], &[2.0]] {
                let mut free = build(&text, |setup| {
                    method.clone_into(&mut setup.method);
                    setup.settings.step = (method == "rk4").then_some(0.25);
                    setup.end = Some(3.0);
                });
                for &time in rows {
                    run(&mut free, time);
                }
                let speed = value(&free, "x'");
                assert!((speed + 1.5).abs() < 1e-12, "{method}: {speed} of {rows:?}\n{text}");
            }
        }
    }
}

#[test]
fn a_mark_at_the_time_of_a_stop_lets_no_impulse_in_between() {
    let text = format!(
        "{FREE}[[impulses]]\nname = 'k'\nat = 2.0\nchange = {{ p_x = '5' }}\n\
         [[events]]\nname = 'stop'\nwhen = 'x - 2'\naction = 'stop'\n\
         [[events]]\nname = 'mark'\nwhen = '(x - 2)*(x - 3)'\n"
    );
    let mut free = file(&text);
    assert_eq!(free.advance(3.0, PLENTY), AdvanceOutcome::Ended);
    assert_eq!((free.time(), value(&free, "x'")), (2.0, 1.0));
}

/// Two walls are met at once; each turns its own coordinate.
#[test]
fn the_row_at_the_time_of_two_impulses_by_events_is_after_both() {
    let text = "
title = 'a corner'
[coordinates]
x = { initial = 0.0, velocity = 1.0 }
y = { initial = 0.0, velocity = 1.0 }
[lagrangian]
L = \"1/2*(x'^2 + y'^2)\"
[[events]]
name = 'right'
when = 'x - 2'
action = 'impulse:x'
[[events]]
name = 'upper'
when = 'y - 2'
action = 'impulse:y'
[[impulses]]
name = 'x'
change = { p_x = \"-2*x'\" }
[[impulses]]
name = 'y'
change = { p_y = \"-2*y'\" }
";
    for method in ["taylor", "rk4", "dop853"] {
        let mut corner = build(text, |setup| {
            method.clone_into(&mut setup.method);
            setup.settings.step = (method == "rk4").then_some(0.25);
            setup.end = Some(3.0);
        });
        run(&mut corner, 2.0);
        let velocity = (value(&corner, "x'"), value(&corner, "y'"));
        assert_eq!(velocity, (-1.0, -1.0), "{method}");
    }
}

/// The function of an event on a circle about the origin, in whatever form it is written.
const ON_A_CIRCLE: [&str; 3] = ["x^2 + y^2 - 1", "sqrt(x^2 + y^2) - 1", "x*x' + y*y'"];

fn circle(starts: &str, rest: &str, when: &str, action: &str) -> String {
    format!(
        "title = 'a circle'\n[coordinates]\nx = {{ initial = 1.0, velocity = 0.0 }}\n\
         y = {{ initial = 0.0, velocity = {starts} }}\n{rest}\n\
         [[events]]\nname = 'circle'\nwhen = \"{when}\"\naction = '{action}'\n"
    )
}

const KEPLER: &str = "[lagrangian]\nL = \"1/2*(x'^2 + y'^2) + 1/sqrt(x^2 + y^2)\"";

#[test]
fn a_function_that_is_zero_all_along_but_for_rounding_never_happens_and_is_named() {
    let hoop = "[lagrangian]\nL = \"1/2*(x'^2 + y'^2) - y\"\n\
                [[constraints]]\nname = 'hoop'\nexpression = '(x^2 + y^2)^3 - 1'";
    for (law, when, method, action) in [
        (KEPLER, ON_A_CIRCLE[0], "taylor", "mark"),
        (KEPLER, ON_A_CIRCLE[0], "dop853", "stop"),
        (KEPLER, ON_A_CIRCLE[1], "gauss4", "mark"),
        (KEPLER, ON_A_CIRCLE[2], "rk4", "stop"),
        (hoop, ON_A_CIRCLE[0], "taylor", "stop"),
        (hoop, ON_A_CIRCLE[1], "dop853", "mark"),
    ] {
        let text = circle("1.0", law, when, action);
        let mut circling = build(&text, |setup| method.clone_into(&mut setup.method));
        run(&mut circling, 7.0);
        assert!(times(&circling, "circle").is_empty(), "{method} {when}");
        let said = circling.vanishing_events();
        let lead = "the function of `circle` is zero all along but for rounding";
        assert!(said.len() == 1 && said[0].starts_with(lead), "{method} {when} {said:?}");
    }
}

#[test]
fn a_function_that_leaves_zero_by_more_than_rounding_happens() {
    // a little more than the speed of the circle: r comes back to 1 after each period, from outside
    for speed in ["1.000000001", "1.0001"] {
        let mut ellipse = file(&circle(speed, KEPLER, "x*x' + y*y'", "mark"));
        run(&mut ellipse, 30.0);
        // at each apoapsis and periapsis, half a period of 2π apart
        let found = times(&ellipse, "circle");
        assert!((8..=10).contains(&found.len()), "{speed}: {found:?}");
        assert!(ellipse.vanishing_events().is_empty());
    }
}

#[test]
fn a_function_that_was_zero_until_a_force_was_switched_on_happens() {
    // the spring begins at t = 5: x leaves 0 and comes back
    let text = "
title = 'a switch'
[coordinates]
x = { initial = 0.0, velocity = 0.0 }
[lagrangian]
L = \"1/2*x'^2 - 1/2*x^2 + x*max(0, sin(t - 5))*max(0, t - 5)/(t + 1)\"
[[events]]
name = 'back'
when = 'x'
";
    let mut switched = file(text);
    run(&mut switched, 30.0);
    let found = times(&switched, "back");
    assert!(found.len() > 4 && found.iter().all(|t| *t > 5.0), "{found:?}");
    assert!(switched.vanishing_events().is_empty());
}
/// A function whose zero is a kink and of a higher order, as x |x| at x = 0, crosses there once and in the direction of x: its
/// series on one side, ±x², is no more than rounding for some 10⁻⁸ of the way. With x = cos t its zeros are known; what is never
/// negative does not cross.
#[test]
fn a_double_zero_at_a_kink_is_crossed_once_and_in_its_direction() {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};
    let acos = 0.3_f64.acos();
    let (x, rate, off) = ([-FRAC_PI_2, FRAC_PI_2], [PI, 0.0], [-acos, acos]);
    // rising and falling first at these, and every turn after them
    let cases = [
        ("x*abs(x)", Some(x)),
        ("sign(x)*x^2", Some(x)),
        ("x*sqrt(x^2)", Some(x)),
        ("max(0, x)^2 - max(0, -x)^2", Some(x)),
        ("x^2*abs(x)*sign(x)", Some(x)),
        ("x^4*sign(x)", Some(x)),
        ("x*abs(x)*(2 + y)", Some(x)),
        ("x^3", Some(x)),
        ("abs(x)^1.5*sign(x)", Some(x)),
        ("(x - 0.3)*abs(x - 0.3)", Some(off)),
        ("x'*abs(x')", Some(rate)),
        ("x*max(0, x)", None),
    ];
    for (when, first) in cases {
        for (k, direction) in ["rising", "falling"].into_iter().enumerate() {
            let text = format!(
                "title = 'a test'\n[coordinates]\nx = {{ initial = 1, velocity = 0 }}\n\
                 y = {{ initial = 0, velocity = 0.7 }}\n[lagrangian]\n\
                 L = \"1/2*(x'^2 + y'^2) - 1/2*(x^2 + 2*y^2)\"\n\
                 [[events]]\nname = 'e'\nwhen = \"{when}\"\ndirection = '{direction}'\n"
            );
            let mut experiment = file(&text);
            run(&mut experiment, 50.0);
            let turns = |first: f64| {
                let all = (0..8).map(move |turn| first + TAU * f64::from(turn));
                all.filter(|&t| t > 0.0 && t < 50.0).collect::<Vec<f64>>()
            };
            let expected = first.map_or_else(Vec::new, |first| turns((first[k] + TAU) % TAU));
            let found = times(&experiment, "e");
            assert_eq!(found.len(), expected.len(), "{when}, {direction}: {found:?}");
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-12, "{when}, {direction}: {found}");
            }
        }
    }
}
