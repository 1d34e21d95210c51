//! The files of the last session and of unsaved texts: where they are, and what they hold.
//!
//! In: paths, texts. Out: sessions and texts as read, contents to be written, or why a file cannot be read. Never here:
//! who writes a file and when.

use std::io;
use std::path::{Path, PathBuf};

use etcetera::BaseStrategy;
use etcetera::base_strategy::Xdg;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::regular;
use crate::app::{Saved, Unsaved};
use crate::printable;

/// The format of the file of texts.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct UnsavedTexts {
    version: u32,
    phaselab: String,
    texts: Vec<Unsaved>,
}

const TEXTS_VERSION: u32 = 1;

/// The maximum size of a session or of texts, in bytes: more than 30 texts of the greatest length, each with its
/// base text. Phaselab writes nothing longer.
const LONGEST: usize = 64 << 20;

/// Why there is no session to resume.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// There is no home folder.
    #[error("there is no session to resume: there is no home folder it could be in")]
    NoHome,
    /// There is no file, or it cannot be read.
    #[error("there is no session to resume: cannot read {}: {}", .path.display(), printable::why(.reason))]
    Unread {
        /// The file.
        path: PathBuf,
        /// The reason given by the system.
        reason: io::Error,
    },
    /// It was written by a newer version of the program.
    #[error(
        "{} is a session in format {found}, of a newer phaselab; this one reads format {} and older",
        .path.display(), Saved::VERSION
    )]
    Newer {
        /// The file.
        path: PathBuf,
        /// Its version.
        found: i64,
    },
    /// It is not a session.
    #[error("{} is not a session:\n{reason}", .path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong, with the position.
        reason: String,
    },
}

/// Returns the session's file, `phaselab/session.toml` in the XDG state folder.
pub(super) fn session_path() -> Option<PathBuf> {
    let folder = Xdg::new().ok()?.state_dir()?;
    Some(folder.join("phaselab").join("session.toml"))
}

/// Whether there is a session to resume.
pub fn has_session() -> bool {
    session_path().is_some_and(|path| path.is_file())
}

/// Serializes texts into the contents of their file.
pub(super) fn contents(texts: &[Unsaved]) -> io::Result<String> {
    let phaselab = env!("CARGO_PKG_VERSION").to_owned();
    let form = UnsavedTexts { version: TEXTS_VERSION, phaselab, texts: texts.to_vec() };
    toml::to_string_pretty(&form).map_err(io::Error::other)
}

/// Reads the last session.
pub(super) fn read() -> Result<Saved, SessionError> {
    read_from(&session_path().ok_or(SessionError::NoHome)?)
}

pub(super) fn read_from(path: &Path) -> Result<Saved, SessionError> {
    read_form(path, Saved::VERSION)
}

pub(super) fn read_texts(path: &Path) -> Result<Vec<Unsaved>, SessionError> {
    read_form(path, TEXTS_VERSION).map(|form: UnsavedTexts| form.texts)
}

fn read_form<T: DeserializeOwned>(path: &Path, version: u32) -> Result<T, SessionError> {
    let unread = |reason| SessionError::Unread { path: path.to_owned(), reason };
    let text = regular::read_text(path, LONGEST).map_err(unread)?;
    // A power failure can leave zeros, or nothing.
    if text.bytes().all(|byte| byte == 0 || byte.is_ascii_whitespace()) {
        let empty = io::Error::new(io::ErrorKind::NotFound, "it is empty");
        return Err(unread(empty));
    }
    // Another version may have other keys, so the version is checked first.
    let number = text.parse::<toml::Table>().ok().and_then(|t| t.get("version")?.as_integer());
    if let Some(found) = number.filter(|found| *found > i64::from(version)) {
        return Err(SessionError::Newer { path: path.to_owned(), found });
    }
    toml::from_str(&text).map_err(|error| SessionError::Malformed {
        path: path.to_owned(),
        reason: error.to_string(),
    })
}

impl SessionError {
    /// Whether the file does not exist.
    pub(super) fn is_missing(&self) -> bool {
        matches!(self, Self::Unread { reason, .. } if reason.kind() == io::ErrorKind::NotFound)
    }

    /// Returns the error in one line.
    pub(super) fn in_short(&self) -> String {
        match self {
            Self::NoHome => "there is no home folder".to_owned(),
            Self::Unread { path, reason } => {
                format!("cannot read {}: {}", path.display(), printable::why(reason))
            }
            Self::Newer { path, .. } => {
                format!("{} was written by a newer phaselab and was left unchanged", path.display())
            }
            Self::Malformed { path, .. } => {
                format!("{} cannot be understood and was left unchanged", path.display())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn what_is_no_session_is_reported_in_its_place() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("session.toml");
        let message = |text: &str| {
            fs::write(&path, text).expect("it is written");
            read_from(&path).expect_err("it is wrong").to_string()
        };
        let newer = message("version = 2\nsomething = \"else\"\n");
        assert!(newer.contains("format 2, of a newer phaselab"), "{newer}");
        let malformed = message("version = 1\npage = \"nowhere\"\n");
        assert!(malformed.contains("is not a session:\n"), "{malformed}");
        assert!(message("version = ]\n").contains("line 1"));
        assert!(message(" \n").contains("it is empty"));
        let missing = read_from(&folder.path().join("other.toml")).expect_err("it is not there");
        assert!(missing.to_string().starts_with("there is no session to resume: "), "{missing}");
    }
}
