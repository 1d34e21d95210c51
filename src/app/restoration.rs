//! The motion that the experiment is to restore: of a session, of an undone change, or of a text that was rebuilt.
//!
//! In: checkpoints, snapshots. Out: the checkpoint to restore, and which snapshots are of it. Never here: how a motion is restored.

use crate::experiment::{Checkpoint, Snapshot, Status};
use crate::preset::law_digest;

/// A motion that the experiment is to restore, until it has.
#[derive(Clone, Debug, Default)]
pub(super) struct Restoration {
    /// The motion that the experiment is to restore now.
    awaited: Option<Checkpoint>,
    /// A digest of the law of motion under which it was recorded; `None` for that of the text.
    law: Option<String>,
    /// Where the motion is to continue once the text is rebuilt; until then nothing later is seen.
    after_rebuild: Option<Checkpoint>,
}

impl Restoration {
    /// Awaits a motion recorded under the law with this digest, or under that of the text.
    pub(super) fn begin(&mut self, checkpoint: Checkpoint, law: Option<String>) {
        (self.awaited, self.law) = (Some(checkpoint), law);
    }

    /// Awaits a motion that continues once the text is rebuilt; one that waits already stays.
    pub(super) fn begin_after_rebuild(&mut self, checkpoint: Checkpoint) {
        self.after_rebuild.get_or_insert(checkpoint);
    }

    /// No text is waited for any longer: what waited for one is to be restored now.
    pub(super) fn end_wait(&mut self) {
        self.awaited = self.after_rebuild.take().or(self.awaited.take());
    }

    /// No motion waits for a text any more.
    pub(super) fn forget_rebuild(&mut self) {
        self.after_rebuild = None;
    }

    pub(super) fn waits_for_rebuild(&self) -> bool {
        self.after_rebuild.is_some()
    }

    /// Returns the motion that is awaited, now or once the text is rebuilt.
    pub(super) fn checkpoint(&self) -> Option<&Checkpoint> {
        self.after_rebuild.as_ref().or(self.awaited.as_ref())
    }

    /// Returns the digest of the law under which the awaited motion was recorded, if it is not that of the text.
    pub(super) fn law(&self) -> Option<&String> {
        self.law.as_ref().filter(|_| self.awaited.is_some())
    }

    /// Whether the awaited motion was recorded under another law than that of this text.
    pub(super) fn is_of_another_law(&self, text: &str) -> bool {
        self.law.is_some() && self.law != law_digest(text)
    }

    /// Returns the motion to restore now; if it was recorded under another law than that of this text, it says so.
    pub(super) fn under_the_law_of(&self, text: &str) -> Option<Checkpoint> {
        let awaited = self.awaited.clone()?;
        let differs = awaited.changed.is_none() && self.is_of_another_law(text);
        Some(if differs { awaited.with_another_law("the text") } else { awaited })
    }

    /// Takes in a snapshot. Returns whether it may be shown: it is not of the motion before.
    pub(super) fn see(&mut self, snapshot: &Snapshot) -> bool {
        let stopped = matches!(snapshot.status, Status::Failed(_));
        let waits = self.after_rebuild.is_some() || self.awaited.is_some() && !snapshot.restored;
        if waits && !stopped {
            return false;
        }
        if snapshot.restored {
            (self.awaited, self.law) = (None, None);
        }
        true
    }
}
