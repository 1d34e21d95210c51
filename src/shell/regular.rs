//! Regular files: reads only regular files, up to a size limit.
//!
//! In: a path. Out: the contents. Never here: waiting. A pipe or a device in the place of a file is refused before
//! a byte of it is read, even if it has only just replaced the file.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::Path;

use rustix::fs::{Mode, OFlags};

use crate::diagnostic::Document;
use crate::file;
use crate::preset::{Catalog, NotFound};

/// Opens a file to be locked, and creates it if it does not exist.
///
/// # Errors
/// Returns an error if that fails, or if it is not a regular file.
pub(super) fn open_or_make(path: &Path) -> io::Result<File> {
    // Merely opening a device can have an effect.
    if let Ok(about) = fs::metadata(path) {
        file::check_regular(about.file_type())?;
    }
    // Without `NONBLOCK`, opening a pipe waits for its other end.
    let flags = OFlags::RDWR | OFlags::CREATE | OFlags::NONBLOCK | OFlags::NOCTTY | OFlags::CLOEXEC;
    let file = File::from(rustix::fs::open(path, flags, Mode::from_raw_mode(0o666))?);
    file::check_regular(file.metadata()?.file_type())?;
    Ok(file)
}

/// Returns the contents of a file of at most this size.
///
/// # Errors
/// Returns an error if the file cannot be read, is not regular or is longer.
pub(super) fn read(path: &Path, most: usize) -> io::Result<Vec<u8>> {
    let (bytes, _) = file::read_regular(path, most as u64)?;
    if bytes.len() > most {
        let message = format!("it has more than {most} bytes");
        return Err(io::Error::new(ErrorKind::FileTooLarge, message));
    }
    Ok(bytes)
}

/// Returns the contents of a text file of at most this size.
///
/// # Errors
/// Returns an error as [`read`] does, or if the file is not UTF-8.
pub(super) fn read_text(path: &Path, most: usize) -> io::Result<String> {
    let text = String::from_utf8(read(path, most)?);
    text.map_err(|_| io::Error::new(ErrorKind::InvalidData, "it is not UTF-8 text"))
}

/// Returns the document for a preset's name or a path.
///
/// # Errors
/// Returns an error if there is no such preset, or no regular file.
pub(super) fn find(catalog: &Catalog, name: &str) -> Result<Document, NotFound> {
    match catalog.place(name) {
        Some(path) => {
            Document::open_regular(&path).map_err(|reason| NotFound::File { path, reason })
        }
        None => catalog.find(name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_file_is_refused_without_waiting() {
        let folder = tempfile::tempdir().expect("a folder");
        let pipe = folder.path().join("pipe.toml");
        rustix::fs::mknodat(rustix::fs::CWD, &pipe, rustix::fs::FileType::Fifo, Mode::RUSR, 0)
            .expect("a pipe");
        let message = |path: &Path| read(path, 10).expect_err("it is no file").to_string();
        assert_eq!(message(&pipe), "it is a pipe, not a file");
        assert_eq!(message(Path::new("/dev/zero")), "it is a device, not a file");
        assert_eq!(message(folder.path()), "it is a folder, not a file");
        let lock = open_or_make(&pipe).expect_err("no lock").to_string();
        assert_eq!(lock, "it is a pipe, not a file");
        let link = folder.path().join("link.toml");
        std::os::unix::fs::symlink("/dev/zero", &link).expect("a link");
        assert_eq!(message(&link), "it is a device, not a file");
    }

    #[test]
    fn no_more_is_read_than_is_allowed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.toml");
        fs::write(&path, [b'a'; 10]).expect("written");
        assert_eq!(read(&path, 10).expect("it fits").len(), 10);
        let message = read(&path, 9).expect_err("it does not").to_string();
        assert_eq!(message, "it has more than 9 bytes");
    }
}
