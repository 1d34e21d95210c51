//! Whether a motion has moved at all: at an equilibrium the last digits of its coordinates change, and nothing else.
//!
//! In: the coordinates of a motion at the times of its rows, and the terms of its energy at the ends of its steps, as rows alone may
//! always meet a motion at the same phase. Out: whether it is at rest. Never here: whether it stays there.

use crate::system::{ChannelKind, Form, System, TermSums};

/// What changes by no more than so many of its last digits, in units of ε, is at rest. Under constraints those of the largest coordinate
/// count: a state is moved back onto them, and what is zero with it, by the rounding of others.
const DIGITS: f64 = 8.0;

/// The energy of motion at rest is at most that of a change by so many last digits: the square of this part of the energy's terms. The
/// velocity of a body so far away that its place does not show it is greater.
const MOVING: f64 = 64.0;

/// Whether the energy of motion is that of rounding errors, given the sums over the terms of the energy.
#[inline]
pub(super) fn is_slow(energy: &TermSums) -> bool {
    let digits = MOVING * f64::EPSILON;
    energy.beyond <= digits * digits * energy.size
}

/// A coordinate where the reference was taken.
#[derive(Clone, Debug)]
struct Watched {
    channel: usize,
    start: f64,
}

#[derive(Clone, Debug)]
pub(super) struct RestWatch {
    watched: Vec<Watched>,
    is_constrained: bool,
    has_moved: bool,
}

impl RestWatch {
    pub(super) fn new(system: &System) -> RestWatch {
        let channels = system.channels().iter().enumerate();
        let positions = channels.filter(|(_, one)| matches!(one.kind, ChannelKind::Position(_)));
        let watched = positions.map(|(channel, _)| Watched { channel, start: f64::NAN }).collect();
        // variables of brackets have no energy of motion
        let has_moved = system.form() == Form::Variables;
        RestWatch { watched, is_constrained: system.constraints() > 0, has_moved }
    }

    /// Takes the current place as that of rest.
    pub(super) fn begin(&mut self, system: &System, values: &[f64]) {
        self.has_moved = system.form() == Form::Variables;
        self.watched.iter_mut().for_each(|one| one.start = values[one.channel]);
    }

    pub(super) fn observe(&mut self, values: &[f64]) {
        let size = |one: &Watched| one.start.abs().max(values[one.channel].abs());
        let largest = self.watched.iter().map(size).fold(0.0, f64::max);
        let is_there = |one: &Watched| {
            let now = values[one.channel];
            let digit = f64::EPSILON * if self.is_constrained { largest } else { size(one) };
            (now - one.start).abs() <= DIGITS * digit
        };
        self.has_moved |= !self.watched.iter().all(is_there);
    }

    /// Whether every row shows the coordinates where they began.
    pub(super) fn is_in_place(&self) -> bool {
        !self.has_moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rest_is_a_change_of_eight_digits_and_an_energy_of_sixty_four() {
        let unit = f64::EPSILON;
        let is_in_place = |off: f64| {
            let watched = vec![Watched { channel: 0, start: 1.0 }];
            let mut watch = RestWatch { watched, is_constrained: false, has_moved: false };
            watch.observe(&[1.0 - unit * off]);
            watch.observe(&[1.0]);
            watch.is_in_place()
        };
        let is_in_place_beside = |is_constrained: bool| {
            let watched = [0.0, 1.0].iter().enumerate();
            let watched = watched.map(|(channel, &start)| Watched { channel, start }).collect();
            let mut watch = RestWatch { watched, is_constrained, has_moved: false };
            watch.observe(&[7.5 * unit, 1.0]);
            let is_in_place = watch.is_in_place();
            watch.observe(&[8.5 * unit, 1.0]);
            (is_in_place, watch.is_in_place())
        };
        assert_eq!(is_in_place_beside(true), (true, false));
        assert_eq!(is_in_place_beside(false), (false, false));
        assert!(is_in_place(8.0) && !is_in_place(8.5) && !is_in_place(f64::NAN));
        let is_slow = |moving: f64| {
            let beyond = 3.0 * moving * unit * unit;
            is_slow(&TermSums { size: 3.0, beyond, ..TermSums::NOTHING })
        };
        assert!(is_slow(64.0 * 63.0) && !is_slow(64.0 * 65.0) && !is_slow(f64::NAN));
    }
}
