//! An expression typed above the list of quantities becomes the axis of the plot. It belongs to the view: neither the text of
//! the system nor what is saved of it changes.

use std::time::Duration;

use phaselab::app::{App, AppEvent, Effect, Overlay};

use crate::fixtures::{catalog, checked, judged, lab, loaded, press, write};
use crate::screen::{rich, rows, screen};

/// Focuses the first phase plane.
fn focus(app: &mut App) {
    while app.lab.as_ref().unwrap().focused_plot().is_none_or(|(_, p)| p.kind.name() != "phase") {
        press(app, "Tab");
    }
}

/// Focuses the first phase plane and types into its list.
fn ask(app: &mut App, typed: &str) -> Vec<Effect> {
    focus(app);
    press(app, "v");
    write(app, typed)
}

/// The channels of the axes of the focused plot, by name.
fn axes(app: &App) -> Vec<String> {
    let lab = app.lab.as_ref().unwrap();
    let (_, plot) = lab.focused_plot().expect("a plot");
    let name =
        |axis: usize| plot.column(axis).map(|c| lab.loaded.system.channels()[c].name.clone());
    [0, 1].into_iter().filter_map(name).collect()
}

#[test]
fn an_expression_can_be_typed_for_either_axis() {
    let mut app = lab("double-pendulum", 1.0);
    ask(&mut app, "theta1 - 2 theta2");
    let text = checked(&mut app);
    assert!(text.contains("expression = \"theta1 - 2 theta2\""), "{text}");
    // the vertical axis is asked for next
    assert!(matches!(app.overlay, Some(Overlay::Menu(_))));
    write(&mut app, "theta1'^2");
    let text = checked(&mut app);
    assert!(text.contains("\"theta1 - 2 theta2\"") && text.contains("\"theta1'^2\""), "{text}");
    assert!(app.overlay.is_none());
    assert_eq!(axes(&app), ["θ₁ − 2 θ₂", "theta1'^2"]);
    // the text is what it was, in the lab and in the editor
    let own = loaded("double-pendulum", 1).document.text.clone();
    assert_eq!(app.lab.as_ref().unwrap().loaded.document.text, own);
    press(&mut app, "E");
    assert_eq!(app.open_buffer().expect("a buffer").editor.text(), own);
    assert!(app.workbench.unsaved().is_empty());
    // an edit of the text keeps the axes, and is checked together with them
    press(&mut app, "End # x");
    app.update(AppEvent::Tick(Duration::from_millis(140)));
    let text = checked(&mut app);
    assert!(text.contains("\"theta1'^2\"") && text.contains("#x"), "{text}");
    press(&mut app, "Esc");
    assert_eq!(axes(&app), ["θ₁ − 2 θ₂", "theta1'^2"]);
}

/// What was typed is stored with the session, and is on its axes again when that is resumed.
#[test]
fn a_typed_axis_is_resumed_with_the_session() {
    let mut app = lab("double-pendulum", 1.0);
    ask(&mut app, "theta1 - 2 theta2");
    checked(&mut app);
    write(&mut app, "theta1'^2");
    checked(&mut app);
    let saved = app.saved().expect("a session");
    assert!(!saved.edited);
    let (mut again, _) = App::new(catalog(), Some("double-pendulum"));
    again.resume(saved);
    again.update(AppEvent::Loaded(Ok(loaded("double-pendulum", 1))));
    let text = checked(&mut again);
    assert!(text.contains("\"theta1'^2\""), "{text}");
    assert_eq!(axes(&again), ["θ₁ − 2 θ₂", "theta1'^2"]);
    assert_eq!(
        again.lab.as_ref().unwrap().loaded.document.text,
        loaded("double-pendulum", 1).document.text
    );
}

/// A session with a wrong text has its axes again once the text is right, also when it was left and resumed in between.
#[test]
fn a_typed_axis_waits_until_a_wrong_text_is_right() {
    let mut app = lab("double-pendulum", 1.0);
    ask(&mut app, "theta1 - 2 theta2");
    checked(&mut app);
    write(&mut app, "theta1'^2");
    checked(&mut app);
    press(&mut app, "E Ctrl-End Enter w r o n g");
    app.update(AppEvent::Tick(Duration::from_millis(140)));
    assert!(!judged(&mut app).1);
    for _ in 0..2 {
        let (mut again, _) = App::new(catalog(), Some("double-pendulum"));
        again.workbench.put(app.unsaved());
        let saved = app.saved().expect("a session");
        assert!(saved.edited);
        again.resume(saved);
        again.update(AppEvent::Loaded(Ok(loaded("double-pendulum", 1))));
        assert!(!judged(&mut again).1);
        assert_ne!(axes(&again), ["θ₁ − 2 θ₂", "theta1'^2"]);
        app = again;
    }
    press(&mut app, "E Ctrl-End");
    press(&mut app, "Backspace Backspace Backspace Backspace Backspace Esc");
    app.update(AppEvent::Tick(Duration::from_millis(140)));
    checked(&mut app);
    assert_eq!(axes(&app), ["θ₁ − 2 θ₂", "theta1'^2"]);
}

/// A text that an axis no longer fits runs without it, and that is said; what still fits stays.
#[test]
fn an_axis_that_no_longer_fits_the_text_is_given_up() {
    let mut app = lab("double-pendulum", 1.0);
    ask(&mut app, "m2*theta1");
    checked(&mut app);
    write(&mut app, "theta1'^2");
    checked(&mut app);
    assert_eq!(app.lab.as_ref().unwrap().typed.len(), 2);
    let own = app.lab.as_ref().unwrap().loaded.document.text.clone();
    app.update(AppEvent::FileRead { text: own.replace("m2", "mass2"), asked: false });
    let (text, is_right) = judged(&mut app);
    assert!(text.contains("m2*theta1") && !is_right, "{text}");
    let shown = app.notifications.shown.as_ref().map(|one| &*one.text);
    let sentence =
        "`m₂·θ₁` was removed from its axis: the text no longer defines all of its names.";
    assert_eq!(shown, Some(sentence));
    let text = checked(&mut app);
    assert!(!text.contains("m2*theta1") && text.contains("mass2"), "{text}");
    assert!(text.contains("theta1'^2"), "{text}");
    let names = |app: &App| {
        let typed = app.lab.as_ref().unwrap().typed.iter();
        typed.map(|one| one.name.clone()).collect::<Vec<_>>()
    };
    assert_eq!(names(&app), ["theta1'^2"]);
    // the picture that had it is that of the file again, the others are what they were
    let mut fresh = lab("double-pendulum", 1.0);
    focus(&mut fresh);
    assert_eq!(axes(&app), axes(&fresh));
}

/// One sentence names all that are given up together.
#[test]
fn axes_that_no_longer_fit_the_text_are_named_together() {
    let mut app = lab("double-pendulum", 1.0);
    ask(&mut app, "m2*theta1");
    checked(&mut app);
    write(&mut app, "m2*theta2");
    checked(&mut app);
    let own = app.lab.as_ref().unwrap().loaded.document.text.clone();
    app.update(AppEvent::FileRead { text: own.replace("m2", "mass2"), asked: false });
    assert!(!judged(&mut app).1);
    let shown = app.notifications.shown.as_ref().map(|one| &*one.text);
    let sentence = "`m₂·θ₁`, `m₂·θ₂` were removed from their axes: the text no longer defines all of their names.";
    assert_eq!(shown, Some(sentence));
}

/// What the system has already needs no change of the text, however it is written.
#[test]
fn a_quantity_that_is_there_is_taken_as_it_is() {
    let mut app = lab("double-pendulum", 1.0);
    ask(&mut app, "0 + theta2");
    let effects = app.update(AppEvent::Tick(Duration::from_millis(20)));
    assert!(!effects.iter().any(|effect| matches!(effect, Effect::Check { .. })));
    write(&mut app, "1*theta1");
    assert_eq!(axes(&app), ["theta2", "theta1"]);
}

#[test]
fn what_is_no_expression_is_refused_and_the_list_stays() {
    let mut app = lab("double-pendulum", 1.0);
    ask(&mut app, "thetta1 - theta2");
    let reported = app.notifications.shown.take().map(|notice| notice.text).unwrap_or_default();
    assert!(reported.contains("unknown name `thetta1`"), "{reported}");
    assert!(matches!(app.overlay, Some(Overlay::Menu(_))));
}

/// A new variable of a transformation that no view draws is a quantity like any other: no text is changed for it.
#[test]
fn a_new_variable_that_is_typed_is_taken_as_it_is() {
    let mut app = lab("angle-of-the-oscillator", 1.0);
    ask(&mut app, "1*X");
    let effects = app.update(AppEvent::Tick(Duration::from_millis(20)));
    assert!(!effects.iter().any(|effect| matches!(effect, Effect::Check { .. })));
    assert!(matches!(app.overlay, Some(Overlay::Menu(_))));
    write(&mut app, "0 + Y");
    assert_eq!(axes(&app), ["X", "Y"]);
}

/// Two places are a plane with one scale, also where they are chosen one after the other.
#[test]
fn a_plane_whose_axes_are_chosen_has_one_scale() {
    for [x, y, expected] in [["0 + x", "1*y", "Plane"], ["0 + x", "1*p_x", "Phase"]] {
        let mut app = lab("restricted-three-body", 1.0);
        ask(&mut app, x);
        write(&mut app, y);
        let lab = app.lab.as_ref().unwrap();
        let (_, plot) = lab.focused_plot().expect("a plot");
        assert_eq!(plot.viewport().map(|v| v.equal), Some(expected == "Plane"), "{y} over {x}");
        let shown = rows(&screen(&app, &rich(), (120, 40))).concat();
        assert!(shown.contains(expected), "{y} over {x}: {shown}");
    }
}
