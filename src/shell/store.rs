//! The store: the files in which the last session and the texts that were not saved are kept, and the locks by which two
//! programs do not write them both.
//!
//! In: a session, texts. Out: their files, whole or as they were; both read back. Never here: what they are made of;
//! waiting for a disk, unless that is asked for.
//!
//! One program keeps the session and its texts. Another that runs meanwhile keeps its texts in a file of its own
//! (`texts-2.toml`, …), takes the place of the first when that ends, and whoever is first takes up what others left.
//! What stands there and is of a newer program is never written over; what is no session at all is put aside.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use etcetera::BaseStrategy;
use etcetera::base_strategy::Xdg;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::file_writer::{self, FileWriter};
use super::regular;
use crate::app::{Saved, Unsaved};

/// The place where sessions are kept, held for as long as this lives.
#[derive(Debug)]
pub(super) struct Store {
    /// The session's file; `None` where what stands there is not to be written over, or another program has it.
    session: Option<PathBuf>,
    /// The same of the texts.
    texts: Option<PathBuf>,
    /// The texts as the file has them, or will soon have them.
    known: Vec<Unsaved>,
    /// The file of the texts could not be written last.
    failed: bool,
    /// The place of the first program, where this one is another.
    waits_for: Option<PathBuf>,
    /// The file in which the texts were kept before the place of the first was taken.
    former: Option<PathBuf>,
    file_writer: FileWriter,
    /// What is not kept and why, in sentences.
    pub(super) troubles: Vec<String>,
    /// Let go by the system, whatever becomes of the program.
    _lock: File,
}

/// The form of the file of texts.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Kept {
    version: u32,
    phaselab: String,
    texts: Vec<Unsaved>,
}

/// The version of that form.
const TEXTS_VERSION: u32 = 1;

/// The most bytes that are read of a session or of texts: more than 30 texts of the greatest length with what they were
/// made from. What is longer was not written by phaselab.
const LONGEST: usize = 64 << 20;

/// So many programs keep texts at the same time.
const PROGRAMS: u32 = 64;

/// Why sessions are not kept, as a sentence for the user.
#[derive(Debug, thiserror::Error)]
pub(super) enum StoreError {
    /// There is no place for it.
    #[error("the session will not be saved: there is no home folder to save it in")]
    NoHome,
    /// The place cannot be written to.
    #[error("the session will not be saved: cannot write {}: {reason}", .path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: io::Error,
    },
    /// Other programs have all places.
    #[error("the session will not be saved: {PROGRAMS} others are running and save their own")]
    Taken,
}

/// Why there is no session to go on with.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// There is no home folder.
    #[error("there is no session to resume: there is no home folder it could be in")]
    NoHome,
    /// There is no file, or it cannot be read.
    #[error("there is no session to resume: cannot read {}: {reason}", .path.display())]
    Unread {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: io::Error,
    },
    /// A newer program wrote it.
    #[error(
        "{} is a session of form {found}, of a newer phaselab; this one reads form {} and older",
        .path.display(), Saved::VERSION
    )]
    Newer {
        /// The file.
        path: PathBuf,
        /// Its version.
        found: i64,
    },
    /// It is no session.
    #[error("{} is no session:\n{reason}", .path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong and where.
        reason: String,
    },
}

/// The session's file, `phaselab/session.toml` where XDG keeps state.
fn place() -> Option<PathBuf> {
    let folder = Xdg::new().ok()?.state_dir()?;
    Some(folder.join("phaselab").join("session.toml"))
}

impl Store {
    /// The usual place.
    pub(super) fn open() -> Result<Self, StoreError> {
        Self::at(place().ok_or(StoreError::NoHome)?)
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

    /// The store of the program that keeps the session.
    fn first(session: &Path, lock: File, file_writer: FileWriter) -> Self {
        let mut troubles = Vec::new();
        let what = "the session will not be saved";
        let readable =
            read_or_put_aside(session, what, &mut troubles, |path| read_from(path).map(|_| ()));
        let texts = session.with_file_name("texts.toml");
        let what = "texts that are left unsaved will not be kept";
        let known = read_or_put_aside(&texts, what, &mut troubles, read_texts);
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
        store.take_up_others(session);
        store
    }

    /// The store of a program that runs beside that.
    fn another(session: PathBuf, texts: PathBuf, lock: File, file_writer: FileWriter) -> Self {
        let told = "the session will not be saved: another phaselab is running and saves its own";
        let mut troubles = vec![told.to_owned()];
        let what = "texts that are left unsaved will not be kept";
        let known = read_or_put_aside(&texts, what, &mut troubles, read_texts);
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

    /// Takes up the texts of other programs that have ended and could not pass them on.
    fn take_up_others(&mut self, session: &Path) {
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
            // theirs goes only once it stands here
            match form(&self.known).and_then(|text| file_writer::write(&texts, &text)) {
                Ok(()) => {
                    // one that stays is taken up once more, which does no harm
                    let _ = fs::remove_file(&theirs);
                }
                Err(why) => self.troubles.push(why.to_string()),
            }
        }
    }

    /// Takes the place of the first program once that has ended; the texts that are to be taken up then.
    pub(super) fn take_over(&mut self) -> Option<Vec<Unsaved>> {
        let session = self.waits_for.as_ref()?;
        let lock = lock(&session.with_extension("lock")).ok().flatten()?;
        let file_writer = FileWriter::new().ok()?;
        let session = self.waits_for.take()?;
        let mut own = std::mem::replace(self, Self::first(&session, lock, file_writer));
        // one that still has something to write goes on
        std::mem::swap(&mut self.file_writer, &mut own.file_writer);
        let found = self.known.clone();
        // what this program kept so far stands in its old file until it stands in the new one
        self.former = own.texts;
        Some(found)
    }

    /// Has a session put in the place of the last one. What goes wrong leaves that as it was.
    pub(super) fn save(&mut self, saved: Saved) {
        let Some(path) = &self.session else { return };
        self.file_writer.write(path, move || toml::to_string(&saved).map_err(io::Error::other));
    }

    /// The texts that were not saved, as they were kept last.
    pub(super) fn texts(&self) -> &[Unsaved] {
        &self.known
    }

    /// The file of the texts; `None` where none are kept.
    pub(super) fn place_of_texts(&self) -> Option<&Path> {
        self.texts.as_deref()
    }

    /// Whether texts are kept, as far as is known.
    pub(super) fn keeps_texts(&self) -> bool {
        self.texts.is_some() && !self.failed
    }

    /// Has these texts kept in the place of those before; whether that was necessary. Where it is the last time, nobody
    /// relies on what was written before.
    pub(super) fn keep_texts(&mut self, texts: Vec<Unsaved>, last: bool) -> bool {
        let changed = texts != self.known || self.failed || self.former.is_some();
        let needed = changed || last && !texts.is_empty();
        let Some(path) = self.texts.as_ref().filter(|_| needed) else { return false };
        self.known.clone_from(&texts);
        if texts.is_empty() {
            self.file_writer.remove(path);
        } else {
            self.file_writer.write(path, move || form(&texts));
        }
        true
    }

    /// There is no time any more to wait for a disk.
    pub(super) fn hurry(&self) {
        self.file_writer.hurry();
    }

    /// What went wrong since this was asked last; each error names its file.
    pub(super) fn errors(&mut self) -> Vec<io::Error> {
        let outcomes = self.file_writer.outcomes();
        self.hear(outcomes)
    }

    /// The same of all that is under way, waited for no longer than that.
    pub(super) fn settle(&mut self, time: Duration) -> Vec<io::Error> {
        let outcomes = self.file_writer.settle(time);
        self.hear(outcomes)
    }

    fn hear(&mut self, outcomes: Vec<(PathBuf, io::Result<()>)>) -> Vec<io::Error> {
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

/// The file of the texts of another program.
fn numbered(session: &Path, number: u32) -> PathBuf {
    session.with_file_name(format!("texts-{number}.toml"))
}

/// A lock, if nobody has it.
fn lock(path: &Path) -> io::Result<Option<File>> {
    let file = regular::open_or_make(path)?;
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Ok(None),
        Err(TryLockError::Error(reason)) => Err(reason),
    }
}

/// A file that must not be written over.
struct Untouchable;

/// What a file holds; nothing where it is not there, or is of no use and was put aside.
fn read_or_put_aside<T>(
    path: &Path,
    what: &str,
    troubles: &mut Vec<String>,
    read: impl FnOnce(&Path) -> Result<T, SessionError>,
) -> Result<Option<T>, Untouchable> {
    let why = match read(path) {
        Ok(found) => return Ok(Some(found)),
        Err(why) if why.is_missing() => return Ok(None),
        Err(why) => why,
    };
    if let SessionError::Malformed { .. } = why
        && let Some(place) = put_aside(path)
    {
        let (was, place) = (path.display(), place.display());
        troubles.push(format!("{was} cannot be understood; it is now {place}"));
        return Ok(None);
    }
    troubles.push(format!("{what}: {}", why.in_short()));
    Err(Untouchable)
}

/// Gives a file a name that nothing has yet; `None` where that cannot be.
fn put_aside(path: &Path) -> Option<PathBuf> {
    let stem = path.file_stem()?.to_str()?;
    let names = (1..=PROGRAMS).map(|n| path.with_file_name(format!("{stem}-damaged-{n}.toml")));
    let place = names.into_iter().find(|place| place.symlink_metadata().is_err())?;
    fs::rename(path, &place).ok().map(|()| place)
}

/// The file of these texts.
fn form(texts: &[Unsaved]) -> io::Result<String> {
    let phaselab = env!("CARGO_PKG_VERSION").to_owned();
    let form = Kept { version: TEXTS_VERSION, phaselab, texts: texts.to_vec() };
    toml::to_string_pretty(&form).map_err(io::Error::other)
}

/// The last session.
pub(super) fn read() -> Result<Saved, SessionError> {
    read_from(&place().ok_or(SessionError::NoHome)?)
}

fn read_from(path: &Path) -> Result<Saved, SessionError> {
    read_form(path, Saved::VERSION)
}

fn read_texts(path: &Path) -> Result<Vec<Unsaved>, SessionError> {
    read_form(path, TEXTS_VERSION).map(|form: Kept| form.texts)
}

fn read_form<T: DeserializeOwned>(path: &Path, version: u32) -> Result<T, SessionError> {
    let unread = |reason| SessionError::Unread { path: path.to_owned(), reason };
    let text = regular::read_text(path, LONGEST).map_err(unread)?;
    // a disk without power leaves zeros, or nothing
    if text.bytes().all(|byte| byte == 0 || byte.is_ascii_whitespace()) {
        let empty = io::Error::new(io::ErrorKind::NotFound, "it is empty");
        return Err(unread(empty));
    }
    // Another form may have other keys, so its number is looked at first.
    let number = text.parse::<toml::Table>().ok().and_then(|t| t.get("version")?.as_integer());
    if let Some(found) = number.filter(|found| *found > i64::from(version)) {
        return Err(SessionError::Newer { path: path.to_owned(), found });
    }
    toml::from_str(&text).map_err(|error| SessionError::Malformed {
        path: path.to_owned(),
        reason: error.to_string(),
    })
}

impl SessionError {
    /// Whether there is nothing at all.
    fn is_missing(&self) -> bool {
        matches!(self, Self::Unread { reason, .. } if reason.kind() == io::ErrorKind::NotFound)
    }

    /// In one line.
    fn in_short(&self) -> String {
        match self {
            Self::NoHome => "there is no home folder".to_owned(),
            Self::Unread { path, reason } => format!("cannot read {}: {reason}", path.display()),
            Self::Newer { path, .. } => {
                format!("{} is of a newer phaselab and stays as it is", path.display())
            }
            Self::Malformed { path, .. } => {
                format!("{} cannot be understood and stays as it is", path.display())
            }
        }
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
            version: Saved::VERSION,
            phaselab: "0.1.0".to_owned(),
            open: "pendulum".to_owned(),
            page: Page::Lab,
            focus: Pane::Plot(1),
            zoomed: true,
            selection: Selection::default(),
            edited: true,
            plots: Vec::new(),
            moment: Checkpoint {
                parameters: vec![g],
                speed: Some(f64::INFINITY),
                ..Checkpoint::default()
            },
        }
    }

    const LONG: Duration = Duration::from_secs(20);

    #[track_caller]
    fn settled(store: &mut Store) {
        let errors = store.settle(LONG);
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
    fn texts_are_kept_to_the_last_character_until_there_are_none() {
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
    fn what_cannot_be_understood_is_put_aside_and_does_not_stop_saving() {
        for strange in ["version = ]\n", "", "\0\0\0\0"] {
            let folder = tempfile::tempdir().expect("a folder");
            let path = folder.path().join("session.toml");
            let texts = path.with_file_name("texts.toml");
            for place in [&path, &texts] {
                fs::write(place, strange).expect("it is written");
            }
            let mut store = Store::at(path.clone()).expect("it is free");
            let empty = !strange.starts_with("version");
            assert_eq!(store.troubles.is_empty(), empty, "{:?}", store.troubles);
            store.save(session());
            store.keep_texts(vec![text("one", "two")], false);
            settled(&mut store);
            assert_eq!(read_from(&path).expect("it is read"), session());
            assert_eq!(read_texts(&texts).expect("they are read"), [text("one", "two")]);
            for aside in ["session-damaged-1.toml", "texts-damaged-1.toml"] {
                let found = fs::read_to_string(folder.path().join(aside)).ok();
                assert_eq!(found.as_deref(), Some(strange).filter(|_| !empty));
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
        assert!(store.troubles.iter().all(|told| told.contains("it is a pipe, not a file")));
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
        // a folder without the right to write would not stop root: a folder stands where the file is to be
        fs::remove_file(&path).expect("it goes");
        fs::create_dir(&path).expect("a folder");
        fs::write(path.join("in the way"), "").expect("it is written");
        store.save(Saved { open: "planet".to_owned(), ..session() });
        let errors = store.settle(LONG);
        let [error] = &errors[..] else { panic!("{errors:?}") };
        let told = error.to_string();
        assert!(told.starts_with("cannot write ") && told.contains("session.toml"), "{told}");
        assert!(path.join("in the way").exists());
    }

    #[test]
    fn what_is_no_session_is_reported_in_its_place() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("session.toml");
        let told = |text: &str| {
            fs::write(&path, text).expect("it is written");
            read_from(&path).expect_err("it is wrong").to_string()
        };
        let newer = told("version = 2\nsomething = \"else\"\n");
        assert!(newer.contains("form 2, of a newer phaselab"), "{newer}");
        let malformed = told("version = 1\npage = \"nowhere\"\n");
        assert!(malformed.contains("is no session:\n"), "{malformed}");
        assert!(told("version = ]\n").contains("line 1"));
        assert!(told(" \n").contains("it is empty"));
        let gone = read_from(&folder.path().join("other.toml")).expect_err("it is not there");
        assert!(gone.to_string().starts_with("there is no session to resume: "), "{gone}");
    }
}
