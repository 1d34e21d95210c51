//! A false statement in a file about its brackets or its body, discovered from its consequences.
//!
//! In: a place and a message. Out: a [`StructureError`]. Never here: the checks themselves.

use crate::diagnostic::SourceRange;

/// A false statement in a file about its brackets or its body.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct StructureError {
    /// Its place in the file.
    pub place: SourceRange,
    /// What is false.
    pub message: String,
    /// The correct value.
    pub help: String,
}
