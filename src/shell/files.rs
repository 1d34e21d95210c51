//! Files of systems: read, written whole or not at all, and watched.
//!
//! In: texts and paths. Out: the same on disk; the news that a file has changed. Never here: what a text means.

use std::fs::{self, File, Metadata};
use std::io::{self, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use crate::app::NotSaved;
use crate::preset::{Catalog, TEXT_LIMIT, is_path};

/// How often a watched file is looked at.
const LOOKS: Duration = Duration::from_millis(500);

/// Writes a text over a file, if that still holds what is known of it. Returns the file.
pub(super) fn save(place: &Path, text: &str, known: Option<&str>) -> Result<(), NotSaved> {
    if let Some(known) = known {
        match fs::read(place) {
            Ok(bytes) if bytes != known.as_bytes() => return Err(NotSaved::Changed),
            // a file that is gone is written anew
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                return Err(refused("read", place, &error));
            }
            _ => {}
        }
    }
    write_whole(place, text.as_bytes()).map_err(|error| refused("write", place, &error))
}

/// Writes a text to a file that is not there yet: a preset of the user's by its name, or a path. Returns the file.
pub(super) fn save_copy(name: &str, text: &str) -> Result<PathBuf, NotSaved> {
    let place = if is_path(name) {
        let toml = Path::new(name).extension().is_some();
        PathBuf::from(if toml { name.to_owned() } else { format!("{name}.toml") })
    } else {
        let none = "there is no home folder for presets; give the copy a path, ./pendulum.toml";
        let folder = Catalog::user_folder().ok_or_else(|| NotSaved::Refused(none.to_owned()))?;
        fs::create_dir_all(&folder).map_err(|error| refused("make", &folder, &error))?;
        folder.join(format!("{name}.toml"))
    };
    if place.symlink_metadata().is_ok() {
        return Err(NotSaved::Exists(place));
    }
    write_whole(&place, text.as_bytes()).map_err(|error| refused("write", &place, &error))?;
    Ok(place)
}

/// Fills a file beside the one meant and puts it in its place, so that no reader ever finds half of it. What a link
/// points to is replaced, not the link; who may read it stays so.
fn write_whole(place: &Path, bytes: &[u8]) -> io::Result<()> {
    let place = fs::canonicalize(place).unwrap_or_else(|_| place.to_owned());
    let name = place.file_name().unwrap_or_default().to_string_lossy();
    let partial = place.with_file_name(format!(".{name}.{}.partial", std::process::id()));
    let written = File::create(&partial).and_then(|mut file| {
        file.write_all(bytes)?;
        if let Ok(old) = fs::metadata(&place) {
            file.set_permissions(old.permissions())?;
        }
        file.sync_all()?;
        fs::rename(&partial, &place)
    });
    written.inspect_err(|_| {
        // the error that matters is the one on its way
        let _ = fs::remove_file(&partial);
    })
}

fn refused(what: &str, place: &Path, error: &io::Error) -> NotSaved {
    NotSaved::Refused(format!("cannot {what} {}: {error}", place.display()))
}

/// The text of a file, `None` where it cannot be read now or is no text.
pub(super) fn read(place: &Path) -> Option<String> {
    let size = fs::metadata(place).ok()?.len();
    if size > TEXT_LIMIT as u64 {
        return None;
    }
    fs::read_to_string(place).ok()
}

/// A file that is looked at now and then.
#[derive(Debug, Default)]
pub(super) struct Watch {
    place: Option<PathBuf>,
    stamp: Option<Stamp>,
    since: Duration,
}

/// What changes with a file.
type Stamp = (u64, Option<SystemTime>, u64);

impl Watch {
    /// Time has passed: the file's text, if it has changed since it was looked at last. One that is gone for a moment,
    /// as some editors write, is looked at again.
    pub(super) fn look(&mut self, place: &Path, elapsed: Duration) -> Option<String> {
        if self.place.as_deref() != Some(place) {
            *self = Self { place: Some(place.to_owned()), stamp: stamp(place), since: LOOKS };
            // it may have changed between its loading and now
            return read(place);
        }
        self.since = self.since.saturating_sub(elapsed);
        if !self.since.is_zero() {
            return None;
        }
        self.since = LOOKS;
        let stamp = stamp(place)?;
        if self.stamp == Some(stamp) {
            return None;
        }
        let text = read(place)?;
        self.stamp = Some(stamp);
        Some(text)
    }
}

fn stamp(place: &Path) -> Option<Stamp> {
    let about: Metadata = fs::metadata(place).ok()?;
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
        assert_eq!(save(&place, "three", Some("one")), Err(NotSaved::Changed));
        assert_eq!(fs::read_to_string(&place).expect("it is there"), "two");
        assert_eq!(save(&place, "three", None), Ok(()));
        assert_eq!(fs::read_to_string(&place).expect("it is there"), "three");
        assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 1, "nothing half");
    }

    #[test]
    fn what_cannot_be_written_leaves_the_old_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("system.toml");
        fs::write(&place, "one").expect("it is written");
        // a folder stands where the new file would be filled
        let partial = format!(".system.toml.{}.partial", std::process::id());
        fs::create_dir(folder.path().join(partial)).expect("a folder");
        let why = save(&place, "two", Some("one"));
        assert!(
            matches!(&why, Err(NotSaved::Refused(why)) if why.contains("system.toml")),
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
        assert_eq!(save_copy(&name, "two"), Err(NotSaved::Exists(place.clone())));
        assert_eq!(fs::read_to_string(&place).expect("it is there"), "one");
    }

    #[test]
    fn a_change_is_noticed_at_the_next_look_and_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("system.toml");
        fs::write(&place, "one").expect("it is written");
        let mut watch = Watch::default();
        assert_eq!(watch.look(&place, Duration::ZERO).as_deref(), Some("one"));
        fs::write(&place, "longer").expect("it is written");
        assert_eq!(watch.look(&place, LOOKS / 2), None, "it is not looked at all the time");
        assert_eq!(watch.look(&place, LOOKS / 2).as_deref(), Some("longer"));
        assert_eq!(watch.look(&place, LOOKS), None);
        // gone for a moment, and there again
        fs::remove_file(&place).expect("it goes");
        assert_eq!(watch.look(&place, LOOKS), None);
        fs::write(&place, "again").expect("it is written");
        assert_eq!(watch.look(&place, LOOKS).as_deref(), Some("again"));
    }
}
