//! The store: the files of the last session and of unsaved texts, and the locks that keep two programs from writing
//! the same file.
//!
//! In: a session, texts. Out: their files, complete or unchanged; both can be read back. Never here: their
//! contents; waiting for a disk, unless requested.
//!
//! One program saves the session and its texts. Another program that runs at the same time stores its texts in a
//! separate file (`texts-2.toml`, …), and takes the place of the first when that ends. The first program also
//! adopts what others left behind. Files of a newer version are never overwritten; a malformed file is moved aside.

mod damaged;
mod error;
mod lock;

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use self::damaged::read_or_quarantine;
pub(super) use self::error::StoreError;
use self::lock::{lock, numbered};
use super::file_writer::{self, FileWriter};
use super::session_file::{contents, read_from, read_texts, session_path};
use crate::app::{Saved, Unsaved};

/// The maximum number of programs that store texts at the same time.
const PROGRAMS: u32 = 64;

/// The session folder, locked as long as this value lives.
#[derive(Debug)]
pub(super) struct Store {
    /// The session's file; `None` if its contents must not be overwritten, or if another program saves the session.
    session: Option<PathBuf>,
    /// The file of the texts; `None` if its contents must not be overwritten.
    texts: Option<PathBuf>,
    /// The texts as they are, or soon will be, in the file.
    known: Vec<Unsaved>,
    /// Whether the last write of the file of texts failed.
    failed: bool,
    /// The session's file of the first program, if this is another program.
    waits_for: Option<PathBuf>,
    /// The previous file of the texts, from before this program took the place of the first.
    former: Option<PathBuf>,
    file_writer: FileWriter,
    /// What is not stored and why, in sentences.
    pub(super) troubles: Vec<String>,
    /// The system releases the lock however the program ends.
    _lock: File,
}

impl Store {
    /// Opens the store in its default place.
    pub(super) fn open() -> Result<Self, StoreError> {
        Self::at(session_path().ok_or(StoreError::NoHome)?)
    }

    fn at(path: PathBuf) -> Result<Self, StoreError> {
        let refused = |reason| StoreError::Refused { path: path.clone(), reason };
        let folder = path.parent().unwrap_or(Path::new("."));
        fs::create_dir_all(folder).map_err(refused)?;
        let file_writer = FileWriter::new().map_err(refused)?;
        if let Some(lock) = lock(&path.with_extension("lock")).map_err(refused)? {
            return Ok(Self::first(&path, lock, file_writer));
        }
        for number in 2..=PROGRAMS {
            let texts = numbered(&path, number);
            if let Some(lock) = lock(&texts.with_extension("lock")).map_err(refused)? {
                return Ok(Self::another(path, texts, lock, file_writer));
            }
        }
        Err(StoreError::Taken)
    }

    /// Creates the store of the program that saves the session.
    fn first(session: &Path, lock: File, file_writer: FileWriter) -> Self {
        let mut troubles = Vec::new();
        let what = "the session will not be saved";
        let readable =
            read_or_quarantine(session, what, &mut troubles, |path| read_from(path).map(|_| ()));
        let texts = session.with_file_name("texts.toml");
        let what = "unsaved texts will not be kept";
        let known = read_or_quarantine(&texts, what, &mut troubles, read_texts);
        let mut store = Self {
            texts: known.is_ok().then_some(texts),
            session: readable.is_ok().then(|| session.to_owned()),
            known: known.ok().flatten().unwrap_or_default(),
            failed: false,
            waits_for: None,
            former: None,
            file_writer,
            troubles,
            _lock: lock,
        };
        store.adopt_others(session);
        store
    }

    /// Creates the store of a program that runs beside the first.
    fn another(session: PathBuf, texts: PathBuf, lock: File, file_writer: FileWriter) -> Self {
        let message =
            "the session will not be saved: another phaselab is running and saves its own";
        let mut troubles = vec![message.to_owned()];
        let what = "unsaved texts will not be kept";
        let known = read_or_quarantine(&texts, what, &mut troubles, read_texts);
        Self {
            session: None,
            texts: known.is_ok().then_some(texts),
            known: known.ok().flatten().unwrap_or_default(),
            failed: false,
            waits_for: Some(session),
            former: None,
            file_writer,
            troubles,
            _lock: lock,
        }
    }

    /// Adopts the texts of other programs that have ended without passing them on.
    fn adopt_others(&mut self, session: &Path) {
        let Some(texts) = self.texts.clone() else { return };
        for number in 2..=PROGRAMS {
            let theirs = numbered(session, number);
            if !theirs.exists() {
                continue;
            }
            let Ok(Some(_lock)) = lock(&theirs.with_extension("lock")) else { continue };
            let Ok(found) = read_texts(&theirs) else { continue };
            for text in found {
                if !self.known.contains(&text) {
                    self.known.push(text);
                }
            }
            // Their file is removed only after the texts have been written to this one.
            match contents(&self.known).and_then(|text| file_writer::write(&texts, &text)) {
                Ok(()) => {
                    // If removing it fails, it is adopted once more, which does not matter.
                    let _ = fs::remove_file(&theirs);
                }
                Err(why) => self.troubles.push(why.to_string()),
            }
        }
    }

    /// Takes the place of the first program if that has ended. Returns the texts to restore from it.
    pub(super) fn take_over(&mut self) -> Option<Vec<Unsaved>> {
        let session = self.waits_for.as_ref()?;
        let lock = lock(&session.with_extension("lock")).ok().flatten()?;
        let file_writer = FileWriter::new().ok()?;
        let session = self.waits_for.take()?;
        let mut own = std::mem::replace(self, Self::first(&session, lock, file_writer));
        // The current file writer stays, since it may still have work to do.
        std::mem::swap(&mut self.file_writer, &mut own.file_writer);
        let found = self.known.clone();
        // The texts of this program remain in the old file until they are in the new one.
        self.former = own.texts;
        Some(found)
    }

    /// Queues a session to replace the last one. If writing fails, the last one stays.
    pub(super) fn save(&mut self, saved: Saved) {
        let Some(path) = &self.session else { return };
        self.file_writer.write(path, move || toml::to_string(&saved).map_err(io::Error::other));
    }

    /// Returns the unsaved texts as they were stored last.
    pub(super) fn texts(&self) -> &[Unsaved] {
        &self.known
    }

    /// Returns the file of the texts, or `None` if no texts are stored.
    pub(super) fn place_of_texts(&self) -> Option<&Path> {
        self.texts.as_deref()
    }

    pub(super) fn keeps_texts(&self) -> bool {
        self.texts.is_some() && !self.failed
    }

    /// Queues these texts to replace the stored ones. Returns whether that was necessary. The last call does not
    /// rely on earlier writes.
    pub(super) fn keep_texts(&mut self, texts: Vec<Unsaved>, last: bool) -> bool {
        let changed = texts != self.known || self.failed || self.former.is_some();
        let needed = changed || last && !texts.is_empty();
        let Some(path) = self.texts.as_ref().filter(|_| needed) else { return false };
        self.known.clone_from(&texts);
        if texts.is_empty() {
            self.file_writer.remove(path);
        } else {
            self.file_writer.write(path, move || contents(&texts));
        }
        true
    }

    /// Whether files are given their names without waiting for the disk from now on.
    pub(super) fn hurry(&self, hurried: bool) {
        self.file_writer.hurry(hurried);
    }

    /// Puts the files on the disk that were stored without waiting for it, within this time: what the disk has not taken by
    /// then the system writes back, since no reader misses anything.
    pub(super) fn sync(&mut self, time: Duration) {
        let files = self.session.iter().chain(&self.texts).filter(|path| path.exists());
        files.for_each(|path| self.file_writer.sync(path));
        self.file_writer.wait_for_outcomes(time);
    }

    /// Returns the errors since the last call; each names its file.
    pub(super) fn errors(&mut self) -> Vec<io::Error> {
        let outcomes = self.file_writer.outcomes();
        self.collect_errors(outcomes)
    }

    /// Returns the errors of all queued work, waiting at most this long.
    pub(super) fn wait_for_errors(&mut self, time: Duration) -> Vec<io::Error> {
        let outcomes = self.file_writer.wait_for_outcomes(time);
        self.collect_errors(outcomes)
    }

    fn collect_errors(&mut self, outcomes: Vec<(PathBuf, io::Result<()>)>) -> Vec<io::Error> {
        for (path, done) in &outcomes {
            if self.texts.as_ref() != Some(path) {
                continue;
            }
            self.failed = done.is_err();
            if done.is_ok()
                && let Some(former) = self.former.take()
            {
                self.file_writer.remove(&former);
            }
        }
        outcomes.into_iter().filter_map(|(_, done)| done.err()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::{Page, Pane, Selection};
    use crate::experiment::{Changed, Checkpoint};

    fn session() -> Saved {
        let g = Changed { name: "g".to_owned(), value: 1.0 / 3.0, of_file: 9.81 };
        Saved {
            typed: Vec::new(),
            version: Saved::VERSION,
            phaselab: "0.1.0".to_owned(),
            open: "pendulum".to_owned(),
            page: Page::Lab,
            focus: Pane::Plot(1),
            zoomed: true,
            selection: Selection::default(),
            edited: true,
            law: Some("0123456789abcdef".to_owned()),
            time_unit: "s".to_owned(),
            marks: vec![0.5],
            in_front: vec![1],
            plots: Vec::new(),
            checkpoint: Checkpoint {
                parameters: vec![g],
                speed: Some(f64::INFINITY),
                ..Checkpoint::default()
            },
        }
    }

    const LONG: Duration = Duration::from_secs(20);

    #[track_caller]
    fn settled(store: &mut Store) {
        let errors = store.wait_for_errors(LONG);
        assert!(errors.is_empty(), "{errors:?}");
    }

    #[test]
    fn what_is_saved_is_read_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new/session.toml");
        let mut store = Store::at(path.clone()).expect("it can be written");
        store.save(session());
        settled(&mut store);
        assert_eq!(read_from(&path).expect("it is read"), session());
        let files = fs::read_dir(folder.path().join("new")).expect("the folder").count();
        assert_eq!(files, 2, "the session and its lock, nothing half written");
    }

    fn text(name: &str, text: &str) -> Unsaved {
        let place = Some(PathBuf::from("/a/b.toml"));
        let of = String::new();
        Unsaved { name: name.into(), title: "b".into(), place, text: text.into(), of }
    }

    #[test]
    fn texts_are_saved_to_the_last_character_until_there_are_none() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("session.toml");
        let mut store = Store::at(path.clone()).expect("it can be written");
        let odd = "a \"text\"\r\n'''\u{1}\u{7f}\\ θ\n\n\"\"\" \t";
        let texts = vec![text("one", odd), text("two", "")];
        assert!(store.keep_texts(texts.clone(), false));
        assert!(!store.keep_texts(texts.clone(), false), "they stand there");
        settled(&mut store);
        drop(store);
        let mut store = Store::at(path).expect("it can be written");
        assert_eq!(store.texts(), texts);
        let place = store.place_of_texts().expect("a file").to_owned();
        assert!(place.exists());
        store.keep_texts(Vec::new(), false);
        settled(&mut store);
        assert!(!place.exists());
    }

    #[test]
    fn what_a_newer_program_wrote_is_never_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("session.toml");
        let places = [path.clone(), path.with_file_name("texts.toml")];
        let newer = "version = 2\n";
        for place in &places {
            fs::write(place, newer).expect("it is written");
        }
        let mut store = Store::at(path).expect("it is free");
        assert_eq!(store.troubles.len(), 2, "{:?}", store.troubles);
        assert_eq!((store.place_of_texts(), store.keeps_texts()), (None, false));
        store.save(session());
        store.keep_texts(vec![text("one", "two")], false);
        settled(&mut store);
        for place in &places {
            assert_eq!(fs::read_to_string(place).expect("it is there"), newer);
        }
    }

    #[test]
    fn what_cannot_be_understood_is_quarantined_and_does_not_stop_saving() {
        for malformed in ["version = ]\n", "", "\0\0\0\0"] {
            let folder = tempfile::tempdir().expect("a folder");
            let path = folder.path().join("session.toml");
            let texts = path.with_file_name("texts.toml");
            for place in [&path, &texts] {
                fs::write(place, malformed).expect("it is written");
            }
            let mut store = Store::at(path.clone()).expect("it is free");
            let empty = !malformed.starts_with("version");
            assert_eq!(store.troubles.is_empty(), empty, "{:?}", store.troubles);
            store.save(session());
            store.keep_texts(vec![text("one", "two")], false);
            settled(&mut store);
            assert_eq!(read_from(&path).expect("it is read"), session());
            assert_eq!(read_texts(&texts).expect("they are read"), [text("one", "two")]);
            for name in ["session-damaged-1.toml", "texts-damaged-1.toml"] {
                let found = fs::read_to_string(folder.path().join(name)).ok();
                assert_eq!(found.as_deref(), Some(malformed).filter(|_| !empty));
            }
        }
    }

    #[test]
    fn a_pipe_in_the_place_of_a_file_is_reported_and_not_waited_for() {
        use rustix::fs::{CWD, FileType, Mode, mknodat};
        let pipe = |path: &Path| {
            mknodat(CWD, path, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).expect("a pipe");
        };
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("session.toml");
        pipe(&path);
        pipe(&path.with_file_name("texts.toml"));
        let store = Store::at(path.clone()).expect("it is free");
        assert_eq!(store.troubles.len(), 2, "{:?}", store.troubles);
        assert!(store.troubles.iter().all(|message| message.contains("it is a pipe, not a file")));
        drop(store);
        fs::remove_file(path.with_extension("lock")).expect("it goes");
        pipe(&path.with_extension("lock"));
        assert!(matches!(Store::at(path), Err(StoreError::Refused { .. })));
    }

    #[test]
    fn the_second_of_two_keeps_its_texts_and_takes_the_place_of_the_first() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("session.toml");
        let mut first = Store::at(path.clone()).expect("it is free");
        let mut second = Store::at(path.clone()).expect("it has a place of its own");
        assert!(second.troubles[0].contains("another phaselab is running"));
        assert!(second.keeps_texts());
        second.save(session());
        second.keep_texts(vec![text("two", "b")], false);
        settled(&mut second);
        assert!(!path.exists(), "the session is the first one's");
        assert_eq!(second.take_over(), None, "the first is there");
        first.keep_texts(vec![text("one", "a")], false);
        settled(&mut first);
        drop(first);
        assert_eq!(second.take_over(), Some(vec![text("one", "a")]));
        assert_eq!(second.take_over(), None);
        second.save(session());
        second.keep_texts(vec![text("one", "a"), text("two", "b")], false);
        settled(&mut second);
        settled(&mut second);
        assert!(path.exists());
        drop(second);
        let third = Store::at(path.clone()).expect("it is free");
        assert_eq!(third.texts(), [text("one", "a"), text("two", "b")]);
        assert!(!numbered(&path, 2).exists(), "they stand in one place only");
    }

    #[test]
    fn the_texts_of_a_second_that_ended_first_are_taken_up() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("session.toml");
        let first = Store::at(path.clone()).expect("it is free");
        let mut second = Store::at(path.clone()).expect("it has a place of its own");
        second.keep_texts(vec![text("two", "b")], false);
        settled(&mut second);
        drop(second);
        drop(first);
        let again = Store::at(path.clone()).expect("it is free");
        assert_eq!(again.texts(), [text("two", "b")]);
        assert!(!numbered(&path, 2).exists());
        drop(again);
        assert_eq!(Store::at(path).expect("it is free").texts(), [text("two", "b")]);
    }

    #[test]
    fn a_session_that_cannot_be_written_leaves_the_last_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("session.toml");
        let mut store = Store::at(path.clone()).expect("it is free");
        store.save(session());
        settled(&mut store);
        // Missing write permission would not stop root, so a folder takes the place of the file.
        fs::remove_file(&path).expect("it goes");
        fs::create_dir(&path).expect("a folder");
        fs::write(path.join("in the way"), "").expect("it is written");
        store.save(Saved { open: "planet".to_owned(), ..session() });
        let errors = store.wait_for_errors(LONG);
        let [error] = &errors[..] else { panic!("{errors:?}") };
        let message = error.to_string();
        assert!(
            message.starts_with("cannot write ") && message.contains("session.toml"),
            "{message}"
        );
        assert!(path.join("in the way").exists());
    }
}
