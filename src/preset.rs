//! The preset file.
//!
//! In: its text. Out: a checked [`Model`](crate::model::Model), or every error with its range. The stages: [`Document`](crate::diagnostic::Document) (a file's text, within limits) → `toml` (TOML with spans) →
//! `draft` (as written, with names unresolved) → `check` (names resolved, expressions parsed) → [`Model`](crate::model::Model). There is
//! also the [`Catalog`] of shipped and user presets. Never here: equations of motion, and whether what a file claims
//! is true.

mod catalog;
mod check;
mod draft;
mod law_digest;
mod new_surface;
mod number_help;
mod read;
mod rewrite;
mod schema;
mod settings;
mod template;
mod toml_errors;

pub use catalog::{
    Catalog, CatalogEntry, NotFound, PresetOrigin, demo, demos, file_here, find, find_beside,
    is_path, lesson, lessons,
};
pub use law_digest::law_digest;
pub use new_surface::{NewSurface, NewZero, SurfaceView};
pub use read::{Checked, UNTITLED, read, read_with};
pub use rewrite::{InitialValue, NewObservable, NewRamp, Rewrite};
pub use schema::reference;
pub use settings::{PlainValue, Setting};
pub use template::template;
