//! The last lines: keys of what is hidden, what Space does, a step that is longer than the motion.

use super::{ascii, rich, rows, screen};
use crate::app::real::Real;

/// The last row of a screen.
fn footer(real: &Real, size: (u16, u16)) -> String {
    rows(&screen(&real.app, &rich(), size)).pop().expect("a footer")
}

/// Where panes are hidden behind others, the key that leads to them comes first, however little room there is.
#[test]
fn tab_comes_first_where_panes_are_hidden() {
    for name in ["planet", "double-pendulum", "kicked-rotor"] {
        let real = Real::of(name);
        let hidden = footer(&real, (80, 24));
        let [tab, turn, choose] = ["Tab pane", "\\ tabs", "choose"].map(|word| hidden.find(word));
        assert!(tab.is_some() && choose.is_none_or(|at| tab.unwrap() < at), "{name}: {hidden}");
        assert!(turn.map_or(name != "planet", |at| Some(at) > tab), "{name}: {hidden}");
    }
    // two pictures, three lists and the law all have a place of their own
    let real = Real::of("harmonic-oscillator");
    let all = footer(&real, (300, 90));
    assert!(all.find("choose") < all.find("Tab pane"), "{all}");
    assert!(!all.contains("tabs"), "{all}");
}

/// How to pause is said on a standard screen, too.
#[test]
fn the_pause_is_in_the_footer_of_a_standard_screen() {
    let real = Real::of("pendulum");
    let footer = footer(&real, (80, 24));
    assert!(footer.ends_with("Space pause   ? help   q quit"), "{footer:?}");
    assert!(footer.contains("Tab pane"), "{footer}");
}

#[test]
fn space_resumes_what_it_has_paused() {
    let mut real = Real::of("pendulum");
    real.press("Space");
    let paused = footer(&real, (120, 40));
    assert!(paused.contains("Space resume") && !paused.contains("pause"), "{paused}");
    real.press("Space");
    let running = footer(&real, (120, 40));
    assert!(running.contains("Space pause") && !running.contains("resume"), "{running}");
}

/// A free particle is carried on by one step for as long as anybody looks: no rate of steps is reported of it.
#[test]
fn a_step_longer_than_the_motion_is_called_so() {
    for (name, longer) in [("free-particle", true), ("double-pendulum", false)] {
        let mut real = Real::of(name);
        real.run(120);
        let status = &rows(&screen(&real.app, &rich(), (120, 40)))[38];
        assert_eq!(status.contains("longer than the motion so far"), longer, "{status}");
        assert_eq!(status.contains("steps/s"), !longer, "{status}");
        assert!(status.contains("taylor step "), "{status}");
    }
}

/// What the motion has left is not told as its law.
#[test]
fn a_law_of_a_released_constraint_says_so() {
    let mut real = Real::of("smooth-sphere");
    let says_so = |real: &Real| {
        let text = rows(&screen(&real.app, &rich(), (200, 70))).join("\n");
        text.contains("While the constraint sphere holds")
    };
    assert!(!says_so(&real));
    // speed 0.2: at 0.8 s it flies
    real.run(240);
    assert_eq!(real.seen().released, [0]);
    assert!(says_so(&real));
}

/// While a value is typed its range is still there, and so is its unit.
#[test]
fn the_range_stays_while_a_value_is_typed() {
    let mut real = Real::of("pendulum");
    for size in [(80, 24), (120, 40)] {
        let before = footer(&real, size);
        assert!(before.contains("0.1 to 5"), "{size:?}: {before}");
        real.press("Enter");
        let typing = footer(&real, size);
        assert!(typing.contains("m = ") && typing.contains("0.1 to 5 kg"), "{size:?}: {typing}");
        real.press("Esc");
    }
}

/// An initial value that follows a parameter says which, until it is changed by itself.
#[test]
fn an_initial_value_that_follows_a_parameter_says_which() {
    let mut real = Real::of("pendulum");
    let text = |real: &Real| rows(&screen(&real.app, &rich(), (120, 40))).join("\n");
    assert!(text(&real).contains("= θ₀"), "{}", text(&real));
    real.press("Tab");
    assert!(text(&real).contains("= θ₀, initial coordinate;"), "{}", text(&real));
    real.press("Right");
    let changed = text(&real);
    assert!(!changed.contains("= θ₀"), "{changed}");
}

/// In ASCII the formula has the names of the file, which can be typed, and no spelt symbols.
#[test]
fn an_initial_value_in_ascii_follows_a_name_that_can_be_typed() {
    let real = Real::of("heavy-top");
    let shown = rows(&screen(&real.app, &ascii(), (120, 40))).join("\n");
    assert!(shown.contains("= dphi0") && !shown.contains("phi0'"), "{shown}");
}
