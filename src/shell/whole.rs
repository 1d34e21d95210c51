//! Whole files: filled under another name beside the one that is meant, then put in its place, so that no reader ever
//! finds half of one, and a failure leaves what was there.
//!
//! In: a path, bytes. Out: the file. Never here: files that must not replace one (`fresh`), or what the bytes mean.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file being filled. Dropped before it is finished it leaves nothing behind.
#[derive(Debug)]
pub(crate) struct Whole {
    file: File,
    partial: PathBuf,
    place: PathBuf,
    finished: bool,
}

impl Whole {
    /// Begins a file. What a link points to will be replaced, not the link; who may read it stays so.
    pub(crate) fn begin(place: &Path) -> io::Result<Self> {
        let place = fs::canonicalize(place).unwrap_or_else(|_| place.to_owned());
        let name = place.file_name().unwrap_or_default().to_string_lossy();
        let partial = place.with_file_name(format!(".{name}.{}.partial", std::process::id()));
        let file = File::create(&partial)?;
        Ok(Self { file, partial, place, finished: false })
    }

    /// Puts it in its place.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        if let Ok(old) = fs::metadata(&self.place) {
            self.file.set_permissions(old.permissions())?;
        }
        fs::rename(&self.partial, &self.place)?;
        self.finished = true;
        Ok(())
    }

    /// The same, once the disk has all of it: for what somebody wrote and nothing could make again.
    pub(crate) fn finish_on_disk(self) -> io::Result<()> {
        self.file.sync_all()?;
        self.finish()
    }
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
            // the error that matters is the one on its way
            let _ = fs::remove_file(&self.partial);
        }
    }
}

#[cfg(test)]
mod tests {
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
}
