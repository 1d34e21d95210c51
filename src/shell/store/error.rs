//! Why sessions are not stored.
//!
//! In: a file, a reason. Out: a sentence for the user. Never here: where files are.

use std::io;
use std::path::PathBuf;

use super::PROGRAMS;
use crate::printable;

/// Why sessions are not stored, as a sentence for the user.
#[derive(Debug, thiserror::Error)]
pub(in crate::shell) enum StoreError {
    /// There is no home folder for it.
    #[error("the session will not be saved: there is no home folder to save it in")]
    NoHome,
    /// The file cannot be written.
    #[error("the session will not be saved: cannot write {}: {}", .path.display(), printable::why(.reason))]
    Refused { path: PathBuf, reason: io::Error },
    #[error("the session will not be saved: {PROGRAMS} others are running and save their own")]
    Taken,
}
