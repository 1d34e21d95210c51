//! The workbench: keys, the requests to the shell, and the results of its answers. The tests construct the answers.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use phaselab::app::keymap::KeyContext;
use phaselab::app::{
    App, AppEvent, BufferState, Caret, CheckedText, Effect, Loaded, NotificationKind, Overlay,
    Page, SaveError, SourceBuffer,
};
use phaselab::diagnostic::Document;
use phaselab::experiment::{Command, Prepared, Snapshot, Status};
use phaselab::instrument::Plot;

use crate::fixtures::{begun, catalog, in_lab, loaded, pendulum, press, showing, snapshot};

fn sheet(app: &App) -> &SourceBuffer {
    app.open_buffer().expect("the editor is open")
}

/// The shell's answer to a check.
fn checked(app: &App, effect: &Effect) -> AppEvent {
    let Effect::Check { ticket, title, text } = effect else { panic!("{effect:?}") };
    assert!(app.awaits(*ticket));
    let name = app.lab.as_ref().unwrap().loaded.name.clone();
    let ready = Prepared::of(&Document::new(title.as_str(), text.as_str()));
    let outcome = ready.map(|ready| Loaded::of(name, ready, |_| 2)).map_err(|why| why.diagnostics);
    let took = Some(Duration::from_millis(7));
    AppEvent::Checked(Box::new(CheckedText { ticket: *ticket, outcome, took }))
}

/// Waits until typing pauses, answers the resulting check, and returns the effects that follow.
fn rest(app: &mut App) -> Vec<Effect> {
    let effects = app.update(AppEvent::Tick(Duration::from_millis(200)));
    let [effect @ Effect::Check { .. }] = effects.as_slice() else { panic!("{effects:?}") };
    let answer = checked(app, effect);
    app.update(answer)
}

fn edited() -> App {
    let mut app = in_lab();
    assert_eq!(press(&mut app, "E Ctrl-Home"), []);
    app
}

/// Replaces the first occurrence of these words by typing.
fn replace(app: &mut App, words: &str, with: &str) {
    press(app, "Ctrl-Home Ctrl-f Ctrl-u");
    app.update(AppEvent::Paste(words.to_owned()));
    press(app, "Enter");
    app.update(AppEvent::Paste(with.to_owned()));
}

#[test]
fn the_editor_opens_at_the_law() {
    let mut app = in_lab();
    press(&mut app, "E");
    let Caret { row, column } = sheet(&app).editor.cursor();
    assert_eq!(column, 0);
    let line = &sheet(&app).editor.lines()[row];
    assert!(line.starts_with("L ="), "{line}");
}

#[test]
fn a_change_is_checked_when_typing_rests_and_the_motion_goes_on() {
    let mut app = edited();
    assert_eq!(sheet(&app).state, BufferState::Runs);
    press(&mut app, "Ctrl-End x");
    assert_eq!(sheet(&app).state, BufferState::Changed);
    assert_eq!(app.update(AppEvent::Tick(Duration::from_millis(100))), [], "typing goes on");
    press(&mut app, "Backspace");
    assert_eq!(app.update(AppEvent::Tick(Duration::from_millis(100))), [], "typing goes on");
    let effects = rest(&mut app);
    let [Effect::Execute(Command::Restore(moment))] = effects.as_slice() else {
        panic!("{effects:?}")
    };
    assert!(moment.running);
    assert_eq!(sheet(&app).state, BufferState::Rebuilt(Some(Duration::from_millis(7))));
    assert_eq!(app.lab.as_ref().unwrap().loaded.epoch, 2);
    assert_eq!(app.update(AppEvent::Tick(Duration::from_secs(1))), [], "it is checked once");
}

/// Whoever left the editor and asks to undo is told where changes of the text are undone.
#[test]
fn undo_in_the_lab_says_where_the_text_is_undone() {
    let reported =
        |app: &App| app.notifications.shown.as_ref().map(|n| n.text.clone()).unwrap_or_default();
    let mut app = in_lab();
    press(&mut app, "u");
    assert_eq!(reported(&app), "Nothing to undo.");
    press(&mut app, "E Ctrl-End x Backspace Esc u");
    assert_eq!(reported(&app), "Nothing to undo.");
    press(&mut app, "E Ctrl-End # Esc u");
    assert!(reported(&app).ends_with("in the editor: E, then Ctrl-u."), "{}", reported(&app));
    press(&mut app, "E Ctrl-u Esc u");
    assert_eq!(reported(&app), "Nothing to undo.");
}

#[test]
fn what_has_a_name_in_both_texts_is_looked_at_as_before() {
    let mut app = in_lab();
    press(&mut app, "Tab Tab Tab");
    press(&mut app, "+ + z");
    let before = app.lab.as_ref().unwrap().plots.clone();
    press(&mut app, "E Ctrl-Home");
    replace(
        &mut app,
        "[expect]",
        "[[observables]]\nname = \"new\"\nexpression = \"theta\"\n\n[expect]",
    );
    rest(&mut app);
    let lab = app.lab.as_ref().unwrap();
    assert!(lab.focus.zoomed);
    assert_eq!(lab.plots.len(), before.len());
    let viewport = |plots: &[Plot]| plots.iter().filter(|p| p.kind.name() == "phase").count();
    assert_eq!(viewport(&lab.plots), viewport(&before));
    assert!(lab.loaded.system.channels().iter().any(|channel| channel.name == "new"));
}

#[test]
fn errors_stand_in_their_places_until_the_text_is_right_again() {
    let mut app = edited();
    replace(&mut app, "cos(theta)", "cos(thet)");
    assert_eq!(rest(&mut app), [], "the old system goes on");
    let diagnostic = sheet(&app).diagnostic().expect("an error").clone();
    let line = &sheet(&app).editor.lines()[diagnostic.from.row];
    let word: String = line
        .chars()
        .skip(diagnostic.from.column)
        .take(diagnostic.to.column - diagnostic.from.column)
        .collect();
    assert_eq!((word.as_str(), sheet(&app).state), ("thet", BufferState::Wrong));
    assert!(
        diagnostic.help.as_deref().is_some_and(|help| help.contains("theta")),
        "{diagnostic:?}"
    );
    // while the editor is closed, a line reports it
    press(&mut app, "Esc");
    let banner = app.banner().expect("a banner");
    assert!(banner.contains("pendulum.toml:") && banner.contains("thet"), "{banner}");
    press(&mut app, "E Ctrl-Home Ctrl-n");
    assert_eq!(sheet(&app).editor.cursor(), diagnostic.from);
    press(&mut app, "Ctrl-u");
    let effects = rest(&mut app);
    assert!(matches!(effects.as_slice(), [Effect::Execute(Command::Restore(_))]), "{effects:?}");
    assert_eq!(sheet(&app).diagnostics, []);
    assert_eq!(app.banner(), None);
}

#[test]
fn next_and_previous_go_round_all_errors() {
    let mut app = edited();
    app.update(AppEvent::Paste("oops = 1\n".to_owned()));
    replace(&mut app, "cos(theta)", "cos(thet)");
    rest(&mut app);
    let rows: Vec<usize> =
        sheet(&app).diagnostics.iter().map(|diagnostic| diagnostic.from.row).collect();
    assert_eq!((rows.len(), rows[0]), (2, 0));
    press(&mut app, "Ctrl-Home Ctrl-n");
    assert_eq!(sheet(&app).editor.cursor().row, rows[1]);
    press(&mut app, "Ctrl-n");
    assert_eq!(sheet(&app).editor.cursor(), Caret::default());
    press(&mut app, "Ctrl-p");
    assert_eq!(sheet(&app).editor.cursor().row, rows[1]);
}

#[test]
fn an_answer_to_an_older_text_shows_no_errors() {
    let mut app = edited();
    press(&mut app, "Ctrl-Home x");
    let effects = app.update(AppEvent::Tick(Duration::from_millis(200)));
    let answer = checked(&app, &effects[0]);
    press(&mut app, "Backspace");
    app.update(answer);
    assert_eq!(sheet(&app).diagnostics, []);
    assert_eq!(rest(&mut app).len(), 1);
}

#[test]
fn a_newer_text_is_checked_in_place_of_an_older_one() {
    let mut app = edited();
    press(&mut app, "Ctrl-Home x");
    let older = app.update(AppEvent::Tick(Duration::from_millis(200)));
    let [Effect::Check { ticket, .. }] = older.as_slice() else { panic!("{older:?}") };
    press(&mut app, "Backspace");
    let newer = app.update(AppEvent::Tick(Duration::from_millis(200)));
    let [Effect::Check { text, .. }] = newer.as_slice() else { panic!("{newer:?}") };
    assert_eq!(*text, sheet(&app).editor.text());
    assert!(!app.awaits(*ticket), "nobody waits for the older one");
}

#[test]
fn a_check_that_takes_long_is_stopped_by_leaving_and_goes_on_when_one_comes_back() {
    let stopped = |after: u64| {
        let mut app = edited();
        press(&mut app, "Ctrl-Home #");
        assert!(matches!(
            app.update(AppEvent::Tick(Duration::from_millis(200))).as_slice(),
            [Effect::Check { .. }]
        ));
        app.update(AppEvent::Tick(Duration::from_millis(after)));
        (press(&mut app, "Esc") == [Effect::StopCheck], app)
    };
    assert!(!stopped(999).0, "what is soon there is not stopped");
    let (is_stopped, mut app) = stopped(1000);
    assert!(is_stopped);
    assert_eq!(app.update(AppEvent::Tick(Duration::from_secs(9))), [], "nothing goes on");
    press(&mut app, "E Ctrl-Home");
    let again = app.update(AppEvent::Tick(Duration::from_millis(1)));
    assert!(matches!(again.as_slice(), [Effect::Check { .. }]), "{again:?}");
    // in the list of systems nothing is checked; in the lab, checks continue
    assert_eq!(press(&mut app, "Esc Esc Esc"), []);
    assert_eq!(app.page, Page::Picker);
    assert_eq!(app.update(AppEvent::Tick(Duration::from_millis(1))), [Effect::StopCheck]);
    assert_eq!(app.update(AppEvent::Tick(Duration::from_secs(9))), []);
    press(&mut app, "Enter");
    let again = app.update(AppEvent::Tick(Duration::from_millis(1)));
    assert!(matches!(again.as_slice(), [Effect::Check { .. }]), "{again:?}");
}

#[test]
fn an_answer_that_comes_late_never_reaches_another_system() {
    let mut app = edited();
    replace(&mut app, "cos(theta)", "cos(thet)");
    let slow = app.update(AppEvent::Tick(Duration::from_millis(200)));
    let late = checked(&app, &slow[0]);
    app.update(AppEvent::Loaded(Ok(loaded("planet", 3))));
    app.update(AppEvent::Snapshot(Arc::new(snapshot(&loaded("planet", 3), 1.0))));
    press(&mut app, "E Ctrl-Home x");
    let asked = app.update(AppEvent::Tick(Duration::from_millis(200)));
    assert!(
        matches!(&asked[..], [Effect::Check { .. }]),
        "nobody waits for the old one: {asked:?}"
    );
    let AppEvent::Checked(old) = &late else { panic!("{late:?}") };
    assert!(!app.awaits(old.ticket));
    app.update(late);
    assert_eq!((sheet(&app).diagnostics.len(), sheet(&app).state), (0, BufferState::Changed));
    // its own answer is still to come
    let own = checked(&app, &asked[0]);
    app.update(own);
    assert_eq!(sheet(&app).state, BufferState::Wrong);
    // back at the first system, whose text is unchanged and is checked again
    app.update(AppEvent::Loaded(Ok(pendulum())));
    press(&mut app, "E Ctrl-Home");
    assert!(sheet(&app).is_modified());
    rest(&mut app);
    assert_eq!(sheet(&app).diagnostics.len(), 1);
}

#[test]
fn a_shipped_system_is_saved_as_a_copy_and_then_in_its_place() {
    let mut app = edited();
    press(&mut app, "# Enter");
    assert_eq!(press(&mut app, "Ctrl-s"), [], "it asks for a name");
    press(&mut app, "Ctrl-u m i n e");
    let text = sheet(&app).editor.text();
    let copy = Effect::SaveCopy { name: "mine".to_owned(), text: text.clone() };
    assert_eq!(press(&mut app, "Enter"), [copy]);
    assert!(sheet(&app).is_modified());
    let place = PathBuf::from("/home/me/.config/phaselab/presets/mine.toml");
    app.update(AppEvent::FileSaved(Ok((place.clone(), text.clone()))));
    assert!(!sheet(&app).is_modified());
    assert_eq!(app.file(), Some(place.clone()), "the copy is what is open now");
    press(&mut app, "y");
    let later = sheet(&app).editor.text();
    assert_eq!(press(&mut app, "Ctrl-s"), [Effect::Save { place, text: later, known: Some(text) }]);
}

#[test]
fn a_name_that_is_taken_is_asked_for_again() {
    let mut app = edited();
    press(&mut app, "Ctrl-s Enter");
    app.update(AppEvent::FileSaved(Err(SaveError::Exists(PathBuf::from("mine.toml")))));
    assert!(app.notifications.shown.as_ref().unwrap().text.contains("already exists"));
    assert!(sheet(&app).asking.is_some());
    press(&mut app, "Esc");
    assert!(sheet(&app).asking.is_none(), "Esc leaves the question, not the text");
    press(&mut app, "Esc");
    assert!(app.overlay.is_none());
}

/// A user's file in the lab.
fn own_file() -> App {
    let text = &catalog().find("pendulum").unwrap().text;
    let ready = Prepared::of(&Document::new("./my.toml", text.as_str())).unwrap();
    showing(Loaded::of("./my.toml".to_owned(), ready, |_| 1), 2.0)
}

fn file(text: &str) -> AppEvent {
    AppEvent::FileRead { text: text.to_owned(), asked: false }
}

#[test]
fn a_file_changed_by_another_program_is_written_over_only_on_demand() {
    let mut app = own_file();
    press(&mut app, "E Ctrl-Home #");
    let save = press(&mut app, "Ctrl-s");
    assert!(matches!(&save[..], [Effect::Save { known: Some(_), .. }]), "{save:?}");
    app.update(AppEvent::FileSaved(Err(SaveError::Changed)));
    assert!(app.notifications.shown.as_ref().unwrap().text.contains("changed by another program"));
    let again = press(&mut app, "Ctrl-s");
    assert!(matches!(&again[..], [Effect::Save { known: None, .. }]), "{again:?}");
    assert_eq!(press(&mut app, "Ctrl-o"), [Effect::Reread(PathBuf::from("./my.toml"))]);
    app.update(AppEvent::FileRead { text: "title = \"Other\"\n".to_owned(), asked: true });
    assert_eq!(sheet(&app).editor.text(), "title = \"Other\"\n");
    press(&mut app, "Ctrl-u");
    assert!(sheet(&app).editor.text().starts_with('#'), "what stood there can be had back");
}

#[test]
fn a_watched_file_is_taken_up_while_its_editor_is_closed() {
    let mut app = own_file();
    let text = app.lab.as_ref().unwrap().loaded.document.text.clone();
    app.update(file(&text));
    assert_eq!(app.update(AppEvent::Tick(Duration::from_secs(1))), [], "nothing has changed");
    app.update(file(&text.replace("9.81", "1.62")));
    let effects = rest(&mut app);
    assert!(matches!(effects.as_slice(), [Effect::Execute(Command::Restore(_))]), "{effects:?}");
    let model = &app.lab.as_ref().unwrap().loaded.model;
    assert!(model.parameters.iter().any(|p| p.value == 1.62));
    assert!(app.overlay.is_none());
}

#[test]
fn a_file_caught_half_written_is_looked_at_once_more_before_it_is_called_wrong() {
    let mut app = own_file();
    let text = app.lab.as_ref().unwrap().loaded.document.text.clone();
    app.update(file(&text[..text.len() / 2]));
    rest(&mut app);
    assert_eq!(app.banner(), None, "it may still be written");
    app.update(AppEvent::Tick(Duration::from_millis(600)));
    rest(&mut app);
    assert!(app.banner().is_some(), "nobody has completed it");
    app.update(file(&text));
    rest(&mut app);
    assert_eq!(app.banner(), None);
}

#[test]
fn a_watched_file_does_not_replace_what_is_not_saved() {
    let mut app = own_file();
    press(&mut app, "E Ctrl-Home #");
    let mine = sheet(&app).editor.text();
    app.update(file("title = \"Other\"\n"));
    assert_eq!(sheet(&app).editor.text(), mine);
    assert!(app.notifications.shown.as_ref().unwrap().text.contains("changed by another program"));
}

#[test]
fn what_is_not_saved_of_another_system_is_kept() {
    let mut app = edited();
    press(&mut app, "x y Esc");
    let planet = loaded("planet", 3);
    app.update(AppEvent::Loaded(Ok(planet.clone())));
    press(&mut app, "E Ctrl-Home");
    assert_eq!(sheet(&app).editor.text(), planet.document.text);
    press(&mut app, "z Esc");
    let mut names: Vec<String> = app.unsaved().into_iter().map(|text| text.name).collect();
    names.sort();
    assert_eq!(names, ["pendulum", "planet"]);
    app.update(AppEvent::Loaded(Ok(pendulum())));
    press(&mut app, "E Ctrl-Home");
    assert!(sheet(&app).editor.text().starts_with("xy"));
    assert_eq!(sheet(&app).state, BufferState::Changed, "the system was loaded anew meanwhile");
}

/// Starts the program again with the saved texts; returns the effects once the system is there.
fn started_again(app: &App, resumed: bool) -> (App, Vec<Effect>) {
    let (mut again, _) = App::new(catalog(), Some("pendulum"));
    again.workbench.put(app.unsaved());
    if resumed {
        again.resume(app.saved().unwrap());
    }
    let effects = again.update(AppEvent::Loaded(Ok(pendulum())));
    (again, effects)
}

#[test]
fn a_text_that_is_not_saved_outlives_the_session() {
    let mut app = edited();
    assert_eq!(app.unsaved(), []);
    replace(&mut app, "cos(theta)", "cos(2*theta)");
    rest(&mut app);
    app.update(AppEvent::Snapshot(Arc::new(Snapshot { epoch: 2, ..snapshot(&pendulum(), 2.0) })));
    let left = app.saved().unwrap();
    assert!(left.edited);
    let (mut again, effects) = started_again(&app, true);
    // the motion belongs to the text and waits for it; a session that ends now is unchanged
    assert_eq!(effects, []);
    assert_eq!(again.saved().unwrap().checkpoint, left.checkpoint);
    assert_eq!(rest(&mut again), [Effect::Execute(Command::Restore(Box::new(left.checkpoint)))]);
    press(&mut again, "E Ctrl-Home");
    assert_eq!(sheet(&again).editor.text(), sheet(&app).editor.text());
    assert!(sheet(&again).is_modified());
    assert!(matches!(sheet(&again).state, BufferState::Rebuilt(Some(_))));
}

#[test]
fn a_text_with_errors_that_is_not_saved_outlives_the_session_too() {
    let mut app = edited();
    replace(&mut app, "cos(theta)", "cos(thet)");
    rest(&mut app);
    let left = app.saved().unwrap();
    let (mut again, effects) = started_again(&app, true);
    assert_eq!(effects, []);
    assert_eq!(rest(&mut again), [Effect::Execute(Command::Restore(Box::new(left.checkpoint)))]);
    assert!(again.banner().is_some_and(|banner| banner.contains("thet")));
}

#[test]
fn without_resuming_the_file_runs_and_the_text_waits_for_its_editor() {
    let mut app = edited();
    press(&mut app, "# Enter");
    let (mut again, effects) = started_again(&app, false);
    assert_eq!(effects, [Effect::Execute(Command::Play)]);
    assert!(again.notifications.shown.as_ref().unwrap().text.contains("E shows them"));
    assert_eq!(again.update(AppEvent::Tick(Duration::from_secs(1))), []);
    assert_eq!(again.unsaved(), app.unsaved(), "it is kept on");
    // the file is watched, not the text
    let text = again.lab.as_ref().unwrap().loaded.document.text.clone();
    again.update(AppEvent::FileRead { text, asked: false });
    assert_eq!(again.update(AppEvent::Tick(Duration::from_secs(1))), []);
    press(&mut again, "E Ctrl-Home");
    assert_eq!(sheet(&again).editor.text(), sheet(&app).editor.text());
    assert_eq!(rest(&mut again).len(), 1);
}

/// A key that changes the text must not make old changes run that nobody sees.
#[test]
fn a_text_from_before_is_not_run_by_a_key() {
    let mut app = edited();
    replace(&mut app, "cos(theta)", "cos(2*theta)");
    let (mut again, _) = started_again(&app, false);
    let before = again.unsaved();
    for _ in 0..12 {
        press(&mut again, "Tab");
        press(&mut again, "L");
        if again.overlay.is_some() {
            break;
        }
    }
    assert!(again.overlay.is_some(), "a field for the surface");
    press(&mut again, "t h e t a = 0 . 2 Enter");
    let notice = again.notifications.shown.as_ref().map_or("", |notice| &notice.text);
    assert!(
        notice.ends_with("has unsaved changes that do not run; E shows and runs them."),
        "{notice}"
    );
    assert_eq!(again.unsaved(), before);
    // once it is seen it runs, and the surface is written into it
    press(&mut again, "E Esc");
    press(&mut again, "L t h e t a = 0 . 2 Enter");
    assert_ne!(again.unsaved(), before);
}

#[test]
fn another_system_s_start_leaves_kept_texts_alone() {
    let mut app = edited();
    press(&mut app, "# Enter");
    let (mut again, _) = App::new(catalog(), Some("planet"));
    again.workbench.put(app.unsaved());
    again.update(AppEvent::Loaded(Ok(loaded("planet", 1))));
    assert_eq!(again.notifications.shown, None);
    press(&mut again, "E Esc");
    assert_eq!(again.unsaved(), app.unsaved());
}

#[test]
fn a_second_rebuild_before_the_first_was_seen_goes_on_with_the_same_motion() {
    let mut app = edited();
    press(&mut app, "x Backspace");
    let first = rest(&mut app);
    // a snapshot of the new system from before the motion was restored
    let early = Snapshot { epoch: 2, restored: false, ..snapshot(&pendulum(), 0.0) };
    app.update(AppEvent::Snapshot(Arc::new(early)));
    assert!(app.snapshot().is_none(), "it is not shown");
    press(&mut app, "x Backspace");
    assert_eq!(rest(&mut app), first);
    let taken = Snapshot { epoch: 2, status: Status::Paused, ..snapshot(&pendulum(), 2.5) };
    app.update(AppEvent::Snapshot(Arc::new(taken)));
    press(&mut app, "x Backspace");
    assert_ne!(rest(&mut app), first, "now the motion is seen, and goes on from there");
}

#[test]
fn leaving_keeps_the_text_and_coming_back_finds_it() {
    let mut app = edited();
    press(&mut app, "x y Esc");
    assert!(app.notifications.shown.as_ref().unwrap().text.contains("unsaved changes"));
    assert!(app.overlay.is_none());
    // q in the editor is a letter, in the lab it leaves
    press(&mut app, "E q");
    assert!(sheet(&app).editor.text().starts_with("xyq"));
    assert!(matches!(app.overlay, Some(Overlay::Workbench)));
}

#[test]
fn a_text_that_would_be_lost_is_not_lost_at_the_first_q() {
    let mut app = in_lab();
    press(&mut app, "E Ctrl-Home x Esc");
    let mut kept = app.clone();
    kept.workbench.keeps = true;
    assert_eq!(press(&mut kept, "q"), [Effect::Quit]);
    assert_eq!(press(&mut kept, "Esc Esc q"), [Effect::Quit], "also from the list of systems");
    let lost = "has unsaved changes; quit again to discard them.";
    for keys in ["q", "Esc q"] {
        let mut app = app.clone();
        assert_eq!(press(&mut app, keys), []);
        assert!(app.notifications.shown.as_ref().unwrap().text.ends_with(lost));
        assert_eq!(press(&mut app, "q"), [Effect::Quit]);
    }
    // saving it failed
    kept.stay();
    assert!(kept.notifications.shown.as_ref().unwrap().text.ends_with(lost));
    assert_eq!(press(&mut kept, "q"), [Effect::Quit]);
}

#[test]
fn reading_anew_gives_a_shipped_text_back() {
    let mut app = edited();
    press(&mut app, "x y Ctrl-o");
    assert!(!sheet(&app).is_modified());
    assert_eq!(app.unsaved(), []);
    press(&mut app, "Ctrl-u");
    assert!(sheet(&app).editor.text().starts_with("xy"), "it can be taken back");
}

#[test]
fn saving_what_has_an_error_says_so() {
    let reported =
        |app: &App| app.notifications.shown.clone().map(|notice| notice.text).unwrap_or_default();
    let saved = |app: &mut App| {
        let [Effect::Save { place, text, .. }] = &press(app, "Ctrl-s")[..] else { panic!("no") };
        app.update(AppEvent::FileSaved(Ok((place.clone(), text.clone()))));
    };
    let mut app = own_file();
    press(&mut app, "E Ctrl-Home");
    replace(&mut app, "cos(theta)", "cos(thet)");
    rest(&mut app);
    saved(&mut app);
    let with = reported(&app);
    assert!(with.starts_with("Saved: ./my.toml, with 1 error: "), "{with}");
    assert!(with.contains("thet"), "{with}");
    // one that was saved before it was checked
    replace(&mut app, "thet)", "thetta)");
    saved(&mut app);
    assert_eq!(reported(&app), "Saved: ./my.toml");
    rest(&mut app);
    assert!(reported(&app).starts_with("Saved: ./my.toml, with 1 error: "), "{}", reported(&app));
    replace(&mut app, "thetta)", "theta)");
    saved(&mut app);
    rest(&mut app);
    assert_eq!(reported(&app), "Saved: ./my.toml");
}

#[test]
fn the_keys_are_shown_over_the_editor_which_is_there_again_afterwards() {
    let mut app = edited();
    press(&mut app, "x y F1");
    assert!(matches!(app.overlay, Some(Overlay::Help { below: Some(_), .. })));
    assert_eq!(app.key_contexts_below()[0], KeyContext::Workbench);
    for back in ["Esc", "F1", "?"] {
        press(&mut app, back);
        assert!(sheet(&app).editor.text().starts_with("xy"), "{back}");
        press(&mut app, "F1");
    }
    press(&mut app, "Esc Esc F1 Esc");
    assert!(app.overlay.is_none(), "elsewhere it goes back to the page");
}

#[test]
fn of_a_paste_that_is_too_long_the_beginning_is_taken() {
    let mut app = edited();
    let long = "0123456789\n".repeat(100_000);
    app.update(AppEvent::Paste(long.clone()));
    assert!(app.notifications.shown.as_ref().unwrap().text.contains("too long"));
    let text = sheet(&app).editor.text();
    let taken = text.bytes().zip(long.bytes()).take_while(|(a, b)| a == b).count();
    assert_eq!(taken, 256 << 10);
}

#[test]
fn what_becomes_of_a_watched_file_is_reported() {
    let mut app = own_file();
    let reported =
        |app: &App| app.notifications.shown.clone().map(|notice| notice.text).unwrap_or_default();
    let text = app.lab.as_ref().unwrap().loaded.document.text.clone();
    app.update(AppEvent::FileThere(false));
    assert_eq!(reported(&app), "./my.toml no longer exists; its last valid version keeps running.");
    app.update(AppEvent::FileThere(true));
    app.update(file(&text));
    assert_eq!(reported(&app), "./my.toml exists again.");
    app.update(file(&text.replace("9.81", "1.62")));
    rest(&mut app);
    assert_eq!(reported(&app), "./my.toml: rebuilt in 7 ms; the motion continues.");
}

/// A warning is no error: the system runs, and the lab says what was probably not meant; the editor marks its place.
#[test]
fn a_warning_of_the_text_is_shown_in_the_lab_and_in_the_editor() {
    let text = |unit: &str| {
        format!(
            "title = 'a test'\n[coordinates]\nx = {{ initial = 30, unit = '{unit}' }}\n\
             [parameters]\nidle = 1\n[lagrangian]\nL = \"x'^2 + cos(x)\"\n"
        )
    };
    assert_eq!(begun(&text("rad")).notifications.shown, None);
    let mut app = begun(&text("degree"));
    let shown = app.notifications.shown.clone().expect("a warning");
    let words = "Warning, line 7: `x` is in degrees, but cos takes radians; write cos(x*pi/180)";
    assert!(shown.text.starts_with(words), "{shown:?}");
    assert_eq!(shown.kind, NotificationKind::Warning);
    press(&mut app, "E");
    let buffer = sheet(&app);
    let marked: Vec<(usize, bool)> =
        buffer.diagnostics.iter().map(|one| (one.from.row, one.warning)).collect();
    assert_eq!((marked.as_slice(), buffer.error_count()), (&[(4, true), (6, true)][..], 0));
    // once the text is mended, or its file, nothing of it is left
    replace(&mut app, "degree", "rad");
    rest(&mut app);
    assert_eq!(sheet(&app).diagnostics.len(), 1, "the parameter is still idle");
    assert_eq!(app.notifications.shown, None);
    press(&mut app, "Esc");
    let warned =
        |app: &App| app.notifications.shown.clone().is_some_and(|n| n.text.starts_with("Warning"));
    assert!(!warned(&app), "{:?}", app.notifications.shown);
}

/// What is watched is rebuilt without the editor: the lab says what its new text is warned of, until that is mended.
#[test]
fn a_warning_of_a_watched_file_comes_and_goes() {
    let mut app = own_file();
    let reported = |app: &App| app.notifications.shown.clone().map(|notice| notice.text);
    let text = app.lab.as_ref().unwrap().loaded.document.text.clone();
    let wrong = text.replace("\"rad\"", "\"degree\"");
    assert_ne!(wrong, text);
    app.update(file(&wrong));
    rest(&mut app);
    app.update(AppEvent::Tick(Duration::from_secs(2)));
    let warning = reported(&app).unwrap_or_default();
    assert!(warning.starts_with("Warning, line "), "{warning}");
    app.update(file(&text));
    rest(&mut app);
    let left = |app: &App| reported(app).is_some_and(|text| text.starts_with("Warning"));
    assert!(!left(&app), "{:?}", reported(&app));
    app.update(AppEvent::Tick(Duration::from_secs(2)));
    assert!(!left(&app), "{:?}", reported(&app));
}

/// While the editor is open it shows a warning in its place; the lab says it once the editor is closed, and only once.
#[test]
fn a_warning_of_an_edited_text_is_told_when_the_editor_is_closed() {
    let mut app = own_file();
    let reported = |app: &App| app.notifications.shown.clone().map(|notice| notice.text);
    press(&mut app, "E");
    replace(&mut app, "\"rad\"", "\"degree\"");
    rest(&mut app);
    assert_eq!(reported(&app), None);
    press(&mut app, "Esc");
    let unsaved = reported(&app).unwrap_or_default();
    assert!(unsaved.contains("unsaved changes"), "{unsaved}");
    app.update(AppEvent::Tick(Duration::from_secs(2)));
    let warning = reported(&app).unwrap_or_default();
    assert!(warning.starts_with("Warning, line "), "{warning}");
    app.update(AppEvent::Tick(Duration::from_secs(10)));
    press(&mut app, "E Esc");
    app.update(AppEvent::Tick(Duration::from_secs(2)));
    let again = reported(&app);
    assert!(again.is_none_or(|text| text.contains("unsaved changes")));
    // a warning that was mended before the editor was closed is not told
    press(&mut app, "E");
    replace(&mut app, "\"degree\"", "\"rad\"");
    rest(&mut app);
    press(&mut app, "Esc");
    app.update(AppEvent::Tick(Duration::from_secs(6)));
    assert_eq!(reported(&app), None);
}
