//! Fresh files: what is written for long into the current folder; it gets its name when it is whole, and never that of a
//! file that is there.
//!
//! In: a name and bytes, little by little. Out: the file and the name it got (`pendulum.cast`, else `pendulum-2.cast`, …).
//! Never here: what the bytes mean; files that are written at once (`product`).

use std::fs::{self, File};
use std::io::{self, Write};
use std::mem;
use std::path::{Path, PathBuf};

use rustix::process::{Pid, test_kill_process};

use super::partial;
use super::whole::sync_folder;
use crate::printable;

/// A file that is being written under another name, line by line.
#[derive(Debug)]
pub(super) struct Fresh {
    file: File,
    /// What is not written yet.
    pending: Vec<u8>,
    /// How many bytes are in the file for good: whole lines, but at its end.
    whole: u64,
    partial: PathBuf,
    stem: String,
    ending: &'static str,
}

/// What a file without a line is called.
pub(super) const NOTHING: &str = "nothing";

/// What the name of an unfinished file ends in.
const PARTIAL: &str = ".partial";

/// Unfinished files in a folder whose writers have ended, killed or without power.
pub(super) fn left_behind(folder: &Path) -> Vec<PathBuf> {
    let listing = fs::read_dir(folder).into_iter().flatten().take(LOOKED_AT).flatten();
    let mut left: Vec<PathBuf> = listing
        .filter(|entry| entry.file_name().to_str().and_then(writer).is_some_and(has_ended))
        .map(|entry| entry.path())
        .collect();
    left.sort();
    left
}

/// No more files of a folder are looked at: it may be large, and this is a courtesy.
const LOOKED_AT: usize = 10_000;

/// The process that fills a file of this name, if it is one that is being filled.
fn writer(name: &str) -> Option<Pid> {
    let name = name.strip_prefix('.')?.strip_suffix(PARTIAL)?;
    // behind the name: the process, with a number that tells its files apart
    let (_, process) = name.rsplit_once('.')?;
    let process = process.split_once('-').map_or(process, |(process, _)| process);
    process.parse().ok().and_then(Pid::from_raw)
}

fn has_ended(process: Pid) -> bool {
    test_kill_process(process) == Err(rustix::io::Errno::SRCH)
}

/// How many names are tried.
const NAMES: u32 = 10_000;

/// So many bytes are written at once.
const CHUNK: usize = 32 * 1024;

impl Fresh {
    /// Begins a file in the current folder; `stem` is what of its name stands before the ending.
    pub(super) fn begin(stem: &str, ending: &'static str) -> io::Result<Fresh> {
        Fresh::within(Path::new(""), stem, ending)
    }

    /// The same in another folder.
    pub(super) fn within(folder: &Path, stem: &str, ending: &'static str) -> io::Result<Fresh> {
        let stem = plain(stem);
        let place = folder.join(format!("{stem}.{ending}"));
        let (file, partial) =
            partial::create(&place, partial::USUAL).map_err(|why| told(&place, &why))?;
        Ok(Fresh { file, pending: Vec::new(), whole: 0, partial, stem, ending })
    }

    /// Waits until the disk has what was written.
    pub(super) fn sync(&mut self) -> io::Result<()> {
        self.settle()?;
        self.file.sync_all().map_err(|why| self.told(&why))
    }

    /// Gives it its name, which is returned. Where not all of it can be written it holds the whole lines that were, and the
    /// error says so; only a file without a line is none.
    pub(super) fn finish(mut self) -> io::Result<String> {
        let written = self.sync();
        if self.whole == 0 {
            return written.map(|()| NOTHING.to_owned());
        }
        match (written, self.name()) {
            (Ok(()), Ok(name)) => {
                sync_folder(&self.partial);
                Ok(name)
            }
            (Err(why), Ok(name)) => {
                let what = format!("{why}; {name} holds what came before");
                Err(io::Error::new(why.kind(), what))
            }
            (_, Err(why)) => {
                let what = format!("{why}; it is in {}", printable::path(&self.partial));
                // better under that name than not at all
                partial::settled(&self.partial);
                self.partial = PathBuf::new();
                Err(io::Error::new(why.kind(), what))
            }
        }
    }

    /// Writes what is pending. Where that fails what was written of the last line is taken away again, and what comes is
    /// not to be written any more.
    fn settle(&mut self) -> io::Result<()> {
        let bytes = mem::take(&mut self.pending);
        let (mut at, mut failed) = (0, None);
        while at < bytes.len() {
            match self.file.write(&bytes[at..]) {
                Ok(0) => failed = Some(io::ErrorKind::WriteZero.into()),
                Ok(count) => at += count,
                Err(why) if why.kind() == io::ErrorKind::Interrupted => {}
                Err(why) => failed = Some(why),
            }
            if failed.is_some() {
                break;
            }
        }
        let Some(why) = failed else {
            self.whole += at as u64;
            return Ok(());
        };
        let lines = bytes[..at].iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
        self.whole += lines as u64;
        // the error that matters is the one on its way
        let _ = self.file.set_len(self.whole);
        Err(self.told(&why))
    }

    /// The error with the name that it was to have.
    fn told(&self, why: &io::Error) -> io::Error {
        told(&PathBuf::from(format!("{}.{}", self.stem, self.ending)), why)
    }

    /// Gives it the first name that is free.
    fn name(&self) -> io::Result<String> {
        let folder = self.partial.parent().unwrap_or(Path::new(""));
        for number in 1..=NAMES {
            let name = match number {
                1 => format!("{}.{}", self.stem, self.ending),
                n => format!("{}-{n}.{}", self.stem, self.ending),
            };
            let path = folder.join(&name);
            // a link is refused where the name is taken; a rename would not be
            match fs::hard_link(&self.partial, &path) {
                Ok(()) => return Ok(name),
                Err(why) if why.kind() == io::ErrorKind::AlreadyExists => {}
                Err(_) if !path.exists() => {
                    // there are file systems without links
                    return fs::rename(&self.partial, &path)
                        .map(|()| name)
                        .map_err(|why| told(&path, &why));
                }
                Err(_) => {}
            }
        }
        Err(io::Error::other(format!("there are {NAMES} files named after {}", self.stem)))
    }
}

impl Write for Fresh {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.pending.extend(bytes);
        if self.pending.len() >= CHUNK && bytes.ends_with(b"\n") {
            self.settle()?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.settle()
    }
}

impl Drop for Fresh {
    /// The name it was written under goes, and with it what was not finished.
    fn drop(&mut self) {
        partial::remove(&self.partial);
    }
}

/// The last part of a name, without what a file's name should not hold.
fn plain(name: &str) -> String {
    let last = Path::new(name).file_stem().map_or(String::new(), |s| s.to_string_lossy().into());
    let kept: String =
        last.chars().filter(|&c| !printable::is_steering(c) && !"/\\:".contains(c)).collect();
    if kept.is_empty() { "phaselab".to_owned() } else { kept }
}

/// The error with the file's name.
fn told(path: &Path, why: &io::Error) -> io::Error {
    io::Error::new(
        why.kind(),
        format!("cannot write {}: {}", printable::path(path), printable::why(why)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_planted_link_is_not_followed() {
        // under the name that was once foreseeable
        let folder = tempfile::tempdir().expect("a folder");
        let kept = folder.path().join("kept");
        fs::write(&kept, "one").expect("written");
        let partial = format!(".a.{}-1.svg.partial", std::process::id());
        std::os::unix::fs::symlink(&kept, folder.path().join(partial)).expect("a link");
        let mut file = Fresh::within(folder.path(), "a", "svg").expect("begun");
        file.write_all(b"two\n").expect("written");
        file.finish().expect("finished");
        assert_eq!(fs::read_to_string(&kept).expect("it is there"), "one");
        assert_eq!(fs::read_to_string(folder.path().join("a.svg")).expect("it is there"), "two\n");
    }

    #[test]
    fn what_a_killed_program_left_is_found() {
        let folder = tempfile::tempdir().expect("a folder");
        // no process has so large a number
        let dead = i32::MAX;
        let names = [
            format!(".a.b.cast.{dead}-0123456789abcdef.partial"),
            format!(".c.toml.{dead}.partial"),
            format!(".d.cast.{}-0123456789abcdef.partial", std::process::id()),
            "e.cast".to_owned(),
            ".f.cast.partial".to_owned(),
        ];
        for name in &names {
            fs::write(folder.path().join(name), "").expect("written");
        }
        let found = left_behind(folder.path());
        let found: Vec<_> = found.iter().filter_map(|path| path.file_name()?.to_str()).collect();
        assert_eq!(found, [&names[0], &names[1]]);
    }

    #[test]
    fn nothing_is_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |text: &str| {
            let mut file = Fresh::within(folder.path(), "my/pendulum.toml", "svg").expect("begun");
            file.write_all(text.as_bytes()).expect("written");
            file.finish().expect("finished")
        };
        assert_eq!([write("one"), write("two")], ["pendulum.svg", "pendulum-2.svg"]);
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect("a file");
        assert_eq!((read("pendulum.svg"), read("pendulum-2.svg")), ("one".into(), "two".into()));
        drop(Fresh::within(folder.path(), "given up", "cast").expect("begun"));
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 2);
    }
}
