//! The rows of an unfinished sweep, kept on the disk as they are computed.
//!
//! In: rows in any order. Out: a file beside the one to be written, which survives a kill at any moment: a line counts
//! once its end is there. Never here: how a row is computed.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use rustix::fs::{FlockOperation, flock};
use serde_json::Value;

use super::identity::Identity;
use crate::cli::error::CommandError;
use crate::file::check_regular;
use crate::printable;

/// A journal that is being written.
pub(super) struct Journal {
    path: PathBuf,
    lines: Mutex<Lines<File>>,
}

/// Lines at the end of a file, each of them complete or not there.
struct Lines<F> {
    file: F,
    /// The length of the complete lines.
    complete: u64,
    /// Whether part of a line may stand after them.
    torn: bool,
}

/// What can be cut to a length.
trait Cut {
    fn cut(&mut self, length: u64) -> io::Result<()>;
}

impl Cut for File {
    fn cut(&mut self, length: u64) -> io::Result<()> {
        self.set_len(length)
    }
}

impl<F: Write + Cut> Lines<F> {
    /// Adds a line. Where that fails, on a full disk, what was written of it is removed; no other line is added before.
    fn add(&mut self, line: &str) -> io::Result<()> {
        if self.torn {
            self.file.cut(self.complete)?;
            self.torn = false;
        }
        match self.file.write_all(line.as_bytes()) {
            Ok(()) => {
                self.complete += line.len() as u64;
                Ok(())
            }
            Err(error) => {
                self.torn = self.file.cut(self.complete).is_err();
                Err(error)
            }
        }
    }
}

fn path_of(output: &Path) -> PathBuf {
    let mut name = output.file_name().unwrap_or_default().to_owned();
    name.push(".journal");
    output.with_file_name(name)
}

/// Whether an output is, or will be, a regular file.
pub(super) fn is_regular(path: &Path) -> bool {
    fs::metadata(path).map_or(true, |about| about.is_file())
}

/// Whether an output is the file of this sweep with all its rows; one of another sweep is refused.
pub(super) fn is_complete(
    path: &Path,
    identity: &Identity,
    rows: usize,
) -> Result<bool, CommandError> {
    let text = match fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(false),
        Err(error) => return Err(CommandError::reading(path, &error)),
    };
    let mut lines = text.lines().take_while(|line| line.starts_with('#'));
    if lines.find_map(Identity::read).as_ref() == Some(identity) {
        // a sweep that was written row by row, and ended early, has fewer
        let lines = text.lines().filter(|line| !line.starts_with('#')).count();
        return Ok(lines == rows + 1 && text.ends_with('\n'));
    }
    let path = printable::path(path);
    let message = format!("{path} does not belong to this sweep: --resume leaves it unchanged");
    Err(CommandError::WrongUse(message))
}

/// Removes the journal of a complete file, left by a kill between the two.
pub(super) fn discard(output: &Path) {
    let _ = fs::remove_file(path_of(output));
}

impl Journal {
    /// Begins a journal, or continues one. Returns with it the line of each place that is known, and what is remarked of it.
    pub(super) fn open(
        output: &Path,
        identity: &Identity,
        places: usize,
        resume: bool,
    ) -> Result<(Journal, Vec<Option<String>>, BTreeMap<usize, Value>), CommandError> {
        let path = path_of(output);
        let name = printable::path(&path);
        let failed = |error: io::Error| CommandError::writing(&name, &error);
        let mut file =
            OpenOptions::new().read(true).append(true).create(true).open(&path).map_err(failed)?;
        // what is not a file may never end
        let about = file.metadata().map_err(failed)?;
        check_regular(about.file_type()).map_err(failed)?;
        if flock(&file, FlockOperation::NonBlockingLockExclusive).is_err() {
            let message = format!("{name} is being written by another phaselab");
            return Err(CommandError::WrongUse(message));
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(failed)?;
        // a line without its end was being written when the program was killed
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
        let text = String::from_utf8_lossy(&bytes[..whole]);
        let mut lines: Vec<Option<String>> = vec![None; places];
        let mut remarks: BTreeMap<usize, Value> = BTreeMap::new();
        let mut written = text.split_inclusive('\n');
        if let Some(first) = written.next() {
            if Identity::read(first.trim_end()).as_ref() != Some(identity) {
                let message = format!(
                    "{name} is the journal of another sweep; remove it, or write to another file"
                );
                return Err(CommandError::WrongUse(message));
            }
            if !resume {
                let message = format!("{name} holds an unfinished sweep; --resume continues it");
                return Err(CommandError::WrongUse(message));
            }
        }
        for line in written {
            let Some((place, row)) = line.split_once(' ') else { continue };
            if let Some(place) = place.strip_prefix('!') {
                let remark = place.parse().ok().zip(serde_json::from_str(row).ok());
                remarks.extend(remark.filter(|(place, _)| *place < places));
                continue;
            }
            if let Some(known) = place.parse().ok().and_then(|place: usize| lines.get_mut(place)) {
                *known = Some(row.to_owned());
            }
        }
        file.set_len(whole as u64).map_err(failed)?;
        let mut journal = Lines { file, complete: whole as u64, torn: false };
        if whole == 0 {
            journal.add(&format!("{}\n", identity.line())).map_err(failed)?;
        }
        // of a row that was not written no remark holds
        remarks.retain(|&place, _| lines[place].is_some());
        Ok((Journal { path, lines: Mutex::new(journal) }, lines, remarks))
    }

    /// Notes the line of a place, and before it what is remarked of it.
    pub(super) fn note(&self, place: usize, line: &str, remark: Option<&Value>) -> io::Result<()> {
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        let remark = remark.map_or_else(String::new, |remark| format!("!{place} {remark}\n"));
        lines.add(&format!("{remark}{place} {line}"))
    }

    pub(super) fn name(&self) -> String {
        printable::path(&self.path)
    }

    /// Removes it, once the file is written. What cannot be removed is recognised by its sweep.
    pub(super) fn remove(self) {
        let _ = fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk with some room left.
    struct Disk {
        text: Vec<u8>,
        room: usize,
        /// Whether it can be cut at present.
        cuts: bool,
    }

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let count = bytes.len().min(self.room);
            if count == 0 {
                return Err(io::ErrorKind::StorageFull.into());
            }
            self.room -= count;
            self.text.extend(&bytes[..count]);
            Ok(count)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Cut for Disk {
        fn cut(&mut self, length: u64) -> io::Result<()> {
            if !self.cuts {
                return Err(io::ErrorKind::StorageFull.into());
            }
            self.text.truncate(usize::try_from(length).map_err(io::Error::other)?);
            Ok(())
        }
    }

    #[test]
    fn a_line_torn_by_a_full_disk_leaves_nothing_behind() {
        for cuts in [true, false] {
            let file = Disk { text: Vec::new(), room: 12, cuts };
            let mut lines = Lines { file, complete: 0, torn: false };
            lines.add("0 1,2,3\n").expect("there is room");
            let failed = lines.add("1 4,5,6\n").expect_err("there is no room");
            assert_eq!(failed.kind(), io::ErrorKind::StorageFull);
            // there is room again, for another row
            lines.file.room = 100;
            lines.file.cuts = true;
            lines.add("2 7,8,9\n").expect("there is room again");
            assert_eq!(String::from_utf8_lossy(&lines.file.text), "0 1,2,3\n2 7,8,9\n");
        }
    }
}
