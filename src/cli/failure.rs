//! How a command ends when it does not end well: an exit code and a sentence.

use std::io;
use std::path::Path;
use std::process::ExitCode;

use super::exit;
use crate::printable;

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
        Failure::CouldNotWrite(format!("cannot write {what}: {}", printable::why(error)))
    }

    /// A file that cannot be read.
    pub(super) fn reading(path: &Path, error: &io::Error) -> Failure {
        let (path, why) = (printable::path(path), printable::why(error));
        Failure::WrongUse(format!("cannot read {path}: {why}"))
    }

    /// The exit code, one of [`super::EXITS`].
    pub(super) fn code(&self) -> ExitCode {
        ExitCode::from(match self {
            Failure::Signal(number) => {
                u8::try_from(*number).map_or(u8::MAX, |n| exit::SIGNAL.saturating_add(n))
            }
            Failure::NobodyReads => exit::DONE,
            Failure::CouldNot(_) => exit::COULD_NOT,
            Failure::WrongUse(_) => exit::WRONG_USE,
            Failure::WrongFile(_) => exit::WRONG_FILE,
            Failure::CouldNotWrite(_) => exit::COULD_NOT_WRITE,
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
