//! Reads a preset: its text in, a checked model or all its mistakes out.

use super::{check, draft, toml_errors};
use crate::cancel::Cancel;
use crate::diagnostic::{Diagnostic, Diagnostics, Document, TEXT_LIMIT, too_long};
use crate::model::Model;

/// A file without errors.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The system it describes.
    pub model: Model,
    /// The warnings: what is allowed but probably unintended.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a preset.
///
/// # Errors
/// Returns all mistakes of the file, warnings included, in the order of their ranges. The list is
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
    let mut mistakes = Diagnostics::default();
    let table = toml_errors::parse(text, &mut mistakes);
    if mistakes.lost_track() {
        return conclude(mistakes, None);
    }
    let draft = draft::read(&table, &mut mistakes);
    let model = check::check(text, &draft, cancel, &mut mistakes);
    conclude(mistakes, model)
}

/// Returns the model with its warnings, or all mistakes if one of them is an error.
fn conclude(mistakes: Diagnostics, model: Option<Model>) -> Result<Checked, Vec<Diagnostic>> {
    match model {
        Some(model) if !mistakes.any_error() => {
            Ok(Checked { model, warnings: mistakes.into_warnings() })
        }
        _ => Err(mistakes.into_list()),
    }
}

impl Document {
    /// Reads the preset in this document.
    ///
    /// # Errors
    /// Returns all its mistakes, see [`read`](read).
    pub fn read(&self) -> Result<Checked, Vec<Diagnostic>> {
        self.read_with(&Cancel::new())
    }

    /// Like [`Document::read`], with a token that cancels this and everything computed from the
    /// model.
    ///
    /// # Errors
    /// Returns all its mistakes, see [`read`](read).
    pub fn read_with(&self, cancel: &Cancel) -> Result<Checked, Vec<Diagnostic>> {
        match self.unreadable() {
            Some(mistake) => Err(vec![mistake.clone()]),
            None => read_with(&self.text, cancel),
        }
    }
}
