//! What is wrong with a text, and where: documents, diagnostics with their places, suggestions for
//! misspelt words.
//!
//! In: the text of a file, and the errors a reader finds in it. Out: a [`report()`] with file,
//! line, column, a caret under the place, the reason, and a correction. Presets, scripts,
//! configuration and casts use it. Never here: what any text means.

mod document;
mod list;
mod nearest;
mod report;

pub use document::{Document, TEXT_LIMIT, too_long};
pub use list::{Diagnostic, Diagnostics, Severity, SourceRange};
pub use nearest::{nearest, with_index};
pub use report::report;
