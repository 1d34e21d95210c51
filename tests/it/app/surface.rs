//! The surface of a section typed in the lab, and the direction of its crossings turned by a key.

use phaselab::app::{App, Overlay};
use phaselab::model::Direction;

use crate::fixtures::{checked, lab, lowered, press, showing, write};

/// Focuses the first plot of a kind.
fn focus(app: &mut App, kind: &str) {
    while app.lab.as_ref().unwrap().focused_plot().is_none_or(|(_, p)| p.kind.name() != kind) {
        press(app, "Tab");
    }
}

/// What is open to type into.
fn typed(app: &App) -> String {
    match &app.overlay {
        Some(Overlay::Field(field)) => field.input.value().to_owned(),
        other => panic!("{other:?}"),
    }
}

fn said(app: &App) -> String {
    match &app.overlay {
        Some(Overlay::Field(field)) => field.diagnostic.clone().unwrap_or_default(),
        _ => String::new(),
    }
}

/// The surface and direction of the focused section.
fn shown(app: &App) -> (String, Direction) {
    let lab = app.lab.as_ref().unwrap();
    let (_, plot) = lab.focused_plot().expect("a plot");
    let view = &lab.loaded.model.views[plot.view.expect("a view")];
    let on = view.axes.last().unwrap()[0].written.clone();
    (on, lab.loaded.model.sections[view.section.unwrap()].direction)
}

#[test]
fn the_surface_of_a_section_is_typed() {
    let mut app = lab("henon-heiles", 1.0);
    focus(&mut app, "section");
    press(&mut app, "L");
    assert_eq!(typed(&app), "x = 0, rising");
    write(&mut app, "y = 0.1, falling");
    let text = checked(&mut app);
    assert!(
        text.contains("on = \"y - 0.1\"") && text.contains("direction = \"falling\""),
        "{text}"
    );
    // the file's title and ranges were those of another surface
    assert!(!text.contains("Section x = 0"), "{text}");
    assert_eq!(shown(&app), ("y - 0.1".to_owned(), Direction::Falling));
    assert!(app.overlay.is_none());
    // y, which it holds, was an axis
    let lab = app.lab.as_ref().unwrap();
    let (_, plot) = lab.focused_plot().unwrap();
    let axes = [0, 1].map(|k| lab.loaded.system.channels()[plot.column(k).unwrap()].name.as_str());
    assert_eq!(axes, ["x", "p_x"]);
    assert!(text.contains("x = \"x\"") && text.contains("y = \"p_x\""), "{text}");
    // and so it is when it is asked for again
    press(&mut app, "L");
    assert_eq!(typed(&app), "y - 0.1 = 0, falling");
}

#[test]
fn the_direction_is_turned_by_a_key() {
    let mut app = lab("henon-heiles", 1.0);
    focus(&mut app, "section");
    for expected in [Direction::Falling, Direction::Either, Direction::Rising] {
        press(&mut app, "|");
        let text = checked(&mut app);
        assert!(text.contains("Section x = 0"), "the surface is the same: {text}");
        assert_eq!(shown(&app), ("x".to_owned(), expected));
    }
    focus(&mut app, "phase");
    press(&mut app, "|");
    assert!(
        app.notifications.shown.as_ref().unwrap().text.contains("Only a section has a direction")
    );
}

/// An angle passes a value once in a turn, in either direction; the sine of half of it vanishes there alone.
#[test]
fn an_angle_passes_a_value_once_in_a_turn() {
    let mut app = lab("double-pendulum", 1.0);
    focus(&mut app, "section");
    press(&mut app, "L");
    write(&mut app, "theta2 = pi/2, rising");
    assert!(said(&app).contains("theta2 is an angle"), "{}", said(&app));
    for _ in 0.."theta2 = pi/2, rising".len() {
        press(&mut app, "Backspace");
    }
    write(&mut app, "theta2 = pi/2");
    checked(&mut app);
    assert_eq!(shown(&app), ("sin((theta2 - (pi/2))/2)".to_owned(), Direction::Either));
    // of a period of one's own, whatever its parameters become; what is offered of it is accepted
    let text = "title = \"turns\"\n[coordinates]\na = { initial = 0.3, velocity = 1.0, period = \"P\" }\n\
                b = { initial = 0.3, velocity = 1.0 }\n[parameters]\nP = 3.0\n[lagrangian]\n\
                L = \"1/2*(a'^2 + b'^2) - 1/2*b^2\"\n[[views]]\nkind = \"section\"\non = \"a\"\nx = \"b\"\ny = \"p_b\"\n";
    for (typed, surface) in [("a = 1", "sin((a - 1)/(P/pi))"), ("", "sin((a)/(P/pi))")] {
        let mut app = showing(lowered(text), 1.0);
        focus(&mut app, "section");
        press(&mut app, "L");
        if typed.is_empty() {
            press(&mut app, "Enter");
        } else {
            press(&mut app, "Ctrl-u");
            write(&mut app, typed);
        }
        checked(&mut app);
        assert_eq!(shown(&app), (surface.to_owned(), Direction::Either), "{typed}");
    }
}

/// Every period of time, and every time an event happens.
#[test]
fn a_section_may_be_a_stroboscope_or_an_event() {
    let mut app = lab("duffing", 1.0);
    focus(&mut app, "section");
    press(&mut app, "L");
    write(&mut app, "every 2*pi/w, falling");
    checked(&mut app);
    assert_eq!(shown(&app), ("sin(2*pi*t/(2*pi/w))".to_owned(), Direction::Falling));
    press(&mut app, "L");
    write(&mut app, "event bounce");
    assert!(said(&app).contains("no events"), "{}", said(&app));
    let mut app = lab("bouncing-ball", 0.2);
    focus(&mut app, "phase");
    press(&mut app, "L");
    let event = app.lab.as_ref().unwrap().loaded.model.events[0].clone();
    write(&mut app, &format!("event {}", event.name));
    checked(&mut app);
    assert_eq!(shown(&app).1, event.direction);
}

/// Where a plot shows no section, it becomes one of its own two quantities.
#[test]
fn a_plot_without_a_section_becomes_one() {
    let mut app = lab("spherical-pendulum", 1.0);
    focus(&mut app, "phase");
    press(&mut app, "L");
    assert_eq!(typed(&app), "");
    write(&mut app, "phi = 0 = 1");
    assert!(!said(&app).is_empty());
    press(&mut app, "Esc");
    press(&mut app, "L");
    write(&mut app, "sin(phi) = 0, up");
    let text = checked(&mut app);
    assert!(
        text.contains("kind = \"section\"") && text.contains("direction = \"rising\""),
        "{text}"
    );
    let lab = app.lab.as_ref().unwrap();
    let (_, plot) = lab.focused_plot().unwrap();
    assert!(plot.kind.properties().is_section);
    assert_eq!(shown(&app), ("sin(phi)".to_owned(), Direction::Rising));
}

#[test]
fn what_is_no_surface_is_refused_and_the_field_stays() {
    let mut app = lab("henon-heiles", 1.0);
    focus(&mut app, "section");
    press(&mut app, "L");
    write(&mut app, "z = 0");
    assert!(said(&app).contains("unknown name `z`"), "{}", said(&app));
    press(&mut app, "Esc");
    for (typed, words) in [
        ("x", "Write x = 0"),
        ("x = 0, sideways", "is not a direction"),
        ("max(y, z) = 0", "unknown name `z`"),
    ] {
        press(&mut app, "L");
        write(&mut app, typed);
        assert!(said(&app).contains(words), "{typed}: {}", said(&app));
        press(&mut app, "Esc");
    }
}
