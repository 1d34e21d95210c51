//! Atomic files: written under a temporary name in the same folder, then renamed, so that nobody ever sees a
//! partial file.
//!
//! In: a path and bytes. Out: the file, complete or as it was before; it replaces an existing file. Unfinished files
//! are removed with their writer; those of a killed process are detected and removed later. Never here: what the
//! bytes mean, or files that replace nothing ([`new_file`](super::new_file)).

use std::collections::BTreeSet;
use std::fs::{self, DirEntry, File, OpenOptions};
use std::io::{self, Write};
use std::mem;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt, fchown};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use rustix::fs::{Access, access};
use rustix::process::{Pid, geteuid, test_kill_process};
use tempfile::{Builder, NamedTempFile};

use crate::printable;

/// The suffix of an unfinished file's name: `.pendulum.cast.1234-k3W….partial`, which contains the writing process.
const PARTIAL: &str = ".partial";

/// The maximum number of bytes of the file's own name in that name; the whole stays below any system's limit.
const LONGEST: usize = 60;

/// The permissions of an unfinished file: for its owner alone, or as the process's umask allows.
const PRIVATE: u32 = 0o600;
pub(super) const USUAL: u32 = 0o666;

/// The maximum number of links followed to the place where a file is to be created.
const MOST_LINKS: usize = 40;

/// The maximum number of files of a folder that are searched for unfinished ones.
const MOST_ENTRIES: usize = 100_000;

/// Whether a file must be on the disk before it gets its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Durability {
    /// The file and its name are on the disk when it is finished.
    OnDisk,
    /// The system writes it back at a time of its choice.
    Cached,
}

/// The unfinished files of this process.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Removes the unfinished files of this process, which ends before they can be completed.
pub(crate) fn remove_unfinished() {
    for path in mem::take(&mut *unfinished()) {
        // There is no one left to report an error to.
        let _ = fs::remove_file(path);
    }
}

fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// An unfinished file, registered with the process until it is dropped.
#[derive(Debug)]
pub(super) struct UnfinishedFile {
    file: NamedTempFile,
    registered: Registered,
}

#[derive(Debug)]
struct Registered(PathBuf);

impl Drop for Registered {
    fn drop(&mut self) {
        unfinished().remove(&self.0);
    }
}

impl UnfinishedFile {
    /// Opens one beside `place`, under an unpredictable and unused name.
    pub(super) fn begin(place: &Path, mode: u32) -> io::Result<Self> {
        let prefix = format!("{}.{}-", lead(place), std::process::id());
        let open =
            |path: &Path| OpenOptions::new().write(true).create_new(true).mode(mode).open(path);
        let file = Builder::new()
            .prefix(&prefix)
            .suffix(PARTIAL)
            .rand_bytes(16)
            .make_in(folder(place), open)?;
        let path = file.path().to_owned();
        unfinished().insert(path.clone());
        Ok(Self { file, registered: Registered(path) })
    }

    pub(super) fn file(&mut self) -> &mut File {
        self.file.as_file_mut()
    }

    /// Gives it a name that no file has, or returns it with the reason why not.
    pub(super) fn persist_new(self, place: &Path) -> Result<(), (Self, io::Error)> {
        let Self { file, registered } = self;
        let persisted = match file.persist_noclobber(place) {
            // Some file systems cannot rename without replacing, so that the check has to come first.
            Err(failed) if fs::symlink_metadata(place).is_err() => failed.file.persist(place),
            persisted => persisted,
        };
        match persisted {
            Ok(_) => {
                // The file is on the disk; syncing its name as well is optional.
                let _ = sync_folder(place);
                Ok(())
            }
            Err(failed) => Err((Self { file: failed.file, registered }, failed.error)),
        }
    }

    /// Keeps it under its temporary name, which is returned.
    pub(super) fn keep(self) -> PathBuf {
        self.file.keep().map_or(self.registered.0.clone(), |(_, path)| path)
    }
}

/// Returns the start of the names of unfinished files for a place.
fn lead(place: &Path) -> String {
    let name = place.file_name().unwrap_or_default().to_string_lossy();
    let mut ends = (0..=name.len().min(LONGEST)).rev();
    let end = ends.find(|end| name.is_char_boundary(*end)).unwrap_or(0);
    format!(".{}", &name[..end])
}

fn folder(place: &Path) -> &Path {
    place.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

pub(super) fn write(place: &Path, bytes: &[u8], durability: Durability) -> io::Result<()> {
    let mut file = AtomicFile::begin(place)?;
    file.write_all(bytes)?;
    file.finish(durability)
}

/// A file that replaces an existing one. If it is dropped before it is finished, nothing is left behind.
#[derive(Debug)]
pub(crate) struct AtomicFile {
    temporary: UnfinishedFile,
    place: PathBuf,
}

impl AtomicFile {
    /// Begins a file. If `place` is a link, its target is replaced, not the link. The permissions are kept, and a
    /// read-only file is refused. Unfinished files left by killed processes are removed.
    pub(crate) fn begin(place: &Path) -> io::Result<Self> {
        let place = followed(place);
        let old = fs::metadata(&place).ok();
        // The permissions of the folder alone would allow the replacement.
        if old.as_ref().is_some_and(|old| {
            old.permissions().readonly() || access(&place, Access::WRITE_OK).is_err()
        }) {
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, "it is read-only"));
        }
        sweep(&place);
        let mode = if old.is_some() { PRIVATE } else { USUAL };
        Ok(Self { temporary: UnfinishedFile::begin(&place, mode)?, place })
    }

    /// Renames it to its final name.
    pub(crate) fn finish(self, durability: Durability) -> io::Result<()> {
        let file = self.temporary.file.as_file();
        if durability == Durability::OnDisk {
            file.sync_all()?;
        }
        if let Ok(old) = fs::metadata(&self.place) {
            if file.metadata().is_ok_and(|new| (new.uid(), new.gid()) != (old.uid(), old.gid())) {
                // Only a privileged process may change the owner; otherwise the file belongs to its writer.
                let _ = fchown(file, Some(old.uid()), Some(old.gid()));
            }
            file.set_permissions(old.permissions())?;
        }
        self.temporary.file.persist(&self.place)?;
        match durability {
            Durability::OnDisk => sync_folder(&self.place),
            Durability::Cached => Ok(()),
        }
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.temporary.file().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Syncs the names in a file's folder to the disk.
pub(super) fn sync_folder(place: &Path) -> io::Result<()> {
    // A writable folder need not be readable.
    let Ok(folder) = File::open(folder(place)) else { return Ok(()) };
    match folder.sync_all() {
        // Some file systems cannot sync folders.
        Err(error) if error.kind() == io::ErrorKind::InvalidInput => Ok(()),
        synced => synced,
    }
}

/// Resolves links to the place where a file is or will be, even if a link's target does not exist yet.
fn followed(place: &Path) -> PathBuf {
    let mut place = place.to_owned();
    for _ in 0..MOST_LINKS {
        if let Ok(real) = fs::canonicalize(&place) {
            return real;
        }
        let Ok(target) = fs::read_link(&place) else { break };
        place = place.parent().unwrap_or(Path::new("")).join(target);
    }
    place
}

/// Adds the file's name to an error.
pub(super) fn named(path: &Path, why: &io::Error) -> io::Error {
    let reason = printable::why_unwritten(why);
    let message = format!("cannot write {}: {reason}", printable::path(path));
    io::Error::new(why.kind(), message)
}

/// Returns the unfinished files in a folder whose writers have ended (killed, or by a power failure), with the
/// starts of their names.
fn abandoned(folder: &Path) -> impl Iterator<Item = (String, DirEntry)> {
    let listing = fs::read_dir(folder).into_iter().flatten().take(MOST_ENTRIES).flatten();
    listing.filter_map(|entry| {
        let name = entry.file_name();
        let (lead, process) = name.to_str()?.strip_suffix(PARTIAL)?.rsplit_once('.')?;
        let process = process.split_once('-').map_or(process, |(process, _)| process);
        let process = process.parse().ok().and_then(Pid::from_raw)?;
        let ended = test_kill_process(process) == Err(rustix::io::Errno::SRCH);
        (ended && lead.starts_with('.')).then(|| (lead.to_owned(), entry))
    })
}

/// Returns the same files sorted by name, to be reported.
pub(super) fn left_behind(folder: &Path) -> Vec<PathBuf> {
    let mut left: Vec<PathBuf> = abandoned(folder).map(|(_, entry)| entry.path()).collect();
    left.sort();
    left
}

/// Removes those for one place that belong to this user.
fn sweep(place: &Path) {
    let lead = lead(place);
    for (_, entry) in abandoned(folder(place)).filter(|(other, _)| *other == lead) {
        let about = entry.metadata();
        if about.is_ok_and(|about| about.is_file() && about.uid() == geteuid().as_raw()) {
            // A file that cannot be removed does not matter.
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::os::unix::fs::{PermissionsExt, symlink};

    use super::*;

    fn read(path: &Path) -> String {
        fs::read_to_string(path).expect("it is there")
    }

    /// The names of the files in a folder, in order.
    pub(in crate::shell) fn names(folder: &Path) -> Vec<String> {
        let listing = fs::read_dir(folder).expect("the folder").flatten();
        let mut names: Vec<_> =
            listing.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_complete_or_as_it_was() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("a.txt");
        fs::write(&place, "one").expect("it is written");
        let mut given_up = AtomicFile::begin(&place).expect("begun");
        given_up.write_all(b"tw").expect("there is room");
        drop(given_up);
        assert_eq!(read(&place), "one");
        let mut file = AtomicFile::begin(&place).expect("begun");
        file.write_all(b"two").expect("there is room");
        assert_eq!(read(&place), "one");
        file.finish(Durability::OnDisk).expect("finished");
        assert_eq!(read(&place), "two");
        assert_eq!(names(folder.path()), ["a.txt"], "nothing half");
        assert!(unfinished().iter().all(|path| !path.starts_with(folder.path())));
    }

    #[test]
    fn what_is_read_only_is_refused_and_modes_stay() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("a.txt");
        fs::write(&place, "one").expect("it is written");
        let permit = |mode| fs::set_permissions(&place, fs::Permissions::from_mode(mode));
        permit(0o444).expect("it is ours");
        let refused = AtomicFile::begin(&place).expect_err("read-only");
        assert_eq!(refused.to_string(), "it is read-only");
        permit(0o640).expect("it is ours");
        let file = AtomicFile::begin(&place).expect("begun");
        let mode = |path: &Path| fs::metadata(path).expect("it is there").mode() & 0o777;
        assert_eq!(mode(file.temporary.file.path()), PRIVATE, "private until it is complete");
        file.finish(Durability::Cached).expect("finished");
        assert_eq!(mode(&place), 0o640);
        // The permissions of a new file are those the umask allows.
        let usual = folder.path().join("usual");
        fs::write(&usual, "").expect("it is written");
        write(&folder.path().join("b.txt"), b"", Durability::Cached).expect("written");
        assert_eq!(mode(&folder.path().join("b.txt")), mode(&usual));
    }

    #[test]
    fn links_are_followed() {
        let folder = tempfile::tempdir().expect("a folder");
        let (place, link) = (folder.path().join("a.txt"), folder.path().join("link"));
        symlink("a.txt", &link).expect("a link");
        // First the link's target does not exist, then it is a file.
        for text in ["one", "two"] {
            write(&link, text.as_bytes(), Durability::Cached).expect("written");
            assert_eq!(read(&place), text);
            assert!(fs::symlink_metadata(&link).expect("it is there").is_symlink());
        }
    }

    #[test]
    fn names_of_unfinished_files_are_short_and_differ() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("é".repeat(120));
        let made = [(); 2].map(|()| UnfinishedFile::begin(&place, USUAL).expect("made"));
        assert_ne!(made[0].file.path(), made[1].file.path());
        assert!(made.iter().all(|one| unfinished().contains(&one.registered.0)));
        drop(made);
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn what_the_dead_left_is_found_and_swept_and_what_the_living_write_is_not() {
        let folder = tempfile::tempdir().expect("a folder");
        // No process has so large a number.
        let (dead, living) = (i32::MAX, std::process::id());
        let left = [
            ".a.csv.DEAD-0123456789abcdef.partial",
            ".a.csv.DEAD.partial",
            ".b.csv.DEAD-0.partial",
        ];
        let left = left.map(|name| name.replace("DEAD", &dead.to_string()));
        let mut others = vec![
            format!(".a.csv.{living}-0123456789abcdef.partial"),
            ".a.csv.mine.partial".to_owned(),
            "a.csv".to_owned(),
        ];
        for name in left.iter().chain(&others) {
            fs::write(folder.path().join(name), "").expect("written");
        }
        let found = left_behind(folder.path());
        assert_eq!(found, left.each_ref().map(|name| folder.path().join(name)));
        sweep(&folder.path().join("a.csv"));
        others.push(left[2].clone());
        others.sort();
        assert_eq!(names(folder.path()), others);
    }
}
