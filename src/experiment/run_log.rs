//! What has happened on a run: its events and impulses, and its crossings of the surfaces of section.
//!
//! In: occurrences and crossings. Out: [`RunLog`], which goes with the run to where it is resumed. Never here: when anything happens.

use super::event_log::EventLog;
use crate::analysis::CrossingLog;

#[derive(Clone, Debug)]
pub(super) struct RunLog {
    /// The events and impulses since the last restart.
    pub(super) occurrences: EventLog,
    /// The crossings of the surfaces of section since then, or since a parameter was changed.
    pub(super) crossings: CrossingLog,
}

impl RunLog {
    pub(super) fn new(surfaces: usize) -> RunLog {
        RunLog { occurrences: EventLog::default(), crossings: CrossingLog::new(surfaces) }
    }

    pub(super) fn clear(&mut self) {
        self.occurrences.clear();
        self.crossings.clear();
    }

    /// Only counts what happens from now on, without storing it.
    pub(super) fn only_count(&mut self) {
        self.occurrences.only_count();
        self.crossings.only_count();
    }

    /// Removes what happened after a time on the way with this sign, for a system with so many channels.
    pub(super) fn rewind(&mut self, time: f64, sign: f64, channels: usize) {
        self.occurrences.rewind(time, sign);
        self.crossings.rewind(time, sign, channels);
    }
}
