//! The functions of the events looked at inside a step.
//!
//! In: a stepper that has taken a step, a time within it. Out: values. Never here: where they are zero.

use super::Stepper;
use crate::expr::Double;
use crate::system::{Fault, State, Triggers};

/// What looks at the functions of one motion.
#[derive(Clone, Debug)]
pub(super) struct Probe {
    triggers: Triggers,
    /// When the last blow fell: the motion after it is not to be asked about earlier times.
    begun: Option<Double>,
    values: Vec<f64>,
    state: State,
}

impl Probe {
    pub(super) fn new(triggers: Triggers, functions: usize, blank: State) -> Probe {
        Probe { triggers, begun: None, values: vec![0.0; functions], state: blank }
    }

    pub(super) fn triggers(&mut self) -> &mut Triggers {
        &mut self.triggers
    }

    /// The motion begins anew at a time, or with nothing behind it.
    pub(super) fn begin(&mut self, begun: Option<Double>) {
        self.begun = begun;
    }

    /// A time, though not before the last blow.
    pub(super) fn not_before(&self, time: Double) -> Double {
        self.begun.filter(|&begun| earlier(time, begun)).unwrap_or(time)
    }

    /// The values at a state.
    pub(super) fn of(&mut self, state: &State) -> Result<&[f64], Fault> {
        self.triggers.look(state, &mut self.values)?;
        Ok(&self.values)
    }

    /// The values at a time within the last step.
    pub(super) fn at(&mut self, stepper: &mut dyn Stepper, time: f64) -> Result<&[f64], Fault> {
        self.move_to(stepper, time)?;
        self.triggers.look(&self.state, &mut self.values)?;
        Ok(&self.values)
    }

    /// One value at a time within the last step, in all digits.
    pub(super) fn exactly(
        &mut self,
        stepper: &mut dyn Stepper,
        event: usize,
        time: f64,
    ) -> Result<Double, Fault> {
        self.move_to(stepper, time)?;
        self.triggers.exactly(event, &self.state)
    }

    /// The same at a time known beyond the last digit of an `f64`.
    pub(super) fn exactly_at(
        &mut self,
        stepper: &mut dyn Stepper,
        event: usize,
        time: Double,
    ) -> Result<Double, Fault> {
        stepper.at_exactly(self.not_before(time), &mut self.state)?;
        self.triggers.exactly(event, &self.state)
    }

    /// How far after a time within the last step the functions are simple; `near` is a length of time not far from the
    /// motion's own.
    pub(super) fn resolved(
        &mut self,
        stepper: &mut dyn Stepper,
        time: f64,
        near: f64,
    ) -> Result<Option<f64>, Fault> {
        self.move_to(stepper, time)?;
        Ok(self.triggers.resolved(&self.state, near))
    }

    fn move_to(&mut self, stepper: &mut dyn Stepper, time: f64) -> Result<(), Fault> {
        match self.begun.filter(|&begun| earlier(Double::written(time), begun)) {
            Some(begun) => stepper.at_exactly(begun, &mut self.state),
            None => stepper.at(time, &mut self.state),
        }
    }
}

/// Whether one time comes before another.
pub(super) fn earlier(a: Double, b: Double) -> bool {
    (a - b).high < 0.0
}
