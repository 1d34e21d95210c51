//! Equal steps, counted: time is the product of a count and a step, not a sum.
//!
//! In: the time at which counting begins, a step, the time scale of a motion. Out: times. Never here:
//! states.

use super::clock::spacing;
use super::initial_step;
use crate::num::DoubleDouble;
use crate::system::{State, System};

/// The default step, as a part of the motion's [time scale](super::initial_step::of).
const PART_OF_PACE: f64 = 1.0 / 10.0;

/// The largest number of steps that can be counted.
const MOST_STEPS: f64 = 9_007_199_254_740_992.0;

/// The steps in a row that must change the time by more than this many of its last digits.
const DIGITS_PER_STEP: f64 = 4.0;

#[derive(Clone, Copy, Debug)]
pub(super) struct EqualSteps {
    /// The step; negative if the motion runs backwards.
    pub(super) step: DoubleDouble,
    origin: DoubleDouble,
    count: f64,
}

impl EqualSteps {
    pub(super) fn new(origin: DoubleDouble, step: DoubleDouble) -> EqualSteps {
        EqualSteps { step, origin, count: 0.0 }
    }

    /// The step of a motion that begins at a state: the one asked for, or one that suits the motion.
    pub(super) fn step_of(
        asked: Option<f64>,
        system: &System,
        state: &State,
        parameters: &[f64],
    ) -> DoubleDouble {
        match asked {
            Some(step) => DoubleDouble::from_decimal(step),
            None => {
                let pace = initial_step::of(system, state, parameters) * PART_OF_PACE;
                // two digits are enough, and times are then short decimals
                DoubleDouble::from_decimal(format!("{pace:.1e}").parse().unwrap_or(pace))
            }
        }
    }

    /// The time after `count` more steps.
    pub(super) fn time_after(&self, count: u64) -> DoubleDouble {
        self.origin + self.step * (self.count + count as f64)
    }

    pub(super) fn take(&mut self, count: u64) {
        self.count += count as f64;
    }

    /// Whether there are more steps to a time than can be counted.
    pub(super) fn are_too_many(&self, time: f64) -> bool {
        let way = (time - self.origin.high).abs() / self.step.high.abs();
        time.is_finite() && way > MOST_STEPS
    }

    /// Whether each of `count` more steps from `now` on changes the time.
    pub(super) fn are_distinct(&self, count: u64, now: f64) -> bool {
        let last = self.time_after(count).high;
        self.step.high.abs() >= DIGITS_PER_STEP * spacing(last.abs().max(now.abs()))
    }

    /// The number of steps, at least one and at most `most`, after which `time` is reached or passed.
    pub(super) fn to(&self, time: f64, most: u64) -> u64 {
        let way = (time - self.origin.high) / self.step.high - self.count;
        let reached = |count: u64| (self.time_after(count).high - time) * self.step.high >= 0.0;
        // a quotient that is negative or not a number counts as zero
        let mut count = (way.ceil() as u64).clamp(1, most);
        while count > 1 && reached(count - 1) {
            count -= 1;
        }
        while count < most && !reached(count) {
            count += 1;
        }
        count
    }
}
