//! The command that opens the lab as it is set.

use std::sync::Arc;

use phaselab::app::{App, AppEvent, Effect, command_line};
use phaselab::experiment::{Checkpoint, Command};
use phaselab::integrate::Stepping;

use super::mend::rest;
use super::real::Real;
use crate::fixtures::{catalog, in_lab, key, loaded, press};

/// What the key copies.
fn copied(real: &mut Real) -> String {
    let effects = real.app.update(AppEvent::Key(key("Ctrl-y")));
    let text = effects.into_iter().find_map(|effect| match effect {
        Effect::Copy { text, ending: "sh", .. } => Some(text),
        _ => None,
    });
    text.expect("a command is copied")
}

#[test]
fn only_what_differs_from_the_preset_is_in_the_command() {
    let mut real = Real::of("pendulum");
    assert_eq!(copied(&mut real), "phaselab pendulum");
    real.press("Home Enter");
    for digit in ["2", ".", "5", "Enter"] {
        real.press(digit);
    }
    let line = copied(&mut real);
    let (name, value) = line
        .strip_prefix("phaselab pendulum --set ")
        .expect(&line)
        .split_once('=')
        .expect("a value");
    assert_eq!(value, "2.5", "{line}");
    let changed = &real.seen().setup.parameters;
    let index = real.lab().loaded.model.parameter(name).expect("a parameter");
    assert_eq!(changed[index], 2.5);
}

/// The lab that is opened with a start has its values, and runs from them.
#[test]
fn a_lab_begins_with_what_is_asked_for() {
    let loaded = loaded("pendulum", 1);
    let model = Arc::clone(&loaded.model);
    let mut values = model.parameter_values();
    values[0] *= 3.0;
    let mut start = Checkpoint { running: true, ..Checkpoint::default() };
    start.set_parameters(&model, values.iter().copied());
    start.initial = vec![phaselab::experiment::Named { name: "theta'".to_owned(), value: 1.25 }];
    start.method = Some("gauss4".to_owned());
    let line = command_line("pendulum", &start, Stepping::Fixed);
    let (mut app, _) = App::new(catalog(), Some("pendulum"));
    app.start_with("pendulum", start);
    let effects = app.update(AppEvent::Loaded(Ok(loaded.clone())));
    let command = effects.into_iter().find_map(|effect| match effect {
        Effect::Execute(command @ Command::Restore(_)) => Some(command),
        _ => None,
    });
    let mut real = Real::with(loaded);
    real.app = app;
    real.experiment.execute(command.expect("the motion begins as asked"));
    real.look();
    let setup = &real.seen().setup;
    assert_eq!((&setup.parameters, setup.method.as_str()), (&values, "gauss4"));
    assert_eq!(real.seen().state.values[1], 1.25);
    assert_eq!(copied(&mut real), line);
}

#[test]
fn the_command_is_found_by_what_it_is_for() {
    let mut app = in_lab();
    press(&mut app, ": s h a r e");
    let menu = match &app.overlay {
        Some(phaselab::app::Overlay::Menu(menu)) => menu,
        other => panic!("{other:?}"),
    };
    let (_, first) = menu.current().expect("a line");
    assert!(first.label.starts_with("share") || first.about.starts_with("share"), "{first:?}");
}

/// The lab keeps a tolerance beside a method of fixed steps, and the other way round; the command line refuses it.
#[test]
fn only_the_setting_of_the_method_in_force_is_in_the_command() {
    let mut real = Real::of("pendulum");
    real.experiment.execute(Command::Tolerance(1e-9));
    real.look();
    assert_eq!(copied(&mut real), "phaselab pendulum --tolerance 1e-9");
    real.experiment.execute(Command::Method("rk4".to_owned()));
    real.look();
    assert_eq!(copied(&mut real), "phaselab pendulum --method rk4");
    real.experiment.execute(Command::StepSize(0.01));
    real.look();
    assert_eq!(copied(&mut real), "phaselab pendulum --method rk4 --step 0.01");
    real.experiment.execute(Command::Method("dop853".to_owned()));
    real.look();
    assert_eq!(copied(&mut real), "phaselab pendulum --method dop853 --tolerance 1e-9");
}

/// A new system has no file that a command could open; that of the system before it is not copied instead.
#[test]
fn a_new_system_is_saved_first() {
    let mut app = in_lab();
    press(&mut app, "Ctrl-n");
    rest(&mut app);
    press(&mut app, "Esc");
    let effects = app.update(AppEvent::Key(key("Ctrl-y")));
    assert!(!effects.iter().any(|effect| matches!(effect, Effect::Copy { .. })), "{effects:?}");
    let notice = app.notifications.shown.as_ref().map(|notice| notice.text.clone());
    assert!(
        notice.as_ref().is_some_and(|text| text.contains("Save the system first")),
        "{notice:?}"
    );
}

/// A start is for the system that was named with it.
#[test]
fn another_system_begins_as_its_file_says() {
    let start = Checkpoint { method: Some("gauss4".to_owned()), ..Checkpoint::default() };
    let (mut app, _) = App::new(catalog(), Some("pendulum"));
    app.start_with("chain-pendulum", start);
    let effects = app.update(AppEvent::Loaded(Ok(loaded("pendulum", 1))));
    let restores = |effect: &Effect| matches!(effect, Effect::Execute(Command::Restore(_)));
    assert!(!effects.iter().any(restores), "{effects:?}");
}
