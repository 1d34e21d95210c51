//! What is recorded of a motion beside the main one: rows, crossings of the surfaces of section, distances from the main one.
//!
//! In: observed values, at the times of the main motion's rows. Out: the record as it is seen at a time. Never here: how the
//! motion moves.

use std::sync::Arc;

use super::Trail;
use super::recorder::Recorder;
use crate::analysis::{CrossingLog, DistanceHistory};
use crate::model::EventAction;
use crate::system::System;

/// A row of the main motion that a companion has yet to reach: its time, and the canonical variables.
pub(super) type DueRow = (f64, Arc<[f64]>);

pub(super) struct CompanionRecord {
    /// The value of each channel where it has come to.
    pub(super) values: Vec<f64>,
    pub(super) rows: Recorder,
    pub(super) crossings: CrossingLog,
    pub(super) separation: Arc<DistanceHistory>,
}

pub(super) struct RecordSeen {
    pub(super) time: f64,
    pub(super) values: Arc<[f64]>,
    pub(super) trail: Trail,
    pub(super) crossings: CrossingLog,
}

impl CompanionRecord {
    /// An empty record, whose rows take at most `numbers` numbers.
    pub(super) fn new(system: &System, numbers: usize) -> CompanionRecord {
        let channels = system.channels().len();
        let events = system.discontinuities().events.iter();
        let surfaces =
            events.filter(|event| matches!(event.action.written(), Some(EventAction::Section(_))));
        CompanionRecord {
            values: vec![f64::NAN; channels],
            rows: Recorder::bounded(channels, numbers),
            crossings: CrossingLog::new(surfaces.count()),
            separation: Arc::default(),
        }
    }

    /// Forgets everything; the next row is due after a time.
    pub(super) fn clear(&mut self, time: f64) {
        self.rows.restart(time);
        self.crossings.clear();
        self.separation = Arc::default();
    }

    /// Forgets the rows and crossings after a time.
    pub(super) fn rewind(&mut self, time: f64) {
        self.rows.rewind(time);
        self.crossings.rewind(time, 1.0, self.values.len());
    }

    /// Adds a row at the time of one of the main motion, with the distance of the canonical `variables` from it.
    pub(super) fn add_row(
        &mut self,
        (time, main): &DueRow,
        variables: &[usize],
        periods: &[Option<f64>],
    ) {
        self.rows.insert(*time, &self.values);
        let own: Vec<f64> = variables.iter().map(|&i| self.values[i]).collect();
        Arc::make_mut(&mut self.separation).add(*time, main, &own, periods);
    }

    pub(super) fn add_crossing(&mut self, surface: usize, time: f64) {
        self.crossings.push(surface, time, &self.values);
    }

    /// The record of a motion that has come to `time`, as it is seen at the time `now` of the main motion, which may have been
    /// carried back.
    pub(super) fn seen(&self, time: f64, now: f64) -> RecordSeen {
        let whole = self.rows.trail();
        let back = (time > now).then(|| whole.until(now));
        let row = back.as_ref().and_then(|trail| trail.row(trail.len().checked_sub(1)?));
        let (time, values) = row.map_or((time, self.values.as_slice()), |row| (row[0], &row[1..]));
        let values = values.into();
        let mut crossings = self.crossings.clone();
        if back.is_some() {
            crossings.rewind(now, 1.0, self.values.len());
        }
        RecordSeen { time, values, trail: back.unwrap_or(whole), crossings }
    }
}
