//! Partial files: what a file is called while it is filled, beside the place it is meant for.
//!
//! In: a place. Out: an open file that nobody else had a hand in: it is made anew under a name that cannot be foreseen,
//! and no link is followed. Those that a killed process left are swept away. Never here: what becomes of it.

use std::collections::BTreeSet;
use std::collections::hash_map::RandomState;
use std::fs::{self, File, OpenOptions};
use std::hash::{BuildHasher, Hasher};
use std::io;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use rustix::fs::OFlags;
use rustix::process::{Pid, geteuid, test_kill_process};

/// What such names end in.
const ENDING: &str = ".partial";

/// So much of the file's own name is in them: with the rest they stay shorter than any system's limit.
const LONGEST: usize = 60;

/// How many names are tried.
const TRIES: usize = 16;

/// Who may read a file: its owner alone, or whoever the process lets.
pub(super) const PRIVATE: u32 = 0o600;
pub(super) const USUAL: u32 = 0o666;

/// Those this process is filling.
static OWN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Makes one beside `place`.
pub(super) fn create(place: &Path, mode: u32) -> io::Result<(File, PathBuf)> {
    let lead = lead(place);
    let mut last = io::Error::from(io::ErrorKind::AlreadyExists);
    for _ in 0..TRIES {
        let chance = RandomState::new().build_hasher().finish();
        let name = format!("{lead}{}-{chance:016x}{ENDING}", std::process::id());
        let path = place.with_file_name(name);
        let file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .mode(mode)
            .custom_flags(OFlags::NOFOLLOW.bits() as i32)
            .open(&path);
        match file {
            Ok(file) => {
                own().insert(path.clone());
                return Ok((file, path));
            }
            Err(why) if why.kind() == io::ErrorKind::AlreadyExists => last = why,
            Err(why) => return Err(why),
        }
    }
    Err(last)
}

/// It has got another name, or is to be kept under this one.
pub(super) fn settled(path: &Path) {
    own().remove(path);
}

/// Takes one away that is not wanted any more.
pub(super) fn remove(path: &Path) {
    settled(path);
    // the error that matters is the one on its way
    let _ = fs::remove_file(path);
}

/// Takes all away that this process is filling: it ends before they can be whole.
pub(crate) fn remove_all() {
    for path in std::mem::take(&mut *own()) {
        // there is nobody left to tell
        let _ = fs::remove_file(path);
    }
}

fn own() -> std::sync::MutexGuard<'static, BTreeSet<PathBuf>> {
    OWN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Takes away what processes left that were killed while they filled a file of this place.
pub(super) fn sweep(place: &Path) {
    let folder = match place.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let (lead, Ok(listing)) = (lead(place), fs::read_dir(folder)) else { return };
    for entry in listing.flatten() {
        let name = entry.file_name();
        let process = name.to_str().and_then(|name| process(name.strip_prefix(&lead)?));
        let Some(process) = process else { continue };
        let gone = Pid::from_raw(process)
            .is_some_and(|pid| test_kill_process(pid) == Err(rustix::io::Errno::SRCH));
        let ours = entry
            .metadata()
            .is_ok_and(|about| about.is_file() && about.uid() == geteuid().as_raw());
        if gone && ours {
            // what cannot be taken away harms nobody
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// How the names of a place's partial files begin.
fn lead(place: &Path) -> String {
    let name = place.file_name().unwrap_or_default().to_string_lossy();
    let mut end = name.len().min(LONGEST);
    while !name.is_char_boundary(end) {
        end -= 1;
    }
    format!(".{}.", &name[..end])
}

/// Which process filled it, by what follows in its name.
fn process(rest: &str) -> Option<i32> {
    let rest = rest.strip_suffix(ENDING)?;
    let process = rest.split_once('-').map_or(rest, |(process, _)| process);
    process.parse().ok().filter(|process| *process > 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_dead_left_is_swept_and_what_the_living_fill_is_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("a.csv");
        // no process has that number: it is beyond the greatest there can be
        let left =
            ["-0123456789abcdef", ""].map(|rest| format!(".a.csv.{}{rest}.partial", i32::MAX));
        let mut others = vec![
            format!(".a.csv.{}-0123456789abcdef.partial", std::process::id()),
            format!(".b.csv.{}-0123456789abcdef.partial", i32::MAX),
            ".a.csv.mine.partial".to_owned(),
            "a.csv".to_owned(),
        ];
        for name in left.iter().chain(&others) {
            fs::write(folder.path().join(name), "").expect("written");
        }
        sweep(&place);
        let names = fs::read_dir(folder.path()).expect("a folder").flatten();
        let mut names: Vec<String> =
            names.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        others.sort();
        assert_eq!(names, others);
    }

    #[test]
    fn its_name_is_short_and_never_the_same() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("é".repeat(120));
        let made = [PRIVATE, USUAL].map(|mode| create(&place, mode).expect("made").1);
        assert_ne!(made[0], made[1]);
        let mode = fs::metadata(&made[0]).expect("it is there").mode();
        assert_eq!(mode & 0o777, PRIVATE);
        for path in &made {
            remove(path);
        }
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
    }
}
