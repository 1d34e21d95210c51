//! Sections in the lab: the crossings of the running motion, the orbits beside it, what is forbidden, keys, sessions.

use std::sync::Arc;
use std::time::Duration;

use phaselab::app::{App, AppEvent, Drawn, Effect, Saved};
use phaselab::cancel::Cancel;
use phaselab::ensemble::{NotInPlane, NotOnShell, Region, SectionPlane};
use phaselab::experiment::{Command, Experiment, Prepared, Snapshot};
use phaselab::instrument::{Entry, Ink, Layer, Plot, PlotContext, Seed};
use phaselab::system::{ChannelKind, InitialOverride};
use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::theme::Theme;

use crate::fixtures::{catalog, lab, press};
use crate::laboratory::{layers, measure, open, prepared, see, typed};
use crate::screen::{rich, rows, screen};

/// Two oscillators that know nothing of each other: x = sin t, y = cos √2 t, with p_y² + 2 y² constant.
const OSCILLATORS: &str = r#"
title = "two oscillators"
[coordinates]
x = { initial = 0.0, momentum = 1.0 }
y = { initial = 1.0, momentum = 0.0 }
[parameters]
k = 1.0
[hamiltonian]
H = "1/2*(p_x^2 + p_y^2) + 1/2*k*x^2 + y^2"
[[views]]
kind = "section"
on = "x"
x = "y"
y = "p_y"
[run]
until = 100.0
"#;

pub(crate) fn shipped(name: &str) -> Prepared {
    Prepared::of(&catalog().find(name).unwrap()).unwrap_or_else(|error| panic!("{error}"))
}

fn column(prepared: &Prepared, kind: ChannelKind) -> usize {
    prepared.system.channels().iter().position(|channel| channel.kind == kind).unwrap()
}

#[test]
fn the_crossings_of_the_motion_lie_where_a_closed_form_has_them() {
    let mut ready = prepared(OSCILLATORS);
    ready.experiment.advance(100.0, u64::MAX);
    let channels = ready.system.channels().len();
    let log = ready.experiment.crossings();
    let rows: Vec<&[f64]> = log.rows(0, channels).collect();
    // the start lies on the surface and is no crossing
    assert_eq!((rows.len(), log.counts()), (15, &[15][..]));
    let [x, y] = [0, 1].map(|i| column(&ready, ChannelKind::Position(i)));
    for (k, row) in (1..).zip(rows) {
        let time = std::f64::consts::TAU * f64::from(k);
        assert!((row[0] - time).abs() < 1e-12, "{} {time}", row[0]);
        assert!(row[1 + x].abs() < 1e-12);
        assert!((row[1 + y] - (2f64.sqrt() * time).cos()).abs() < 1e-11);
    }
    // a crossing is nothing that happens to the motion
    assert!(ready.experiment.occurrences().is_empty());
    assert!(ready.experiment.snapshot().notices.is_empty());
}

#[test]
fn a_section_changes_no_bit_of_the_motion() {
    let without = OSCILLATORS.replace("kind = \"section\"\non = \"x\"", "kind = \"phase\"");
    let (mut with, mut without) = (prepared(OSCILLATORS), prepared(&without));
    for time in [0.7, 31.0, 99.5] {
        for ready in [&mut with, &mut without] {
            ready.experiment.advance(time, u64::MAX);
        }
        let [a, b] = [&with, &without].map(|ready| ready.experiment.snapshot().state);
        assert_eq!(a, b);
    }
}

#[test]
fn a_stroboscope_of_the_kicked_rotor_is_the_standard_map() {
    let mut ready = shipped("kicked-rotor");
    ready.experiment.advance(60.2, u64::MAX);
    let [theta, p] = [ChannelKind::Position(0), ChannelKind::Momentum(0)];
    let [theta, p] = [theta, p].map(|kind| column(&ready, kind));
    let channels = ready.system.channels().len();
    let rows: Vec<&[f64]> = ready.experiment.crossings().rows(0, channels).collect();
    assert_eq!(rows.len(), 60);
    // Chirikov's map by hand, seen half an interval after each kick
    let (mut angle, mut momentum) = (0.5_f64, 2.6_f64);
    for row in rows {
        let seen = angle + 0.5 * momentum;
        assert!((row[1 + theta] - seen).abs() < 1e-10, "{} {seen}", row[1 + theta]);
        assert!((row[1 + p] - momentum).abs() < 1e-10);
        angle += momentum;
        momentum += 0.971635406 * angle.sin();
    }
}

#[test]
fn what_crossed_is_forgotten_when_the_motion_or_the_system_becomes_another() {
    let mut ready = prepared(OSCILLATORS);
    let orders =
        [Command::Parameter { index: 0, value: 1.5 }, Command::Reset, Command::ForgetCrossings];
    for order in orders {
        let until = ready.experiment.time() + 20.0;
        ready.experiment.advance(until, u64::MAX);
        assert!(ready.experiment.crossings().counts()[0] >= 3);
        ready.experiment.execute(order.clone());
        assert_eq!(ready.experiment.crossings().counts(), [0], "{order:?}");
    }
}

/// The section x = 0 of Hénon and Heiles at an energy.
fn plane(ready: &Prepared, energy: f64) -> SectionPlane {
    let axes = [ChannelKind::Position(1), ChannelKind::Momentum(1)];
    let axes = axes.map(|kind| column(ready, kind));
    let parameters = ready.model.parameter_values();
    let at = (0.0, &parameters[..], energy);
    SectionPlane::new((&ready.model, &ready.system), 0, axes, at).unwrap()
}

/// The initial values of a motion through a point.
fn beginning(
    plane: &SectionPlane,
    ready: &Prepared,
    at: [f64; 2],
) -> Result<Vec<InitialOverride>, NotInPlane> {
    let mut observer = ready.system.observer(plane.parameters());
    Ok(plane.through(&ready.system, &mut observer, (at, None))?.overrides)
}

#[test]
fn the_boundary_of_the_region_is_the_curve_of_no_velocity() {
    let ready = shipped("henon-heiles");
    let energy = 0.125;
    let plane = plane(&ready, energy);
    // from any part of the region the same window is found, without the open valley beyond the saddle at y = 1
    for around in
        [[[-0.25, -0.25], [0.0, 0.0]], [[-0.3, 0.6], [-0.4, 0.4]], [[0.4, 0.5], [0.1, 0.1]]]
    {
        let region = Region::of(&plane, &ready.system, [None; 2], around, &Cancel::new());
        assert!(region.boundary.len() > 100);
        let [[left, right], [below, above]] = region.window;
        // ½ p_y² = E at y = 0; y² (½ − y/3) = E at p_y = 0
        let far = |y: f64| y * y / 2.0 - y * y * y / 3.0 - energy;
        assert!(far(left) > 0.0 && left > -0.55 && far(right) > 0.0 && right < 1.0, "{region:?}");
        assert!(above > 0.5 && above < 0.6 && below < -0.5 && below > -0.6);
        for [y, p] in region.boundary.iter().flatten().copied().filter(|[y, _]| *y < 0.95) {
            let excess = p * p / 2.0 + far(y);
            assert!(excess.abs() < 1e-5, "{y} {p} {excess}");
        }
        assert!(region.contains([0.0, 0.0]) && !region.contains([0.0, above]));
    }
}

#[test]
fn a_point_is_completed_to_the_energy_and_a_forbidden_one_refused() {
    let ready = shipped("henon-heiles");
    let plane = plane(&ready, 0.125);
    let given = beginning(&plane, &ready, [0.1, -0.2]).unwrap();
    let px = (2.0_f64 * (0.125 - 0.5 * 0.04 - 0.5 * 0.01 + 0.001 / 3.0)).sqrt();
    assert!(given.contains(&InitialOverride::Position(0, 0.0)));
    assert!(given.contains(&InitialOverride::Position(1, 0.1)));
    assert!(given.contains(&InitialOverride::Momentum(1, -0.2)));
    let found = given.iter().find_map(|given| match given {
        InitialOverride::Momentum(0, p) => Some(*p),
        _ => None,
    });
    // rising through x = 0: the positive root
    assert!((found.unwrap() - px).abs() < 1e-15);
    let refused = beginning(&plane, &ready, [0.1, 0.6]);
    let Err(NotInPlane::Shell(NotOnShell::Forbidden { bound, .. })) = refused else {
        panic!("{refused:?}")
    };
    assert!((bound - (0.18 + 0.005 - 0.001 / 3.0)).abs() < 1e-14);
}

#[test]
fn planes_without_starts_are_none() {
    let ready = shipped("henon-heiles");
    let [y, px, energy] = [ChannelKind::Position(1), ChannelKind::Momentum(0), ChannelKind::Energy]
        .map(|kind| column(&ready, kind));
    let x = column(&ready, ChannelKind::Position(0));
    let parameters = ready.model.parameter_values();
    for axes in [[y, y], [y, energy], [x, y], [x, px]] {
        let at = (0.0, &parameters[..], 0.125);
        let plane = SectionPlane::new((&ready.model, &ready.system), 0, axes, at);
        assert_eq!(plane, None, "{axes:?}");
    }
}

/// The application with a system in the lab and a snapshot of its real motion, and the section.
pub(crate) fn opened(ready: Prepared, time: f64) -> (App, usize) {
    let (mut app, mut experiment) = open(ready);
    see(&mut app, &mut experiment, time);
    let plots = &app.lab.as_ref().unwrap().plots;
    let index = plots.iter().position(|plot| plot.kind.properties().is_section).unwrap();
    (app, index)
}

#[test]
fn each_orbit_of_an_integrable_system_lies_on_its_curve() {
    let (app, index) = opened(prepared(OSCILLATORS), 30.0);
    let plot = &app.lab.as_ref().unwrap().plots[index];
    assert_eq!(index, 0, "a section that a file names opens the lab");
    assert_eq!(measure(&app, plot, "points"), 4.0);
    assert_eq!(measure(&app, plot, "orbits"), 16.0);
    // each start is a point of its own, and has 120 crossings
    assert_eq!(measure(&app, plot, "crossings"), 16.0 * 121.0);
    let mut curves = Vec::new();
    for layer in layers(&app, plot) {
        let Layer::Points(points, _) = layer else { continue };
        let action = |[y, p]: [f64; 2]| p * p + 2.0 * y * y;
        let first = action(points[0]);
        assert!(points.iter().all(|point| (action(*point) - first).abs() < 1e-11 * first));
        // E = ½ (1 + 2): nothing lies beyond
        assert!(first <= 3.0 + 1e-12);
        curves.push(first);
    }
    curves.sort_by(f64::total_cmp);
    assert_eq!(curves.len(), 16);
    assert!(curves.windows(2).all(|pair| pair[1] - pair[0] > 1e-6), "different orbits: {curves:?}");
    assert!(curves[0] < 0.6 && curves[15] > 2.4, "over all of the region: {curves:?}");
}

/// The number that stands in the title of a section, and its word.
fn counted(app: &App, index: usize) -> (f64, String) {
    let lab = app.lab.as_ref().unwrap();
    let (plot, present) = (&lab.plots[index], lab.present().unwrap());
    let Some(Entry::Words(words)) = plot.kind.counted(lab.context(plot, &present)) else {
        panic!("a number of crossings");
    };
    let (number, word) = words.split_once(' ').expect("a number and a word");
    (number.parse().expect("a number"), word.to_owned())
}

/// All points of the picture are counted, of the running motion and of the orbits beside it, in what their surface is: a surface
/// in the space of the states is crossed, an instant comes back once in a period, or with each kick.
#[test]
fn the_title_of_a_section_counts_the_points_that_are_drawn() {
    for (name, word) in
        [("henon-heiles", "crossings"), ("duffing", "periods"), ("kicked-rotor", "kicks")]
    {
        let (app, index) = opened(shipped(name), 30.0);
        let plot = &app.lab.as_ref().unwrap().plots[index];
        let [own, others] = ["points", "crossings"].map(|word| measure(&app, plot, word));
        assert!(own > 0.0 && others > 100.0, "{name}: {own} and {others}");
        assert_eq!(counted(&app, index), (own + others, word.to_owned()), "{name}");
    }
}

/// Two oscillators whose frequencies are as 1 to √2: from one crossing to the next the other turns by √2, or √2 − 1.
#[test]
fn the_running_motion_has_its_rotation_number_in_the_title() {
    let words = |app: &App, index: usize| {
        let lab = app.lab.as_ref().unwrap();
        let plot = &lab.plots[index];
        let heading = plot.kind.heading(plot, &lab.present().unwrap()).unwrap();
        let entries = heading.entries.into_iter().map(|entry| match entry {
            Entry::Words(words) => words,
            Entry::Key(Ink::Warn, words) => format!("amber: {words}"),
            other => panic!("{other:?}"),
        });
        entries.collect::<Vec<_>>()
    };
    let counted = |app: &App, index: usize| counted(app, index).1;
    let (app, index) = opened(prepared(OSCILLATORS), 700.0);
    let number = measure(&app, &app.lab.as_ref().unwrap().plots[index], "own_rotation");
    assert!((number - (2.0_f64.sqrt() - 1.0)).abs() < 1e-6, "{number}");
    let said = words(&app, index);
    assert!(said[0].starts_with("rotation 0.41421"), "{said:?}");
    assert_eq!(counted(&app, index), "crossings");
    // too few crossings have none, and what the title of the view says is not said again
    let (app, index) = opened(shipped("henon-heiles"), 30.0);
    assert_eq!(
        words(&app, index),
        ["rising", "regular orbits in several colours", "amber: chaotic"]
    );
    let lab = app.lab.as_ref().unwrap();
    let own = lab.plots[index].kind.measure("own_rotation").unwrap();
    let present = lab.present().unwrap();
    let context = PlotContext { plot: &lab.plots[index], present: &present, answer: None };
    assert_eq!((own.value)(context), None);
}

/// `H` colours orbits by whether their average turn converges: all of two oscillators', not all of Hénon and Heiles's.
#[test]
fn a_key_colours_orbits_by_whether_they_are_regular() {
    let inks = |app: &App, index: usize| {
        let plot = app.lab.as_ref().unwrap().plots[index].clone();
        let inks = layers(app, &plot).into_iter().filter_map(|layer| match layer {
            Layer::Points(_, ink) => Some(ink),
            _ => None,
        });
        inks.collect::<Vec<Ink>>()
    };
    for (mut app, chaos) in [
        (Box::new(opened(prepared(OSCILLATORS), 30.0).0), false),
        (Box::new(opened(shipped("henon-heiles"), 30.0).0), true),
    ] {
        typed(&mut app, "Tab Tab Tab");
        let plain = inks(&app, 0);
        let plot = app.lab.as_ref().unwrap().plots[0].clone();
        // each regular orbit has a colour of its own, and chaotic ones are amber without a key, too
        let amber = plain.iter().filter(|ink| **ink == Ink::Warn).count() as f64;
        assert_eq!(amber, measure(&app, &plot, "chaotic"));
        let others = plain.iter().filter(|ink| **ink != Ink::Warn);
        assert!(others.clone().all(|ink| matches!(ink, Ink::Curve(2..))), "{plain:?}");
        assert!(others.clone().any(|ink| Some(ink) != others.clone().next()), "{plain:?}");
        typed(&mut app, "H");
        let inked = inks(&app, 0);
        let of = |wanted: Ink| inked.iter().filter(|ink| **ink == wanted).count() as f64;
        assert_eq!(of(Ink::Warn), measure(&app, &plot, "chaotic"));
        assert_eq!(of(Ink::Curve(0)), measure(&app, &plot, "regular"));
        assert_eq!((of(Ink::Warn) > 4.0, of(Ink::Curve(0)) > 2.0), (chaos, true), "{inked:?}");
        // without colour chaotic orbits are crosses, and so is their key
        let theme = Theme::dark(ColourDepth::None);
        let text = rows(&screen(&app, &RenderStyle { theme, ..rich() }, (120, 40))).concat();
        assert!(
            text.contains("× chaotic")
                && text.contains("● regular")
                && text.contains("· undecided"),
            "{text}"
        );
        assert_eq!(text.matches('×').count() > 20, chaos, "{text}");
        // where the title has no room for the keys, they stand above the picture, and none is cut
        for size in [(100, 30), (90, 26), (80, 24), (60, 20), (44, 16)] {
            let text = rows(&screen(&app, &rich(), size)).join("\n");
            for key in ["● regular", "● chaotic", "● undecided"] {
                assert!(text.contains(key), "{size:?} {key}\n{text}");
            }
        }
        typed(&mut app, "H");
        assert_eq!(inks(&app, 0), plain);
    }
    // elsewhere it says what it is for
    let (mut app, _) = opened(shipped("henon-heiles"), 1.0);
    typed(&mut app, "Tab Tab Tab Tab Tab H");
    assert!(app.notifications.shown.take().is_some_and(|notice| notice.text.contains("section")));
}

#[test]
fn keys_add_orbits_and_clear_them_and_sessions_have_them() {
    let (mut app, index) = opened(prepared(OSCILLATORS), 30.0);
    let plot = |app: &App| app.lab.as_ref().unwrap().plots[index].clone();
    typed(&mut app, "Tab Tab Tab n");
    let added = plot(&app);
    let [Seed::Spread(window)] = added.seeds[..] else { panic!("{:?}", added.seeds) };
    // the region ends at y² = 3/2, within a margin of the window
    let end = window[0][1] / 1.5f64.sqrt();
    assert!((1.0..1.15).contains(&end), "{window:?}");
    assert_eq!(measure(&app, &added, "orbits"), 32.0);
    // zoomed in, orbits begin in what is seen
    typed(&mut app, "+ + + + n");
    let [_, Seed::Spread(part)] = plot(&app).seeds[..] else { panic!("{:?}", plot(&app).seeds) };
    assert!((part[0][1] - part[0][0]) < 0.45 * (window[0][1] - window[0][0]));
    assert_eq!(measure(&app, &plot(&app), "orbits"), 48.0);
    // with a cursor, the orbit through it
    typed(&mut app, "c");
    app.update(AppEvent::Drawn(Drawn { reading: Some([0.5, 0.25]), ..Drawn::default() }));
    typed(&mut app, "n");
    assert_eq!(plot(&app).seeds[2..], [Seed::Through([0.5, 0.25])]);
    assert_eq!(measure(&app, &plot(&app), "orbits"), 49.0);
    let last = layers(&app, &plot(&app)).into_iter().rev().find_map(|layer| match layer {
        Layer::Points(points, _) => Some(points),
        _ => None,
    });
    assert_eq!(last.unwrap()[0], [0.5, 0.25]);
    // a session has them, and a foreign one does no harm
    let text = toml::to_string(&app.saved().unwrap()).unwrap();
    let read: Saved = toml::from_str(&text).unwrap();
    let physics = app.lab.as_ref().unwrap().loaded.physics();
    assert_eq!(read.plots[index].place(physics), Some(plot(&app)));
    let mut strange = read.plots[index].clone();
    strange.seeds = vec![Seed::Through([f64::NAN, 0.0]); 100];
    assert_eq!(strange.place(physics).unwrap().seeds, []);
    strange.view = Some(99);
    assert_eq!(strange.place(physics), None);
    // one key removes all, another brings it back
    assert_eq!(typed(&mut app, "N"), [Effect::Execute(Command::ForgetCrossings)]);
    assert_eq!((plot(&app).seeds, measure(&app, &plot(&app), "orbits")), (Vec::new(), 16.0));
    typed(&mut app, "u");
    assert_eq!(plot(&app).seeds.len(), 3);
}

#[test]
fn one_key_fills_a_section() {
    let (mut app, index) = opened(prepared(OSCILLATORS), 30.0);
    let plot = |app: &App| app.lab.as_ref().unwrap().plots[index].clone();
    typed(&mut app, "Tab Tab Tab");
    let [orbits, crossings] = ["orbits", "crossings"].map(|word| measure(&app, &plot(&app), word));
    typed(&mut app, "G");
    let filled = plot(&app);
    let [Seed::Fill(_)] = filled.seeds[..] else { panic!("{:?}", filled.seeds) };
    assert_eq!(measure(&app, &filled, "orbits"), orbits + 100.0);
    // a start is on the section too
    assert_eq!(measure(&app, &filled, "crossings"), crossings + 100.0 * 101.0);
    // each is on the ellipse p²/2 + y² = e of an oscillator of its own, within the energy 3/2
    for layer in layers(&app, &filled) {
        let Layer::Points(points, _) = layer else { continue };
        let size = |at: &[f64; 2]| at[0] * at[0] + at[1] * at[1] / 2.0;
        assert!(points.iter().all(|at| (size(at) - size(&points[0])).abs() < 1e-9), "{points:?}");
        assert!(size(&points[0]) < 1.5);
    }
    // again, it has other orbits, and a session has both
    typed(&mut app, "G");
    assert_eq!(measure(&app, &plot(&app), "orbits"), orbits + 200.0);
    let read: Saved = toml::from_str(&toml::to_string(&app.saved().unwrap()).unwrap()).unwrap();
    let physics = app.lab.as_ref().unwrap().loaded.physics();
    assert_eq!(read.plots[index].place(physics), Some(plot(&app)));
    typed(&mut app, "N");
    assert_eq!(measure(&app, &plot(&app), "orbits"), orbits);
    // elsewhere it says what it is for
    let (mut app, _) = opened(shipped("henon-heiles"), 1.0);
    typed(&mut app, "Tab Tab Tab Tab Tab G");
    assert!(app.notifications.shown.take().is_some_and(|notice| notice.text.contains("section")));
}

#[test]
fn enter_begins_at_the_cursor_or_says_why_not() {
    let (mut app, _) = opened(shipped("henon-heiles"), 0.01);
    let at = |app: &mut App, point: [f64; 2]| {
        app.update(AppEvent::Drawn(Drawn { reading: Some(point), ..Drawn::default() }));
        press(app, "Enter")
    };
    press(&mut app, "Tab Tab Tab");
    press(&mut app, "Enter");
    assert!(app.overlay.take().is_some(), "without a cursor Enter chooses the axes");
    press(&mut app, "c");
    let effects = at(&mut app, [0.1, 0.0]);
    let [Effect::Execute(Command::Start(given))] = &effects[..] else { panic!("{effects:?}") };
    assert!(given.contains(&InitialOverride::Position(1, 0.1)) && given.len() == 4);
    assert_eq!(at(&mut app, [0.1, 0.7]), []);
    let message = app.notifications.shown.take().expect("a reason").text;
    assert!(message.contains("outside the region that the energy"), "{message}");
}

#[test]
fn the_picture_is_computed_anew_only_where_it_would_be_another() {
    let (mut app, index) = opened(prepared(OSCILLATORS), 10.0);
    let answer = |app: &App| {
        let lab = app.lab.as_ref().unwrap();
        lab.answer(&lab.plots[index]).cloned()
    };
    let first = answer(&app);
    let mut ready = prepared(OSCILLATORS);
    ready.experiment.set_epoch(1);
    ready.experiment.advance(20.0, u64::MAX);
    let asked = |app: &mut App, seen: Snapshot| {
        let effects = app.update(AppEvent::Snapshot(Arc::new(seen)));
        let jobs = effects.iter().filter_map(|effect| match effect {
            Effect::Compute(computation) => Some(computation.job.name.clone()),
            _ => None,
        });
        jobs.collect::<Vec<_>>()
    };
    assert_eq!(asked(&mut app, ready.experiment.snapshot()), [""; 0]);
    assert!(answer(&app) == first);
    ready.experiment.execute(Command::Initial { index: 3, value: 0.3 });
    assert_eq!(asked(&mut app, ready.experiment.snapshot()), ["orbits"], "another energy");
}

/// A recording has no background: its section fills where the values rest, and a sweep, which moves them in each frame, keeps what
/// there is.
#[test]
fn without_a_background_orbits_are_computed_where_the_values_rest() {
    let (mut app, mut experiment) = open(prepared(OSCILLATORS));
    app.jobs.in_background = false;
    let frame = |app: &mut App, experiment: &Experiment| {
        app.update(AppEvent::Snapshot(Arc::new(experiment.snapshot())));
        app.update(AppEvent::Tick(Duration::from_millis(33)));
        let lab = app.lab.as_ref().unwrap();
        lab.answer(&lab.plots[0]).cloned()
    };
    experiment.advance(1.0, u64::MAX);
    assert_eq!(frame(&mut app, &experiment), None);
    let first = (0..4).filter_map(|_| frame(&mut app, &experiment)).last();
    assert!(first.is_some());
    for step in 1..10 {
        let value = 1.0 + 0.05 * f64::from(step);
        experiment.execute(Command::Parameter { index: 0, value });
        assert!(frame(&mut app, &experiment) == first, "{value}");
    }
    let last = (0..4).filter_map(|_| frame(&mut app, &experiment)).last();
    assert!(last.is_some() && last != first);
    assert!((0..4).all(|_| frame(&mut app, &experiment) == last));
    let lab = app.lab.as_ref().unwrap();
    assert_eq!(measure(&app, &lab.plots[0], "orbits"), 16.0);
}

#[test]
fn without_a_background_further_orbits_are_computed_once_they_are_asked_for() {
    let (mut app, index) = opened(prepared(OSCILLATORS), 10.0);
    app.jobs.in_background = false;
    let mut ready = prepared(OSCILLATORS);
    ready.experiment.set_epoch(1);
    ready.experiment.execute(Command::Initial { index: 3, value: 0.3 });
    ready.experiment.advance(10.0, u64::MAX);
    app.update(AppEvent::Snapshot(Arc::new(ready.experiment.snapshot())));
    let plot = |app: &App| app.lab.as_ref().unwrap().plots[index].clone();
    press(&mut app, "Tab Tab Tab n");
    assert_eq!(measure(&app, &plot(&app), "orbits"), 32.0);
    let highest = layers(&app, &plot(&app)).into_iter().filter_map(|layer| match layer {
        Layer::Points(points, _) => Some(points[0]),
        _ => None,
    });
    let highest = highest.map(|[y, p]| p * p + 2.0 * y * y).fold(0.0, f64::max);
    // E = ½ (1 + 0.09) + 1 of the new motion
    assert!(highest < 3.09 && highest > 2.6, "{highest}");
}

/// Below zero, where no weight can be, r has no bound: the picture is that of 0 < r < E/((M − m) g) = 3/2, where
/// |p_r| is at most √(2 (M + m) E) = 15.3.
#[test]
fn the_section_of_the_swinging_weight_shows_all_that_the_energy_allows() {
    let (app, index) = opened(shipped("swinging-atwood"), 0.5);
    let plot = app.lab.as_ref().unwrap().plots[index].clone();
    let points = layers(&app, &plot).into_iter().filter_map(|layer| match layer {
        Layer::Points(points, _) => Some(points),
        _ => None,
    });
    let points: Vec<[f64; 2]> = points.flat_map(|points| points.to_vec()).collect();
    assert!(points.len() > 500, "{}", points.len());
    let (energy, slope) = (29.43, 2.0 * 9.81);
    for [r, p] in &points {
        assert!(*r > 0.0 && p * p / 8.0 + slope * r <= energy * (1.0 + 1e-9), "{r} {p}");
    }
    let reaches = |test: fn(&[f64; 2]) -> bool| points.iter().any(test);
    assert!(reaches(|[r, _]| *r < 0.15) && reaches(|[r, _]| *r > 1.2));
    assert!(reaches(|[_, p]| *p < -8.0) && reaches(|[_, p]| *p > 8.0));
}

#[test]
fn sections_open_the_systems_that_are_known_by_them() {
    let names = [
        "henon-heiles",
        "duffing",
        "kicked-rotor",
        "swinging-atwood",
        "double-pendulum",
        "driven-damped-pendulum",
        "restricted-three-body",
    ];
    for name in names {
        let ready = shipped(name);
        let loaded = Plot::opening(phaselab::instrument::Physics {
            model: &ready.model,
            equations: &ready.equations,
            system: &ready.system,
        });
        assert!(loaded[0].kind.properties().is_section, "{name}");
    }
    let app = lab("pendulum", 1.0);
    assert!(app.lab.unwrap().plots.iter().all(|plot| !plot.kind.properties().is_section));
}
