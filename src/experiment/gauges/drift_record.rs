//! The distances of a gauge from its reference, and the drift they are.
//!
//! In: distances, and what moved at that time. Out: the greatest of them, and their history. Never here: what a distance is measured
//! from, or which of them rounding explains.

use super::mean::Mean;
use crate::analysis::{History, LEFT, LOST};

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
    /// The distances beyond rounding, as long as it is not known how much moves.
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
            early: Early::beginning(moving.time()),
            distances: History::new(),
        }
    }

    /// Records how much moves at a time.
    #[inline]
    pub(super) fn see_moving(&mut self, moving: f64) {
        if moving.is_finite() {
            self.most_moving = self.most_moving.max(moving);
        }
    }

    /// Adds what moves at a time to its mean. What moves of a motion that is lost is no measure of it.
    #[inline]
    pub(super) fn note_moving(&mut self, time: f64, distance: f64, moving: f64) {
        let mean = self.moving.value();
        let is_lost = self.worst > LOST || distance.abs() > LOST * moving.max(mean);
        if mean == 0.0 || !is_lost {
            self.moving.note(time, moving);
        }
    }

    /// Begins anew where so much moves that the motion had not begun before: the noise of a rest is no drift of what follows.
    /// Returns whether it does.
    #[inline]
    pub(super) fn begin_if_at_rest(&mut self, time: f64, distance: f64, moving: f64) -> bool {
        let is_noise = distance.abs() <= LEFT * moving;
        let begins = self.worst > LEFT && is_noise && is_beginning(moving, self.worst_scale);
        if begins {
            (self.worst, self.worst_scale, self.left) = (0.0, 0.0, None);
            self.moving = Mean::beginning(time);
            self.early = Early::beginning(time);
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

/// A distance from the reference, and what moved at that time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Distance {
    pub(super) time: f64,
    pub(super) size: f64,
    /// What moved then, or on the mean up to then if that was more.
    pub(super) moving: f64,
}

/// The observations after which it may be known how much moves.
const FEWEST_OBSERVATIONS: u32 = 128;

/// What moves has turned where it falls below this part of the most that has moved.
const TURNED: f64 = 0.5;

/// A distance is compared with what has moved until so many times as long after the beginning.
const AHEAD: f64 = 8.0;

/// The distances while a motion begins. Until what moves has grown and fallen again, it is not known how much will move: from rest, or
/// from a velocity that first leads to a turning point nearby, little moves at first, and an error of the first steps may be as
/// large. These distances are compared with what moves later. Of times that differ by a few per cent the greatest part is kept.
#[derive(Clone, Debug, Default)]
pub(super) struct Early {
    observations: u32,
    over: bool,
    /// When the motion began.
    from: f64,
    slot: u64,
    /// Those that wait to be compared, the oldest first.
    pub(super) waiting: Vec<Waiting>,
}

/// Distances at neighbouring times that wait to be compared.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waiting {
    /// The greatest part of what moved.
    greatest: Distance,
    /// The first that was beyond the limit by what moved then.
    beyond: Option<Distance>,
}

impl Waiting {
    pub(super) fn distances(&self) -> impl Iterator<Item = Distance> + use<> {
        self.beyond.into_iter().chain([self.greatest])
    }

    fn of(distance: Distance) -> Waiting {
        let is_beyond = distance.size > LEFT * distance.moving;
        Waiting { greatest: distance, beyond: is_beyond.then_some(distance) }
    }

    fn join(&mut self, distance: Distance) {
        let greatest = self.greatest;
        if distance.size * greatest.moving > greatest.size * distance.moving {
            self.greatest = distance;
        }
        self.beyond = self.beyond.or(Waiting::of(distance).beyond);
    }
}

impl Early {
    pub(super) fn beginning(from: f64) -> Early {
        Early { from, ..Early::default() }
    }

    pub(super) fn over() -> Early {
        Early { over: true, ..Early::default() }
    }

    /// Counts an observation in which this much of the most so far moves: the beginning may end with it.
    pub(super) fn observe(&mut self, moving: f64, most: f64) {
        self.observations = self.observations.saturating_add(1);
        self.over |= self.may_compare() && (has_turned(moving, most) || most == 0.0);
    }

    fn may_compare(&self) -> bool {
        self.observations >= FEWEST_OBSERVATIONS
    }

    /// Defers a distance beyond rounding. Returns whether it does: after the beginning none is.
    pub(super) fn defer(&mut self, distance: Distance) -> bool {
        if self.over {
            return false;
        }
        // sixteen of each power of two
        let slot = self.since(distance.time).to_bits() >> 48;
        match self.waiting.last_mut().filter(|_| slot == self.slot) {
            Some(waiting) => waiting.join(distance),
            None => self.waiting.push(Waiting::of(distance)),
        }
        self.slot = slot;
        true
    }

    /// The oldest distances, if enough has moved by now to compare them.
    pub(super) fn take(&mut self, time: f64) -> Option<Waiting> {
        let oldest = self.waiting.first()?.greatest;
        let is_due = self.may_compare() && self.since(time) >= AHEAD * self.since(oldest.time);
        (self.over || is_due).then(|| self.waiting.remove(0))
    }

    fn since(&self, time: f64) -> f64 {
        (time - self.from).abs()
    }
}

fn has_turned(moving: f64, most: f64) -> bool {
    moving < TURNED * most
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

    /// A beginning with this many observations, of which this much moves, and a distance at one unit of time after it.
    fn early(observations: u32, moving: f64) -> Early {
        let mut early = Early::beginning(5.0);
        (0..observations).for_each(|_| early.observe(moving, 1.0));
        early.defer(Distance { time: 6.0, size: 0.1, moving: 1.0 });
        early
    }

    #[test]
    fn an_early_distance_is_compared_with_what_moves_until_eight_times_as_long() {
        let taken = |observations, after: f64| early(observations, 1.0).take(5.0 + after).is_some();
        assert!(!taken(128, 7.9) && taken(128, 8.1));
        assert!(!taken(127, 100.0));
        assert!(taken(1000, 8.1) && !taken(1000, 7.9));
    }

    #[test]
    fn a_motion_has_begun_where_half_of_what_moves_is_over() {
        assert!(!early(127, 0.1).over && early(128, 0.49).over && !early(128, 0.51).over);
        assert!(!early(128, 0.49).defer(Distance { time: 6.0, size: 0.1, moving: 1.0 }));
    }

    #[test]
    fn of_early_distances_that_are_near_each_other_the_greatest_part_is_stored() {
        let mut early = Early::beginning(0.0);
        let seen = |time, size, moving| Distance { time, size, moving };
        let small = seen(1.0, 1e-9, 1.0);
        for distance in [small, seen(1.03, 2e-6, 1.0), seen(1.05, 2.0, 4.0), seen(1.06, 3.0, 2.0)] {
            early.defer(distance);
        }
        // and the first that is beyond the limit, with its time
        let times = |early: &Early| {
            early.waiting.iter().flat_map(Waiting::distances).map(|d| d.time).collect::<Vec<_>>()
        };
        assert_eq!(times(&early), [1.03, 1.06]);
        early.defer(seen(1.07, 1e-9, 1.0));
        assert_eq!(times(&early), [1.03, 1.06, 1.07], "a sixteenth later");
    }
}
