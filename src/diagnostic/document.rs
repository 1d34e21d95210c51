//! The text of one preset, from the binary or from disk: read within limits, kept with the name it
//! is reported under. Not here: what the text means.

use std::io;
use std::path::Path;

use super::{Checked, Diagnostic, TEXT_LIMIT, read_with, report};
use crate::cancel::Cancel;
use crate::{file, printable};

/// A preset's text with its name.
#[derive(Clone, Debug)]
pub struct Document {
    /// What reports call it: the path of a file, fit to be shown; `presets/…` for a shipped one.
    pub path: String,
    /// The text; what is not UTF-8 in it replaced by `�`.
    pub text: String,
    /// What is wrong with it before a word of it is read.
    unreadable: Option<Diagnostic>,
}

impl Document {
    /// A text already at hand.
    pub fn new(path: impl Into<String>, text: impl Into<String>) -> Document {
        Document { path: path.into(), text: text.into(), unreadable: None }
    }

    /// Bytes already at hand.
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

    /// Reads a file or a pipe, no more of it than a preset may have.
    ///
    /// # Errors
    /// Those of opening and reading it; where it is neither.
    pub fn open(path: &Path) -> io::Result<Document> {
        Ok(Document::of_bytes_read(path, file::read(path, TEXT_LIMIT as u64)?))
    }

    /// The same of a regular file alone: nothing is waited for.
    ///
    /// # Errors
    /// Those of opening and reading it; where it is no regular file.
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

    /// What is wrong with its bytes, before a word of it is read.
    pub fn unreadable(&self) -> Option<&Diagnostic> {
        self.unreadable.as_ref()
    }

    /// Reads the preset in it.
    ///
    /// # Errors
    /// All its mistakes, see [`read`](super::read).
    pub fn read(&self) -> Result<Checked, Vec<Diagnostic>> {
        self.read_with(&Cancel::new())
    }

    /// The same, with a token by which this and all that is made of the model can be stopped.
    ///
    /// # Errors
    /// All its mistakes, see [`read`](super::read).
    pub fn read_with(&self, cancel: &Cancel) -> Result<Checked, Vec<Diagnostic>> {
        match &self.unreadable {
            Some(mistake) => Err(vec![mistake.clone()]),
            None => read_with(&self.text, cancel),
        }
    }

    /// The line and the column of a byte of the text, both counted from 1, the column in
    /// characters.
    pub fn line_and_column(&self, byte: usize) -> (usize, usize) {
        let before = self.text.get(..byte.min(self.text.len())).unwrap_or("");
        let line = 1 + before.matches('\n').count();
        let column = 1 + before.chars().rev().take_while(|&c| c != '\n').count();
        (line, column)
    }

    /// Draws mistakes found in it, see [`report()`].
    pub fn report(&self, mistakes: &[Diagnostic], colour: bool) -> String {
        report(&self.text, &self.path, mistakes, colour)
    }
}

/// The refusal of a file beyond the limit.
pub(super) fn too_long(bytes: u64) -> Diagnostic {
    let message = format!("the file has {bytes} bytes; a preset may have {TEXT_LIMIT} (1 MiB)");
    Diagnostic::error(0..0, message)
}
