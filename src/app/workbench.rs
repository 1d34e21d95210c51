//! The workbench: the source buffers of all systems whose files are being edited. The current one is on top.
//!
//! In: systems, and restored texts. Out: their buffers, and the texts to be stored. Never here: what a key does to
//! a text (`edit`), or the state of one buffer (`buffer`).

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::buffer::{BufferState, SourceBuffer, Unsaved};
use super::{Effect, Loaded};
use crate::preset::NewObservable;

/// The source buffers.
#[derive(Clone, Debug, Default)]
pub struct Workbench {
    /// Whether unsaved texts are stored beyond the end of the program.
    pub keeps: bool,
    /// The buffers; the last one is on top.
    buffers: Vec<SourceBuffer>,
    checks: u64,
}

impl Workbench {
    /// Returns the buffer on top.
    pub fn top(&self) -> Option<&SourceBuffer> {
        self.buffers.last()
    }

    /// Returns the buffer on top, mutably.
    pub fn top_mut(&mut self) -> Option<&mut SourceBuffer> {
        self.buffers.last_mut()
    }

    /// Returns the unsaved texts of all systems.
    pub fn unsaved(&self) -> Vec<Unsaved> {
        self.buffers.iter().filter_map(SourceBuffer::unsaved).collect()
    }

    /// Adds restored texts below the others; they wait until their systems are opened.
    pub fn put(&mut self, texts: Vec<Unsaved>) {
        self.buffers.splice(0..0, texts.into_iter().map(SourceBuffer::of_unsaved));
    }

    /// Returns a number that changes with every change of a text.
    pub fn revision(&self) -> u64 {
        self.buffers.iter().map(SourceBuffer::revision).sum()
    }

    /// Returns the buffer of a system, if it has one.
    pub(super) fn of(&self, name: &str, place: Option<&Path>) -> Option<&SourceBuffer> {
        self.buffers.iter().rfind(|buffer| buffer.is_of(name, place))
    }

    /// Moves the buffer of the running system to the top, creating it if there is none.
    pub(super) fn lay(&mut self, loaded: &Loaded, place: Option<PathBuf>) -> &mut SourceBuffer {
        let at = self.buffers.iter().rposition(|s| s.is_of(&loaded.name, place.as_deref()));
        let mut buffer = match at {
            Some(at) => self.buffers.remove(at),
            None => SourceBuffer::new(loaded, place),
        };
        buffer.name.clone_from(&loaded.name);
        if buffer.state == BufferState::Left {
            buffer.touch_at_once(false);
        }
        self.buffers.retain(SourceBuffer::is_modified);
        let top = self.buffers.len();
        self.buffers.push(buffer);
        &mut self.buffers[top]
    }

    /// Puts a text on top that no running system has, or what is kept of it unsaved, and has it checked at once.
    pub(super) fn lay_text(&mut self, text: Unsaved) {
        let at = self.buffers.iter().rposition(|s| s.is_of(&text.name, text.place.as_deref()));
        let mut buffer = match at {
            Some(at) => self.buffers.remove(at),
            None => SourceBuffer::of_unsaved(text),
        };
        buffer.touch_at_once(false);
        self.buffers.push(buffer);
    }

    /// Marks all buffers as left, since another system was loaded; no check is awaited any more.
    pub(super) fn clear(&mut self) {
        self.buffers.retain(SourceBuffer::is_modified);
        self.buffers.iter_mut().for_each(SourceBuffer::leave);
    }

    /// Postpones the check of the top buffer, since the editor was closed. Returns whether a check was running.
    pub(super) fn postpone_check(&mut self) -> bool {
        self.buffers.last_mut().is_some_and(SourceBuffer::postpone_check)
    }

    /// Advances the time for the top buffer. Returns the check that is now due, if there is one: of the text with the quantities
    /// that the view has besides.
    pub(super) fn tick(&mut self, elapsed: Duration, typed: &[NewObservable]) -> Option<Effect> {
        let buffer = self.buffers.last_mut().filter(|buffer| buffer.state != BufferState::Left)?;
        if !buffer.tick(elapsed) {
            return None;
        }
        self.checks += 1;
        let own = buffer.begin_check(self.checks);
        let title = buffer.title.clone();
        let text = typed.iter().fold(own, |text, observable| observable.behind(&text));
        Some(Effect::Check { ticket: self.checks, title, text })
    }
}
