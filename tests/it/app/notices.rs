//! Notifications: what was said about a motion ends with it, and nothing is said twice.

use std::time::Duration;

use crossterm::event::{MouseButton, MouseEventKind};
use phaselab::app::{AppEvent, HitTarget};

use super::real::Real;

/// The sentence that is shown.
fn said(real: &Real) -> String {
    real.app.notifications.shown.as_ref().map(|notice| notice.text.clone()).unwrap_or_default()
}

/// The pendulum after g was changed: the energy has jumped.
fn jumped() -> Real {
    let mut real = Real::of("pendulum");
    real.run(30);
    real.press("Down Down Right");
    assert!(said(&real).contains("energy jumped"), "{}", said(&real));
    real
}

#[test]
fn what_was_said_of_a_motion_ends_where_another_begins() {
    let click = |real: &mut Real| {
        let kind = |plot: &phaselab::instrument::Plot| plot.kind.name() == "phase";
        let index = real.lab().plots.iter().position(kind).expect("a phase portrait");
        let hit = HitTarget::Plot { index, place: [0.5, 0.5], at: [0.5, 0.25] };
        for kind in [MouseEventKind::Down(MouseButton::Left), MouseEventKind::Up(MouseButton::Left)]
        {
            let effects = real.app.update(AppEvent::Mouse(kind, hit));
            real.execute(effects);
            real.look();
        }
        assert_eq!(real.seen().values[0], 0.5);
    };
    let mut real = jumped();
    click(&mut real);
    assert_eq!(said(&real), "");
    for keys in ["r", "R", "Tab Right", "Tab Enter 1 Enter"] {
        let mut real = jumped();
        real.press(keys);
        assert_eq!(real.seen().time, 0.0, "{keys}");
        assert_eq!(said(&real), "", "{keys}");
    }
    // what is said of the new motion stays
    let mut real = jumped();
    real.press("Tab Right");
    real.press("u");
    assert!(said(&real).starts_with("undone"), "{}", said(&real));
    // the motion goes on: what was said of it holds
    let mut real = jumped();
    real.press("Space");
    assert!(said(&real).contains("energy jumped"));
}

#[test]
fn a_jump_that_replaces_another_repeats_nothing_before_it() {
    let mut real = Real::of("struck-pendulum");
    while !said(&real).starts_with("impulse") {
        real.run(10);
    }
    real.press("Right");
    real.app.update(AppEvent::Tick(Duration::from_secs(3)));
    assert!(said(&real).contains("energy jumped"), "{}", said(&real));
    real.press("Right Right Right");
    assert!(said(&real).contains("energy jumped"), "{}", said(&real));
    for _ in 0..8 {
        real.app.update(AppEvent::Tick(Duration::from_secs(3)));
        assert!(!said(&real).starts_with("impulse"), "it was said before: {}", said(&real));
    }
    assert_eq!(said(&real), "");
}
