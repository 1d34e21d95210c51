//! Signals: every command ends within a fifth of a second with 128 + n; a run keeps its rows so far.
//!
//! Times are measured; retries separate delays of a loaded machine from those of the program.

use std::fs::{self, File};
use std::io::{Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};

use super::PENDULUM;

/// The greatest time that termination may take.
const BAR: Duration = Duration::from_millis(200);

/// The number of attempts for an operation with a time limit.
const TRIES: usize = 6;

/// The greatest time to wait for anything.
const PATIENCE: Duration = Duration::from_secs(60);

const SIGNALS: [(Signal, i32); 4] =
    [(Signal::HUP, 129), (Signal::INT, 130), (Signal::QUIT, 131), (Signal::TERM, 143)];

fn command(home: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("phaselab"));
    command.env_clear().env("HOME", home).env("LANG", "C.UTF-8").current_dir(home);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn signal(child: &Child, signal: Signal) {
    let id = i32::try_from(child.id()).unwrap();
    kill_process(Pid::from_raw(id).unwrap(), signal).unwrap();
}

/// Waits for a child and returns its exit status.
fn end(child: &mut Child) -> Option<i32> {
    let deadline = Instant::now() + PATIENCE;
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return status.code();
        }
        if Instant::now() > deadline {
            let _ = child.kill();
            panic!("it never ends");
        }
        thread::sleep(Duration::from_millis(1));
    }
}

/// Starts a program, waits until `ready`, and asserts that a signal ends it in time. Returns the child of the last try.
#[track_caller]
fn ends(
    mut start: impl FnMut() -> Child,
    ready: impl Fn(&mut Child),
    by: Signal,
    code: i32,
) -> Child {
    let mut times = Vec::new();
    while times.len() < TRIES {
        let mut child = start();
        ready(&mut child);
        let begun = Instant::now();
        signal(&child, by);
        let ended = end(&mut child);
        times.push(begun.elapsed());
        assert_eq!(ended, Some(code), "{by:?}");
        if begun.elapsed() < BAR {
            return child;
        }
    }
    panic!("never within {BAR:?}: {times:?}");
}

/// Creates a named pipe in a folder.
fn pipe(home: &Path, name: &str) {
    assert!(Command::new("mkfifo").arg(home.join(name)).status().unwrap().success());
}

/// Waits until signals are handled: the thread that does so has its name.
fn watching(child: &mut Child) {
    let tasks = format!("/proc/{}/task", child.id());
    let deadline = Instant::now() + PATIENCE;
    let watches = || {
        let names = fs::read_dir(&tasks).into_iter().flatten().flatten();
        let mut names = names.map(|task| fs::read_to_string(task.path().join("comm")));
        names.any(|name| name.is_ok_and(|name| name.trim() == "signals"))
    };
    while !watches() {
        assert!(Instant::now() < deadline, "nobody watches for signals");
        thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_command_that_waits_for_its_file_is_ended() {
    let home = tempfile::tempdir().unwrap();
    pipe(home.path(), "in.toml");
    // the other end is open, and nothing is ever written
    let open = File::options().read(true).write(true).open(home.path().join("in.toml")).unwrap();
    let commands: [&[&str]; 8] = [
        &["check", "in.toml"],
        &["derive", "in.toml"],
        &["bracket", "in.toml", "x", "y"],
        &["run", "in.toml"],
        &["play", "./in.toml"],
        &["script", "check", "in.toml"],
        &["config", "check", "in.toml"],
        &["record", "pendulum", "--script", "in.toml"],
    ];
    for (i, arguments) in commands.iter().enumerate() {
        let (by, code) = SIGNALS[i % SIGNALS.len()];
        ends(|| command(home.path(), arguments).spawn().unwrap(), watching, by, code)
            .wait()
            .unwrap();
    }
    drop(open);
}

/// Starts a run whose output is not read, and waits until it can write no more.
fn stalled(home: &Path, format: &str) -> Child {
    let arguments = ["run", "system.toml", "--until", "1e9", "--every", "0.01", "--format", format];
    command(home, &arguments).stdout(Stdio::piped()).spawn().unwrap()
}

/// Waits until the child blocks on its reader: it sleeps, and continues to sleep.
fn waiting(child: &mut Child) {
    watching(child);
    let stat = format!("/proc/{}/stat", child.id());
    let sleeps = || {
        let stat = fs::read_to_string(&stat).unwrap_or_default();
        let state = stat.rsplit_once(") ").and_then(|(_, rest)| rest.chars().next());
        state == Some('S')
    };
    let deadline = Instant::now() + PATIENCE;
    let mut asleep = 0;
    while asleep < 20 {
        assert!(Instant::now() < deadline, "it never waits");
        asleep = if sleeps() { asleep + 1 } else { 0 };
        thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_run_whose_reader_is_stalled_is_ended() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("system.toml"), PENDULUM).unwrap();
    for (by, code) in SIGNALS {
        ends(|| stalled(home.path(), "csv"), waiting, by, code).wait().unwrap();
    }
}

#[test]
fn a_run_into_a_pipe_without_a_reader_is_ended() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("system.toml"), PENDULUM).unwrap();
    pipe(home.path(), "out");
    let start = || command(home.path(), &["run", "system.toml", "-o", "out"]).spawn().unwrap();
    ends(start, waiting, Signal::TERM, 143).wait().unwrap();
}

/// Reads all output, so that nothing stalls.
fn with_reader(home: &Path, format: &str) -> (Child, thread::JoinHandle<String>) {
    let mut child = stalled(home, format);
    let mut out = child.stdout.take().unwrap();
    // the first bytes show that rows are being written
    let mut text = vec![0; 10_000];
    out.read_exact(&mut text).unwrap();
    let reader = thread::spawn(move || {
        out.read_to_end(&mut text).unwrap();
        String::from_utf8(text).unwrap()
    });
    (child, reader)
}

#[test]
fn a_run_that_is_ended_has_written_its_rows_and_its_end() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("system.toml"), PENDULUM).unwrap();
    for (format, (by, code)) in ["csv", "json", "jsonl"].into_iter().zip(SIGNALS) {
        let (mut child, reader) = with_reader(home.path(), format);
        signal(&child, by);
        assert_eq!(end(&mut child), Some(code));
        let text = reader.join().unwrap();
        let stopped = "stopped by a signal";
        match format {
            "csv" => assert!(text.ends_with(&format!("# stopped: {stopped}\n")), "{text}"),
            "json" => {
                let read: serde_json::Value = serde_json::from_str(&text).unwrap();
                assert_eq!(
                    (&read["status"], &read["message"]),
                    (&"stopped".into(), &stopped.into())
                );
                assert!(!read["invariants"].as_array().unwrap().is_empty());
            }
            _ => {
                let last = text.lines().last().unwrap();
                let read: serde_json::Value = serde_json::from_str(last).unwrap();
                assert_eq!(read["status"], "stopped");
            }
        }
    }
}

/// Starts a command, ends it by a signal and returns what it has written, once that is `enough`: it is given longer each time.
fn ended(
    home: &Path,
    arguments: &[&str],
    (by, code): (Signal, i32),
    enough: impl Fn(&str) -> bool,
) -> String {
    let mut time = Duration::from_millis(50);
    while time < PATIENCE {
        let mut child = command(home, arguments).stdout(Stdio::piped()).spawn().unwrap();
        let mut out = child.stdout.take().unwrap();
        let reader = thread::spawn(move || {
            let mut text = String::new();
            out.read_to_string(&mut text).unwrap();
            text
        });
        watching(&mut child);
        thread::sleep(time);
        signal(&child, by);
        assert_eq!(end(&mut child), Some(code), "{arguments:?}");
        let text = reader.join().unwrap();
        if enough(&text) {
            return text;
        }
        time *= 2;
    }
    panic!("never enough: {arguments:?}");
}

/// The end of a run of many impulses takes longer to write than a command has to end: the object is complete all the same,
/// also in a file.
#[test]
fn a_run_of_many_impulses_that_is_ended_lists_them() {
    let home = tempfile::tempdir().unwrap();
    let text = "title = \"Kicks\"\n[coordinates]\nx = { initial = 0, velocity = 1 }\n\
        [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n\
        [[impulses]]\nname = \"kick\"\nevery = 1e-6\nchange = { p_x = \"1e-9\" }\n";
    fs::write(home.path().join("system.toml"), text).unwrap();
    // nothing is there of a run that has not begun, and no events are listed where the signal finds it within a long step
    let many = |text: &str| {
        let read = serde_json::from_str::<serde_json::Value>(text);
        let read = read.unwrap_or_else(|error| {
            assert!(text.is_empty(), "{error}: {}", text.len());
            serde_json::Value::Null
        });
        read["events"].as_array().is_some_and(|events| events.len() > 10_000)
    };
    let to_output = ["run", "system.toml", "--until=1e9", "--format=json"];
    let text = ended(home.path(), &to_output, (Signal::INT, 130), many);
    assert!(many(&text), "{} bytes", text.len());
    let to_file = ["run", "system.toml", "--until=1e9", "--format=json", "-o", "out.json"];
    let (mut text, mut time) = (String::new(), Duration::from_millis(500));
    while !many(&text) && time < PATIENCE {
        let mut child = command(home.path(), &to_file).spawn().unwrap();
        watching(&mut child);
        thread::sleep(time);
        signal(&child, Signal::TERM);
        end(&mut child);
        text = fs::read_to_string(home.path().join("out.json")).unwrap_or_default();
        time *= 2;
    }
    assert!(many(&text), "{} bytes", text.len());
}

/// A section that is ended has the crossings so far, in an object that is complete.
#[test]
fn a_section_that_is_ended_has_what_it_has() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("system.toml"), PENDULUM).unwrap();
    let arguments = ["section", "system.toml", "--on=theta", "--until=1e9", "--format=json"];
    let read = |text: &str| serde_json::from_str::<serde_json::Value>(text).ok();
    let crossings = |text: &str| read(text)?["orbits"][0]["crossings"].as_u64();
    let crossed = |text: &str| crossings(text).is_some_and(|crossings| crossings > 0);
    let text = ended(home.path(), &arguments, (Signal::INT, 130), crossed);
    let read = read(&text).unwrap();
    let orbit = &read["orbits"][0];
    assert_eq!(orbit["status"], "stopped");
    assert_eq!(orbit["message"], "stopped by a signal");
    assert_eq!(read["rows"].as_array().unwrap().len() as u64, orbit["crossings"]);
}

/// Actions at so many energies that they take long: those so far are written, in every format, with the reason.
#[test]
fn actions_that_are_ended_have_the_rows_so_far() {
    let home = tempfile::tempdir().unwrap();
    let text = "title = \"Quartic\"\n[coordinates]\nx = { initial = 1 }\n\
                [lagrangian]\nL = \"1/2*x'^2 - 1/4*x^4\"\n";
    fs::write(home.path().join("system.toml"), text).unwrap();
    let energies: Vec<String> = (1..=10_000).map(|energy| energy.to_string()).collect();
    let energies = format!("--energy={}", energies.join(","));
    let some = |text: &str| !text.is_empty();
    for (format, by) in [("csv", (Signal::INT, 130)), ("json", (Signal::TERM, 143))] {
        let format = format!("--format={format}");
        let arguments = ["actions", "system.toml", &energies, &format];
        let text = ended(home.path(), &arguments, by, some);
        let rows = if format == "--format=csv" {
            assert!(text.ends_with("# stopped: stopped by a signal\n"), "{text}");
            text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit())).count()
        } else {
            let read: serde_json::Value = serde_json::from_str(&text).unwrap();
            let end = (&read["status"], &read["message"]);
            assert_eq!(end, (&"stopped".into(), &"stopped by a signal".into()));
            read["rows"].as_array().unwrap().len()
        };
        assert!((1..10_000).contains(&rows), "{rows} rows: {}", &text[..text.len().min(300)]);
    }
}

/// What a section has when it is ended is written to whoever reads; a reader that takes nothing is not waited for.
#[test]
fn a_section_whose_reader_is_stalled_is_ended() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("system.toml"), PENDULUM).unwrap();
    let arguments = ["section", "system.toml", "--on=theta", "--until=1e9", "--format=json"];
    // a pipe that is full before anything is written
    pipe(home.path(), "full");
    let path = home.path().join("full");
    let flags = rustix::fs::OFlags::NONBLOCK.bits() as i32;
    let mut filler =
        File::options().read(true).write(true).custom_flags(flags).open(&path).unwrap();
    while filler.write(&[b' '; 4096]).is_ok() {}
    while filler.write(b" ").is_ok() {}
    let into = || File::options().write(true).open(&path).unwrap();
    let start = || command(home.path(), &arguments).stdout(into()).spawn().unwrap();
    ends(start, watching, Signal::TERM, 143).wait().unwrap();
}

/// Under `nohup` the program must continue when the terminal hangs up.
#[test]
fn nohup_is_heeded() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("system.toml"), PENDULUM).unwrap();
    let program = assert_cmd::cargo::cargo_bin("phaselab");
    let mut child = Command::new("nohup")
        .arg(program)
        .args(["run", "system.toml", "--until", "1e9", "--every", "0.01", "-o", "/dev/null"])
        .current_dir(home.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    watching(&mut child);
    signal(&child, Signal::HUP);
    thread::sleep(Duration::from_millis(50));
    assert_eq!(child.try_wait().unwrap(), None, "it goes on");
    signal(&child, Signal::TERM);
    assert_eq!(end(&mut child), Some(143));
}

#[test]
fn a_signal_wins_over_a_full_disk() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("system.toml"), PENDULUM).unwrap();
    // there are few rows, so that nothing is written before the signal
    let long = ["run", "system.toml", "--until", "1e9", "--every", "1e8"];
    let full = || File::options().write(true).open("/dev/full").unwrap();
    let start = || command(home.path(), &long).stdout(full()).spawn().unwrap();
    ends(start, watching, Signal::TERM, 143).wait().unwrap();
}

#[test]
fn a_signal_leaves_no_half_of_a_file_and_a_kill_leaves_one_that_is_swept() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("system.toml"), PENDULUM).unwrap();
    let names = || {
        let entries = fs::read_dir(home.path()).unwrap().flatten();
        let mut names: Vec<_> = entries.map(|entry| entry.file_name()).collect();
        names.sort();
        names
    };
    // one that has rows, and so is known to whatever cleans up
    let begun = || {
        let files = fs::read_dir(home.path()).unwrap().flatten();
        let mut partial =
            files.filter(|entry| entry.file_name().to_string_lossy().ends_with(".partial"));
        partial.any(|entry| entry.metadata().is_ok_and(|about| about.len() > 0))
    };
    let partial = |child: &mut Child| {
        watching(child);
        let deadline = Instant::now() + PATIENCE;
        while !begun() {
            assert!(Instant::now() < deadline, "no output within a minute");
            thread::yield_now();
        }
    };
    let long = ["run", "system.toml", "--until", "1e9", "--every", "0.1", "-o", "out.csv"];
    let mut child = command(home.path(), &long).spawn().unwrap();
    partial(&mut child);
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(names().iter().any(|name| name.to_string_lossy().ends_with(".partial")));
    let short = ["run", "system.toml", "--at", "0", "-o", "out.csv"];
    assert_eq!(end(&mut command(home.path(), &short).spawn().unwrap()), Some(0));
    assert_eq!(names(), ["out.csv", "system.toml"]);
    // after two signals it exits at once, and cleans up
    fs::remove_file(home.path().join("out.csv")).unwrap();
    let mut child = command(home.path(), &long).spawn().unwrap();
    partial(&mut child);
    signal(&child, Signal::INT);
    signal(&child, Signal::TERM);
    assert!([Some(130), Some(143)].contains(&end(&mut child)));
    assert!(!names().iter().any(|name| name.to_string_lossy().ends_with(".partial")));
}

/// Whatever a command does, a signal ends it with its own exit code: the failure of the work that it stopped is not
/// reported in its place.
#[test]
fn every_command_that_computes_is_ended_with_the_code_of_the_signal() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("long.demo"), "Open double-pendulum\nSize 80x24\nWait 3000s\n")
        .unwrap();
    let commands: [&[&str]; 11] = [
        &["run", "double-pendulum", "--until", "1e9", "-o", "/dev/null"],
        &["section", "henon-heiles", "--on", "x", "--until", "1e9"],
        &[
            "sweep",
            "double-pendulum",
            "--until=1e6",
            "--grid=theta1=1:2:9",
            "--measure=crossings=theta1",
        ],
        &["lyapunov", "double-pendulum", "--until", "1e9"],
        &["flow", "double-pendulum", "--until", "1e9"],
        &["orbit", "pendulum", "--along", "energy=-9:9:10000"],
        &["equilibria", "double-pendulum"],
        &["invariants", "henon-heiles", "--degree", "12"],
        &["symmetries", "heavy-top", "--budget", "1e9"],
        &["record", "double-pendulum", "--script", "long.demo"],
        &["script", "check", "long.demo"],
    ];
    for (i, arguments) in commands.iter().enumerate() {
        for delay in [0, 40, 160] {
            let (by, code) = SIGNALS[(i + delay) % SIGNALS.len()];
            let mut child = command(home.path(), arguments).spawn().unwrap();
            watching(&mut child);
            thread::sleep(Duration::from_millis(delay as u64));
            if child.try_wait().unwrap().is_some() {
                // it was done before
                continue;
            }
            signal(&child, by);
            let ended = end(&mut child);
            assert!(ended == Some(code) || ended == Some(0), "{arguments:?}: {ended:?}");
        }
    }
}

/// The motion has a thousand million periods until the claim, so that its budget lasts for seconds.
#[test]
fn a_check_that_is_stopped_says_before_which_claim_and_where() {
    let home = tempfile::tempdir().unwrap();
    let text = "title = \"Fast\"\n[coordinates]\nx = { initial = 1 }\n[lagrangian]\n\
        L = \"1/2*x'^2 - 1/2*1e12*x^2 - 1e12*x^4\"\n[expect]\nvalues = [{ name = \"x\", expression = \"x\", at = 1e4, is = 0.5 }]\n";
    fs::write(home.path().join("fast.toml"), text).unwrap();
    let mut delay = Duration::from_millis(200);
    let said = loop {
        let mut command = command(home.path(), &["check", "fast.toml"]);
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        thread::sleep(delay);
        signal(&child, Signal::INT);
        let code = end(&mut child);
        let mut said = String::new();
        child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        // sooner the motion had not begun
        if said.contains("was checked") || delay > PATIENCE {
            break (code, said);
        }
        delay *= 2;
    };
    assert_eq!(said.0, Some(130), "{}", said.1);
    assert!(said.1.contains("of the motion, before `x` was checked"), "{}", said.1);
}
