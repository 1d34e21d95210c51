//! Over what time the functions of the events are simple: how far ahead of a state their Taylor
//! series along the motion, cut off at a modest order, tell what they do.
//!
//! Looks that are no farther apart than that see every turn, be a function ever so much faster than
//! the motion. In: a state. Out: a length of time. Never here: zeros.

use std::sync::Arc;

use super::expansion::{Expansion, side};
use super::program::Program;
use super::series::Series;
use super::{State, System};
use crate::num::DoubleDouble;

/// The order of the series.
const ORDER: usize = 12;

/// The last terms may be this part of the largest one: a sine is then followed for half a turn.
const CUT_OFF: f64 = 1e-3;

/// How often another unit of time, or other branches at kinks, are tried.
const ATTEMPTS: u32 = 12;

/// Estimates the resolution that the events of one system need.
#[derive(Clone, Debug)]
pub(super) struct Resolution {
    series: Series,
    expansion: Expansion,
    /// The length found last, near which the next one is expected.
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

    /// How far after a state, in the system's own form, all functions are simple; `None` where that
    /// cannot be reported. `near` is some length of time that is not far from the motion's own.
    pub(super) fn after(&mut self, state: &State, near: f64) -> Option<f64> {
        let mut unit = self.last.unwrap_or(near);
        for _ in 0..ATTEMPTS {
            if !(unit.is_finite() && unit > 0.0) {
                return None;
            }
            self.series.set_scale(unit);
            match self.expand(state) {
                Attempt::Length(length) => {
                    self.last = Some(length).filter(|length| length.is_finite());
                    return Some(length);
                }
                Attempt::OtherSides => {}
                Attempt::NotFinite => unit *= 1e-4,
            }
        }
        None
    }

    fn expand(&mut self, state: &State) -> Attempt {
        let built = self.series.build(state).is_ok();
        let mut turned = false;
        for i in 0..self.series.switches() {
            let side = side(self.series.switch(i));
            turned |= side != self.series.sides()[i];
            self.series.set_side(i, side);
        }
        if turned {
            return Attempt::OtherSides;
        }
        if !built || !self.expansion.about(&self.series, 0.0) {
            return Attempt::NotFinite;
        }
        let length = self.expansion.reach(CUT_OFF);
        if length.is_nan() {
            return Attempt::NotFinite;
        }
        Attempt::Length(length * self.series.scale().abs())
    }
}

/// What came of one attempt.
enum Attempt {
    Length(f64),
    /// At a kink another branch holds.
    OtherSides,
    /// Some coefficient is beyond all range.
    NotFinite,
}
