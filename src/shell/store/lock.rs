//! The locks by which programs that run at the same time share a folder.
//!
//! In: the file of a lock. Out: the lock, unless another program has it. Never here: waiting for it.

use std::fs::{File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use super::super::regular;

/// Returns the file of texts of another program.
pub(super) fn numbered(session: &Path, number: u32) -> PathBuf {
    session.with_file_name(format!("texts-{number}.toml"))
}

/// Takes a lock, unless another program has it.
pub(super) fn lock(path: &Path) -> io::Result<Option<File>> {
    let file = regular::open_or_make(path)?;
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Ok(None),
        Err(TryLockError::Error(reason)) => Err(reason),
    }
}
