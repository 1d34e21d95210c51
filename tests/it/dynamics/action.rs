//! The action of paths beside a motion, against closed forms and the integral of each path by itself.

use std::f64::consts::PI;

use phaselab::cancel::Cancel;
use phaselab::dynamics::{
    DynamicsError, Lagrangian, VARIATIONS, VariedAction, nearest_stationary_path, stationary_path,
    stationary_path_between, varied_action,
};

use crate::fixtures::{lowered, showing};
use crate::laboratory::{measured, plot_named};
use crate::screen::screen_text;

const OSCILLATOR: &str = "title = 'a test'\n[coordinates]\nx = { initial = 1.0 }\n\
                          [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n[[views]]\nkind = \"action\"\nx = \"x\"\n";

/// The action beside a path x(t), x'(t) of a law with one coordinate.
fn beside(
    law: &str,
    path: impl Fn(f64) -> [f64; 2],
    duration: f64,
) -> (Lagrangian, Result<VariedAction, DynamicsError>) {
    let text = OSCILLATOR.replace("1/2*x'^2 - 1/2*x^2", law);
    let loaded = lowered(&text);
    let mut equations = (*loaded.equations).clone();
    let mut lagrangian = Lagrangian::of(&loaded.model, &mut equations, &[]).unwrap();
    let mut motion = |times: &[f64]| Some(times.iter().map(|&time| path(time).to_vec()).collect());
    let found = varied_action(&mut lagrangian, &mut motion, 0, duration);
    (lagrangian, found)
}

#[test]
fn the_curves_of_an_oscillator_are_those_of_its_second_variation() {
    for duration in [0.5, 2.0, 3.5, 7.0, 20.0] {
        let (_, found) = beside("1/2*x'^2 - 1/2*x^2", |t| [t.cos(), -t.sin()], duration);
        let found = found.unwrap();
        assert!((found.action + (2.0 * duration).sin() / 4.0).abs() < 1e-12 * duration);
        assert_eq!(found.curves.len(), VARIATIONS);
        for (k, curve) in (1..).zip(&found.curves) {
            let k = f64::from(k);
            // ½ ∫ (δ′² − δ²) dt of δ = ε sin(kπt/T)/k
            let second = duration / 4.0 * ((k * PI / duration).powi(2) - 1.0) / (k * k);
            assert_eq!(curve.len(), 25);
            for [epsilon, rise] in curve {
                let exact = second * epsilon * epsilon;
                assert!((rise - exact).abs() < 1e-12 * (1.0 + duration), "{duration} {k} {rise}");
            }
        }
        // beyond half a period the first curve opens downwards, beyond a whole one the second
        let down = |k: usize| found.curves[k].last().unwrap()[1] < 0.0;
        assert_eq!([down(0), down(1)], [duration > PI, duration > 2.0 * PI], "{duration}");
    }
}

#[test]
fn the_curves_of_a_pendulum_are_the_actions_of_the_varied_paths() {
    let duration = 3.0;
    let path = |t: f64| [1.5 * t.sin(), 1.5 * t.cos()];
    let (mut lagrangian, found) = beside("1/2*x'^2 + cos(x)", path, duration);
    let found = found.unwrap();
    let own = lagrangian.action(&mut |t: f64| path(t).to_vec(), duration).unwrap();
    assert!((found.action - own).abs() < 1e-13);
    for (k, curve) in (1..).zip(&found.curves) {
        let rate = f64::from(k) * PI / duration;
        for &[epsilon, rise] in curve {
            let size = epsilon / f64::from(k);
            let mut varied = |t: f64| {
                let [x, v] = path(t);
                vec![x + size * (rate * t).sin(), v + size * rate * (rate * t).cos()]
            };
            let action = lagrangian.action(&mut varied, duration).unwrap();
            assert!((rise - (action - own)).abs() < 1e-12, "{k} {epsilon} {rise}");
        }
    }
    // this path is no motion, so that the action is not stationary
    let slope = found.curves[0][13][1] - found.curves[0][11][1];
    assert!(slope.abs() > 0.01, "{slope}");
}

/// ∂S/∂q = p and ∂S/∂t = −H at the end, with the other sign at the start, of motions known in closed form: an oscillator, and a
/// particle under a force that grows with the time, whose energy is not conserved.
#[test]
fn slopes_by_the_ends_are_momenta_and_energies() {
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-9 * (1.0 + b.abs()), "{a} is not {b}");
    let check = |law: &str,
                 path: &dyn Fn(f64) -> [f64; 2],
                 momentum: &dyn Fn(f64) -> f64,
                 energy: &dyn Fn(f64) -> f64| {
        for duration in [0.7, 2.0, 5.0] {
            let found = beside(law, path, duration).1.unwrap();
            let [first, last] = found.ends.expect("the slopes at both ends");
            near(last.by_position, momentum(duration));
            near(first.by_position, -momentum(0.0));
            near(last.by_time, -energy(duration));
            near(first.by_time, energy(0.0));
            near(last.momentum, momentum(duration));
            near(first.energy, energy(0.0));
        }
    };
    let swing = |t: f64| [t.cos() + 0.3 * t.sin(), -t.sin() + 0.3 * t.cos()];
    check("1/2*x'^2 - 1/2*x^2", &swing, &|t| swing(t)[1], &|_| 0.5 * (1.0 + 0.09));
    // x″ = t: the energy ½ v² − t x is not conserved
    let driven = |t: f64| [t.powi(3) / 6.0 + 0.4 * t, 0.5 * t * t + 0.4];
    let energy = |t: f64| 0.5 * driven(t)[1].powi(2) - t * driven(t)[0];
    check("1/2*x'^2 + t*x", &driven, &|t| driven(t)[1], &energy);
    // x″ = cos 300t, many swings of which fall on any step of differences
    let shaken = |t: f64| {
        let w = 300.0;
        [0.3 * t + (1.0 - (w * t).cos()) / (w * w), 0.3 + (w * t).sin() / w]
    };
    let energy = |t: f64| 0.5 * shaken(t)[1].powi(2) - (300.0 * t).cos() * shaken(t)[0];
    check("1/2*x'^2 + cos(300*t)*x", &shaken, &|t| shaken(t)[1], &energy);
    // Bateman's dual oscillator at y = 0: the action is nothing, and settles before its slopes do
    let text = "title = 't'\n[coordinates]\nx = { initial = 1.0 }\ny = { initial = 0.0 }\n[lagrangian]\n\
                L = \"x'*y' - 40000*x*y\"\n[[views]]\nkind = \"action\"\nx = \"y\"\n";
    let (shown, _) = picture(text, 9.0);
    assert!(!shown.contains('≠'), "{shown}");
    // what is no motion has other slopes
    let wrong = beside("1/2*x'^2 - 1/2*x^2", |t| [1.0 + t, 1.0], 2.0).1.unwrap();
    let [_, last] = wrong.ends.expect("the slopes at both ends");
    assert!((last.by_position - last.momentum).abs() > 0.1);
}

#[test]
fn what_has_no_action_is_reported() {
    let (_, found) = beside("1/2*x'^2 - 1/x", |t| [t - 1.0, 1.0], 2.0);
    assert!(found.unwrap_err().to_string().contains("does not settle"));
    let (_, found) = beside("1/2*x'^2 - sqrt(x)", |t| [t - 1.0, 1.0], 2.0);
    assert!(found.unwrap_err().to_string().contains("not finite"));
    let loaded = lowered(OSCILLATOR);
    let mut equations = (*loaded.equations).clone();
    let mut lagrangian = Lagrangian::of(&loaded.model, &mut equations, &[]).unwrap();
    let found = varied_action(&mut lagrangian, &mut |_: &[f64]| None, 0, 1.0);
    assert!(found.unwrap_err().to_string().contains("cannot be followed"));
}

/// The picture of a file's view at a time, and its measures by their words.
fn picture(text: &str, time: f64) -> (String, impl Fn(&str) -> Option<f64>) {
    picture_of(text, time, "action")
}

/// The same of a view of another kind.
fn picture_of(text: &str, time: f64, kind: &'static str) -> (String, impl Fn(&str) -> Option<f64>) {
    let app = showing(lowered(text), time);
    let shown = screen_text(&app, (120, 40));
    (shown, move |word: &str| measured(&app, plot_named(&app, kind), word))
}

#[test]
fn the_lab_says_when_the_action_is_no_longer_least() {
    let (shown, measure) = picture(OSCILLATOR, 3.1);
    assert!(shown.contains("least of all paths nearby"), "{shown}");
    assert!(
        shown.contains("= p,") && shown.contains("= −p, ∂S/∂t = H") && !shown.contains('≠'),
        "{shown}"
    );
    // x = cos t up to t = 3
    assert!((measure("by_place").unwrap() + 3.0_f64.sin()).abs() < 1e-9);
    assert!((measure("by_time").unwrap() + 0.5).abs() < 1e-9);
    assert_eq!(measure("foci"), Some(0.0));
    assert!((measure("value").unwrap() + (2.0 * 3.0_f64).sin() / 4.0).abs() < 1e-12);
    assert!(measure("rise").unwrap() > 0.0);
    let (shown, measure) = picture(OSCILLATOR, 3.3);
    assert!(shown.contains("kinetic focus at t = 3.1416"), "{shown}");
    assert_eq!(measure("foci"), Some(1.0));
    assert!(measure("rise").unwrap() < 0.0);
    let (shown, measure) = picture(OSCILLATOR, 9.5);
    assert!(shown.contains("3 kinetic foci from t = 3.1416"), "{shown}");
    assert_eq!(measure("foci"), Some(3.0));
    // in other units, and under a fast drive
    for law in ["1e-9*(1/2*x'^2 - 1/2*x^2)", "1/2*x'^2 - 1/2*x^2 + x*cos(1500*t)"] {
        let (shown, _) = picture(&OSCILLATOR.replace("1/2*x'^2 - 1/2*x^2", law), 2.0);
        assert!(shown.contains("= p,") && shown.contains("= −p, ∂S/∂t = H"), "{law}: {shown}");
        assert!(!shown.contains('≠'), "{law}: {shown}");
    }
    // at rest on the top of a hill nothing ever meets again
    let hill = OSCILLATOR.replace("- 1/2*x^2", "+ 1/2*x^2").replace("1.0 }", "0.0 }");
    let (shown, measure) = picture(&hill, 9.5);
    assert!(shown.contains("least of all paths nearby") && measure("foci") == Some(0.0));
}

#[test]
fn the_lab_says_where_the_action_means_nothing() {
    let friction = OSCILLATOR.replace("[[views]]", "dissipation = \"1/10*x'^2\"\n[[views]]");
    let (shown, measure) = picture(&friction, 3.1);
    assert!(shown.contains("not stationary"), "{shown}");
    assert_eq!(measure("foci"), None);
    let wall = OSCILLATOR.to_owned()
        + "[[impulses]]\nname = \"stroke\"\nchange = { p_x = \"-2*x'\" }\n\
           [[events]]\nname = \"wall\"\nwhen = \"x\"\naction = \"impulse:stroke\"\n";
    let (shown, measure) = picture(&wall, 3.1);
    assert!(shown.contains("events act on the motion") && measure("value").is_none(), "{shown}");
}

/// Under a method of fixed step what is seen between the ends of steps has corners there, and the action is that of it all the
/// same. Of an oscillator with x(0) = 1 it is −sin 2t/4, up to the error of the method.
#[test]
fn a_method_of_low_order_has_an_action() {
    for (method, error) in [("leapfrog", 1e-3), ("symplectic-euler", 0.1), ("yoshida4", 1e-6)] {
        for kind in ["action", "abbreviated", "phase-action"] {
            let own = format!("\"{kind}\"");
            let text =
                OSCILLATOR.replace("\"action\"", &own) + "[run]\nmethod = '" + method + "'\n";
            let (shown, measure) = picture_of(&text, 3.1, kind);
            assert!(
                !shown.contains("not smooth") && !shown.contains('≠'),
                "{method} {kind}: {shown}"
            );
            let action = measure("value").expect(kind);
            let exact = if kind == "abbreviated" {
                0.5 * 3.0 - 6.0_f64.sin() / 4.0
            } else {
                -6.0_f64.sin() / 4.0
            };
            assert!((action - exact).abs() < error, "{method} {kind}: {action} {exact}");
        }
        let paths =
            OSCILLATOR.replace("\"action\"", "\"paths\"") + "[run]\nmethod = '" + method + "'\n";
        let (shown, _) = picture_of(&paths, 2.1, "paths");
        assert!(shown.contains("least nearby, the motion"), "{method}: {shown}");
    }
}

/// A search that is cancelled while it looks at the path to begin with ends before it looks at another.
#[test]
fn a_search_for_a_path_ends_once_it_is_cancelled() {
    let loaded = lowered(&OSCILLATOR.replace("1/2*x'^2 - 1/2*x^2", "1/2*x'^2 + cos(x)"));
    let mut equations = (*loaded.equations).clone();
    let mut of = |cancel: &Cancel| {
        let lagrangian = Lagrangian::of(&loaded.model, &mut equations, &[]).unwrap();
        lagrangian.with_cancel(cancel.clone())
    };
    let looks = std::cell::Cell::new(0);
    for nearest in [false, true] {
        for cancelled in [false, true] {
            let cancel = Cancel::new();
            let mut lagrangian = of(&cancel);
            looks.set(0);
            let guess = |t: f64| {
                looks.set(looks.get() + 1);
                if cancelled {
                    cancel.cancel();
                }
                vec![(PI * t / 4.0).sin()]
            };
            let found = if nearest {
                nearest_stationary_path(&mut lagrangian, &guess, 4.0)
            } else {
                stationary_path(&mut lagrangian, &guess, 4.0)
            };
            if cancelled {
                let why = found.expect_err("it is cancelled").to_string();
                assert_eq!(why, "the search was cancelled");
                assert!(looks.get() <= 15, "{}", looks.get());
            } else {
                // the swing, or rest
                let action = found.unwrap().action;
                assert!([3.344_291_248_262_989_3, 4.0].iter().any(|s| (action - s).abs() < 1e-10));
                assert!(looks.get() > 15);
            }
        }
    }
}

/// A particle that a charge at x = 0 attracts for a moment, at t = 1: the straight line from 0 to 0 meets the singularity, and a path to either side
/// does not. What is searched beside the line ends with its budget, also within a search: with none the line's own error stands, and with
/// a tenth of what all arcs take the path is that of the first.
#[test]
fn searches_beside_the_straight_line_end_with_their_budget() {
    let loaded = lowered(
        "title = \"t\"\n[coordinates]\nx = { initial = 0 }\n[lagrangian]\nL = \"1/2*x'^2 + 1/10/(x^2 + (t - 1)^2)\"\n",
    );
    let mut equations = (*loaded.equations).clone();
    let mut lagrangian = || Lagrangian::of(&loaded.model, &mut equations, &[]).unwrap();
    let mut line = lagrangian();
    let why =
        stationary_path(&mut line, &|_| vec![0.0], 2.0).expect_err("there is none").to_string();
    let search = |mut own: Lagrangian, budget: Option<f64>| {
        own.budget = budget.unwrap_or(own.budget);
        let found = stationary_path_between(&mut own, [&[0.0], &[0.0]], 2.0);
        (found, own.work() - line.work())
    };
    let (found, needed) = search(lagrangian(), None);
    let path = found.expect("a path");
    // the deflection is about that of an impulse, h³ = π/20
    let height = path.at(1.0)[0].abs();
    assert!((height - (PI / 20.0).cbrt()).abs() < 0.1, "{height}");
    // one expansion of the highest degree goes beyond
    let within = |taken: f64, part: f64| taken >= part * needed && taken <= part * needed + 5e6;
    let (found, taken) = search(lagrangian(), Some(0.0));
    let said = found.map(|path| path.action).expect_err("nothing was searched").to_string();
    assert!(said == why && within(taken, 0.0), "{said} {taken:e}");
    let (found, taken) = search(lagrangian(), Some(0.1 * needed));
    assert!((found.expect("a path").action - path.action).abs() < 1e-12);
    assert!(within(taken, 0.1), "{taken:e} {needed:e}");
}

/// From a place to the opposite one in half a turn of the circle: the straight line meets the centre, and paths along it are not
/// resolved. The circle is found, whose action is 3π/2.
#[test]
fn a_path_beside_a_collision_is_found() {
    let loaded = lowered(
        "title = \"t\"\n[coordinates]\nx = { initial = 1 }\ny = { initial = 0 }\n[lagrangian]\n\
         L = \"1/2*(x'^2 + y'^2) + 1/sqrt(x^2 + y^2)\"\n",
    );
    let mut equations = (*loaded.equations).clone();
    let mut lagrangian = Lagrangian::of(&loaded.model, &mut equations, &[]).unwrap();
    let found = stationary_path_between(&mut lagrangian, [&[1.0, 0.0], &[-1.0, 0.0]], PI);
    let path = found.expect("the circle");
    assert!((path.action - 1.5 * PI).abs() < 1e-12, "{}", path.action);
    let [x, y] = [0, 1].map(|k| path.at(PI / 3.0)[k]);
    assert!((x - 0.5).abs() < 1e-9 && (y.abs() - 0.75_f64.sqrt()).abs() < 1e-9, "{x} {y}");
}
