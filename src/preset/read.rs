//! Reads a preset: its text in, a checked model or all its errors out.

use super::{check, draft, toml_errors};
use crate::cancel::Cancel;
use crate::diagnostic::{Diagnostic, Diagnostics, Document, SourceRange, TEXT_LIMIT, too_long};
use crate::model::Model;

/// A file without errors.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The system it describes.
    pub model: Model,
    /// The warnings: what is allowed but probably unintended.
    pub warnings: Vec<Diagnostic>,
    /// The expressions in the notation of the screen, each with the range of its value and its plain form.
    pub plain: Vec<(SourceRange, String)>,
    /// Whether the text gives no title; that of the model is then the file's name, or [`UNTITLED`].
    untitled: bool,
}

/// The title of a system that gives none and is in no file.
pub const UNTITLED: &str = "untitled";

impl Checked {
    /// A text with its expressions in plain form, and everything else as it was.
    pub fn in_plain_form(&self, text: &str) -> String {
        let mut plain = self.plain.clone();
        plain.sort_by_key(|(place, _)| std::cmp::Reverse(place.start));
        plain.dedup_by(|one, other| one.0 == other.0);
        let mut text = text.to_owned();
        for (place, expression) in plain {
            if text.get(place.clone()).is_some_and(|value| value.starts_with(['"', '\''])) {
                text.replace_range(place, &format!("\"{expression}\""));
            }
        }
        text
    }
}

/// Reads a preset.
///
/// # Errors
/// Returns all diagnostics of the file, warnings included, in the order of their ranges. The list is
/// never empty.
pub fn read(text: &str) -> Result<Checked, Vec<Diagnostic>> {
    read_with(text, &Cancel::new())
}

/// Like [`read`], with a token that cancels this and everything computed from the model.
///
/// # Errors
/// Returns the same errors as [`read`].
pub fn read_with(text: &str, cancel: &Cancel) -> Result<Checked, Vec<Diagnostic>> {
    if text.len() > TEXT_LIMIT {
        return Err(vec![too_long(text.len() as u64)]);
    }
    let mut diagnostics = Diagnostics::default();
    let table = toml_errors::parse(text, &mut diagnostics);
    if diagnostics.lost_track() {
        return conclude(diagnostics, None);
    }
    let draft = draft::read(&table, &diagnostics);
    let model = check::check(text, &draft, cancel, &mut diagnostics);
    conclude(diagnostics, model)
}

/// Returns the model with its warnings, or all diagnostics if one of them is an error.
fn conclude(diagnostics: Diagnostics, model: Option<Model>) -> Result<Checked, Vec<Diagnostic>> {
    match model {
        Some(mut model) if !diagnostics.any_error() => {
            let plain = diagnostics.take_plain();
            let untitled = model.info.title.is_empty();
            if untitled {
                UNTITLED.clone_into(&mut model.info.title);
            }
            Ok(Checked { model, plain, untitled, warnings: diagnostics.into_warnings() })
        }
        _ => Err(diagnostics.into_list()),
    }
}

impl Document {
    /// Reads the preset in this document.
    ///
    /// # Errors
    /// Returns all its errors, see [`read`](read).
    pub fn read(&self) -> Result<Checked, Vec<Diagnostic>> {
        self.read_with(&Cancel::new())
    }

    /// Like [`Document::read`], with a token that cancels this and everything computed from the
    /// model.
    ///
    /// # Errors
    /// Returns all its errors, see [`read`](read).
    pub fn read_with(&self, cancel: &Cancel) -> Result<Checked, Vec<Diagnostic>> {
        match self.unreadable() {
            Some(diagnostic) => Err(vec![diagnostic.clone()]),
            None => {
                let mut checked = read_with(&self.text, cancel)?;
                if let Some(stem) = self.stem().filter(|_| checked.untitled) {
                    stem.clone_into(&mut checked.model.info.title);
                }
                Ok(checked)
            }
        }
    }
}
