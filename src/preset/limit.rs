//! How long a file may be.
//!
//! In: a number of bytes. Out: the refusal. Never here: files.

use crate::diagnostic::Diagnostic;

/// The most bytes a file may have.
pub const TEXT_LIMIT: usize = 1 << 20;

/// The refusal of a file beyond the limit.
pub(super) fn too_long(bytes: u64) -> Diagnostic {
    let message = format!("the file has {bytes} bytes; a preset may have {TEXT_LIMIT} (1 MiB)");
    Diagnostic::error(0..0, message)
}
