//! What is wrong with a text, and where: documents, diagnostics in their places, the nearest right word.
//!
//! In: the text of a file, and what a reader finds wrong in it. Out: a [`report()`] with file, line, column, a caret under
//! the place, the reason, and what would be right. Used by presets, scripts, configuration and casts. Never here: what any
//! text means.

mod document;
mod list;
mod nearest;
mod report;

pub use document::{Document, TEXT_LIMIT, too_long};
pub use list::{Diagnostic, Diagnostics, Severity, SourceRange};
pub use nearest::nearest;
pub use report::report;
