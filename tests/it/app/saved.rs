//! Sessions as data: the application is restored as it was left, and so is the view of a rebuilt system.

use std::sync::Arc;

use phaselab::app::{Above, App, AppEvent, Effect, LeastRange, Page, Pane, Saved};
use phaselab::experiment::Command;

use crate::fixtures::{catalog, in_lab, lowered, pendulum, press, rebuild, snapshot};

/// A session after writing and reading.
fn kept(app: &App) -> Saved {
    let saved = app.saved().expect("a lab is open");
    let text = toml::to_string(&saved).expect("it can be written");
    let read: Saved = toml::from_str(&text).expect("it can be read");
    assert_eq!(read, saved, "{text}");
    read
}

fn resumed(saved: Saved) -> (App, Vec<Effect>) {
    let (mut app, _) = App::new(catalog(), Some(&saved.open));
    app.resume(saved);
    let effects = app.update(AppEvent::Loaded(Ok(pendulum())));
    app.update(AppEvent::Snapshot(Arc::new(snapshot(&pendulum(), 2.0))));
    (app, effects)
}

#[test]
fn what_was_looked_at_is_looked_at_again() {
    let mut app = in_lab();
    // a phase plot, zoomed and panned, with a cursor
    press(&mut app, "Tab Tab Tab");
    press(&mut app, "+ + x Right c g z");
    let saved = kept(&app);
    let (again, effects) = resumed(saved.clone());
    let (lab, before) = (again.lab.as_ref().unwrap(), app.lab.as_ref().unwrap());
    assert_eq!(lab.plots, before.plots);
    assert_eq!(
        (lab.focus.pane, lab.focus.zoomed, lab.selection),
        (before.focus.pane, true, before.selection)
    );
    // what was in front of other pictures is so again, wherever the focus is
    press(&mut app, "Tab Tab Tab");
    let in_front = |app: &App| app.lab.as_ref().unwrap().focused_before().collect::<Vec<_>>();
    assert!(!in_front(&app).is_empty());
    assert_eq!(in_front(&resumed(kept(&app)).0), in_front(&app));
    assert_eq!(effects, [Effect::Execute(Command::Restore(Box::new(saved.checkpoint)))]);
    press(&mut app, "2");
    assert_eq!(resumed(kept(&app)).0.page, Page::Equations);
}

/// A user who leaves by the list of systems can continue with the previous system.
#[test]
fn the_list_of_systems_keeps_what_was_left() {
    let mut app = in_lab();
    let left = kept(&app);
    press(&mut app, "Esc Esc");
    assert_eq!(app.page, Page::Picker);
    assert_eq!(kept(&app), left);
    // a system that is only previewed is not part of it
    press(&mut app, "Down");
    app.update(AppEvent::Snapshot(Arc::new(snapshot(&pendulum(), 3.0))));
    assert_eq!(kept(&app), left);
    let (app, _) = App::new(catalog(), None);
    assert_eq!(app.saved(), None);
}

#[test]
fn another_system_than_the_session_s_begins_as_always() {
    let saved = Saved { open: "planet".to_owned(), ..kept(&in_lab()) };
    let (app, effects) = resumed(saved);
    assert_eq!(effects, [Effect::Execute(Command::Play)]);
    assert_eq!(app.lab.unwrap().focus.pane, Pane::Parameters);
}

const FILE: &str = r#"
title = "Two masses"
[coordinates]
x = { initial = 1.0 }
y = { initial = 2.0 }
[parameters]
k = 4.0
[lagrangian]
L = "1/2*(x'^2 + y'^2) - 1/2*k*(x^2 + y^2)"
"#;

fn opened(text: &str) -> App {
    let (mut app, _) = App::new(catalog(), Some("test"));
    let loaded = lowered(text);
    app.update(AppEvent::Loaded(Ok(loaded.clone())));
    app.update(AppEvent::Snapshot(Arc::new(snapshot(&loaded, 1.0))));
    app
}

#[test]
fn a_rebuilt_system_is_looked_at_as_before() {
    let mut app = opened(FILE);
    press(&mut app, "Tab Tab Tab + + x");
    let before = app.lab.as_ref().unwrap().clone();
    // with two more observables the channels have other indices
    let text = format!("{FILE}[[observables]]\nname = \"r\"\nexpression = \"sqrt(x^2 + y^2)\"\n");
    let effects = rebuild(&mut app, &text);
    let lab = app.lab.as_ref().unwrap();
    assert_eq!((lab.focus.pane, lab.plots.len()), (before.focus.pane, before.plots.len()));
    let names = |lab: &phaselab::app::Lab| {
        let name = |i: &usize| lab.loaded.system.channels()[*i].name.clone();
        let names = lab.plots.iter().map(|plot| {
            let names: Vec<String> = plot.columns.iter().flatten().map(name).collect();
            (plot.kind.name(), names, plot.viewport())
        });
        names.collect::<Vec<_>>()
    };
    assert_eq!(names(lab), names(&before));
    assert!(matches!(effects.as_slice(), [Effect::Execute(Command::Restore(_))]), "{effects:?}");
}

/// The least range of a quantity stays with it where the channels of a changed text have other indices, also of one that the
/// system lacks in between.
#[test]
fn the_least_ranges_of_pictures_stay_with_their_quantities() {
    let mut app = opened(FILE);
    let range = [-7.0, 9.0];
    let set = ["y'", "u"].map(|of| LeastRange { of: of.to_owned(), range, channel: None });
    app.lab.as_mut().unwrap().set_least_ranges(set.to_vec());
    let held = |app: &App| -> Vec<String> {
        let lab = app.lab.as_ref().unwrap();
        let channels = lab.loaded.system.channels().iter().enumerate();
        let held = channels.filter(|(index, _)| lab.least_range(*index) == Some(range));
        held.map(|(_, channel)| channel.name.clone()).collect()
    };
    assert_eq!(held(&app), ["y'"]);
    let text = FILE.replace("[coordinates]\n", "[coordinates]\nu = { initial = 1.0 }\n");
    let text = text.replace("y'^2", "y'^2 + u'^2");
    rebuild(&mut app, &text);
    assert_eq!(held(&app), ["u", "y'"]);
    rebuild(&mut app, FILE);
    assert_eq!(held(&app), ["y'"]);
}

#[test]
fn a_system_that_lost_what_was_shown_opens_its_own_views() {
    let mut app = opened(FILE);
    let text = FILE.replace("y = { initial = 2.0 }\n", "").replace("y'^2", "x'^2");
    rebuild(&mut app, &text.replace("y^2", "x^2"));
    let lab = app.lab.as_ref().unwrap();
    assert!(!lab.plots.is_empty());
    for plot in &lab.plots {
        let known = |channel: &usize| *channel < lab.loaded.system.channels().len();
        assert!(plot.columns.iter().flatten().all(known));
    }
}

/// What of the law is said to be another one, where the motion is restored.
fn changed(effects: &[Effect]) -> Option<String> {
    let restored = effects.iter().find_map(|effect| match effect {
        Effect::Execute(Command::Restore(checkpoint)) => Some(checkpoint.changed.clone()),
        _ => None,
    });
    restored.expect("the motion is restored")
}

/// A text that says the same of the motion: other words, observables, another layout.
fn with_the_same_law() -> String {
    let text = FILE.replace("Two masses", "A pair");
    let (coordinates, rest) = text.split_once("[parameters]").unwrap();
    let (parameters, law) = rest.split_once("[lagrangian]").unwrap();
    format!(
        "{coordinates}[lagrangian]  # the law\n{law}[parameters]{parameters}\n\
         [[observables]]\nname = \"r\"\nexpression = \"sqrt(x^2 + y^2)\"\n"
    )
}

/// A change can be undone in a text that was rebuilt; the motion before it comes back if it follows the same law.
#[test]
fn a_motion_of_another_law_is_not_brought_back() {
    let other_words = FILE.replace("Two masses", "A pair");
    let other_law = FILE.replace("1/2*k", "1/3*k");
    for (text, comes_back) in [(other_words, true), (other_law, false)] {
        let mut app = opened(FILE);
        press(&mut app, "Right");
        rebuild(&mut app, &text);
        let seen = snapshot(&app.lab.as_ref().unwrap().loaded, 2.0);
        app.update(AppEvent::Snapshot(Arc::new(seen)));
        let effects = press(&mut app, "u");
        let restores = |effect: &Effect| matches!(effect, Effect::Execute(Command::Restore(_)));
        assert_eq!(effects.iter().any(restores), comes_back, "{effects:?}");
        assert!(!effects.is_empty());
    }
}

/// A flow map, an action since the last change begin where the law became another one, and nowhere else.
#[test]
fn only_a_change_of_the_law_is_one() {
    let same = with_the_same_law();
    let other_law = FILE.replace("1/2*k", "1/3*k");
    let other_value = FILE.replace("k = 4.0", "k = 5.0");
    let cases = [(&same, None), (&other_law, Some("the text")), (&other_value, Some("the text"))];
    for (text, what) in cases {
        let mut app = opened(FILE);
        let effects = rebuild(&mut app, text);
        assert_eq!(changed(&effects).as_deref(), what, "rebuilt from {text}");
        // the same file changed by another program between two sessions
        let saved = kept(&opened(FILE));
        let (mut app, _) = App::new(catalog(), Some(&saved.open));
        app.resume(saved);
        let effects = app.update(AppEvent::Loaded(Ok(lowered(text))));
        assert_eq!(changed(&effects).as_deref(), what, "resumed with {text}");
        let said =
            app.notifications.shown.as_ref().map(|notice| notice.text.clone()).unwrap_or_default();
        assert_eq!(said.contains("has changed since"), what.is_some(), "{said}");
    }
}

fn offered(saved: Saved) -> App {
    let (mut app, _) = App::new(catalog(), None);
    app.offer_session(saved);
    app
}

#[test]
fn the_first_row_of_the_list_goes_on_with_the_session() {
    let mut app = in_lab();
    press(&mut app, "Tab Tab Tab z 2");
    let saved = kept(&app);
    let mut app = offered(saved.clone());
    assert_eq!(press(&mut app, "Enter"), [Effect::Load(saved.open.clone())]);
    let effects = app.update(AppEvent::Loaded(Ok(pendulum())));
    let (by_option, effects_of_option) = resumed(saved.clone());
    assert_eq!(effects, effects_of_option);
    assert_eq!(effects, [Effect::Execute(Command::Restore(Box::new(saved.checkpoint)))]);
    assert_eq!((app.page, by_option.page), (Page::Equations, Page::Equations));
    let (lab, other) = (app.lab.as_ref().unwrap(), by_option.lab.as_ref().unwrap());
    assert_eq!(
        (lab.focus.pane, lab.focus.zoomed, &lab.plots),
        (other.focus.pane, true, &other.plots)
    );
}

/// The row above the systems begins one of one's own; a search is among the systems only.
#[test]
fn the_row_of_a_new_system_opens_the_editor() {
    let (mut app, _) = App::new(catalog(), None);
    assert!(app.picker.is_selected(0));
    press(&mut app, "Up");
    assert_eq!(app.picker.selected_above(), Some(Above::NewSystem));
    assert!(app.picker.current().is_none() && !app.picker.is_selected(0));
    press(&mut app, "Enter");
    assert!(app.open_buffer().is_some_and(|buffer| buffer.editor.text().contains("[lagrangian]")));
    let (mut app, _) = App::new(catalog(), None);
    press(&mut app, "Up / p e n d");
    assert!(app.picker.above().next().is_none() && app.picker.is_selected(0));
}

/// Negatives: no row without a session, none among the results of a search, and a system of the list begins anew.
#[test]
fn only_the_row_of_the_session_goes_on_with_it() {
    let (app, _) = App::new(catalog(), None);
    assert!(app.picker.session().is_none() && app.picker.is_selected(0));
    let saved = kept(&in_lab());
    let mut app = offered(saved.clone());
    assert!(app.picker.selected_session().is_some() && !app.picker.is_selected(0));
    press(&mut app, "Down");
    assert_eq!(app.picker.selected_above(), Some(Above::NewSystem));
    press(&mut app, "Down");
    assert!(app.picker.selected_session().is_none() && app.picker.is_selected(0));
    press(&mut app, "Up Up");
    assert!(app.picker.selected_session().is_some());
    press(&mut app, "/ p e n d");
    assert!(app.picker.session().is_none() && app.picker.is_selected(0));
    press(&mut app, "Up");
    assert!(app.picker.is_selected(0));
    assert_eq!(app.picker.current().unwrap().info.title, "Simple pendulum");
    // the first Esc stops the load of the preview
    press(&mut app, "Esc Esc");
    assert!(app.picker.session().is_some() && app.picker.selected_session().is_none());
    press(&mut app, "Enter");
    let effects = app.update(AppEvent::Loaded(Ok(pendulum())));
    assert!(effects.contains(&Effect::Execute(Command::Play)), "{effects:?}");
    // a load that was stopped leaves nothing to be taken up by the next one
    let mut app = offered(saved.clone());
    press(&mut app, "Enter");
    assert_eq!(press(&mut app, "Esc"), [Effect::StopLoading]);
    press(&mut app, "Down");
    app.picker.select(&saved.open);
    press(&mut app, "Enter");
    let effects = app.update(AppEvent::Loaded(Ok(pendulum())));
    assert!(effects.contains(&Effect::Execute(Command::Play)), "{effects:?}");
}
