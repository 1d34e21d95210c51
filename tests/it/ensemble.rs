//! Clouds and closed curves carried by the flow: areas and Poincaré's integral against closed forms, the rate at which
//! friction shrinks them, and the picture in the lab.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use phaselab::app::{App, AppEvent, Effect, Saved};
use phaselab::dynamics::{PhaseSpace, conformal_rate};
use phaselab::ensemble::{ClosedCurve, SystemFlow};
use phaselab::experiment::{Command, Experiment, Prepared};
use phaselab::instrument::{Layer, Picture, Plot, Seed, named};
use phaselab::integrate::{Settings, method_named};
use phaselab::job::Progress;
use phaselab::system::{ChannelKind, InitialOverride, State};

use crate::fixtures::{catalog, press};
use crate::laboratory::{first, layers, measured, open, prepared, see, typed};
use crate::screen::screen_text;

/// An oscillator of one degree of freedom with the potential V and friction γ p.
fn oscillator(potential: &str, friction: &str) -> Prepared {
    prepared(&format!(
        "title = \"one\"\n[coordinates]\nq = {{ initial = 1.0, velocity = 0.0 }}\n\
         [parameters]\nc = 0.25\n[lagrangian]\nL = \"1/2*q'^2 - ({potential})\"\n\
         dissipation = \"{friction}\"\n[run]\nuntil = 100.0\n"
    ))
}

fn flow(ready: &Prepared) -> SystemFlow {
    let method = method_named("taylor").unwrap();
    let parameters = ready.model.parameter_values();
    let system = phaselab::system::System::clone(&ready.system);
    SystemFlow {
        system,
        method: (method, Settings::default()),
        parameters,
        start: 0.0,
        effort: None,
    }
}

fn channel(ready: &Prepared, kind: ChannelKind) -> usize {
    ready.system.channels().iter().position(|channel| channel.kind == kind).unwrap()
}

/// A circle of this radius about (q, p) of the first coordinate; the others are those of the file.
fn circle(ready: &Prepared, centre: [f64; 2], radius: f64) -> impl Fn(f64) -> Option<State> + Sync {
    let (system, parameters) = (Arc::clone(&ready.system), ready.model.parameter_values());
    move |s: f64| {
        let (sin, cos) = (TAU * s).sin_cos();
        let q = InitialOverride::Position(0, centre[0] + radius * cos);
        let p = InitialOverride::Momentum(0, centre[1] + radius * sin);
        system.initial(0.0, &parameters, &[q, p]).ok()
    }
}

/// The channels of a curve: two quantities of a picture, all coordinates, all momenta.
fn channels(ready: &Prepared) -> Vec<usize> {
    let n = ready.system.degrees();
    let q = (0..n).map(|i| channel(ready, ChannelKind::Position(i)));
    let p: Vec<usize> = (0..n).map(|i| channel(ready, ChannelKind::Momentum(i))).collect();
    let q: Vec<usize> = q.collect();
    [vec![q[0], p[0]], q, p].concat()
}

fn carried(ready: &Prepared, centre: [f64; 2], radius: f64, times: &[f64]) -> ClosedCurve {
    let start = circle(ready, centre, radius);
    let mut curve = ClosedCurve::new(&start, channels(ready), [f64::INFINITY; 2]).unwrap();
    curve.carry(&flow(ready), times, &start).unwrap();
    curve
}

#[test]
fn a_harmonic_oscillator_turns_its_clouds_rigidly() {
    let ready = oscillator("1/2*q^2", "0");
    let times = [0.0, 0.9, TAU, 31.0];
    let curve = carried(&ready, [1.0, 0.0], 0.3, &times);
    for (k, t) in times.iter().enumerate() {
        let (sin, cos) = t.sin_cos();
        let points = curve.points(k);
        let count = points.len() - 1;
        for (i, [q, p]) in points.iter().enumerate() {
            let (along, up) = (TAU * i as f64 / count as f64).sin_cos();
            let (q0, p0) = (1.0 + 0.3 * up, 0.3 * along);
            assert!((q - (q0 * cos + p0 * sin)).abs() < 1e-12, "{t} {i}");
            assert!((p - (p0 * cos - q0 * sin)).abs() < 1e-12, "{t} {i}");
        }
        // counter-clockwise in (q, p) the integral is less than zero
        let found = curve.circulation(k).unwrap();
        assert!((found.value + PI * 0.09).abs() < 1e-11, "{found:?}");
        assert!(found.error < 1e-9 && curve.is_resolved());
    }
}

#[test]
fn a_pendulum_stretches_a_curve_and_keeps_its_area() {
    let ready = oscillator("-cos(q)", "0");
    // across the separatrix, p = 2 cos(q/2): a part swings, a part turns over
    let curve = carried(&ready, [2.0, 0.6], 0.5, &[0.0, 5.0, 12.0]);
    assert!(curve.len() > 4 * 128, "it takes more points: {}", curve.len());
    for k in 0..3 {
        let found = curve.circulation(k).unwrap();
        let off = (found.value + PI * 0.25).abs();
        assert!(off <= found.error + 1e-12 && found.error < 1e-6, "{k} {found:?} {off:e}");
    }
    // no part of the polygon is long beside the whole
    let points = curve.points(2);
    let all = || points.iter().map(|at| at[0]);
    let extent = all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min);
    assert!(points.windows(2).all(|pair| (pair[0][0] - pair[1][0]).abs() <= 0.05 * extent));
}

#[test]
fn starts_are_put_where_they_are_needed_most() {
    // carried in parts, as the lab does: neighbours at the saddle part like e^t, so that at t = 20 the starts there lie
    // 10⁻⁹ apart, and at t = 40 no two numbers are close enough
    let ready = oscillator("-cos(q)", "0");
    for centre in [[2.0, 0.6], [1.0, 1.5]] {
        let start = circle(&ready, centre, 0.5);
        let scales = [TAU, f64::INFINITY];
        let mut curve = ClosedCurve::new(&start, channels(&ready), scales).unwrap();
        for part in 1..=8 {
            curve.carry(&flow(&ready), &[5.0 * f64::from(part)], &start).unwrap();
            let found = curve.circulation(0);
            if part <= 4 {
                let found = found.unwrap();
                assert!(found.error < 1e-4, "{found:?}");
                assert!((found.value + PI * 0.25).abs() < found.error, "{found:?}");
            }
        }
        assert_eq!(curve.circulation(0), None);
    }
}

#[test]
fn friction_shrinks_areas_at_its_rate_and_at_no_other() {
    let ready = oscillator("-cos(q)", "1/2*c*q'^2");
    let times = [0.0, 2.0, 12.0];
    let curve = carried(&ready, [1.0, 0.5], 0.5, &times);
    for (k, t) in times.iter().enumerate() {
        let found = curve.circulation(k).unwrap().value;
        let law = |rate: f64| -PI * 0.25 * (-rate * t).exp();
        assert!((found / law(0.25) - 1.0).abs() < 1e-9, "{t} {found}");
        assert!(*t == 0.0 || (found / law(0.26) - 1.0).abs() > 1e-2, "{t} {found}");
    }
}

#[test]
fn poincares_integral_is_that_of_all_pairs() {
    let document = catalog().find("henon-heiles").unwrap();
    let ready = Prepared::of(&document).unwrap();
    let curve = carried(&ready, [0.1, 0.3], 0.1, &[0.0, 12.0]);
    let first = curve.circulation(0).unwrap();
    let last = curve.circulation(1).unwrap();
    assert!((first.value + PI * 0.01).abs() < 1e-13);
    assert!((last.value - first.value).abs() < 1e-12, "{last:?}");
    // what is seen of it in one plane is not conserved
    let shadow = |k: usize| -> f64 {
        let points = curve.points(k);
        points
            .windows(2)
            .map(|pair| 0.5 * (pair[0][1] + pair[1][1]) * (pair[1][0] - pair[0][0]))
            .sum()
    };
    assert!((shadow(1) / shadow(0) - 1.0).abs() > 0.05, "{} {}", shadow(0), shadow(1));
}

#[test]
fn where_a_start_is_lost_no_area_is_given() {
    // q̈ = q²: some of the starts are at infinity before the others
    let ready = oscillator("-q^3/3", "0");
    let curve = carried(&ready, [1.0, 1.0], 0.9, &[0.5, 3.0]);
    assert!(curve.circulation(0).is_some());
    assert_eq!(curve.circulation(1), None);
    assert!(curve.points(1).iter().any(|at| at[0].is_nan()));
}

#[test]
fn points_too_far_apart_are_not_joined() {
    // a driven double well is chaotic: after ten periods the circle is everywhere
    let ready = oscillator("q^4/4 - q^2/2 - 0.3*q*cos(t)", "0");
    let curve = carried(&ready, [0.0, 0.0], 0.5, &[60.0]);
    assert!(curve.circulation(0).is_none());
    let points = curve.points(0);
    let number = |at: &[f64; 2]| at[0].is_finite();
    let all: Vec<[f64; 2]> = points.iter().copied().filter(number).collect();
    assert_eq!(all.len(), curve.len() + 1, "all starts got there");
    assert!(points.len() > all.len(), "some are not joined");
    for k in 0..2 {
        let seen = || all.iter().map(|at| at[k]);
        let (lo, hi) = (seen().fold(0.0, f64::min), seen().fold(0.0, f64::max));
        let mut joined = points.windows(2).filter(|pair| pair.iter().all(number));
        assert!(joined.all(|pair| (pair[1][k] - pair[0][k]).abs() <= 0.05 * (hi - lo)));
    }
}

/// The rate in some states of a file.
fn rate(text: &str) -> Option<f64> {
    let ready = prepared(text);
    let parameters = ready.model.parameter_values();
    let space =
        PhaseSpace::of((&ready.model, &ready.equations, &ready.system), &parameters).unwrap();
    let n = space.dimension();
    let states: Vec<Vec<f64>> = (0..7)
        .map(|k| (0..n).map(|i| (0.3 + 0.7 * f64::from(k) + 0.4 * i as f64).sin()).collect())
        .collect();
    conformal_rate(&space, 0.0, states.iter().map(|state| &state[..])).unwrap()
}

#[test]
fn the_rate_is_one_number_or_none() {
    let two = |dissipation: &str| {
        format!(
            "title = \"two\"\n[coordinates]\nx = {{ initial = 1.0 }}\ny = {{ initial = 0.5 }}\n\
             [lagrangian]\nL = \"1/2*(x'^2 + 2*y'^2) - x^2*y - x^2 - y^2\"\n\
             dissipation = \"{dissipation}\"\n"
        )
    };
    assert_eq!(rate(&two("0")), Some(0.0));
    // 2 m takes twice the friction for the same rate
    let same = rate(&two("1/2*0.3*(x'^2 + 2*y'^2)")).unwrap();
    assert!((same + 0.3).abs() < 1e-14, "{same}");
    assert_eq!(rate(&two("1/2*0.3*(x'^2 + y'^2)")), None, "the pairs shrink at different rates");
    let one = |dissipation: &str| {
        format!(
            "title = \"one\"\n[coordinates]\nx = {{ initial = 1.0 }}\n[lagrangian]\n\
             L = \"1/2*3*x'^2 - x^4\"\ndissipation = \"{dissipation}\"\n"
        )
    };
    let one_pair = rate(&one("1/2*0.6*x'^2")).unwrap();
    assert!((one_pair + 0.2).abs() < 1e-14, "{one_pair}");
    assert_eq!(rate(&one("1/2*0.6*(x^2 - 1)*x'^2")), None, "it depends on the place");
    let driven = |friction: &str| {
        rate(&format!(
            "title = \"driven\"\n[coordinates]\nx = {{ initial = 1.0 }}\n[lagrangian]\n\
             L = \"1/2*3*x'^2 - x^4\"\nforces = {{ x = \"cos(2*t) - {friction}*x'\" }}\n"
        ))
    };
    let steady = driven("0.6").unwrap();
    assert!((steady + 0.2).abs() < 1e-14, "{steady}");
    assert_eq!(driven("0.6*(1 + 0.5*sin(2*t))"), None, "it depends on the time");
    assert_eq!(
        driven("0.6*(1 + 0.5*sin(10*t))"),
        None,
        "it depends on the time, five times as fast"
    );
    assert_eq!(driven("0.6*exp(-t)"), None, "it has no period");
}

/// The lab with a motion and the picture of its cloud, and the motion.
pub(crate) fn opened(ready: Prepared) -> (App, usize, Experiment) {
    let (mut app, mut experiment) = open(ready);
    let lab = app.lab.as_mut().unwrap();
    let kind = named("ensemble").unwrap();
    let offer = kind.offers(lab.loaded.physics()).remove(0);
    lab.plots = vec![Plot::new(kind, (offer.columns, None), &lab.loaded.model)];
    see(&mut app, &mut experiment, 0.01);
    (app, 0, experiment)
}

pub(crate) fn measure(app: &App, word: &str) -> Option<f64> {
    measured(app, first(app), word)
}

/// Since when the cloud is carried, where its picture says so.
fn since(app: &App) -> Option<String> {
    let lab = app.lab.as_ref().unwrap();
    let (plot, present) = (&lab.plots[0], lab.present().unwrap());
    let picture = plot.kind.picture(lab.context(plot, &present), [f64::NAN; 2]);
    let Some(Picture::Axes { layers, .. }) = picture else { panic!("no picture") };
    let lines = layers.into_iter().filter_map(|(_, layer)| match layer {
        Layer::Legend(lines) => Some(lines),
        _ => None,
    });
    lines.flatten().find(|line| line.starts_with("since"))
}

pub(crate) fn cloud(app: &App) -> Vec<[f64; 2]> {
    let found = layers(app, first(app)).into_iter().find_map(|layer| match layer {
        Layer::Cloud(points) => Some(points.to_vec()),
        _ => None,
    });
    found.unwrap_or_default()
}

#[test]
fn the_lab_carries_a_cloud_with_the_motion_and_begins_it_anew_where_it_must() {
    let (mut app, _, mut experiment) = opened(oscillator("1/2*q^2", "1/2*c*q'^2"));
    assert_eq!(measure(&app, "points"), Some(2000.0));
    assert!((measure(&app, "rate").unwrap() + 0.25).abs() < 1e-14);
    let begun = measure(&app, "action").unwrap();
    // a disc about the motion, as far in both directions as the same energy goes
    assert!((begun - PI * 0.09).abs() < 1e-4 * begun, "{begun}");
    see(&mut app, &mut experiment, 3.0);
    let off = measure(&app, "off").unwrap();
    assert!(off < 1e-9, "{off:e}");
    let ratio = measure(&app, "action").unwrap() / begun;
    assert!((ratio.ln() + 0.25 * 2.99).abs() < 0.02, "{ratio}");
    // the cloud is around the motion, which is its middle, as the law is linear
    let lab = app.lab.as_ref().unwrap();
    let own = lab.plots[0].column(0).map(|x| lab.present().unwrap().value(x)).unwrap();
    let points = cloud(&app);
    let middle = points.iter().map(|at| at[0]).sum::<f64>() / points.len() as f64;
    assert!((middle - own).abs() < 0.05, "{middle} {own}");
    assert_eq!(since(&app), None);
    // another parameter: a new cloud around where the motion is now
    experiment.execute(Command::Parameter { index: 0, value: 0.5 });
    see(&mut app, &mut experiment, 3.01);
    assert_eq!(since(&app).as_deref(), Some("since t = 3.01, as large as before"));
    let again = measure(&app, "action").unwrap();
    assert!((again - begun).abs() < 1e-3 * begun, "{again} {begun}");
    assert!((measure(&app, "rate").unwrap() + 0.5).abs() < 1e-14);
    assert!(measure(&app, "off").unwrap() < 1e-9);
    // the motion begins again, and so does the cloud
    experiment.execute(Command::Reset);
    see(&mut app, &mut experiment, 0.02);
    assert!((measure(&app, "action").unwrap() - PI * 0.09).abs() < 1e-2 * begun);
}

/// A cloud that is begun anew where the motion passes q = 0 has the size of one that is begun elsewhere: π (0.3)², by the amplitude.
#[test]
fn a_cloud_begun_anew_at_zero_keeps_its_size() {
    let (mut app, _, mut experiment) = opened(oscillator("1/2*q^2", "0*c*q'"));
    see(&mut app, &mut experiment, 4.712);
    experiment.execute(Command::Parameter { index: 0, value: 0.5 });
    see(&mut app, &mut experiment, 4.713);
    let action = measure(&app, "action").unwrap();
    assert!((action - PI * 0.09).abs() < 1e-2 * action, "{action}");
}

/// Another method carries a cloud on from where it is: a step of Runge and Kutta multiplies its area by 1 − h⁶/72 + h⁸/576, and
/// what is expected of it stays that of the beginning.
#[test]
fn another_method_carries_the_cloud_on() {
    let (mut app, _, mut experiment) = opened(oscillator("1/2*q^2", "0"));
    let begun = measure(&app, "action").unwrap();
    see(&mut app, &mut experiment, 3.0);
    let before = cloud(&app);
    let step: f64 = 0.5;
    let settings = Settings { step: Some(step), ..Settings::default() };
    experiment.execute(Command::Method("rk4".to_owned()));
    experiment.execute(Command::Settings(settings));
    see(&mut app, &mut experiment, 3.0);
    let far = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
    let moved = before.iter().zip(&cloud(&app)).map(far).fold(0.0, f64::max);
    assert!(moved < 1e-9, "{moved:e}");
    assert_eq!(since(&app), None);
    see(&mut app, &mut experiment, 5.0);
    let expected = measure(&app, "expected").unwrap();
    assert!((expected / begun - 1.0).abs() < 1e-9, "{expected} {begun}");
    let grown = (measure(&app, "action").unwrap() / begun).ln();
    // steps are cut short where a part of the cloud's course ends
    let law = (step.powi(8) / 576.0 - step.powi(6) / 72.0).ln_1p() / step;
    assert!((2.1 * law..0.6 * law).contains(&grown), "{grown} {law}");
    // the motion begins again by the new method, and so does the cloud
    experiment.execute(Command::Reset);
    see(&mut app, &mut experiment, 0.02);
    see(&mut app, &mut experiment, 1.02);
    let grown = (measure(&app, "action").unwrap() / measure(&app, "expected").unwrap()).ln();
    assert!((1.1 * law..0.3 * law).contains(&grown), "{grown} {law}");
}

/// Seen in its initial values a cloud stands still, point by point; seen in others it does not.
#[test]
fn in_the_initial_values_the_cloud_stands_still() {
    let back = "[[transformations]]\nname = \"back\"\nkind = \"explicit\"\n\
                Q = { Q0 = \"q*cos(2*t) - p_q*sin(2*t)/2\" }\nP = { P0 = \"p_q*cos(2*t) + 2*q*sin(2*t)\" }\n";
    let law = |potential: &str| {
        prepared(&format!(
            "title = \"one\"\n[coordinates]\nq = {{ initial = 1.0, momentum = 0.5 }}\n[hamiltonian]\n\
             H = \"1/2*p_q^2 + {potential}\"\n{back}[[views]]\nkind = \"phase\"\nx = \"Q0\"\ny = \"P0\"\n[run]\nuntil = 100.0\n"
        ))
    };
    let moved = |potential: &str| {
        let (mut app, _, mut experiment) = opened(law(potential));
        let lab = app.lab.as_mut().unwrap();
        let physics = lab.loaded.physics();
        let of = |name: &str| physics.named().find(|(_, c)| c.name == name).map(|(x, _)| vec![x]);
        let columns = vec![of("Q0").unwrap(), of("P0").unwrap()];
        lab.plots = vec![Plot::new(named("ensemble").unwrap(), (columns, None), &lab.loaded.model)];
        see(&mut app, &mut experiment, 0.02);
        let before = cloud(&app);
        assert_eq!(before.len(), 2000);
        let action = measure(&app, "action").unwrap();
        see(&mut app, &mut experiment, 7.0);
        // the area is that of the cloud itself, in whichever variables it is drawn
        assert!((measure(&app, "action").unwrap() - action).abs() < 1e-9 * action);
        let far = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
        before.iter().zip(&cloud(&app)).map(far).fold(0.0, f64::max)
    };
    let still = moved("2*q^2");
    assert!(still < 1e-11, "{still:e}");
    assert!(moved("2*q^2 + q^4/10") > 0.05);
}

#[test]
fn a_key_begins_the_cloud_over_what_is_seen_and_a_session_has_it() {
    let (mut app, _, _) = opened(oscillator("-cos(q)", "0"));
    press(&mut app, "Tab Tab Tab");
    typed(&mut app, "n");
    let plot = app.lab.as_ref().unwrap().plots[0].clone();
    let [Seed::Spread([[left, right], [below, above]])] = plot.seeds[..] else {
        panic!("{:?}", plot.seeds)
    };
    let area = (right - left) * (above - below);
    let action = measure(&app, "action").unwrap();
    assert!((action / area - 1.0).abs() < 1e-9, "a box has the area of a box: {action} {area}");
    // another takes its place
    typed(&mut app, "+ + + + n");
    assert_eq!(app.lab.as_ref().unwrap().plots[0].seeds.len(), 1);
    assert!(measure(&app, "action").unwrap() < 0.8 * area);
    let text = toml::to_string(&app.saved().unwrap()).unwrap();
    let read: Saved = toml::from_str(&text).unwrap();
    let physics = app.lab.as_ref().unwrap().loaded.physics();
    assert_eq!(read.plots[0].place(physics).as_ref(), app.lab.as_ref().unwrap().plots.first());
    press(&mut app, "N");
    assert_eq!(app.lab.as_ref().unwrap().plots[0].seeds, []);
}

/// Two oscillators, of which the energy shell is a sphere: the points of the cloud are all over it, and on it.
#[test]
fn once_more_it_is_spread_over_the_energy_shell() {
    let text = "title = 'shell'\n[coordinates]\nx = { initial = 1.0 }\ny = { initial = 0.5, momentum = 1.0 }\n\
                [hamiltonian]\nH = \"1/2*(p_x^2 + p_y^2 + x^2 + y^2)\"\n\
                [[views]]\nkind = \"ensemble\"\nx = \"x\"\ny = \"y\"\n";
    // x against y is no plane of a start: x against p_x is
    let (mut app, _, _) = opened(prepared(&text.replace("y = \"y\"", "y = \"p_x\"")));
    press(&mut app, "Tab Tab Tab");
    for (keys, seed) in [("n", "Spread"), ("n", "Shell"), ("n", "Spread")] {
        typed(&mut app, keys);
        let seeds = app.lab.as_ref().unwrap().plots[0].seeds.clone();
        assert!(seeds.len() == 1 && format!("{seeds:?}").contains(seed), "{seeds:?}");
        if seed != "Shell" {
            continue;
        }
        // E = ½ (1 + ¼ + 1): x² + p_x² is anything up to 2E, and no more
        let points = cloud(&app);
        assert!(points.len() > 1000, "{}", points.len());
        let squares: Vec<f64> = points.iter().map(|[x, p]| x * x + p * p).collect();
        assert!(squares.iter().all(|square| *square < 2.25 + 1e-9));
        for part in 0..5 {
            let part = 0.45 * f64::from(part)..0.45 * f64::from(part + 1);
            let count = squares.iter().filter(|square| part.contains(square)).count();
            assert!(count > 50, "{part:?}: {count}");
        }
        assert_eq!(measure(&app, "action"), None);
        let session = toml::to_string(&app.saved().unwrap()).unwrap();
        let read: Saved = toml::from_str(&session).unwrap();
        let physics = app.lab.as_ref().unwrap().loaded.physics();
        assert_eq!(read.plots[0].place(physics).unwrap().seeds, seeds);
    }
    // where the energy is not constant there is no shell
    let (mut app, _, _) = opened(oscillator("-cos(q)", "0.1*q'^2"));
    press(&mut app, "Tab Tab Tab");
    for _ in 0..2 {
        typed(&mut app, "n");
        let seeds = &app.lab.as_ref().unwrap().plots[0].seeds;
        assert!(matches!(seeds[..], [Seed::Spread(_)]), "{seeds:?}");
    }
}

/// What is said of a cloud has lines of its own, and is not cut where the pane is narrow.
#[test]
fn a_narrow_pane_has_all_that_is_said_of_a_cloud() {
    let (mut app, _, mut experiment) = opened(oscillator("1/2*q^2", "1/2*c*q'^2"));
    see(&mut app, &mut experiment, 1.0);
    let screen = screen_text(&app, (80, 24));
    let words: String =
        screen.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
    let (_, said) = words.split_once("action 0.2").expect("the action");
    assert!(said.contains("∝ e^(−0.25 t)"), "{screen}");
    assert!(said.contains(" to "), "{screen}");
}

/// Two pictures of the same cloud show the same moment, also where one of them is computed later than the other.
#[test]
fn two_pictures_of_a_cloud_show_the_same_moment() {
    let (mut app, _, mut experiment) = opened(oscillator("1/2*q^2", "0"));
    let lab = app.lab.as_mut().unwrap();
    let mut other = lab.plots[0].clone();
    other.columns.reverse();
    lab.plots.push(other);
    see(&mut app, &mut experiment, 0.011);
    let seen = |app: &App| {
        let lab = app.lab.as_ref().unwrap();
        let present = lab.present().unwrap();
        let of = |plot: &Plot| {
            let picture = plot.kind.picture(lab.context(plot, &present), [f64::NAN; 2]);
            let Some(Picture::Axes { layers, .. }) = picture else { panic!("no picture") };
            layers.iter().find_map(|(_, layer)| match layer {
                Layer::Cloud(points) => Some(points.to_vec()),
                _ => None,
            })
        };
        lab.plots.iter().map(|plot| of(plot).expect("a cloud")).collect::<Vec<_>>()
    };
    // from here on the second is never finished
    let mut waiting = Vec::new();
    for k in 1..60 {
        experiment.advance(0.011 + 0.05 * f64::from(k), u64::MAX);
        let mut effects = app.update(AppEvent::Snapshot(Arc::new(experiment.snapshot())));
        while let Some(effect) = effects.pop() {
            let Effect::Compute(computation) = effect else { continue };
            if computation.asker == phaselab::app::Asker::Plot(1) {
                waiting.push(computation);
                continue;
            }
            let outcome = computation.job.run(&Progress::new());
            effects.extend(app.update(AppEvent::Computed { ticket: computation.ticket, outcome }));
        }
        let [first, second] = &seen(&app)[..] else { panic!("two") };
        // the law is linear, so the middle of a disc about the motion is the motion
        let [first, second] = [first, second].map(|points| {
            let sum = points.iter().fold([0.0; 2], |sum, at| [sum[0] + at[0], sum[1] + at[1]]);
            sum.map(|x| x / points.len() as f64)
        });
        let off = (first[0] - second[1]).abs().max((first[1] - second[0]).abs());
        assert!(off < 5e-3, "at step {k}: {first:?} {second:?}");
    }
    assert!(!waiting.is_empty());
}
