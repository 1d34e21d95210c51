//! Files that cannot be understood: they are moved aside, so that nothing is overwritten.
//!
//! In: a file, and how it is read. Out: its contents, and a sentence where there are none. Never here: what they mean.

use std::fs;
use std::path::{Path, PathBuf};

use super::super::session_file::SessionError;

/// The maximum number of damaged files of a name.
const DAMAGED: u32 = 64;

/// A file that must not be overwritten.
pub(super) struct Untouchable;

/// Reads a file. Returns `None` if it does not exist, or if it was malformed and has been moved aside.
pub(super) fn read_or_quarantine<T>(
    path: &Path,
    what: &str,
    troubles: &mut Vec<String>,
    read: impl FnOnce(&Path) -> Result<T, SessionError>,
) -> Result<Option<T>, Untouchable> {
    let why = match read(path) {
        Ok(found) => return Ok(Some(found)),
        Err(why) if why.is_missing() => return Ok(None),
        Err(why) => why,
    };
    if let SessionError::Malformed { .. } = why
        && let Some(place) = quarantine(path)
    {
        let (was, place) = (path.display(), place.display());
        troubles.push(format!("{was} cannot be understood; it is now {place}"));
        return Ok(None);
    }
    troubles.push(format!("{what}: {}", why.in_short()));
    Err(Untouchable)
}

/// Renames a file to an unused name. Returns `None` if that fails.
fn quarantine(path: &Path) -> Option<PathBuf> {
    let stem = path.file_stem()?.to_str()?;
    let names = (1..=DAMAGED).map(|n| path.with_file_name(format!("{stem}-damaged-{n}.toml")));
    let place = names.into_iter().find(|place| place.symlink_metadata().is_err())?;
    fs::rename(path, &place).ok().map(|()| place)
}
