//! Texts edited while no system runs: a file that is wrong, and a new system.
//!
//! In: the name of a file with errors, its text; the template. Out: the editor, at the first error; the lab, as soon as
//! a text has none. Never here: how a text is checked, or files.

use std::path::PathBuf;

use super::buffer::Unsaved;
use super::session::NEW_SYSTEM;
use super::{Above, App, Effect, Lab, Loaded, Overlay, Page};
use crate::experiment::Command;
use crate::preset::{CatalogEntry, template};

impl App {
    /// Asks for the text of the file whose errors are shown.
    pub(super) fn mend_file(&mut self) -> Vec<Effect> {
        let Some(name) = self.failed_system().map(str::to_owned) else { return Vec::new() };
        let Some(place) = self.place_of(&name) else {
            return self.notify("This system has no file to edit.");
        };
        self.awaited.wrong_file = Some(name);
        vec![Effect::Reread(place)]
    }

    /// The file of a system of this name, if it has one.
    pub(super) fn place_of(&self, name: &str) -> Option<PathBuf> {
        CatalogEntry::place_among(&self.picker.entries, name)
    }

    /// Opens the editor with the text of a wrong file; its check says where the errors are.
    pub(super) fn edit_wrong(&mut self, name: String, text: &str) {
        let place = self.place_of(&name);
        let title = place.as_ref().map_or_else(|| name.clone(), |p| p.display().to_string());
        let (text, of) = (text.to_owned(), text.to_owned());
        self.edit_alone(Unsaved { name, title, place, text, of });
    }

    /// Opens the editor with a system of one's own to begin from; nothing is written until it is saved.
    pub(super) fn new_system(&mut self) -> Vec<Effect> {
        let title = format!("{NEW_SYSTEM}.toml");
        let (text, of) = (template().to_owned(), template().to_owned());
        self.edit_alone(Unsaved { name: NEW_SYSTEM.to_owned(), title, place: None, text, of });
        // It opens at the law, as every system does.
        if let Some(buffer) = self.workbench.top_mut()
            && let Some(before) = template().find("\nL = ")
            && !buffer.is_modified()
        {
            let law = buffer.editor.caret_at(before + 1);
            buffer.editor.go(law);
        }
        Vec::new()
    }

    /// Leaves the system in the lab, and edits a text that becomes the next one.
    fn edit_alone(&mut self, text: Unsaved) {
        // The session that is left can be continued from the list of systems.
        if self.page != Page::Picker {
            self.go(Page::Picker);
        }
        self.end_group();
        self.mouse.resumes = false;
        self.awaited.system = None;
        self.workbench.clear();
        self.workbench.lay_text(text);
        (self.lab, self.picker.error) = (None, None);
        (self.page, self.overlay, self.text.scroll) = (Page::Lab, Some(Overlay::Workbench), 0);
    }

    /// Begins the motion of a text edited without a system, as soon as it has no errors.
    pub(super) fn mended(&mut self, loaded: Loaded) -> Vec<Effect> {
        self.lab = Some(Lab::new(loaded));
        self.meter.forget();
        vec![Effect::Execute(Command::Play)]
    }

    /// Leaves the editor where no system runs: the list of systems is below, at the row of the text if it is not saved.
    pub(super) fn leave_alone(&mut self) -> Vec<Effect> {
        let notice = self.notifications.shown.take();
        self.go(Page::Picker);
        self.notifications.shown = notice;
        self.list_unsaved();
        self.picker.point_above(Above::Unsaved);
        self.picker.take().map(|name| self.ask(name, false)).into_iter().collect()
    }

    /// Leaves an unchanged text where no system runs: its file is read again, and its errors are shown as before. A new
    /// system has no file.
    pub(super) fn leave_unchanged(&mut self) -> Vec<Effect> {
        let file = self.workbench.top().filter(|buffer| buffer.place.is_some());
        let Some(name) = file.map(|buffer| buffer.name.clone()) else { return self.leave_alone() };
        self.go(Page::Picker);
        self.picker.select(&name);
        vec![self.ask(name, true)]
    }

    /// Lists the last unsaved text among the systems, unless the session is the one that runs it.
    pub(super) fn list_unsaved(&mut self) {
        let title = self.waiting_text().map(|text| text.title);
        let is_new = title.is_some() && self.picker.unsaved.is_none();
        self.picker.unsaved = title;
        if is_new && self.picker.is_at_its_start() {
            self.picker.point_above(Above::Unsaved);
        }
    }

    /// The last unsaved text to which no other row leads.
    fn waiting_text(&self) -> Option<Unsaved> {
        let session = self.picker.session().filter(|session| session.edited);
        let continued = session.map(|session| session.open.as_str());
        let texts = self.workbench.unsaved().into_iter();
        texts.rev().find(|text| Some(text.name.as_str()) != continued)
    }

    pub(super) fn return_to_text(&mut self) -> Vec<Effect> {
        if let Some(text) = self.waiting_text() {
            self.edit_alone(text);
        }
        Vec::new()
    }

    /// Returns the name of the system that a checked text is to have.
    pub fn checked_system(&self) -> Option<String> {
        match &self.lab {
            Some(lab) => Some(lab.loaded.name.clone()),
            None => self.own_buffer().map(|buffer| buffer.name.clone()),
        }
    }
}
