//! The preset file: its text in, a checked [`Model`] out, or every mistake in its place.
//!
//! The way: [`Document`](crate::diagnostic::Document) (a file's text, within limits) → `toml` (TOML with spans) → `draft` (as
//! written, nothing looked up) → `check` (names resolved, expressions read) → [`Model`]. Beside it
//! the [`Catalog`] of shipped and own presets. Never here: equations of motion, and whether what a file claims is true.

mod catalog;
mod check;
mod draft;
mod read;
mod rewrite;
mod schema;
mod settings;
mod toml_errors;

pub use catalog::{Catalog, Entry, NotFound, Origin, demo, demos, is_path};
pub use read::{Checked, read, read_with};
pub use rewrite::{Beginning, Rewrite};
pub use schema::reference;
pub use settings::{Entry as Setting, Plain};
