//! The motions beside the main one: added, pinned, cleared, and carried along.
//!
//! Each follows the main motion: it is recorded at the same times, follows its parameters and its method unless it was
//! pinned, and begins again when the main motion does. What they cost is bounded: there are at most [`MOST_COMPANIONS`],
//! they are advanced after the main motion, and all together take no more steps in a slice of work than the main motion
//! may; one that needs more is behind until it has caught up. Their rows together take as much memory as those of the
//! main motion.
//!
//! In: the main motion's rows, and commands. Out: [`Companion`]s. Never here: threads, or how they are drawn.

use std::sync::Arc;

use super::Companion;
use super::companion_motion::CompanionMotion;
use super::companion_record::DueRow;
use crate::analysis::DistanceHistory;

/// The most motions beside the main one.
pub const MOST_COMPANIONS: usize = 6;

#[derive(Default)]
pub(super) struct Companions {
    pub(super) all: Vec<CompanionMotion>,
    /// The channels of the canonical variables, and their periods.
    pub(super) variables: Vec<usize>,
    pub(super) periods: Vec<Option<f64>>,
}

impl Companions {
    /// The first number that is free.
    pub(super) fn number(&self) -> Option<usize> {
        (1..=MOST_COMPANIONS).find(|n| self.all.iter().all(|one| one.number != *n))
    }

    /// The main motion was recorded with these values.
    pub(super) fn expect(&mut self, time: f64, values: &[f64]) {
        if !self.all.is_empty() {
            let due = self.due(time, values);
            self.all.iter_mut().for_each(|one| one.expect(due.clone()));
        }
    }

    pub(super) fn due(&self, time: f64, values: &[f64]) -> DueRow {
        (time, self.variables.iter().map(|&i| values[i]).collect())
    }

    /// Whether one has not reached a time.
    pub(super) fn are_behind(&self, time: f64) -> bool {
        self.all.iter().any(|one| one.is_behind(time))
    }

    /// Advances all to a time, in at most `budget` steps together. Those that are behind most are the first.
    pub(super) fn advance(&mut self, time: f64, ahead: f64, budget: u64) {
        let Companions { all, variables, periods } = self;
        let count = all.len() as u64;
        let mut left = budget;
        for (index, one) in all.iter_mut().enumerate() {
            let mut share = (left / (count - index as u64)).max(1);
            let before = share;
            one.advance(time, ahead, &mut share, (variables, periods));
            left = left.saturating_sub(before - share);
        }
    }

    /// What is seen of them at the time of the main motion.
    pub(super) fn shown(&self, now: f64) -> Arc<[Companion]> {
        self.all.iter().map(|one| one.shown(now)).collect()
    }

    pub(super) fn separations(&self) -> Arc<[(usize, Arc<DistanceHistory>)]> {
        self.all.iter().map(|one| (one.number, one.separation())).collect()
    }

    pub(super) fn clear(&mut self) {
        self.all.clear();
    }

    /// The main motion was carried back to a time.
    pub(super) fn forget_rows_after(&mut self, time: f64) {
        self.all.iter_mut().for_each(|one| one.forget_rows_after(time));
    }

    pub(super) fn forget_crossings(&mut self) {
        self.all.iter_mut().for_each(CompanionMotion::forget_crossings);
    }
}
