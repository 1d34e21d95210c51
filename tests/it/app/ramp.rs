//! A parameter changed in the course of time by a key: the ramp is written into the text, and the pane of the action opens.

use phaselab::app::{AppEvent, CheckedText, Effect, Loaded, Overlay, Pane, ValueId};
use phaselab::diagnostic::Document;
use phaselab::experiment::{Command, Experiment, Setup};
use phaselab::num::significant;

use super::real::Real;
use crate::fixtures::{key, lowered};
use crate::screen::{rich, rows, screen};

const OSCILLATOR: &str = "title = \"t\"\n[coordinates]\nq = { initial = 1.0, momentum = 0.0 }\n[parameters]\n\
                          w = { value = 1.0, min = 0.5, max = 5.0 } # a comment\n[hamiltonian]\nH = \"p_q^2/2 + w^2*q^2/2\"\n\
                          [expect]\nconserves = [\"energy\"]\n";

/// Types into the field of the ramp.
fn ask(real: &mut Real, typed: &str) {
    while real.lab().focus.pane != Pane::Parameters {
        real.press("Tab");
    }
    real.press("g");
    for c in typed.chars() {
        let name = if c == ' ' { "Space".to_owned() } else { c.to_string() };
        real.press(&name);
    }
    real.press("Enter");
}

/// The text that is to be checked next.
fn text(real: &mut Real) -> Option<String> {
    let effects = real.app.update(AppEvent::Tick(std::time::Duration::from_millis(20)));
    effects.into_iter().find_map(|effect| match effect {
        Effect::Check { text, .. } => Some(text),
        _ => None,
    })
}

/// The law of a text takes the place of the one before, as once it is checked.
fn rebuild(real: &mut Real, written: &str) {
    let loaded = Loaded { epoch: 2, ..lowered(written) };
    let Loaded { model, equations, system, .. } = &loaded;
    real.experiment = Experiment::new(model, equations, system, Setup::of(model)).unwrap();
    real.experiment.set_epoch(2);
    let took = Some(std::time::Duration::from_millis(800));
    let checked = CheckedText { ticket: 1, outcome: Ok(loaded), took };
    let effects = real.app.update(AppEvent::Checked(Box::new(checked)));
    real.execute(effects);
    real.look();
}

#[test]
fn a_ramp_that_is_typed_is_a_part_of_the_text() {
    let mut real = Real::with(lowered(OSCILLATOR));
    real.run(90);
    ask(&mut real, "2 in 60 cubic");
    assert!(real.app.overlay.is_none(), "{:?}", real.app.overlay);
    let written = text(&mut real).expect("a text to be checked");
    assert!(written.contains("# a comment"), "{written}");
    let read = Document::new("t", &written).read().unwrap_or_else(|_| panic!("{written}"));
    let model = read.model;
    assert!(!model.ramped.is_empty() && !written.contains("[expect]"), "{written}");
    // w goes from 1 at the time of the key to 2 a minute later
    let now = model.observables.iter().find(|o| o.name == "w now").expect("an observable");
    let at = |time: f64| {
        model.pool.evaluate(now.expression, &|s| if s == model.symbols.time { time } else { 1.0 })
    };
    let start = real.seen().time;
    assert!((at(start) - 1.0).abs() < 1e-15 && (at(start + 60.0) - 2.0).abs() < 1e-15);
    assert!((at(start + 15.0) - (1.0 + 3.0 / 16.0 - 2.0 / 64.0)).abs() < 1e-12);
    // the action variable is in view, and the next ramp begins with the same key
    assert_eq!(real.lab().focus.pane, Pane::Parameters);
    let front = *real.lab().focus.recent.first().expect("a picture in front");
    assert_eq!(real.lab().plots[front].kind.name(), "actions");
    real.press("g");
    assert!(matches!(&real.app.overlay, Some(Overlay::Field(_))), "{:?}", real.app.overlay);
}

/// However long the text takes to be rebuilt, the motion continues from where it was seen when the ramp was typed: neither the
/// parameter nor E jumps. The slider shows the value of now.
#[test]
fn a_ramp_begins_where_it_was_asked_for() {
    let mut real = Real::with(lowered(OSCILLATOR));
    real.run(90);
    ask(&mut real, "2 in 0.5 linear");
    let parameters = real.seen().parameters.clone();
    let before = (real.seen().time, real.seen().values.to_vec());
    let written = text(&mut real).expect("a text to be checked");
    // the old law runs on meanwhile, and is not seen
    real.run(50);
    assert_eq!((real.seen().time, real.seen().values.to_vec()), before);
    let status = |real: &Real| rows(&screen(&real.app, &rich(), (120, 40))).join("\n");
    let held = status(&real);
    assert!(held.contains("waiting") && !held.contains("running"), "{held}");
    rebuild(&mut real, &written);
    assert_eq!(real.seen().time, before.0);
    assert!(!status(&real).contains("waiting"), "{}", status(&real));
    let value = |real: &Real, name: &str| {
        let channels = real.lab().loaded.system.channels();
        real.seen().values[channels.iter().position(|c| c.name == name).expect(name)]
    };
    assert_eq!((value(&real, "q"), value(&real, "p_q")), (before.1[0], momentum(&before.1)));
    assert_eq!(value(&real, "w now"), 1.0);
    let energy = value(&real, "energy");
    assert!((energy - 0.5).abs() < 1e-14, "{energy}");
    // halfway, the slider is there too, and keys change what it was before
    real.experiment.execute(Command::Play);
    real.run(15);
    let place = ValueId::Parameter(0);
    let expected = 1.0 + (real.seen().time - before.0) / 0.5;
    let now = real.lab().current_value(place).expect("a value");
    assert!((now - expected).abs() < 1e-12 && (now - 1.5).abs() < 0.1, "{now}, {expected}");
    assert_eq!(real.lab().value(place), Some(parameters[0]));
    let screen = rows(&screen(&real.app, &rich(), (120, 40))).join("\n");
    assert!(
        screen.contains(&significant(now, 6, 1e-4..1e6)) && screen.contains("ramped"),
        "{screen}"
    );
    // a second ramp holds the motion as well, though it was restored for the first
    ask(&mut real, "3 in 1");
    let held = real.seen().time;
    real.run(20);
    assert_eq!(real.seen().time, held);
}

/// A motion that is begun while a ramp waits for its law is not taken back when that is there.
#[test]
fn a_reset_while_a_ramp_waits_stays() {
    let mut real = Real::with(lowered(OSCILLATOR));
    real.run(90);
    ask(&mut real, "2 in 0.5 linear");
    let written = text(&mut real).expect("a text to be checked");
    let held = real.seen().time;
    real.run(20);
    assert_eq!(real.seen().time, held);
    real.press("r");
    real.run(5);
    assert!(real.seen().time < 0.5 * held, "{} {held}", real.seen().time);
    rebuild(&mut real, &written);
    assert!(real.seen().time < 0.5 * held, "{} {held}", real.seen().time);
}

/// p in the row of the oscillator before the ramp: q, q̇, p.
fn momentum(row: &[f64]) -> f64 {
    row[2]
}

#[test]
fn what_is_no_ramp_is_refused() {
    for (typed, why) in [
        ("2", "the duration"),
        ("2 in 0", "above zero"),
        ("two in 3", "is not a number"),
        ("2 in 3 cubical", "is not a number"),
    ] {
        let mut real = Real::with(lowered(OSCILLATOR));
        ask(&mut real, typed);
        let Some(Overlay::Field(field)) = &real.app.overlay else { panic!("{typed}") };
        assert!(
            field.diagnostic.as_ref().is_some_and(|m| m.contains(why)),
            "{:?}",
            field.diagnostic
        );
        real.press_key(key("Esc"));
        assert!(text(&mut real).is_none());
    }
}

/// A second ramp continues what is known of the first: J and E are compared with what they were before any ramp, and with
/// what they were when the last one began.
#[test]
fn a_second_ramp_by_the_key_keeps_what_the_first_has_changed() {
    // a mass that is changed fast changes J, and one that goes to where it is does not
    let text = "Open slow-oscillator\nSize 120x40\nPress g\nType \"4 in 1\"\nPress Enter\nWait 3s\nAssert actions.change > 2\n\
                Press g\nType \"4 in 1\"\nPress Enter\nWait 2s\nAssert actions.change > 2\n\
                Assert actions.last_change < 0.01\nAssert actions.last_change > -0.01\n";
    crate::record::played("slow-oscillator", text);
}
