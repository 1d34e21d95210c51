//! The file of the system in the lab: where it is, saving it, and what another program does to it.
//!
//! In: the results of saves, and changes on disk. Out: the changed buffer, and what to save. Never here: files themselves.

use std::path::PathBuf;

use super::buffer::{Asking, BufferState};
use super::{App, Effect, Lab, Notification, SaveError};
use crate::preset::is_path;

impl App {
    /// Returns the file of the loaded system, if it has one.
    pub fn file(&self) -> Option<PathBuf> {
        self.place_of(&self.lab.as_ref()?.loaded.name)
    }

    pub(super) fn save_file(&mut self) -> Vec<Effect> {
        let Some(buffer) = self.buffer() else { return Vec::new() };
        let text = buffer.editor.text();
        match &buffer.place {
            Some(place) => {
                let known = (!buffer.overwrites).then(|| buffer.on_disk.clone());
                vec![Effect::Save { place: place.clone(), text, known }]
            }
            None => {
                let copy = format!("my-{}", buffer.name);
                buffer.asking = Some(Asking::name(copy));
                Vec::new()
            }
        }
    }

    /// Handles the result of saving a text.
    pub(super) fn saved_file(&mut self, outcome: Result<(PathBuf, String), SaveError>) {
        let Some(buffer) = self.workbench.top_mut() else { return };
        buffer.overwrites = outcome == Err(SaveError::Changed);
        self.notifications.show(match outcome {
            Ok((place, text)) => {
                let shown = place.display().to_string();
                buffer.on_disk = text;
                let renamed = buffer.place.as_ref() != Some(&place);
                if renamed {
                    // From now on the copy is the open file.
                    let here = |lab: &&mut Lab| lab.loaded.name == buffer.name;
                    let name = if is_path(&shown) { shown.clone() } else { format!("./{shown}") };
                    if let Some(lab) = self.lab.as_mut().filter(here) {
                        lab.loaded.name.clone_from(&name);
                    }
                    (buffer.name, buffer.title) = (name, shown.clone());
                    buffer.place = Some(place);
                }
                let saved = match (buffer.saved_as(), buffer.state) {
                    (Some(message), BufferState::Wrong) => Notification::error(message),
                    (message, _) => Notification::info(message.unwrap_or_default()),
                };
                let unchecked = buffer.state == BufferState::Changed;
                if renamed && buffer.state != BufferState::Wrong {
                    // a text without a title has that of its file
                    buffer.touch_at_once(false);
                }
                buffer.unchecked = unchecked;
                saved
            }
            Err(SaveError::Changed) => Notification::error(format!(
                "{} was changed by another program: Ctrl-s again overwrites it, Ctrl-o reloads it.",
                buffer.title
            )),
            Err(SaveError::Exists(place)) => {
                buffer.asking = Some(Asking::name(place.display().to_string()));
                Notification::error(format!(
                    "{} already exists; choose another name.",
                    place.display()
                ))
            }
            Err(SaveError::Refused(why)) => Notification::error(why),
        });
    }

    /// Handles a new text of the file on disk; `asked` says whether the user asked to read it.
    pub(super) fn changed_on_disk(&mut self, text: &str, asked: bool) {
        if let Some(buffer) = self.own_buffer().filter(|buffer| !asked && buffer.is_modified()) {
            if buffer.on_disk != text {
                let message = format!(
                    "{} was changed by another program; your text has unsaved changes.",
                    buffer.title
                );
                self.notifications.show(Notification::error(message));
            }
            return;
        }
        let Some(buffer) = self.ready_buffer() else { return };
        text.clone_into(&mut buffer.on_disk);
        if buffer.editor.text() != text {
            buffer.editor.become_text(text);
            buffer.touch_at_once(!asked);
        }
        buffer.overwrites = false;
    }

    /// Handles the disappearance or return of the watched file.
    pub(super) fn found_on_disk(&mut self, there: bool) {
        let Some(lab) = &self.lab else { return };
        let title = &lab.loaded.document.path;
        self.notifications.show(if there {
            Notification::info(format!("{title} exists again."))
        } else {
            Notification::error(format!(
                "{title} no longer exists; its last valid version keeps running."
            ))
        });
    }
}
