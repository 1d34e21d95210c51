//! The time over which the events' functions are simple: how far ahead of a state their Taylor
//! series along the motion, truncated at a modest order, represent them.
//!
//! Samples that are no farther apart than that detect every turning point, even if a function
//! varies much faster than the motion. In: a state. Out: a length of time. Never here: zeros.

use std::sync::Arc;

use super::expansion::{Expansion, side};
use super::program::Program;
use super::series::Series;
use super::{State, System};
use crate::num::DoubleDouble;

const ORDER: usize = 12;

/// The last terms may be this part of the largest one: a sine is then represented for half a
/// period.
const CUT_OFF: f64 = 1e-3;

/// The maximal number of trials with another unit of time, or with other branches at kinks.
const ATTEMPTS: u32 = 12;

/// Estimates the resolution that the events of one system need.
#[derive(Clone, Debug)]
pub(super) struct Resolution {
    series: Series,
    expansion: Expansion,
    /// The last length found, as a first guess of the next one.
    last: Option<f64>,
}

impl Resolution {
    pub(super) fn new(system: &System, program: Arc<Program>, functions: usize) -> Resolution {
        Resolution {
            series: system.series(ORDER, 0),
            expansion: Expansion::new(system, program, functions, ORDER),
            last: None,
        }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        self.series.set_parameters(parameters);
        self.expansion.set_parameters(parameters);
        self.last = None;
    }

    /// The time after a state, in the system's native form, over which all functions are simple.
    /// Returns `None` if it cannot be estimated. `near` is a time comparable to the time scale of
    /// the motion.
    pub(super) fn after(&mut self, state: &State, near: f64) -> Option<f64> {
        let mut unit = self.last.unwrap_or(near);
        for _ in 0..ATTEMPTS {
            if !(unit.is_finite() && unit > 0.0) {
                return None;
            }
            self.series.set_scale(unit);
            match self.expand(state) {
                LengthTrial::Length(length) => {
                    self.last = Some(length).filter(|length| length.is_finite());
                    return Some(length);
                }
                LengthTrial::OtherSides => {}
                LengthTrial::NotFinite => unit *= 1e-4,
            }
        }
        None
    }

    fn expand(&mut self, state: &State) -> LengthTrial {
        let built = self.series.build(state).is_ok();
        let mut turned = false;
        for i in 0..self.series.switches() {
            let side = side(self.series.switch(i));
            turned |= side != self.series.sides()[i];
            self.series.set_side(i, side);
        }
        if turned {
            return LengthTrial::OtherSides;
        }
        if !built {
            return LengthTrial::NotFinite;
        }
        let length = self.expansion.expand(&self.series, 0.0, (CUT_OFF, f64::INFINITY));
        if length.is_nan() {
            return LengthTrial::NotFinite;
        }
        LengthTrial::Length(length * self.series.scale().abs())
    }
}

enum LengthTrial {
    Length(f64),
    /// Another branch applies at a kink.
    OtherSides,
    /// A coefficient is out of range.
    NotFinite,
}
