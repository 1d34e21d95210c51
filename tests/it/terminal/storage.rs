//! Sessions: saved on every exit, and resumed where they were left.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use rustix::process::Signal;
use tempfile::TempDir;

use super::session::{Session, Setup};

const PROGRAM: &str = env!("CARGO_BIN_EXE_phaselab");

fn lab(arguments: &[&str], state: &Path) -> Session {
    Setup::new(PROGRAM, arguments).size(120, 40).variable("XDG_STATE_HOME", state).start()
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder")
}

fn file(state: &Path) -> PathBuf {
    state.join("phaselab/session.toml")
}

/// The saved session, without the lines about how it ended.
fn kept(state: &Path) -> String {
    fs::read_to_string(file(state)).expect("a session")
}

/// A double pendulum with changed parameters and view, paused; its session is saved at the end.
fn changed(state: &Path) -> Session {
    let mut lab = lab(&["double-pendulum"], state);
    lab.shows("running");
    lab.press("llL");
    lab.press("\t");
    lab.press(" ");
    lab.shows("paused");
    lab.press("..");
    lab.quiet(Duration::from_millis(300));
    lab
}

#[test]
fn quitting_saves_and_resuming_goes_on_bit_by_bit() {
    let state = folder();
    let mut first = changed(state.path());
    let shown = first.text();
    first.press("q");
    assert_eq!(first.ends().0, 0);
    let left = kept(state.path());
    assert!(left.contains("running = false"), "{left}");

    let mut second = lab(&["--resume"], state.path());
    second.shows("paused");
    second.quiet(Duration::from_millis(500));
    // the trail is not saved, but the time is, to the last digit shown
    let time = |text: &str| {
        let number = |rest: &str| Some(rest.split_whitespace().next()?.to_owned());
        let mut words = text.rsplit(" t ").filter_map(number);
        words.find(|word| word.parse::<f64>().is_ok()).expect("the time is shown")
    };
    assert_eq!(time(&second.text()), time(&shown));
    second.press("q");
    assert_eq!(second.ends().0, 0);
    assert_eq!(kept(state.path()), left);
}

#[test]
fn every_signal_saves() {
    for (signal, status) in
        [(Signal::HUP, 129), (Signal::INT, 130), (Signal::QUIT, 131), (Signal::TERM, 143)]
    {
        let state = folder();
        let mut lab = changed(state.path());
        lab.signal(signal);
        assert_eq!(lab.ends().0, status);
        lab.assert_restored();
        assert!(kept(state.path()).contains("double-pendulum"));
    }
}

#[test]
fn a_lost_line_saves() {
    let state = folder();
    let lab = changed(state.path());
    let mut child = lab.hang_up();
    child.wait().expect("it ends");
    assert!(kept(state.path()).contains("double-pendulum"));
}

#[test]
fn a_home_that_cannot_be_written_costs_a_warning() {
    let mut lab = lab(&["pendulum"], Path::new("/proc/nowhere"));
    lab.shows("the session will not be saved");
    lab.press("q");
    assert_eq!(lab.ends().0, 0);
    lab.assert_restored();
}

#[test]
fn the_second_copy_is_reported() {
    let state = folder();
    let mut first = lab(&["pendulum"], state.path());
    first.shows("running");
    let mut second = lab(&["planet"], state.path());
    second.shows("another phaselab is running");
    for lab in [&mut second, &mut first] {
        lab.press("q");
        assert_eq!(lab.ends().0, 0);
    }
    assert!(kept(state.path()).contains("open = \"pendulum\""));
}

#[test]
fn a_session_that_cannot_be_resumed_is_reported_before_the_screen_is_touched() {
    let state = folder();
    let mut none = lab(&["--resume"], state.path());
    assert_eq!(none.ends().0, 2);
    assert!(none.sent().contains("there is no session to resume"), "{}", none.sent());
    fs::create_dir_all(state.path().join("phaselab")).expect("a folder");
    for (text, message) in
        [("version = 9\n", "newer phaselab"), ("version = ]\n", "is not a session")]
    {
        fs::write(file(state.path()), text).expect("it is written");
        let mut lab = lab(&["--resume"], state.path());
        assert_eq!(lab.ends().0, 65);
        assert!(lab.sent().contains(message) && !lab.sent().contains("\x1b[?1049h"));
    }
}

#[test]
fn a_disk_that_is_full_at_the_end_is_reported() {
    let state = folder();
    let mut lab = changed(state.path());
    let folder = state.path().join("phaselab");
    fs::remove_dir_all(&folder).expect("it is there");
    fs::write(&folder, "in the way").expect("it is written");
    lab.press("q");
    assert_eq!(lab.ends().0, 74);
    lab.assert_restored();
    assert!(lab.text().contains("the session could not be saved: cannot write"), "{}", lab.text());
}

#[test]
fn a_configured_resume_of_what_cannot_be_understood_opens_all_the_same() {
    for (text, shown, stays) in [
        ("version = 9\n", "newer phaselab", true),
        ("version = ]\n", "cannot be understood", false),
        ("", "running", false),
    ] {
        let state = folder();
        fs::create_dir_all(state.path().join("phaselab")).expect("a folder");
        fs::write(file(state.path()), text).expect("it is written");
        let setup = Setup::new(PROGRAM, &[]).size(160, 40).variable("XDG_STATE_HOME", state.path());
        let mut lab = setup.variable("PHASELAB_RESUME", "true").start();
        lab.shows("Systems");
        if shown != "running" {
            // it goes by itself, so it is waited for where it is first seen
            lab.shows(shown);
        }
        lab.press("\r");
        lab.shows("running");
        lab.press("q");
        assert_eq!(lab.ends().0, 0);
        assert_eq!(kept(state.path()) == text, stays, "{}", kept(state.path()));
        let aside = state.path().join("phaselab/session-damaged-1.toml");
        let aside = fs::read_to_string(aside).ok();
        assert_eq!(aside.as_deref(), (!stays && !text.is_empty()).then_some(text));
    }
}

#[test]
fn what_is_typed_in_a_second_program_outlives_a_signal() {
    let (state, folder) = (folder(), folder());
    let place = folder.path().join("own.toml");
    let mut first = lab(&["pendulum"], state.path());
    first.shows("running");
    let mut second = edited(state.path(), &place);
    second.signal(Signal::TERM);
    assert_eq!(second.ends().0, 143);
    first.press("q");
    assert_eq!(first.ends().0, 0);
    // under another spelling, and by a link, it is the same file
    let link = folder.path().join("link.toml");
    std::os::unix::fs::symlink(&place, &link).expect("a link");
    for spelled in [folder.path().join("./own.toml"), link] {
        let mut again = lab(&[spelled.to_str().expect("text")], state.path());
        again.shows("E shows them");
        again.press("E");
        again.shows("# mine");
        again.signal(Signal::TERM);
        assert_eq!(again.ends().0, 143);
    }
}

#[test]
fn the_second_saves_the_session_once_the_first_has_ended() {
    let state = folder();
    let mut first = lab(&["pendulum"], state.path());
    first.shows("running");
    let mut second = lab(&["planet"], state.path());
    second.shows("another phaselab is running");
    first.press("q");
    assert_eq!(first.ends().0, 0);
    assert!(kept(state.path()).contains("open = \"pendulum\""));
    second.shows("this one saves the session now");
    second.press("q");
    assert_eq!(second.ends().0, 0);
    assert!(kept(state.path()).contains("open = \"planet\""));
}

#[test]
fn a_pipe_in_the_place_of_a_session_freezes_nothing() {
    use rustix::fs::{CWD, FileType, Mode, mknodat};
    for name in ["session.toml", "texts.toml", "session.lock"] {
        let state = folder();
        let place = state.path().join("phaselab").join(name);
        fs::create_dir_all(state.path().join("phaselab")).expect("a folder");
        mknodat(CWD, &place, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).expect("a pipe");
        let mut lab = lab(&["pendulum"], state.path());
        lab.shows("it is a pipe");
        lab.shows("running");
        lab.press("q");
        assert_eq!(lab.ends().0, 0);
        lab.assert_restored();
    }
}

/// A user's file with unsaved text at its beginning, left for the list of systems.
fn edited(state: &Path, place: &Path) -> Session {
    let text = "title = \"Oscillator\"\n[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\n\
                L = \"1/2*x'^2 - 1/2*x^2\"\n";
    if !place.exists() {
        fs::write(place, text).expect("it is written");
    }
    let mut lab = lab(&[place.to_str().expect("text")], state);
    // a message about another program also mentions running
    lab.shows("Gauges");
    lab.press("E");
    lab.shows("Running this version");
    lab.press("# mine\r");
    lab.shows("rebuilt in");
    lab.press("\x1b");
    lab.shows("E returns to it");
    lab.until("the editor is closed", |lab| !lab.text().contains("Esc close"));
    lab
}

#[test]
fn an_unsaved_text_is_stored_on_every_way_out() {
    let (state, folder) = (folder(), folder());
    let (place, texts) = (folder.path().join("own.toml"), state.path().join("phaselab/texts.toml"));
    let kept = || fs::read_to_string(&texts).unwrap_or_default();
    let mut left = edited(state.path(), &place);
    left.press("\x1b");
    left.shows("Esc again");
    left.press("\x1b");
    left.shows("Systems");
    left.press("q");
    assert_eq!(left.ends().0, 0);
    assert!(kept().contains("# mine"), "{}", kept());
    // another system begins and ends, and the text stays
    let mut other = lab(&["planet"], state.path());
    other.shows("running");
    other.press("q");
    assert_eq!(other.ends().0, 0);
    assert!(kept().contains("# mine"));
    // it is restored when its system is opened again, however the program then ends
    let mut again = lab(&[place.to_str().expect("text")], state.path());
    again.shows("E shows them");
    again.press("E");
    again.shows("# mine");
    again.press("# more\r");
    again.shows("# more");
    again.signal(Signal::TERM);
    assert_eq!(again.ends().0, 143);
    again.assert_restored();
    assert!(kept().contains("# more") && kept().contains("# mine"), "{}", kept());
    // also if the terminal is closed, and if the session is resumed
    let mut resumed = lab(&["--resume"], state.path());
    resumed.shows("E shows them");
    resumed.press("E");
    resumed.shows("rebuilt in");
    resumed.press("# last\r");
    resumed.shows("# last");
    resumed.hang_up().wait().expect("it ends");
    assert!(kept().contains("# last") && kept().contains("# mine"), "{}", kept());
    // what is in the file need not be in the session
    let mut saved = lab(&["--resume"], state.path());
    saved.shows("E shows them");
    saved.press("E");
    saved.shows("rebuilt in");
    saved.press("\x13");
    saved.shows("Saved: ");
    saved.press("\x1b");
    saved.until("the editor is closed", |lab| !lab.text().contains("Esc close"));
    saved.press("q");
    assert_eq!(saved.ends().0, 0);
    assert!(!texts.exists());
    assert!(fs::read_to_string(&place).expect("it is there").contains("# last"));
}

#[test]
fn a_text_that_cannot_be_stored_is_not_lost_at_the_first_q() {
    let (state, folder) = (folder(), folder());
    let mut lab = edited(state.path(), &folder.path().join("own.toml"));
    let place = state.path().join("phaselab");
    fs::remove_dir_all(&place).expect("it is there");
    fs::write(&place, "in the way").expect("it is written");
    lab.press("q");
    lab.shows("quit again to discard them");
    lab.press("q");
    assert_eq!(lab.ends().0, 74);
    lab.assert_restored();
}
