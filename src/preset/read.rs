//! A file's text read and checked.
//!
//! In: text. Out: [`Checked`], or every mistake in it. Never here: files.

use super::check;
use super::draft;
use super::limit::{TEXT_LIMIT, too_long};
use super::toml_errors;
use crate::cancel::Cancel;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::Model;

/// A file without a mistake.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The system it describes.
    pub model: Model,
    /// What is allowed but probably not meant.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a preset.
///
/// # Errors
/// All mistakes of the file (warnings among them), in the order of their places; never empty.
pub fn read(text: &str) -> Result<Checked, Vec<Diagnostic>> {
    read_with(text, &Cancel::new())
}

/// The same, with a token by which this and all that is made of the model can be stopped.
///
/// # Errors
/// Those of [`read`].
pub fn read_with(text: &str, cancel: &Cancel) -> Result<Checked, Vec<Diagnostic>> {
    if text.len() > TEXT_LIMIT {
        return Err(vec![too_long(text.len() as u64)]);
    }
    let mut mistakes = Diagnostics::default();
    let table = toml_errors::parse(text, &mut mistakes);
    if mistakes.lost_track() {
        return Err(mistakes.into_list());
    }
    let draft = draft::read(&table, &mut mistakes);
    let model = check::check(text, &draft, cancel, &mut mistakes);
    match model {
        Some(model) if !mistakes.any_error() => {
            Ok(Checked { model, warnings: mistakes.warnings() })
        }
        _ => Err(mistakes.into_list()),
    }
}
