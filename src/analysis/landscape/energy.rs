//! The energy over the phase plane, as a function and on grids.
//!
//! In: an observer of the system, a time. Out: values of the energy. Never here: what is searched for in them.

use crate::system::{Form, Observer};

/// The energy as a function of one coordinate and its rate.
pub(super) struct Energy {
    pub(super) observer: Observer,
    pub(super) time: f64,
    pub(super) form: Form,
}

impl Energy {
    /// Values on a grid, row by row from the first rate.
    pub(super) fn grid(&mut self, positions: &[f64], rates: &[f64]) -> Vec<f64> {
        let mut values = vec![f64::NAN; positions.len() * rates.len()];
        self.observer.energy_on_grid(self.time, self.form, positions, rates, &mut values);
        values
    }
}

/// Returns `count` evenly spaced values from one end to the other.
pub(super) fn spread([from, to]: [f64; 2], count: usize) -> Vec<f64> {
    let last = (count - 1) as f64;
    (0..count).map(|i| from + (to - from) * i as f64 / last).collect()
}
