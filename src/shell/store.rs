//! The store: the file in which the last session is kept, and the lock by which two programs do not write it both.
//!
//! In: a session. Out: the file, whole or as it was; the session read back. Never here: what a session is made of.

use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use etcetera::BaseStrategy;
use etcetera::base_strategy::Xdg;

use crate::app::Saved;

/// The place where sessions are kept, held for as long as this lives.
#[derive(Debug)]
pub(super) struct Store {
    path: PathBuf,
    /// Let go by the system, whatever becomes of the program.
    _lock: File,
}

/// Why sessions are not kept, as a sentence for the user.
#[derive(Debug, thiserror::Error)]
pub(super) enum NoStore {
    /// There is no place for it.
    #[error("the session will not be saved: there is no home folder to save it in")]
    NoHome,
    /// The place cannot be written to.
    #[error("the session will not be saved: cannot write {}: {reason}", .path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: io::Error,
    },
    /// Another program has it.
    #[error("the session will not be saved: another phaselab is running and saves its own")]
    Taken,
}

/// Why there is no session to go on with.
#[derive(Debug, thiserror::Error)]
pub enum NoSession {
    /// There is no home folder.
    #[error("there is no session to resume: there is no home folder it could be in")]
    NoHome,
    /// There is no file, or it cannot be read.
    #[error("there is no session to resume: cannot read {}: {reason}", .path.display())]
    Unread {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: io::Error,
    },
    /// A newer program wrote it.
    #[error(
        "{} is a session of form {found}, of a newer phaselab; this one reads form {} and older",
        .path.display(), Saved::VERSION
    )]
    Newer {
        /// The file.
        path: PathBuf,
        /// Its version.
        found: i64,
    },
    /// It is no session.
    #[error("{} is no session:\n{reason}", .path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong and where.
        reason: String,
    },
}

/// The session's file, `phaselab/session.toml` where XDG keeps state.
fn place() -> Option<PathBuf> {
    let folder = Xdg::new().ok()?.state_dir()?;
    Some(folder.join("phaselab").join("session.toml"))
}

impl Store {
    /// The usual place.
    pub(super) fn open() -> Result<Self, NoStore> {
        Self::at(place().ok_or(NoStore::NoHome)?)
    }

    fn at(path: PathBuf) -> Result<Self, NoStore> {
        let lock = path.with_extension("lock");
        let folder = path.parent().unwrap_or(Path::new("."));
        let lock = fs::create_dir_all(folder)
            .and_then(|()| File::options().create(true).truncate(false).write(true).open(lock));
        let lock = match lock {
            Ok(lock) => lock,
            Err(reason) => return Err(NoStore::Refused { path, reason }),
        };
        match lock.try_lock() {
            Ok(()) => Ok(Self { path, _lock: lock }),
            Err(TryLockError::WouldBlock) => Err(NoStore::Taken),
            Err(TryLockError::Error(reason)) => Err(NoStore::Refused { path, reason }),
        }
    }

    /// Puts a session in the place of the last one. What goes wrong leaves that as it was; the error names the file.
    pub(super) fn save(&self, saved: &Saved) -> io::Result<()> {
        let text = toml::to_string(saved).map_err(io::Error::other)?;
        let partial = self.path.with_extension(format!("{}.partial", std::process::id()));
        let written = File::create(&partial).and_then(|mut file| {
            file.write_all(text.as_bytes())?;
            fs::rename(&partial, &self.path)
        });
        written.map_err(|error| {
            // The error that matters is the one on its way.
            let _ = fs::remove_file(&partial);
            io::Error::new(error.kind(), format!("cannot write {}: {error}", self.path.display()))
        })
    }
}

/// The last session.
pub(super) fn read() -> Result<Saved, NoSession> {
    read_from(place().ok_or(NoSession::NoHome)?)
}

fn read_from(path: PathBuf) -> Result<Saved, NoSession> {
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(reason) => return Err(NoSession::Unread { path, reason }),
    };
    // Another form may have other keys, so its number is looked at first.
    let version = text.parse::<toml::Table>().ok().and_then(|t| t.get("version")?.as_integer());
    if let Some(found) = version.filter(|found| *found > i64::from(Saved::VERSION)) {
        return Err(NoSession::Newer { path, found });
    }
    toml::from_str(&text).map_err(|error| NoSession::Malformed { path, reason: error.to_string() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::{Page, Pane, Selection};
    use crate::experiment::{Changed, Moment};

    fn session() -> Saved {
        let g = Changed { name: "g".to_owned(), value: 1.0 / 3.0, of_file: 9.81 };
        Saved {
            version: Saved::VERSION,
            phaselab: "0.1.0".to_owned(),
            open: "pendulum".to_owned(),
            page: Page::Lab,
            focus: Pane::Plot(1),
            zoomed: true,
            selection: Selection::default(),
            draft: Some("title = \"a \\\"text\\\"\"\n".to_owned()),
            draft_of: Some(String::new()),
            plots: Vec::new(),
            moment: Moment { parameters: vec![g], speed: Some(f64::INFINITY), ..Moment::default() },
        }
    }

    #[test]
    fn what_is_saved_is_read_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new/session.toml");
        let store = Store::at(path.clone()).expect("it can be written");
        store.save(&session()).expect("it is written");
        assert_eq!(read_from(path).expect("it is read"), session());
        let files = fs::read_dir(folder.path().join("new")).expect("the folder").count();
        assert_eq!(files, 2, "the session and its lock, nothing half written");
    }

    #[test]
    fn the_second_of_two_does_not_save() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("session.toml");
        let first = Store::at(path.clone()).expect("it is free");
        assert!(matches!(Store::at(path.clone()), Err(NoStore::Taken)));
        drop(first);
        assert!(Store::at(path).is_ok());
    }

    #[test]
    fn a_session_that_cannot_be_written_leaves_the_last_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("session.toml");
        let store = Store::at(path.clone()).expect("it is free");
        store.save(&session()).expect("it is written");
        // a folder stands where the new file would be filled
        let partial = path.with_extension(format!("{}.partial", std::process::id()));
        fs::create_dir(partial).expect("a folder");
        let changed = Saved { open: "planet".to_owned(), ..session() };
        let error = store.save(&changed).expect_err("there is no room for it").to_string();
        assert!(error.starts_with("cannot write ") && error.contains("session.toml"), "{error}");
        assert_eq!(read_from(path).expect("it is read"), session());
    }

    #[test]
    fn what_is_no_session_is_told_in_its_place() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("session.toml");
        let told = |text: &str| {
            fs::write(&path, text).expect("it is written");
            read_from(path.clone()).expect_err("it is wrong").to_string()
        };
        let newer = told("version = 2\nsomething = \"else\"\n");
        assert!(newer.contains("form 2, of a newer phaselab"), "{newer}");
        let malformed = told("version = 1\npage = \"nowhere\"\n");
        assert!(malformed.contains("is no session:\n"), "{malformed}");
        assert!(told("version = ]\n").contains("line 1"));
        let gone = read_from(folder.path().join("other.toml")).expect_err("it is not there");
        assert!(gone.to_string().starts_with("there is no session to resume: "), "{gone}");
    }
}
