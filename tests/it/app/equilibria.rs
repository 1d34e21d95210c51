//! Equilibria in the lab: found by a job, listed, marked on portraits, and begun at.

use phaselab::app::{AppEvent, Asker, Choice, Computation, Effect, Overlay};
use phaselab::dynamics::{Equilibrium, PhaseSpace, equilibria, name_equilibria};
use phaselab::job::{Progress, Share};
use phaselab::model::Model;

use super::real::Real;
use crate::fixtures::{key, lowered};
use crate::record::played;

/// The equilibria of a file, with the names that it gives.
fn named(text: &str) -> Vec<Equilibrium> {
    let case = lowered(text);
    let parameters = case.model.parameter_values();
    let space = PhaseSpace::of((&case.model, &case.equations, &case.system), &parameters).unwrap();
    let start = case.system.initial(0.0, &parameters, &[]).unwrap();
    let mut found = equilibria(&space, &space.state(&start).unwrap()).unwrap().found;
    name_equilibria(&case.model, &parameters, &mut found);
    found
}

/// Presses F, and computes what it asks for.
fn found(real: &mut Real) -> Vec<(String, Choice)> {
    real.app.jobs.in_background = true;
    let effects = real.app.update(AppEvent::Key(key("F")));
    let Some(Effect::Compute(Computation { ticket, job, asker })) = effects
        .into_iter()
        .find(|e| matches!(e, Effect::Compute(c) if c.asker == Asker::Equilibria))
    else {
        panic!("no search: {:?}", real.app.notifications.shown)
    };
    assert_eq!(asker, Asker::Equilibria);
    let progress = Progress::new();
    let outcome = job.run(&progress);
    assert!(progress.share().done > 100, "it says how far it is");
    real.app.update(AppEvent::Computed { ticket, outcome });
    match &real.app.overlay {
        Some(Overlay::Menu(menu)) => {
            menu.items.iter().map(|item| (item.label.clone(), item.choice)).collect()
        }
        _ => panic!("no list: {:?}", real.app.notifications.shown),
    }
}

fn parameter(model: &Model, name: &str) -> f64 {
    model.parameters.iter().find(|p| p.name == name).unwrap().value
}

#[test]
fn the_pendulum_rests_below_stably_and_above_unstably() {
    let mut real = Real::of("pendulum");
    let lines = found(&mut real);
    let labels: Vec<&str> = lines.iter().map(|(label, _)| label.as_str()).collect();
    assert_eq!(lines.len(), 3, "{labels:?}");
    assert!(labels[0].ends_with("stable minimum") && !labels[0].contains("unstable"), "{labels:?}");
    assert!(labels[1].starts_with("  mode ω = 3.13"), "{labels:?}");
    assert!(labels[2].ends_with("unstable maximum"), "{labels:?}");
    // Enter on the upper one begins there, and the motion stays
    real.press("Down Down Enter");
    real.look();
    assert!((real.seen().values[0].abs() - std::f64::consts::PI).abs() < 1e-12);
    real.run(60);
    assert!((real.seen().values[0].abs() - std::f64::consts::PI).abs() < 1e-9);
    // the list is there at once, until a parameter changes
    real.press("F");
    assert!(matches!(real.app.overlay, Some(Overlay::Menu(_))));
    real.press("Esc Right");
    let effects = real.app.update(AppEvent::Key(key("F")));
    assert!(effects.iter().any(|e| matches!(e, Effect::Compute(_))));
    // F again stops it
    let effects = real.app.update(AppEvent::Key(key("F")));
    assert_eq!(effects, [Effect::StopComputing(Asker::Equilibria)]);
    let share = Share { done: 3, total: Some(600) };
    real.app.update(AppEvent::Progress { ticket: 1, share });
    assert!(real.app.notifications.shown.as_ref().unwrap().text.contains("stopped"));
}

#[test]
fn a_motion_along_a_mode_stays_in_it_with_its_frequency() {
    // θ₂/θ₁ = ±√2 and ω² = (2 ∓ √2) g/l for equal masses and rods
    for (mode, ratio, square) in
        [(0, 2.0_f64.sqrt(), 2.0 - 2.0_f64.sqrt()), (1, -(2.0_f64.sqrt()), 2.0 + 2.0_f64.sqrt())]
    {
        let mut real = Real::of("double-pendulum");
        let model = real.lab().loaded.model.clone();
        let (g, l) = (parameter(&model, "g"), parameter(&model, "l1"));
        let lines = found(&mut real);
        let line = lines.iter().position(|(_, c)| *c == Choice::Mode(0, mode)).unwrap();
        real.press(&format!("{} Enter", "Down ".repeat(line)));
        real.look();
        let begun = real.seen().values[..2].to_vec();
        assert!((begun[1] / begun[0] - ratio).abs() < 1e-9, "{begun:?}");
        let period = std::f64::consts::TAU / (square * g / l).sqrt();
        real.experiment.advance(period, u64::MAX);
        real.look();
        // at an amplitude of a tenth the period is longer by about a thousandth
        for (now, begun) in real.seen().values.iter().zip(&begun) {
            assert!((now - begun).abs() < 0.02 * begun.abs(), "{now} {begun}");
        }
        real.experiment.advance(period / 2.0 + period, u64::MAX);
        real.look();
        assert!((real.seen().values[0] + begun[0]).abs() < 0.02 * begun[0].abs());
    }
}

#[test]
fn a_gyroscopic_mode_begins_with_its_velocity() {
    // at L4 of the restricted problem the modes are ellipses: the motion returns after a period
    let mut real = Real::of("restricted-three-body");
    let lines = found(&mut real);
    let stable: Vec<_> = lines.iter().filter(|(l, _)| l.contains(": linearly stable")).collect();
    assert_eq!(lines.iter().filter(|(l, _)| !l.starts_with("  ")).count(), 5, "{lines:?}");
    assert_eq!(stable.len(), 2, "{lines:?}");
    let Choice::Equilibrium(index) = stable[0].1 else { panic!("{stable:?}") };
    let line = lines.iter().position(|(_, c)| *c == Choice::Mode(index, 1)).unwrap();
    let omega: f64 = {
        let label = &lines[line].0;
        let text = label.split("ω = ").nth(1).unwrap().split(':').next().unwrap();
        text.parse().unwrap()
    };
    assert!(omega > 0.9 && omega < 1.0, "{omega}");
    real.press(&format!("{} Enter", "Down ".repeat(line)));
    real.look();
    let present = real.lab().present().unwrap();
    let n = present.physics.system.degrees();
    let rates: f64 = (n..2 * n).map(|i| present.values[i].abs()).fold(0.0, f64::max);
    assert!(rates > 1e-4, "an ellipse is not begun at rest: {rates}");
}

/// The slow mode of L₄ leads along the orbit of the Moon: displaced by a tenth of what Arenstorf's orbit covers, the probe would
/// leave L₄ for good.
#[test]
fn a_mode_begins_where_the_forces_are_nearly_linear() {
    for mode in [0, 1] {
        let mut real = Real::of("restricted-three-body");
        real.run(60);
        real.look();
        let lines = found(&mut real);
        let stable = lines.iter().find(|(label, _)| label.contains(": linearly stable")).unwrap();
        let Choice::Equilibrium(index) = stable.1 else { panic!("{stable:?}") };
        let line = lines.iter().position(|(_, c)| *c == Choice::Mode(index, mode)).unwrap();
        let place = real.lab().present().unwrap().equilibria[index].clone();
        real.press(&format!("{} Enter", "Down ".repeat(line)));
        real.look();
        let off = |real: &Real| {
            let seen = real.seen().values.clone();
            (seen[0] - place.variables[0]).hypot(seen[1] - place.variables[1])
        };
        let begun = off(&real);
        assert!((0.002..0.1).contains(&begun), "{mode}: {begun}");
        let period = std::f64::consts::TAU / place.modes[mode].frequency;
        for part in 1..=40 {
            real.experiment.advance(f64::from(part) * period / 20.0, u64::MAX);
            real.look();
            assert!(off(&real) < 2.0 * begun, "{mode} {part}: {} of {begun}", off(&real));
        }
    }
}

#[test]
fn scripts_find_equilibria_and_portraits_mark_them() {
    drop(played(
        "henon-heiles",
        "Open henon-heiles\nSize 120x40\nPress F\nWait 0.2s\n\
         Assert screen \"Equilibria: Enter starts there\"\nPress Esc\nWait 0.1s\n\
         Assert phase.equilibria = 4 within 0\nAssert phase.stable = 1 within 0\n\
         Press 4\nWait 0.1s\nAssert screen \"stable minimum\"\nAssert screen \"ω = 1: \"\n",
    ));
    // a disc that rolls stands at rest, and would swing if it hung below the table
    drop(played(
        "rolling-coin",
        "Open rolling-coin\nSize 120x40\nPress F\nWait 0.2s\n\
         Assert screen \"mode ω = 3.96: θ 1\"\n",
    ));
    drop(played(
        "struck-rod",
        "Open struck-rod\nSize 120x40\nPress F\nWait 0.2s\n\
         Assert screen \"Equilibria cannot be searched for here: impulses act\"\n",
    ));
}

/// A bob on a rod, in x and y: its place of rest is on the circle, and so is the motion along its mode, which has the
/// frequency of small oscillations less what the amplitude takes from it.
#[test]
fn a_mode_under_constraints_begins_on_their_surface() {
    let mut real = Real::of("pendulum-rod");
    let lines = found(&mut real);
    assert_eq!(lines[1].1, Choice::Mode(0, 0), "{lines:?}");
    real.press("Down Enter");
    real.look();
    let present = real.lab().present().unwrap();
    let [x, y] = [present.values[0], present.values[1]];
    let angle = x.atan2(-y);
    assert!((x * x + y * y - 1.0).abs() < 1e-14 && (angle.abs() - 0.1).abs() < 0.01, "{x} {y}");
    assert!(present.values[2..4].iter().all(|v| v.abs() < 1e-12), "begins at rest");
}

/// Places of a coordinate with a period are near across its ends, and what is as far from one name as from another has none.
#[test]
fn names_are_near_within_a_period_and_nearer_than_halfway() {
    let found = named(
        "title = \"t\"\n[coordinates]\na = { initial = 1.0, velocity = 0.0, period = \"2*pi\" }\n[lagrangian]\n\
         L = \"1/2*a'^2 + cos(a)\"\n[[equilibria]]\nname = \"up\"\nnear = { a = \"-pi\" }\n[[equilibria]]\n\
         name = \"down\"\nnear = { a = \"2*pi\" }\n",
    );
    for one in &found {
        let expected = if one.variables[0].cos() > 0.0 { "down" } else { "up" };
        assert_eq!(one.name, expected, "{}", one.variables[0]);
    }
    assert!(found.len() >= 2);
    let well = |a: &str| {
        format!(
            "title = \"t\"\n[coordinates]\nx = {{ initial = 0.5, velocity = 0.0 }}\n[parameters]\na = {a}\n[lagrangian]\n\
             L = \"1/2*x'^2 + a*x^2/2 - x^4/4\"\n[[equilibria]]\nname = \"left\"\nnear = {{ x = \"-1\" }}\n\
             [[equilibria]]\nname = \"right\"\nnear = {{ x = \"1\" }}\n"
        )
    };
    let found = named(&well("1.0"));
    for one in &found {
        let expected = match one.variables[0] {
            x if x < -0.5 => "left",
            x if x > 0.5 => "right",
            _ => "",
        };
        assert_eq!(one.name, expected);
    }
    assert_eq!(found.len(), 3);
    let found = named(&well("-1.0"));
    assert!(!found.is_empty() && found.iter().all(|one| one.name.is_empty()));
}

/// A name that stands alone is that of the equilibrium at its place, and of no other that is merely the nearest.
#[test]
fn a_name_alone_is_not_given_to_what_is_far_away() {
    let names = |coordinate: &str, potential: &str, near: &str| {
        let text = format!(
            "title = \"t\"\n[coordinates]\nx = {{ initial = 0.3, velocity = 0.0{coordinate} }}\n[lagrangian]\n\
             L = \"1/2*x'^2 - ({potential})\"\n[[equilibria]]\nname = \"here\"\nnear = {{ x = \"{near}\" }}\n"
        );
        let found = named(&text);
        let mut named: Vec<(f64, bool)> =
            found.iter().map(|one| (one.variables[0], !one.name.is_empty())).collect();
        named.sort_by(|a, b| a.0.total_cmp(&b.0));
        named.into_iter().map(|(x, named)| ((x * 10.0).round() / 10.0, named)).collect::<Vec<_>>()
    };
    // V' = (x + 0.9)(x − 0.8)
    let two = "x^3/3 + 0.05*x^2 - 0.72*x";
    assert_eq!(names("", two, "0"), [(-0.9, false), (0.8, false)]);
    assert_eq!(names("", two, "0.7"), [(-0.9, false), (0.8, true)]);
    assert_eq!(names("", two, "-1"), [(-0.9, true), (0.8, false)]);
    let three = "1/2*(x - 3)^2";
    assert_eq!(names("", three, "0"), [(3.0, false)]);
    assert_eq!(names("", three, "2.5"), [(3.0, true)]);
    assert_eq!(names("", "1/2*x^2", "0"), [(0.0, true)]);
    let turning = ", period = \"2*pi\"";
    assert_eq!(names(turning, "-cos(x - 1)", "1.2"), [(-2.1, false), (1.0, true)]);
    assert_eq!(names(turning, "-cos(x - 1)", "1 + pi/2"), [(-2.1, false), (1.0, false)]);
}

/// The five points of the restricted problem have their names in the list and on portraits, and those on the axis on the section
/// y = 0; the names are those that the file gives, at other masses too.
#[test]
fn lagranges_points_have_their_names() {
    for mu in ["0.012277471", "0.2"] {
        let text = include_str!("../../../presets/gravity/restricted-three-body.toml");
        let text = text.replace("mu = { value = 0.012277471", &format!("mu = {{ value = {mu}"));
        let case = lowered(&text);
        let found = named(&text);
        let mu: f64 = mu.parse().unwrap();
        let mut named = 0;
        for one in &found {
            let [x, y] = [one.variables[0], one.variables[1]];
            let expected = match (x, y) {
                (_, y) if y > 0.5 => "L₄",
                (_, y) if y < -0.5 => "L₅",
                (x, _) if x > 1.0 - mu => "L₂",
                (x, _) if x < -mu => "L₃",
                _ => "L₁",
            };
            assert_eq!(one.name, expected, "{x} {y}");
            named += 1;
        }
        assert_eq!(named, 5, "{mu}");
        // of those that are missing no other gets the name
        let mut some: Vec<_> = found.iter().filter(|one| one.name != "L₁").cloned().collect();
        for one in &mut some {
            one.name.clear();
        }
        name_equilibria(&case.model, &case.model.parameter_values(), &mut some);
        assert!(some.iter().all(|one| one.name != "L₁" && !one.name.is_empty()));
    }
}
