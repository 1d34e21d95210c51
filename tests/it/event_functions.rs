//! Events whose function leaves its zero after an impulse, jumps at a cut, begins to exist on the way, or is constant.

use std::f64::consts::{PI, TAU};

use phaselab::experiment::Experiment;

use crate::experiment::{build, run};
use crate::nonempty;

/// Methods, each with its step if that is fixed.
const METHODS: [(&str, Option<f64>); 7] = [
    ("taylor", None),
    ("dop853", None),
    ("rk4", Some(0.02)),
    ("gauss4", Some(0.02)),
    ("leapfrog", Some(0.02)),
    ("yoshida4", Some(0.02)),
    ("symplectic-euler", Some(0.02)),
];

/// A coordinate with this L and these initial values, and an event on it.
fn moving(
    (law, initial): (&str, &str),
    (when, direction, action): (&str, &str, &str),
    until: f64,
    (method, step): (&str, Option<f64>),
) -> Experiment {
    let text = format!(
        "title = \"Events\"\n[coordinates]\nx = {{ {initial} }}\n[lagrangian]\nL = \"{law}\"\n[[impulses]]\n\
         name = \"kick\"\nchange = {{ p_x = \"0.1\" }}\n[[events]]\nname = \"e\"\nwhen = \"{when}\"\n\
         direction = \"{direction}\"\naction = \"{action}\"\n"
    );
    let mut experiment = build(&text, |setup| {
        method.clone_into(&mut setup.method);
        setup.settings.step = step;
    });
    run(&mut experiment, until);
    experiment
}

fn times(experiment: &Experiment) -> Vec<f64> {
    experiment.occurrences().iter().map(|h| h.time).collect()
}

/// Whether these are the times, each to within so much.
fn near(found: &[f64], expected: &[f64], within: f64) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < within)
}

const OSCILLATOR: &str = "1/2*x'^2 - 1/2*x^2";
const FREE: &str = "1/2*x'^2";

#[test]
fn an_impulse_at_a_gate_that_is_passed_acts_once() {
    // x = 0.4 + …: from a kick at x = g with the velocity v back to g with −|v| takes 2 atan(v/g) if v > 0, a turn if v < 0
    let (gate, kick) = (0.4_f64, 0.1_f64);
    let mut v = -(0.3_f64.powi(2) + 0.5_f64.powi(2) - gate * gate).sqrt();
    // from x = 0.3, x' = 0.5 up through the gate and down to it
    let mut time = (0.5_f64).atan2(0.3) + (gate / v.hypot(gate)).acos();
    let mut expected = Vec::new();
    while time < 32.0 {
        expected.push(time);
        v += kick;
        time += if v > 0.0 { 2.0 * (v / gate).atan() } else { TAU };
        v = -v.abs();
    }
    assert!(expected.len() > 15);
    let start = "initial = 0.3, velocity = 0.5";
    for (method, step, within) in [
        ("taylor", None, 1e-12),
        ("dop853", None, 1e-8),
        ("rk4", Some(0.02), 1e-6),
        ("gauss4", Some(0.02), 1e-6),
        ("gauss6", Some(0.05), 1e-8),
    ] {
        let event = ("x - 0.4", "falling", "impulse:kick");
        let found = times(&moving((OSCILLATOR, start), event, 32.0, (method, step)));
        assert!(near(&found, &expected, within), "{method}: {} {found:?}", found.len());
    }
}

#[test]
fn an_impulse_at_a_zero_of_the_time_acts_once() {
    let every = |first: f64, between: f64| (0..).map(move |k| first + between * f64::from(k));
    for (when, direction, expected) in [
        ("sin(t)", "either", every(PI, PI)),
        ("sin(t)", "rising", every(TAU, TAU)),
        ("t - 2", "either", every(2.0, 100.0)),
        ("t^2 - 3", "rising", every(3.0_f64.sqrt(), 100.0)),
        ("sin(1000*t)*exp(-t)", "falling", every(PI / 1000.0, TAU / 1000.0)),
    ] {
        let until = if when.contains("1000") { 0.1 } else { 7.0 };
        let expected: Vec<f64> = expected.take_while(|t| *t < until).collect();
        for method in METHODS {
            let start = "initial = 0.3, velocity = 0.5";
            let event = (when, direction, "impulse:kick");
            let found = times(&moving((OSCILLATOR, start), event, until, method));
            assert!(near(&found, &expected, 2e-14), "{method:?}, {when}: {found:?}");
        }
    }
}

#[test]
fn the_cut_of_an_angle_is_no_zero_of_it() {
    // x = 0.1 + v t: the angle x less c vanishes at c + 2πk, and jumps at the odd multiples of π
    for speed in [1.0, 0.013] {
        for (when, at) in [
            ("atan2(sin(x), cos(x))", 0.0),
            ("atan2(sin(x), cos(x)) - 1", 1.0),
            ("2*atan(tan(x/2))", 0.0),
            ("atan2(sin(x), cos(x)) + 3.1", -3.1),
        ] {
            for (method, step) in METHODS {
                let until = if step.is_some() { 10.0 } else { 30.0 } / speed;
                let zeros = (0..).map(|k| (at - 0.1 + TAU * f64::from(k)) / speed);
                let expected: Vec<f64> =
                    zeros.skip_while(|t| *t <= 0.0).take_while(|t| *t < until).collect();
                let start = format!("initial = 0.1, velocity = {speed}");
                let event = (when, "either", "mark");
                let method = (method, step.map(|step| step / speed));
                let found = times(&moving((FREE, &start), event, until, method));
                assert!(
                    near(&found, &expected, 1e-12 * until),
                    "{method:?}, {when}, {speed}: {found:?}, not {expected:?}"
                );
            }
        }
    }
}

#[test]
fn the_angle_of_a_turning_pendulum_vanishes_where_its_sine_does() {
    let law = "1/2*x'^2 + cos(x)";
    let start = "initial = 0.1, velocity = 2.5, period = \"2*pi\"";
    for method in METHODS {
        let until = if method.1.is_some() { 10.0 } else { 60.0 };
        let of = |when: &str| times(&moving((law, start), (when, "either", "mark"), until, method));
        let (angle, sine) = (of("atan2(sin(x), cos(x))"), of("sin(x/2)"));
        assert!(sine.len() > 2 && near(&angle, &sine, 1e-11), "{method:?}: {angle:?}, {sine:?}");
    }
}

#[test]
fn a_root_that_begins_to_exist_is_no_zero() {
    // x = cos t: √(x − ½) = 0.3 where x = 0.59, and it has no value where x < ½
    let first = 0.59_f64.acos();
    let both = (0..).flat_map(|k| [TAU * f64::from(k) - first, TAU * f64::from(k) + first]);
    let expected: Vec<f64> = both.skip(1).take_while(|t| *t < 15.0).collect();
    for (method, step) in METHODS {
        let steps = step.map_or(vec![None], |step| vec![Some(step), Some(0.5 * step)]);
        for step in nonempty(steps) {
            let event = ("sqrt(x - 0.5) - 0.3", "either", "mark");
            let start = "initial = 1.0, velocity = 0.0";
            let found = times(&moving((OSCILLATOR, start), event, 15.0, (method, step)));
            let within = if method == "symplectic-euler" { 2e-2 } else { 2e-3 };
            assert!(near(&found, &expected, within), "{method}, {step:?}: {found:?}");
        }
    }
}

#[test]
fn no_pole_is_an_event_whatever_the_method() {
    // x = 0.1 + t
    for method in METHODS {
        let start = "initial = 0.1, velocity = 1.0";
        let of = |when: &str| times(&moving((FREE, start), (when, "either", "mark"), 10.0, method));
        let expected: Vec<f64> = (1..4).map(|k| PI * f64::from(k) - 0.1).collect();
        let found = of("tan(x)");
        assert!(near(&found, &expected, 1e-12), "{method:?}: {found:?}");
        let found = of("1/(x - 3.3)");
        assert!(found.is_empty(), "{method:?}: {found:?}");
    }
}

#[test]
fn a_constant_of_the_motion_has_no_zeros() {
    for method in METHODS.iter().take(4) {
        for (when, law, start) in [
            ("energy - 0.5", OSCILLATOR, "initial = 1.0, velocity = 0.0"),
            ("x^2 + x'^2 - 1", OSCILLATOR, "initial = 1.0, velocity = 0.0"),
            ("p_x - 0.7", FREE, "initial = 0.0, velocity = 0.7"),
        ] {
            let found = times(&moving((law, start), (when, "either", "mark"), 10.0, *method));
            assert!(found.is_empty(), "{method:?}, {when}: {} events", found.len());
        }
    }
}

/// A pendulum on a string, from below with 3.2: where the tension vanishes, cos θ = (v² − 2 g)/(3 g) from the top, it flies on
/// a parabola until the string is taut again.
#[test]
fn what_a_constraint_keeps_at_zero_is_no_event_before_its_release() {
    let (g, v) = (4.0_f64, 3.2_f64.powi(2));
    // at the height h above the centre: v² − 2 g (1 + h) = g h
    let height = (v - 2.0 * g) / (3.0 * g);
    let (speed, across) = ((g * height).sqrt(), (1.0 - height * height).sqrt());
    // x = a − s h t, y = h + s a t − g t²/2 with a² + h² = 1, s² = g h: x² + y² = 1 again at t = 4 a s/g
    let flight = 4.0 * across * speed / g;
    let text = "title = \"String\"\n[coordinates]\nx = { initial = 0.0, velocity = 3.2 }\ny = { initial = -1.0 }\n\
                [lagrangian]\nL = \"1/2*(x'^2+y'^2)-4*y\"\n[[constraints]]\nname = \"rod\"\n\
                expression = \"x^2+y^2-1\"\n[[events]]\nname = \"slack\"\nwhen = \"lambda_rod\"\n\
                direction = \"rising\"\naction = \"release:rod\"\n[[events]]\nname = \"taut\"\n\
                when = \"2*x^2+2*y^2-2\"\ndirection = \"rising\"\naction = \"mark\"\n";
    for (method, step) in [("taylor", None), ("dop853", None), ("rk4", Some(0.01))] {
        let mut string = build(text, |setup| {
            method.clone_into(&mut setup.method);
            setup.settings.step = step;
        });
        run(&mut string, 4.0);
        let found = times(&string);
        let right = found.len() == 2 && (found[1] - found[0] - flight).abs() < 1e-6;
        assert!(right, "{method}: {found:?}, not {flight} apart");
    }
}

/// A function that jumps through zero crosses it there, whichever way its size changes beside the jump, and at one of the kinks of the
/// motion, where it has a third value, as elsewhere.
#[test]
fn a_jump_through_zero_is_a_crossing_at_its_time() {
    let bounces = |first: f64| -> Vec<f64> {
        (0..6).map(|k| first * f64::from(2 * k + 1)).filter(|t| *t < 16.0).collect()
    };
    let root = std::f64::consts::SQRT_2;
    let kinked = "1/2*x'^2 - abs(x)";
    let dry = "-0.2*sign(x')";
    let pushed = "-1 + 3*max(0, sign(t - 2))";
    let cases = [
        (FREE, "initial = 0, velocity = 1", "0", "sign(x - 1)", vec![1.0]),
        (FREE, "initial = 0, velocity = 1", "0", "x - 3 + 5*sign(x - 2)", vec![2.0]),
        (FREE, "initial = 0, velocity = 1", "0", "(x - 3)*sign(x - 2)", vec![2.0, 3.0]),
        (FREE, "initial = 0", pushed, "x'' - 0.5", vec![2.0]),
        (OSCILLATOR, "initial = 3", dry, "x'' + x", vec![PI, TAU, 3.0 * PI]),
        (kinked, "initial = 1", "0", "x''", bounces(root)),
        (kinked, "initial = 1", "0", "x'' + 0.1*x", bounces(root)),
        (kinked, "initial = 2", "0", "x''", bounces(2.0)),
        (kinked, "initial = 2", "0", "sign(x) - x/10", bounces(2.0)),
    ];
    for (law, initial, force, when, expected) in &cases {
        let until = if *force == dry { 10.0 } else { 16.0 };
        let text = format!(
            "title = \"Jumps\"\n[coordinates]\nx = {{ {initial} }}\n[lagrangian]\nL = \"{law}\"\nforces = {{ x = \"{force}\" }}\n\
             [[events]]\nname = \"jump\"\nwhen = \"{when}\"\n[[events]]\nname = \"other\"\nwhen = \"x*x'' + 0.5\"\n"
        );
        for method in ["taylor", "dop853"] {
            let mut experiment = build(&text, |setup| method.clone_into(&mut setup.method));
            run(&mut experiment, until);
            let jumps = experiment.occurrences().iter().filter(|h| h.name == "jump");
            let found: Vec<f64> = jumps.map(|h| h.time).collect();
            assert!(near(&found, expected, 1e-9), "{law}, {when}, {method}: {found:?}");
        }
    }
}
