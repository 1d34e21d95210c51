//! A mistake in a file: where, what, and what would be right; and the list that collects them.

use std::collections::BTreeSet;

use super::Checked;
use crate::diagnostic::SourceRange;
use crate::model::Model;

/// How bad a mistake is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Severity {
    /// The file cannot be used.
    Error,
    /// The file can be used; this is probably not what was meant.
    Warning,
}

/// A mistake in a file.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{message}")]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// Where it stands, as bytes of the file.
    pub place: SourceRange,
    /// What is wrong, one clause without a full stop.
    pub message: String,
    /// What would be right, where that can be said.
    pub help: Option<String>,
    /// Another place that has to do with it, and what stands there.
    pub also: Option<(SourceRange, String)>,
}

impl Diagnostic {
    /// A mistake that makes the file unusable.
    pub fn error(place: SourceRange, message: impl Into<String>) -> Diagnostic {
        let message = message.into();
        Diagnostic { severity: Severity::Error, place, message, help: None, also: None }
    }

    /// Something allowed but probably not meant.
    pub fn warning(place: SourceRange, message: impl Into<String>) -> Diagnostic {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(place, message) }
    }

    /// The same mistake with what would be right.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Diagnostic {
        self.help = Some(help.into());
        self
    }

    /// The same mistake with a second place to look at.
    #[must_use]
    pub fn with_also(mut self, place: SourceRange, what: impl Into<String>) -> Diagnostic {
        self.also = Some((place, what.into()));
        self
    }
}

/// The most letters of a message: a name of a file may fill the file.
const LONGEST: usize = 400;

/// No more mistakes than these are kept: a file of a million would fill the memory.
const MOST: usize = 100;

/// The mistakes of one file, and what TOML's own mistakes may have swallowed: what only seems to
/// be missing because of them is not complained of.
#[derive(Default, Debug)]
pub(super) struct Diagnostics {
    list: Vec<Diagnostic>,
    left_out: usize,
    /// Keys that TOML lost.
    lost_keys: BTreeSet<String>,
    /// Values that TOML could not read; nothing more is said of them.
    lost_values: Vec<SourceRange>,
    /// Whether any part of the file may be lost.
    lost_track: bool,
}

impl Diagnostics {
    /// Takes note of a mistake.
    pub(super) fn push(&mut self, mut mistake: Diagnostic) {
        shorten(&mut mistake.message);
        if let Some(help) = &mut mistake.help {
            shorten(help);
        }
        let meets =
            |lost: &SourceRange| mistake.place.start <= lost.end && lost.start <= mistake.place.end;
        if self.lost_values.iter().any(meets) {
            return;
        }
        if self.list.len() < MOST || mistake.severity == Severity::Error && self.make_room() {
            self.list.push(mistake);
        } else {
            self.left_out += 1;
        }
    }

    /// Drops a warning in favour of an error.
    fn make_room(&mut self) -> bool {
        let warning = self.list.iter().rposition(|m| m.severity == Severity::Warning);
        if let Some(at) = warning {
            self.list.remove(at);
            self.left_out += 1;
        }
        warning.is_some()
    }

    /// Takes note that something called `key` is not there, unless TOML's mistakes explain it.
    pub(super) fn missing(&mut self, key: &str, mistake: Diagnostic) {
        if !self.lost_keys.contains(key) {
            self.push(mistake);
        }
    }

    /// A key that TOML lost on the way.
    pub(super) fn lose_key(&mut self, key: &str) {
        self.lost_keys.insert(key.to_owned());
    }

    /// A value that TOML could not read.
    pub(super) fn lose_value(&mut self, place: SourceRange) {
        self.lost_values.push(place);
    }

    /// TOML lost its way: what it read of the rest may be anything.
    pub(super) fn lose_track(&mut self) {
        self.lost_track = true;
    }

    /// Whether too little is left of the file to say more of it.
    pub(super) fn lost_track(&self) -> bool {
        self.lost_track
    }

    /// All of them, in the order of their places.
    pub(super) fn into_list(mut self) -> Vec<Diagnostic> {
        self.sort();
        if self.left_out > 0 {
            let place = self.list.last().map_or(0..0, |m| m.place.clone());
            let message = format!("{} more mistakes are not listed", self.left_out);
            self.list.push(Diagnostic::error(place, message));
        }
        self.list
    }

    /// Whether there is a mistake that makes the file unusable.
    pub(super) fn any_error(&self) -> bool {
        self.list.iter().any(|m| m.severity == Severity::Error)
    }

    /// The verdict on the file.
    pub(super) fn conclude(mut self, model: Option<Model>) -> Result<Checked, Vec<Diagnostic>> {
        match model {
            Some(model) if !self.any_error() => {
                self.sort();
                Ok(Checked { model, warnings: self.list })
            }
            _ => Err(self.into_list()),
        }
    }

    fn sort(&mut self) {
        self.list.sort_by_key(|m| (m.place.start, m.place.end));
    }
}

fn shorten(message: &mut String) {
    if let Some((at, _)) = message.char_indices().nth(LONGEST) {
        message.truncate(at);
        message.push_str("...");
    }
}
