//! The plain reading: what was seen at one moment, to be read line by line in peace.
//!
//! In: a snapshot. Out: the snapshot read, the line the reader is at, and when it is to be read anew. Never here: the
//! words.

use std::sync::Arc;
use std::time::Duration;

use super::{Action, App, Effect, Notification, Page};
use crate::experiment::Snapshot;

/// Between two readings where they come by themselves.
const PAUSE: Duration = Duration::from_secs(2);

/// What is read, and where the reader is. It stays as it is until it is asked for anew.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// What was seen.
    pub snapshot: Option<Arc<Snapshot>>,
    /// The line the reader is at.
    pub line: usize,
    /// Whether it is read anew by itself.
    pub automatic: bool,
    /// A command was given, and what comes of it is wanted.
    due: bool,
    /// Since it was read.
    since: Duration,
}

impl Reading {
    /// Time has passed.
    pub(super) fn tick(&mut self, elapsed: Duration) {
        self.since = self.since.saturating_add(elapsed);
    }

    /// Something new is seen; it is read if it was asked for.
    pub(super) fn see(&mut self, snapshot: &Arc<Snapshot>) {
        if self.due || self.automatic && self.since >= PAUSE {
            self.snapshot = Some(Arc::clone(snapshot));
            (self.due, self.since) = (false, Duration::ZERO);
        }
    }
}

impl App {
    /// Reads the present, from the first line.
    pub(super) fn read(&mut self) {
        let automatic = self.reading.automatic;
        let snapshot = self.lab.as_ref().and_then(|lab| lab.snapshot.clone());
        self.reading = Reading { snapshot, automatic, ..Reading::default() };
    }

    /// The actions of the page.
    pub(super) fn read_by(&mut self, action: Action) -> Vec<Effect> {
        if action == Action::ReadAnew {
            let line = self.reading.line;
            self.read();
            self.reading.line = line;
        } else {
            self.reading.automatic = !self.reading.automatic;
            self.notice = Some(Notification::info(if self.reading.automatic {
                "It is read anew every two seconds."
            } else {
                "It stays as it is until Enter."
            }));
        }
        Vec::new()
    }

    /// What is done on the page shows in what is read.
    pub(super) fn expect(&mut self, effects: &[Effect]) {
        let told = effects.iter().any(|effect| matches!(effect, Effect::Tell(_)));
        self.reading.due |= told && self.page == Page::Plain;
    }
}
