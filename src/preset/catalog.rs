//! The catalog: the presets that are part of the program and the user's own, which take precedence over shipped ones
//! of the same name.
//!
//! In: the folder `presets/` at build time, and the user's folder. Out: the entries, and the [`Document`] behind a
//! name or path. An invalid user file is listed with its error. Never here: whether a shipped preset is correct,
//! which the tests ensure.

mod entry;
mod folder;
mod shipped;

use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};

use etcetera::BaseStrategy;
use etcetera::base_strategy::Xdg;

use crate::diagnostic::Document;
use crate::diagnostic::nearest;
use crate::printable;

pub use entry::{CatalogEntry, PresetOrigin};

/// All available presets.
#[derive(Clone, Debug)]
pub struct Catalog {
    entries: Vec<CatalogEntry>,
    cut: bool,
}

/// Why no document was found.
#[derive(Debug, thiserror::Error)]
pub enum NotFound {
    /// No preset of that name.
    #[error("unknown preset `{}`{}", printable::quoted(.name), meant(.file.as_deref(), .near.as_deref()))]
    Name {
        /// The requested name.
        name: String,
        /// The nearest existing name.
        near: Option<String>,
        /// The file of that name in the working folder, if there is one.
        file: Option<String>,
    },
    /// The file cannot be read.
    #[error("cannot read {}: {}", printable::path(.path), printable::why(.reason))]
    File {
        /// The file.
        path: PathBuf,
        /// The system's error.
        reason: io::Error,
    },
}

/// What may have been meant by a name that no preset has.
fn meant(file: Option<&str>, near: Option<&str>) -> String {
    match (file, near) {
        (Some(file), _) => format!("; did you mean the file `{}`?", printable::quoted(file)),
        (None, Some(near)) => format!("; did you mean `{}`?", printable::line(near)),
        (None, None) => "; `phaselab list` lists the presets".to_owned(),
    }
}

/// `./x.toml` for the name `x`, if there is such a file: `phaselab new x` writes it.
pub fn file_here(name: &str) -> Option<String> {
    let file = format!("./{name}.toml");
    Path::new(&file).is_file().then_some(file)
}

impl Catalog {
    /// Loads the shipped presets and those in the user's folder.
    pub fn load() -> Catalog {
        Catalog::with_folder(Catalog::user_folder().as_deref())
    }

    /// The user's folder: `phaselab/presets` in the XDG configuration folder, or `None` without a home.
    pub fn user_folder() -> Option<PathBuf> {
        Xdg::new().ok().map(|xdg| xdg.config_dir().join("phaselab").join("presets"))
    }

    /// Loads the shipped presets and those in a folder and its subfolders, if it exists.
    pub fn with_folder(user: Option<&Path>) -> Catalog {
        let mut entries = Vec::new();
        let mut cut = false;
        if let Some(folder) = user {
            let found = folder::presets(folder);
            cut = found.cut;
            entries.extend(found.files.iter().map(|path| CatalogEntry::of_user(folder, path)));
        }
        let own: Vec<String> = entries.iter().map(|entry| entry.name.clone()).collect();
        let shipped = shipped::INDEX.iter().map(CatalogEntry::shipped);
        entries.extend(shipped.filter(|entry| !own.contains(&entry.name)));
        entry::sort(&mut entries);
        Catalog { entries, cut }
    }

    /// Whether the user's folder exceeds the limits: thousands of files, or links and folders nested too deeply.
    pub fn is_cut(&self) -> bool {
        self.cut
    }

    /// The presets, by topic in the order of the notes, and by chapter within a topic.
    pub fn entries(&self) -> &[CatalogEntry] {
        &self.entries
    }

    /// The path of what a user names, which need not exist; `None` for a shipped preset or an unknown name.
    pub fn place(&self, wanted: &str) -> Option<PathBuf> {
        CatalogEntry::place_among(&self.entries, wanted)
    }

    /// Returns the name of the preset with this title, in capitals or not.
    pub fn titled(&self, title: &str) -> Option<&str> {
        let folded = title.to_lowercase();
        let titled = self.entries.iter().find(|entry| entry.info.title.to_lowercase() == folded);
        titled.map(|entry| entry.name.as_str())
    }

    /// Returns the name of the preset that was meant by one that none has: with this title, or with a name or a title close
    /// to it, or the first with the word in either, or in its summary.
    pub fn nearest(&self, wanted: &str) -> Option<&str> {
        let names = self.entries.iter().map(|entry| entry.name.as_str());
        let titles = self.entries.iter().map(|entry| entry.info.title.as_str());
        let folded = wanted.to_lowercase();
        let holds = |text: &str| {
            let text = text.to_lowercase();
            text.split(|c: char| !c.is_alphanumeric()).any(|word| word == folded)
        };
        let candidates = || self.entries.iter().filter(|_| folded.chars().count() >= LEAST_LETTERS);
        let with_word = || {
            candidates()
                .find(|entry| holds(&entry.name) || holds(&entry.info.title))
                .or_else(|| candidates().find(|entry| holds(&entry.info.summary)))
        };
        self.titled(wanted)
            .or_else(|| nearest(wanted, names))
            .or_else(|| nearest(wanted, titles).and_then(|title| self.titled(title)))
            .or_else(|| with_word().map(|entry| entry.name.as_str()))
    }

    /// Finds the document that a user names: a path if the name contains a `/` or ends in `.toml`, otherwise a
    /// preset.
    ///
    /// # Errors
    /// Returns an error with the nearest name if there is none.
    pub fn find(&self, wanted: impl AsRef<OsStr>) -> Result<Document, NotFound> {
        let wanted = wanted.as_ref();
        if is_path(wanted) {
            return open(Path::new(wanted));
        }
        match self.entries.iter().find(|entry| wanted == entry.name.as_str()) {
            Some(entry) => entry.document(),
            None => {
                let name = printable::os(wanted);
                let near = self.nearest(&name).map(str::to_owned);
                let file = file_here(&name);
                Err(NotFound::Name { name, near, file })
            }
        }
    }
}

/// What is searched for among the words of names, titles and summaries has at least this many letters.
const LEAST_LETTERS: usize = 3;

/// Finds the document that a user names, as [`Catalog::find`] does, without reading any other.
///
/// # Errors
/// Returns an error with the nearest name if there is none.
pub fn find(wanted: impl AsRef<OsStr>) -> Result<Document, NotFound> {
    find_beside(Catalog::user_folder().as_deref(), wanted.as_ref())
}

/// The same with another folder for the user's presets.
///
/// # Errors
/// Returns the errors of [`find`].
pub fn find_beside(user: Option<&Path>, wanted: &OsStr) -> Result<Document, NotFound> {
    if is_path(wanted) {
        return open(Path::new(wanted));
    }
    let own = user.map(folder::presets).unwrap_or_default().files;
    let own: Vec<&PathBuf> = own.iter().filter(|path| path.file_stem() == Some(wanted)).collect();
    let shipped = shipped::INDEX
        .iter()
        .map(CatalogEntry::shipped)
        .find(|entry| wanted == entry.name.as_str());
    match (own.as_slice(), shipped) {
        ([path], _) => open(path),
        ([], Some(entry)) => entry.document(),
        // several files of one name, of which the list decides, or none
        _ => Catalog::with_folder(user).find(wanted),
    }
}

fn open(path: &Path) -> Result<Document, NotFound> {
    Document::open(path).map_err(|reason| NotFound::File { path: path.to_owned(), reason })
}

/// The shipped demo of a preset, `presets/demos/<preset>.demo`: a script for the `record` module.
pub fn demo(preset: &str) -> Option<Document> {
    let path = format!("demos/{preset}.demo");
    let text = shipped::text(&path)?;
    Some(Document::new(format!("presets/{path}"), text))
}

/// The presets that have a shipped demo, by name.
pub fn demos() -> Vec<&'static str> {
    let mut names: Vec<&str> = shipped::names_in("demos").collect();
    names.sort_unstable();
    names
}

/// The shipped lesson of a name, `presets/lessons/<name>.lesson`: a script for the `record` module.
pub fn lesson(name: &str) -> Option<Document> {
    let path = format!("lessons/{name}.lesson");
    let text = shipped::text(&path)?;
    Some(Document::new(format!("presets/{path}"), text))
}

/// The lessons in the order in which they are best taken; any other follows by its name.
const LESSONS: [&str; 9] = [
    "tour",
    "kepler",
    "symmetries",
    "t-handle",
    "leaving-the-sphere",
    "rolling-race",
    "heavy-top",
    "rolling-disc",
    "third-law",
];

/// The shipped lessons, by name.
pub fn lessons() -> Vec<&'static str> {
    let mut names: Vec<&str> = shipped::names_in("lessons").collect();
    let place = |name: &&str| LESSONS.iter().position(|known| known == name);
    names.sort_unstable_by_key(|name| (place(name).unwrap_or(LESSONS.len()), *name));
    names
}

/// Whether a name is a file's path.
pub fn is_path(wanted: impl AsRef<OsStr>) -> bool {
    let wanted = wanted.as_ref();
    let ends = Path::new(wanted).extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    wanted.as_encoded_bytes().iter().any(|&byte| std::path::is_separator(byte.into())) || ends
}

fn is_preset(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "toml")
}
