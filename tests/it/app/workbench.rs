//! The workbench: keys, what is asked of the shell, and what its answers change. The answers are given by hand.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use phaselab::app::{
    App, BenchState, Caret, Checked, Effect, Event, Loaded, NotSaved, Over, Plot, Workbench,
};
use phaselab::experiment::{Command, Ready};
use phaselab::preset::Document;

use crate::hand::{catalog, in_lab, loaded, press, snapshot};

fn bench(app: &App) -> &Workbench {
    app.open_workbench().expect("the workbench is open")
}

/// What the shell would answer to a check.
fn checked(app: &App, effect: &Effect) -> Event {
    let Effect::Check { revision, title, text } = effect else { panic!("{effect:?}") };
    assert!(app.awaits(*revision));
    let name = app.lab.as_ref().unwrap().loaded.name.clone();
    let outcome = match Ready::of(&Document::new(title.as_str(), text.as_str())) {
        Ok(Ready { document, model, equations, system, .. }) => {
            Ok(Loaded { name, epoch: 2, document, model, equations, system })
        }
        Err(unready) => Err(unready.mistakes),
    };
    let took = Duration::from_millis(7);
    Event::Checked(Box::new(Checked { revision: *revision, outcome, took }))
}

/// Lets typing rest, answers the check that follows, and returns what is asked for then.
fn rest(app: &mut App) -> Vec<Effect> {
    let effects = app.update(Event::Tick(Duration::from_millis(200)));
    let [effect @ Effect::Check { .. }] = effects.as_slice() else { panic!("{effects:?}") };
    let answer = checked(app, effect);
    app.update(answer)
}

fn edited() -> App {
    let mut app = in_lab();
    assert_eq!(press(&mut app, "E"), []);
    app
}

/// Types in the place of the first of these words.
fn replace(app: &mut App, words: &str, with: &str) {
    press(app, "Ctrl-Home Ctrl-f Ctrl-u");
    app.update(Event::Paste(words.to_owned()));
    press(app, "Enter");
    app.update(Event::Paste(with.to_owned()));
}

#[test]
fn a_change_is_checked_when_typing_rests_and_the_motion_goes_on() {
    let mut app = edited();
    assert_eq!(bench(&app).state, BenchState::Runs(None));
    press(&mut app, "Ctrl-End x");
    assert_eq!(bench(&app).state, BenchState::Changed);
    assert_eq!(app.update(Event::Tick(Duration::from_millis(100))), [], "typing goes on");
    press(&mut app, "Backspace");
    assert_eq!(app.update(Event::Tick(Duration::from_millis(100))), [], "typing goes on");
    let effects = rest(&mut app);
    let [Effect::Tell(Command::TakeUp(moment))] = effects.as_slice() else { panic!("{effects:?}") };
    assert!(moment.running);
    assert_eq!(bench(&app).state, BenchState::Runs(Some(Duration::from_millis(7))));
    assert_eq!(app.lab.as_ref().unwrap().loaded.epoch, 2);
    assert_eq!(app.update(Event::Tick(Duration::from_secs(1))), [], "it is checked once");
}

#[test]
fn what_has_a_name_in_both_texts_is_looked_at_as_before() {
    let mut app = in_lab();
    press(&mut app, "Tab Tab Tab");
    press(&mut app, "+ + z");
    let before = app.lab.as_ref().unwrap().plots.clone();
    press(&mut app, "E");
    replace(
        &mut app,
        "[expect]",
        "[[observables]]\nname = \"new\"\nexpression = \"theta\"\n\n[expect]",
    );
    rest(&mut app);
    let lab = app.lab.as_ref().unwrap();
    assert!(lab.zoomed);
    assert_eq!(lab.plots.len(), before.len());
    let lens = |plots: &[Plot]| plots.iter().filter(|p| matches!(p, Plot::Phase { .. })).count();
    assert_eq!(lens(&lab.plots), lens(&before));
    assert!(lab.loaded.system.channels().iter().any(|channel| channel.name == "new"));
}

#[test]
fn mistakes_stand_in_their_places_until_the_text_is_right_again() {
    let mut app = edited();
    replace(&mut app, "cos(theta)", "cos(thet)");
    assert_eq!(rest(&mut app), [], "the old system goes on");
    let flaw = bench(&app).flaw().expect("a mistake").clone();
    let line = &bench(&app).editor.lines()[flaw.from.row];
    let word: String =
        line.chars().skip(flaw.from.column).take(flaw.to.column - flaw.from.column).collect();
    assert_eq!((word.as_str(), bench(&app).state), ("thet", BenchState::Wrong));
    assert!(flaw.help.as_deref().is_some_and(|help| help.contains("theta")), "{flaw:?}");
    // while the editor is closed a line tells of it
    press(&mut app, "Esc");
    let banner = app.banner().expect("a banner");
    assert!(banner.contains("pendulum.toml:") && banner.contains("thet"), "{banner}");
    press(&mut app, "E Ctrl-Home Ctrl-n");
    assert_eq!(bench(&app).editor.cursor(), flaw.from);
    press(&mut app, "Ctrl-u");
    let effects = rest(&mut app);
    assert!(matches!(effects.as_slice(), [Effect::Tell(Command::TakeUp(_))]), "{effects:?}");
    assert_eq!(bench(&app).flaws, []);
    assert_eq!(app.banner(), None);
}

#[test]
fn next_and_previous_go_round_all_mistakes() {
    let mut app = edited();
    app.update(Event::Paste("oops = 1\n".to_owned()));
    replace(&mut app, "cos(theta)", "cos(thet)");
    rest(&mut app);
    let rows: Vec<usize> = bench(&app).flaws.iter().map(|flaw| flaw.from.row).collect();
    assert_eq!((rows.len(), rows[0]), (2, 0));
    press(&mut app, "Ctrl-Home Ctrl-n");
    assert_eq!(bench(&app).editor.cursor().row, rows[1]);
    press(&mut app, "Ctrl-n");
    assert_eq!(bench(&app).editor.cursor(), Caret::default());
    press(&mut app, "Ctrl-p");
    assert_eq!(bench(&app).editor.cursor().row, rows[1]);
}

#[test]
fn an_answer_to_an_older_text_shows_no_mistakes_and_another_check_follows() {
    let mut app = edited();
    press(&mut app, "Ctrl-Home x");
    let effects = app.update(Event::Tick(Duration::from_millis(200)));
    let answer = checked(&app, &effects[0]);
    press(&mut app, "Backspace");
    assert_eq!(app.update(Event::Tick(Duration::from_secs(1))), [], "one check at a time");
    app.update(answer);
    assert_eq!(bench(&app).flaws, []);
    assert_eq!(rest(&mut app).len(), 1);
}

#[test]
fn an_answer_is_not_wanted_once_another_system_is_open() {
    let mut app = edited();
    press(&mut app, "x");
    let effects = app.update(Event::Tick(Duration::from_millis(200)));
    let Effect::Check { revision, .. } = effects[0] else { panic!("{effects:?}") };
    assert!(app.awaits(revision));
    app.lab.as_mut().unwrap().loaded.name = "planet".to_owned();
    assert!(!app.awaits(revision));
}

#[test]
fn a_shipped_system_is_saved_as_a_copy_and_then_in_its_place() {
    let mut app = edited();
    press(&mut app, "# Enter");
    assert_eq!(press(&mut app, "Ctrl-s"), [], "it asks for a name");
    press(&mut app, "Ctrl-u m i n e");
    let text = bench(&app).editor.text();
    let copy = Effect::SaveCopy { name: "mine".to_owned(), text: text.clone() };
    assert_eq!(press(&mut app, "Enter"), [copy]);
    assert!(bench(&app).is_modified());
    let place = PathBuf::from("/home/me/.config/phaselab/presets/mine.toml");
    app.update(Event::FileSaved(Ok((place.clone(), text.clone()))));
    assert!(!bench(&app).is_modified());
    assert_eq!(app.file(), Some(place.clone()), "the copy is what is open now");
    press(&mut app, "y");
    let later = bench(&app).editor.text();
    assert_eq!(press(&mut app, "Ctrl-s"), [Effect::Save { place, text: later, known: Some(text) }]);
}

#[test]
fn a_name_that_is_taken_is_asked_for_again() {
    let mut app = edited();
    press(&mut app, "Ctrl-s Enter");
    app.update(Event::FileSaved(Err(NotSaved::Exists(PathBuf::from("mine.toml")))));
    assert!(app.notice.as_ref().unwrap().text.contains("exists already"));
    assert!(bench(&app).asking.is_some());
    press(&mut app, "Esc");
    assert!(bench(&app).asking.is_none(), "Esc leaves the question, not the text");
    press(&mut app, "Esc");
    assert!(app.over.is_none());
}

/// A file of one's own in the lab.
fn own_file() -> App {
    let text = &catalog().find("pendulum").unwrap().text;
    let (mut app, _) = App::new(catalog(), Some("./my.toml"));
    let ready = Ready::of(&Document::new("./my.toml", text.as_str())).unwrap();
    let Ready { document, model, equations, system, .. } = ready;
    let name = "./my.toml".to_owned();
    let loaded = Loaded { name, epoch: 1, document, model, equations, system };
    let seen = snapshot(&loaded, 2.0);
    app.update(Event::Loaded(Ok(loaded)));
    app.update(Event::Snapshot(Arc::new(seen)));
    app
}

fn file(text: &str) -> Event {
    Event::FileRead { text: text.to_owned(), asked: false }
}

#[test]
fn a_file_changed_by_another_program_is_written_over_only_on_demand() {
    let mut app = own_file();
    press(&mut app, "E #");
    let save = press(&mut app, "Ctrl-s");
    assert!(matches!(&save[..], [Effect::Save { known: Some(_), .. }]), "{save:?}");
    app.update(Event::FileSaved(Err(NotSaved::Changed)));
    assert!(app.notice.as_ref().unwrap().text.contains("changed by another program"));
    let again = press(&mut app, "Ctrl-s");
    assert!(matches!(&again[..], [Effect::Save { known: None, .. }]), "{again:?}");
    assert_eq!(press(&mut app, "Ctrl-o"), [Effect::Reread(PathBuf::from("./my.toml"))]);
    app.update(Event::FileRead { text: "title = \"Other\"\n".to_owned(), asked: true });
    assert_eq!(bench(&app).editor.text(), "title = \"Other\"\n");
    press(&mut app, "Ctrl-u");
    assert!(bench(&app).editor.text().starts_with('#'), "what stood there can be had back");
}

#[test]
fn a_watched_file_is_taken_up_while_its_editor_is_closed() {
    let mut app = own_file();
    let text = app.lab.as_ref().unwrap().loaded.document.text.clone();
    app.update(file(&text));
    assert_eq!(app.update(Event::Tick(Duration::from_secs(1))), [], "nothing has changed");
    app.update(file(&text.replace("9.81", "1.62")));
    let effects = rest(&mut app);
    assert!(matches!(effects.as_slice(), [Effect::Tell(Command::TakeUp(_))]), "{effects:?}");
    let model = &app.lab.as_ref().unwrap().loaded.model;
    assert!(model.parameters.iter().any(|p| p.value == 1.62));
    assert!(app.over.is_none());
}

#[test]
fn a_file_caught_half_written_is_looked_at_once_more_before_it_is_called_wrong() {
    let mut app = own_file();
    let text = app.lab.as_ref().unwrap().loaded.document.text.clone();
    app.update(file(&text[..text.len() / 2]));
    rest(&mut app);
    assert_eq!(app.banner(), None, "it may still be written");
    app.update(Event::Tick(Duration::from_millis(600)));
    rest(&mut app);
    assert!(app.banner().is_some(), "nobody has completed it");
    app.update(file(&text));
    rest(&mut app);
    assert_eq!(app.banner(), None);
}

#[test]
fn a_watched_file_does_not_replace_what_is_not_saved() {
    let mut app = own_file();
    press(&mut app, "E #");
    let mine = bench(&app).editor.text();
    app.update(file("title = \"Other\"\n"));
    assert_eq!(bench(&app).editor.text(), mine);
    assert!(app.notice.as_ref().unwrap().text.contains("changed by another program"));
}

#[test]
fn what_is_not_saved_of_another_system_is_kept() {
    let mut app = edited();
    press(&mut app, "x y Esc");
    let pendulum = app.lab.as_ref().unwrap().loaded.clone();
    let planet = loaded("planet", 3);
    app.lab.as_mut().unwrap().loaded = planet.clone();
    press(&mut app, "E");
    assert_eq!(bench(&app).editor.text(), planet.document.text);
    press(&mut app, "Esc");
    app.lab.as_mut().unwrap().loaded = pendulum;
    press(&mut app, "E");
    assert!(bench(&app).editor.text().starts_with("xy"));
    assert_eq!(bench(&app).state, BenchState::Changed, "the system was loaded anew meanwhile");
}

#[test]
fn a_text_that_is_not_saved_outlives_the_session() {
    let mut app = edited();
    assert_eq!(app.saved().unwrap().draft, None);
    press(&mut app, "# Enter");
    let saved = app.saved().unwrap();
    let (mut again, _) = App::new(catalog(), Some("pendulum"));
    again.resume(saved);
    again.update(Event::Loaded(Ok(loaded("pendulum", 1))));
    press(&mut again, "E");
    assert_eq!(bench(&again).editor.text(), bench(&app).editor.text());
    assert!(bench(&again).is_modified());
}

#[test]
fn leaving_keeps_the_text_and_coming_back_finds_it() {
    let mut app = edited();
    press(&mut app, "x y Esc");
    assert!(app.notice.as_ref().unwrap().text.contains("not saved"));
    assert!(app.over.is_none());
    // q in the editor is a letter, in the lab it leaves
    press(&mut app, "E q");
    assert!(bench(&app).editor.text().starts_with("xyq"));
    assert!(matches!(app.over, Some(Over::Workbench)));
}

#[test]
fn a_text_that_no_session_would_keep_is_not_lost_at_the_first_q() {
    let mut app = in_lab();
    press(&mut app, "E x Esc");
    // in the lab the session keeps it
    assert_eq!(press(&mut app.clone(), "q"), [Effect::Quit]);
    assert!(app.saved().unwrap().draft.is_some());
    press(&mut app, "Esc");
    assert_eq!(press(&mut app, "q"), []);
    let told = app.notice.clone().unwrap().text;
    assert!(told.ends_with("has changes that are not saved; quit again to lose them."), "{told}");
    assert_eq!(press(&mut app, "q"), [Effect::Quit]);
}
