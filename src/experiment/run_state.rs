//! Whether a motion continues: running or paused, ended, or unable to continue.
//!
//! In: what has happened to it. Out: its [`Status`]. Never here: the motion itself.

use super::snapshot::{RunError, Status};

/// What decides whether time runs.
pub(super) struct RunState {
    /// Whether the user lets it run.
    pub(super) running: bool,
    /// Why the motion cannot continue.
    pub(super) error: Option<RunError>,
    /// The event that ended the motion.
    pub(super) ended: Option<String>,
    /// Whether the motion was resumed from a checkpoint.
    pub(super) restored: bool,
}

impl RunState {
    pub(super) fn status(&self) -> Status {
        match (&self.error, &self.ended) {
            (Some(error), _) => Status::Failed(error.clone()),
            (None, Some(event)) => Status::Ended(event.clone()),
            (None, None) if self.running => Status::Running,
            (None, None) => Status::Paused,
        }
    }
}
