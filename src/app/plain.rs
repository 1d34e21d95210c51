//! What the keys do on the page of plain text.
//!
//! In: actions. Out: the snapshot to be read. Never here: the wording.

use super::{Action, App, Effect, Notification, Page, Reading};

impl App {
    /// Reads the current state, from the first line.
    pub(super) fn read(&mut self) {
        let automatic = self.reading.automatic;
        let snapshot = self.lab.as_ref().and_then(|lab| lab.snapshot.clone());
        self.reading = Reading { snapshot, automatic, ..Reading::default() };
    }

    pub(super) fn read_by(&mut self, action: Action) -> Vec<Effect> {
        if action == Action::ReadAnew {
            let line = self.reading.line;
            self.read();
            self.reading.line = line;
        } else {
            self.reading.automatic = !self.reading.automatic;
            self.notifications.show(Notification::info(if self.reading.automatic {
                "It is reread every two seconds."
            } else {
                "It is left unchanged until Enter."
            }));
        }
        Vec::new()
    }

    /// Schedules a refresh if these effects, caused on this page, include a command.
    pub(super) fn expect(&mut self, effects: &[Effect]) {
        let commanded = effects.iter().any(|effect| matches!(effect, Effect::Execute(_)));
        self.reading.due |= commanded && self.page == Page::Plain;
    }
}
