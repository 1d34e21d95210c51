//! Equal steps that pass a narrow place of the law, as a thin barrier, without having been there.
//!
//! In: the ends of steps. Out: the first such passage. Never here: how it is seen.

use super::Propagator;
use crate::integrate::Stepping;
use crate::integrate::narrow_place::PassedPlaces;
use crate::integrate::passed_poles::PassedPoles;

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
    pub(super) fn watch_narrow_places(&mut self) {
        (self.narrow, self.poles) = match self.method.stepping {
            Stepping::Fixed => (
                self.system.steep_arguments(&self.parameters).map(PassedPlaces::new),
                PassedPoles::of(&self.system, &self.parameters, &self.state),
            ),
            Stepping::Adaptive => (None, None),
        };
        self.note_narrow_place();
    }

    pub(super) fn note_narrow_place(&mut self) {
        if self.narrow_passage.is_some() {
            return;
        }
        let state = self.stepper.state();
        let place = if self.narrow.as_mut().is_some_and(|places| places.has_passed(state)) {
            NarrowPlace::Exponential
        } else if self.poles.as_mut().is_some_and(|poles| poles.has_passed(state)) {
            NarrowPlace::Pole
        } else {
            return;
        };
        let (time, step) = (state.time, self.stepper.step_size().abs());
        self.narrow_passage = Some(NarrowPassage { time, step, place });
    }
}
