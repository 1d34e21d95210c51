//! Evaluates the events' functions inside a step.
//!
//! In: a motion that has taken a step, a time within it. Out: values. Never here: where they are
//! zero.

use super::DenseOutput;
use crate::num::DoubleDouble;
use crate::system::{EventFunctions, MotionError, State};

#[derive(Clone, Debug)]
pub(super) struct Probe {
    event_functions: EventFunctions,
    /// The time of the last impulse: the motion after it must not be evaluated at earlier times.
    begun: Option<DoubleDouble>,
    values: Vec<f64>,
    state: State,
}

impl Probe {
    pub(super) fn new(event_functions: EventFunctions, functions: usize, blank: State) -> Probe {
        Probe { event_functions, begun: None, values: vec![0.0; functions], state: blank }
    }

    pub(super) fn event_functions(&mut self) -> &mut EventFunctions {
        &mut self.event_functions
    }

    /// Starts at the time of an impulse, or without one.
    pub(super) fn begin(&mut self, begun: Option<DoubleDouble>) {
        self.begun = begun;
    }

    /// Returns the later of a time and that of the last impulse.
    pub(super) fn not_before(&self, time: DoubleDouble) -> DoubleDouble {
        self.begun.filter(|&begun| earlier(time, begun)).unwrap_or(time)
    }

    pub(super) fn of(&mut self, state: &State) -> Result<&[f64], MotionError> {
        self.event_functions.observe(state, &mut self.values)?;
        Ok(&self.values)
    }

    /// The values at a time within the last step.
    pub(super) fn at(
        &mut self,
        motion: &mut dyn DenseOutput,
        time: f64,
    ) -> Result<&[f64], MotionError> {
        self.move_to(motion, time)?;
        self.event_functions.observe(&self.state, &mut self.values)?;
        Ok(&self.values)
    }

    /// One value at a time within the last step, in double-double.
    pub(super) fn exactly(
        &mut self,
        motion: &mut dyn DenseOutput,
        event: usize,
        time: f64,
    ) -> Result<DoubleDouble, MotionError> {
        self.move_to(motion, time)?;
        self.event_functions.exactly(event, &self.state)
    }

    pub(super) fn exactly_of(
        &mut self,
        event: usize,
        state: &State,
    ) -> Result<DoubleDouble, MotionError> {
        self.event_functions.exactly(event, state)
    }

    /// The same as [`Probe::exactly`] at a time known beyond the last digit of an `f64`.
    pub(super) fn exactly_at(
        &mut self,
        motion: &mut dyn DenseOutput,
        event: usize,
        time: DoubleDouble,
    ) -> Result<DoubleDouble, MotionError> {
        motion.at_exactly(self.not_before(time), &mut self.state)?;
        self.event_functions.exactly(event, &self.state)
    }

    /// The time after one within the last step over which the functions are simple; `near` is a
    /// time comparable to the time scale of the motion.
    pub(super) fn resolved(
        &mut self,
        motion: &mut dyn DenseOutput,
        time: f64,
        near: f64,
    ) -> Result<Option<f64>, MotionError> {
        self.move_to(motion, time)?;
        Ok(self.event_functions.resolved(&self.state, near))
    }

    fn move_to(&mut self, motion: &mut dyn DenseOutput, time: f64) -> Result<(), MotionError> {
        match self.begun.filter(|&begun| earlier(DoubleDouble::from_decimal(time), begun)) {
            Some(begun) => motion.at_exactly(begun, &mut self.state),
            None => motion.at(time, &mut self.state),
        }
    }
}

/// Whether one time comes before another.
pub(super) fn earlier(a: DoubleDouble, b: DoubleDouble) -> bool {
    (a - b).high < 0.0
}
