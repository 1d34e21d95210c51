//! The three principles of stationary action beside a motion, against closed forms and lengths of ways.

use std::f64::consts::PI;
use std::sync::Arc;

use phaselab::app::{App, AppEvent, Pane};
use phaselab::dynamics::{
    Hamiltonian, Lagrangian, PhaseSpace, VariedAction, conjugate_points,
    conjugate_points_at_energy, varied_abbreviated_action, varied_phase_action,
};
use phaselab::instrument::Layer;
use phaselab::integrate::{METHODS, Settings};

use crate::fixtures::{catalog, lab, lowered, press, snapshot};
use crate::laboratory::{layers, measure, measured, plot_named};
use crate::screen::screen_text;

/// A law in the plane, without parameters.
fn plane(law: &str) -> String {
    format!(
        "title = 'a test'\n[coordinates]\nx = {{ initial = 0.0 }}\ny = {{ initial = 0.0 }}\n[lagrangian]\nL = \"{law}\"\n"
    )
}

/// The abbreviated action beside a path x, y, x', y'; the coordinate of this index is varied.
fn abbreviated(
    law: &str,
    path: impl Fn(f64) -> [f64; 4],
    (coordinate, duration): (usize, f64),
) -> Result<VariedAction, String> {
    let loaded = lowered(&plane(law));
    let mut equations = (*loaded.equations).clone();
    let mut lagrangian = Lagrangian::of(&loaded.model, &mut equations, &[]).unwrap();
    let mut motion = |times: &[f64]| Some(times.iter().map(|&time| path(time).to_vec()).collect());
    varied_abbreviated_action(&mut lagrangian, &mut motion, coordinate, duration)
        .map_err(|why| why.to_string())
}

/// The length of a curve and ∫ x dy along it, by chords, improved once by those of half as many.
fn chords(curve: impl Fn(f64) -> [f64; 2]) -> [f64; 2] {
    let by = |count: u32| {
        let mut sums = [0.0; 2];
        for i in 0..count {
            let [a, b] = [i, i + 1].map(|i| curve(f64::from(i) / f64::from(count)));
            sums[0] += (b[0] - a[0]).hypot(b[1] - a[1]);
            sums[1] += 0.5 * (a[0] + b[0]) * (b[1] - a[1]);
        }
        sums
    };
    let (coarse, fine) = (by(1000), by(2000));
    [0, 1].map(|k| (4.0 * fine[k] - coarse[k]) / 3.0)
}

#[test]
fn without_forces_the_abbreviated_action_is_the_length_of_the_way() {
    let (speed, duration) = (2.0, 1.5);
    let path = |t: f64| [speed * t, 0.0, speed, 0.0];
    let found = abbreviated("1/2*(x'^2 + y'^2)", path, (1, duration)).unwrap();
    assert!((found.action - speed * speed * duration).abs() < 1e-13);
    for (k, curve) in (1..).zip(&found.curves) {
        assert_eq!(curve.len(), 25);
        let k = f64::from(k);
        for &[epsilon, rise] in curve {
            let way = |s: f64| [speed * duration * s, epsilon / k * (k * PI * s).sin()];
            let exact = speed * (chords(way)[0] - speed * duration);
            assert!((rise - exact).abs() < 1e-9, "{k} {epsilon}: {rise} is not {exact}");
        }
    }
}

/// A charge on a circle: W = v · length + B ∫ x dy.
#[test]
fn a_field_that_turns_the_motion_adds_its_flux() {
    let duration = 2.0;
    let path = |t: f64| [t.sin(), t.cos(), t.cos(), -t.sin()];
    let found = abbreviated("1/2*(x'^2 + y'^2) + x*y'", path, (0, duration)).unwrap();
    let way = |size: f64, k: f64, s: f64| {
        let t = duration * s;
        [t.sin() + size / k * (k * PI * s).sin(), t.cos()]
    };
    let exact = |size, k| chords(|s| way(size, k, s)).iter().sum::<f64>();
    assert!((found.action - exact(0.0, 1.0)).abs() < 1e-10);
    for (k, curve) in (1..).zip(&found.curves) {
        for &[epsilon, rise] in curve {
            let exact = exact(epsilon, f64::from(k)) - exact(0.0, 1.0);
            assert!((rise - exact).abs() < 1e-9, "{k} {epsilon}: {rise} is not {exact}");
        }
        // that path is a motion, x″ = y′ and y″ = −x′: its slope vanishes, extrapolated from two differences
        let slope = |n: usize| {
            (curve[12 + n][1] - curve[12 - n][1]) / (curve[12 + n][0] - curve[12 - n][0])
        };
        let slope = (4.0 * slope(1) - slope(2)) / 3.0;
        assert!(slope.abs() < 1e-5, "{k}: {slope}");
    }
}

#[test]
fn a_way_that_the_energy_forbids_has_no_point() {
    // thrown upwards to where it turns: beside it no higher place is allowed
    let path = |t: f64| [t, t - 0.5 * t * t, 1.0, 1.0 - t];
    let found = abbreviated("1/2*(x'^2 + y'^2) - y", path, (1, 1.6)).unwrap();
    let first = &found.curves[0];
    assert!(first.iter().all(|at| at[0] <= 0.5) && first.len() > 12, "{first:?}");
    let timed = abbreviated("1/2*(x'^2 + y'^2) - y*t", path, (1, 1.6));
    assert!(timed.unwrap_err().contains("depends on the time"));
    let quartic = abbreviated("1/4*(x'^2 + y'^2)^2", path, (1, 1.6));
    assert!(quartic.unwrap_err().contains("second degree"));
}

#[test]
fn in_phase_space_the_action_is_a_saddle() {
    let text = "title = 'a test'\n[coordinates]\nx = { initial = 1.0 }\n[hamiltonian]\nH = \"p_x^2/2 + x^2/2\"\n";
    let loaded = lowered(text);
    let mut equations = (*loaded.equations).clone();
    let mut lagrangian = Lagrangian::of(&loaded.model, &mut equations, &[]).unwrap();
    let mut hamiltonian = Hamiltonian::of(&loaded.model, &mut equations, &[]).unwrap();
    for duration in [0.7, 2.0, 3.5, 7.0] {
        let path = |t: f64| vec![t.cos(), -t.sin()];
        let mut motion = |times: &[f64]| Some(times.iter().map(|&time| path(time)).collect());
        let functions = (&mut hamiltonian, &mut lagrangian);
        let found = varied_phase_action(functions, &mut motion, 0, duration).unwrap();
        assert!((found.action + (2.0 * duration).sin() / 4.0).abs() < 1e-12 * duration);
        // of ε sin πs alone −½ ∫ δq², of ε c cos πs alone −½ ∫ δp², of both together Hamilton's ½ ∫ (δq′² − δq²)
        let of_q = -duration / 4.0;
        let together = duration / 4.0 * ((PI / duration).powi(2) - 1.0);
        let [q, p, both] = &found.curves[..] else { panic!("three curves") };
        let scale = (p.last().unwrap()[1] / (of_q * p.last().unwrap()[0].powi(2))).sqrt();
        for (curve, second) in [(q, of_q), (p, of_q * scale * scale), (both, together)] {
            assert_eq!(curve.len(), 25);
            for [epsilon, rise] in curve {
                let exact = second * epsilon * epsilon;
                assert!((rise - exact).abs() < 1e-12 * (1.0 + duration), "{duration}: {rise}");
            }
        }
        // c is the ratio of the ranges: both are 1 once half a turn has gone by
        assert!(duration < 2.0 * PI || (scale - 1.0).abs() < 0.01, "{scale}");
    }
}

/// A ball thrown at an angle touches the parabola of safety at v/(g sin α), where its velocity is at right angles to the first;
/// its action ∫ L dt is least for ever, since L is quadratic in q̇ and linear in q.
#[test]
fn a_thrown_ball_passes_a_focus_of_its_way_and_none_of_its_path() {
    for (vx, vy) in [(1.0, 2.0), (3.0, 1.5), (0.5, 2.5)] {
        let text = plane("1/2*(x'^2 + y'^2) - y")
            .replacen("initial = 0.0", &format!("initial = 0.0, velocity = {vx}"), 1)
            .replacen("initial = 0.0 }", &format!("initial = 0.0, velocity = {vy} }}"), 1);
        let loaded = lowered(&text);
        let space =
            PhaseSpace::of((&loaded.model, &loaded.equations, &loaded.system), &[]).unwrap();
        let start = space.state(&loaded.system.initial(0.0, &[], &[]).unwrap()).unwrap();
        let method = (&METHODS[0], Settings { step: None, tolerance: None });
        let touched = (vx * vx + vy * vy) / vy;
        let found = conjugate_points_at_energy(&space, method, &start, 1.5 * touched).unwrap();
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0] - touched).abs() < 1e-11 * touched, "{found:?} is not {touched}");
        let before = conjugate_points_at_energy(&space, method, &start, 0.99 * touched).unwrap();
        assert!(before.is_empty());
        assert!(conjugate_points(&space, method, &start, 1.5 * touched).unwrap().is_empty());
    }
}

/// On a sphere both principles have their foci at the antipodes; with one coordinate ways meet where it turns.
#[test]
fn foci_at_equal_energy_are_those_of_geodesics() {
    let method = (&METHODS[0], Settings { step: None, tolerance: None });
    let found = |text: &str, duration: f64| {
        let loaded = lowered(text);
        let space =
            PhaseSpace::of((&loaded.model, &loaded.equations, &loaded.system), &[]).unwrap();
        let start = space.state(&loaded.system.initial(0.0, &[], &[]).unwrap()).unwrap();
        conjugate_points_at_energy(&space, method, &start, duration)
    };
    let sphere = plane("1/2*(x'^2 + sin(x)^2*y'^2)")
        .replacen("initial = 0.0", "initial = 1.0, velocity = 0.7", 1)
        .replacen("initial = 0.0 }", "initial = 0.0, velocity = 1.3 }", 1);
    let speed = 0.7_f64.hypot(1.0_f64.sin() * 1.3);
    let foci = found(&sphere, 2.5 * PI / speed).unwrap();
    assert_eq!(foci.len(), 2, "{foci:?}");
    for (n, focus) in (1..).zip(&foci) {
        assert!((focus - f64::from(n) * PI / speed).abs() < 1e-10, "{foci:?}");
    }
    let line = "title = 'a test'\n[coordinates]\nx = { initial = 0.0, velocity = 1.0 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n";
    let turns = found(line, 6.0).unwrap();
    assert_eq!(turns.len(), 2);
    assert!((turns[0] - 0.5 * PI).abs() < 1e-12 && (turns[1] - 1.5 * PI).abs() < 1e-12);
    let at_rest = found(&plane("1/2*(x'^2 + y'^2) - y"), 1.0).unwrap_err();
    assert!(at_rest.to_string().contains("begins at rest"), "{at_rest}");
    let timed = found(&plane("1/2*(x'^2 + y'^2) - y*t"), 1.0).unwrap_err();
    assert!(timed.to_string().contains("not conserved"), "{timed}");
}

/// A key goes from one principle to the next, and the pane says what each finds.
#[test]
fn a_key_shows_the_next_principle() {
    let text = plane("1/2*(x'^2 + y'^2) - y")
        .replacen("initial = 0.0", "initial = 0.0, velocity = 1.0", 1)
        .replacen("initial = 0.0 }", "initial = 0.0, velocity = 2.0 }", 1)
        + "[[views]]\nkind = \"action\"\nx = \"y\"\n";
    let loaded = lowered(&text);
    let seen = Arc::new(snapshot(&loaded, 3.0));
    let (mut app, _) = App::new(catalog(), Some("test"));
    app.update(AppEvent::Loaded(Ok(loaded)));
    app.update(AppEvent::Snapshot(Arc::clone(&seen)));
    let shown = |app: &mut App| {
        app.update(AppEvent::Snapshot(Arc::clone(&seen)));
        screen_text(app, (160, 40))
    };
    let measure = |app: &App, kind: &str, word: &str| measured(app, plot_named(app, kind), word);
    let hamilton = shown(&mut app);
    assert!(hamilton.contains("least of all paths nearby"), "{hamilton}");
    // ∫ L dt = ½ (1 + 4) t − 2 t² + ⅓ t³
    assert!((measure(&app, "action", "value").unwrap() + 1.5).abs() < 1e-12);
    assert_eq!(measure(&app, "action", "foci"), Some(0.0));
    let plots = &app.lab.as_ref().unwrap().plots;
    let place = plots.iter().position(|plot| plot.kind.name() == "action").unwrap();
    app.lab.as_mut().unwrap().focus.pane = Pane::Plot(place);
    press(&mut app, "Q");
    let maupertuis = shown(&mut app);
    assert!(maupertuis.contains("kinetic focus at t = 2.5"), "{maupertuis}");
    // ∫ v² dt = 5 t − 2 t² + ⅓ t³
    assert!((measure(&app, "abbreviated", "value").unwrap() - 6.0).abs() < 1e-12);
    assert_eq!(measure(&app, "abbreviated", "foci"), Some(1.0));
    press(&mut app, "Q");
    let apart = shown(&mut app);
    assert!(apart.contains("neither least nor greatest"), "{apart}");
    assert!((measure(&app, "phase-action", "value").unwrap() + 1.5).abs() < 1e-12);
    press(&mut app, "Q");
    assert!(shown(&mut app).contains("least of all paths nearby"));
}

/// With one coordinate there is one way at an energy; where the motion rests there is none, and no foci are counted on it.
#[test]
fn one_coordinate_has_no_other_way() {
    for (velocity, words) in [("0.0", "at rest: no path"), ("1.6", "no other path at this H")] {
        let text = format!(
            "title = \"t\"\n[coordinates]\nq = {{ initial = 0.0, velocity = {velocity} }}\n\
             [lagrangian]\nL = \"1/2*q'^2 + cos(q)\"\n[[views]]\nkind = \"abbreviated\"\nx = \"q\"\n"
        );
        let loaded = lowered(&text);
        let seen = Arc::new(snapshot(&loaded, 9.0));
        let (mut app, _) = App::new(catalog(), Some("test"));
        app.update(AppEvent::Loaded(Ok(loaded)));
        app.update(AppEvent::Snapshot(seen));
        let screen = screen_text(&app, (160, 40));
        assert!(screen.contains(words), "{screen}");
        assert!(!screen.contains("foci"), "{screen}");
    }
}

/// Between the ends of the pendulum's swing of 4 s there are three true paths: rest, S = 4, and a swing to either side,
/// S = 8 (E(k) − k′² K(k)) − 4 (2k² − 1).
#[test]
fn every_true_path_between_the_ends_of_a_swing_is_shown() {
    let mut app = lab("least-action", 4.0);
    press(&mut app, "Wait");
    let paths = plot_named(&app, "paths");
    let of = |word: &str| measure(&app, paths, word);
    assert_eq!(of("count"), 3.0);
    assert!((of("least") - 3.344_291_248_362_989_3).abs() < 1e-10, "{}", of("least"));
    assert!((of("greatest") - 4.0).abs() < 1e-10, "{}", of("greatest"));
    let said = layers(&app, paths).into_iter().find_map(|layer| match layer {
        Layer::Legend(lines) => Some(lines),
        _ => None,
    });
    let said = said.expect("words");
    assert!(said.contains(&"S = 3.3443, least nearby, the motion".to_owned()), "{said:?}");
    assert!(said.contains(&"S = 4, Morse index 1".to_owned()), "{said:?}");
}
