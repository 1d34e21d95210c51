//! Changes sent to the experiment and not yet confirmed.
//!
//! In: changes, snapshots. Out: what was requested last. Never here: how a change is made.

use crate::experiment::Snapshot;
use crate::integrate::Settings;
use crate::system::InitialOverride;

/// Changes sent to the experiment and not yet confirmed by a snapshot, except single values.
#[derive(Clone, Debug, Default)]
pub(super) struct PendingChanges {
    pub(super) method: Option<&'static str>,
    pub(super) settings: Option<Settings>,
    pub(super) given: Option<Vec<InitialOverride>>,
}

impl PendingChanges {
    /// Removes the changes that a snapshot confirms.
    pub(super) fn see(&mut self, snapshot: &Snapshot) {
        self.method.take_if(|value| *value == snapshot.method.name);
        self.settings.take_if(|value| *value == snapshot.setup.settings);
        self.given.take_if(|value| *value == snapshot.setup.overrides);
    }
}
