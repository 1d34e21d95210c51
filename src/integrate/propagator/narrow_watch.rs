//! Equal steps that pass a narrow place of the law, as a thin barrier, without having been there.
//!
//! In: the ends of steps. Out: the first such passage. Never here: how it is seen.

use super::Propagator;
use crate::integrate::Stepping;
use crate::integrate::narrow_place::PassedPlaces;
use crate::integrate::passed_poles::{PassedPoles, PoleOfStep};
use crate::system::{MotionError, MotionErrorKind};

/// What a step has passed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum NarrowPlace {
    /// One where an exponential function changes by more than the step can tell.
    Exponential,
    /// A pole.
    Pole,
}

/// A step that may have missed a narrow feature of the law.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct NarrowPassage {
    /// When it ended.
    pub time: f64,
    /// Its length.
    pub step: f64,
    /// What it has passed.
    pub place: NarrowPlace,
}

impl Propagator {
    /// The first step that has passed a place where the law changes by more than a step can tell.
    pub fn narrow_passage(&self) -> Option<NarrowPassage> {
        self.narrow_passage
    }

    /// Begins to watch, by a method whose steps are equal.
    ///
    /// # Errors
    /// Returns an error if the motion begins on a pole.
    pub(super) fn watch_narrow_places(&mut self) -> Result<(), MotionError> {
        (self.narrow, self.poles) = match self.method.stepping {
            Stepping::Fixed => (
                self.system.steep_arguments(&self.parameters).map(PassedPlaces::new),
                PassedPoles::of(&self.system, &self.parameters, &self.state),
            ),
            Stepping::Adaptive => (None, None),
        };
        self.note_narrow_place()
    }

    /// Records the end of a step.
    ///
    /// # Errors
    /// Returns an error if it is on a pole.
    pub(super) fn note_narrow_place(&mut self) -> Result<(), MotionError> {
        let state = self.stepper.state();
        let pole = self.poles.as_mut().and_then(|poles| poles.find(state));
        if pole == Some(PoleOfStep::Reached) {
            let kind = MotionErrorKind::NotFiniteInStep("a force".to_owned());
            return Err(self.system.error(kind, state.time, &state.values));
        }
        if self.narrow_passage.is_some() {
            return Ok(());
        }
        let place = if self.narrow.as_mut().is_some_and(|places| places.has_passed(state)) {
            NarrowPlace::Exponential
        } else if pole.is_some() {
            NarrowPlace::Pole
        } else {
            return Ok(());
        };
        let (time, step) = (state.time, self.stepper.step_size().abs());
        self.narrow_passage = Some(NarrowPassage { time, step, place });
        Ok(())
    }
}
