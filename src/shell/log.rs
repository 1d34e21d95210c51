//! The log: what happened and when, in a file, for whoever wants to know it afterwards.
//!
//! In: sentences. Out: lines of a file, each with its time. Never here: the terminal; waiting. Lines are written by a
//! thread of their own; where the disk is slower than what happens, some are left out and their number is reported.

use std::fmt::Display;
use std::fs::{self, File};
use std::io::{self, Write};
use std::mem;
use std::panic;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::thread;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use etcetera::BaseStrategy;
use etcetera::base_strategy::Xdg;

/// Where the log is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LogFile {
    /// `phaselab/phaselab.log` where XDG keeps state.
    Usual,
    /// A file of one's own.
    At(PathBuf),
}

/// Why there is no log, as a sentence for the user.
#[derive(Debug, thiserror::Error)]
#[error("cannot write the log {}: {reason}", .path.display())]
pub struct LogError {
    /// The file.
    path: PathBuf,
    /// What the system says.
    reason: io::Error,
}

/// Lines that may wait to be written.
const WAITING: usize = 1024;

/// How long the end of the program waits for the last lines.
const PATIENCE: Duration = Duration::from_millis(200);

/// What happened, told line by line.
#[derive(Debug, Default)]
pub(super) struct Log {
    writer: Option<Writer>,
}

#[derive(Debug)]
struct Writer {
    lines: SyncSender<String>,
    done: Receiver<()>,
    /// Lines left out since the last that was written.
    lost: u64,
    file: File,
}

impl Log {
    /// A log in a file, to which it adds; the folder is made where there is none.
    pub(super) fn open(place: &LogFile) -> Result<Self, LogError> {
        let path = match place {
            LogFile::At(path) => path.clone(),
            LogFile::Usual => usual().ok_or_else(|| LogError {
                path: "phaselab.log".into(),
                reason: io::Error::new(io::ErrorKind::NotFound, "there is no home folder"),
            })?,
        };
        Self::at(&path).map_err(|reason| LogError { path, reason })
    }

    fn at(path: &Path) -> io::Result<Self> {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let file = File::options().create(true).append(true).open(path)?;
        let mut written = file.try_clone()?;
        let (lines, waiting) = sync_channel::<String>(WAITING);
        let (finished, done) = sync_channel(1);
        thread::Builder::new().name("log".to_owned()).spawn(move || {
            for line in waiting {
                // There is nobody to be reported that it cannot be written.
                let _ = written.write_all(line.as_bytes());
            }
            let _ = finished.send(());
        })?;
        Ok(Self { writer: Some(Writer { lines, done, lost: 0, file }) })
    }

    /// Tells what happened.
    pub(super) fn info(&mut self, what: impl Display) {
        self.tell("info", what);
    }

    /// Tells what went wrong.
    pub(super) fn error(&mut self, what: impl Display) {
        self.tell("error", what);
    }

    fn tell(&mut self, level: &str, what: impl Display) {
        let Some(writer) = &mut self.writer else { return };
        if writer.lost > 0 {
            let line =
                line(SystemTime::now(), "error", &format!("{} lines are missing", writer.lost));
            if writer.lines.try_send(line).is_ok() {
                writer.lost = 0;
            }
        }
        let line = line(SystemTime::now(), level, &what.to_string());
        if let Err(TrySendError::Full(_)) = writer.lines.try_send(line) {
            writer.lost += 1;
        }
    }

    /// Has panics written before they are reported.
    pub(super) fn guard(&self) {
        let Some(file) = self.writer.as_ref().and_then(|w| w.file.try_clone().ok()) else {
            return;
        };
        let report = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            let line = line(SystemTime::now(), "panic", &info.to_string());
            let _ = (&file).write_all(line.as_bytes());
            report(info);
        }));
    }

    /// Waits a little for the last lines to be written.
    pub(super) fn close(&mut self) {
        let Some(Writer { lines, done, .. }) = mem::take(&mut self.writer) else { return };
        drop(lines);
        if let Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) =
            done.recv_timeout(PATIENCE)
        {
            // What a disk does not take in this time is lost.
        }
    }
}

fn usual() -> Option<PathBuf> {
    Some(Xdg::new().ok()?.state_dir()?.join("phaselab").join("phaselab.log"))
}

/// `2026-03-01T12:00:00.250Z error …`; what has several lines is indented after the first.
fn line(time: SystemTime, level: &str, what: &str) -> String {
    let what = what.trim_end().replace('\n', "\n    ");
    format!("{} {level:<5} {what}\n", timestamp(time))
}

/// A time in UTC by ISO 8601, to the millisecond.
fn timestamp(time: SystemTime) -> String {
    let since = time.duration_since(UNIX_EPOCH).unwrap_or_default();
    let (days, second) = (since.as_secs() / 86_400, since.as_secs() % 86_400);
    let (year, month, day) = date(days);
    let (hour, minute) = (second / 3600, second / 60 % 60);
    let (second, milli) = (second % 60, since.subsec_millis());
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{milli:03}Z")
}

/// Year, month and day of the Gregorian calendar, from the days since 1970-01-01. Counted in years that begin in March,
/// so that the day of a leap year comes last: E. G. Richards, *Explanatory Supplement to the Astronomical Almanac*, 15.11.
fn date(days: u64) -> (u64, u64, u64) {
    let days = days + 719_468;
    let (cycle, of_cycle) = (days / 146_097, days % 146_097);
    let year = (of_cycle - of_cycle / 1460 + of_cycle / 36_524 - of_cycle / 146_096) / 365;
    let of_year = of_cycle - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    (year + 400 * cycle + u64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_have_their_dates() {
        for (days, expected) in [
            (0, (1970, 1, 1)),
            (59, (1970, 3, 1)),
            (11_016, (2000, 2, 29)),
            (11_017, (2000, 3, 1)),
            (19_782, (2024, 2, 29)),
            (20_453, (2025, 12, 31)),
            (47_540, (2100, 2, 28)),
            (47_541, (2100, 3, 1)),
        ] {
            assert_eq!(date(days), expected);
        }
        let time = UNIX_EPOCH + Duration::from_millis(951_826_153_042);
        assert_eq!(timestamp(time), "2000-02-29T12:09:13.042Z");
    }

    #[test]
    fn what_is_reported_stands_in_the_file_in_order_and_after_what_was_there() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new/own.log");
        for count in [2, 3] {
            let mut log = Log::open(&LogFile::At(path.clone())).expect("it can be written");
            (0..count).for_each(|n| log.info(format!("line {n}\nand more")));
            log.error("wrong");
            log.close();
            log.info("this comes too late");
        }
        let text = fs::read_to_string(path).expect("a file");
        let said: Vec<_> = text.lines().map(|l| l.get(25..).unwrap_or(l)).collect();
        assert_eq!(said.len(), 2 * (2 + 3) + 2, "{text}");
        assert_eq!((said[0], said[2], said[4]), ("info  line 0", "info  line 1", "error wrong"));
        assert!(text.lines().nth(1).is_some_and(|line| line == "    and more"), "{text}");
    }

    #[test]
    fn a_place_that_cannot_be_written_is_reported_with_its_name() {
        let folder = tempfile::tempdir().expect("a folder");
        let error = Log::open(&LogFile::At(folder.path().to_owned())).expect_err("it is a folder");
        let told = error.to_string();
        assert!(told.contains(&folder.path().display().to_string()), "{told}");
    }

    #[test]
    fn a_log_that_is_not_wanted_costs_nothing() {
        /// Must not be turned into text.
        struct Costly;
        impl Display for Costly {
            fn fmt(&self, _: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                panic!("a line that nobody wants was put together");
            }
        }
        let mut log = Log::default();
        log.info(Costly);
        log.error(Costly);
        log.guard();
        log.close();
        assert!(log.writer.is_none());
    }
}
