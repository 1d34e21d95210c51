//! The file writer: writes whole files to the disk, one after the other, on its own thread, so that no frame waits
//! for a disk.
//!
//! In: the contents of a file, its removal, or a request that it be on the disk. Out: the outcomes. Never here: what the texts mean.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use super::atomic_file::{self, Durability, named, sync_folder};

/// A closure that produces the text of a file; it may be slow.
type Maker = Box<dyn FnOnce() -> io::Result<String> + Send>;

/// What is done with a file.
enum Task {
    Write(Maker),
    Remove,
    /// What was given its name without waiting for the disk is put on the disk.
    Sync,
}

#[derive(Debug)]
pub(super) struct FileWriter {
    tasks: Sender<(PathBuf, Task)>,
    outcomes: Receiver<(PathBuf, io::Result<()>)>,
    /// How many writes of each file are outstanding.
    open: BTreeMap<PathBuf, usize>,
    /// Whether there is no time to wait for a disk.
    hurried: Arc<AtomicBool>,
}

impl FileWriter {
    pub(super) fn new() -> io::Result<Self> {
        let (tasks, given) = channel::<(PathBuf, Task)>();
        let (sender, outcomes) = channel();
        let hurried = Arc::new(AtomicBool::new(false));
        let hurry = Arc::clone(&hurried);
        thread::Builder::new().name("scribe".to_owned()).spawn(move || {
            for (path, task) in given {
                let done = match task {
                    Task::Write(text) => text().and_then(|text| {
                        let hurried = hurry.load(Ordering::Relaxed);
                        let durability =
                            if hurried { Durability::Cached } else { Durability::OnDisk };
                        put(&path, &text, durability)
                    }),
                    Task::Remove => remove(&path),
                    Task::Sync => sync(&path),
                };
                if sender.send((path, done)).is_err() {
                    break;
                }
            }
        })?;
        Ok(Self { tasks, outcomes, open: BTreeMap::new(), hurried })
    }

    /// From now on gives files their names without waiting for the disk, or no longer does: where the program ends, the
    /// files outlive it, and the system writes them back.
    pub(super) fn hurry(&self, hurried: bool) {
        self.hurried.store(hurried, Ordering::Relaxed);
    }

    pub(super) fn write(
        &mut self,
        path: &Path,
        text: impl FnOnce() -> io::Result<String> + Send + 'static,
    ) {
        self.give(path, Task::Write(Box::new(text)));
    }

    /// Queues the removal of a file; a missing file is not an error.
    pub(super) fn remove(&mut self, path: &Path) {
        self.give(path, Task::Remove);
    }

    /// Queues that a file is put on the disk as it is.
    pub(super) fn sync(&mut self, path: &Path) {
        self.give(path, Task::Sync);
    }

    fn give(&mut self, path: &Path, task: Task) {
        if self.tasks.send((path.to_owned(), task)).is_ok() {
            *self.open.entry(path.to_owned()).or_default() += 1;
        }
    }

    /// Returns the outcomes since the last call.
    pub(super) fn outcomes(&mut self) -> Vec<(PathBuf, io::Result<()>)> {
        let outcomes: Vec<_> = self.outcomes.try_iter().collect();
        for (path, _) in &outcomes {
            self.close(path);
        }
        outcomes
    }

    /// Returns the outcomes of everything queued so far, waiting at most this long. Work not done by then yields an
    /// error of the kind [`ErrorKind::TimedOut`], and may still be done later.
    pub(super) fn wait_for_outcomes(&mut self, time: Duration) -> Vec<(PathBuf, io::Result<()>)> {
        let end = Instant::now() + time;
        let mut outcomes = self.outcomes();
        while !self.open.is_empty() {
            let left = end.saturating_duration_since(Instant::now());
            let Ok((path, done)) = self.outcomes.recv_timeout(left) else { break };
            self.close(&path);
            outcomes.push((path, done));
        }
        for path in self.open.keys() {
            let slow = io::Error::new(ErrorKind::TimedOut, "writing takes too long");
            outcomes.push((path.clone(), Err(named(path, &slow))));
        }
        outcomes
    }

    fn close(&mut self, path: &Path) {
        if let Some(count) = self.open.get_mut(path) {
            *count -= 1;
            if *count == 0 {
                self.open.remove(path);
            }
        }
    }
}

/// Writes a whole file: it is on the disk before it gets its name, and has its name before this returns.
pub(super) fn write(path: &Path, text: &str) -> io::Result<()> {
    put(path, text, Durability::OnDisk)
}

fn put(path: &Path, text: &str, durability: Durability) -> io::Result<()> {
    atomic_file::write(path, text.as_bytes(), durability).map_err(|error| named(path, &error))
}

fn sync(path: &Path) -> io::Result<()> {
    let synced = fs::File::open(path).and_then(|file| file.sync_all());
    synced.and_then(|()| sync_folder(path)).map_err(|error| named(path, &error))
}

fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(error) => Err(named(path, &error)),
        Ok(()) => sync_folder(path).map_err(|error| named(path, &error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONG: Duration = Duration::from_secs(20);

    #[test]
    fn files_are_written_in_order_and_what_goes_wrong_is_reported() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.toml");
        let nowhere = folder.path().join("none/b.toml");
        let mut file_writer = FileWriter::new().expect("a thread");
        for text in ["one", "two"] {
            file_writer.write(&path, move || Ok(text.to_owned()));
        }
        file_writer.write(&nowhere, || Ok(String::new()));
        let outcomes = file_writer.wait_for_outcomes(LONG);
        assert_eq!(outcomes.len(), 3);
        assert_eq!(fs::read_to_string(&path).expect("it is there"), "two");
        let (_, failed) = &outcomes[2];
        let message = failed.as_ref().expect_err("there is no such folder").to_string();
        assert!(message.starts_with("cannot write ") && message.contains("b.toml"), "{message}");
        file_writer.remove(&path);
        file_writer.remove(&path);
        assert!(file_writer.wait_for_outcomes(LONG).iter().all(|(_, done)| done.is_ok()));
        assert!(!path.exists());
    }

    #[test]
    fn in_a_hurry_a_file_has_its_name_first_and_is_put_on_the_disk_afterwards() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.toml");
        let mut file_writer = FileWriter::new().expect("a thread");
        file_writer.hurry(true);
        file_writer.write(&path, || Ok("one".to_owned()));
        assert!(file_writer.wait_for_outcomes(LONG).iter().all(|(_, done)| done.is_ok()));
        assert_eq!(fs::read_to_string(&path).expect("it is there"), "one");
        file_writer.sync(&path);
        file_writer.sync(&folder.path().join("none"));
        let outcomes = file_writer.wait_for_outcomes(LONG);
        assert!(outcomes[0].1.is_ok() && outcomes[1].1.is_err(), "{outcomes:?}");
        assert_eq!(fs::read_to_string(&path).expect("it is there"), "one");
    }

    #[test]
    fn a_slow_disk_is_not_waited_for_without_end() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.toml");
        let mut file_writer = FileWriter::new().expect("a thread");
        let (go, slow) = channel::<()>();
        file_writer.write(&path, move || {
            // Blocks until the sender is used or dropped.
            let _ = slow.recv();
            Ok("late".to_owned())
        });
        let [(_, Err(late))] = &file_writer.wait_for_outcomes(Duration::ZERO)[..] else {
            panic!("it is not late")
        };
        assert_eq!(late.kind(), ErrorKind::TimedOut);
        go.send(()).expect("it waits");
        assert!(file_writer.wait_for_outcomes(LONG).iter().all(|(_, done)| done.is_ok()));
        assert_eq!(fs::read_to_string(&path).expect("it is there"), "late");
    }
}
