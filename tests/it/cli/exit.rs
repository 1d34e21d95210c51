//! Exit codes: each row of the table has a case, and there are no other codes.

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use phaselab::cli::EXITS;

use super::{PENDULUM, done, phaselab, program};

/// Codes that only occur on a terminal; `terminal::lab` and `terminal::page` test them.
const ON_A_TERMINAL: [&str; 3] = ["101", "129", "131"];

/// Runs until it receives a signal.
fn signalled(signal: &str) -> i32 {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("system.toml"), PENDULUM).unwrap();
    let long = ["run", "system.toml", "--until", "1e9", "--every", "0.1", "-o", "out.csv"];
    let mut child = Command::new(assert_cmd::cargo::cargo_bin("phaselab"))
        .args(long)
        .current_dir(home.path())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // the partial file exists once signals are handled
    let deadline = Instant::now() + Duration::from_secs(60);
    while fs::read_dir(home.path()).unwrap().count() < 2 {
        assert!(Instant::now() < deadline, "no output within a minute");
        std::thread::yield_now();
    }
    let reported = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    assert!(reported.success());
    child.wait().unwrap().code().unwrap()
}

#[cfg(unix)]
#[test]
fn every_code_of_the_table_is_given() {
    let singular = PENDULUM.replace("1/2*m*theta'^2", "1/2*m*(theta^2 - 1)*theta'^2");
    let wrong = "title = 3\n";
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("system.toml"), PENDULUM).unwrap();
    fs::write(home.path().join("singular.toml"), singular).unwrap();
    fs::write(home.path().join("wrong.toml"), wrong).unwrap();
    let code = |arguments: &[&str]| done(program(home.path()).args(arguments)).code;
    let cases = [
        (0, phaselab(&["list"]).code),
        (1, code(&["run", "singular.toml"])),
        (2, code(&["run", "system.toml", "--method", "none"])),
        (2, phaselab(&["pendulum"]).code),
        (65, code(&["derive", "wrong.toml"])),
        (65, code(&["config", "check", "wrong.toml"])),
        (74, code(&["run", "system.toml", "-o", "no/such/folder.csv"])),
        (130, signalled("-INT")),
        (143, signalled("-TERM")),
    ];
    for (expected, given) in cases {
        assert_eq!(given, expected);
    }
    let shown = |code: &str| cases.iter().any(|(given, _)| given.to_string() == code);
    for exit in EXITS {
        assert!(shown(exit.code) || ON_A_TERMINAL.contains(&exit.code), "{} is not", exit.code);
    }
    for (given, _) in cases {
        assert!(EXITS.iter().any(|exit| exit.code == given.to_string()), "{given} has no row");
    }
}

/// What is asked for wrongly ends alike in every command, also with numbers that begin with a sign.
#[test]
fn wrong_use_ends_with_two() {
    for (words, said) in [
        (&["lyapunov", "pendulum", "--until", "0"][..], "the end lies after the start"),
        (&["lyapunov", "pendulum", "--gali", "9", "--until", "10"], "GALI takes from 2"),
        (&["run", "pendulum", "--flow-of", "action"], "not a function of its state"),
        (&["orbit", "pendulum", "--period", "-1"], "a period must be above zero"),
        (&["section", "pendulum", "--on", "theta", "--count", "-1"], "invalid value '-1'"),
        (
            &["path", "pendulum", "--in", "1", "--to", "theta=1", "--to", "theta=2"],
            "--to gives theta twice",
        ),
    ] {
        phaselab(words).fails(2, &[said]);
    }
}
