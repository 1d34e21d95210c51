//! The configuration: a file of the user's with default options for the laboratory.
//!
//! In: `phaselab/config.toml` in the XDG configuration folder, if it exists. Out: [`Words`], or every error with
//! its position. Never here: what an option does.

use std::fmt::Write as _;
use std::io;
use std::path::PathBuf;

use etcetera::BaseStrategy;
use etcetera::base_strategy::Xdg;

use super::options::{OptionRow, Words, rows};
use crate::diagnostic::{Diagnostic, Document};
use crate::preset::{PlainValue, Setting};

/// Returns the path of the configuration, whether or not the file exists. Returns `None` if there is no home
/// folder.
pub fn path() -> Option<PathBuf> {
    Xdg::new().ok().map(|xdg| xdg.config_dir().join("phaselab").join("config.toml"))
}

/// Reads the configuration file if it exists.
///
/// # Errors
/// Returns an error if the file exists but cannot be read.
pub fn find() -> io::Result<Option<Document>> {
    let Some(path) = path() else { return Ok(None) };
    match Document::open_regular(&path) {
        Ok(document) => Ok(Some(document)),
        Err(error) => match error.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => Ok(None),
            _ => Err(error),
        },
    }
}

/// Parses a configuration.
///
/// # Errors
/// Returns all its errors, ordered by position.
pub fn read(document: &Document) -> Result<Words, Vec<Diagnostic>> {
    let mut words = Words::new();
    let names: Vec<&str> = rows().iter().map(|row| row.name.as_str()).collect();
    let (entries, mut diagnostics) = document.settings("the configuration", &names);
    for entry in entries {
        let Some(row) = rows().iter().find(|row| row.name == entry.key) else { continue };
        match word(row, &entry) {
            Ok(word) => words.push((entry.key, word)),
            Err(diagnostic) => diagnostics.push(diagnostic),
        }
    }
    diagnostics.sort_by_key(|diagnostic| diagnostic.place.start);
    if diagnostics.is_empty() { Ok(words) } else { Err(diagnostics) }
}

/// Returns the value as a word that the option accepts.
fn word(row: &OptionRow, entry: &Setting) -> Result<String, Diagnostic> {
    let at = |message: String| Diagnostic::error(entry.place.clone(), message);
    // `color = 256` and `color = true` are accepted too.
    let word = match &entry.value {
        PlainValue::Flag(flag) => flag.to_string(),
        PlainValue::Number(number) => number.clone(),
        PlainValue::Text(text) if row.is_switch => {
            let diagnostic = at(format!("`{}` must be true or false, not a text", row.name));
            let quoted = ["true", "false"].contains(&text.as_str());
            return Err(if quoted {
                diagnostic.with_help("remove the quotes")
            } else {
                diagnostic
            });
        }
        PlainValue::Text(text) => text.clone(),
        PlainValue::Other(kind) => {
            let wanted = if row.is_switch { "true or false" } else { "a word" };
            return Err(at(format!("`{}` must be {wanted}, not {kind}", row.name)));
        }
    };
    row.accept(&word).map(|()| word).map_err(|wrong| {
        let diagnostic = at(wrong.message);
        match wrong.help {
            Some(help) => diagnostic.with_help(help),
            None => diagnostic,
        }
    })
}

/// Returns a configuration with the default values and a comment on each key.
pub fn default_text() -> String {
    let mut text = "\
# The configuration of phaselab: what the laboratory opens with.
# `phaselab config path` prints where it belongs. An option on the command line
# wins over a variable of the environment (PHASELAB_FPS), and that over a key
# here. Each key below has the value it has without this file.
"
    .to_owned();
    for row in rows() {
        let _ = writeln!(text, "\n# {}", row.about);
        let width = row.words.iter().map(|(word, _)| word.len()).max().unwrap_or(0);
        for (word, about) in row.words.iter().filter(|_| !row.is_switch) {
            let _ = writeln!(text, "#   {word:width$}  {about}");
        }
        if !row.shape.is_empty() {
            let _ = writeln!(text, "#   {}", row.shape);
        }
        let quote = if row.is_switch { "" } else { "\"" };
        let _ = writeln!(text, "{} = {quote}{}{quote}", row.name, row.usual);
    }
    text
}
