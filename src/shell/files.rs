//! System files: read, written atomically, and watched.
//!
//! In: texts and paths. Out: the texts on disk; a report that a file has changed. Never here: what a text means.

use std::fs::{self, Metadata};
use std::io;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use super::atomic_file::{self, Durability};
use super::regular;
use crate::app::SaveError;
use crate::diagnostic::TEXT_LIMIT;
use crate::preset::{Catalog, is_path};
use crate::printable;

/// The interval between checks of a watched file.
const INTERVAL: Duration = Duration::from_millis(500);

/// Writes a text over a file if the file still has the expected contents. Returns the file.
pub(super) fn save(place: &Path, text: &str, known: Option<&str>) -> Result<(), SaveError> {
    if let Some(known) = known {
        match regular::read(place, TEXT_LIMIT) {
            Ok(bytes) if bytes != known.as_bytes() => return Err(SaveError::Changed),
            Err(error) if error.kind() == io::ErrorKind::FileTooLarge => {
                return Err(SaveError::Changed);
            }
            // A file that has disappeared is created again.
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                return Err(refused("read", place, &error));
            }
            _ => {}
        }
    }
    if fs::metadata(place).is_ok_and(|about| about.permissions().readonly()) {
        let message = format!("{} is read-only and was left unchanged", place.display());
        return Err(SaveError::Refused(message));
    }
    atomic_file::write(place, text.as_bytes(), Durability::OnDisk)
        .map_err(|error| refused("write", place, &error))
}

/// Writes a text to a new file: a user preset given by name, or a path. Returns the file.
pub(super) fn save_copy(name: &str, text: &str) -> Result<PathBuf, SaveError> {
    let place = if is_path(name) {
        let toml = Path::new(name).extension().is_some();
        PathBuf::from(if toml { name.to_owned() } else { format!("{name}.toml") })
    } else {
        let none = "there is no home folder for presets; give the copy a path, ./pendulum.toml";
        let folder = Catalog::user_folder().ok_or_else(|| SaveError::Refused(none.to_owned()))?;
        fs::create_dir_all(&folder).map_err(|error| refused("make", &folder, &error))?;
        folder.join(format!("{name}.toml"))
    };
    if place.symlink_metadata().is_ok() {
        return Err(SaveError::Exists(place));
    }
    atomic_file::write(&place, text.as_bytes(), Durability::OnDisk)
        .map_err(|error| refused("write", &place, &error))?;
    Ok(place)
}

fn refused(what: &str, place: &Path, error: &io::Error) -> SaveError {
    SaveError::Refused(format!("cannot {what} {}: {}", place.display(), printable::why(error)))
}

/// Reads the text of a file.
///
/// # Errors
/// Returns an error that names the file if it cannot be read, is not a regular file, is not text or is too long.
pub(super) fn read(place: &Path) -> io::Result<String> {
    regular::read_text(place, TEXT_LIMIT).map_err(|error| {
        let message = format!("cannot read {}: {}", place.display(), printable::why(&error));
        io::Error::new(error.kind(), message)
    })
}

#[derive(Debug, Default)]
pub(super) struct Watch {
    place: Option<PathBuf>,
    stamp: Option<FileMetadata>,
    since: Duration,
    /// The number of consecutive checks in which it was missing.
    missed: u32,
}

#[derive(Debug, PartialEq, Eq)]
pub(super) enum FileChange {
    /// It has changed and now has this text, or it has reappeared.
    Text {
        text: String,
        back: bool,
    },
    Removed,
}

/// The number of consecutive misses after which a file counts as gone; some editors remove a file briefly when they
/// write it.
const MISSES: u32 = 2;

type FileMetadata = (u64, Option<SystemTime>, u64);

impl Watch {
    /// Starts to watch a file that is about to be read; later changes are reported.
    pub(super) fn follow(&mut self, place: &Path) {
        let stamp = stamp(place);
        *self = Self { place: Some(place.to_owned()), stamp, since: INTERVAL, missed: 0 };
    }

    /// Advances the time. Returns a change of the file since the last check; each is reported once.
    pub(super) fn poll(&mut self, place: &Path, elapsed: Duration) -> Option<FileChange> {
        if self.place.as_deref() != Some(place) {
            let place = place.to_owned();
            *self = Self { stamp: stamp(&place), place: Some(place), since: INTERVAL, missed: 0 };
            // It may have changed between its loading and now.
            let text = read(self.place.as_deref()?).ok()?;
            return Some(FileChange::Text { text, back: false });
        }
        self.since = self.since.saturating_sub(elapsed);
        if !self.since.is_zero() {
            return None;
        }
        self.since = INTERVAL;
        let Some(stamp) = stamp(place) else {
            self.missed = self.missed.saturating_add(1);
            return (self.missed == MISSES).then_some(FileChange::Removed);
        };
        let back = self.missed >= MISSES;
        if self.stamp == Some(stamp) && !back {
            self.missed = 0;
            return None;
        }
        let text = read(place).ok()?;
        (self.stamp, self.missed) = (Some(stamp), 0);
        Some(FileChange::Text { text, back })
    }
}

/// Returns `None` if there is no file.
fn stamp(place: &Path) -> Option<FileMetadata> {
    let about: Metadata = fs::metadata(place).ok().filter(Metadata::is_file)?;
    Some((about.len(), about.modified().ok(), about.ino()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_saved_whole_and_only_over_what_is_known() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("system.toml");
        fs::write(&place, "one").expect("it is written");
        assert_eq!(save(&place, "two", Some("one")), Ok(()));
        assert_eq!(fs::read_to_string(&place).expect("it is there"), "two");
        assert_eq!(save(&place, "three", Some("one")), Err(SaveError::Changed));
        assert_eq!(fs::read_to_string(&place).expect("it is there"), "two");
        assert_eq!(save(&place, "three", None), Ok(()));
        assert_eq!(fs::read_to_string(&place).expect("it is there"), "three");
        assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 1, "nothing half");
    }

    #[cfg(unix)]
    #[test]
    fn what_cannot_be_written_leaves_the_old_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("system.toml");
        fs::write(&place, "one").expect("it is written");
        fs::set_permissions(&place, fs::Permissions::from_mode(0o444)).expect("it is mine");
        let why = save(&place, "two", Some("one"));
        assert!(
            matches!(&why, Err(SaveError::Refused(why)) if why.contains("system.toml")),
            "{why:?}"
        );
        assert_eq!(fs::read_to_string(&place).expect("it is there"), "one");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_one_and_who_may_read_stays() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().expect("a folder");
        let (place, link) = (folder.path().join("system.toml"), folder.path().join("link.toml"));
        fs::write(&place, "one").expect("it is written");
        fs::set_permissions(&place, fs::Permissions::from_mode(0o600)).expect("it is mine");
        symlink(&place, &link).expect("a link");
        assert_eq!(save(&link, "two", Some("one")), Ok(()));
        assert!(link.symlink_metadata().expect("it is there").is_symlink());
        let about = fs::metadata(&place).expect("it is there");
        assert_eq!(about.permissions().mode() & 0o777, 0o600);
        assert_eq!(fs::read_to_string(&place).expect("it is there"), "two");
    }

    #[test]
    fn a_copy_never_replaces_a_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let name = folder.path().join("copy").display().to_string();
        let place = folder.path().join("copy.toml");
        assert_eq!(save_copy(&name, "one"), Ok(place.clone()));
        assert_eq!(save_copy(&name, "two"), Err(SaveError::Exists(place.clone())));
        assert_eq!(fs::read_to_string(&place).expect("it is there"), "one");
    }

    #[test]
    fn a_change_is_noticed_at_the_next_check_and_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("system.toml");
        fs::write(&place, "one").expect("it is written");
        let mut watch = Watch::default();
        let text = |text: &str, back| Some(FileChange::Text { text: text.to_owned(), back });
        assert_eq!(watch.poll(&place, Duration::ZERO), text("one", false));
        fs::write(&place, "longer").expect("it is written");
        assert_eq!(watch.poll(&place, INTERVAL / 2), None, "it is not looked at all the time");
        assert_eq!(watch.poll(&place, INTERVAL / 2), text("longer", false));
        assert_eq!(watch.poll(&place, INTERVAL), None);
        // It is gone for a moment, and then there again.
        fs::remove_file(&place).expect("it goes");
        assert_eq!(watch.poll(&place, INTERVAL), None);
        fs::write(&place, "again").expect("it is written");
        assert_eq!(watch.poll(&place, INTERVAL), text("again", false));
        // It is gone for good.
        fs::remove_file(&place).expect("it goes");
        let changes: Vec<_> = (0..4).filter_map(|_| watch.poll(&place, INTERVAL)).collect();
        assert_eq!(changes, [FileChange::Removed], "it is reported once");
        fs::write(&place, "again").expect("it is written");
        assert_eq!(watch.poll(&place, INTERVAL), text("again", true));
        assert_eq!(watch.poll(&place, INTERVAL), None);
    }
}
