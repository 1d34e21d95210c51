//! Whether a motion continues: running or paused, ended, or unable to continue.
//!
//! In: what has happened to it. Out: its [`Status`]. Never here: the motion itself.

use super::snapshot::{Failure, Status};

/// What decides whether time runs.
pub(super) struct RunState {
    /// Whether the user lets it run.
    pub(super) running: bool,
    /// Why the motion cannot continue.
    pub(super) fault: Option<Failure>,
    /// The event that ended the motion.
    pub(super) ended: Option<String>,
    /// Whether the motion was resumed from a checkpoint.
    pub(super) restored: bool,
}

impl RunState {
    pub(super) fn status(&self) -> Status {
        match (&self.fault, &self.ended) {
            (Some(fault), _) => Status::Failed(fault.clone()),
            (None, Some(event)) => Status::Ended(event.clone()),
            (None, None) if self.running => Status::Running,
            (None, None) => Status::Paused,
        }
    }
}
