//! Plain reading: a frozen snapshot, to be read line by line.
//!
//! In: a snapshot. Out: the snapshot being read, the reader's line, and when it is due to be refreshed. Never here:
//! the wording.

use std::sync::Arc;
use std::time::Duration;

use crate::experiment::Snapshot;

/// The interval of automatic refreshes.
const PAUSE: Duration = Duration::from_secs(2);

/// The snapshot being read, and the reader's position. It stays unchanged until a refresh is requested.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// What the page shows until another one is asked for.
    pub snapshot: Option<Arc<Snapshot>>,
    /// The reader's line.
    pub line: usize,
    /// Whether it is refreshed automatically.
    pub automatic: bool,
    /// Whether a command was given whose result is to be shown.
    pub(super) due: bool,
    /// The time since the last refresh.
    pub(super) since: Duration,
}

impl Reading {
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
