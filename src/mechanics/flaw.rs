//! Something false in what a file says of its brackets or its body, found by what follows from it.
//!
//! In: a place and words. Out: a [`StructureError`]. Never here: what is looked for.

use crate::diagnostic::SourceRange;

/// Something false in what a file says of its brackets or its body.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct StructureError {
    /// Where it stands in the file.
    pub place: SourceRange,
    /// What is false.
    pub message: String,
    /// What it is instead.
    pub help: String,
}
