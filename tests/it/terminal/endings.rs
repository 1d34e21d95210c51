//! Endings imposed from outside: signals, closed terminals, panics on them; and the return after a suspension.
//!
//! Times are measured; retries separate delays of a loaded machine from those of the program.

use std::path::Path;
use std::time::{Duration, Instant};

use rustix::process::Signal;

use super::session::{Session, Setup};

const PROGRAM: &str = env!("CARGO_BIN_EXE_phaselab");

/// The number of attempts for an operation with a time limit.
const TRIES: usize = 6;

/// Asserts on the least time of several attempts, which stop once one is short enough.
#[track_caller]
fn in_time(bar: Duration, mut run: impl FnMut() -> Duration) {
    let mut times = Vec::new();
    while times.len() < TRIES {
        times.push(run());
        if times.last().is_some_and(|time| *time < bar) {
            return;
        }
    }
    panic!("never within {bar:?}: {times:?}");
}

fn pendulum() -> Session {
    let mut lab = Setup::new(PROGRAM, &["pendulum"]).size(120, 40).start();
    lab.shows("running");
    lab
}

#[test]
fn a_signal_ends_a_moving_lab_in_a_fifth_of_a_second() {
    let signals =
        [(Signal::TERM, 143), (Signal::HUP, 129), (Signal::INT, 130), (Signal::QUIT, 131)];
    for (signal, status) in signals {
        in_time(Duration::from_millis(200), || {
            let mut lab = pendulum();
            lab.signal(signal);
            let (ended, took) = lab.ends();
            assert_eq!(ended, status, "{signal:?}");
            lab.assert_restored();
            took
        });
    }
}

#[test]
fn every_signal_that_ends_a_program_gives_the_terminal_back() {
    let signals = [
        (Signal::USR1, 138),
        (Signal::USR2, 140),
        (Signal::ALARM, 142),
        (Signal::XCPU, 152),
        (Signal::VTALARM, 154),
        (Signal::PROF, 155),
        (Signal::ABORT, 134),
        #[cfg(target_os = "linux")]
        (Signal::POWER, 158),
        #[cfg(target_os = "linux")]
        (Signal::STKFLT, 144),
    ];
    for (signal, status) in signals {
        let mut lab = pendulum();
        lab.signal(signal);
        assert_eq!(lab.ends().0, status, "{signal:?}");
        lab.assert_restored();
    }
}

#[test]
fn a_line_that_dies_in_a_panic_leaves_nobody_behind() {
    let mut panicked = 0;
    in_time(Duration::from_secs(1), || {
        let mut page = Setup::page().size(200, 60).start();
        page.shows("clock");
        // A terminal that reads nothing blocks the panic where the screen is restored; then it is closed.
        page.press("f");
        page.stalled(|page| {
            std::thread::sleep(Duration::from_millis(500));
            page.press("p");
            std::thread::sleep(Duration::from_millis(50));
        });
        let start = Instant::now();
        let status = page.hang_up().wait().expect("a child of ours");
        let took = start.elapsed();
        assert_eq!(status.signal(), None, "no abort: {status:?}");
        assert!([101, 129].contains(&status.exit_code()), "{status:?}");
        panicked += u32::from(status.exit_code() == 101);
        // if the terminal closed before the key was read, the panic is still to be tried
        if panicked == 0 { Duration::from_secs(60) } else { took }
    });
}

#[test]
fn after_a_stop_everything_is_painted_and_nothing_is_asked() {
    let mut lab = pendulum();
    lab.press(" ");
    lab.shows("paused");
    lab.quiet(Duration::from_millis(300));
    let picture = |screen: &vt100::Screen| -> Vec<String> {
        let rows: Vec<String> = screen.rows(0, 120).collect();
        rows.into_iter().filter(|row| !row.contains(" fps")).collect()
    };
    let before = picture(lab.screen());
    lab.press("\x1a");
    lab.stops();
    lab.assert_restored();
    let from = lab.sent.len();
    lab.signal(Signal::CONT);
    lab.until("the whole picture came again", |lab| {
        let mut fresh = vt100::Parser::new(40, 120, 0);
        fresh.process(&lab.sent[from..]);
        picture(fresh.screen()) == before
    });
    let sent = lab.sent();
    // Neither questions nor a keyboard protocol: `CSI > … u` would ask for one.
    for question in ["\x1b[6n", "\x1b[>", "\x1b[=", "\x1b[5n"] {
        assert!(!sent.contains(question), "{question:?}");
    }
    // The background is asked for once, at the start.
    assert_eq!(sent.matches("\x1b]11;?").count(), 1);
    assert_eq!(sent.matches("\x1b[c").count(), 1);
    lab.press("q");
    assert_eq!(lab.ends().0, 0);
}

/// The processor time of a process, and whether it has exited without being waited for; `None` if it is gone.
#[cfg(target_os = "linux")]
fn spent(id: &str) -> Option<(Duration, bool)> {
    let stat = std::fs::read_to_string(Path::new("/proc").join(id).join("stat")).ok()?;
    // after the name, which may contain anything: state, …, and as the 12th and 13th user and system time in hundredths
    let fields: Vec<&str> = stat.rsplit_once(") ")?.1.split(' ').collect();
    let ticks: u64 = fields.get(11)?.parse::<u64>().ok()? + fields.get(12)?.parse::<u64>().ok()?;
    Some((Duration::from_millis(10 * ticks), fields[0] == "Z"))
}

/// Closes the terminal of a lab; returns how long the lab then lived, and its processor time.
#[cfg(target_os = "linux")]
fn closed(line: &str) -> (Duration, Duration) {
    let folder = tempfile::tempdir().expect("a folder");
    let report = folder.path().join("id");
    let mut lab = Setup::new("sh", &["-c", line]).argument(PROGRAM).argument(&report).start();
    lab.shows("Phase");
    let id = std::fs::read_to_string(&report).expect("its number");
    let id = id.trim();
    let (before, _) = spent(id).expect("it runs");
    let start = Instant::now();
    let mut child = lab.hang_up();
    let mut last = before;
    while let Some((now, ended)) = spent(id) {
        last = now;
        if ended {
            break;
        }
        assert!(start.elapsed() < Duration::from_secs(20), "it does not end");
        std::thread::sleep(Duration::from_millis(2));
    }
    let lived = start.elapsed();
    child.wait().expect("a child of ours");
    (lived, last.saturating_sub(before))
}

#[test]
#[cfg(target_os = "linux")]
fn a_dead_line_ends_it_soon_and_without_a_loop() {
    let lines = [
        // as when a terminal is closed
        "echo $$ > \"$1\"; exec \"$0\" pendulum",
        // no process is notified
        "trap '' HUP; echo $$ > \"$1\"; exec \"$0\" pendulum",
        // in a separate session
        "trap '' HUP; setsid --wait sh -c 'echo $$ > \"$1\"; exec \"$0\" pendulum' \"$0\" \"$1\"",
    ];
    for line in lines {
        let mut spent = Duration::MAX;
        in_time(Duration::from_secs(2), || {
            let (lived, took) = closed(line);
            spent = spent.min(took);
            lived
        });
        assert!(spent < Duration::from_millis(200), "{spent:?} of the processor: {line}");
    }
}
