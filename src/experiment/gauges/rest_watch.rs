//! Whether a motion has moved at all: at an equilibrium the last digits of its coordinates change, and nothing else.
//!
//! In: the channels of a motion and the terms of its energy at some times. Out: whether it is at rest. Never here: whether it stays there.

use crate::system::{ChannelKind, System, TermWatch};

/// What changes by no more than so many of its last digits, in units of ε, is at rest.
const DIGITS: f64 = 8.0;

/// The energy of motion at rest is at most that of a change by so many last digits: the square of this part of the energy's terms. The
/// velocity of a body so far away that its place does not show it is greater.
const MOVING: f64 = 64.0;

/// A coordinate, or a variable of brackets, where the reference was taken.
#[derive(Clone, Debug)]
struct Watched {
    channel: usize,
    start: f64,
}

#[derive(Clone, Debug)]
pub(super) struct RestWatch {
    watched: Vec<Watched>,
    has_moved: bool,
}

impl RestWatch {
    pub(super) fn new(system: &System) -> RestWatch {
        let channels = system.channels().iter().enumerate();
        let positions = channels.filter(|(_, one)| matches!(one.kind, ChannelKind::Position(_)));
        let watched = positions.map(|(channel, _)| Watched { channel, start: f64::NAN }).collect();
        RestWatch { watched, has_moved: false }
    }

    /// Takes the current place as that of rest.
    pub(super) fn begin(&mut self, values: &[f64]) {
        self.has_moved = false;
        self.watched.iter_mut().for_each(|one| one.start = values[one.channel]);
    }

    pub(super) fn observe(&mut self, values: &[f64], terms: &TermWatch) {
        if !self.has_moved {
            let [moving, size] = terms.beyond_rest(TermWatch::ENERGY);
            self.take(values, moving, size);
        }
    }

    /// Takes into account where the motion is, its energy of motion, and the size of the energy's terms.
    fn take(&mut self, values: &[f64], moving: f64, size: f64) {
        let is_there = |one: &Watched| {
            let now = values[one.channel];
            let digit = f64::EPSILON * one.start.abs().max(now.abs());
            (now - one.start).abs() <= DIGITS * digit
        };
        let digits = MOVING * f64::EPSILON;
        let is_slow = moving <= digits * digits * size;
        self.has_moved = !is_slow || !self.watched.iter().all(is_there);
    }

    pub(super) fn is_at_rest(&self) -> bool {
        !self.has_moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A coordinate of 1 that is off by so many units of ε, with an energy of motion of so many units of ε².
    fn is_at_rest(off: f64, moving: f64) -> bool {
        let watched = vec![Watched { channel: 0, start: 1.0 }];
        let mut watch = RestWatch { watched, has_moved: false };
        let unit = f64::EPSILON;
        watch.take(&[1.0 - unit * off], 3.0 * moving * unit * unit, 3.0);
        watch.is_at_rest()
    }

    #[test]
    fn rest_is_a_change_of_eight_digits_and_an_energy_of_sixty_four() {
        assert!(is_at_rest(8.0, 0.0) && !is_at_rest(8.5, 0.0));
        assert!(is_at_rest(0.0, 64.0 * 63.0) && !is_at_rest(0.0, 64.0 * 65.0));
        assert!(!is_at_rest(0.0, f64::NAN));
    }
}
