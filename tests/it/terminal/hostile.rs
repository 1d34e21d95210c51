//! The laboratory under adverse conditions: floods of input, closed terminals, multiplexers, full disks.

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::session::{Session, Setup, quits};

const PROGRAM: &str = env!("CARGO_BIN_EXE_phaselab");

fn pendulum() -> Session {
    let mut lab = Setup::new(PROGRAM, &["pendulum"]).size(120, 40).start();
    lab.shows("running");
    lab
}

/// The rows that a terminal of that size shows after the last full repaint.
fn repainted(lab: &Session, (columns, rows): (u16, u16)) -> Vec<String> {
    let sent = lab.sent();
    let mut screen = vt100::Parser::new(rows, columns, 0);
    screen.process(&sent.as_bytes()[sent.rfind("\x1b[2J").unwrap_or(0)..]);
    still(screen.screen().rows(0, columns).map(|row| row.trim_end().to_owned()).collect())
}

/// The rows without the status line, whose rates change all the time.
fn still(mut rows: Vec<String>) -> Vec<String> {
    rows.retain(|row| !row.contains(" fps"));
    rows
}

#[test]
fn a_megabyte_pasted_into_the_palette_is_cut_and_reported() {
    let mut lab = pendulum();
    lab.press(" ");
    lab.shows("paused");
    assert!(!lab.screen().bracketed_paste(), "nothing is typed");
    lab.press(":");
    lab.until("pastes come in brackets", |lab| lab.screen().bracketed_paste());
    lab.press(&format!("\x1b[200~{}\x1b[201~", "energy q\r ".repeat(100_000)));
    lab.shows("too long");
    lab.press("\x1b");
    lab.until("pastes are plain again", |lab| !lab.screen().bracketed_paste());
    quits(lab);
}

#[test]
fn a_storm_of_sizes_ends_in_what_a_fresh_picture_shows() {
    let mut lab = pendulum();
    lab.press(" ");
    lab.shows("paused");
    let mut seed = 7_u32;
    let mut random = |most: u32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        ((seed >> 16) % most) as u16
    };
    for step in 0..300 {
        match step % 60 {
            0 => lab.resize(0, 0),
            1 => lab.resize(1, 1),
            2 => lab.resize(500, 500),
            _ => lab.resize(random(300), random(100)),
        }
    }
    lab.resize(100, 30);
    lab.until("the last size is painted", |lab| {
        repainted(lab, (100, 30)).last().is_some_and(|row| row.contains("q quit"))
    });
    lab.quiet(Duration::from_millis(300));
    let after_the_storm = repainted(&lab, (100, 30));
    let before = lab.sent.len();
    lab.press("\x0c");
    lab.until("all is painted anew", |lab| {
        String::from_utf8_lossy(&lab.sent[before..]).contains("\x1b[2J")
    });
    lab.quiet(Duration::from_millis(300));
    assert_eq!(repainted(&lab, (100, 30)), after_the_storm);
    lab.press("q");
    assert_eq!(lab.ends().0, 0);
}

#[test]
fn a_terminal_that_does_not_know_the_marks_gets_none() {
    let mut lab = Setup::new(PROGRAM, &["pendulum", "--no-sync"]).size(120, 40).start();
    lab.shows("running");
    lab.bytes_in(Duration::from_millis(300));
    assert!(!lab.sent().contains("\x1b[?2026h"));
    lab.press("q");
    assert_eq!(lab.ends().0, 0);
}

/// The number of bytes that the program has written so far, to the terminal and elsewhere.
#[cfg(target_os = "linux")]
fn written(lab: &Session) -> u64 {
    let counts = format!("/proc/{}/io", lab.pid().as_raw_nonzero());
    let counts = fs::read_to_string(counts).expect("it runs");
    let count = counts.lines().find_map(|line| line.strip_prefix("wchar: ")?.parse().ok());
    count.expect("a count")
}

/// The time that each frame sent so far has shown.
fn times(lab: &Session) -> Vec<f64> {
    let mut screen = vt100::Parser::new(40, 120, 0);
    let sent = lab.sent();
    let shown = sent.split("\x1b[?2026l").filter_map(|frame| {
        screen.process(frame.as_bytes());
        let text = screen.screen().contents();
        text.rsplit(" t ").find_map(|rest| rest.split_whitespace().next()?.parse().ok())
    });
    shown.collect()
}

#[test]
#[cfg(target_os = "linux")]
fn time_goes_on_behind_a_stalled_terminal() {
    let mut lab = pendulum();
    lab.until("the time is shown", |lab| times(lab).last().is_some_and(|time| *time > 0.0));
    lab.stalled(|lab| {
        // repainted until nothing more is taken, for as long as many frames would last
        let mut before = 0;
        while before != written(lab) {
            before = written(lab);
            (0..30).for_each(|_| {
                lab.press("\x0c");
                std::thread::sleep(Duration::from_millis(10));
            });
        }
    });
    // the next frame is where the motion is, and not where it was
    lab.until("the time has gone on", |lab| {
        times(lab).windows(2).any(|pair| pair[1] - pair[0] > 0.25)
    });
    quits(lab);
}

#[test]
fn the_log_tells_what_happened_and_the_terminal_does_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("own.log");
    let option = format!("--log={}", path.display());
    let mut lab = Setup::new(PROGRAM, &[option.as_str(), "pendulum"]).size(120, 40).start();
    lab.shows("running");
    lab.press(" ");
    lab.shows("paused");
    lab.press("q");
    assert_eq!(lab.ends().0, 0);
    lab.assert_restored();
    let log = fs::read_to_string(&path).expect("a log");
    for said in [
        "starts",
        "TERM=xterm-256color",
        "load pendulum",
        "loaded pendulum",
        "command Pause",
        "ends: Quit",
    ] {
        assert!(log.contains(said), "no {said:?} in {log}");
    }
    assert!(!lab.sent().contains("command Pause"));

    let mut refused = Setup::new(PROGRAM, &["--log=/dev/null/log", "pendulum"]).start();
    assert_eq!(refused.ends().0, 74);
    assert!(refused.text().contains("/dev/null/log"), "{}", refused.text());
}

#[test]
fn a_reader_who_goes_away_ends_a_run_quietly() {
    let mut run = Command::new(PROGRAM)
        .args(["run", "pendulum", "--until", "100000", "--every", "0.01", "--format", "jsonl"])
        .env("HOME", "/nonexistent")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(run.stdout.take());
    let done = run.wait_with_output().expect("it ends");
    assert_eq!(String::from_utf8_lossy(&done.stderr), "");
    assert_eq!(done.status.code(), Some(0));
}

/// The output of a command, or `None` if there is no such program.
fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let done = Command::new(program).args(arguments).output().ok()?;
    Some(String::from_utf8_lossy(&done.stdout).into_owned())
}

#[test]
fn tmux_shows_what_was_drawn() {
    let socket = format!("phaselab-{}", std::process::id());
    let found = output("tmux", &["-V"]).is_some();
    assert!(found, "there is no tmux: install it (Debian: apt-get install tmux)");
    let tmux = |arguments: &[&str]| {
        let all: Vec<&str> =
            ["-u", "-f", "/dev/null", "-L", &socket].iter().chain(arguments).copied().collect();
        output("tmux", &all).unwrap_or_default()
    };
    let program = format!("env LANG=C.UTF-8 HOME=/nonexistent {PROGRAM} pendulum");
    tmux(&["new-session", "-d", "-x", "120", "-y", "30", &program]);
    let screen = || tmux(&["capture-pane", "-p"]);
    let shows = |what: &str| {
        let end = Instant::now() + Duration::from_secs(20);
        while !screen().contains(what) {
            if Instant::now() > end {
                let text = screen();
                tmux(&["kill-server"]);
                panic!("never {what:?} in\n{text}");
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    };
    shows("running");
    tmux(&["send-keys", " "]);
    shows("paused");
    // A repaint gives the same screen: tmux has handled every cell correctly.
    let settled = || {
        let mut last = screen();
        loop {
            std::thread::sleep(Duration::from_millis(300));
            let now = screen();
            if now == last {
                return now;
            }
            last = now;
        }
    };
    let drawn = settled();
    tmux(&["send-keys", "C-l"]);
    let anew = settled();
    tmux(&["send-keys", "q"]);
    tmux(&["kill-server"]);
    let rows = |screen: &str| still(screen.lines().map(|row| row.trim_end().to_owned()).collect());
    assert_eq!(rows(&anew), rows(&drawn));
    for stray in ["rgb:", "?1;2c", "\u{fffd}", "[<", "[I", "[O"] {
        assert!(!drawn.contains(stray), "{stray:?} in\n{drawn}");
    }
    assert!(drawn.contains("Simple pendulum") && drawn.contains("q quit"), "{drawn}");
    assert!(drawn.contains('╭') && drawn.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c)));
}

/// asciinema, or where it is not installed `script`: the demo has a terminal there that answers nothing, and ends by itself.
#[test]
fn a_program_that_records_terminals_records_the_demo() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("demo");
    let path = file.to_str().expect("a plain path");
    let demo = format!("{PROGRAM} --demo");
    let asciinema = ["rec", "--headless", "--window-size", "80x24", "-c", &demo, path];
    let script = ["-qefc", &demo, path];
    let (program, arguments) = match output("asciinema", &["--version"]) {
        Some(_) => ("asciinema", &asciinema[..]),
        None => ("script", &script[..]),
    };
    let mut recorder = Command::new(program)
        .args(arguments)
        .env_clear()
        .env("PATH", std::env::var_os("PATH").unwrap_or_default())
        .env("TERM", "xterm-256color")
        .env("LANG", "C.UTF-8")
        .env("HOME", folder.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("asciinema or script (Debian: util-linux, bsdutils)");
    // whoever records types nothing; the pipe stays open
    let keyboard = recorder.stdin.take();
    let status = recorder.wait().expect("it ends");
    drop(keyboard);
    assert!(status.success(), "{program}: {status}");
    let cast = fs::read_to_string(&file).expect("a recording");
    assert!(cast.contains("[?1049h") && cast.contains("[?1049l"), "{}", cast.len());
    assert!(cast.contains("Double pendulum"), "{program} has recorded {} bytes", cast.len());
}

/// A chain of pendulums with a kinetic energy of the fourth degree, which takes seconds to derive.
fn heavy() -> String {
    let mut text = "title = \"Chain\"\n[coordinates]\n".to_owned();
    let sum = |k: usize, term: &dyn Fn(usize) -> String| {
        (1..=k).map(term).collect::<Vec<_>>().join(" + ")
    };
    let mut terms = Vec::new();
    for k in 1..=64 {
        text += &format!("a{k} = {{ initial = 0.5 }}\n");
        let x = sum(k, &|i| format!("cos(a{i})*a{i}'"));
        let y = sum(k, &|i| format!("sin(a{i})*a{i}'"));
        terms.push(format!("1/2*(({x})^2 + ({y})^2)*(1 + ({x})^2)"));
    }
    text + &format!("[lagrangian]\nL = \"{}\"\n", terms.join(" + "))
}

const RIGHT: &str = "title = \"Oscillator\"\n[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\n\
                     L = \"1/2*x'^2 - 1/2*x^2\"\n";

/// The names of its threads.
#[cfg(target_os = "linux")]
fn threads(lab: &Session) -> Vec<String> {
    let tasks = format!("/proc/{}/task", lab.pid().as_raw_nonzero());
    let names = fs::read_dir(tasks).expect("it runs").flatten();
    names.filter_map(|task| fs::read_to_string(task.path().join("comm")).ok()).collect()
}

#[test]
#[cfg(target_os = "linux")]
fn what_is_no_longer_loaded_or_checked_leaves_no_thread() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("heavy.toml");
    fs::write(&place, heavy()).expect("written");
    let mut lab = Setup::new(PROGRAM, &[]).argument(&place).size(120, 40).start();
    lab.shows("Esc cancels");
    // a thread has its name a moment after it was begun
    lab.until("it is being loaded", |lab| threads(lab).iter().any(|name| name.trim() == "loader"));
    std::thread::sleep(Duration::from_millis(500));
    lab.press("\x1b");
    lab.shows("was cancelled");
    lab.until("its thread has ended", |lab| {
        threads(lab).iter().all(|name| name.trim() != "loader")
    });
    // the next is loaded at once
    lab.press("/pendulum\r");
    lab.shows("running");
    // a text that takes long to check, and then one that does not
    lab.press("E");
    lab.shows("Running this version");
    lab.press("\x1b[200~");
    lab.press(&heavy());
    lab.press("\x1b[201~");
    lab.press("\x03");
    assert_eq!(lab.ends().0, 0);
    lab.assert_restored();
}

#[test]
fn a_signal_while_something_is_loaded_ends_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("heavy.toml");
    fs::write(&place, heavy()).expect("written");
    for key in [None, Some("\x03"), Some("q")] {
        let mut lab = Setup::new(PROGRAM, &[]).argument(&place).size(120, 40).start();
        lab.shows("Esc cancels");
        match key {
            None => lab.signal(rustix::process::Signal::TERM),
            Some(key) => lab.press(key),
        }
        assert_eq!(lab.ends().0, if key.is_none() { 143 } else { 0 });
        lab.assert_restored();
    }
}

#[test]
fn a_right_text_is_taken_although_a_heavy_one_is_being_loaded() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("own.toml");
    fs::write(&place, heavy()).expect("written");
    let mut lab = Setup::new(PROGRAM, &["--watch"]).argument(&place).size(120, 40).start();
    lab.shows("Esc cancels");
    fs::write(&place, RIGHT).expect("written");
    lab.shows("running");
    // and the same once it runs
    fs::write(&place, heavy()).expect("written");
    #[cfg(target_os = "linux")]
    lab.until("it is being loaded", |lab| {
        threads(lab).iter().any(|name| ["loader", "checker"].contains(&name.trim()))
    });
    fs::write(&place, RIGHT.replace("Oscillator", "The second one")).expect("written");
    lab.shows("The second one");
    quits(lab);
}

#[test]
fn a_file_that_becomes_a_pipe_freezes_nothing() {
    use rustix::fs::{CWD, FileType, Mode, mknodat};
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("own.toml");
    fs::write(&place, RIGHT).expect("written");
    let mut lab = Setup::new(PROGRAM, &["--watch"]).argument(&place).size(120, 40).start();
    lab.shows("running");
    fs::remove_file(&place).expect("it goes");
    mknodat(CWD, &place, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).expect("a pipe");
    lab.shows("no longer exists");
    lab.press(" ");
    lab.shows("paused");
    // failures to save it and to read it again are reported with their reason
    lab.press("E");
    lab.shows("Running this version");
    lab.press("\x0f");
    lab.shows("it is a pipe, not a file");
    lab.press("# mine\r\x13");
    lab.shows("cannot read");
    lab.press("\x03");
    assert_eq!(lab.ends().0, 0);
    let mut none = Setup::new(PROGRAM, &[]).argument(&place).start();
    assert_eq!(none.ends().0, 2);
    assert!(none.sent().contains("it is a pipe, not a file"), "{}", none.sent());
}
