//! Editing: what is done to the file of the system in the lab while that runs.
//!
//! In: keys, time, and what became of checks, of saving and of the file on disk. Out: the changed sheet, and what is to
//! be checked or saved. Never here: files, threads, how it is drawn.
//!
//! A text is checked when typing rests, one check at a time, and where it is right the lab is built anew from it. A
//! newer text stops the check of an older one. A file changed by another program takes the same way.

use std::path::PathBuf;
use std::time::Duration;

use tui_input::Input;

use super::buffer::{Asking, Found, SourceBuffer, State, Unsaved};
use super::field::paste;
use super::{App, Effect, Key, Lab, Loaded, Notification, Overlay, Page};
use crate::diagnostic::Diagnostic;
use crate::preset::{Origin, is_path};

/// A text that was asked to be checked: what became of it.
#[derive(Clone, Debug)]
pub struct Checked {
    /// Which check it was.
    pub ticket: u64,
    /// The system it makes, running already, or its mistakes.
    pub outcome: Result<Loaded, Vec<Diagnostic>>,
    /// How long that took.
    pub took: Duration,
}

/// Why a text was not saved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SaveError {
    /// The file is not what it was when it was read.
    Changed,
    /// There is a file of that name already.
    Exists(PathBuf),
    /// Anything else, a sentence.
    Refused(String),
}

impl App {
    /// The sheet being edited, while its editor is open.
    pub fn open_buffer(&self) -> Option<&SourceBuffer> {
        self.workbench.top().filter(|_| matches!(self.overlay, Some(Overlay::Workbench)))
    }

    fn buffer(&mut self) -> Option<&mut SourceBuffer> {
        self.workbench.top_mut()
    }

    /// The sheet of the system in the lab, if it has one.
    pub(super) fn own_buffer(&self) -> Option<&SourceBuffer> {
        let lab = self.lab.as_ref()?;
        self.workbench.of(&lab.loaded.name, self.file().as_deref())
    }

    /// The file of the loaded system, where it has one of its own.
    pub fn file(&self) -> Option<PathBuf> {
        let name = &self.lab.as_ref()?.loaded.name;
        if is_path(name) {
            return Some(PathBuf::from(name));
        }
        let entry = self.picker.entries.iter().find(|entry| entry.name == *name)?;
        match &entry.origin {
            Origin::User(path) => Some(path.clone()),
            Origin::Shipped => None,
        }
    }

    /// A line on what is wrong with the file while its editor is closed.
    pub fn banner(&self) -> Option<String> {
        let buffer = self.own_buffer().filter(|_| self.overlay.is_none())?;
        let flaw = buffer.flaws.first().filter(|_| buffer.state == State::Wrong)?;
        let (row, column) = (flaw.from.row + 1, flaw.from.column + 1);
        Some(format!("{}:{row}:{column}: {}; what was right goes on", buffer.title, flaw.message))
    }

    /// Whether the answer to a check is still wanted.
    pub fn awaits(&self, ticket: u64) -> bool {
        self.own_buffer().is_some_and(|buffer| buffer.awaits(ticket))
    }

    /// The texts of all systems that are not saved.
    pub fn unsaved(&self) -> Vec<Unsaved> {
        self.workbench.unsaved()
    }

    /// Opens the file of the loaded system.
    pub(super) fn edit_file(&mut self) -> Vec<Effect> {
        if self.ready_buffer().is_some() {
            self.overlay = Some(Overlay::Workbench);
        }
        Vec::new()
    }

    /// The sheet of the system in the lab, as it was left.
    fn ready_buffer(&mut self) -> Option<&mut SourceBuffer> {
        let place = self.file();
        Some(self.workbench.lay(&self.lab.as_ref()?.loaded, place))
    }

    /// Ends the program; where a text would be lost only when asked twice.
    pub(super) fn quit(&mut self) -> Vec<Effect> {
        let Some(told) = self.loss().filter(|_| !self.workbench.keeps) else {
            return vec![Effect::Quit];
        };
        if self.notice.as_ref().is_some_and(|notice| notice.text == told) {
            return vec![Effect::Quit];
        }
        self.notify(told)
    }

    /// The program was about to end, and a text could not be kept.
    pub fn stay(&mut self) {
        self.workbench.keeps = false;
        self.notice = self.loss().map(Notification::error);
    }

    /// A sentence on what would be lost.
    fn loss(&self) -> Option<String> {
        let text = self.workbench.unsaved().into_iter().next()?;
        Some(format!("{} has changes that are not saved; quit again to lose them.", text.title))
    }

    /// The text that was not saved is the one that ran: it is checked at once. Whether there is such a text.
    pub(super) fn wake(&mut self) -> bool {
        let modified = self.own_buffer().is_some_and(SourceBuffer::is_modified);
        modified && self.ready_buffer().is_some()
    }

    /// Tells of a text of the system in the lab that was not saved.
    pub(super) fn remind(&mut self) {
        if let Some(buffer) = self.own_buffer().filter(|buffer| buffer.is_modified()) {
            let told = format!("{} has changes that are not saved; E goes to them.", buffer.title);
            self.notice = Some(Notification::info(told));
        }
    }

    /// A key that stands for itself.
    pub(super) fn type_into_buffer(&mut self, key: Key) {
        let page = usize::from(self.drawn.rows).saturating_sub(1);
        if let Some(buffer) = self.buffer() {
            buffer.press(key, page);
        }
    }

    /// Pasted text; whether all of it found room.
    pub(super) fn paste_into_buffer(&mut self, text: &str) -> bool {
        let Some(buffer) = self.buffer() else { return true };
        match &mut buffer.asking {
            Some(Asking::Words(input) | Asking::Name(input)) => paste(input, text),
            None => {
                let whole = buffer.editor.paste(text);
                buffer.touch();
                whole
            }
        }
    }

    /// Something done to the text as a whole.
    pub(super) fn work(&mut self, work: EditCommand) -> Vec<Effect> {
        let Some(buffer) = self.buffer() else { return Vec::new() };
        let changed = match work {
            EditCommand::Save => return self.save_file(),
            EditCommand::Find => {
                buffer.asking = Some(Asking::Words(Input::new(buffer.sought.clone())));
                false
            }
            EditCommand::FindNext => return self.find(),
            EditCommand::Diagnostic(sign) => {
                if !buffer.step(sign) {
                    return self.notify("There is no mistake.");
                }
                false
            }
            EditCommand::Cut => buffer.editor.cut(),
            EditCommand::Copy => {
                buffer.editor.copy();
                self.notice = Some(Notification::info("Copied; Ctrl-v puts it in."));
                return Vec::new();
            }
            EditCommand::PutBack => buffer.editor.put_back(),
            EditCommand::Undo => {
                if !buffer.editor.undo() {
                    return self.notify("There is nothing to take back.");
                }
                true
            }
            EditCommand::Redo => {
                if !buffer.editor.redo() {
                    return self.notify("There is nothing to do again.");
                }
                true
            }
            EditCommand::Reread => {
                let Some(place) = &buffer.place else {
                    // what is shipped has not changed
                    let text = buffer.on_disk.clone();
                    self.changed_on_disk(&text, true);
                    return Vec::new();
                };
                return vec![Effect::Reread(place.clone())];
            }
        };
        if changed && let Some(buffer) = self.buffer() {
            buffer.touch();
        }
        Vec::new()
    }

    /// Esc: leaves what is asked for, else the workbench; the text stays. A check that takes long is stopped.
    pub(super) fn leave_buffer(&mut self) -> Vec<Effect> {
        let Some(buffer) = self.workbench.top_mut() else {
            self.overlay = None;
            return Vec::new();
        };
        if buffer.asking.take().is_some() {
            return Vec::new();
        }
        self.overlay = None;
        let stopped = buffer.is_long_checked();
        if stopped {
            buffer.leave();
        }
        let told = match (stopped, buffer.is_modified()) {
            (true, _) => format!("{} is no longer being checked; E goes on with it.", buffer.title),
            (false, true) => format!("{} is not saved; E goes back to it.", buffer.title),
            (false, false) => return Vec::new(),
        };
        self.notice = Some(Notification::info(told));
        if stopped { vec![Effect::StopCheck] } else { Vec::new() }
    }

    /// Enter, where something is asked for.
    pub(super) fn accept_in_buffer(&mut self) -> Vec<Effect> {
        let Some(buffer) = self.buffer() else { return Vec::new() };
        match buffer.asking.take() {
            None => Vec::new(),
            Some(Asking::Words(input)) => {
                input.value().clone_into(&mut buffer.sought);
                if buffer.sought.is_empty() { Vec::new() } else { self.find() }
            }
            Some(Asking::Name(input)) => {
                let name = input.value().trim().to_owned();
                if name.is_empty() || name.ends_with('/') {
                    buffer.asking = Some(Asking::Name(input));
                    return self.notify("Give the copy a name, as my-pendulum or ./pendulum.toml.");
                }
                let text = buffer.editor.text();
                vec![Effect::SaveCopy { name, text }]
            }
        }
    }

    fn find(&mut self) -> Vec<Effect> {
        let Some(buffer) = self.buffer() else { return Vec::new() };
        let sought = buffer.sought.clone();
        if sought.is_empty() {
            buffer.asking = Some(Asking::Words(Input::default()));
            return Vec::new();
        }
        if buffer.editor.find(&sought) {
            return Vec::new();
        }
        self.notify(format!("`{sought}` stands nowhere."))
    }

    fn save_file(&mut self) -> Vec<Effect> {
        let Some(buffer) = self.buffer() else { return Vec::new() };
        let text = buffer.editor.text();
        match &buffer.place {
            Some(place) => {
                let known = (!buffer.overrule).then(|| buffer.on_disk.clone());
                vec![Effect::Save { place: place.clone(), text, known }]
            }
            None => {
                let copy = format!("my-{}", buffer.name);
                buffer.asking = Some(Asking::Name(Input::new(copy)));
                Vec::new()
            }
        }
    }

    /// A text was saved, or was not.
    pub(super) fn saved_file(&mut self, outcome: Result<(PathBuf, String), SaveError>) {
        let Some(buffer) = self.workbench.top_mut() else { return };
        buffer.overrule = outcome == Err(SaveError::Changed);
        self.notice = Some(match outcome {
            Ok((place, text)) => {
                let shown = place.display().to_string();
                buffer.on_disk = text;
                if buffer.place.as_ref() != Some(&place) {
                    // from now on the copy is what is open
                    let here = |lab: &&mut Lab| lab.loaded.name == buffer.name;
                    let name = if is_path(&shown) { shown.clone() } else { format!("./{shown}") };
                    if let Some(lab) = self.lab.as_mut().filter(here) {
                        lab.loaded.name.clone_from(&name);
                    }
                    (buffer.name, buffer.title) = (name, shown.clone());
                    buffer.place = Some(place);
                }
                buffer.unlooked = buffer.state == State::Changed;
                match (buffer.saved_as(), buffer.state) {
                    (Some(told), State::Wrong) => Notification::error(told),
                    (told, _) => Notification::info(told.unwrap_or_default()),
                }
            }
            Err(SaveError::Changed) => Notification::error(format!(
                "{} was changed by another program: Ctrl-s again writes over it, Ctrl-o reads it.",
                buffer.title
            )),
            Err(SaveError::Exists(place)) => {
                buffer.asking = Some(Asking::Name(Input::new(place.display().to_string())));
                Notification::error(format!(
                    "{} exists already; give another name.",
                    place.display()
                ))
            }
            Err(SaveError::Refused(why)) => Notification::error(why),
        });
    }

    /// The file holds this text now; `asked` says that it was read because the user wanted it.
    pub(super) fn changed_on_disk(&mut self, text: &str, asked: bool) {
        if let Some(buffer) = self.own_buffer().filter(|buffer| !asked && buffer.is_modified()) {
            if buffer.on_disk != text {
                let told = format!(
                    "{} was changed by another program; what stands here is not saved.",
                    buffer.title
                );
                self.notice = Some(Notification::error(told));
            }
            return;
        }
        let Some(buffer) = self.ready_buffer() else { return };
        text.clone_into(&mut buffer.on_disk);
        if buffer.editor.text() != text {
            buffer.editor.become_text(text);
            buffer.touch_at_once(!asked);
        }
        buffer.overrule = false;
    }

    /// The watched file has gone, or is there again.
    pub(super) fn found_on_disk(&mut self, there: bool) {
        let Some(lab) = &self.lab else { return };
        let title = &lab.loaded.document.path;
        self.notice = Some(if there {
            Notification::info(format!("{title} is there again."))
        } else {
            Notification::error(format!("{title} is no longer there; what it held goes on."))
        });
    }

    /// Time has passed.
    pub(super) fn tick_buffer(&mut self, elapsed: Duration) -> Option<Effect> {
        if self.page == Page::Picker {
            return self.workbench.put_off().then_some(Effect::StopCheck);
        }
        self.workbench.tick(elapsed)
    }

    /// The screen was drawn: the cursor is kept on it.
    pub(super) fn follow_cursor(&mut self) {
        let (rows, columns) = (self.drawn.rows.into(), self.drawn.columns.into());
        if matches!(self.overlay, Some(Overlay::Workbench))
            && let Some(buffer) = self.buffer()
        {
            buffer.scroll = buffer.follow(rows, columns);
        }
    }

    /// A text was checked, and where it was right its system runs already.
    pub(super) fn checked(&mut self, checked: Checked) -> Vec<Effect> {
        let Checked { ticket, outcome, took } = checked;
        let Some(buffer) = self.buffer().filter(|buffer| buffer.awaits(ticket)) else {
            return Vec::new();
        };
        let found = buffer.end_check();
        match (outcome, found) {
            (Ok(loaded), found) => {
                if let Found::Newest = found {
                    buffer.flaws.clear();
                    buffer.state = State::Runs(Some(took));
                }
                let resumes = self.lab.as_ref().is_some_and(|lab| lab.awaited.is_some());
                if !resumes && !matches!(self.overlay, Some(Overlay::Workbench)) {
                    let (title, time) = (&loaded.document.path, took.as_secs_f64() * 1e3);
                    let told = format!("{title}: built anew in {time:.0} ms; the motion goes on.");
                    self.notice = Some(Notification::info(told));
                }
                self.rebuilt(loaded)
            }
            // what was wrong with a text that has changed since is no longer so
            (Err(_), Found::Older) => Vec::new(),
            (Err(mistakes), Found::Newest) => {
                buffer.is_wrong(&mistakes);
                let saved = buffer.saved_as().filter(|_| buffer.unlooked);
                buffer.unlooked = false;
                if let Some(told) = saved {
                    self.notice = Some(Notification::error(told));
                }
                self.restore()
            }
        }
    }
}

/// What can be done to the text beside typing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EditCommand {
    /// Save it.
    Save,
    /// Look for words.
    Find,
    /// Look for them again.
    FindNext,
    /// To the next mistake (+1) or the one before (−1).
    Diagnostic(i8),
    /// Cut what is selected, or the line.
    Cut,
    /// Keep it without cutting it.
    Copy,
    /// Put in what was cut.
    PutBack,
    /// Take back the last change.
    Undo,
    /// Make it again.
    Redo,
    /// Read the file anew.
    Reread,
}
