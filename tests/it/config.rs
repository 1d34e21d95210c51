//! The configuration: its contents, the reports on its errors, and the precedence of settings.
//!
//! Each file of `tests/bad-config` has its exact expected report beside it; `UPDATE_EXPECT=1` rewrites the reports.
//! Review them afterwards.

use std::fs;

use phaselab::diagnostic::Document;
use phaselab::shell::config;
use phaselab::shell::options::rows;

use crate::cli::{done, program};
use crate::report_corpus;

#[test]
fn each_error_gives_its_report() {
    report_corpus::compare("tests/bad-config", 20, |document| match config::read(document) {
        Ok(options) => panic!("{} was read as {options:?}", document.path),
        Err(diagnostics) => document.report(&diagnostics, false),
    });
}

/// The default configuration lists the default of every option exactly once.
#[test]
fn the_printed_default_equals_the_defaults() {
    let text = config::default_text();
    let words = config::read(&Document::new("default", text.as_str())).unwrap();
    for row in rows() {
        let word = words.iter().find(|(name, _)| *name == row.name).map(|(_, word)| word);
        assert_eq!(word, Some(&row.usual), "{}", row.name);
        assert!(text.contains(&row.about), "{}", row.name);
        let lines = text.lines().filter(|line| line.starts_with(&format!("{} =", row.name)));
        assert_eq!(lines.count(), 1, "{}", row.name);
        assert!(row.words.iter().all(|(_, about)| text.contains(about)), "{}", row.name);
    }
    assert!(text.lines().all(|line| line.len() <= 80), "{text}");
    let home = tempfile::tempdir().unwrap();
    assert_eq!(done(program(home.path()).args(["config", "print-default"])).success(), text);
}

/// A home with this configuration.
fn home(text: &str) -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join(".config/phaselab");
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("config.toml"), text).unwrap();
    home
}

#[test]
fn a_wrong_configuration_leaves_the_lab_closed() {
    let home = home("color = \"auto\"\nfsp = 30\n");
    let lab = done(program(home.path()).arg("pendulum"));
    let place = format!("{}/.config/phaselab/config.toml:2:1", home.path().display());
    lab.fails(65, &[&place, "fsp = 30", "^^^", "did you mean `fps`?", "1 error in"]);
    // a command without a screen does not read it
    let listed = done(program(home.path()).args(["methods"])).success();
    assert!(listed.contains("taylor"));
}

#[test]
fn a_right_configuration_does_not_stand_in_the_way() {
    let home = home(&config::default_text());
    done(program(home.path()).args(["config", "check"])).fails(0, &[]);
    // the configuration is correct, but there is no terminal here
    done(program(home.path()).arg("pendulum")).fails(2, &["terminal"]);
    done(program(home.path()).env("PHASELAB_FPS", "1000").arg("pendulum"))
        .fails(2, &["PHASELAB_FPS", "from 1 to 240"]);
}

#[test]
fn the_configuration_is_where_its_path_says() {
    let home = tempfile::tempdir().unwrap();
    let usual = home.path().join(".config/phaselab/config.toml");
    let said = done(program(home.path()).args(["config", "path"])).success();
    assert_eq!(said, format!("{}\n", usual.display()));
    let moved = home.path().join("elsewhere");
    let mut command = program(home.path());
    let said = done(command.env("XDG_CONFIG_HOME", &moved).args(["config", "path"])).success();
    assert_eq!(said, format!("{}\n", moved.join("phaselab/config.toml").display()));
    done(program(home.path()).args(["config", "check"])).fails(0, &["there is no configuration"]);
}

#[test]
fn a_file_can_be_checked_before_it_becomes_the_configuration() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("new.toml"), "fps = 10\n").unwrap();
    fs::write(home.path().join("bad.toml"), "fps = 0\n").unwrap();
    done(program(home.path()).args(["config", "check", "new.toml"])).fails(0, &[]);
    done(program(home.path()).args(["config", "check", "bad.toml"]))
        .fails(65, &["bad.toml:1:7", "from 1 to 240"]);
    done(program(home.path()).args(["config", "check", "none.toml"])).fails(2, &["none.toml"]);
}
