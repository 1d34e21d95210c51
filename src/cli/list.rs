//! `phaselab list`: the presets by the chapters of the notes, and by topic within a chapter.

use clap::ValueEnum;
use serde_json::{Value, json};

use super::error::CommandError;
use super::output::{Output, OutputForm};
use super::stderr;
use crate::preset::{Catalog, CatalogEntry, PresetOrigin};
use crate::printable;

/// List the presets by chapter and topic.
///
/// Your own, in `phaselab/presets` of your configuration folder, are among them; one that cannot be
/// used is listed with its error.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab list                          chapters, topics, names and what they show
  phaselab list --format names           names alone, one a line
  phaselab list --format json            one object, {\"presets\": [...]}")]
pub(super) struct Arguments {
    /// How the list is written.
    #[arg(long, value_enum, default_value_t)]
    format: ListFormat,
}

#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum ListFormat {
    /// For reading.
    #[default]
    Text,
    /// One object, `{"presets": [...]}`.
    Json,
    /// Names alone, one a line, for scripts and shells.
    Names,
}

impl ListFormat {
    fn form(self) -> OutputForm {
        match self {
            ListFormat::Text | ListFormat::Names => OutputForm::Text,
            ListFormat::Json => OutputForm::Json,
        }
    }
}

pub(super) fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let catalog = Catalog::load();
    if catalog.is_cut() {
        let folder =
            Catalog::user_folder().map_or(String::new(), |folder| printable::path(&folder));
        stderr::report(&format!("{folder} holds too many files; not all of them are listed"));
    }
    let text = match arguments.format {
        ListFormat::Text => text(catalog.entries()),
        ListFormat::Names => {
            let names: Vec<&str> = catalog.entries().iter().map(|e| e.name.as_str()).collect();
            let names: Vec<_> = names.into_iter().map(printable::line).collect();
            names.join("\n") + "\n"
        }
        ListFormat::Json => {
            let presets: Vec<Value> = catalog.entries().iter().map(object).collect();
            format!("{:#}\n", json!({ "presets": presets }))
        }
    };
    Output::print(arguments.format.form(), &text)
}

/// The titles of the chapters of *The Principles of Dynamics*, beginning with the introduction.
const CHAPTERS: [&str; 5] = [
    "Introduction",
    "Chapter 1: from Newton to Lagrange",
    "Chapter 2: rotating frames and rigid bodies",
    "Chapter 3: Hamilton's equations",
    "Chapter 4: action variables and adiabatic invariants",
];

/// The heading of a preset, and its position among the headings.
fn heading(entry: &CatalogEntry) -> (usize, &'static str) {
    let number = entry.info.chapter.split('.').next().and_then(|first| first.parse().ok());
    match number.and_then(|n: usize| Some((n, *CHAPTERS.get(n)?))) {
        Some(chapter) => chapter,
        None => (CHAPTERS.len(), "Further systems"),
    }
}

fn text(entries: &[CatalogEntry]) -> String {
    let longest = |of: fn(&CatalogEntry) -> &str| {
        entries.iter().map(|entry| printable::line(of(entry)).chars().count()).max().unwrap_or(0)
    };
    let section = longest(|entry| &entry.info.chapter);
    let width = longest(|entry| &entry.name);
    let mut ordered: Vec<&CatalogEntry> = entries.iter().collect();
    ordered.sort_by_key(|entry| heading(entry).0);
    let mut text = String::new();
    let mut above = None;
    for entry in ordered {
        let (chapter, title) = heading(entry);
        if above.is_none_or(|(number, _)| number != chapter) {
            let gap = if above.is_some() { "\n" } else { "" };
            text.push_str(&format!("{gap}{title}\n"));
        }
        if above != Some((chapter, entry.topic())) {
            let topic = if entry.topic().is_empty() { "others" } else { entry.topic() };
            text.push_str(&format!("\n  {}\n", printable::line(topic)));
            above = Some((chapter, entry.topic()));
        }
        let about = match &entry.diagnostic {
            Some(diagnostic) => format!("cannot be used: {diagnostic}"),
            None if entry.info.summary.is_empty() => entry.info.title.clone(),
            None => entry.info.summary.clone(),
        };
        let own = if matches!(entry.origin, PresetOrigin::User(_)) { " (your own)" } else { "" };
        let [place, name, about] =
            [&entry.info.chapter, &entry.name, &about].map(|text| printable::line(text));
        text.push_str(&format!("    {place:section$}  {name:width$}  {about}{own}\n"));
    }
    text
}

fn object(entry: &CatalogEntry) -> Value {
    let path = match &entry.origin {
        PresetOrigin::Shipped => None,
        PresetOrigin::User(path) => Some(path.display().to_string()),
    };
    json!({
        "name": entry.name,
        "title": entry.info.title,
        "summary": entry.info.summary,
        "topics": entry.info.topics,
        "source": entry.info.source,
        "chapter": entry.info.chapter,
        "file": path,
        "mistake": entry.diagnostic,
    })
}
