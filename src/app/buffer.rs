//! A sheet: the text of one system's file being edited, and what is known of it.
//!
//! In: keys, time, mistakes. Out: the text, its mistakes in their places, and when it is to be checked. Never here: the
//! other sheets, the system that runs, files, how it is drawn.

use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::{Deserialize, Serialize};
use tui_input::Input;

use super::editor::{Caret, Editor};
use super::field::edit;
use super::{Key, Loaded};
use crate::diagnostic::{Diagnostic, Severity};
use crate::preset::TEXT_LIMIT;

/// For how long typing rests before the text is checked.
const REST: Duration = Duration::from_millis(150);

/// For how long a file found wrong is left to the program that is perhaps still writing it.
const PATIENCE: Duration = Duration::from_millis(700);

/// A check that takes this long is one that a person would rather stop than wait for.
const LONG: Duration = Duration::from_secs(1);

/// A file being edited.
#[derive(Clone, Debug)]
pub struct SourceBuffer {
    /// What was asked for when the system was loaded.
    pub name: String,
    /// What reports call it.
    pub title: String,
    /// The file it is saved to; a shipped preset has none until its copy has a name.
    pub place: Option<PathBuf>,
    /// The text.
    pub editor: Editor,
    /// What was wrong with it when it was last checked, in order.
    pub flaws: Vec<BufferDiagnostic>,
    /// What is known of the text.
    pub state: State,
    /// What is being asked for below the text.
    pub asking: Option<Asking>,
    /// The first row and column shown.
    pub scroll: (usize, usize),
    /// The text as the file has it.
    pub(super) on_disk: String,
    /// Counts the texts.
    revision: u64,
    /// The check under way, and the text that it is about.
    checking: Option<(u64, u64)>,
    /// For how long it has been so.
    busy: Duration,
    /// The time left until the text is checked.
    rest: Option<Duration>,
    /// A wrong text that just came from the file may be half of one, and is looked at once more.
    half: bool,
    /// Another program has changed the file, and the next saving writes over it all the same.
    pub(super) overrule: bool,
    pub(super) sought: String,
    /// It was saved before it was checked: where mistakes are found, that is reported.
    pub(super) unlooked: bool,
}

/// A text that was not saved, as it can be kept beyond the end of the program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unsaved {
    /// The preset's name or the file's path.
    pub name: String,
    /// What reports call it.
    pub title: String,
    /// The file it is saved to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<PathBuf>,
    /// The text.
    pub text: String,
    /// The file's text that it was made from.
    pub of: String,
}

/// A mistake in its place in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BufferDiagnostic {
    /// Where it begins.
    pub from: Caret,
    /// Where it ends, on the same line.
    pub to: Caret,
    /// Whether the text can still be used.
    pub warning: bool,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: Option<String>,
}

/// What is known of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It is the one that runs, and was built in so much time where that is known.
    Runs(Option<Duration>),
    /// It has changed and was not checked yet.
    Changed,
    /// It has mistakes; the last right one runs.
    Wrong,
    /// It was left for another system; nothing is known of it until it is taken up again.
    Left,
}

/// Something asked for.
#[derive(Clone, Debug)]
pub enum Asking {
    /// Words to look for.
    Words(Input),
    /// The name of a copy.
    Name(Input),
}

/// What a text that is right or wrong means for the one that runs.
pub(super) enum Found {
    /// It is the newest.
    Newest,
    /// The text has changed since.
    Older,
}

impl SourceBuffer {
    /// The file of a system, `place` being where it stands if that can be written to.
    pub(super) fn new(loaded: &Loaded, place: Option<PathBuf>) -> Self {
        let text = &loaded.document.text;
        let known = Unsaved {
            name: loaded.name.clone(),
            title: loaded.document.path.clone(),
            place,
            text: text.clone(),
            of: text.clone(),
        };
        Self { state: State::Runs(None), ..Self::of_unsaved(known) }
    }

    /// A text that was kept.
    pub(super) fn of_unsaved(unsaved: Unsaved) -> Self {
        Self {
            name: unsaved.name,
            title: unsaved.title,
            place: unsaved.place,
            editor: Editor::new(&unsaved.text, TEXT_LIMIT),
            flaws: Vec::new(),
            state: State::Left,
            asking: None,
            scroll: (0, 0),
            // what the file became since is noticed before it is written over
            on_disk: unsaved.of,
            revision: 0,
            checking: None,
            busy: Duration::ZERO,
            rest: None,
            half: false,
            overrule: false,
            sought: String::new(),
            unlooked: false,
        }
    }

    /// Counts its changes.
    pub(super) fn revision(&self) -> u64 {
        self.revision
    }

    /// The text, if it is to be kept.
    pub(super) fn unsaved(&self) -> Option<Unsaved> {
        self.is_modified().then(|| Unsaved {
            name: self.name.clone(),
            title: self.title.clone(),
            place: self.place.clone(),
            text: self.editor.text(),
            of: self.on_disk.clone(),
        })
    }

    /// Whether it is that of a system, whose file stands there if it has one of its own.
    pub(super) fn is_of(&self, name: &str, place: Option<&Path>) -> bool {
        self.name == name || place.is_some() && self.place.as_deref() == place
    }

    /// Whether the text is not the file's.
    pub fn is_modified(&self) -> bool {
        self.editor.text() != self.on_disk
    }

    /// The mistake that the cursor stands on or before, else the first.
    pub fn flaw(&self) -> Option<&BufferDiagnostic> {
        let cursor = self.editor.cursor();
        let on_line = self.flaws.iter().find(|flaw| flaw.from.row == cursor.row);
        let after = self.flaws.iter().find(|flaw| flaw.to >= cursor);
        let at = self.flaws.iter().find(|flaw| flaw.from <= cursor && cursor <= flaw.to);
        at.or(on_line).or(after).or(self.flaws.first())
    }

    /// How many mistakes there are with which the text cannot be used.
    pub fn mistakes(&self) -> usize {
        self.flaws.iter().filter(|flaw| !flaw.warning).count()
    }

    /// The first row and column to show, so that the cursor is among so many of them.
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
        // the line as far as the cursor need not be moved where it fits from its beginning
        let start = if cursor.column < columns { 0 } else { self.scroll.1 };
        (within(self.scroll.0, cursor.row, rows), within(start, cursor.column, columns))
    }

    /// The text has changed.
    pub(super) fn touch(&mut self) {
        self.revision += 1;
        self.rest = Some(REST);
        (self.half, self.unlooked) = (false, false);
        self.state = State::Changed;
    }

    /// The text has changed and is not being typed: it is checked at the next opportunity.
    pub(super) fn touch_at_once(&mut self, half: bool) {
        self.touch();
        (self.rest, self.half) = (Some(Duration::ZERO), half);
    }

    /// Another system has taken the place of its own.
    pub(super) fn leave(&mut self) {
        (self.checking, self.rest, self.asking) = (None, None, None);
        (self.half, self.overrule) = (false, false);
        self.flaws.clear();
        self.state = State::Left;
    }

    /// Time has passed; whether the text is to be checked now, in place of an older one.
    pub(super) fn tick(&mut self, elapsed: Duration) -> bool {
        self.rest = self.rest.map(|rest| rest.saturating_sub(elapsed));
        self.busy = self.busy.saturating_add(elapsed);
        self.rest == Some(Duration::ZERO)
    }

    /// Whether its check takes so long that who leaves it is not waiting for the end of it.
    pub fn is_long_checked(&self) -> bool {
        self.checking.is_some() && self.busy >= LONG
    }

    /// Its check is put off until it is looked at again; whether there was one under way.
    pub(super) fn put_off(&mut self) -> bool {
        let checking = self.checking.take().is_some();
        if checking {
            self.rest = Some(Duration::ZERO);
        }
        checking
    }

    /// Its text is being checked, and the answer will carry this number.
    pub(super) fn begin_check(&mut self, ticket: u64) {
        (self.rest, self.checking) = (None, Some((ticket, self.revision)));
        self.busy = Duration::ZERO;
    }

    /// Whether the answer of this number is about this sheet.
    pub(super) fn awaits(&self, ticket: u64) -> bool {
        self.checking.is_some_and(|(number, _)| number == ticket)
    }

    /// The check has come to its end.
    pub(super) fn end_check(&mut self) -> Found {
        let of = self.checking.take().map(|(_, revision)| revision);
        if of == Some(self.revision) { Found::Newest } else { Found::Older }
    }

    /// It was found wrong: takes the mistakes in, unless it may be half a file that is looked at once more.
    pub(super) fn is_wrong(&mut self, mistakes: &[Diagnostic]) {
        if self.half {
            (self.half, self.rest) = (false, Some(PATIENCE));
        } else {
            self.note(mistakes);
            self.state = State::Wrong;
        }
    }

    /// What is reported when the text is saved as it is, or was saved before its mistakes were found.
    pub(super) fn saved_as(&self) -> Option<String> {
        let shown = self.place.as_ref()?.display();
        let flaw = self.flaws.iter().find(|flaw| !flaw.warning);
        let Some(flaw) = flaw.filter(|_| self.state == State::Wrong) else {
            return Some(format!("Saved: {shown}"));
        };
        let count = match self.mistakes() {
            1 => "1 mistake".to_owned(),
            n => format!("{n} mistakes"),
        };
        let (row, column) = (flaw.from.row + 1, flaw.from.column + 1);
        Some(format!("Saved: {shown}, with {count}: {row}:{column} {}", flaw.message))
    }

    /// Types a key.
    pub(super) fn press(&mut self, key: Key, page: usize) {
        match &mut self.asking {
            Some(Asking::Words(input) | Asking::Name(input)) => {
                edit(input, key);
            }
            None => {
                if self.editor.press(key, page) {
                    self.touch();
                }
            }
        }
    }

    /// Takes mistakes in, each where it stands.
    fn note(&mut self, mistakes: &[Diagnostic]) {
        let flaw = |mistake: &Diagnostic| {
            let from = self.editor.spot(mistake.place.start);
            let end = self.editor.spot(mistake.place.end);
            let length = self.editor.lines()[from.row].chars().count();
            let column = if end.row == from.row { end.column } else { length };
            BufferDiagnostic {
                from,
                to: Caret { row: from.row, column: column.max(from.column) },
                warning: mistake.severity == Severity::Warning,
                message: mistake.message.clone(),
                help: mistake.help.clone(),
            }
        };
        self.flaws = mistakes.iter().map(flaw).collect();
    }

    /// To the next mistake (+1) or the one before (−1); whether there is one.
    pub(super) fn step(&mut self, sign: i8) -> bool {
        let cursor = self.editor.cursor();
        let mut places = self.flaws.iter().map(|flaw| flaw.from);
        let to = if sign > 0 {
            places.clone().find(|place| *place > cursor).or(places.next())
        } else {
            places.clone().rfind(|place| *place < cursor).or(places.next_back())
        };
        to.inspect(|to| self.editor.go(*to)).is_some()
    }
}
