//! Equal steps that pass a narrow place of the law, as a thin barrier, without having been there.
//!
//! In: the ends of steps. Out: the first such passage. Never here: how it is seen.

use super::Propagator;
use crate::integrate::Stepping;
use crate::integrate::narrow_place::PassedPlaces;

/// A step that may have missed a narrow feature of the law.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct NarrowPassage {
    /// When it ended.
    pub time: f64,
    /// Its length.
    pub step: f64,
}

impl Propagator {
    /// The first step that has passed a place where an exponential function in the law changes by more than a step can tell.
    pub fn narrow_passage(&self) -> Option<NarrowPassage> {
        self.narrow_passage
    }

    /// Begins to watch, by a method whose steps are equal.
    pub(super) fn watch_narrow_places(&mut self) {
        self.narrow = match self.method.stepping {
            Stepping::Fixed => self.system.steep_arguments(&self.parameters).map(PassedPlaces::new),
            Stepping::Adaptive => None,
        };
        self.note_narrow_place();
    }

    pub(super) fn note_narrow_place(&mut self) {
        let Some(places) = self.narrow.as_mut().filter(|_| self.narrow_passage.is_none()) else {
            return;
        };
        let state = self.stepper.state();
        if places.has_passed(state) {
            self.narrow_passage =
                Some(NarrowPassage { time: state.time, step: self.stepper.step_size().abs() });
        }
    }
}
