//! How large the quantities with an expected value have been along the motion: the measure of their errors where the file
//! gives no tolerance. Units of atoms or galaxies make numbers of any size.
//!
//! What swings through zero is as large there as just before, and what has decayed is as small as that: sizes are those of the last
//! part of the way.
//!
//! In: the values of all symbols at times along the motion. Out: a tolerance. Never here: the motion.

use crate::expr::Symbol;
use crate::mechanics::Equations;
use crate::model::{ExpectedEvent, ExpectedValue, Model};

/// The tolerated error of an expected number, relative to the largest size of its terms in the last part of the way.
const TOLERANCE: f64 = 1e-10;

/// The last part of the way until a value is expected, and how often the motion is observed there.
const LAST_PART: f64 = 0.125;
const LAST_OBSERVATIONS: u32 = 8;

/// Rounding of what was larger before, relative to that: what is expected to be zero may be so much.
const ROUNDING: f64 = 1e-15;

/// How often the motion is observed between the start and the last time at which a value is expected.
const OBSERVATIONS: u32 = 64;

/// Where in each of these intervals it is observed.
const PLACE: f64 = 0.618;

/// The largest sizes of the terms of each expected quantity.
pub(super) struct QuantitySizes<'a> {
    values: &'a [ExpectedValue],
    start: f64,
    sizes: Vec<QuantitySize>,
}

/// The largest size of the terms of one quantity.
#[derive(Clone, Copy)]
struct QuantitySize {
    /// Since the motion began.
    ever: f64,
    /// In the last part of the way until the value is expected.
    lately: f64,
}

impl<'a> QuantitySizes<'a> {
    pub(super) fn of(model: &'a Model) -> QuantitySizes<'a> {
        let values = &model.expect.values[..];
        let expected = |value: &ExpectedValue| {
            let size = value.is.abs();
            QuantitySize { ever: size, lately: size }
        };
        QuantitySizes {
            values,
            start: model.run.start,
            sizes: values.iter().map(expected).collect(),
        }
    }

    /// The times of observation: none if each value has a tolerance of its own.
    pub(super) fn times(&self, start: f64) -> Vec<f64> {
        let open = self.values.iter().filter(|value| value.within.is_none());
        let last = open.map(|value| value.at).fold(start, f64::max);
        let count = if last > start { OBSERVATIONS } else { 0 };
        let part = |k: u32, observations: u32| (f64::from(k) + PLACE) / f64::from(observations);
        let all = (0..count).map(|k| start + (last - start) * part(k, OBSERVATIONS));
        let lately = |value: &ExpectedValue| {
            let (from, at) = (last_part_before(value.at, start), value.at);
            (0..LAST_OBSERVATIONS).map(move |k| from + (at - from) * part(k, LAST_OBSERVATIONS))
        };
        let open = self.values.iter().filter(|value| value.within.is_none() && value.at > start);
        all.chain(open.flat_map(lately)).collect()
    }

    /// Records how large the terms of the quantities are at a time.
    pub(super) fn observe(&mut self, equations: &Equations, time: f64, at: &dyn Fn(Symbol) -> f64) {
        for (value, largest) in self.values.iter().zip(&mut self.sizes) {
            if value.within.is_some() {
                continue;
            }
            let (_, size) = equations.pool.evaluate_with_size(value.expression, at);
            if size.is_finite() {
                largest.ever = largest.ever.max(size);
                if (last_part_before(value.at, self.start)..=value.at).contains(&time) {
                    largest.lately = largest.lately.max(size);
                }
            }
        }
    }

    /// How far a value may be from what is expected.
    pub(super) fn tolerance(&self, index: usize) -> f64 {
        let value = &self.values[index];
        value.within.unwrap_or(self.sizes[index].tolerance(value.is))
    }
}

impl QuantitySize {
    /// The tolerated error of a quantity that is expected to have a value.
    fn tolerance(self, expected: f64) -> f64 {
        let tolerance = TOLERANCE * self.lately;
        if expected == 0.0 { tolerance.max(ROUNDING * self.ever) } else { tolerance }
    }
}

/// Where the last part of the way to a time begins.
fn last_part_before(time: f64, start: f64) -> f64 {
    time - LAST_PART * (time - start)
}

/// How far the time of an event may be from what is expected.
pub(super) fn tolerated_delay(expected: &ExpectedEvent, start: f64) -> f64 {
    let size = expected.at.abs().max((expected.at - start).abs());
    expected.within.unwrap_or(TOLERANCE * size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_a_part_of_what_is_left_and_zero_is_but_for_rounding_of_what_was() {
        let tolerance =
            |lately: f64, expected: f64| QuantitySize { ever: 2.0, lately }.tolerance(expected);
        for expected in [0.0, 1e-12] {
            assert_eq!(tolerance(2.0, expected), 2.0 * 1e-10);
            assert_eq!(tolerance(2e-3, expected), 2e-3 * 1e-10);
        }
        assert_eq!(tolerance(2e-9, 1e-12), 2e-9 * 1e-10);
        assert_eq!(tolerance(2e-9, 0.0), 2.0 * 1e-15);
    }

    #[test]
    fn the_last_part_of_the_way_is_an_eighth_of_it() {
        assert_eq!(last_part_before(9.0, 1.0), 8.0);
    }
}
