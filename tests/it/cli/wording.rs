//! What a wrong request is told: what is wrong, where, and what would be right.

use super::{done, phaselab, program};

#[test]
fn a_number_out_of_range_names_the_range() {
    let refused = |arguments: &[&str], sentence: &str| {
        phaselab(arguments).fails(2, &[sentence]);
    };
    refused(&["invariants", "pendulum", "--degree", "0"], "not a whole number from 1 to 12");
    refused(&["invariants", "pendulum", "--budget=-1"], "a time cannot be negative");
    refused(&["symmetries", "pendulum", "--budget=-1"], "a time cannot be negative");
    refused(&["lyapunov", "pendulum", "--gali", "1"], "not a whole number from 2 to 64");
    refused(&["spectrum", "pendulum", "--count", "2"], "not a whole number from 64 to 65536");
    refused(&["spectrum", "pendulum", "--lines", "x"], "not a whole number from 1 to 64");
    refused(&["section", "henon-heiles", "--threads", "0"], "not a positive whole number");
    refused(&["section", "henon-heiles", "--count=-4"], "not a whole number from 1 to 100000000");
}

#[test]
fn a_name_that_is_not_there_is_reported_with_those_that_are() {
    let all = "unknown parameter or initial value `q`; there are m, l, g, theta0, theta, \
               theta', p_theta, t";
    phaselab(&["sweep", "pendulum", "--grid", "q=1:2:3"]).fails(2, &[all]);
    let family = "unknown parameter `q`; there are m, l, g, theta0, energy, period";
    phaselab(&["orbit", "pendulum", "--along", "q=1:2:3"]).fails(2, &[family]);
    phaselab(&["actions", "double-pendulum"]).fails(2, &["give --coordinate theta1 or theta2"]);
    let lists = "`phaselab list` lists the presets, `phaselab --help` the commands";
    phaselab(&["zzzzzz"]).fails(2, &["unknown command or preset `zzzzzz`", lists]);
}

/// A second name is not taken for a command of the first, and `help` not for a preset.
#[test]
fn words_that_are_no_command_are_called_what_they_are() {
    phaselab(&["help", "actoins"])
        .fails(2, &["unknown command `actoins`; did you mean `actions`?"]);
    let commands = "unknown command `verify`; `phaselab --help` lists the commands";
    phaselab(&["help", "verify"]).fails(2, &[commands]);
    phaselab(&["verify", "pendulum"]).fails(2, &[commands]);
    phaselab(&["help", "pendulum"]).fails(2, &["unknown command `pendulum`; `phaselab --help`"]);
    let second = "the laboratory opens one system: `planet` follows `pendulum`";
    phaselab(&["pendulum", "planet"]).fails(2, &[second]);
    let second = "the laboratory opens one system: `b.toml` follows `a.toml`";
    phaselab(&["a.toml", "b.toml"]).fails(2, &[second]);
}

/// Before a demo is recorded, which takes a while, and not after it.
#[test]
fn a_still_that_cannot_be_drawn_is_reported_at_once() {
    let home = tempfile::tempdir().unwrap();
    // recorded first, its claim would be found false
    std::fs::write(home.path().join("false.demo"), "Wait 0.1s\nAssert t > 1000\n").unwrap();
    let record = |still: &[&str]| {
        let words = [&["record", "pendulum", "--script", "false.demo"], still].concat();
        done(program(home.path()).args(words))
    };
    assert_eq!(record(&[]).code, 65);
    for (still, reported) in [
        (&["--still", "a.png"][..], "a still ends in .svg, .txt or .ans"),
        (&["--still", "a.svg", "--at", "Nowhere"], "unknown marker `Nowhere`"),
    ] {
        let refused = record(still);
        assert_eq!(refused.code, 2, "{}", refused.stderr);
        assert!(refused.stderr.contains(reported), "{}", refused.stderr);
    }
}

#[test]
fn a_missing_folder_is_reported_as_a_folder() {
    let home = tempfile::tempdir().unwrap();
    let run = |words: &[&str]| done(program(home.path()).args(words));
    let new = run(&["new", "nowhere/cart"]);
    assert_eq!(new.stderr, "phaselab: cannot write nowhere/cart.toml: its folder does not exist\n");
    let rows = run(&["run", "pendulum", "--until", "1", "-o", "nowhere/rows.csv"]);
    assert!(rows.stderr.contains("its folder does not exist"), "{}", rows.stderr);
}

/// What is printed can be typed: a shell splits words at spaces.
#[test]
fn a_command_to_be_typed_is_quoted() {
    let home = tempfile::tempdir().unwrap();
    let run = |words: &[&str]| done(program(home.path()).args(words));
    let spaced = run(&["new", "my cart"]);
    assert_eq!(spaced.stdout, "my cart.toml was written; open it with phaselab './my cart.toml'\n");
    assert!(home.path().join("my cart.toml").exists());
}

#[test]
fn without_a_terminal_each_command_names_what_needs_none() {
    let needs = "needs a terminal for its input and output";
    phaselab(&["pendulum"]).fails(2, &[needs, "`phaselab run PRESET` integrates without one"]);
    phaselab(&["play", "pendulum"]).fails(2, &[needs, "`phaselab record PRESET --format account`"]);
    let lesson = phaselab(&["lessons", "kepler"]);
    assert!(!lesson.stderr.contains("phaselab run"), "{}", lesson.stderr);
    lesson.fails(2, &[needs]);
}
