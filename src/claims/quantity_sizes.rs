//! How large the quantities with an expected value have been along the motion: the measure of their errors where the file
//! gives no tolerance. Units of atoms or galaxies make numbers of any size.
//!
//! In: the values of all symbols at looks along the motion. Out: a tolerance. Never here: the motion.

use crate::expr::Symbol;
use crate::mechanics::Equations;
use crate::model::{ExpectedEvent, ExpectedValue, Model};

/// The tolerated error of an expected number, relative to the largest size of its terms until then.
const TOLERANCE: f64 = 1e-10;

/// How often the motion is looked at between the start and the last time at which a value is expected.
const LOOKS: u32 = 64;

/// Where in each interval between two looks it is looked at.
const PLACE: f64 = 0.618;

/// The largest size of the terms of each expected quantity.
pub(super) struct QuantitySizes<'a> {
    values: &'a [ExpectedValue],
    sizes: Vec<f64>,
}

impl<'a> QuantitySizes<'a> {
    pub(super) fn of(model: &'a Model) -> QuantitySizes<'a> {
        let values = &model.expect.values[..];
        QuantitySizes { values, sizes: values.iter().map(|value| value.is.abs()).collect() }
    }

    /// The times at which to look: none if each value has a tolerance of its own.
    pub(super) fn looks(&self, start: f64) -> Vec<f64> {
        let open = self.values.iter().filter(|value| value.within.is_none());
        let last = open.map(|value| value.at).fold(start, f64::max);
        let count = if last > start { LOOKS } else { 0 };
        let part = |k: u32| (f64::from(k) + PLACE) / f64::from(LOOKS);
        (0..count).map(|k| start + (last - start) * part(k)).collect()
    }

    /// Looks at the quantities.
    pub(super) fn look(&mut self, equations: &Equations, at: &dyn Fn(Symbol) -> f64) {
        for (value, largest) in self.values.iter().zip(&mut self.sizes) {
            if value.within.is_none() {
                let (_, size) = equations.pool.evaluate_with_size(value.expression, at);
                *largest = if size.is_finite() { largest.max(size) } else { *largest };
            }
        }
    }

    /// How far a value may be from what is expected.
    pub(super) fn tolerance(&self, index: usize) -> f64 {
        self.values[index].within.unwrap_or(TOLERANCE * self.sizes[index])
    }
}

/// How far the time of an event may be from what is expected.
pub(super) fn tolerated_delay(expected: &ExpectedEvent, start: f64) -> f64 {
    let size = expected.at.abs().max((expected.at - start).abs());
    expected.within.unwrap_or(TOLERANCE * size)
}
