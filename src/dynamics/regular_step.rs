//! Whether the steps of a motion have begun to vanish, as they do towards a singular place.
//!
//! In: their lengths. Out: whether they vanish. Never here: what lies there.

/// A step below this part of those before it leads up to a singular place.
const VANISHING: f64 = 1e-6;

/// What steps are compared with shrinks by this factor with each, as a motion may become faster for good.
const FORGETTING: f64 = 0.99;

/// The length of the steps before they began to vanish.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RegularStep(f64);

impl RegularStep {
    /// Records the length of the next step, and returns whether it is one of those that vanish.
    pub(super) fn vanishes_with(&mut self, step: f64) -> bool {
        let is_vanishing = step <= VANISHING * self.0;
        self.0 = step.max(FORGETTING * self.0);
        is_vanishing
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::math;

    #[test]
    fn steps_that_shrink_fast_vanish_and_those_of_a_faster_motion_do_not() {
        let (mut halved, mut faster) = (RegularStep::default(), RegularStep::default());
        let vanish = |steps: &mut RegularStep, factor: f64, count: i32| {
            (0..count).any(|k| steps.vanishes_with(math::powi(factor, k)))
        };
        assert!(!vanish(&mut halved, 0.5, 19));
        assert!(vanish(&mut RegularStep::default(), 0.5, 24));
        assert!(!vanish(&mut faster, 0.995, 4000));
    }
}
