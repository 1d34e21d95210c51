//! One preset in the catalog: its listing and access to its text.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::shipped::{self, Listed};
use super::{NotFound, is_path};
use crate::diagnostic::Diagnostics;
use crate::diagnostic::{Diagnostic, Document, Severity};
use crate::model::Info;
use crate::preset::{draft, toml_errors};
use crate::printable;

/// Where a preset comes from.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum PresetOrigin {
    /// Part of the program.
    Shipped,
    /// A file of the user.
    User(PathBuf),
}

/// A preset in the catalog.
#[derive(Clone, Debug)]
pub struct CatalogEntry {
    /// The file's name without `.toml`.
    pub name: String,
    /// Its folder below `presets`; empty at the top level.
    pub folder: String,
    /// Whether it is shipped or the user's.
    pub origin: PresetOrigin,
    /// The title, summary, topics and chapter, without the notes.
    pub info: Info,
    /// The first error of an invalid preset, as `file:line:column: reason`.
    pub diagnostic: Option<String>,
}

impl CatalogEntry {
    /// The path of what a user names, which need not exist; `None` for a shipped preset or an unknown name.
    pub fn place_among(entries: &[CatalogEntry], wanted: &str) -> Option<PathBuf> {
        if is_path(wanted) {
            return Some(PathBuf::from(wanted));
        }
        match &entries.iter().find(|entry| entry.name == wanted)?.origin {
            PresetOrigin::User(path) => Some(path.clone()),
            PresetOrigin::Shipped => None,
        }
    }

    pub(super) fn shipped(listed: &Listed) -> CatalogEntry {
        let path = Path::new(listed.path);
        CatalogEntry {
            name: stem(path),
            folder: folder_of(path),
            origin: PresetOrigin::Shipped,
            info: Info {
                title: listed.title.to_owned(),
                summary: listed.summary.to_owned(),
                source: listed.source.to_owned(),
                chapter: listed.chapter.to_owned(),
                topics: listed.topics.iter().map(|&topic| topic.to_owned()).collect(),
                notes: String::new(),
            },
            diagnostic: None,
        }
    }

    /// An entry for a file in the user's folder. The whole file is read, so that its errors can
    /// be reported.
    pub(super) fn of_user(folder: &Path, path: &Path) -> CatalogEntry {
        let mut entry = CatalogEntry {
            name: stem(path),
            folder: path.strip_prefix(folder).map_or(String::new(), folder_of),
            origin: PresetOrigin::User(path.to_owned()),
            info: Info::default(),
            diagnostic: None,
        };
        match entry.document() {
            Err(unreadable) => entry.diagnostic = Some(unreadable.to_string()),
            Ok(document) => {
                entry.info = head(&document.text);
                if let Err(diagnostics) = document.read() {
                    entry.diagnostic = diagnostics
                        .iter()
                        .find(|m| m.severity == Severity::Error)
                        .map(|m| located(&document, m));
                }
            }
        }
        if entry.info.title.is_empty() {
            entry.info.title.clone_from(&entry.name);
        }
        entry
    }

    /// The first topic, which determines its position in a list.
    pub fn topic(&self) -> &str {
        self.info.topics.first().unwrap_or(&self.folder)
    }

    /// The preset's text.
    ///
    /// # Errors
    /// Returns an error if a user's file cannot be read.
    pub fn document(&self) -> Result<Document, NotFound> {
        match &self.origin {
            PresetOrigin::Shipped => {
                let folder = if self.folder.is_empty() { "" } else { "/" };
                let path = format!("{}{folder}{}.toml", self.folder, self.name);
                let text = shipped::text(&path).unwrap_or_default();
                Ok(Document::new(format!("presets/{path}"), text))
            }
            PresetOrigin::User(path) => {
                Document::open(path).map_err(|reason| NotFound::File { path: path.clone(), reason })
            }
        }
    }
}

/// The head of a file, without the notes.
fn head(text: &str) -> Info {
    let table = toml_errors::parse(text, &mut Diagnostics::default());
    Info { notes: String::new(), ..draft::read_head(&table) }
}

fn located(document: &Document, diagnostic: &Diagnostic) -> String {
    let (line, column) = document.line_and_column(diagnostic.place.start);
    format!("{}:{line}:{column}: {}", document.path, printable::line(&diagnostic.message))
}

fn stem(path: &Path) -> String {
    path.file_stem().map_or(String::new(), |stem| stem.to_string_lossy().into_owned())
}

fn folder_of(path: &Path) -> String {
    let parts = path.parent().into_iter().flat_map(Path::components);
    let parts: Vec<String> =
        parts.map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    parts.join("/")
}

/// Sorts by topic in the order of the notes, with topics without a chapter last; within a topic by
/// chapter, then by title.
pub(super) fn sort(entries: &mut [CatalogEntry]) {
    let mut first: BTreeMap<String, Chapter> = BTreeMap::new();
    for entry in entries.iter() {
        let chapter = Chapter::of(&entry.info.chapter);
        let earliest = first.entry(entry.topic().to_owned()).or_insert_with(|| chapter.clone());
        if chapter < *earliest {
            *earliest = chapter;
        }
    }
    entries.sort_by_cached_key(|entry| {
        let topic = (first.get(entry.topic()).cloned(), entry.topic().to_owned());
        let chapter = Chapter::of(&entry.info.chapter);
        (topic, chapter, entry.info.title.clone(), entry.name.clone())
    });
}

/// The numbers of a chapter such as `2.3.1`; no chapter comes after all others.
#[derive(Clone, PartialEq, Eq)]
struct Chapter(Vec<u32>);

impl Chapter {
    fn of(written: &str) -> Chapter {
        Chapter(written.split('.').map_while(|part| part.trim().parse().ok()).collect())
    }
}

impl Ord for Chapter {
    fn cmp(&self, other: &Chapter) -> Ordering {
        self.0.is_empty().cmp(&other.0.is_empty()).then_with(|| self.0.cmp(&other.0))
    }
}

impl PartialOrd for Chapter {
    fn partial_cmp(&self, other: &Chapter) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
