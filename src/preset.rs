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
mod limit;
mod mistake;
mod read;
mod report;
mod rewrite;
mod settings;
mod toml_errors;

pub use catalog::{Catalog, Entry, NotFound, Origin, demo, demos, is_path};
pub use document::Document;
pub use limit::TEXT_LIMIT;
pub use mistake::{Diagnostic, Severity};
pub use read::{Checked, read, read_with};
pub use report::report;
pub use rewrite::{Beginning, Rewrite};
pub use settings::{Entry as Setting, Plain};
