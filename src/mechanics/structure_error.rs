//! A false statement in a file about its brackets or its body, discovered from its consequences.
//!
//! In: a place and a message. Out: a [`StructureError`]. Never here: the checks themselves.

use crate::diagnostic::{Diagnostic, SourceRange};

/// A false statement in a file about its brackets or its body.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct StructureError {
    /// Its place in the file; `None` for what an option has added.
    pub place: Option<SourceRange>,
    /// What is false.
    pub message: String,
    /// The correct value.
    pub help: String,
}

impl StructureError {
    /// The error at its place in the file, if it has one.
    pub fn diagnostic(self) -> Option<Diagnostic> {
        let StructureError { place, message, help } = self;
        Some(Diagnostic::error(place?, message).with_help(help))
    }
}
