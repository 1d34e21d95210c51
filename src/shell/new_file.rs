//! New files: written as atomic files are, under a name that no file has (`pendulum.cast`, else `pendulum-2.cast`, …).
//!
//! In: a folder, a stem and bytes. Out: the file under the first free name; where not everything can be written, the
//! whole lines that were. Never here: what the bytes mean, or files that replace others.

use std::io::{self, Seek, Write};
use std::mem;
use std::path::{Path, PathBuf};

use super::atomic_file::{USUAL, UnfinishedFile, named};
use crate::printable;

const NAMES: u32 = 10_000;

/// The number of bytes written at once.
const CHUNK: usize = 32 * 1024;

/// The name reported for a file without a line.
pub(super) const NOTHING: &str = "nothing";

/// A file that never replaces another, written line by line.
#[derive(Debug)]
pub(super) struct NewFile {
    temporary: UnfinishedFile,
    /// The bytes not written yet.
    pending: Vec<u8>,
    /// The number of bytes that stay in the file: whole lines, except at the end.
    whole: u64,
    folder: PathBuf,
    stem: String,
    ending: &'static str,
}

/// Writes `heavy-top.toml` or, if that exists, `heavy-top-2.toml`, …, and returns its path.
///
/// # Errors
/// Returns an error that names the file if it cannot be written; nothing is left of it.
pub(super) fn write_new(
    folder: &Path,
    stem: &str,
    ending: &'static str,
    bytes: &[u8],
) -> io::Result<PathBuf> {
    let mut file = NewFile::begin(folder, stem, ending)?;
    file.write_all(bytes)?;
    // It must be complete before it is finished, since finishing also names a partial file.
    file.sync()?;
    Ok(folder.join(file.finish()?))
}

impl NewFile {
    /// Begins a file; `stem` is a preset's name or a path, whose file stem is used.
    pub(super) fn begin(folder: &Path, stem: &str, ending: &'static str) -> io::Result<Self> {
        let stem = plain(stem);
        let place = folder.join(format!("{stem}.{ending}"));
        let temporary = UnfinishedFile::begin(&place, USUAL).map_err(|why| named(&place, &why))?;
        let folder = folder.to_owned();
        Ok(Self { temporary, pending: Vec::new(), whole: 0, folder, stem, ending })
    }

    /// Waits until all written bytes are on the disk.
    pub(super) fn sync(&mut self) -> io::Result<()> {
        self.flush()?;
        self.temporary.file().sync_all().map_err(|why| named(&self.place(1), &why))
    }

    /// Gives it its name, which is returned. If not everything can be written, the file keeps the whole lines that
    /// were, and the error says so; a file without a line is removed.
    pub(super) fn finish(mut self) -> io::Result<String> {
        let written = self.sync();
        if self.whole == 0 {
            return written.map(|()| NOTHING.to_owned());
        }
        let name = self.persist()?;
        written.map(|()| name.clone()).map_err(|why| {
            io::Error::new(why.kind(), format!("{why}; {name} holds what came before"))
        })
    }

    /// Gives it the first free name. If there is none, it is kept under its temporary name.
    fn persist(self) -> io::Result<String> {
        let mut place = self.place(1);
        let mut temporary = self.temporary;
        let mut why = io::Error::other(format!("there are already {NAMES} files of that name"));
        for number in 1..=NAMES {
            place = self.folder.join(numbered(&self.stem, number, self.ending));
            match temporary.persist_new(&place) {
                Ok(()) => return Ok(numbered(&self.stem, number, self.ending)),
                Err(failed) => (temporary, why) = failed,
            }
            if why.kind() != io::ErrorKind::AlreadyExists {
                break;
            }
        }
        let why = named(&place, &why);
        let message = format!("{why}; it is in {}", printable::path(&temporary.keep()));
        Err(io::Error::new(why.kind(), message))
    }

    fn place(&self, number: u32) -> PathBuf {
        self.folder.join(numbered(&self.stem, number, self.ending))
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.pending.extend(bytes);
        if self.pending.len() >= CHUNK && bytes.ends_with(b"\n") {
            self.flush()?;
        }
        Ok(bytes.len())
    }

    /// Writes what is pending. If that fails, the partial last line is removed, and nothing more is to be written.
    fn flush(&mut self) -> io::Result<()> {
        let bytes = mem::take(&mut self.pending);
        let file = self.temporary.file();
        let Err(why) = file.write_all(&bytes) else {
            self.whole += bytes.len() as u64;
            return Ok(());
        };
        let written = file.stream_position().unwrap_or(self.whole).saturating_sub(self.whole);
        let written = &bytes[..bytes.len().min(written as usize)];
        self.whole +=
            written.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1) as u64;
        // The error that matters is the one about to be returned.
        let _ = file.set_len(self.whole);
        Err(named(&self.place(1), &why))
    }
}

fn numbered(stem: &str, number: u32, ending: &str) -> String {
    if number == 1 { format!("{stem}.{ending}") } else { format!("{stem}-{number}.{ending}") }
}

/// Returns the stem for files made from a preset or file: its name without folders, extension, and characters that
/// do not belong in a file name.
fn plain(name: &str) -> String {
    let last = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    let clean: String =
        last.chars().filter(|&c| !printable::is_steering(c) && !"/\\:".contains(c)).collect();
    if clean.is_empty() { "phaselab".to_owned() } else { clean }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::shell::atomic_file::tests::names;

    #[test]
    fn new_files_replace_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let put = |text: &str| write_new(folder.path(), "my/top.toml", "svg", text.as_bytes());
        for text in ["one", "two", "three"] {
            put(text).expect("written");
        }
        assert_eq!(names(folder.path()), ["top-2.svg", "top-3.svg", "top.svg"]);
        let first = fs::read_to_string(folder.path().join("top.svg")).expect("it is there");
        assert_eq!(first, "one");
        drop(NewFile::begin(folder.path(), "given up", "cast").expect("begun"));
        assert_eq!(names(folder.path()).len(), 3);
        let error =
            write_new(Path::new("/nowhere/at/all"), "top", "svg", b"").expect_err("no folder");
        assert_eq!(
            error.to_string(),
            "cannot write /nowhere/at/all/top.svg: its folder does not exist"
        );
    }

    #[test]
    fn names_come_from_presets_and_paths() {
        assert_eq!(
            ["heavy-top", "my/own.system.toml", ""].map(plain),
            ["heavy-top", "own.system", "phaselab"]
        );
    }
}
