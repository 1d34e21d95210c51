//! Editing the file of the system in the lab while it runs.
//!
//! In: keys, time, and the results of checks. Out: the changed buffer, and what to check
//! or save. Never here: files (`file_on_disk`), threads, how it is drawn.
//!
//! A text is checked when typing pauses, one check at a time. If it is correct, the lab is rebuilt from it. A newer
//! text cancels the check of an older one. A file changed by another program is handled the same way.

use std::sync::Arc;
use std::time::Duration;

use crossterm::event::KeyEvent;
use tui_input::Input;

use super::buffer::{Asking, BufferState, CheckedRevision, SourceBuffer};
use super::field::{paste, paste_selected};
use super::pending::AwaitedPlots;
use super::{App, CheckedText, EditCommand, Effect, Lab, Notification, Overlay, Page};
use crate::diagnostic::Document;

impl App {
    /// Returns the buffer being edited, while the editor is open.
    pub fn open_buffer(&self) -> Option<&SourceBuffer> {
        self.workbench.top().filter(|_| matches!(self.overlay, Some(Overlay::Workbench)))
    }

    pub(super) fn buffer(&mut self) -> Option<&mut SourceBuffer> {
        self.workbench.top_mut()
    }

    /// Returns the buffer of the system in the lab, if it has one.
    pub(super) fn own_buffer(&self) -> Option<&SourceBuffer> {
        let Some(lab) = &self.lab else {
            // A text that is edited while no system runs.
            return self
                .workbench
                .top()
                .filter(|buffer| self.page == Page::Lab && buffer.state != BufferState::Left);
        };
        self.workbench.of(&lab.loaded.name, self.file().as_deref())
    }

    /// Returns a line about the file's errors while its editor is closed.
    pub fn banner(&self) -> Option<String> {
        let buffer = self.own_buffer().filter(|_| self.overlay.is_none())?;
        let diagnostic =
            buffer.diagnostics.first().filter(|_| buffer.state == BufferState::Wrong)?;
        let (row, column) = (diagnostic.from.row + 1, diagnostic.from.column + 1);
        Some(format!(
            "{}:{row}:{column}: {}; still running the last valid version",
            buffer.title, diagnostic.message
        ))
    }

    /// Whether the result of a check is still wanted.
    pub fn awaits(&self, ticket: u64) -> bool {
        self.own_buffer().is_some_and(|buffer| buffer.awaits(ticket))
    }

    pub(super) fn edit_file(&mut self) -> Vec<Effect> {
        // The row of the editor's state is not taken by what was said of the motion before.
        self.notifications.shown.take_if(|notice| !notice.is_error());
        if self.ready_buffer().is_some() {
            self.overlay = Some(Overlay::Workbench);
        }
        Vec::new()
    }

    /// Returns the buffer of the system in the lab, as it was left.
    pub(super) fn ready_buffer(&mut self) -> Option<&mut SourceBuffer> {
        if self.lab.is_none() {
            return self.workbench.top_mut().filter(|buffer| buffer.state != BufferState::Left);
        }
        let place = self.file();
        Some(self.workbench.lay(&self.lab.as_ref()?.loaded, place))
    }

    /// Checks an unsaved text at once if it is the one that was running. Returns whether there is one.
    pub(super) fn wake(&mut self) -> bool {
        let modified = self.own_buffer().is_some_and(SourceBuffer::is_modified);
        modified && self.ready_buffer().is_some()
    }

    /// Handles a key that is typed as text.
    pub(super) fn type_into_buffer(&mut self, key: KeyEvent) {
        let page = usize::from(self.drawn.rows).saturating_sub(1);
        if let Some(buffer) = self.buffer() {
            buffer.press(key, page);
        }
    }

    /// Inserts pasted text. Returns whether all of it fitted.
    pub(super) fn paste_into_buffer(&mut self, text: &str) -> bool {
        let Some(buffer) = self.buffer() else { return true };
        match &mut buffer.asking {
            Some(Asking::Words(input)) => paste(input, text),
            Some(Asking::Name { input, whole }) => paste_selected(input, whole, text),
            None => {
                let whole = buffer.editor.paste(text);
                buffer.touch();
                whole
            }
        }
    }

    pub(super) fn work(&mut self, work: EditCommand) -> Vec<Effect> {
        let Some(buffer) = self.buffer() else { return Vec::new() };
        let changed = match work {
            EditCommand::Save => return self.save_file(),
            EditCommand::Find => {
                buffer.asking = Some(Asking::Words(Input::new(buffer.searched.clone())));
                false
            }
            EditCommand::FindNext => return self.find(),
            EditCommand::Diagnostic(sign) => {
                if !buffer.step(sign) {
                    return self.notify("There are no errors.");
                }
                false
            }
            EditCommand::Cut => buffer.editor.cut(),
            EditCommand::Copy => {
                buffer.editor.copy();
                self.notifications.show(Notification::info("Copied; Ctrl-v pastes it."));
                return Vec::new();
            }
            EditCommand::PutBack => buffer.editor.put_back(),
            EditCommand::Undo => {
                if !buffer.editor.undo() {
                    return self.notify("Nothing to undo.");
                }
                true
            }
            EditCommand::Redo => {
                if !buffer.editor.redo() {
                    return self.notify("Nothing to redo.");
                }
                true
            }
            EditCommand::Reread => {
                let Some(place) = &buffer.place else {
                    // A built-in preset has not changed.
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

    /// Shows the warning of the running text that has not been shown outside the editor, after what is shown now.
    fn show_warning(&mut self) {
        let untold = self.workbench.top_mut().and_then(|buffer| buffer.untold.take());
        if let Some(text) = untold {
            self.notifications.add(Notification::warning(text));
        }
    }

    /// Handles Esc: closes the prompt, or else the editor; the text stays. A long check is stopped.
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
        let message = match (stopped, buffer.is_modified()) {
            (true, _) => Some(format!("{} is no longer being checked; E resumes.", buffer.title)),
            (false, true) => {
                let key = if self.lab.is_some() { "E" } else { "Enter" };
                // the frame of the editor had the whole path
                let name = buffer.title.rsplit('/').next().unwrap_or(&buffer.title);
                Some(format!("{name} has unsaved changes; {key} returns to it."))
            }
            (false, false) if self.lab.is_none() => return self.leave_unchanged(),
            (false, false) => None,
        };
        if let Some(message) = message {
            self.notifications.show(Notification::info(message));
        }
        self.show_warning();
        let mut effects = if stopped { vec![Effect::StopCheck] } else { Vec::new() };
        if stopped {
            // a motion that waits for this text runs on without it
            effects.extend(self.restore());
        }
        if self.lab.is_none() {
            effects.extend(self.leave_alone());
        }
        effects
    }

    /// Handles Enter in a prompt.
    pub(super) fn accept_in_buffer(&mut self) -> Vec<Effect> {
        let Some(buffer) = self.buffer() else { return Vec::new() };
        match buffer.asking.take() {
            None => Vec::new(),
            Some(Asking::Words(input)) => {
                input.value().clone_into(&mut buffer.searched);
                if buffer.searched.is_empty() { Vec::new() } else { self.find() }
            }
            Some(Asking::Name { input, whole }) => {
                let name = input.value().trim().to_owned();
                if name.is_empty() || name.ends_with('/') {
                    buffer.asking = Some(Asking::Name { input, whole });
                    return self.notify("Give the copy a name, as my-pendulum or ./pendulum.toml.");
                }
                let text = buffer.editor.text();
                vec![Effect::SaveCopy { name, text }]
            }
        }
    }

    fn find(&mut self) -> Vec<Effect> {
        let Some(buffer) = self.buffer() else { return Vec::new() };
        let pattern = buffer.searched.clone();
        if pattern.is_empty() {
            buffer.asking = Some(Asking::Words(Input::default()));
            return Vec::new();
        }
        if buffer.editor.find(&pattern) {
            return Vec::new();
        }
        self.notify(format!("not found: `{pattern}`"))
    }

    pub(super) fn tick_buffer(&mut self, elapsed: Duration) -> Option<Effect> {
        if self.page == Page::Picker {
            return self.workbench.postpone_check().then_some(Effect::StopCheck);
        }
        let typed = self.lab.as_ref().map_or(&[][..], |lab| &lab.typed);
        self.workbench.tick(elapsed, typed)
    }

    /// Scrolls the text so that the cursor is visible on the screen that was drawn.
    pub(super) fn follow_cursor(&mut self) {
        let (rows, columns) = (self.drawn.rows.into(), self.drawn.columns.into());
        if matches!(self.overlay, Some(Overlay::Workbench))
            && let Some(buffer) = self.buffer()
        {
            buffer.scroll = buffer.follow(rows, columns);
        }
    }

    /// Handles the result of a check; if the text is correct, its system is already running.
    pub(super) fn checked(&mut self, checked: CheckedText) -> Vec<Effect> {
        let CheckedText { ticket, outcome, took } = checked;
        let mends = self.awaited.wrong_file.take().is_some();
        let warned = self.lab.as_ref().and_then(|lab| lab.loaded.warning());
        let Some(buffer) = self.buffer().filter(|buffer| buffer.awaits(ticket)) else {
            return Vec::new();
        };
        let (found, own) = buffer.end_check();
        match (outcome, found) {
            (Ok(mut loaded), found) => {
                // what was typed for an axis is no part of the text
                if loaded.document.text != own {
                    let path = loaded.document.path.clone();
                    loaded.document = Arc::new(Document::new(path, own));
                }
                if let CheckedRevision::Newest = found {
                    buffer.note(&loaded.warnings);
                    buffer.state = BufferState::Rebuilt(took);
                }
                let warning = loaded.warning();
                let is_new = warning != warned;
                if is_new {
                    buffer.untold.clone_from(&warning);
                }
                let waits = |lab: &Lab| lab.restoration.checkpoint().is_some();
                let resumes = self.lab.as_ref().is_some_and(waits);
                // a quantity typed for an axis or a section is no change of the text
                let is_quantity = self.awaited.plots.any();
                let is_open = matches!(self.overlay, Some(Overlay::Workbench));
                if !resumes && !is_open && !is_quantity {
                    let title = &loaded.document.path;
                    let time = took.map(|took| format!(" in {:.0} ms", took.as_secs_f64() * 1e3));
                    let time = time.unwrap_or_default();
                    let message = format!("{title}: rebuilt{time}; the motion continues.");
                    self.notifications.show(Notification::info(message));
                }
                if let Some(text) = warned.filter(|_| is_new) {
                    self.notifications.withdraw(&text);
                }
                // the editor shows it in its place
                if !is_open {
                    self.show_warning();
                }
                self.rebuilt(loaded)
            }
            // Errors of a text that has changed since are out of date.
            (Err(_), CheckedRevision::Older) => Vec::new(),
            (Err(diagnostics), CheckedRevision::Newest) => {
                self.awaited.plots = AwaitedPlots::default();
                if self.gives_up_typed(&diagnostics, &own) {
                    return Vec::new();
                }
                let Some(buffer) = self.buffer() else { return Vec::new() };
                // behind the text stand the quantities typed for axes
                let mut within = diagnostics;
                within.retain(|one| one.place.start <= own.len());
                buffer.is_wrong(&within);
                if mends {
                    buffer.step_to_first();
                }
                let saved = buffer.saved_as().filter(|_| buffer.unchecked);
                buffer.unchecked = false;
                if let Some(message) = saved {
                    self.notifications.show(Notification::error(message));
                }
                self.restore()
            }
        }
    }
}
