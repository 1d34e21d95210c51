//! The mouse: the target at a position is what is drawn there, and mouse events act on it.

use std::sync::Arc;

use crossterm::event::MouseButton::Left;
use crossterm::event::MouseEventKind;
use crossterm::event::MouseEventKind::{Down, Drag, ScrollDown, ScrollUp, Up};
use phaselab::app::{App, AppEvent, Grab, HitTarget, Overlay, Page, Pane, ValueId};
use phaselab::experiment::{Command, Status};
use phaselab::instrument::{Plot, Sight};
use phaselab::model::Shape;
use phaselab::num::math;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::{hit_targets, hit_test};
use ratatui::layout::Rect;

use super::{drawn, find, rich, rows, screen};
use crate::app::real::Real;
use crate::fixtures::{at_picker, catalog, gauge, in_lab, lowered, pendulum, press, snapshot};

const SIZES: [(u16, u16); 5] = [(40, 18), (66, 16), (80, 24), (120, 40), (200, 60)];

fn at(app: &App, size: (u16, u16), place: (u16, u16)) -> Option<HitTarget> {
    hit_test(app, &rich(), Rect::new(0, 0, size.0, size.1), place.0, place.1)
}

/// Every position with its target.
fn all(app: &App, (width, height): (u16, u16)) -> Vec<((u16, u16), HitTarget)> {
    let targets = hit_targets(app, &rich(), Rect::new(0, 0, width, height));
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    places.filter_map(|place| Some((place, targets.at(place.0, place.1)?))).collect()
}

/// The positions of a target.
fn places(app: &App, size: (u16, u16), is: impl Fn(&HitTarget) -> bool) -> Vec<(u16, u16)> {
    all(app, size).into_iter().filter(|(_, target)| is(target)).map(|(place, _)| place).collect()
}

fn act(real: &mut Real, size: (u16, u16), act: MouseEventKind, place: (u16, u16)) {
    let Some(target) = at(&real.app, size, place) else { return };
    let effects = real.app.update(AppEvent::Mouse(act, target));
    real.execute(effects);
    real.look();
}

fn click(real: &mut Real, size: (u16, u16), place: (u16, u16)) {
    act(real, size, Down(Left), place);
    act(real, size, Up(Left), place);
}

/// The lab with two more gauges.
fn with_gauges() -> App {
    let mut app = in_lab();
    let mut seen = snapshot(&pendulum(), 2.0);
    let exact = phaselab::experiment::Verdict::Bounded;
    seen.gauges = ["energy", "second", "third"].map(|n| gauge(n, n, 1.0, exact.clone())).into();
    app.update(AppEvent::Snapshot(Arc::new(seen)));
    app
}

#[test]
fn every_line_of_a_list_is_where_it_is_drawn() {
    for size in [(80, 24), (120, 40), (200, 60)] {
        let app = with_gauges();
        let buffer = screen(&app, &rich(), size);
        let text = rows(&buffer);
        let mut seen = Vec::new();
        for (place, target) in all(&app, size) {
            let row = &text[usize::from(place.1)];
            let named = |name: &str| assert!(row.contains(name), "{target:?} at {place:?}: {row}");
            match target {
                HitTarget::Value(target) | HitTarget::Bar { target, .. } => {
                    let shown = app.lab.as_ref().unwrap().value_info(target).unwrap().shown;
                    named(&rich().glyphs.text(&shown));
                }
                // Every second row of a gauge contains its numbers.
                HitTarget::Gauge(_) => assert!(!row.contains("verdict"), "{row}"),
                HitTarget::Page(page) => named(&format!("{page:?}")),
                HitTarget::Hint(action) => {
                    let hint = phaselab::app::keymap::KEYS.iter().find(|row| row.action == action);
                    named(hint.unwrap().hint);
                }
                _ => {}
            }
            let kind = format!("{target:?}").split([' ', '(']).next().unwrap().to_owned();
            if !seen.contains(&kind) {
                seen.push(kind);
            }
        }
        seen.sort();
        let wanted = ["Bar", "Gauge", "Hint", "Mass", "Page", "Pane", "Plot", "Space", "Value"];
        let wanted = wanted.map(str::to_owned);
        assert_eq!(seen, wanted, "{size:?}");
    }
}

#[test]
fn every_pane_answers_in_its_own_frame() {
    for size in SIZES {
        let mut app = in_lab();
        let panes: Vec<Pane> = app.lab.as_ref().unwrap().panes().collect();
        for _ in &panes {
            press(&mut app, "Tab");
            let focus = app.lab.as_ref().unwrap().focus.pane;
            let belongs = |target: &HitTarget| match *target {
                HitTarget::Pane(pane) => pane == focus,
                HitTarget::Plot { index, .. } | HitTarget::Space { index, .. } => {
                    focus == Pane::Plot(index)
                }
                HitTarget::Value(ValueId::Parameter(_)) => focus == Pane::Parameters,
                HitTarget::Bar { target: ValueId::Parameter(_), .. } => focus == Pane::Parameters,
                HitTarget::Value(ValueId::Initial(_)) => focus == Pane::Initial,
                HitTarget::Gauge(_) => focus == Pane::Gauges,
                _ => false,
            };
            let found = all(&app, size);
            let cells = found.iter().filter(|(_, target)| belongs(target)).count();
            assert!(cells >= 6, "{focus:?} at {size:?}: {cells} of {}", found.len());
        }
    }
}

#[test]
fn the_coordinates_of_a_place_are_those_of_the_axes() {
    // The cursor and the mouse read the same in a cell, to half a dot of eight.
    for size in [(80, 24), (120, 40), (200, 60)] {
        let app = in_lab();
        for (place, target) in all(&app, size) {
            let HitTarget::Plot { index, place: [x, y], at: coordinates } = target else {
                continue;
            };
            if place.0 % 7 != 0 || place.1 % 3 != 0 {
                continue;
            }
            assert!((0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y), "{target:?}");
            let mut marked = app.clone();
            let lab = marked.lab.as_mut().unwrap();
            let viewport = lab.plots[index].viewport_mut().expect("it has axes");
            viewport.cursor = Some([x, y]);
            let buffer = screen(&marked, &rich(), size);
            assert_eq!(buffer[place].symbol(), "┼", "{target:?} at {place:?}");
            // The reading in the corner agrees, in all its digits, with the mouse.
            let reading: String = rows(&buffer).concat();
            let [x, y] =
                coordinates.map(|v| phaselab::view::number::readable(v, 4, Glyphs::Braille));
            assert!(reading.contains(&format!(" {x}, {y} ")), "{x}, {y} in {:#?}", rows(&buffer));
        }
    }
}

#[test]
fn a_click_throws_the_pendulum_to_another_beginning() {
    let size = (120, 40);
    let mut real = Real::of("pendulum");
    real.run(100);
    let start = real.seen().initial.clone();
    let targets = all(&real.app, size);
    let pick = |want: [f64; 2]| {
        let far = |target: &HitTarget| match target {
            HitTarget::Plot { index: 1, at, .. } => {
                (at[0] - want[0]).abs() + (at[1] - want[1]).abs()
            }
            _ => f64::INFINITY,
        };
        targets.iter().min_by(|a, b| far(&a.1).total_cmp(&far(&b.1))).copied().unwrap()
    };
    let (place, target) = pick([-1.0, 2.0]);
    let HitTarget::Plot { at: [theta, momentum], .. } = target else { panic!("{target:?}") };
    click(&mut real, size, place);
    assert_eq!(real.seen().time, 0.0, "it begins anew");
    assert_eq!(real.seen().initial[0].to_bits(), theta.to_bits());
    // p = m l² θ̇ with m = l = 1
    assert!((real.seen().initial[1] - momentum).abs() < 1e-12);
    // And it is drawn where the mouse was.
    let buffer = screen(&real.app, &rich(), size);
    assert_eq!(buffer[place].symbol(), "●", "{:#?}", rows(&buffer));
    real.press("u");
    assert_eq!(real.seen().initial, start, "one step back");
}

#[test]
fn a_click_in_another_plot_reads_the_coordinates() {
    let size = (120, 40);
    let mut real = Real::of("pendulum");
    real.run(100);
    let targets = all(&real.app, size);
    let time = |target: &HitTarget| matches!(target, HitTarget::Plot { index: 2, .. });
    let inside: Vec<_> = targets.iter().filter(|(_, target)| time(target)).collect();
    let (place, _) = *inside[inside.len() / 2];
    click(&mut real, size, place);
    let buffer = screen(&real.app, &rich(), size);
    assert_eq!(buffer[place].symbol(), "┼");
    assert!(real.seen().time > 1.0, "the motion goes on");
}

/// The cursor stays at its coordinates while the axes grow with the motion, and the motion begins there; a key moves it
/// from where it is seen.
#[test]
fn the_cursor_stays_at_its_coordinates_while_the_axes_change() {
    let size = (80, 24);
    // under a force that grows with the time no orbit is known beforehand, and the axes follow the motion
    let text = catalog().find("harmonic-oscillator").expect("a preset").text.clone();
    let pulled = text.replace("p_x^2/(2*m) + V\"", "p_x^2/(2*m) + V - x*t/5\"");
    assert_ne!(pulled, text);
    let mut real = Real::with(lowered(&pulled));
    real.run(5);
    real.press("c");
    assert!(real.lab().has_cursor());
    let seen = |real: &mut Real| {
        let (buffer, shown) = drawn(&real.app, &rich(), size);
        real.app.update(AppEvent::Drawn(shown.clone()));
        let mark = find(&buffer, "┼").expect("the cursor is drawn");
        (mark, shown.reading.expect("it is read"))
    };
    real.press("Left Left Up Up");
    let (mark, reading) = seen(&mut real);
    let mut moved = false;
    // a stiffer spring has another orbit, and so the axes another window
    for softer in (1..=12).rev() {
        let value = 1.0 + 2.0 / f64::from(softer);
        real.experiment.execute(Command::Parameter { index: 1, value });
        real.run(30);
        let (now, at) = seen(&mut real);
        assert_eq!(at, reading);
        moved |= now != mark;
    }
    assert!(moved, "the axes have changed");
    let (before, _) = seen(&mut real);
    real.press("Left Left");
    let (after, _) = seen(&mut real);
    assert!(after.0 < before.0 && after.1 == before.1, "{before:?} {after:?}");
    let (_, [x, p]) = seen(&mut real);
    real.press("Enter");
    let named = |name: &str| {
        let channels = real.lab().loaded.system.channels();
        let place = channels.iter().position(|channel| channel.name == name).expect("a column");
        real.seen().values[place]
    };
    assert_eq!((real.seen().time, named("x")), (0.0, x));
    assert!((named("p_x") - p).abs() <= 1e-12 * p.abs(), "{} {p}", named("p_x"));
}

#[test]
fn a_bar_is_dragged_and_taken_back_in_one_step() {
    let size = (120, 40);
    let mut real = Real::of("pendulum");
    let before = real.seen().parameters.clone();
    let bar = places(&real.app, size, |target| {
        matches!(target, HitTarget::Bar { target: ValueId::Parameter(1), .. })
    });
    assert!(bar.len() > 8, "{bar:?}");
    act(&mut real, size, Down(Left), bar[2]);
    assert_eq!(real.app.mouse.drag, Some(Grab::Bar(ValueId::Parameter(1))));
    for place in &bar {
        act(&mut real, size, Drag(Left), *place);
        real.app.update(AppEvent::Tick(std::time::Duration::from_secs(2)));
        let buffer = screen(&real.app, &rich(), size);
        assert_eq!(buffer[*place].symbol(), "●", "the knob is under the mouse");
    }
    // Beyond the bar the knob stops at its end.
    act(&mut real, size, Drag(Left), (119, 0));
    let (_, max, _) = real.lab().value_info(ValueId::Parameter(1)).unwrap().range.unwrap();
    assert_eq!(real.seen().parameters[1], max);
    act(&mut real, size, Up(Left), (119, 0));
    assert_eq!(real.app.mouse.drag, None);
    real.press("u");
    assert_eq!(real.seen().parameters, before);
    real.press("U");
    assert_eq!(real.seen().parameters[1], max);
}

/// A position in the middle of a picture.
fn inside(app: &App, size: (u16, u16), picture: usize) -> (u16, u16) {
    let here = |target: &HitTarget| match *target {
        HitTarget::Plot { index, .. } | HitTarget::Space { index, .. } => index == picture,
        _ => false,
    };
    let places: Vec<_> = all(app, size).into_iter().filter(|(_, target)| here(target)).collect();
    places[places.len() / 2].0
}

#[test]
fn the_wheel_zooms_about_the_place_under_it() {
    for size in [(80, 24), (120, 40)] {
        for picture in [1, 2] {
            let mut real = Real::of("pendulum");
            real.run(900);
            if size.0 == 80 && picture == 2 {
                real.press("Shift-Tab Shift-Tab");
            }
            let (x, y) = inside(&real.app, size, picture);
            let place = (x + 6, y - 2);
            let coordinates = |real: &Real| match at(&real.app, size, place) {
                Some(HitTarget::Plot { at, .. }) => at,
                other => panic!("{other:?}"),
            };
            let (before, plot) = (coordinates(&real), real.lab().plots[picture].clone());
            for _ in 0..3 {
                act(&mut real, size, ScrollUp, place);
            }
            assert_ne!(real.lab().plots[picture], plot);
            // A change of tick labels shifts the axes by about a cell; the position changes by a fraction of it.
            let after = coordinates(&real);
            let wide = if picture == 1 { 6.3 } else { 20.0 };
            assert!((after[0] - before[0]).abs() < 0.05 * wide, "{before:?} {after:?}");
            for _ in 0..3 {
                act(&mut real, size, ScrollDown, place);
            }
            let after = coordinates(&real);
            assert!((after[0] - before[0]).abs() < 0.03 * wide, "{before:?} {after:?}");
        }
    }
}

/// With a unit as long on both axes one of them is longer than what it shows; the place under the mouse stays there, too.
#[test]
fn a_plane_is_zoomed_and_moved_with_the_mouse() {
    let size = (120, 40);
    for name in ["foucault", "charge-in-fields", "rolling-disc"] {
        let mut real = Real::of(name);
        real.run(300);
        let is_plane = |plot: &phaselab::instrument::Plot| {
            plot.viewport().is_some_and(|viewport| viewport.equal)
        };
        let picture = real.lab().plots.iter().position(is_plane).unwrap();
        let (x, y) = inside(&real.app, size, picture);
        let place = (x + 9, y - 4);
        let coordinates = |real: &Real, place| match at(&real.app, size, place) {
            Some(HitTarget::Plot { at, .. }) => at,
            other => panic!("{other:?}"),
        };
        let cell = |real: &Real| {
            let [from, to] = [(x, y), (x + 1, y)].map(|place| coordinates(real, place)[0]);
            (to - from).abs()
        };
        let before = coordinates(&real, place);
        for _ in 0..4 {
            act(&mut real, size, ScrollUp, place);
        }
        let after = coordinates(&real, place);
        // the labels of the ticks may take another column
        let off = [0, 1].map(|k| (after[k] - before[k]).abs() / cell(&real));
        assert!(off[0] < 2.1 && off[1] < 4.1, "{name}: {before:?} {after:?}");
        let before = coordinates(&real, place);
        act(&mut real, size, Down(Left), place);
        act(&mut real, size, Drag(Left), (place.0 + 6, place.1 + 3));
        let after = coordinates(&real, (place.0 + 6, place.1 + 3));
        let off = [0, 1].map(|k| (after[k] - before[k]).abs() / cell(&real));
        assert!(off[0] < 2.1 && off[1] < 4.1, "{name}: {before:?} {after:?}");
    }
}

/// The cells of the masses that can be dragged.
fn masses(app: &App, size: (u16, u16)) -> Vec<(u16, u16)> {
    places(app, size, |target| matches!(target, HitTarget::Mass { .. }))
}

/// A bob follows the mouse around its pivot, waits there, and swings from rest once it is let go; one undo takes all of it back.
#[test]
fn a_bob_is_dragged_and_let_go_from_rest() {
    let size = (120, 40);
    let mut real = Real::of("pendulum");
    real.run(30);
    let before = real.seen().initial.clone();
    let bob = masses(&real.app, size);
    act(&mut real, size, Down(Left), bob[bob.len() / 2]);
    // the pivot is in the middle of the picture: to its right θ is π/2, below it 0, to its left −π/2
    let angle = |real: &Real| real.seen().values[0];
    for (place, expected) in [((34, 11), 1.57), ((20, 20), 0.0), ((6, 11), -1.57)] {
        act(&mut real, size, Drag(Left), place);
        assert!((angle(&real) - expected).abs() < 0.1, "{place:?} {}", angle(&real));
        assert_eq!(real.seen().status, Status::Paused, "what is dragged does not move");
    }
    let placed = angle(&real);
    act(&mut real, size, Up(Left), (6, 11));
    assert_eq!(*real.seen().initial, [placed, 0.0]);
    real.run(30);
    assert!(real.seen().time > 0.0 && angle(&real) > placed, "it swings");
    real.press("u");
    assert_eq!(real.seen().initial, before);
}

/// Both coordinates of a planet follow the mouse, and both angles of a double pendulum; its upper bob stays on its circle, at the
/// point that is nearest to the mouse.
#[test]
fn a_mass_is_brought_where_the_mouse_is_or_as_near_as_it_can_be() {
    let size = (120, 40);
    for (name, which, on_circle) in [
        ("planet", 0, false),
        ("two-centres", 0, false),
        ("double-pendulum", 0, true),
        ("double-pendulum", 1, false),
    ] {
        let mut real = Real::of(name);
        let hit = |real: &Real, place| match at(&real.app, size, place) {
            Some(HitTarget::Mass { at, shape, .. }) => (at, shape),
            other => panic!("{name}: {other:?}"),
        };
        let cells = masses(&real.app, size);
        let mut shapes: Vec<usize> = cells.iter().map(|cell| hit(&real, *cell).1).collect();
        shapes.sort_unstable();
        shapes.dedup();
        let shape = shapes[which];
        let place = *cells.iter().rfind(|cell| hit(&real, **cell).1 == shape).expect("its cell");
        act(&mut real, size, Down(Left), place);
        let to = (place.0.saturating_sub(3), place.1 + 1);
        let (mut wanted, _) = hit(&real, to);
        if on_circle {
            let far = math::hypot(wanted[0], wanted[1]);
            wanted = wanted.map(|x| x / far);
        }
        act(&mut real, size, Drag(Left), to);
        let lab = real.lab();
        let eye = lab.plots.iter().find_map(Plot::eye).expect("a picture");
        let Shape::Mass { at, .. } = &eye.shapes(&lab.loaded.model)[shape] else {
            panic!("{name}: no mass")
        };
        let found = [0, 1]
            .map(|k| real.seen().values[lab.loaded.system.channel_of(at[k]).expect("a channel")]);
        let off = [0, 1].map(|k| (wanted[k] - found[k]).abs());
        assert!(off.iter().all(|off| *off < 1e-6), "{name}: {wanted:?} {found:?}");
        let velocities = real.seen().initial.len() / 2;
        assert!(real.seen().initial[velocities..].iter().all(|v| *v == 0.0), "{name}");
    }
}

/// The ellipse of a planet that is dragged before it has moved becomes a line, and the picture stays as it is, zoomed or not.
#[test]
fn a_picture_keeps_its_window_when_a_mass_is_dragged() {
    let size = (120, 40);
    for notches in [0, 2] {
        let mut real = Real::of("planet");
        let planet = |real: &Real| *masses(&real.app, size).last().expect("a planet");
        let window = |real: &Real, cell| match at(&real.app, size, cell) {
            Some(HitTarget::Mass { window, .. }) => window.ranges,
            other => panic!("{other:?}"),
        };
        for _ in 0..notches {
            let cell = planet(&real);
            act(&mut real, size, ScrollUp, cell);
        }
        let from = planet(&real);
        let before = window(&real, from);
        let to = (from.0 - 1, from.1 - 3);
        act(&mut real, size, Down(Left), from);
        act(&mut real, size, Drag(Left), to);
        act(&mut real, size, Up(Left), to);
        let after = window(&real, to);
        for k in 0..2 {
            let length = before[k][1] - before[k][0];
            for end in 0..2 {
                let off = (after[k][end] - before[k][end]).abs() / length;
                assert!(off < 1e-9, "{notches} {before:?} {after:?}");
            }
        }
        assert!(real.seen().initial[0] > 0.1, "it was dragged");
    }
}

/// A planet is not pulled through its sun, where its distance would change sign.
#[test]
fn a_planet_is_not_pulled_through_its_sun() {
    let size = (120, 40);
    let mut real = Real::of("planet");
    let masses = masses(&real.app, size);
    let place = *masses.last().expect("a planet");
    act(&mut real, size, Down(Left), place);
    for x in (2..place.0).rev() {
        act(&mut real, size, Drag(Left), (x, place.1));
        assert!(real.seen().values[0] > 0.0, "{x}: {}", real.seen().values[0]);
    }
}

/// What constraints tie together, or the time moves, cannot be dragged.
#[test]
fn what_does_not_follow_from_coordinates_alone_is_not_dragged() {
    for name in ["pendulum-rod", "kapitza", "heavy-top"] {
        let mut real = Real::of(name);
        real.run(10);
        assert_eq!(masses(&real.app, (120, 40)), [], "{name}");
    }
}

/// In a vector potential p = 0 is not rest: with H = ½(p_x + y)² + ½(p_y − x)² that is p = (−y, x).
#[test]
fn a_mass_in_a_vector_potential_is_at_rest_where_it_is_let_go() {
    let size = (120, 40);
    let mut real = Real::with(lowered(
        "title = \"T\"\n[coordinates]\nx = { initial = 1.0, momentum = 0.5 }\ny = { initial = 0.5, momentum = 0.0 }\n\
         [hamiltonian]\nH = \"1/2*((p_x + y)^2 + (p_y - x)^2)\"\n\
         [space]\nshapes = [{ mass = [\"x\", \"y\", \"0\"] }, { line = [\"-2\", \"-2\", \"0\"], to = [\"2\", \"2\", \"0\"] }]\n",
    ));
    let cells = masses(&real.app, size);
    act(&mut real, size, Down(Left), cells[cells.len() / 2]);
    act(&mut real, size, Drag(Left), (cells[0].0 - 4, cells[0].1 + 2));
    let [x, y, p_x, p_y] = real.seen().initial[..] else { panic!("four values") };
    assert!((x - 1.0).abs() > 0.05, "it is dragged: {x}");
    assert_eq!([p_x + y, p_y - x], [0.0; 2]);
}

/// The same where H is not quadratic in the momenta: a fast charge, with H = √((p_x + y)² + (p_y − x)² + 1).
#[test]
fn a_relativistic_charge_is_at_rest_where_it_is_let_go() {
    let size = (120, 40);
    let mut real = Real::with(lowered(
        "title = \"T\"\n[coordinates]\nx = { initial = 1.0, momentum = 0.5 }\ny = { initial = 0.5, momentum = 0.0 }\n\
         [hamiltonian]\nH = \"sqrt((p_x + y)^2 + (p_y - x)^2 + 1)\"\n\
         [space]\nshapes = [{ mass = [\"x\", \"y\", \"0\"] }, { line = [\"-2\", \"-2\", \"0\"], to = [\"2\", \"2\", \"0\"] }]\n",
    ));
    let cells = masses(&real.app, size);
    act(&mut real, size, Down(Left), cells[cells.len() / 2]);
    act(&mut real, size, Drag(Left), (cells[0].0 - 4, cells[0].1 + 2));
    let [x, y, p_x, p_y] = real.seen().initial[..] else { panic!("four values") };
    assert!((x - 1.0).abs() > 0.05, "it is dragged: {x}");
    let left = [p_x + y, p_y - x];
    assert!(left.iter().all(|left| left.abs() < 1e-12), "{left:?}");
}

/// An angle dragged over the top is brought back to the turn about zero when it is let go, and one undo takes back all of it. One
/// that winds up a spring is not: there a turn makes a difference.
#[test]
fn an_angle_dragged_over_the_top_is_brought_back() {
    let size = (120, 40);
    let wound = "title = \"T\"\n[coordinates]\ntheta = { initial = 0.5, period = \"2*pi\" }\n[lagrangian]\n\
                 L = \"1/2*theta'^2 + 9.81*cos(theta) - 0.01*theta^2\"\n[space]\nshapes = [\
                 { line = [\"0\", \"0\"], to = [\"sin(theta)\", \"-cos(theta)\"] }, { mass = [\"sin(theta)\", \"-cos(theta)\"] }]\n";
    for (mut real, is_angle) in
        [(Box::new(Real::of("pendulum")), true), (Box::new(Real::with(lowered(wound))), false)]
    {
        let before = real.seen().initial.clone();
        let bob = masses(&real.app, size);
        act(&mut real, size, Down(Left), bob[bob.len() / 2]);
        // below the pivot, to its left, above it, to its right
        let Some(HitTarget::Mass { window, .. }) = at(&real.app, size, bob[bob.len() / 2]) else {
            panic!("grabbed")
        };
        let place = |[x, y]: [f64; 2]| {
            let share = [0, 1].map(|k| {
                let [from, to] = window.ranges[k];
                ([x, y][k] - from) / (to - from)
            });
            let cell = |k: usize, share: f64| {
                window.corner[k] + (share * f64::from(window.cells[k])) as u16
            };
            (cell(0, share[0]), cell(1, 1.0 - share[1]))
        };
        for to in [[0.0, -0.9], [-0.9, 0.0], [0.0, 0.9], [0.9, 0.0]] {
            act(&mut real, size, Drag(Left), place(to));
        }
        let dragged = real.seen().initial[0];
        assert!((dragged + 1.5 * std::f64::consts::PI).abs() < 0.2, "{dragged}");
        act(&mut real, size, Up(Left), place([0.9, 0.0]));
        let placed = real.seen().initial[0];
        let expected = if is_angle { dragged + std::f64::consts::TAU } else { dragged };
        assert!((placed - expected).abs() < 1e-12, "{placed} {expected}");
        real.press("u");
        assert_eq!(real.seen().initial, before);
    }
}

/// A cart with a pendulum: the bob, at X + sin θ, follows the mouse from X = 0, where X has no sign to keep.
#[test]
fn the_bob_of_a_cart_is_dragged() {
    let size = (120, 40);
    let mut real = Real::with(lowered(
        "title = \"T\"\n[coordinates]\nX = { initial = 0.0 }\ntheta = { initial = 0.5, period = \"2*pi\" }\n\
         [lagrangian]\nL = \"X'^2 + 1/2*theta'^2 + X'*theta'*cos(theta) + cos(theta)\"\n\
         [space]\nshapes = [{ mass = [\"X + sin(theta)\", \"-cos(theta)\", \"0\"] }, { line = [\"-2\", \"-2\", \"0\"], to = [\"2\", \"2\", \"0\"] }]\n",
    ));
    let cells = masses(&real.app, size);
    act(&mut real, size, Down(Left), cells[cells.len() / 2]);
    let to = (cells[0].0 - 4, cells[0].1 - 1);
    let Some(HitTarget::Mass { at: wanted, .. }) = at(&real.app, size, to) else {
        panic!("grabbed")
    };
    act(&mut real, size, Drag(Left), to);
    let [x, theta, ..] = real.seen().initial[..] else { panic!("four values") };
    let found = [x + math::sin(theta), -math::cos(theta)];
    let off = [0, 1].map(|k| (wanted[k] - found[k]).abs());
    assert!(off.iter().all(|off| *off < 1e-6), "{wanted:?} {found:?}");
}

/// The counterweight pulled down to the ground shortens the string of the other weight, and stops before it has none.
#[test]
fn a_mass_is_not_dragged_through_a_place_where_the_masses_are_singular() {
    let size = (120, 40);
    let mut real = Real::of("swinging-atwood");
    let is_weight = |target: &HitTarget| matches!(target, HitTarget::Mass { shape, .. } if *shape == counterweight(&real));
    let cell = places(&real.app, size, is_weight)[0];
    act(&mut real, size, Down(Left), cell);
    let mut found = Vec::new();
    for row in 1..39 {
        for column in [cell.0, cell.0 + 1] {
            act(&mut real, size, Drag(Left), (column, row));
            found.push(real.seen().values[0]);
        }
    }
    assert!(found.iter().all(|r| *r > 0.0), "{found:?}");
    assert!(found.iter().any(|r| *r != found[0]), "it is dragged");
}

/// The mass at the place of the heavier weight, which moves straight: r alone is in it.
fn counterweight(real: &Real) -> usize {
    let lab = real.lab();
    let eye = lab.plots.iter().find_map(Plot::eye).expect("a picture");
    let angle = lab.loaded.equations.coordinates[1].position;
    let is_straight = |shape: &Shape| match shape {
        Shape::Mass { at, .. } => at.iter().all(|e| !lab.loaded.equations.pool.depends(*e, angle)),
        _ => false,
    };
    eye.shapes(&lab.loaded.model).iter().position(is_straight).expect("a weight")
}

/// Whatever ends a drag, the motion runs again if it ran before, and not otherwise: the button let go beyond the pane of a picture
/// that is zoomed, a key, or the next press of the button, where its release was not reported.
#[test]
fn a_motion_paused_by_a_drag_runs_again_however_that_ends() {
    let size = (120, 40);
    for was_paused in [false, true] {
        for ending in 0..3 {
            let mut real = Real::of("pendulum");
            real.run(30);
            let status = if was_paused { Status::Paused } else { Status::Running };
            if (real.seen().status == Status::Paused) != was_paused {
                real.press("Space");
            }
            assert_eq!(real.seen().status, status);
            let bob = masses(&real.app, size);
            let bob = bob[bob.len() / 2];
            for _ in 0..3 {
                act(&mut real, size, ScrollUp, bob);
            }
            let zoomed = masses(&real.app, size);
            let bob = zoomed[zoomed.len() / 2];
            act(&mut real, size, Down(Left), bob);
            act(&mut real, size, Drag(Left), (bob.0 + 2, bob.1));
            act(&mut real, size, Drag(Left), (119, 39));
            assert_eq!(real.seen().status, Status::Paused);
            match ending {
                0 => act(&mut real, size, Up(Left), (119, 39)),
                1 => real.press("Tab"),
                _ => {
                    real.app.end_group();
                    act(&mut real, size, Down(Left), (0, 0));
                }
            }
            assert_eq!(real.app.mouse.drag, None, "{ending}");
            // what is still to be done is done by the next event
            let effects = real.app.update(AppEvent::Tick(std::time::Duration::ZERO));
            real.execute(effects);
            real.look();
            assert_eq!(real.seen().status, status, "{ending}");
        }
    }
}

/// The window of a picture stays the same while a mass is dragged, however far and often the mouse leaves it; one undo brings back both.
#[test]
fn a_drag_beyond_a_picture_does_not_widen_it() {
    let size = (120, 40);
    let mut real = Real::of("planet");
    real.press("Space");
    real.run(10);
    let window = |real: &Real| {
        all(&real.app, size).into_iter().find_map(|(_, target)| match target {
            HitTarget::Mass { window, .. } => Some(window),
            _ => None,
        })
    };
    let (before, values) = (window(&real).expect("a planet"), real.seen().initial.clone());
    let place = masses(&real.app, size)[0];
    act(&mut real, size, Down(Left), place);
    for wiggle in 0..24 {
        act(&mut real, size, Drag(Left), (119 - wiggle % 2, 39));
    }
    let [x, y] = before.ranges.map(|range| range[0].abs().max(range[1].abs()));
    let r = real.seen().values[0];
    assert!(r > values[0] && r <= math::hypot(x, y), "{r} {before:?}");
    act(&mut real, size, Up(Left), (119, 39));
    real.press("u");
    assert_eq!(real.seen().initial, values);
    assert_eq!(window(&real), Some(before));
}

/// A picture in space keeps its scale when the motion is begun at a point of a plot: what stays where it is stays on the screen.
#[test]
fn a_picture_in_space_keeps_its_scale_from_start_to_start() {
    let mut real = Real::with(lowered(
        "title = \"T\"\n[coordinates]\nx = { initial = 1.0 }\ny = { initial = 0.0, velocity = 1.0 }\nz = { initial = 0.5 }\n\
         [lagrangian]\nL = \"1/2*(x'^2 + y'^2 + z'^2) - 1/2*(x^2 + y^2 + z^2)\"\n\
         [[views]]\nkind = \"space\"\n[[views]]\nkind = \"phase\"\nx = \"x\"\ny = \"x'\"\n\
         [space]\nshapes = [{ mass = [\"x\", \"y\", \"z\"] }, { caption = [\"0.4\", \"0.2\", \"0\"], text = \"FIXED\" }]\n",
    ));
    let place = |real: &Real| {
        let shown = rows(&screen(&real.app, &rich(), (120, 40)));
        let row = shown.iter().position(|row| row.contains("FIXED")).expect("the caption");
        (row, shown[row].chars().take_while(|c| *c != 'F').count())
    };
    real.run(600);
    let before = place(&real);
    let portrait = real.lab().plots.iter().position(|plot| plot.eye().is_none()).expect("a plot");
    let inside =
        |target: &HitTarget| matches!(target, HitTarget::Plot { index, .. } if *index == portrait);
    let inside = places(&real.app, (120, 40), inside);
    click(&mut real, (120, 40), inside[inside.len() / 2]);
    assert!(real.seen().time < 1.0, "it begins anew");
    assert_eq!(place(&real), before);
    real.run(20);
    assert_eq!(place(&real), before);
}

/// That a mass can be dragged is said only where one can.
#[test]
fn a_drag_beside_the_masses_says_what_can_be_dragged() {
    let size = (120, 40);
    for (name, can_drag) in [("pendulum", true), ("pendulum-rod", false), ("kapitza", false)] {
        let mut real = Real::of(name);
        let picture = real.lab().plots.iter().position(|plot| plot.eye().is_some()).unwrap();
        let space = |target: &HitTarget| matches!(target, HitTarget::Space { index, .. } if *index == picture);
        let place = places(&real.app, size, space)[0];
        act(&mut real, size, Down(Left), place);
        act(&mut real, size, Drag(Left), (place.0 + 3, place.1 + 1));
        let text = &real.app.notifications.shown.as_ref().expect("a notification").text;
        assert!(text.contains("stays in a plane"), "{name}: {text}");
        assert_eq!(text.contains("drag a mass"), can_drag, "{name}: {text}");
    }
}

/// A mass is where it is drawn: every cell of its disc takes hold of it.
#[test]
fn every_cell_of_a_disc_is_its_mass() {
    let size = (120, 40);
    let real = Real::of("swinging-atwood");
    let weight = counterweight(&real);
    let is_weight =
        |target: &HitTarget| matches!(target, HitTarget::Mass { shape, .. } if *shape == weight);
    let cells = places(&real.app, size, is_weight);
    let buffer = screen(&real.app, &rich(), size);
    let colour = buffer[cells[cells.len() / 2]].fg;
    let (from, to) = (cells[0], cells[cells.len() - 1]);
    let around = (from.1 - 2..to.1 + 3).flat_map(|y| (from.0 - 3..to.0 + 4).map(move |x| (x, y)));
    let drawn: Vec<_> =
        around.filter(|at| buffer[*at].fg == colour && buffer[*at].symbol() != " ").collect();
    assert!(drawn.len() > 2, "{drawn:?}");
    let rows = |cells: &[(u16, u16)]| {
        let mut rows: Vec<u16> = cells.iter().map(|cell| cell.1).collect();
        rows.sort_unstable();
        rows.dedup();
        rows
    };
    assert_eq!(rows(&drawn), rows(&cells));
    assert!(drawn.iter().all(|cell| cells.contains(cell)), "{drawn:?} {cells:?}");
}

/// The cells with a disc in some columns of the upper half.
fn discs(app: &App, columns: std::ops::Range<u16>) -> Vec<(u16, u16)> {
    let buffer = screen(app, &rich(), (120, 40));
    let cells = (2..22).flat_map(|y| columns.clone().map(move |x| (x, y)));
    cells.filter(|at| buffer[*at].symbol() == "●").collect()
}

fn is_near(discs: &[(u16, u16)], at: (u16, u16)) -> bool {
    discs.iter().any(|disc| disc.0.abs_diff(at.0) <= 1 && disc.1.abs_diff(at.1) <= 1)
}

#[test]
fn the_wheel_zooms_a_scene_about_the_place_under_it() {
    let size = (120, 40);
    let mut real = Real::of("heavy-top");
    real.run(60);
    let before = real.lab().plots[0].clone();
    let tip = discs(&real.app, 1..39)[0];
    // the disc is up to half a cell off the middle of its cell
    for _ in 0..3 {
        act(&mut real, size, ScrollUp, tip);
        assert!(is_near(&discs(&real.app, 1..39), tip), "{tip:?}");
    }
    let zoomed = real.lab().plots[0].eye().unwrap();
    assert!(zoomed.zoom > 1.7);
    // the whole scene is in the middle again
    for _ in 0..4 {
        act(&mut real, size, ScrollDown, (20, 12));
    }
    act(&mut real, size, ScrollUp, (20, 12));
    let eye = real.lab().plots[0].eye().unwrap();
    assert!((eye.zoom - 1.0).abs() < 1e-9 && eye.pan == [0.0; 2], "{eye:?}");
    real.press("Home");
    assert_eq!(real.lab().plots[0].eye(), before.eye());
}

/// A plane picture is not turned by a drag, but a part of it is moved.
#[test]
fn a_drag_moves_a_part_of_a_scene_in_a_plane() {
    let size = (120, 40);
    let mut real = Real::of("double-pendulum");
    real.run(60);
    let picture = real.lab().plots.iter().position(|plot| plot.eye().is_some()).unwrap();
    let (x, y) = inside(&real.app, size, picture);
    act(&mut real, size, ScrollUp, (x, y));
    let before = real.lab().plots[picture].eye().unwrap();
    act(&mut real, size, Down(Left), (x, y));
    act(&mut real, size, Drag(Left), (x + 4, y));
    let after = real.lab().plots[picture].eye().unwrap();
    assert_eq!((after.yaw, after.pitch, after.zoom), (before.yaw, before.pitch, before.zoom));
    assert!(after.pan[0] < before.pan[0] - 0.05, "{before:?} {after:?}");
}

#[test]
fn keys_zoom_a_plot_about_the_moving_point_or_the_cursor() {
    let mut real = Real::of("pendulum");
    real.run(75);
    while real.lab().focus.pane != Pane::Plot(1) {
        real.press("Tab");
    }
    let now = discs(&real.app, 41..79);
    assert_eq!(now.len(), 1);
    let draw = |real: &mut Real| {
        let drawn = super::drawn(&real.app, &rich(), (120, 40)).1;
        real.app.update(AppEvent::Drawn(drawn.clone()));
        drawn
    };
    for _ in 0..5 {
        draw(&mut real);
        real.press("+");
        // tick labels shift the axes by a cell
        assert!(is_near(&discs(&real.app, 41..79), now[0]), "{now:?}");
    }
    real.press("Home c Up Up Up Up Left Left Left");
    let before = draw(&mut real).reading.unwrap();
    for _ in 0..3 {
        draw(&mut real);
        real.press("+");
    }
    let after = draw(&mut real).reading.unwrap();
    assert!((after[0] - before[0]).abs() < 0.2, "{before:?} {after:?}");
    assert!((after[1] - before[1]).abs() < 0.5, "{before:?} {after:?}");
}

/// A pendulum in a plane is seen face on; turned by accident it would swing askew.
#[test]
fn a_motion_in_a_plane_does_not_turn_under_the_mouse() {
    let size = (120, 40);
    let mut real = Real::of("pendulum");
    real.run(60);
    let (x, y) = inside(&real.app, size, 0);
    let before = real.lab().plots.clone();
    act(&mut real, size, Down(Left), (x, y));
    act(&mut real, size, Drag(Left), (x + 6, y - 1));
    act(&mut real, size, Up(Left), (x + 6, y - 1));
    assert_eq!(real.lab().plots, before);
    let reported = real.app.notifications.shown.as_ref().map(|notice| notice.text.as_str());
    assert!(reported.is_some_and(|text| text.contains("stays in a plane")), "{reported:?}");
    // Keys still turn it, and then the last line says how it is turned back.
    let footer =
        |real: &Real| super::rows(&super::screen(&real.app, &super::rich(), (160, 40)))[39].clone();
    real.app.notifications.dismiss();
    assert!(!footer(&real).contains("initial view"), "{}", footer(&real));
    real.press("Left");
    assert!(footer(&real).contains("Home initial view"), "{}", footer(&real));
}

#[test]
fn a_drag_turns_a_picture_and_moves_a_window_with_the_mouse() {
    let size = (120, 40);
    for (name, picture) in [("spherical-pendulum", 0), ("pendulum", 1)] {
        let mut real = Real::of(name);
        real.run(60);
        let (x, y) = inside(&real.app, size, picture);
        let before = real.lab().plots.clone();
        let grabbed = at(&real.app, size, (x, y)).unwrap();
        act(&mut real, size, Down(Left), (x, y));
        act(&mut real, size, Drag(Left), (x + 3, y));
        act(&mut real, size, Drag(Left), (x + 6, y - 1));
        act(&mut real, size, Up(Left), (x + 6, y - 1));
        assert_eq!(real.lab().focus.pane, Pane::Plot(picture));
        let after = real.lab().plots.clone();
        match (before[picture].sight, after[picture].sight, grabbed) {
            (Sight::Camera(a), Sight::Camera(b), _) => {
                assert!(a.yaw != b.yaw && a.pitch != b.pitch);
            }
            (_, Sight::Axes(_), HitTarget::Plot { at: from, .. }) => {
                let Some(HitTarget::Plot { at: to, .. }) = at(&real.app, size, (x + 6, y - 1))
                else {
                    panic!("nothing there")
                };
                assert!((from[0] - to[0]).abs() < 0.2, "{from:?} {to:?}");
                assert_eq!(real.seen().time, 1.0, "a drag is no click");
            }
            other => panic!("{other:?}"),
        }
        real.press("u");
        assert_eq!(real.lab().plots, before, "one step back");
    }
}

#[test]
fn clicks_do_what_stands_there() {
    let size = (80, 24);
    let mut real = Real::of("pendulum");
    let on = |real: &Real, text: &str| {
        let buffer = screen(&real.app, &rich(), size);
        find(&buffer, text).unwrap_or_else(|| panic!("{text} in {:#?}", rows(&buffer)))
    };
    let place = on(&real, "2 Equations");
    click(&mut real, size, place);
    assert_eq!(real.app.page, Page::Equations);
    let place = on(&real, "1 Lab");
    click(&mut real, size, place);
    let place = on(&real, "Initial values");
    click(&mut real, size, place);
    assert_eq!(real.lab().focus.pane, Pane::Initial);
    let place = on(&real, "Gauges");
    click(&mut real, size, place);
    assert_eq!(real.lab().focus.pane, Pane::Gauges);
    let place = on(&real, "? help");
    click(&mut real, size, place);
    assert!(matches!(real.app.overlay, Some(Overlay::Help { .. })));
    act(&mut real, size, ScrollDown, (10, 10));
    real.press("Esc m");
    let place = on(&real, "leapfrog");
    click(&mut real, size, place);
    assert_eq!(real.seen().method.name, "leapfrog");
    real.press(":");
    click(&mut real, size, (0, 5));
    assert!(real.app.overlay.is_none(), "beside a list it closes");
    real.press("Tab");
    let place = on(&real, "Parameters");
    click(&mut real, size, place);
    assert_eq!(real.lab().focus.pane, Pane::Parameters);
}

#[test]
fn a_value_is_selected_by_one_click_and_typed_by_two() {
    let size = (120, 40);
    let mut real = Real::of("pendulum");
    let value = HitTarget::Value(ValueId::Parameter(2));
    let place = places(&real.app, size, |target| *target == value)[0];
    click(&mut real, size, place);
    assert_eq!(real.lab().selected(), Some(ValueId::Parameter(2)));
    assert!(real.app.overlay.is_none());
    click(&mut real, size, place);
    assert!(matches!(&real.app.overlay, Some(Overlay::Field(_))));
    // A click elsewhere does what it does there, as long as nothing has been typed, and discards no text.
    let plot = places(&real.app, size, |target| matches!(target, HitTarget::Plot { .. }))[0];
    click(&mut real, size, plot);
    assert!(real.app.overlay.is_none());
    assert!(matches!(real.lab().focus.pane, Pane::Plot(_)), "{:?}", real.lab().focus.pane);
    click(&mut real, size, place);
    click(&mut real, size, place);
    real.press("7");
    click(&mut real, size, plot);
    let Some(Overlay::Field(field)) = &real.app.overlay else { panic!("the text is discarded") };
    assert_eq!(field.input.value(), "7");
}

#[test]
fn the_wheel_scrolls_text_and_lists() {
    let mut app = in_lab();
    press(&mut app, "2");
    let (_, drawn) = super::drawn(&app, &rich(), (80, 16));
    app.update(AppEvent::Drawn(drawn));
    let target = at(&app, (80, 16), (20, 8)).unwrap();
    assert_eq!(target, HitTarget::Text);
    app.update(AppEvent::Mouse(ScrollDown, target));
    assert!(app.text.scroll > 0 && app.text.scroll <= 3, "{}", app.text.scroll);
    app.update(AppEvent::Mouse(ScrollUp, target));
    assert_eq!(app.text.scroll, 0);

    let mut app = at_picker();
    let before = app.picker.selected;
    let target = at(&app, (80, 24), (6, 12)).unwrap();
    app.update(AppEvent::Mouse(ScrollUp, target));
    assert_eq!(app.picker.selected, before - 1);
    let systems: Vec<usize> = all(&app, (80, 24))
        .into_iter()
        .filter_map(
            |(_, target)| if let HitTarget::System(place) = target { Some(place) } else { None },
        )
        .collect();
    let other = systems.into_iter().find(|place| *place != app.picker.selected).unwrap();
    app.update(AppEvent::Mouse(Down(Left), HitTarget::System(other)));
    assert_eq!(app.picker.selected, other);

    let mut app = in_lab();
    press(&mut app, ":");
    let target = at(&app, (80, 24), (20, 8)).unwrap();
    assert!(matches!(target, HitTarget::Line(_)), "{target:?}");
    app.update(AppEvent::Mouse(ScrollDown, target));
    let Some(Overlay::Menu(menu)) = &app.overlay else { panic!("the palette is gone") };
    assert_eq!(menu.selected, 1);
}

#[test]
fn nothing_is_under_a_place_that_shows_nothing() {
    let mut app = in_lab();
    for size in [(0, 0), (1, 1), (39, 9), (80, 24)] {
        for place in [(0, 0), (200, 3), (3, 200), (u16::MAX, u16::MAX)] {
            let found = at(&app, size, place);
            assert!(found.is_none(), "{found:?} at {place:?} of {size:?}");
        }
    }
    // A dragged knob that is no longer shown, and a value that does not exist.
    app.mouse.drag = Some(Grab::Bar(ValueId::Parameter(99)));
    assert_eq!(at(&app, (80, 24), (5, 5)), None);
    let effects = app.update(AppEvent::Mouse(Drag(Left), HitTarget::Text));
    assert!(effects.is_empty());
    let target = HitTarget::Bar { target: ValueId::Parameter(99), value: f64::NAN };
    for act in [Down(Left), Drag(Left), Up(Left), ScrollDown] {
        let effects = app.update(AppEvent::Mouse(act, target));
        let harmless = |e: &phaselab::app::Effect| {
            let phaselab::app::Effect::Execute(command) = e else { return true };
            !matches!(command, Command::Parameter { .. } | Command::MoveParameter { .. })
        };
        assert!(effects.iter().all(harmless), "{effects:?}");
    }
}

#[test]
fn what_is_dragged_is_released_when_the_keys_lead_elsewhere() {
    let size = (120, 40);
    let mut real = Real::of("pendulum");
    let bar = places(&real.app, size, |target| matches!(target, HitTarget::Bar { .. }));
    act(&mut real, size, Down(Left), bar[0]);
    assert!(real.app.mouse.drag.is_some());
    real.press("2");
    assert_eq!(real.app.mouse.drag, None);
    assert_eq!(at(&real.app, size, (20, 20)), Some(HitTarget::Text));
}

/// What no momentum brings to rest, or has an infinite mass there, says so and stays where it is.
#[test]
fn a_mass_that_cannot_rest_says_why() {
    let size = (120, 40);
    for (law, why) in [
        ("p_x + p_x^3 + 1/2*x^2", "no momentum brings it to rest here"),
        ("1/4*p_x^4 + 1/2*x^2", "at rest its mass is infinite"),
    ] {
        let text = format!(
            "title = \"Test\"\n[coordinates]\nx = {{ initial = 0.5, momentum = 0.4 }}\n\
             [hamiltonian]\nH = \"{law}\"\n[[views]]\nkind = \"space\"\n[space]\n\
             shapes = [{{ line = [\"-1\", \"0\", \"0\"], to = [\"1\", \"0\", \"0\"] }}, {{ mass = [\"x\", \"0\", \"0\"], radius = \"0.1\" }}]\n"
        );
        let mut real = Real::with(lowered(&text));
        let before = real.seen().initial.clone();
        let mass = masses(&real.app, size);
        let place = mass[mass.len() / 2];
        act(&mut real, size, Down(Left), place);
        let shown = rows(&screen(&real.app, &rich(), size)).join("\n");
        assert!(shown.contains(why), "{law}: {shown}");
        act(&mut real, size, Drag(Left), (place.0 + 5, place.1));
        act(&mut real, size, Up(Left), (place.0 + 5, place.1));
        assert_eq!(real.seen().initial, before, "{law}");
    }
}
