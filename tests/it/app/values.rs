//! Values: steps, typed numbers, undo.

use phaselab::app::{AppEvent, Effect, Overlay, ValueId};
use phaselab::experiment::Command;

use crate::fixtures::{in_lab, press};

/// Types a text into the field of the first parameter and accepts it; returns the effects and the error.
fn typed(text: &str) -> (Vec<Effect>, Option<String>, String) {
    let mut app = in_lab();
    press(&mut app, "Enter Ctrl-u");
    for letter in text.chars() {
        app.update(AppEvent::Key(phaselab::app::key::character(letter)));
    }
    let effects = press(&mut app, "Enter");
    match app.overlay {
        Some(Overlay::Field(field)) => (effects, field.diagnostic, field.input.value().to_owned()),
        _ => (effects, None, String::new()),
    }
}

#[test]
fn a_typed_value_may_be_any_expression_in_parameters() {
    for (text, value) in [
        ("3", 3.0),
        (".5", 0.5),
        ("1e-3", 1e-3),
        ("pi/2", std::f64::consts::FRAC_PI_2),
        ("2*l", 2.0),
        ("sqrt(2)", std::f64::consts::SQRT_2),
        ("-1", -1.0),
    ] {
        let (effects, diagnostic, _) = typed(text);
        assert_eq!(diagnostic, None, "{text}");
        assert_eq!(effects, [Effect::Execute(Command::Parameter { index: 0, value })], "{text}");
    }
}

#[test]
fn a_bad_value_is_reported_and_nothing_is_lost() {
    for (text, reported) in [
        ("2x", "`2x` is not a number"),
        ("", "is not a number"),
        ("theta", "is not a number"),
        ("1/0", "is not a number"),
        ("ln(-1)", "has no finite value"),
        ("1,5", "a decimal fraction is written with a point"),
    ] {
        let (effects, diagnostic, kept) = typed(text);
        assert_eq!(effects, [], "{text}");
        let diagnostic = diagnostic.unwrap_or_default();
        assert!(diagnostic.contains(reported), "{text}: {diagnostic}");
        assert_eq!(kept, text);
    }
}

#[test]
fn steps_and_tolerances_must_be_positive() {
    for keys in ["s 0 Enter", "s - 1 Enter", "a 0 Enter", "a 2 Enter"] {
        let mut app = in_lab();
        if keys.starts_with('s') {
            press(&mut app, ": m e t h o d Space r k 4 Enter");
        }
        assert_eq!(press(&mut app, keys), [], "{keys}");
        assert!(matches!(app.overlay, Some(Overlay::Field(f)) if f.diagnostic.is_some()), "{keys}");
    }
}

/// A method asks only for the settings that it uses, and the others are refused with an explanation.
#[test]
fn a_method_is_asked_only_for_what_it_uses() {
    for (keys, reported) in [
        ("s", "taylor chooses its steps itself; its tolerance is set by a."),
        (": m e t h o d Space r k 4 Enter a", "rk4 has no tolerance; its step is set by s."),
    ] {
        let mut app = in_lab();
        press(&mut app, keys);
        assert!(app.overlay.is_none(), "{keys}");
        assert_eq!(app.notifications.shown.map(|notice| notice.text).as_deref(), Some(reported));
    }
}

#[test]
fn a_value_beyond_its_range_is_taken_and_said() {
    let mut app = in_lab();
    let effects = press(&mut app, "Enter Ctrl-u 9 9 Enter");
    assert_eq!(effects, [Effect::Execute(Command::Parameter { index: 0, value: 99.0 })]);
    let said = |app: &phaselab::app::App| {
        app.notifications.shown.as_ref().map(|notice| notice.text.clone())
    };
    assert!(said(&app).is_some_and(|text| text.contains("0.1 to 5")));
    // and no longer once it is within the range
    press(&mut app, "Enter Ctrl-u 2 Enter");
    assert_eq!(said(&app), None);
}

#[test]
fn a_long_paste_is_cut_and_said() {
    let mut app = in_lab();
    press(&mut app, "Enter");
    app.update(AppEvent::Paste("7".repeat(1 << 20)));
    let Some(Overlay::Field(field)) = &app.overlay else { panic!("the field is gone") };
    assert!(field.input.value().len() <= 4096);
    assert!(app.notifications.shown.is_some());
    press(&mut app, "Esc");
    app.update(AppEvent::Paste("q r R".to_owned()));
    assert!(app.overlay.is_none(), "a paste is no keys");
}

#[test]
fn a_held_key_counts_every_press_before_the_experiment_answers() {
    let mut app = in_lab();
    for _ in 0..10 {
        press(&mut app, "Right");
    }
    let lab = app.lab.as_ref().unwrap();
    assert_eq!(lab.value(ValueId::Parameter(0)), Some(1.2));
}

/// The steps of a key that is held are one change, whose jump of the energy is reported; after a while another one begins.
#[test]
fn steps_that_follow_each_other_are_one_change_for_the_experiment() {
    let mut app = in_lab();
    let values = [1.02, 1.04, 1.06];
    let [first, second, third] = values.map(|value| {
        if value > 1.05 {
            press(&mut app, "Wait");
        }
        press(&mut app, "Right")
    });
    let begins = |effects: &[Effect]| {
        effects.iter().find_map(|effect| match effect {
            Effect::Execute(Command::Parameter { index: 0, .. }) => Some(true),
            Effect::Execute(Command::MoveParameter { index: 0, .. }) => Some(false),
            _ => None,
        })
    };
    assert_eq!(
        [first, second, third].map(|effects| begins(&effects)),
        [Some(true), Some(false), Some(true)]
    );
}
