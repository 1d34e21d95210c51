//! Bounded reading of files: the type of a file is checked first, and only the bytes needed are
//! read.
//!
//! In: a path and a limit. Out: bytes, or why there are none. A pipe without a writer, an endless
//! device, a folder: each is refused instead of blocking the program. Never here: what the bytes
//! mean; writing.

use std::fs::{File, FileType, Metadata, OpenOptions};
use std::io::{self, Read};
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::Path;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::OFlags;

/// How long a pipe may stay silent, in seconds, while the program that writes into it is working.
const SILENCE: i64 = 10;

/// The number of attempts to read from a pipe that nobody has opened for writing yet, and the
/// interval between them.
const ATTEMPTS: u32 = 20;
const INTERVAL: Timespec = Timespec { tv_sec: 0, tv_nsec: 50_000_000 };

/// Reads a file or a pipe, and returns its bytes and its size. It reads at most `most` + 1 bytes;
/// the extra byte shows that a file is too long.
///
/// # Errors
/// Returns an error if it cannot be opened or read, if it is neither a file nor a pipe, or if a
/// pipe stays silent.
pub fn read(path: &Path, most: u64) -> io::Result<(Vec<u8>, u64)> {
    let (file, about) = open(path)?;
    if about.file_type().is_fifo() {
        let bytes = from_pipe(&file, most)?;
        let size = bytes.len() as u64;
        return Ok((bytes, size));
    }
    whole(file, &about, most)
}

/// Reads a regular file only, so it never has to wait.
///
/// # Errors
/// Returns an error if the file cannot be opened or read, or if it is not a regular file.
pub fn read_regular(path: &Path, most: u64) -> io::Result<(Vec<u8>, u64)> {
    let (file, about) = open(path)?;
    check_regular(about.file_type())?;
    whole(file, &about, most)
}

/// Checks that a file is a regular file.
///
/// # Errors
/// Returns an error that names what it is instead.
pub fn check_regular(kind: FileType) -> io::Result<()> {
    if kind.is_fifo() { Err(unreadable("it is a pipe, not a file")) } else { readable(kind) }
}

fn whole(file: File, about: &Metadata, most: u64) -> io::Result<(Vec<u8>, u64)> {
    let mut bytes = Vec::new();
    file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    let size = about.len().max(bytes.len() as u64);
    Ok((bytes, size))
}

/// Opens something that has an end to be read to, without blocking.
fn open(path: &Path) -> io::Result<(File, Metadata)> {
    // checked before opening, because opening a device may have an effect
    readable(std::fs::metadata(path)?.file_type())?;
    let flags = OFlags::NONBLOCK | OFlags::NOCTTY;
    let file = OpenOptions::new().read(true).custom_flags(flags.bits() as i32).open(path)?;
    let about = file.metadata()?;
    readable(about.file_type())?;
    Ok((file, about))
}

fn readable(kind: FileType) -> io::Result<()> {
    if kind.is_dir() {
        Err(unreadable("it is a folder, not a file"))
    } else if kind.is_char_device() || kind.is_block_device() {
        Err(unreadable("it is a device, not a file"))
    } else if kind.is_socket() {
        Err(unreadable("it is a socket, not a file"))
    } else {
        Ok(())
    }
}

fn unreadable(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, what)
}

/// Reads everything that is written into a pipe until its other end is closed.
fn from_pipe(mut file: &File, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut chunk = [0; 8192];
    let mut attempts = 0;
    while bytes.len() as u64 <= most {
        match file.read(&mut chunk) {
            // before the first byte, an end only means that nobody has opened the other end yet
            Ok(0) if bytes.is_empty() && attempts < ATTEMPTS => {
                attempts += 1;
                wait(&mut [], INTERVAL)?;
            }
            Ok(0) if bytes.is_empty() => {
                return Err(unreadable("it is a pipe that nothing was written into"));
            }
            Ok(0) => break,
            Ok(count) => bytes.extend(&chunk[..count]),
            Err(why) if why.kind() == io::ErrorKind::Interrupted => {}
            Err(why) if why.kind() == io::ErrorKind::WouldBlock => {
                let silence = Timespec { tv_sec: SILENCE, tv_nsec: 0 };
                if wait(&mut [PollFd::new(&file, PollFlags::IN)], silence)? == 0 {
                    let what = format!("it is a pipe that was silent for {SILENCE} s");
                    return Err(io::Error::new(io::ErrorKind::TimedOut, what));
                }
            }
            Err(why) => return Err(why),
        }
    }
    bytes.truncate(usize::try_from(most.saturating_add(1)).unwrap_or(usize::MAX));
    Ok(bytes)
}

fn wait(fds: &mut [PollFd<'_>], time: Timespec) -> io::Result<usize> {
    match poll(fds, Some(&time)) {
        Ok(ready) => Ok(ready),
        Err(rustix::io::Errno::INTR) => Ok(1),
        Err(why) => Err(why.into()),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_limit() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.toml");
        fs::write(&path, "12345").expect("written");
        for reads in [read, read_regular] {
            assert_eq!(reads(&path, 5).expect("read"), (b"12345".to_vec(), 5));
            assert_eq!(reads(&path, 3).expect("read"), (b"1234".to_vec(), 5));
            let text = |path: &Path| reads(path, 5).expect_err("no file").to_string();
            assert_eq!(text(folder.path()), "it is a folder, not a file");
            assert_eq!(text(Path::new("/dev/zero")), "it is a device, not a file");
        }
    }

    #[test]
    fn a_pipe_is_read_where_somebody_writes_and_refused_where_nobody_does() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&path).status();
        assert!(made.expect("mkfifo can be started").success());
        let text = |why: io::Error| why.to_string();
        assert_eq!(text(read_regular(&path, 5).expect_err("no file")), "it is a pipe, not a file");
        let silent = "it is a pipe that nothing was written into";
        assert_eq!(text(read(&path, 5).expect_err("nobody writes")), silent);
        let mut shell = std::process::Command::new("sh");
        let mut writer =
            shell.args(["-c", "printf 12345 > \"$0\""]).arg(&path).spawn().expect("sh");
        assert_eq!(read(&path, 5).expect("read").0, b"12345");
        assert!(writer.wait().expect("it ends").success());
    }
}
