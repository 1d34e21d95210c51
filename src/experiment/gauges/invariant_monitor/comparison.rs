//! Distances of an invariant from its reference, as parts of what moves.
//!
//! In: distances, and the size of the moving terms. Out: the greatest drift, and when it first exceeded the limit. Never here: values.

use super::super::drift_record::{Distance, Waiting};
use super::{ENERGY, InvariantMonitor};
use crate::analysis::{LEFT, RESOLVED};

/// What moves by less than this multiple of the error that rounding explains, and all of it away from the reference, is
/// error and no motion: a quantity each of whose terms is constant.
const ERROR: f64 = 1e3;

impl InvariantMonitor {
    pub(super) fn note(&mut self, time: f64, distance: f64, moving: f64, floor: f64) {
        let distance = distance.abs();
        self.drift.last = distance;
        if distance > self.drift.farthest {
            self.drift.farthest = distance;
        }
        let explained = floor * self.rounding.greatest;
        self.rounding.explained = self.rounding.explained.max(explained);
        let beyond = distance > explained;
        // a motion that has not begun says nothing of what will move
        if !beyond && moving == 0.0 && self.moving() == 0.0 {
            return;
        }
        self.drift.early.observe(moving, self.drift.most_moving);
        if beyond {
            let seen = Distance { time, size: distance, moving: moving.max(self.moving()) };
            if !self.drift.early.defer(seen) {
                self.compare(seen);
            }
        }
        while let Some(waiting) = self.drift.early.take(time) {
            waiting.distances().for_each(|seen| self.compare(seen));
        }
    }

    /// Compares a distance with what moves.
    fn compare(&mut self, Distance { time, size, moving }: Distance) {
        let drift = self.drift_of(size, moving);
        if drift > self.drift.worst {
            self.drift.worst = drift;
            self.drift.worst_scale = self.scale_of(moving.max(self.moving()));
        }
        // rows lie before the end of the step, which was recorded first
        if drift > LEFT && self.drift.left.is_none_or(|left| time < left) {
            self.drift.left = Some(time);
        }
    }

    /// What moves: the mean, or where physics changes the value and the motion may come to rest, the greatest so far.
    pub(super) fn moving(&self) -> f64 {
        if self.change_law().is_some() { self.drift.most_moving } else { self.drift.moving.value() }
    }

    /// Whether a drift is seen that the digits of its terms do not explain in themselves, although it is within their rounding
    /// error: either rounding of the state has changed the value, or the method. Only of an energy it is known what moves: of a
    /// quantity each of whose terms is constant nothing moves but the error.
    pub(in crate::experiment::gauges) fn is_seen(&self) -> bool {
        let (moving, seen) = (self.moving(), self.seen.greatest());
        let is_energy = self.invariant.quantity == Some(ENERGY);
        let within_rounding = self.drift.farthest <= self.rounding.explained;
        let is_resolved = is_resolved(seen, moving);
        self.change_law().is_none() && is_energy && within_rounding && is_resolved
    }

    fn drift_of(&self, distance: f64, moving: f64) -> f64 {
        distance / self.scale_of(moving.max(self.moving()))
    }

    /// The greatest drift, and when it first exceeded the limit.
    pub(super) fn drifted(&self) -> (f64, Option<f64>) {
        let (mut worst, mut left) = (self.drift.worst, self.drift.left);
        let waiting = self.drift.early.waiting.iter().flat_map(Waiting::distances);
        for Distance { time, size, moving } in waiting {
            let drift = self.drift_of(size, moving);
            worst = worst.max(drift);
            if drift > LEFT && left.is_none_or(|left| time < left) {
                left = Some(time);
            }
        }
        (worst, left)
    }

    /// The scale of drift: what moves, or the size of the terms if nothing moves.
    pub(super) fn scale(&self) -> f64 {
        self.scale_of(self.moving())
    }

    /// The scale of drift where this much moves.
    fn scale_of(&self, moving: f64) -> f64 {
        // an energy that is seen to change has the state's motion, whatever made it
        let changes =
            self.invariant.quantity == Some(ENERGY) && self.seen.greatest() > 0.0 && moving > 0.0;
        let is_error = is_error(moving, self.drift.farthest, self.rounding.explained);
        if is_error && !changes { self.rounding.greatest } else { moving }
    }
}

/// Whether a change that was seen is so great a part of what moves that a value is not exact.
fn is_resolved(seen: f64, moving: f64) -> bool {
    moving > 0.0 && seen > RESOLVED * moving
}

/// Whether what moves is error and no motion, where a value has been so far from its reference, and rounding explains so much.
fn is_error(moving: f64, farthest: f64, explained: f64) -> bool {
    // terms that balance each other move by more than their sum
    moving <= 2.0 * farthest && moving <= ERROR * explained
}

#[cfg(test)]
mod tests {
    use super::{is_error, is_resolved};

    #[test]
    fn a_value_is_exact_up_to_a_billionth_of_what_moves() {
        assert!(!is_resolved(1.9e-9, 2.0) && is_resolved(2.1e-9, 2.0));
        assert!(!is_resolved(1.0, 0.0), "where nothing moves it is not known of what it is a part");
    }

    #[test]
    fn what_moves_is_error_up_to_a_thousand_times_rounding_and_twice_the_distance() {
        assert!(is_error(1.99, 1.0, 0.002) && !is_error(2.01, 1.0, 0.01));
        assert!(is_error(0.99, 1.0, 0.001) && !is_error(1.01, 1.0, 0.001));
    }
}
