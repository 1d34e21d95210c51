//! How a command ends when it does not end well: an exit code and a sentence.

use std::io;
use std::path::Path;
use std::process::ExitCode;

/// Why a command stops before its end.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Failure {
    /// The thing asked for could not be done: a fault on the way.
    CouldNot(String),
    /// Wrong use: an unknown name, a value out of place, no terminal.
    WrongUse(String),
    /// The file is wrong; the mistakes are told already, or are in the text.
    WrongFile(String),
    /// Output could not be written.
    CouldNotWrite(String),
    /// A signal asked for the end; what there was is written.
    Signal(i32),
    /// Nobody reads any more (`| head`): the command ends quietly, as if done.
    NobodyReads,
}

impl Failure {
    /// A failed write to `what` ("standard output", a path).
    pub(super) fn writing(what: &str, error: &io::Error) -> Failure {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return Failure::NobodyReads;
        }
        Failure::CouldNotWrite(format!("cannot write {what}: {}", plain(error)))
    }

    /// A file that cannot be read.
    pub(super) fn reading(path: &Path, error: &io::Error) -> Failure {
        Failure::WrongUse(format!("cannot read {}: {}", path.display(), plain(error)))
    }

    /// The exit code: 0 done, 1 could not, 2 wrong use, 65 the file is wrong, 74 could not write
    /// (the last two as in BSD's `sysexits.h`), 128 + n ended by signal n.
    pub(super) fn code(&self) -> ExitCode {
        ExitCode::from(match self {
            Failure::Signal(number) => u8::try_from(128 + number).unwrap_or(u8::MAX),
            Failure::NobodyReads => 0,
            Failure::CouldNot(_) => 1,
            Failure::WrongUse(_) => 2,
            Failure::WrongFile(_) => 65,
            Failure::CouldNotWrite(_) => 74,
        })
    }

    /// What is told on standard error; nothing where there is nothing to tell.
    pub(super) fn message(&self) -> &str {
        match self {
            Failure::NobodyReads | Failure::Signal(_) => "",
            Failure::CouldNot(text)
            | Failure::WrongUse(text)
            | Failure::WrongFile(text)
            | Failure::CouldNotWrite(text) => text,
        }
    }
}

/// The system's sentence without its number.
fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    match text.find(" (os error") {
        Some(end) => text[..end].to_lowercase(),
        None => text,
    }
}
