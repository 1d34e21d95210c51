//! The text of one file, from the binary or from disk, read within limits and stored with the name
//! used in reports. Never here: what the text means.

use std::io;
use std::path::Path;

use super::{Diagnostic, report};
use crate::{file, printable};

/// The largest size of a file, in bytes.
pub const TEXT_LIMIT: usize = 1 << 20;

/// A text with the name of its file.
#[derive(Clone, Debug)]
pub struct Document {
    /// The name used in reports: the escaped path of a file, or `presets/…` for a shipped one.
    pub path: String,
    /// The text, with invalid UTF-8 replaced by `�`.
    pub text: String,
    /// An error that prevents the text from being read at all.
    unreadable: Option<Diagnostic>,
}

impl Document {
    /// Creates a document from text in memory.
    pub fn new(path: impl Into<String>, text: impl Into<String>) -> Document {
        Document { path: path.into(), text: text.into(), unreadable: None }
    }

    /// Creates a document from bytes in memory.
    pub fn from_bytes(path: impl Into<String>, bytes: &[u8]) -> Document {
        if bytes.len() > TEXT_LIMIT {
            let mut document = Document::new(path, "");
            document.unreadable = Some(too_long(bytes.len() as u64));
            return document;
        }
        let text = String::from_utf8_lossy(bytes);
        let mut document = Document::new(path, text);
        if let Err(error) = std::str::from_utf8(bytes) {
            let start = error.valid_up_to();
            let place = start..start + '\u{fffd}'.len_utf8();
            let message = format!("the byte 0x{:02X} here is not UTF-8", bytes[start]);
            document.unreadable =
                Some(Diagnostic::error(place, message).with_help("save the file as UTF-8 text"));
        }
        document
    }

    /// Reads a file or a pipe, up to the largest size of a preset.
    ///
    /// # Errors
    /// Returns an error if it cannot be opened or read, or if it is neither a file nor a pipe.
    pub fn open(path: &Path) -> io::Result<Document> {
        Ok(Document::of_bytes_read(path, file::read(path, TEXT_LIMIT as u64)?))
    }

    /// Reads a regular file only, so it never has to wait.
    ///
    /// # Errors
    /// Returns an error if the file cannot be opened or read, or if it is not a regular file.
    pub fn open_regular(path: &Path) -> io::Result<Document> {
        Ok(Document::of_bytes_read(path, file::read_regular(path, TEXT_LIMIT as u64)?))
    }

    fn of_bytes_read(path: &Path, (bytes, size): (Vec<u8>, u64)) -> Document {
        let shown = printable::path(path);
        if bytes.len() > TEXT_LIMIT {
            let mut document = Document::new(shown, "");
            document.unreadable = Some(too_long(size));
            return document;
        }
        Document::from_bytes(shown, &bytes)
    }

    /// The name of the file without its folder and its `.toml`: the title of a system that gives none.
    pub fn stem(&self) -> Option<&str> {
        Path::new(&self.path).file_stem()?.to_str().filter(|stem| !stem.is_empty())
    }

    /// An error in its bytes that prevents the text from being read at all.
    pub fn unreadable(&self) -> Option<&Diagnostic> {
        self.unreadable.as_ref()
    }

    /// The line and the column of a byte of the text, both counted from 1; columns count
    /// characters.
    pub fn line_and_column(&self, byte: usize) -> (usize, usize) {
        let before = self.text.get(..byte.min(self.text.len())).unwrap_or("");
        let line = 1 + before.matches('\n').count();
        let column = 1 + before.chars().rev().take_while(|&c| c != '\n').count();
        (line, column)
    }

    /// Formats errors found in the document, see [`report()`].
    pub fn report(&self, diagnostics: &[Diagnostic], colour: bool) -> String {
        report(&self.text, &self.path, diagnostics, colour)
    }
}

/// The error for a file beyond the size limit.
pub fn too_long(bytes: u64) -> Diagnostic {
    let message = format!("the file has {bytes} bytes; a preset may have {TEXT_LIMIT} (1 MiB)");
    Diagnostic::error(0..0, message)
}
