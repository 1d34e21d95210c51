//! Motion along a kink, as that of a body at rest under dry friction: no size of a step has an error there that its tolerance allows.
//! The steps are those of the default method, which follows kinks, until the motion leaves.
//!
//! In: a state at which the laws on both sides lead towards a kink, or on one where the motion begins. Out: steps, and the first
//! state beside it. Never here: how a kink is followed (`taylor`), when one is met (`kinks`).

use super::kink_course::KinkCourse;
use super::{DormandPrince, FIRST};
use crate::integrate::clock::spacing;
use crate::integrate::dense_output::DenseOutput;
use crate::integrate::method::Settings;
use crate::integrate::stepper::Stepper;
use crate::integrate::taylor::Taylor;
use crate::num::DoubleDouble;
use crate::system::{MotionError, MotionErrorKind, State};

/// A kink within so many digits of the clock after the start is followed to.
const SOON: f64 = 64.0;

impl DormandPrince {
    /// Whether the next step follows a kink. If the motion has left one, steps are its own from here on.
    pub(super) fn is_along_kink(&mut self) -> bool {
        if let KinkCourse::Left(taylor) = &self.course {
            self.size = FIRST * taylor.step_size().abs();
            self.course = KinkCourse::Away;
            self.crossings = 0;
            self.noise.fill(0.0);
            self.stale = true;
        }
        matches!(self.course, KinkCourse::Along(_))
    }

    /// At the start: follows a kink on which the motion begins, or just before which.
    pub(super) fn begin_beside_kinks(&mut self) -> Result<(), MotionError> {
        self.course = KinkCourse::Away;
        if !self.system.has_kinks() {
            return Ok(());
        }
        let numbers: Vec<DoubleDouble> =
            (0..self.state.values.len()).map(|i| self.state.exact(i)).collect();
        self.exact.evaluate(self.state.exact_time(), &numbers)?;
        let switches = self.rates.sides().switches();
        let here: Vec<f64> = (0..switches).map(|i| self.exact.switch(i)).collect();
        // nearer than a step of the clock can be divided
        let soon = DoubleDouble::from(SOON * spacing(self.state.time));
        let later: Vec<DoubleDouble> =
            numbers.iter().enumerate().map(|(i, &x)| x + self.exact.rate(i) * soon).collect();
        let later = match self.exact.evaluate(self.state.exact_time() + soon, &later) {
            Ok(()) => (0..switches).map(|i| self.exact.switch(i)).collect(),
            Err(_) => here.clone(),
        };
        let is_near = |(here, later): (&f64, &f64)| {
            *here == 0.0 || *here > 0.0 && *later < 0.0 || *here < 0.0 && *later > 0.0
        };
        if here.iter().zip(&later).any(is_near) { self.follow_kink() } else { Ok(()) }
    }

    pub(super) fn follow_kink(&mut self) -> Result<(), MotionError> {
        let Ok(mut taylor) = Taylor::new(&self.system, &Settings::default()) else {
            return Ok(());
        };
        taylor.start(&self.state, &self.parameters)?;
        self.course = KinkCourse::Along(Box::new(taylor));
        Ok(())
    }

    /// Whether a motion whose steps have become too small is on its way to a kink, which it then follows: where a number goes to zero
    /// there, no step is so short that its error relative to that number is small.
    pub(super) fn goes_to_kink(&mut self, limit: f64) -> Result<bool, MotionError> {
        if !self.system.has_kinks() {
            return Ok(false);
        }
        self.follow_kink()?;
        let course = std::mem::replace(&mut self.course, KinkCourse::Away);
        let KinkCourse::Along(mut ahead) = course else { return Ok(false) };
        match ahead.step(limit) {
            Ok(()) if !ahead.is_beside_kinks() => self.follow_kink()?,
            Err(error) if error.kind == MotionErrorKind::Cancelled => return Err(error),
            // it ends where the step has become too small
            Ok(()) | Err(_) => return Ok(false),
        }
        Ok(true)
    }

    /// Takes a step of the method that follows kinks.
    pub(super) fn step_along_kink(&mut self, limit: f64) -> Result<(), MotionError> {
        let KinkCourse::Along(mut taylor) = std::mem::replace(&mut self.course, KinkCourse::Away)
        else {
            return Ok(());
        };
        let outcome = taylor.step(limit);
        if outcome.is_ok() {
            std::mem::swap(&mut self.before, &mut self.state);
            self.state.copy_from(taylor.state());
            self.has_interpolant = false;
        }
        self.course = if outcome.is_ok() && taylor.is_beside_kinks() {
            KinkCourse::Left(taylor)
        } else {
            KinkCourse::Along(taylor)
        };
        outcome
    }

    pub(super) fn replace_along_kink(&mut self, state: &State) {
        if let KinkCourse::Along(taylor) = &mut self.course {
            taylor.replace_state(state);
        }
    }

    /// Writes the state at a time within the last step into `out`, if that step followed a kink.
    pub(super) fn at_along_kink(
        &mut self,
        time: f64,
        out: &mut State,
    ) -> Option<Result<(), MotionError>> {
        match &mut self.course {
            KinkCourse::Away => None,
            KinkCourse::Along(taylor) | KinkCourse::Left(taylor) => Some(taylor.at(time, out)),
        }
    }
}
