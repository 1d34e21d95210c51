//! `phaselab list`: the presets by topic.

use std::io::Write;

use clap::ValueEnum;
use serde_json::{Value, json};

use super::failure::Failure;
use super::output::Output;
use crate::preset::{Catalog, Entry, Origin};

/// List the presets by topic.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// How the list is written.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum Format {
    /// For reading.
    #[default]
    Text,
    /// One object, `{"presets": [...]}`.
    Json,
}

pub(super) fn perform(arguments: &Arguments) -> Result<(), Failure> {
    let catalog = Catalog::load();
    let text = match arguments.format {
        Format::Text => text(catalog.entries()),
        Format::Json => {
            let presets: Vec<Value> = catalog.entries().iter().map(object).collect();
            format!("{:#}\n", json!({ "presets": presets }))
        }
    };
    let mut out = Output::open(None)?;
    out.write_all(text.as_bytes()).map_err(|error| out.failed(&error))?;
    out.finish()
}

fn text(entries: &[Entry]) -> String {
    let width = entries.iter().map(|entry| entry.name.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    let mut topic = None;
    for entry in entries {
        if topic != Some(entry.topic()) {
            let gap = if topic.is_some() { "\n" } else { "" };
            let title = if entry.topic().is_empty() { "others" } else { entry.topic() };
            text.push_str(&format!("{gap}{title}\n"));
            topic = Some(entry.topic());
        }
        let about = match &entry.fault {
            Some(fault) => format!("cannot be used: {fault}"),
            None if entry.info.summary.is_empty() => entry.info.title.clone(),
            None => entry.info.summary.clone(),
        };
        let own = if matches!(entry.origin, Origin::User(_)) { " (your own)" } else { "" };
        text.push_str(&format!("  {:width$}  {about}{own}\n", entry.name));
    }
    text
}

fn object(entry: &Entry) -> Value {
    let path = match &entry.origin {
        Origin::Shipped => None,
        Origin::User(path) => Some(path.display().to_string()),
    };
    json!({
        "name": entry.name,
        "title": entry.info.title,
        "summary": entry.info.summary,
        "topics": entry.info.topics,
        "source": entry.info.source,
        "chapter": entry.info.chapter,
        "file": path,
        "mistake": entry.fault,
    })
}
