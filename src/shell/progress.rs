//! Progress in the lessons: which were taken to their end, and where the others were left.
//!
//! In: the state folder. Out: a mark for each lesson by name. The file is written as a whole or not at all, and one of
//! a newer version is never overwritten. Never here: what a lesson is.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use etcetera::BaseStrategy;
use etcetera::base_strategy::Xdg;
use serde::{Deserialize, Serialize};

use super::atomic_file::{self, Durability};
use super::regular;
use crate::printable;
use crate::record::Lesson;

/// How far one lesson was taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LessonMark {
    /// Whether it was taken to its end.
    pub finished: bool,
    /// The step at which a later visit continues; 0 is the beginning.
    pub step: usize,
}

/// How far a person has come in every lesson.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LessonProgress {
    version: u32,
    /// The marks by the names of the lessons.
    #[serde(default)]
    pub lessons: BTreeMap<String, LessonMark>,
}

impl Default for LessonProgress {
    fn default() -> Self {
        Self { version: VERSION, lessons: BTreeMap::new() }
    }
}

const VERSION: u32 = 1;

/// The greatest size of the file, in bytes.
const LONGEST: usize = 1 << 20;

/// Why progress was not read or written.
#[derive(Debug, thiserror::Error)]
pub enum ProgressError {
    /// There is no home folder.
    #[error("the progress in lessons could not be saved: there is no home folder to save it in")]
    NoHome,
    /// The file cannot be read or written.
    #[error("the progress in lessons could not be saved: {}: {}", printable::path(.path), printable::why(.reason))]
    Refused {
        /// The file.
        path: PathBuf,
        /// The reason given by the system.
        reason: io::Error,
    },
    /// The file is of a newer version, or it is damaged.
    #[error("the progress in lessons could not be saved: {} {what} and was left unchanged", printable::path(.path))]
    Unknown {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: &'static str,
    },
}

impl LessonMark {
    /// Returns how far a lesson is.
    pub fn of(lesson: &Lesson) -> Self {
        let finished = lesson.is_finished();
        Self { finished, step: if finished { 0 } else { lesson.place() } }
    }
}

impl LessonProgress {
    /// Reads the progress from its file.
    ///
    /// # Errors
    /// Returns an error if there is no home folder, or if the file cannot be read or understood.
    pub fn known() -> Result<Self, ProgressError> {
        Self::read(&Self::file()?)
    }

    /// The file, `phaselab/lessons.toml` in the XDG state folder.
    ///
    /// # Errors
    /// Returns an error if there is no home folder.
    pub fn file() -> Result<PathBuf, ProgressError> {
        let folder = Xdg::new().map_err(|_| ProgressError::NoHome)?.state_dir();
        Ok(folder.ok_or(ProgressError::NoHome)?.join("phaselab").join("lessons.toml"))
    }

    /// Reads the progress; where there is no file, nothing was done yet.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or understood.
    pub fn read(path: &Path) -> Result<Self, ProgressError> {
        let text = match regular::read_text(path, LONGEST) {
            Ok(text) => text,
            Err(reason) if reason.kind() == io::ErrorKind::NotFound => return Ok(Self::default()),
            Err(reason) => return Err(ProgressError::Refused { path: path.to_owned(), reason }),
        };
        let unknown = |what| Err(ProgressError::Unknown { path: path.to_owned(), what });
        let version = text.parse::<toml::Table>().ok().and_then(|t| t.get("version")?.as_integer());
        match version {
            Some(version) if version > i64::from(VERSION) => {
                return unknown("was written by a newer phaselab");
            }
            _ => {}
        }
        toml::from_str(&text).or_else(|_| unknown("cannot be understood"))
    }

    /// Notes how far a lesson was taken, and leaves all others as they are in the file. A lesson that was once
    /// finished stays so.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read, understood or written; it is then as it was.
    pub fn note(path: &Path, lesson: &str, mark: LessonMark) -> Result<(), ProgressError> {
        let mut progress = Self::read(path)?;
        let known = progress.lessons.entry(lesson.to_owned()).or_default();
        *known = LessonMark { finished: known.finished || mark.finished, ..mark };
        let refused = |reason| ProgressError::Refused { path: path.to_owned(), reason };
        let text = toml::to_string(&progress)
            .map_err(|why| refused(io::Error::new(io::ErrorKind::InvalidData, why)))?;
        fs::create_dir_all(path.parent().unwrap_or(Path::new("."))).map_err(refused)?;
        atomic_file::write(path, text.as_bytes(), Durability::OnDisk).map_err(refused)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_is_read_back_and_a_finished_lesson_stays_finished() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new/lessons.toml");
        assert_eq!(LessonProgress::read(&path).expect("nothing yet"), LessonProgress::default());
        let mark = |finished, step| LessonMark { finished, step };
        LessonProgress::note(&path, "kepler", mark(false, 7)).expect("it is written");
        LessonProgress::note(&path, "top", mark(true, 0)).expect("it is written");
        LessonProgress::note(&path, "top", mark(false, 3)).expect("it is written");
        let read = LessonProgress::read(&path).expect("it is read").lessons;
        assert_eq!((read["kepler"], read["top"]), (mark(false, 7), mark(true, 3)));
        let files = fs::read_dir(folder.path().join("new")).expect("the folder").count();
        assert_eq!(files, 1, "nothing half written is left");
    }

    #[test]
    fn what_is_newer_or_damaged_is_never_overwritten() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("lessons.toml");
        for (text, message) in
            [("version = 2\n", "newer phaselab"), ("version = ]", "cannot be understood")]
        {
            fs::write(&path, text).expect("it is written");
            let noted = LessonProgress::note(&path, "kepler", LessonMark::default());
            let refused = noted.expect_err("it is not overwritten").to_string();
            assert!(refused.contains(message), "{refused}");
            assert_eq!(fs::read_to_string(&path).expect("it is there"), text);
        }
    }
}
