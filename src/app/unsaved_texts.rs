//! Texts with unsaved changes: what is said of them, and what keeps the program from ending without them.
//!
//! In: the workbench. Out: sentences, and the end of the program. Never here: how a text is saved.

use super::{App, Effect, Notification, Unsaved};

impl App {
    /// Returns the unsaved texts of all systems.
    pub fn unsaved(&self) -> Vec<Unsaved> {
        self.workbench.unsaved()
    }

    /// Ends the program. If a text would be lost, the user has to ask twice.
    pub(super) fn quit(&mut self) -> Vec<Effect> {
        let Some(message) = self.loss().filter(|_| !self.workbench.keeps) else {
            return vec![Effect::Quit];
        };
        if self.notifications.shown.as_ref().is_some_and(|notice| notice.text == message) {
            return vec![Effect::Quit];
        }
        self.fail(message)
    }

    /// Cancels the end of the program because a text could not be stored.
    pub fn stay(&mut self) {
        self.workbench.keeps = false;
        self.notifications.shown = self.loss().map(Notification::error);
    }

    /// Returns a sentence about what would be lost.
    fn loss(&self) -> Option<String> {
        let text = self.workbench.unsaved().into_iter().next()?;
        Some(format!("{} has unsaved changes; quit again to discard them.", text.title))
    }

    /// Reminds the user of an unsaved text of the system in the lab.
    pub(super) fn remind(&mut self) {
        if let Some(buffer) = self.own_buffer().filter(|buffer| buffer.is_modified()) {
            let message = format!("{} has unsaved changes; E shows them.", buffer.title);
            self.notifications.show(Notification::info(message));
        }
    }
}
