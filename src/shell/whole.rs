//! Whole files: filled under another name beside the one that is meant, then put in its place, so that no reader ever
//! finds half of one, and a failure leaves what was there.
//!
//! In: a path, bytes. Out: the file. Never here: files that must not replace one (`fresh`), or what the bytes mean.

use std::fs::{self, File, Metadata};
use std::io::{self, Write};
use std::os::unix::fs::{MetadataExt, fchown};
use std::path::{Path, PathBuf};

use rustix::fs::{Access, access};

use super::partial;

/// A file being filled. Dropped before it is finished it leaves nothing behind.
#[derive(Debug)]
pub(crate) struct Whole {
    file: File,
    partial: PathBuf,
    place: PathBuf,
    finished: bool,
}

/// How many links are followed to the place where a file is to be made.
const MOST_LINKS: usize = 40;

impl Whole {
    /// Begins a file. What a link points to will be replaced, not the link; who may read it stays so, and one that is
    /// read-only is refused. What killed processes left of it is swept away.
    pub(crate) fn begin(place: &Path) -> io::Result<Self> {
        let place = followed(place);
        let old = fs::metadata(&place).ok();
        if old.as_ref().is_some_and(|old| is_read_only(&place, old)) {
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, "it is read-only"));
        }
        partial::sweep(&place);
        let mode = if old.is_some() { partial::PRIVATE } else { partial::USUAL };
        let (file, partial) = partial::create(&place, mode)?;
        Ok(Self { file, partial, place, finished: false })
    }

    /// Puts it in its place.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        if let Ok(old) = fs::metadata(&self.place) {
            if let Ok(new) = self.file.metadata()
                && (new.uid(), new.gid()) != (old.uid(), old.gid())
            {
                // only some may give a file away; the others own what they write
                let _ = fchown(&self.file, Some(old.uid()), Some(old.gid()));
            }
            self.file.set_permissions(old.permissions())?;
        }
        fs::rename(&self.partial, &self.place)?;
        partial::settled(&self.partial);
        self.finished = true;
        Ok(())
    }

    /// The same, once the disk has all of it, and its name: for what nothing could make again at once.
    pub(crate) fn finish_on_disk(self) -> io::Result<()> {
        self.file.sync_all()?;
        let place = self.place.clone();
        self.finish()?;
        sync_folder(&place);
        Ok(())
    }
}

/// Has the disk take note of the names in the folder of a file.
pub(super) fn sync_folder(place: &Path) {
    let folder = place.parent().filter(|folder| !folder.as_os_str().is_empty());
    // the file itself is on the disk; not every file system knows this of folders
    let _ = File::open(folder.unwrap_or(Path::new("."))).and_then(|folder| folder.sync_all());
}

/// Where a file is or will be, once links are followed; also one that points to nothing yet.
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

/// Whether nobody, or not this process, may write to a file; its folder would let it be replaced all the same.
fn is_read_only(place: &Path, about: &Metadata) -> bool {
    about.permissions().readonly() || access(place, Access::WRITE_OK).is_err()
}

impl Write for Whole {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for Whole {
    fn drop(&mut self) {
        if !self.finished {
            partial::remove(&self.partial);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::{PermissionsExt, symlink};

    use super::*;

    #[test]
    fn it_is_there_whole_or_as_it_was() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("a.txt");
        fs::write(&place, "one").expect("it is written");
        let mut given_up = Whole::begin(&place).expect("begun");
        given_up.write_all(b"tw").expect("there is room");
        drop(given_up);
        assert_eq!(fs::read_to_string(&place).expect("it is there"), "one");
        let mut file = Whole::begin(&place).expect("begun");
        file.write_all(b"two").expect("there is room");
        assert_eq!(fs::read_to_string(&place).expect("it is there"), "one");
        file.finish_on_disk().expect("finished");
        assert_eq!(fs::read_to_string(&place).expect("it is there"), "two");
        assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 1, "nothing half");
    }

    #[test]
    fn what_is_read_only_is_refused_and_modes_stay() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("a.txt");
        fs::write(&place, "one").expect("it is written");
        let permit = |mode| fs::set_permissions(&place, fs::Permissions::from_mode(mode));
        permit(0o444).expect("it is ours");
        let refused = Whole::begin(&place).expect_err("read-only");
        assert_eq!(refused.to_string(), "it is read-only");
        permit(0o640).expect("it is ours");
        let file = Whole::begin(&place).expect("begun");
        let mode = |path: &Path| fs::metadata(path).expect("it is there").mode() & 0o777;
        assert_eq!(mode(&file.partial), 0o600, "private until it is whole");
        file.finish().expect("finished");
        assert_eq!(mode(&place), 0o640);
    }

    #[test]
    fn links_are_followed_and_planted_ones_are_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let (place, link) = (folder.path().join("a.txt"), folder.path().join("link"));
        symlink("a.txt", &link).expect("a link");
        // to nothing yet, then to a file
        for text in ["one", "two"] {
            let mut file = Whole::begin(&link).expect("begun");
            file.write_all(text.as_bytes()).expect("there is room");
            file.finish().expect("finished");
            assert_eq!(fs::read_to_string(&place).expect("it is there"), text);
            assert!(fs::symlink_metadata(&link).expect("it is there").is_symlink());
        }
        // under the name that was once foreseeable
        let victim = folder.path().join("victim");
        fs::write(&victim, "kept").expect("it is written");
        let planted = folder.path().join(format!(".a.txt.{}.partial", std::process::id()));
        symlink(&victim, planted).expect("a link");
        let mut file = Whole::begin(&place).expect("begun");
        file.write_all(b"three").expect("there is room");
        file.finish().expect("finished");
        assert_eq!(fs::read_to_string(&victim).expect("it is there"), "kept");
    }
}
