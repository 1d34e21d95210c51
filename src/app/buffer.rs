//! A source buffer: the text of one system's file being edited, and its check results.
//!
//! In: keys, time, diagnostics. Out: the text, its diagnostics with positions, and when it is due for a check.
//! Never here: other buffers, the running system, files, or how it is drawn.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crossterm::event::KeyEvent;
use serde::{Deserialize, Serialize};
use tui_input::Input;

use super::Loaded;
use super::editor::{Caret, Editor};
use super::field::{edit, edit_selected};
use crate::diagnostic::TEXT_LIMIT;
use crate::diagnostic::{Diagnostic, Severity};

/// How long typing must pause before the text is checked.
const REST: Duration = Duration::from_millis(150);

/// How long to wait before re-reading a file with errors, since another program may still be writing it.
const RETRY_DELAY: Duration = Duration::from_millis(700);

/// A check that takes longer than this is one that the user would rather stop than wait for.
const LONG: Duration = Duration::from_secs(1);

/// A system's file being edited.
#[derive(Clone, Debug)]
pub struct SourceBuffer {
    /// The name under which the system was loaded.
    pub name: String,
    /// The name used in diagnostics.
    pub title: String,
    /// The file it is saved to. `None` for a built-in preset until its copy has a name.
    pub place: Option<PathBuf>,
    /// The text.
    pub editor: Editor,
    /// The diagnostics of the last check, in order.
    pub diagnostics: Vec<BufferDiagnostic>,
    /// Whether the text has been checked, and with what result.
    pub state: BufferState,
    /// The prompt below the text, if one is open.
    pub asking: Option<Asking>,
    /// The first row and column shown.
    pub scroll: (usize, usize),
    /// The text as it is on disk.
    pub(super) on_disk: String,
    /// Incremented with every change of the text.
    revision: u64,
    checking: Option<RunningCheck>,
    /// The time left until the text is checked.
    rest: Option<Duration>,
    /// Whether the text has just been read from disk and may be incomplete; if it is wrong, it is read once more.
    may_be_partial: bool,
    /// Whether the next save overwrites the file although another program has changed it.
    pub(super) overwrites: bool,
    /// What was searched for last.
    pub(super) searched: String,
    /// Whether it was saved before it was checked; errors found later are then reported.
    pub(super) unchecked: bool,
    /// A warning of the running text that has first been found while the editor showed it in its place.
    pub(super) untold: Option<String>,
}

#[derive(Clone, Debug)]
struct RunningCheck {
    ticket: u64,
    /// The revision that it checks, and its text.
    revision: u64,
    text: String,
    /// How long it has been running.
    busy: Duration,
}

/// An unsaved text, in the form stored between runs of the program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unsaved {
    /// The preset's name or the file's path.
    pub name: String,
    /// The name used in diagnostics.
    pub title: String,
    /// The file it is saved to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<PathBuf>,
    /// The text, with the changes that have not been saved.
    pub text: String,
    /// The file's text on which it is based.
    pub of: String,
}

/// A diagnostic with its position in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BufferDiagnostic {
    /// The start.
    pub from: Caret,
    /// The end, on the same line.
    pub to: Caret,
    /// Whether it is only a warning, so that the text can still be used.
    pub warning: bool,
    /// What is wrong.
    pub message: String,
    /// A suggested correction.
    pub help: Option<String>,
}

/// The state of a buffer's text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BufferState {
    /// It is the running system's.
    Runs,
    /// It has become the running system's by a change, in this time if there is a clock.
    Rebuilt(Option<Duration>),
    /// It has changed and has not been checked yet.
    Changed,
    /// It has errors; the last correct version is running.
    Wrong,
    /// Another system is open; the text is checked again when it is reopened.
    Left,
}

/// What the prompt below the text asks for.
#[derive(Clone, Debug)]
pub enum Asking {
    /// A text to search for.
    Words(Input),
    /// The name of a copy.
    Name {
        /// What is typed so far, with the cursor.
        input: Input,
        /// Whether it is still the suggested name, selected as a whole: typing replaces it.
        whole: bool,
    },
}

impl Asking {
    /// Asks for the name of a copy, with a suggestion.
    pub(super) fn name(suggested: String) -> Self {
        Self::Name { input: Input::new(suggested), whole: true }
    }
}

/// Whether a check result is about the current text.
pub(super) enum CheckedRevision {
    /// It is about the current text.
    Newest,
    /// The text has changed since the check began.
    Older,
}

impl SourceBuffer {
    /// The file of a loaded system; `place` is its path if it can be written to.
    pub(super) fn new(loaded: &Loaded, place: Option<PathBuf>) -> Self {
        let text = &loaded.document.text;
        let known = Unsaved {
            name: loaded.name.clone(),
            title: loaded.document.path.clone(),
            place,
            text: text.clone(),
            of: text.clone(),
        };
        let mut buffer = Self { state: BufferState::Runs, ..Self::of_unsaved(known) };
        buffer.note(&loaded.warnings);
        // It opens at the law: L, H or the brackets.
        let law = buffer.editor.caret_at(loaded.model.law_place.start);
        buffer.editor.go(Caret { column: 0, ..law });
        buffer
    }

    /// Restores an unsaved text.
    pub(super) fn of_unsaved(unsaved: Unsaved) -> Self {
        Self {
            name: unsaved.name,
            title: unsaved.title,
            place: unsaved.place,
            editor: Editor::new(&unsaved.text, TEXT_LIMIT),
            diagnostics: Vec::new(),
            state: BufferState::Left,
            asking: None,
            scroll: (0, 0),
            // A change of the file since then is noticed before it is overwritten.
            on_disk: unsaved.of,
            revision: 0,
            checking: None,
            rest: None,
            may_be_partial: false,
            overwrites: false,
            searched: String::new(),
            unchecked: false,
            untold: None,
        }
    }

    /// Returns the revision: the number of its changes.
    pub(super) fn revision(&self) -> u64 {
        self.revision
    }

    /// Returns the text in the form to be stored, if it is unsaved.
    pub(super) fn unsaved(&self) -> Option<Unsaved> {
        self.is_modified().then(|| Unsaved {
            name: self.name.clone(),
            title: self.title.clone(),
            place: self.place.clone(),
            text: self.editor.text(),
            of: self.on_disk.clone(),
        })
    }

    /// Whether it belongs to the system of this name, or of this file if the system has one.
    pub(super) fn is_of(&self, name: &str, place: Option<&Path>) -> bool {
        self.name == name || place.is_some() && self.place.as_deref() == place
    }

    /// Whether the text differs from the file's.
    pub fn is_modified(&self) -> bool {
        self.editor.text() != self.on_disk
    }

    /// Returns the diagnostic at or after the cursor, or else the first one.
    pub fn diagnostic(&self) -> Option<&BufferDiagnostic> {
        let cursor = self.editor.cursor();
        let on_line = self.diagnostics.iter().find(|diagnostic| diagnostic.from.row == cursor.row);
        let after = self.diagnostics.iter().find(|diagnostic| diagnostic.to >= cursor);
        let at = self
            .diagnostics
            .iter()
            .find(|diagnostic| diagnostic.from <= cursor && cursor <= diagnostic.to);
        at.or(on_line).or(after).or(self.diagnostics.first())
    }

    /// Returns the number of errors, which keep the text from being used.
    pub fn error_count(&self) -> usize {
        self.diagnostics.iter().filter(|diagnostic| !diagnostic.warning).count()
    }

    /// Returns the first row and column to show so that the cursor is visible in a window of this size.
    pub fn follow(&self, rows: usize, columns: usize) -> (usize, usize) {
        let cursor = self.editor.cursor();
        let within = |first: usize, at: usize, count: usize| {
            let last = first + count.saturating_sub(1);
            if count == 0 || (first..=last).contains(&at) {
                first
            } else if at < first {
                at.saturating_sub(count / 4)
            } else {
                (at + 1 + count / 4).saturating_sub(count)
            }
        };
        // No horizontal scrolling is needed if the line fits up to the cursor.
        let start = if cursor.column < columns { 0 } else { self.scroll.1 };
        (within(self.scroll.0, cursor.row, rows), within(start, cursor.column, columns))
    }

    /// Registers a change of the text.
    pub(super) fn touch(&mut self) {
        self.revision += 1;
        self.rest = Some(REST);
        (self.may_be_partial, self.unchecked) = (false, false);
        self.state = BufferState::Changed;
    }

    /// Registers a change that was not typed: the text is checked at the next opportunity.
    pub(super) fn touch_at_once(&mut self, may_be_partial: bool) {
        self.touch();
        (self.rest, self.may_be_partial) = (Some(Duration::ZERO), may_be_partial);
    }

    /// Marks the buffer as left, since another system was opened.
    pub(super) fn leave(&mut self) {
        (self.checking, self.rest, self.asking) = (None, None, None);
        (self.may_be_partial, self.overwrites) = (false, false);
        self.diagnostics.clear();
        self.state = BufferState::Left;
    }

    /// Advances the time. Returns whether the text is to be checked now, replacing any older check.
    pub(super) fn tick(&mut self, elapsed: Duration) -> bool {
        self.rest = self.rest.map(|rest| rest.saturating_sub(elapsed));
        if let Some(check) = &mut self.checking {
            check.busy = check.busy.saturating_add(elapsed);
        }
        self.rest == Some(Duration::ZERO)
    }

    /// Whether its check has run so long that leaving the buffer should stop it.
    pub fn is_long_checked(&self) -> bool {
        self.checking.as_ref().is_some_and(|check| check.busy >= LONG)
    }

    /// Postpones its check until it is opened again. Returns whether a check was running.
    pub(super) fn postpone_check(&mut self) -> bool {
        let checking = self.checking.take().is_some();
        if checking {
            self.rest = Some(Duration::ZERO);
        }
        checking
    }

    /// Marks its text as being checked, and returns it; the result will carry this ticket.
    pub(super) fn begin_check(&mut self, ticket: u64) -> String {
        let (revision, text) = (self.revision, self.editor.text());
        self.rest = None;
        let busy = Duration::ZERO;
        self.checking = Some(RunningCheck { ticket, revision, text: text.clone(), busy });
        text
    }

    pub(super) fn awaits(&self, ticket: u64) -> bool {
        self.checking.as_ref().is_some_and(|check| check.ticket == ticket)
    }

    /// Ends the check, and returns the text that was checked.
    pub(super) fn end_check(&mut self) -> (CheckedRevision, String) {
        let check = self.checking.take();
        let of = check.as_ref().map(|check| check.revision);
        let newest = of == Some(self.revision);
        let revision = if newest { CheckedRevision::Newest } else { CheckedRevision::Older };
        (revision, check.map_or_else(String::new, |check| check.text))
    }

    /// Stores the errors found, unless the text may be an incomplete file that is read once more.
    pub(super) fn is_wrong(&mut self, diagnostics: &[Diagnostic]) {
        if self.may_be_partial {
            (self.may_be_partial, self.rest) = (false, Some(RETRY_DELAY));
        } else {
            self.note(diagnostics);
            self.state = BufferState::Wrong;
        }
    }

    /// Returns the warning for a text that is saved with errors, or before they were found.
    pub(super) fn saved_as(&self) -> Option<String> {
        let shown = self.place.as_ref()?.display();
        let diagnostic = self.diagnostics.iter().find(|diagnostic| !diagnostic.warning);
        let Some(diagnostic) = diagnostic.filter(|_| self.state == BufferState::Wrong) else {
            return Some(format!("Saved: {shown}"));
        };
        let count = match self.error_count() {
            1 => "1 error".to_owned(),
            n => format!("{n} errors"),
        };
        let (row, column) = (diagnostic.from.row + 1, diagnostic.from.column + 1);
        Some(format!("Saved: {shown}, with {count}: {row}:{column} {}", diagnostic.message))
    }

    pub(super) fn press(&mut self, key: KeyEvent, page: usize) {
        match &mut self.asking {
            Some(Asking::Words(input)) => {
                edit(input, key);
            }
            Some(Asking::Name { input, whole }) => {
                edit_selected(input, whole, key);
            }
            None => {
                if self.editor.press(key, page) {
                    self.touch();
                }
            }
        }
    }

    /// Stores the diagnostics, each at its position.
    pub(super) fn note(&mut self, diagnostics: &[Diagnostic]) {
        let diagnostic = |diagnostic: &Diagnostic| {
            let from = self.editor.caret_at(diagnostic.place.start);
            let end = self.editor.caret_at(diagnostic.place.end);
            let length = self.editor.lines()[from.row].chars().count();
            let column = if end.row == from.row { end.column } else { length };
            BufferDiagnostic {
                from,
                to: Caret { row: from.row, column: column.max(from.column) },
                warning: diagnostic.severity != Severity::Error,
                message: diagnostic.message.clone(),
                help: diagnostic.help.clone(),
            }
        };
        self.diagnostics = diagnostics.iter().map(diagnostic).collect();
    }

    /// Goes to the first error.
    pub(super) fn step_to_first(&mut self) {
        if let Some(from) = self.diagnostics.iter().map(|diagnostic| diagnostic.from).min() {
            self.editor.go(from);
        }
    }

    /// Goes to the next error (+1) or the previous one (−1). Returns whether there is one.
    pub(super) fn step(&mut self, sign: i8) -> bool {
        let cursor = self.editor.cursor();
        let mut places = self.diagnostics.iter().map(|diagnostic| diagnostic.from);
        let to = if sign > 0 {
            places.clone().find(|place| *place > cursor).or(places.next())
        } else {
            places.clone().rfind(|place| *place < cursor).or(places.next_back())
        };
        to.inspect(|to| self.editor.go(*to)).is_some()
    }
}
