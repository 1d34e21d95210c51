//! The catalog: the presets that are part of the program and the user's own, which take precedence over shipped ones
//! of the same name.
//!
//! In: the folder `presets/` at build time, and the user's folder. Out: the entries, and the [`Document`] behind a
//! name or path. An invalid user file is listed with its mistake. Never here: whether a shipped preset is correct,
//! which the tests ensure.

mod entry;
mod folder;

use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};

use etcetera::BaseStrategy;
use etcetera::base_strategy::Xdg;
use include_dir::{Dir, DirEntry, include_dir};

use crate::diagnostic::Document;
use crate::diagnostic::nearest;
use crate::printable;

pub use entry::{Entry, Origin};

static SHIPPED: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/presets");

/// All available presets.
#[derive(Clone, Debug)]
pub struct Catalog {
    entries: Vec<Entry>,
    cut: bool,
}

/// Why no document was found.
#[derive(Debug, thiserror::Error)]
pub enum NotFound {
    /// No preset of that name.
    #[error("there is no preset `{}`{}", printable::quoted(.name), .near.as_ref().map_or(String::new(), |n| format!("; did you mean `{}`?", printable::line(n))))]
    Name {
        /// The requested name.
        name: String,
        /// The nearest existing name.
        near: Option<String>,
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
            entries.extend(found.files.iter().map(|path| Entry::of_user(folder, path)));
        }
        let own: Vec<String> = entries.iter().map(|entry| entry.name.clone()).collect();
        let shipped = shipped(&SHIPPED).into_iter().map(|(path, text)| Entry::shipped(path, text));
        entries.extend(shipped.filter(|entry| !own.contains(&entry.name)));
        entry::sort(&mut entries);
        Catalog { entries, cut }
    }

    /// Whether the user's folder exceeds the limits: thousands of files, or links and folders nested too deeply.
    pub fn is_cut(&self) -> bool {
        self.cut
    }

    /// The presets, by topic in the order of the notes, and by chapter within a topic.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The path of what a user names, which need not exist; `None` for a shipped preset or an unknown name.
    pub fn place(&self, wanted: &str) -> Option<PathBuf> {
        if is_path(wanted) {
            return Some(PathBuf::from(wanted));
        }
        let entry = self.entries.iter().find(|entry| entry.name == wanted)?;
        match &entry.origin {
            Origin::User(path) => Some(path.clone()),
            Origin::Shipped => None,
        }
    }

    /// Finds the document that a user names: a path if the name contains a `/` or ends in `.toml`, otherwise a
    /// preset.
    ///
    /// # Errors
    /// Returns an error with the nearest name if there is none.
    pub fn find(&self, wanted: impl AsRef<OsStr>) -> Result<Document, NotFound> {
        let wanted = wanted.as_ref();
        if is_path(wanted) {
            let path = Path::new(wanted);
            return Document::open(path)
                .map_err(|reason| NotFound::File { path: path.to_owned(), reason });
        }
        match self.entries.iter().find(|entry| wanted == entry.name.as_str()) {
            Some(entry) => entry.document(),
            None => {
                let name = printable::os(wanted);
                let names = self.entries.iter().map(|entry| entry.name.as_str());
                let near = nearest(&name, names).map(str::to_owned);
                Err(NotFound::Name { name, near })
            }
        }
    }
}

/// The shipped demo of a preset, `presets/demos/<preset>.demo`: a script for the `record` module.
pub fn demo(preset: &str) -> Option<Document> {
    let path = format!("demos/{preset}.demo");
    let text = SHIPPED.get_file(&path)?.contents_utf8()?;
    Some(Document::new(format!("presets/{path}"), text))
}

/// The presets that have a shipped demo, by name.
pub fn demos() -> Vec<&'static str> {
    let folder = SHIPPED.get_dir("demos").map(Dir::files).into_iter().flatten();
    let mut names: Vec<&str> =
        folder.filter_map(|file| file.path().file_stem()?.to_str()).collect();
    names.sort_unstable();
    names
}

/// Whether a name is a file's path.
pub fn is_path(wanted: impl AsRef<OsStr>) -> bool {
    let wanted = wanted.as_ref();
    let ends = Path::new(wanted).extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    wanted.as_encoded_bytes().iter().any(|&byte| std::path::is_separator(byte.into())) || ends
}

/// The files of the embedded folder, with paths relative to `presets/`.
fn shipped(folder: &Dir<'static>) -> Vec<(&'static Path, &'static str)> {
    let mut all = Vec::new();
    for entry in folder.entries() {
        match entry {
            DirEntry::Dir(folder) => all.extend(shipped(folder)),
            DirEntry::File(file) => {
                let text = file.contents_utf8().filter(|_| is_preset(file.path()));
                all.extend(text.map(|text| (file.path(), text)));
            }
        }
    }
    all
}

fn is_preset(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "toml")
}
