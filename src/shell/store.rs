//! The store: the files in which the last session and the texts that were not saved are kept, and the lock by which two
//! programs do not write them both.
//!
//! In: a session, texts. Out: their files, whole or as they were; both read back. Never here: what they are made of.
//!
//! What stands there and cannot be read, being of a newer program or no session at all, is never written over.

use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use etcetera::BaseStrategy;
use etcetera::base_strategy::Xdg;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::whole::Whole;
use crate::app::{Saved, Unsaved};

/// The place where sessions are kept, held for as long as this lives.
#[derive(Debug)]
pub(super) struct Store {
    /// `None` where what stands there is not to be written over.
    session: Option<PathBuf>,
    /// The same of the texts.
    texts: Option<PathBuf>,
    /// The texts as the file has them.
    known: Vec<Unsaved>,
    /// What is not kept and why, in sentences.
    pub(super) troubles: Vec<String>,
    /// Let go by the system, whatever becomes of the program.
    _lock: File,
}

/// The form of the file of texts.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Kept {
    version: u32,
    phaselab: String,
    texts: Vec<Unsaved>,
}

/// The version of that form.
const TEXTS_VERSION: u32 = 1;

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
            Ok(()) => Ok(Self::with(path, lock)),
            Err(TryLockError::WouldBlock) => Err(NoStore::Taken),
            Err(TryLockError::Error(reason)) => Err(NoStore::Refused { path, reason }),
        }
    }

    fn with(session: PathBuf, lock: File) -> Self {
        let texts = session.with_file_name("texts.toml");
        let mut troubles = Vec::new();
        let mut trouble = |what: &str, why: &NoSession| {
            troubles.push(format!("{what} will not be saved: {}", why.in_short()));
        };
        let session = match read_from(session.clone()) {
            Err(why) if !why.is_missing() => {
                trouble("the session", &why);
                None
            }
            _ => Some(session),
        };
        let (texts, known) = match read_texts(texts.clone()) {
            Ok(known) => (Some(texts), known),
            Err(why) if why.is_missing() => (Some(texts), Vec::new()),
            Err(why) => {
                trouble("texts that are left unsaved", &why);
                (None, Vec::new())
            }
        };
        Self { session, texts, known, troubles, _lock: lock }
    }

    /// Puts a session in the place of the last one. What goes wrong leaves that as it was; the error names the file.
    pub(super) fn save(&self, saved: &Saved) -> io::Result<()> {
        let Some(path) = &self.session else { return Ok(()) };
        write(path, &toml::to_string(saved).map_err(io::Error::other)?)
    }

    /// The texts that were not saved, as they were kept last.
    pub(super) fn texts(&self) -> &[Unsaved] {
        &self.known
    }

    /// The file of the texts; `None` where none are kept.
    pub(super) fn place_of_texts(&self) -> Option<&Path> {
        self.texts.as_deref()
    }

    /// Keeps these texts in the place of those before.
    pub(super) fn keep_texts(&mut self, texts: Vec<Unsaved>) -> io::Result<()> {
        let Some(path) = self.texts.as_ref().filter(|_| texts != self.known) else { return Ok(()) };
        if texts.is_empty() {
            fs::remove_file(path).or_else(|error| match error.kind() {
                io::ErrorKind::NotFound => Ok(()),
                _ => Err(named(path, &error)),
            })?;
        } else {
            let phaselab = env!("CARGO_PKG_VERSION").to_owned();
            let form = Kept { version: TEXTS_VERSION, phaselab, texts: texts.clone() };
            write(path, &toml::to_string_pretty(&form).map_err(io::Error::other)?)?;
        }
        self.known = texts;
        Ok(())
    }
}

fn write(path: &Path, text: &str) -> io::Result<()> {
    let written = Whole::begin(path).and_then(|mut file| {
        file.write_all(text.as_bytes())?;
        // not waited for on the disk: at a signal there is no time
        file.finish()
    });
    written.map_err(|error| named(path, &error))
}

fn named(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("cannot write {}: {error}", path.display()))
}

/// The last session.
pub(super) fn read() -> Result<Saved, NoSession> {
    read_from(place().ok_or(NoSession::NoHome)?)
}

fn read_from(path: PathBuf) -> Result<Saved, NoSession> {
    read_form(path, Saved::VERSION)
}

fn read_texts(path: PathBuf) -> Result<Vec<Unsaved>, NoSession> {
    read_form(path, TEXTS_VERSION).map(|form: Kept| form.texts)
}

fn read_form<T: DeserializeOwned>(path: PathBuf, version: u32) -> Result<T, NoSession> {
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(reason) => return Err(NoSession::Unread { path, reason }),
    };
    // Another form may have other keys, so its number is looked at first.
    let number = text.parse::<toml::Table>().ok().and_then(|t| t.get("version")?.as_integer());
    if let Some(found) = number.filter(|found| *found > i64::from(version)) {
        return Err(NoSession::Newer { path, found });
    }
    toml::from_str(&text).map_err(|error| NoSession::Malformed { path, reason: error.to_string() })
}

impl NoSession {
    /// Whether there is nothing at all.
    fn is_missing(&self) -> bool {
        matches!(self, Self::Unread { reason, .. } if reason.kind() == io::ErrorKind::NotFound)
    }

    /// In one line.
    fn in_short(&self) -> String {
        match self {
            Self::NoHome => "there is no home folder".to_owned(),
            Self::Unread { path, reason } => format!("cannot read {}: {reason}", path.display()),
            Self::Newer { path, .. } => {
                format!("{} is of a newer phaselab and stays as it is", path.display())
            }
            Self::Malformed { path, .. } => {
                format!("{} cannot be understood and stays as it is", path.display())
            }
        }
    }
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
            edited: true,
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

    fn text(name: &str, text: &str) -> Unsaved {
        let place = Some(PathBuf::from("/a/b.toml"));
        let of = String::new();
        Unsaved { name: name.into(), title: "b".into(), place, text: text.into(), of }
    }

    #[test]
    fn texts_are_kept_to_the_last_character_until_there_are_none() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("session.toml");
        let mut store = Store::at(path.clone()).expect("it can be written");
        let odd = "a \"text\"\r\n'''\u{1}\u{7f}\\ θ\n\n\"\"\" \t";
        let texts = vec![text("one", odd), text("two", "")];
        store.keep_texts(texts.clone()).expect("they are written");
        drop(store);
        let mut store = Store::at(path).expect("it can be written");
        assert_eq!(store.texts(), texts);
        let place = store.place_of_texts().expect("a file").to_owned();
        assert!(place.exists());
        store.keep_texts(Vec::new()).expect("it goes");
        assert!(!place.exists());
    }

    #[test]
    fn what_cannot_be_understood_is_never_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("session.toml");
        for strange in ["version = 2\n", "version = ]\n"] {
            let places = [path.clone(), path.with_file_name("texts.toml")];
            for place in &places {
                fs::write(place, strange).expect("it is written");
            }
            let mut store = Store::at(path.clone()).expect("it is free");
            assert_eq!(store.troubles.len(), 2, "{:?}", store.troubles);
            assert_eq!(store.place_of_texts(), None);
            store.save(&session()).expect("nothing is done");
            store.keep_texts(vec![text("one", "two")]).expect("nothing is done");
            for place in &places {
                assert_eq!(fs::read_to_string(place).expect("it is there"), strange);
            }
        }
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
        let partial = format!(".session.toml.{}.partial", std::process::id());
        fs::create_dir(folder.path().join(partial)).expect("a folder");
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
