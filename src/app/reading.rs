//! Plain reading: a frozen snapshot, to be read line by line.
//!
//! In: a snapshot. Out: the snapshot being read, the reader's line, and when it is due to be refreshed. Never here:
//! the wording.

use std::sync::Arc;
use std::time::Duration;

use super::{Action, App, Effect, Notification, Page};
use crate::experiment::Snapshot;

/// The interval of automatic refreshes.
const PAUSE: Duration = Duration::from_secs(2);

/// The snapshot being read, and the reader's position. It stays unchanged until a refresh is requested.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// The snapshot.
    pub snapshot: Option<Arc<Snapshot>>,
    /// The reader's line.
    pub line: usize,
    /// Whether it is refreshed automatically.
    pub automatic: bool,
    /// Whether a command was given whose result is to be shown.
    due: bool,
    /// The time since the last refresh.
    since: Duration,
}

impl Reading {
    /// Advances the time.
    pub(super) fn tick(&mut self, elapsed: Duration) {
        self.since = self.since.saturating_add(elapsed);
    }

    /// Takes in a new snapshot if a refresh is due.
    pub(super) fn see(&mut self, snapshot: &Arc<Snapshot>) {
        if self.due || self.automatic && self.since >= PAUSE {
            self.snapshot = Some(Arc::clone(snapshot));
            (self.due, self.since) = (false, Duration::ZERO);
        }
    }
}

impl App {
    /// Reads the current state, from the first line.
    pub(super) fn read(&mut self) {
        let automatic = self.reading.automatic;
        let snapshot = self.lab.as_ref().and_then(|lab| lab.snapshot.clone());
        self.reading = Reading { snapshot, automatic, ..Reading::default() };
    }

    /// Carries out the actions of the page.
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

    /// Schedules a refresh if these effects, caused on this page, include a command.
    pub(super) fn expect(&mut self, effects: &[Effect]) {
        let commanded = effects.iter().any(|effect| matches!(effect, Effect::Tell(_)));
        self.reading.due |= commanded && self.page == Page::Plain;
    }
}
