//! Changes of the system's text by keys of the lab: a ramp, a surface of section.
//!
//! In: the text, what changes it. Out: the changed text in its buffer, where it is checked and run as any change. Never here: what
//! is written into it.

use std::fmt;

use super::{App, BufferState, Effect};

impl App {
    /// Says that the system in the lab has unsaved changes from before, which do not run: a change of its text by a key would
    /// make them run as well.
    fn remind_of_what_does_not_run(&self) -> Option<String> {
        let running = &self.lab.as_ref()?.loaded.document.text;
        let buffer = self.own_buffer()?;
        let waits = buffer.state == BufferState::Left && buffer.editor.text() != *running;
        let title = &buffer.title;
        waits
            .then(|| format!("{title} has unsaved changes that do not run; E shows and runs them."))
    }

    /// Has the text of the system in the lab checked and run once more, unchanged. Where it cannot be, the message and its
    /// effects are the error.
    pub(super) fn check_again(&mut self) -> Result<(), Vec<Effect>> {
        if let Some(why) = self.remind_of_what_does_not_run() {
            return Err(self.fail(why));
        }
        let Some(buffer) = self.ready_buffer() else { return Err(Vec::new()) };
        buffer.touch_at_once(false);
        Ok(())
    }

    /// Changes the text of the system in the lab by a key; it is checked and run as any change. Where it cannot be changed,
    /// the message and its effects are the error.
    pub(super) fn change_text<E: fmt::Display>(
        &mut self,
        change: impl FnOnce(&str) -> Result<String, E>,
    ) -> Result<(), Vec<Effect>> {
        if let Some(why) = self.remind_of_what_does_not_run() {
            return Err(self.fail(why));
        }
        let Some(buffer) = self.ready_buffer() else { return Err(Vec::new()) };
        match change(&buffer.editor.text()) {
            Ok(text) => {
                buffer.editor.become_text(&text);
                buffer.touch_at_once(false);
                Ok(())
            }
            Err(why) => Err(self.fail(format!("The text cannot be changed: {why}."))),
        }
    }
}
