//! The log: what happened and when, in a file, for later diagnosis.
//!
//! In: events of `tracing`, from any thread. Out: lines of a file, each with its time and level. Never here: the
//! terminal; waiting. A separate thread writes the lines; if the disk cannot keep up, some are dropped and their
//! number is reported at the end.

use std::fmt;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

use etcetera::BaseStrategy;
use etcetera::base_strategy::Xdg;
use tracing::{Event, Subscriber};
use tracing_appender::non_blocking::{ErrorCounter, NonBlocking, WorkerGuard};
use tracing_subscriber::fmt::format::Writer;
use tracing_subscriber::fmt::time::{FormatTime, SystemTime};
use tracing_subscriber::fmt::{FmtContext, FormatEvent, FormatFields};
use tracing_subscriber::registry::LookupSpan;

use crate::printable;

/// Where the log is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LogFile {
    /// `phaselab/phaselab.log` where XDG keeps state.
    Usual,
    /// A file chosen by the user.
    At(PathBuf),
}

/// The error if the log cannot be written, as a sentence for the user.
#[derive(Debug, thiserror::Error)]
#[error("cannot write the log {}: {}", printable::path(.path), printable::why(.reason))]
pub struct LogError {
    path: PathBuf,
    reason: io::Error,
}

/// How long the end of the program waits for the last lines.
const TIMEOUT: Duration = Duration::from_millis(200);

#[derive(Debug)]
pub(super) struct Log {
    writer: WorkerGuard,
    lost: ErrorCounter,
}

impl Log {
    /// Sends the events of all threads to a file, appending to its contents; the folder is created if needed.
    pub(super) fn open(place: &LogFile) -> Result<Self, LogError> {
        let path = match place {
            LogFile::At(path) => path.clone(),
            LogFile::Usual => usual().ok_or_else(|| LogError {
                path: "phaselab.log".into(),
                reason: io::Error::new(io::ErrorKind::NotFound, "there is no home folder"),
            })?,
        };
        let (log, subscriber) = Self::at(&path).map_err(|reason| LogError { path, reason })?;
        // There is one log per program: if there is one already, it stays in use.
        let _ = tracing::subscriber::set_global_default(subscriber);
        Ok(log)
    }

    fn at(path: &Path) -> io::Result<(Self, impl Subscriber + Send + Sync + use<>)> {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let file = File::options().create(true).append(true).open(path)?;
        let (lines, writer) = NonBlocking::new(file);
        let log = Self { writer, lost: lines.error_counter() };
        let subscriber = tracing_subscriber::fmt().with_writer(lines).event_format(LogLine);
        Ok((log, subscriber.finish()))
    }

    /// Waits a short time for the last lines to be written. Lines not written by then are lost.
    pub(super) fn close(self) {
        let lost = self.lost.dropped_lines();
        if lost > 0 {
            tracing::error!("{lost} lines are missing");
        }
        let (done, wait) = channel();
        let close = move || {
            drop(self.writer);
            // The receiver is gone if it took too long.
            let _ = done.send(());
        };
        if thread::Builder::new().name("log".to_owned()).spawn(close).is_ok() {
            let _ = wait.recv_timeout(TIMEOUT);
        }
    }
}

fn usual() -> Option<PathBuf> {
    Some(Xdg::new().ok()?.state_dir()?.join("phaselab").join("phaselab.log"))
}

/// Formats `2026-03-01T12:00:00.250417Z error …`; the further lines of a message are indented.
struct LogLine;

impl<S, N> FormatEvent<S, N> for LogLine
where
    S: Subscriber + for<'a> LookupSpan<'a>,
    N: for<'a> FormatFields<'a> + 'static,
{
    fn format_event(
        &self,
        context: &FmtContext<'_, S, N>,
        mut writer: Writer<'_>,
        event: &Event<'_>,
    ) -> fmt::Result {
        let mut message = String::new();
        context.format_fields(Writer::new(&mut message), event)?;
        SystemTime.format_time(&mut writer)?;
        let level = event.metadata().level().as_str().to_lowercase();
        writeln!(writer, " {level:<5} {}", message.trim_end().replace('\n', "\n    "))
    }
}

#[cfg(test)]
mod tests {
    use tracing::subscriber::with_default;

    use super::*;

    #[test]
    fn what_is_reported_stands_in_the_file_in_order_and_after_what_was_there() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new/own.log");
        for count in [2, 3] {
            let (log, subscriber) = Log::at(&path).expect("it can be written");
            with_default(subscriber, || {
                (0..count).for_each(|n| tracing::info!("line {n}\nand \u{1b}more"));
                tracing::error!("wrong");
                log.close();
            });
        }
        let text = fs::read_to_string(path).expect("a file");
        let lines: Vec<_> = text.lines().map(|l| l.get(28..).unwrap_or(l)).collect();
        assert_eq!(lines.len(), 2 * (2 + 3) + 2, "{text}");
        assert_eq!((lines[0], lines[2], lines[4]), ("info  line 0", "info  line 1", "error wrong"));
        assert_eq!(text.lines().nth(1), Some("    and \\x1bmore"), "{text}");
        let time = text.get(..27).unwrap_or_default().replace(|c: char| c.is_ascii_digit(), "0");
        assert_eq!(time, "0000-00-00T00:00:00.000000Z");
    }

    #[test]
    fn a_place_that_cannot_be_written_is_reported_with_its_name() {
        let folder = tempfile::tempdir().expect("a folder");
        let error = Log::open(&LogFile::At(folder.path().to_owned())).expect_err("it is a folder");
        let path = folder.path().display();
        assert_eq!(
            error.to_string(),
            format!("cannot write the log {path}: it is a folder, not a file")
        );
    }
}
