//! The distances of a gauge from its reference, and the drift they are.
//!
//! In: distances, and what moved at that time. Out: the greatest of them, and their history. Never here: what a distance is measured
//! from, or which of them rounding explains.

use super::mean::Mean;
use crate::analysis::{History, LEFT};

/// The distances from the reference since it was taken.
#[derive(Clone, Debug)]
pub(super) struct DriftRecord {
    pub(super) last: f64,
    /// The mean size of the moving part.
    pub(super) moving: Mean,
    /// The greatest moving part so far.
    pub(super) most_moving: f64,
    /// The greatest distance.
    pub(super) farthest: f64,
    /// The greatest drift: a distance over the mean moving part up to that time, or over the moving part at that time
    /// if it was greater.
    pub(super) worst: f64,
    /// What that is relative to.
    pub(super) worst_scale: f64,
    /// When the drift first exceeded the limit.
    pub(super) left: Option<f64>,
    /// The first distances beyond rounding, as long as it is not known how much moves.
    pub(super) early: Early,
    pub(super) distances: History,
}

impl DriftRecord {
    pub(super) fn beginning(moving: Mean) -> DriftRecord {
        DriftRecord {
            last: 0.0,
            moving,
            most_moving: 0.0,
            farthest: 0.0,
            worst: 0.0,
            worst_scale: 0.0,
            left: None,
            early: Early::default(),
            distances: History::new(),
        }
    }

    /// Records how much moves at a time.
    pub(super) fn see_moving(&mut self, moving: f64) {
        if moving.is_finite() {
            self.most_moving = self.most_moving.max(moving);
        }
    }

    /// Begins anew where so much moves that the motion had not begun before: the noise of a rest is no drift of what follows.
    /// Returns whether it does.
    pub(super) fn begin_if_at_rest(&mut self, time: f64, distance: f64, moving: f64) -> bool {
        let is_noise = distance.abs() <= LEFT * moving;
        let begins = self.worst > LEFT && is_noise && is_beginning(moving, self.worst_scale);
        if begins {
            (self.worst, self.worst_scale, self.left) = (0.0, 0.0, None);
            self.moving = Mean::beginning(time);
            self.early = Early::default();
        }
        begins
    }
}

/// A motion begins where so many times as much moves as before.
const BEGINS: f64 = 1e20;

/// Whether a motion begins in which this much moves, after this much.
fn is_beginning(moving: f64, before: f64) -> bool {
    moving.is_finite() && moving > BEGINS * before
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_begins_where_1e20_times_as_much_moves() {
        assert!(is_beginning(2.1e20, 2.0) && !is_beginning(1.9e20, 2.0));
        assert!(is_beginning(1e-300, 0.0) && !is_beginning(f64::INFINITY, 1.0));
        let lost = |moving: f64| {
            let mut record = DriftRecord::beginning(Mean::default());
            (record.worst, record.worst_scale, record.left) = (0.5, 1e-90, Some(0.0));
            record.begin_if_at_rest(1.0, 1e-50, moving);
            record.worst
        };
        assert_eq!(lost(1e-30), 0.0);
        // what moves is no measure of an error that is as large, nor of one that is far above rounding
        assert_eq!(lost(1e-71), 0.5);
        assert_eq!(lost(1e-50), 0.5);
    }
}

/// A distance from the reference, and what moved at that time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Distance {
    pub(super) time: f64,
    pub(super) size: f64,
    pub(super) moving: f64,
}

/// The number of first observations, whose distances are kept until the scale of what moves is known.
const FIRST_OBSERVATIONS: u32 = 64;

/// The observations after which that scale is known.
const OBSERVATIONS_TO_KNOW: u32 = 2 * FIRST_OBSERVATIONS;

/// The distances at the first observations. A motion that begins at rest moves little in its first steps, and the error of the first
/// may be as large as all that has moved: they are compared with what moves a few steps later.
#[derive(Clone, Debug, Default)]
pub(super) struct Early {
    observations: u32,
    pub(super) distances: Vec<Distance>,
}

impl Early {
    pub(super) fn over() -> Early {
        Early { observations: OBSERVATIONS_TO_KNOW + 1, distances: Vec::new() }
    }

    /// Whether what moves is just known.
    pub(super) fn is_known(&self) -> bool {
        self.observations == OBSERVATIONS_TO_KNOW
    }

    /// Counts an observation, with a distance if rounding does not explain it. Returns whether the distance is deferred.
    pub(super) fn take(&mut self, distance: Option<Distance>) -> bool {
        if self.observations < OBSERVATIONS_TO_KNOW {
            self.observations += 1;
        }
        let is_first = self.observations <= FIRST_OBSERVATIONS;
        self.distances.extend(distance.filter(|_| is_first));
        is_first
    }
}
