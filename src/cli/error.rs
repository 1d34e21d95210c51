//! How a command fails: an exit code and a sentence.

use std::io;
use std::path::Path;
use std::process::ExitCode;

use super::exit;
use crate::printable;

/// Why a command stops early.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum CommandError {
    /// The request could not be fulfilled because of an error.
    CouldNot(String),
    /// Wrong usage: an unknown name, an invalid value, no terminal.
    WrongUse(String),
    /// The file is wrong; its errors are already reported, or are in the text.
    WrongFile(String),
    /// Output could not be written.
    CouldNotWrite(String),
    /// A signal ended the command; the output so far is written.
    Signal(i32),
    /// The reader closed the pipe (`| head`); the command ends quietly and successfully.
    NobodyReads,
}

impl CommandError {
    /// A failed write to `what` ("standard output", a path).
    pub(super) fn writing(what: &str, error: &io::Error) -> CommandError {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return CommandError::NobodyReads;
        }
        CommandError::CouldNotWrite(format!(
            "cannot write {what}: {}",
            printable::why_unwritten(error)
        ))
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

    /// The message for standard error; empty if there is nothing to report.
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
