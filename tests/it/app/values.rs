//! Values: steps, typed numbers, undo.

use std::sync::Arc;

use phaselab::app::{App, Effect, Event, Over, Target};
use phaselab::experiment::{Command, Snapshot};
use proptest::prelude::*;

use crate::hand::{in_lab, key, pendulum, press, snapshot};

/// Types a text into the field of the first parameter and accepts it: what was asked for, or what is wrong.
fn typed(text: &str) -> (Vec<Effect>, Option<String>, String) {
    let mut app = in_lab();
    press(&mut app, "Enter Ctrl-u");
    for letter in text.chars() {
        app.update(Event::Key(phaselab::app::Key::char(letter)));
    }
    let effects = press(&mut app, "Enter");
    match app.over {
        Some(Over::Field(field)) => (effects, field.mistake, field.input.value().to_owned()),
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
        let (effects, mistake, _) = typed(text);
        assert_eq!(mistake, None, "{text}");
        assert_eq!(effects, [Effect::Tell(Command::Parameter { index: 0, value })], "{text}");
    }
}

#[test]
fn a_bad_value_is_told_and_nothing_is_lost() {
    for (text, told) in [
        ("2x", "`2x` is no number"),
        ("", "is no number"),
        ("theta", "is no number"),
        ("1/0", "is no number"),
        ("ln(-1)", "has no finite value"),
        ("1,5", "a decimal fraction is written with a point"),
    ] {
        let (effects, mistake, kept) = typed(text);
        assert_eq!(effects, [], "{text}");
        let mistake = mistake.unwrap_or_default();
        assert!(mistake.contains(told), "{text}: {mistake}");
        assert_eq!(kept, text);
    }
}

#[test]
fn steps_and_tolerances_must_be_positive() {
    for keys in ["s Ctrl-u 0 Enter", "s Ctrl-u - 1 Enter", "a Ctrl-u 0 Enter", "a Ctrl-u 2 Enter"] {
        let mut app = in_lab();
        assert_eq!(press(&mut app, keys), [], "{keys}");
        assert!(matches!(app.over, Some(Over::Field(f)) if f.mistake.is_some()), "{keys}");
    }
}

#[test]
fn a_value_beyond_its_range_is_taken_and_said() {
    let mut app = in_lab();
    let effects = press(&mut app, "Enter Ctrl-u 9 9 Enter");
    assert_eq!(effects, [Effect::Tell(Command::Parameter { index: 0, value: 99.0 })]);
    assert!(app.notice.is_some_and(|notice| notice.text.contains("0.1 to 5")));
}

#[test]
fn a_long_paste_is_cut_and_said() {
    let mut app = in_lab();
    press(&mut app, "Enter");
    app.update(Event::Paste("7".repeat(1 << 20)));
    let Some(Over::Field(field)) = &app.over else { panic!("the field is gone") };
    assert!(field.input.value().len() <= 4096);
    assert!(app.notice.is_some());
    press(&mut app, "Esc");
    app.update(Event::Paste("q r R".to_owned()));
    assert!(app.over.is_none(), "a paste is no keys");
}

#[test]
fn a_held_key_counts_every_press_before_the_experiment_answers() {
    let mut app = in_lab();
    for _ in 0..10 {
        press(&mut app, "Right");
    }
    let lab = app.lab.as_ref().unwrap();
    assert_eq!(lab.value(Target::Parameter(0)), Some(1.2));
}

/// What an experiment would have made of the commands.
struct Fake {
    app: App,
    seen: Snapshot,
}

impl Fake {
    fn new() -> Self {
        // Without bounds there is no landscape to be surveyed after each change.
        let seen = Snapshot { bounds: [].into(), ..snapshot(&pendulum(), 2.0) };
        Self { app: in_lab(), seen }
    }

    fn obey(&mut self, effects: &[Effect]) {
        let mut parameters = self.seen.parameters.to_vec();
        let mut initial = self.seen.initial.to_vec();
        for effect in effects {
            match effect {
                Effect::Tell(Command::Parameter { index, value }) => parameters[*index] = *value,
                Effect::Tell(Command::Initial { index, value }) => initial[*index] = *value,
                Effect::Tell(Command::FullReset) => {
                    let file = snapshot(&pendulum(), 2.0);
                    (parameters, initial) = (file.parameters.to_vec(), file.initial.to_vec());
                }
                _ => {}
            }
        }
        (self.seen.parameters, self.seen.initial) = (parameters.into(), initial.into());
        self.app.update(Event::Snapshot(Arc::new(self.seen.clone())));
    }

    fn press(&mut self, word: &str) {
        let effects = self.app.update(Event::Key(key(word)));
        self.obey(&effects);
    }

    fn values(&self) -> (Vec<f64>, Vec<f64>) {
        (self.seen.parameters.to_vec(), self.seen.initial.to_vec())
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn undoing_everything_leads_back_to_the_beginning(edits in prop::collection::vec(0..9_usize, 100)) {
        let words = ["Right", "Left", "L", "H", "Down", "Up", "Tab", "Backspace", "R"];
        let mut fake = Fake::new();
        let start = fake.values();
        for edit in edits {
            // The focus stays among the lists of values.
            if words[edit] == "Tab" {
                let word = if fake.app.places().contains(&phaselab::app::keymap::Place::Values)
                    && fake.app.lab.as_ref().unwrap().focus == phaselab::app::Pane::Parameters
                { "Tab" } else { "Shift-Tab" };
                fake.press(word);
            } else {
                fake.press(words[edit]);
            }
        }
        let end = fake.values();
        for _ in 0..100 {
            fake.press("u");
        }
        prop_assert_eq!(fake.values(), start);
        for _ in 0..100 {
            fake.press("U");
        }
        prop_assert_eq!(fake.values(), end);
    }
}
