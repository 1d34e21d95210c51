//! The workbench as a user experiences it: typing, errors, saving, and a file changed in another editor.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::session::{Session, Setup, quits};

const PROGRAM: &str = env!("CARGO_BIN_EXE_phaselab");

const FILE: &str = r#"title = "Oscillator"
[coordinates]
x = { initial = 1.0, velocity = 0.0 }
[parameters]
k = 4.0
[lagrangian]
L = "1/2*x'^2 - 1/2*k*x^2"
"#;

/// A folder with a file, and the lab with that file.
fn open(options: &[&str]) -> (TempDir, PathBuf, Session) {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("own.toml");
    fs::write(&place, FILE).expect("it can be written");
    let mut lab = Setup::new(PROGRAM, options).argument(&place).size(120, 40).start();
    lab.shows("running");
    (folder, place, lab)
}

#[test]
fn a_file_is_edited_while_it_runs() {
    let (_folder, place, mut lab) = open(&[]);
    lab.press("E");
    lab.shows("Running this version");
    // the search finds k, and another name is typed over it
    lab.press("\x06k = \r");
    lab.press("q = ");
    lab.shows("still running the last valid version");
    quits_from_bench(lab, &place);
}

/// Makes a valid change, saves it and leaves.
fn quits_from_bench(mut lab: Session, place: &Path) {
    lab.press("\x06\x15q = 4\rk = 9");
    lab.shows("rebuilt in");
    lab.press("\x13");
    lab.shows("Saved: ");
    let saved = fs::read_to_string(place).expect("it is there");
    assert_eq!(saved, FILE.replace("k = 4.0", "k = 9.0"));
    lab.press("\x1b");
    lab.until("the editor is closed", |lab| !lab.text().contains("Esc close"));
    lab.shows("running");
    quits(lab);
}

#[test]
fn a_file_saved_elsewhere_is_taken_up_and_errors_do_not_stop_the_motion() {
    let (_folder, place, mut lab) = open(&["--watch"]);
    fs::write(&place, FILE.replace("k = 4.0", "kk = 4.0")).expect("it can be written");
    lab.shows("own.toml:");
    lab.shows("running");
    let half = &FILE[..FILE.len() / 2];
    fs::write(&place, half).expect("it can be written");
    let right = FILE.replace("Oscillator", "Another name");
    fs::write(&place, right).expect("it can be written");
    lab.shows("Another name");
    lab.shows("rebuilt in");
    lab.until("the error is forgotten", |lab| {
        !lab.text().contains("still running the last valid version")
    });
    let text = fs::read_to_string(&place).expect("it is there");
    fs::remove_file(&place).expect("it goes");
    lab.shows("no longer exists");
    fs::write(&place, text).expect("it can be written");
    lab.shows("exists again");
    quits(lab);
}

#[test]
fn a_watched_file_that_is_wrong_at_first_opens_once_it_is_right() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("own.toml");
    fs::write(&place, FILE.replace("k = 4.0", "kk = 4.0")).expect("it can be written");
    let mut lab = Setup::new(PROGRAM, &["--watch"]).argument(&place).size(120, 40).start();
    lab.shows("own.toml has errors");
    // another error, and then none
    fs::write(&place, format!("unknown = 1\n{FILE}")).expect("it can be written");
    lab.shows("`unknown`");
    fs::write(&place, FILE).expect("it can be written");
    lab.shows("running");
    quits(lab);
}

#[test]
fn what_is_shipped_has_no_file_to_be_watched() {
    let mut lab = Setup::new(PROGRAM, &["--watch", "pendulum"]).start();
    assert_eq!(lab.ends().0, 2);
    assert!(lab.text().contains("no file to be watched"), "{}", lab.text());
    // if the variable is set out of habit, it has no effect
    let setup = Setup::new(PROGRAM, &["pendulum"]).variable("PHASELAB_WATCH", "true");
    let mut habit = setup.start();
    habit.shows("Phase");
    quits(habit);
}

#[test]
fn a_long_paste_is_taken_into_the_text() {
    let (_folder, _place, mut lab) = open(&[]);
    lab.press("E");
    lab.shows("Running this version");
    lab.until("pastes come in brackets", |lab| lab.screen().bracketed_paste());
    lab.press("\x1b[1;5H");
    lab.shows("  1:1");
    let long = "# a line that is pasted, one of very many\n".repeat(4000);
    lab.press(&format!("\x1b[200~{long}\x1b[201~"));
    lab.shows("4001:1");
    lab.shows("rebuilt in");
    lab.press("\x1b[200~");
    lab.press(&"x".repeat(300_000));
    lab.press("\x1b[201~");
    lab.shows("too long");
    lab.press("\x1b");
    lab.until("the editor is closed", |lab| !lab.text().contains("Esc close"));
    lab.press("q");
    assert_eq!(lab.ends().0, 0);
}
