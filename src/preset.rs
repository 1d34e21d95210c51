//! The preset file: its text in, a checked [`Model`] out, or every mistake in its place.
//!
//! The way: [`Document`] (a file's text, within limits) → `toml` (TOML with spans) → `draft` (as
//! written, nothing looked up) → `check` (names resolved, expressions read) → [`Model`]. Beside it
//! the [`Catalog`] of shipped and own presets, and [`report`], which draws a mistake with a caret
//! under its place. Never here: equations of motion, and whether what a file claims is true.

mod catalog;
mod check;
mod document;
mod draft;
mod mistake;
mod report;
mod rewrite;
mod settings;
mod toml_errors;

use crate::cancel::Cancel;
use crate::model::Model;

pub use catalog::{Catalog, Entry, NotFound, Origin, demo, demos, is_path};
pub use document::Document;
pub use mistake::{Diagnostic, Severity};
pub use report::report;
pub use rewrite::{Beginning, Rewrite};
pub use settings::{Entry as Setting, Plain};

use mistake::Diagnostics;

/// The most bytes a file may have.
pub const TEXT_LIMIT: usize = 1 << 20;

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
        return Err(vec![document::too_long(text.len() as u64)]);
    }
    let mut mistakes = Diagnostics::default();
    let table = toml_errors::parse(text, &mut mistakes);
    if mistakes.lost_track() {
        return mistakes.conclude(None);
    }
    let draft = draft::read(&table, &mut mistakes);
    let model = check::check(text, &draft, cancel, &mut mistakes);
    mistakes.conclude(model)
}
