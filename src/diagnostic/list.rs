//! An error in a file, with its place and a correction, and the list that collects errors.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;

/// A range of bytes in the text of a file.
pub type SourceRange = std::ops::Range<usize>;

/// The severity of an error.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Severity {
    /// The file cannot be used.
    Error,
    /// The file can be used, but this is probably not what was meant.
    Warning,
    /// This has no effect on the motion.
    Unused,
}

/// An error in a file.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{message}")]
pub struct Diagnostic {
    /// Whether it prevents the use of the text.
    pub severity: Severity,
    /// The place, as bytes of the file.
    pub place: SourceRange,
    /// What is wrong, one clause without a full stop.
    pub message: String,
    /// A correction, if one is known.
    pub help: Option<String>,
    /// A related place, and a description of what is there.
    pub also: Option<(SourceRange, String)>,
}

impl Diagnostic {
    /// Creates an error that makes the file unusable.
    pub fn error(place: SourceRange, message: impl Into<String>) -> Diagnostic {
        let message = message.into();
        Diagnostic { severity: Severity::Error, place, message, help: None, also: None }
    }

    /// Creates a warning about something that is allowed but probably not meant.
    pub fn warning(place: SourceRange, message: impl Into<String>) -> Diagnostic {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(place, message) }
    }

    /// Creates a warning about something that has no effect on the motion.
    pub fn unused(place: SourceRange, message: impl Into<String>) -> Diagnostic {
        Diagnostic { severity: Severity::Unused, ..Diagnostic::error(place, message) }
    }

    /// Adds a correction.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Diagnostic {
        self.help = Some(help.into());
        self
    }

    /// Adds a related place.
    #[must_use]
    pub fn with_also(mut self, place: SourceRange, what: impl Into<String>) -> Diagnostic {
        self.also = Some((place, what.into()));
        self
    }
}

/// The largest number of characters in a message: a name in a file may fill the whole file.
const LONGEST: usize = 400;

/// The largest number of errors stored: a file with a million of them would fill the memory.
const MOST: usize = 100;

/// The errors of one file. It also records what TOML syntax errors may have hidden, so that
/// nothing is reported as missing because of them.
#[derive(Default, Debug)]
pub struct Diagnostics {
    list: RefCell<Vec<Diagnostic>>,
    left_out: Cell<usize>,
    /// Keys lost in TOML syntax errors.
    lost_keys: BTreeSet<String>,
    /// Values with TOML syntax errors; no further errors are reported in them.
    lost_values: Vec<SourceRange>,
    /// Whether any part of the file may be lost.
    lost_track: bool,
    /// The plain forms of what is written in the notation of the screen.
    plain: RefCell<Vec<(SourceRange, String)>>,
}

impl Diagnostics {
    /// Records an error.
    pub fn push(&self, mut diagnostic: Diagnostic) {
        shorten(&mut diagnostic.message);
        if let Some(help) = &mut diagnostic.help {
            shorten(help);
        }
        let overlaps = |lost: &SourceRange| {
            diagnostic.place.start <= lost.end && lost.start <= diagnostic.place.end
        };
        if self.lost_values.iter().any(overlaps) {
            return;
        }
        let mut list = self.list.borrow_mut();
        if list.len() >= MOST {
            // a warning makes room for an error
            let is_error = diagnostic.severity == Severity::Error;
            let is_warning = |one: &Diagnostic| one.severity != Severity::Error;
            self.left_out.update(|count| count + 1);
            let Some(at) = list.iter().rposition(is_warning).filter(|_| is_error) else { return };
            list.remove(at);
        }
        list.push(diagnostic);
    }

    /// Records that something called `key` is missing, unless a TOML syntax error explains it.
    pub fn missing(&self, key: &str, diagnostic: Diagnostic) {
        if !self.lost_keys.contains(key) {
            self.push(diagnostic);
        }
    }

    /// Records a key that a TOML syntax error has hidden.
    pub fn lose_key(&mut self, key: &str) {
        self.lost_keys.insert(key.to_owned());
    }

    /// Records a value that has a TOML syntax error.
    pub fn lose_value(&mut self, place: SourceRange) {
        self.lost_values.push(place);
    }

    /// Records that a TOML syntax error makes the rest of the file unreliable.
    pub fn lose_track(&mut self) {
        self.lost_track = true;
    }

    /// Returns whether the rest of the file is too unreliable for further checks.
    pub fn lost_track(&self) -> bool {
        self.lost_track
    }

    /// Records the plain form of an expression.
    pub fn note_plain(&self, place: SourceRange, plain: Option<String>) {
        self.plain.borrow_mut().extend(plain.map(|plain| (place, plain)));
    }

    /// The plain forms recorded so far.
    pub fn take_plain(&self) -> Vec<(SourceRange, String)> {
        self.plain.take()
    }

    /// All errors, in the order of their places.
    pub fn into_list(self) -> Vec<Diagnostic> {
        let left_out = self.left_out.get();
        let mut list = self.into_warnings();
        if left_out > 0 {
            let place = list.last().map_or(0..0, |m| m.place.clone());
            let message = format!("{left_out} more errors are not listed");
            list.push(Diagnostic::error(place, message));
        }
        list
    }

    /// All errors in the order of their places, if none makes the file unusable.
    pub fn into_warnings(self) -> Vec<Diagnostic> {
        let mut list = self.list.into_inner();
        list.sort_by_key(|m| (m.place.start, m.place.end));
        list
    }

    /// Returns whether there is an error that makes the file unusable.
    pub fn any_error(&self) -> bool {
        self.list.borrow().iter().any(|m| m.severity == Severity::Error)
    }
}

fn shorten(message: &mut String) {
    if let Some((at, _)) = message.char_indices().nth(LONGEST) {
        message.truncate(at);
        message.push_str("...");
    }
}
