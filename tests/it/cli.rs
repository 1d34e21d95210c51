//! The command line, run as a program: its output and its exit codes.

mod actions;
mod adiabatic;
mod bracket;
mod capture;
mod check;
mod completions;
mod derive;
mod doctor;
mod dynamics;
mod equilibria;
mod exit;
mod help;
mod hostile;
mod invariants;
mod list;
mod manual;
mod new;
mod options_first;
mod path;
mod plot;
mod ramp;
mod record;
mod reverse;
mod run;
mod section;
mod signals;
mod start_words;
mod step_in_time;
mod sweep;
mod transformations;
mod transformations_beside;
mod transformations_composed;
mod transformations_made;
mod transformations_nearest;
mod transformations_units;
mod wording;
mod write;

use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

/// The result of a command.
pub(crate) struct Done {
    code: i32,
    stdout: String,
    stderr: String,
}

/// The program with a fixed environment: English, UTF-8, an empty home.
pub(crate) fn program(home: &Path) -> Command {
    let mut command = Command::cargo_bin("phaselab").expect("cargo builds the program for tests");
    command
        .env_clear()
        .env("HOME", home)
        .env("LANG", "C.UTF-8")
        .current_dir(home)
        .timeout(std::time::Duration::from_secs(120));
    command
}

pub(crate) fn done(command: &mut Command) -> Done {
    let output = command.output().expect("the program can be started");
    Done {
        code: output.status.code().expect("it exits by itself"),
        stdout: String::from_utf8(output.stdout).expect("UTF-8 on standard output"),
        stderr: String::from_utf8(output.stderr).expect("UTF-8 on standard error"),
    }
}

/// Runs the program in an empty folder.
fn phaselab(arguments: &[&str]) -> Done {
    let home = tempfile::tempdir().expect("a temporary folder");
    done(program(home.path()).args(arguments))
}

/// Runs the program in a folder that contains `system.toml`.
pub(crate) fn with_file(text: &str, arguments: &[&str]) -> Done {
    let home = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(home.path().join("system.toml"), text).expect("a file can be written there");
    done(program(home.path()).args(arguments))
}

impl Done {
    /// The output of a command that must succeed.
    pub(crate) fn success(self) -> String {
        assert_eq!((self.code, self.stderr.as_str()), (0, ""), "{}", self.stdout);
        self.stdout
    }

    pub(crate) fn json(self) -> Value {
        let text = self.success();
        serde_json::from_str(&text).unwrap_or_else(|why| panic!("{why} in {text}"))
    }

    /// Everything that a command wrote, to either stream.
    pub(crate) fn text(self) -> String {
        self.stdout + &self.stderr
    }

    /// Asserts that a command succeeded and wrote these words.
    pub(crate) fn says(self, words: &str) {
        assert_eq!(self.code, 0, "{}", self.stderr);
        assert!(
            self.stdout.contains(words) || self.stderr.contains(words),
            "{} {}",
            self.stdout,
            self.stderr
        );
    }

    /// Asserts that a command failed with a code, wrote nothing to stdout, and reported all of this.
    pub(crate) fn fails(self, code: i32, said: &[&str]) {
        assert_eq!((self.code, self.stdout.as_str()), (code, ""), "{}", self.stderr);
        for words in said {
            assert!(self.stderr.contains(words), "no `{words}` in: {}", self.stderr);
        }
    }
}

/// A pendulum of length 1 with g = 1, started from the bottom with a velocity.
const PENDULUM: &str = r#"
title = "A pendulum"

[coordinates]
theta = { initial = 0.0, velocity = "w" }

[parameters]
m = 2.0
w = 1.0

[lagrangian]
L = "1/2*m*theta'^2 + m*cos(theta)"
"#;

#[test]
fn help_and_version_go_to_standard_output() {
    let help = phaselab(&["--help"]).success();
    for words in ["list", "derive", "check", "run", "methods", "PRESET|FILE", "Exit status"] {
        assert!(help.contains(words), "no `{words}` in {help}");
    }
    assert_eq!(
        phaselab(&["--version"]).success(),
        concat!("phaselab ", env!("CARGO_PKG_VERSION"), "\n")
    );
    for command in ["list", "derive", "check", "bracket", "run", "methods"] {
        assert!(phaselab(&[command, "--help"]).success().contains("Usage:"), "{command}");
    }
}

#[test]
fn wrong_use_is_reported_with_exit_2() {
    phaselab(&["run"]).fails(2, &["PRESET|FILE", "Usage:"]);
    phaselab(&["run", "pendulum", "--format", "xml"]).fails(2, &["xml", "csv", "jsonl"]);
    phaselab(&["run", "pendulum", "--untli", "3"]).fails(2, &["--untli", "--until"]);
    phaselab(&["run", "pendulum", "--every", "1", "--at", "1,2"]).fails(2, &["--every", "--at"]);
    phaselab(&["list", "everything"]).fails(2, &["everything"]);
}

#[test]
fn a_name_that_is_not_found_gets_the_nearest_one() {
    phaselab(&["derive", "pendulm"]).fails(2, &["unknown preset `pendulm`", "`pendulum`"]);
    phaselab(&["run", "heavytop"]).fails(2, &["did you mean `heavy-top`?"]);
    phaselab(&["derive", "./pendulum"]).fails(2, &["cannot read ./pendulum"]);
    phaselab(&["derive", "pendulum.toml"]).fails(2, &["cannot read pendulum.toml"]);
    phaselab(&["check", "pendulum.toml"]).fails(2, &["cannot read pendulum.toml"]);
}

#[test]
fn a_users_preset_comes_before_a_shipped_one() {
    let home = tempfile::tempdir().expect("a temporary folder");
    let folder = home.path().join(".config/phaselab/presets");
    std::fs::create_dir_all(&folder).expect("a folder can be made there");
    std::fs::write(folder.join("pendulum.toml"), PENDULUM).expect("a file can be written there");
    let derived = done(program(home.path()).args(["derive", "pendulum"])).success();
    assert!(derived.starts_with("A pendulum\n"), "{derived}");
    let listed = done(program(home.path()).args(["list"])).success();
    let named = |line: &&str| line.starts_with("    ") && line.contains(" pendulum  ");
    assert_eq!(listed.lines().filter(named).count(), 1, "{listed}");
    assert!(listed.contains("A pendulum (your own)"), "{listed}");
}

/// What is typed in another notation is answered with what to write here.
#[test]
fn another_notation_on_the_command_line_gets_the_right_one() {
    let init = |value: &str| phaselab(&["run", "pendulum", "--init", value]);
    init("theta=1,5").fails(2, &["theta=1,5", "a decimal fraction is written with a point"]);
    init("theta=90°").fails(2, &["angles are in radians", "30*pi/180"]);
    init("theta=90deg").fails(2, &["angles are in radians", "30*pi/180"]);
    phaselab(&["run", "pendulum", "--until", "1,5"]).fails(2, &["written with a point"]);
    // no table of a file is of use to the command line
    let unknown = phaselab(&["run", "pendulum", "--until", "2*T"]);
    assert!(unknown.stderr.contains("`T`") && !unknown.stderr.contains("[parameters]"));
    phaselab(&["run", "pendulum", "l=2"]).fails(2, &["`--set l=2`", "`--init l=2`"]);
    phaselab(&["run", "pendulum", "--l", "2"]).fails(2, &["`--set l=2`"]);
    phaselab(&["run", "pendulum", "--method", "euler"]).fails(2, &["taylor", "leapfrog", "rk4"]);
}

/// `phaselab new spring` writes ./spring.toml, and `run spring` asks for a preset.
#[test]
fn a_file_in_the_folder_is_meant_by_its_name() {
    let home = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(home.path().join("spring.toml"), PENDULUM).expect("it can be written");
    for command in ["run", "check", "derive"] {
        let asked = done(program(home.path()).args([command, "spring"]));
        asked.fails(2, &["unknown preset `spring`; did you mean the file `./spring.toml`?"]);
    }
}

/// A name that promises another format than the rows have is remarked upon; the usual ones are not.
#[test]
fn an_output_named_after_another_format_is_remarked_upon() {
    let written = |name: &str, format: &str| {
        let rows = ["run", "pendulum", "--until", "0.1", "--format", format, "-o", name];
        let done = phaselab(&rows);
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.stderr
    };
    for (name, format, word) in
        [("a.xlsx", "csv", ".xlsx"), ("a.json", "csv", ".json"), ("a.csv", "json", ".csv")]
    {
        assert!(written(name, format).contains(word), "{name}");
    }
    for (name, format) in [("a.csv", "csv"), ("a.dat", "csv"), ("a", "json"), ("a.jsonl", "jsonl")]
    {
        assert_eq!(written(name, format), "", "{name}");
    }
}
