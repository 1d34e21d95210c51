//! How a command ends when it does not end well: an exit code and a sentence.

use std::io;
use std::path::Path;
use std::process::ExitCode;

use super::exit;
use crate::printable;

/// Why a command stops before its end.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum CommandError {
    /// The thing asked for could not be done: a fault on the way.
    CouldNot(String),
    /// Wrong use: an unknown name, a value out of place, no terminal.
    WrongUse(String),
    /// The file is wrong; the mistakes are reported already, or are in the text.
    WrongFile(String),
    /// Output could not be written.
    CouldNotWrite(String),
    /// A signal asked for the end; what there was is written.
    Signal(i32),
    /// Nobody reads any more (`| head`): the command ends quietly, as if done.
    NobodyReads,
}

impl CommandError {
    /// A failed write to `what` ("standard output", a path).
    pub(super) fn writing(what: &str, error: &io::Error) -> CommandError {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return CommandError::NobodyReads;
        }
        CommandError::CouldNotWrite(format!("cannot write {what}: {}", printable::why(error)))
    }

    /// A file that cannot be read.
    pub(super) fn reading(path: &Path, error: &io::Error) -> CommandError {
        let (path, why) = (printable::path(path), printable::why(error));
        CommandError::WrongUse(format!("cannot read {path}: {why}"))
    }

    /// The exit code, one of [`super::EXITS`].
    pub(super) fn code(&self) -> ExitCode {
        ExitCode::from(match self {
            CommandError::Signal(number) => {
                u8::try_from(*number).map_or(u8::MAX, |n| exit::SIGNAL.saturating_add(n))
            }
            CommandError::NobodyReads => exit::DONE,
            CommandError::CouldNot(_) => exit::COULD_NOT,
            CommandError::WrongUse(_) => exit::WRONG_USE,
            CommandError::WrongFile(_) => exit::WRONG_FILE,
            CommandError::CouldNotWrite(_) => exit::COULD_NOT_WRITE,
        })
    }

    /// What is reported on standard error; nothing where there is nothing to tell.
    pub(super) fn message(&self) -> &str {
        match self {
            CommandError::NobodyReads | CommandError::Signal(_) => "",
            CommandError::CouldNot(text)
            | CommandError::WrongUse(text)
            | CommandError::WrongFile(text)
            | CommandError::CouldNotWrite(text) => text,
        }
    }
}
