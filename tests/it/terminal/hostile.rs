//! The laboratory where the world is unkind: floods, lost lines, multiplexers, full disks.

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::session::{Session, Setup};

const PROGRAM: &str = env!("CARGO_BIN_EXE_phaselab");

fn pendulum() -> Session {
    let mut lab = Setup::new(PROGRAM, &["pendulum"]).size(120, 40).start();
    lab.shows("running");
    lab
}

#[track_caller]
fn quits(mut lab: Session) {
    lab.press("q");
    assert_eq!(lab.ends().0, 0);
    lab.assert_restored();
}

/// The rows that a terminal of that size shows after the last time everything was painted.
fn repainted(lab: &Session, (columns, rows): (u16, u16)) -> Vec<String> {
    let sent = lab.sent();
    let mut screen = vt100::Parser::new(rows, columns, 0);
    screen.process(&sent.as_bytes()[sent.rfind("\x1b[2J").unwrap_or(0)..]);
    still(screen.screen().rows(0, columns).map(|row| row.trim_end().to_owned()).collect())
}

/// The rows without the status line, whose rates change with every look at them.
fn still(mut rows: Vec<String>) -> Vec<String> {
    rows.retain(|row| !row.ends_with(" fps"));
    rows
}

#[test]
fn a_megabyte_pasted_into_the_palette_is_cut_and_told() {
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

#[test]
fn time_goes_on_behind_a_stalled_terminal() {
    let time = |lab: &Session| {
        let text = lab.text();
        let after =
            text.rsplit(" t ").find_map(|rest| rest.split_whitespace().next()?.parse().ok());
        after.unwrap_or(f64::NAN)
    };
    let mut lab = pendulum();
    lab.until("the time is shown", |lab| time(lab) > 0.0);
    let before = time(&lab);
    lab.stalled(|_| std::thread::sleep(Duration::from_secs(2)));
    lab.until("two seconds have passed", |lab| time(lab) > before + 1.9);
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

/// What a command prints; `None` where there is no such program.
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
    // What is painted anew is what was there: tmux has taken every cell as it was meant.
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
