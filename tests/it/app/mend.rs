//! Texts edited while no system runs: a wrong file where its errors are shown, and a new system.

use std::path::PathBuf;
use std::time::Duration;

use phaselab::app::{
    Above, App, AppEvent, BufferState, CheckedText, Effect, LoadError, Overlay, Page, Pane,
};
use phaselab::diagnostic::Document;
use phaselab::preset::template;

use crate::fixtures::{catalog, in_lab, lowered, press};
use crate::screen::screen_text;

/// The text of a wrong file: `sni` for `sin`, on the fourth line from the end of the template's beginning.
fn wrong() -> String {
    template().replace("m g l cos θ", "m g l csc2(θ)")
}

/// Carries out the checks that are asked for.
pub(super) fn rest(app: &mut App) {
    let effects = app.update(AppEvent::Tick(Duration::from_secs(1)));
    let check = effects.into_iter().find_map(|effect| match effect {
        Effect::Check { ticket, title, text } => Some((ticket, title, text)),
        _ => None,
    });
    let (ticket, title, text) = check.expect("the text is checked");
    assert!(app.awaits(ticket));
    let document = Document::new(title, text.clone());
    let outcome = match document.read() {
        Ok(_) => Ok(lowered(&text)),
        Err(diagnostics) => Err(diagnostics),
    };
    let outcome = outcome.map(|mut loaded| {
        loaded.name = app.checked_system().expect("a name");
        loaded
    });
    app.update(AppEvent::Checked(Box::new(CheckedText {
        ticket,
        outcome,
        took: Some(Duration::ZERO),
    })));
}

fn text_of(app: &App) -> String {
    screen_text(app, (120, 40))
}

#[test]
fn a_wrong_file_is_edited_at_its_first_error_and_then_runs() {
    let name = "./wrong.toml";
    let (mut app, _) = App::new(catalog(), Some(name));
    let message = "error: a wrong line".to_owned();
    app.update(AppEvent::Loaded(Err(LoadError { name: name.to_owned(), message })));
    assert!(matches!(app.overlay, Some(Overlay::Message(_))));
    assert!(text_of(&app).contains("E edit"), "the key is among the hints");
    assert_eq!(press(&mut app, "E"), [Effect::Reread(PathBuf::from(name))]);
    app.update(AppEvent::FileRead { text: wrong(), asked: true });
    rest(&mut app);
    let buffer = app.open_buffer().expect("the editor is open");
    assert_eq!(buffer.state, BufferState::Wrong);
    let line = wrong().lines().position(|line| line.contains("csc2")).unwrap();
    assert_eq!(buffer.editor.cursor().row, line, "at the first error");
    let text = text_of(&app);
    assert!(text.contains("1 error") && text.contains("csc2"), "{text}");
    assert!(!text.contains("last valid version"), "nothing runs yet: {text}");
    // The mend: the name of the function is typed anew.
    let at = buffer.editor.cursor().column;
    let from = wrong().lines().nth(line).unwrap().chars().take(at).collect::<String>();
    assert!(from.ends_with("m g l "), "{from}");
    press(&mut app, "Delete Delete Delete Delete c o s");
    rest(&mut app);
    let buffer = app.open_buffer().expect("the editor stays open");
    assert_eq!(buffer.state, BufferState::Rebuilt(Some(Duration::ZERO)));
    assert_eq!(app.lab.as_ref().map(|lab| lab.loaded.name.as_str()), Some(name));
    press(&mut app, "Esc");
    assert_eq!(app.page, Page::Lab);
    assert!(app.overlay.is_none() && app.lab.as_ref().unwrap().focus.pane == Pane::Parameters);
    assert!(app.unsaved().iter().any(|text| text.name == name), "it is not saved yet");
}

#[test]
fn a_wrong_file_that_is_left_leads_back_to_its_errors_and_then_to_the_systems() {
    let name = "./wrong.toml";
    let (mut app, _) = App::new(catalog(), Some(name));
    let message = "error: a wrong line".to_owned();
    let error = LoadError { name: name.to_owned(), message };
    app.update(AppEvent::Loaded(Err(error.clone())));
    press(&mut app, "E");
    app.update(AppEvent::FileRead { text: wrong(), asked: true });
    rest(&mut app);
    assert_eq!(press(&mut app, "Esc"), [Effect::Load(name.to_owned())]);
    app.update(AppEvent::Loaded(Err(error)));
    assert!(matches!(app.overlay, Some(Overlay::Message(_))), "the page from which it was opened");
    press(&mut app, "Esc");
    assert!(app.page == Page::Picker && app.overlay.is_none());
    assert!(app.unsaved().is_empty());
}

/// What was typed into a wrong file is kept, said, and one key away: over the preview of another system, too, and after a
/// start of the program that finds it.
#[test]
fn an_unsaved_text_of_a_wrong_file_is_listed_among_the_systems() {
    let name = "./wrong.toml";
    let (mut app, _) = App::new(catalog(), Some(name));
    let message = "error: a wrong line".to_owned();
    app.update(AppEvent::Loaded(Err(LoadError { name: name.to_owned(), message })));
    press(&mut app, "E");
    app.update(AppEvent::FileRead { text: wrong(), asked: true });
    rest(&mut app);
    press(&mut app, "x Esc");
    assert_eq!(app.page, Page::Picker);
    let reported =
        app.notifications.shown.as_ref().map(|notice| notice.text.clone()).unwrap_or_default();
    assert_eq!(reported, "wrong.toml has unsaved changes; Enter returns to it.");
    assert_eq!(app.picker.selected_above(), Some(Above::Unsaved));
    assert!(text_of(&app).contains("Unsaved: ./wrong.toml"), "{}", text_of(&app));
    let (mut again, _) = App::new(catalog(), None);
    again.workbench.put(app.unsaved());
    again.update(AppEvent::Tick(Duration::ZERO));
    assert_eq!(again.picker.unsaved(), Some(name));
    assert_eq!(again.picker.selected_above(), Some(Above::Unsaved), "as a session would be");
    for mut app in [Box::new(app), Box::new(again)] {
        app.update(AppEvent::Loaded(Ok(crate::fixtures::pendulum())));
        app.picker.step(-9);
        while app.picker.selected_above() != Some(Above::Unsaved) {
            app.picker.step(1);
        }
        press(&mut app, "Enter");
        let text = app.open_buffer().map(|buffer| buffer.editor.text());
        assert!(text.is_some_and(|text| text.contains('x') && text != wrong()));
    }
}

#[test]
fn a_new_system_begins_from_the_template_and_writes_nothing() {
    let mut app = in_lab();
    let effects = press(&mut app, "Ctrl-n");
    assert!(effects.is_empty(), "{effects:?}");
    rest(&mut app);
    let buffer = app.open_buffer().expect("the editor is open");
    assert_eq!(buffer.editor.text(), template());
    assert!(buffer.place.is_none() && !buffer.is_modified());
    let line = template().lines().nth(buffer.editor.cursor().row);
    assert!(line.is_some_and(|line| line.starts_with("L = ")), "at the law: {line:?}");
    // beside the numbers of the lines all of it is seen on 80 columns
    assert!(template().lines().all(
        |line| line.chars().count() <= 72 && (!line.starts_with("L = ") || line.ends_with('"'))
    ));
    assert!(app.lab.is_some(), "it moves");
    assert_eq!(app.saved().map(|saved| saved.open), Some("pendulum".to_owned()));
    assert!(app.picker.session().is_some(), "what was left can be continued");
    // Saving asks for a name.
    press(&mut app, "Ctrl-s");
    let effects = press(&mut app, "Enter");
    let name = match &effects[..] {
        [Effect::SaveCopy { name, text }] => {
            assert_eq!(text, template());
            name.clone()
        }
        other => panic!("{other:?}"),
    };
    assert_eq!(name, "my-system");
}

#[test]
fn a_name_that_is_typed_replaces_the_suggestion_and_titles_the_system() {
    let mut app = in_lab();
    press(&mut app, "Ctrl-n");
    rest(&mut app);
    let name_after = |app: &mut App, keys: &str| {
        press(app, "Ctrl-s");
        press(app, keys);
        let effects = press(app, "Enter");
        let [Effect::SaveCopy { name, .. }] = &effects[..] else { panic!("{effects:?}") };
        name.clone()
    };
    assert_eq!(name_after(&mut app, "End 2"), "my-system2");
    press(&mut app, "Ctrl-s");
    press(&mut app, "Backspace");
    app.update(AppEvent::Paste("pasted".to_owned()));
    assert!(text_of(&app).contains("save a copy as: pasted"));
    press(&mut app, "Esc");
    assert_eq!(name_after(&mut app, "m i n e"), "mine");
    // A file without a title has its name for one, so it is read again under the new name.
    let place = PathBuf::from("/home/me/presets/mine.toml");
    app.update(AppEvent::FileSaved(Ok((place.clone(), template().to_owned()))));
    let effects = app.update(AppEvent::Tick(Duration::ZERO));
    let title = effects.iter().find_map(|effect| match effect {
        Effect::Check { title, .. } => Some(title.clone()),
        _ => None,
    });
    assert_eq!(title, Some(place.display().to_string()));
}

#[test]
fn a_long_help_is_wrapped_and_not_cut() {
    let help = "write `(1/2) m` or `1/(2 m)`; read from left to right, all of it is `1/2*(M + m)*x'^2 + m*l*x'*theta'*cos(theta)`";
    let message = format!("error: it can be read in two ways\n   = help: {help}\n");
    for width in 80..=120 {
        let (mut app, _) = App::new(catalog(), Some("./wrong.toml"));
        let message = message.clone();
        app.update(AppEvent::Loaded(Err(LoadError { name: "./wrong.toml".to_owned(), message })));
        let text = screen_text(&app, (width, 24));
        let words: Vec<&str> = text.split_whitespace().filter(|word| *word != "│").collect();
        let help: Vec<&str> = help.split_whitespace().collect();
        assert!(words.windows(help.len()).any(|words| words == help), "{width}: {text}");
    }
}
