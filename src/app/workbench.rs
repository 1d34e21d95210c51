//! The workbench: the sheets of all systems whose files are being edited. The one at work lies on top.
//!
//! In: systems, and texts that were kept. Out: their sheets, and the texts to be kept. Never here: what a key does to a
//! text (`edit`), or what is known of one (`buffer`).

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::buffer::{SourceBuffer, State, Unsaved};
use super::{Effect, Loaded};

/// The sheets.
#[derive(Clone, Debug, Default)]
pub struct Workbench {
    /// Whether texts that are not saved are kept beyond the end of the program.
    pub keeps: bool,
    /// The last one lies on top.
    buffers: Vec<SourceBuffer>,
    /// Counts the checks of all sheets.
    checks: u64,
}

impl Workbench {
    /// The sheet on top.
    pub fn top(&self) -> Option<&SourceBuffer> {
        self.buffers.last()
    }

    /// The same, to be changed.
    pub fn top_mut(&mut self) -> Option<&mut SourceBuffer> {
        self.buffers.last_mut()
    }

    /// The texts that are not saved, of all systems.
    pub fn unsaved(&self) -> Vec<Unsaved> {
        self.buffers.iter().filter_map(SourceBuffer::unsaved).collect()
    }

    /// Takes texts that were kept; they wait below the others until their systems are open.
    pub fn put(&mut self, texts: Vec<Unsaved>) {
        self.buffers.splice(0..0, texts.into_iter().map(SourceBuffer::of_unsaved));
    }

    /// A number that changes with every change of a text.
    pub fn revision(&self) -> u64 {
        self.buffers.iter().map(SourceBuffer::revision).sum()
    }

    /// The sheet of a system, if it has one.
    pub(super) fn of(&self, name: &str, place: Option<&Path>) -> Option<&SourceBuffer> {
        self.buffers.iter().rfind(|buffer| buffer.is_of(name, place))
    }

    /// Puts the sheet of the system that runs on top, a fresh one where it has none.
    pub(super) fn lay(&mut self, loaded: &Loaded, place: Option<PathBuf>) -> &mut SourceBuffer {
        let at = self.buffers.iter().rposition(|s| s.is_of(&loaded.name, place.as_deref()));
        let mut buffer = match at {
            Some(at) => self.buffers.remove(at),
            None => SourceBuffer::new(loaded, place),
        };
        buffer.name.clone_from(&loaded.name);
        if buffer.state == State::Left {
            buffer.touch_at_once(false);
        }
        self.buffers.retain(SourceBuffer::is_modified);
        let top = self.buffers.len();
        self.buffers.push(buffer);
        &mut self.buffers[top]
    }

    /// A system was loaded: what is known of any text is no longer so, and no check is waited for.
    pub(super) fn clear(&mut self) {
        self.buffers.retain(SourceBuffer::is_modified);
        self.buffers.iter_mut().for_each(SourceBuffer::leave);
    }

    /// No text is looked at: a check under way is put off; whether there was one.
    pub(super) fn put_off(&mut self) -> bool {
        self.buffers.last_mut().is_some_and(SourceBuffer::put_off)
    }

    /// Time has passed for the sheet on top: the text to be checked now, if there is one.
    pub(super) fn tick(&mut self, elapsed: Duration) -> Option<Effect> {
        let buffer = self.buffers.last_mut().filter(|buffer| buffer.state != State::Left)?;
        if !buffer.tick(elapsed) {
            return None;
        }
        self.checks += 1;
        buffer.begin_check(self.checks);
        let (title, text) = (buffer.title.clone(), buffer.editor.text());
        Some(Effect::Check { ticket: self.checks, title, text })
    }
}
