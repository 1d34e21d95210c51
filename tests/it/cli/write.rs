//! Output: files that appear atomically, readers that close early, full disks.

use std::fs;
use std::io::Read;
use std::process::Stdio;

use super::{PENDULUM, done, program};

/// A folder that contains the pendulum.
fn folder() -> tempfile::TempDir {
    let home = tempfile::tempdir().expect("a temporary folder");
    fs::write(home.path().join("system.toml"), PENDULUM).expect("a file can be written there");
    home
}

#[test]
fn a_file_appears_whole_and_stdout_stays_empty() {
    let home = folder();
    let arguments = ["run", "system.toml", "-o", "out.csv"];
    assert_eq!(done(program(home.path()).args(arguments)).success(), "");
    let written = fs::read_to_string(home.path().join("out.csv")).expect("the file is there");
    assert_eq!(written, done(program(home.path()).args(["run", "system.toml"])).success());
    assert_eq!(fs::read_dir(home.path()).expect("the folder").count(), 2, "nothing else is left");
}

#[test]
fn a_failure_leaves_the_old_file_alone() {
    let home = folder();
    let out = home.path().join("out.csv");
    fs::write(&out, "old").expect("a file can be written there");
    let wrong = ["run", "system.toml", "-o", "out.csv", "--observe", "nothing"];
    done(program(home.path()).args(wrong)).fails(2, &["nothing"]);
    assert_eq!(fs::read_to_string(&out).expect("it is there"), "old");
}

#[test]
fn what_is_replaced_is_reported() {
    let home = folder();
    let run = || done(program(home.path()).args(["run", "system.toml", "-o", "out.csv"]));
    let reported = |done: super::Done| (done.code, done.stdout, done.stderr);
    assert_eq!(reported(run()), (0, String::new(), String::new()));
    let replaced = "phaselab: out.csv is replaced\n".to_owned();
    assert_eq!(reported(run()), (0, String::new(), replaced));
    // a device is not a file with content
    let null = ["run", "system.toml", "-o", "/dev/null"];
    assert_eq!(done(program(home.path()).args(null)).stderr, "");
}

/// The file that is read is the one most easily named by mistake.
#[test]
fn a_file_that_describes_a_system_is_not_replaced() {
    let home = folder();
    let before = fs::read_to_string(home.path().join("system.toml")).expect("it is there");
    for command in ["run", "invariants", "symmetries", "orbit"] {
        let words = [command, "system.toml", "-o", "system.toml"];
        done(program(home.path()).args(words))
            .fails(2, &["system.toml describes a system, and is not replaced"]);
    }
    assert_eq!(fs::read_to_string(home.path().join("system.toml")).expect("it is there"), before);
}

#[test]
fn an_error_still_brings_its_rows_to_the_file() {
    let home = folder();
    let falling = PENDULUM.replace("m*cos(theta)", "1/(theta + 1)").replace("\"w\"", "-1.0");
    fs::write(home.path().join("fall.toml"), falling).expect("a file can be written there");
    let fall = done(program(home.path()).args(["run", "fall.toml", "-o", "out.csv"]));
    assert_eq!((fall.code, fall.stdout.as_str()), (1, ""), "{}", fall.stderr);
    let written = fs::read_to_string(home.path().join("out.csv")).expect("the file is there");
    assert!(written.lines().count() > 4 && written.contains("# faulted: "), "{written}");
}

#[test]
fn a_place_that_cannot_be_written_is_exit_74() {
    let home = folder();
    let run = |path: &str| done(program(home.path()).args(["run", "system.toml", "-o", path]));
    run("no/such/folder/out.csv").fails(74, &["cannot write no/such/folder/out.csv"]);
    run("/dev/full").fails(74, &["cannot write /dev/full", "no space left"]);
}

#[test]
fn a_full_standard_output_is_exit_74() {
    let home = folder();
    for arguments in [&["run", "system.toml"][..], &["list"], &["derive", "system.toml"]] {
        let full = fs::File::options().write(true).open("/dev/full").expect("/dev/full is there");
        let program = assert_cmd::cargo::cargo_bin("phaselab");
        let output = std::process::Command::new(program)
            .args(arguments)
            .current_dir(home.path())
            .stdout(full)
            .stderr(Stdio::piped())
            .output()
            .expect("the program can be started");
        let reported = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(74), "{arguments:?}: {reported}");
        assert!(reported.contains("cannot write standard output"), "{reported}");
    }
}

#[test]
fn a_reader_that_leaves_ends_it_quietly() {
    let home = folder();
    for format in ["csv", "json", "jsonl"] {
        let long = ["run", "system.toml", "--until", "1e9", "--every", "0.01", "--format", format];
        let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("phaselab"))
            .args(long)
            .current_dir(home.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program can be started");
        let mut first = [0; 100];
        let mut stdout = child.stdout.take().expect("a pipe");
        stdout.read_exact(&mut first).expect("something comes");
        drop(stdout);
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{format}");
        assert_eq!(output.status.code(), Some(0), "{format}");
    }
}

#[test]
fn progress_is_shown_to_nobody_but_a_terminal() {
    let home = folder();
    let long = ["run", "system.toml", "--at", "20000"];
    let done = done(program(home.path()).args(long));
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
}

#[cfg(unix)]
#[test]
fn a_signal_ends_a_run_with_its_rows_written() {
    let home = folder();
    let long = ["run", "system.toml", "--until", "1e9", "--every", "0.1", "-o", "out.csv"];
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("phaselab"))
        .args(long)
        .current_dir(home.path())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program can be started");
    // the partial file exists once signals are handled
    let deadline = std::time::Instant::now() + std::time::Duration::from_secs(60);
    while fs::read_dir(home.path()).expect("the folder").count() < 2 {
        assert!(std::time::Instant::now() < deadline, "no output within a minute");
        std::thread::yield_now();
    }
    let reported = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .expect("kill can be started");
    assert!(reported.success());
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    let written = fs::read_to_string(home.path().join("out.csv")).expect("the file is there");
    assert!(written.ends_with("# stopped: stopped by a signal\n"), "{written}");
}

/// Whatever a command writes: where nobody reads any more it ends quietly, and where there is no room it says so.
#[cfg(unix)]
#[test]
fn all_commands_end_alike_where_their_output_ends() {
    let home = folder();
    let commands: [&[&str]; 14] = [
        &["list"],
        &["--help"],
        &["run", "--help"],
        &["man"],
        &["completions", "bash"],
        &["doctor"],
        &["methods"],
        &["lessons"],
        &["theme", "list"],
        &["config", "print-default"],
        &["derive", "system.toml"],
        &["check", "--format", "json", "system.toml"],
        &["equilibria", "system.toml"],
        &["run", "system.toml", "--until", "1"],
    ];
    for arguments in commands {
        let into = |stdout: Stdio| {
            let output = std::process::Command::new(assert_cmd::cargo::cargo_bin("phaselab"))
                .args(arguments)
                .current_dir(home.path())
                .env("HOME", home.path())
                .stdout(stdout)
                .stderr(Stdio::piped())
                .spawn()
                .and_then(std::process::Child::wait_with_output)
                .expect("the program can be started");
            (output.status.code(), String::from_utf8(output.stderr).expect("UTF-8"))
        };
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        assert_eq!(into(Stdio::from(writer)), (Some(0), String::new()), "{arguments:?}");
        let full = fs::File::options().write(true).open("/dev/full").expect("a full device");
        let (code, message) = into(Stdio::from(full));
        assert_eq!(code, Some(74), "{arguments:?}: {message}");
        assert!(message.contains("cannot write standard output"), "{arguments:?}: {message}");
        let shell = std::process::Command::new("sh")
            .args(["-c", "exec \"$0\" \"$@\" >&-"])
            .arg(assert_cmd::cargo::cargo_bin("phaselab"))
            .args(arguments)
            .current_dir(home.path())
            .env("HOME", home.path())
            .output()
            .expect("a shell");
        let message = String::from_utf8(shell.stderr).expect("UTF-8");
        assert_eq!(shell.status.code(), Some(74), "{arguments:?}: {message}");
        assert!(
            message.contains("cannot write standard output: it is closed"),
            "{arguments:?}: {message}"
        );
    }
}

/// What has nothing to write needs no standard output, and `/dev/null` is one.
#[cfg(unix)]
#[test]
fn a_command_that_writes_nothing_does_without_standard_output() {
    let home = folder();
    for redirected in [
        "check system.toml >&-",
        "run system.toml --until 1 -o out.csv >&-",
        "run system.toml --until 1 >/dev/null",
        "run system.toml --until 1 1<>/dev/null",
    ] {
        let code = std::process::Command::new("sh")
            .args(["-c", &format!("exec \"$0\" {redirected}")])
            .arg(assert_cmd::cargo::cargo_bin("phaselab"))
            .current_dir(home.path())
            .env("HOME", home.path())
            .stderr(Stdio::null())
            .status()
            .expect("a shell")
            .code();
        assert_eq!(code, Some(0), "{redirected}");
    }
}
