//! Why the laboratory could not be opened, or not be left cleanly.
//!
//! In: the errors of what it needs. Out: one type with a sentence for each. Never here: exit codes.

use super::log::LogError;
use super::session_file::SessionError;
use super::terminal::TerminalError;
use crate::preset::NotFound;
use crate::printable;

/// Why the laboratory could not be opened, or not be left cleanly.
#[derive(Debug, thiserror::Error)]
pub enum LabError {
    /// There is no terminal that can be used.
    #[error(transparent)]
    TerminalError(#[from] TerminalError),
    /// There is no such preset or file.
    #[error(transparent)]
    NotFound(#[from] NotFound),
    /// There is no session to resume.
    #[error(transparent)]
    SessionError(#[from] SessionError),
    /// The session could not be saved at the end.
    #[error("the session could not be saved: {}", printable::why(.0))]
    Unsaved(std::io::Error),
    /// The log cannot be written.
    #[error(transparent)]
    LogError(#[from] LogError),
    /// The recording could not be saved at the end.
    #[error("the recording is incomplete: {}", printable::why(.0))]
    Unrecorded(std::io::Error),
    /// The system refuses something that the laboratory needs.
    #[error("the laboratory cannot continue: {}", printable::why(.0))]
    System(#[from] std::io::Error),
}
