//! Singular configurations of the constraints that the comparison motion comes to, while the motion itself continues.
//!
//! In: the steps of a motion with a comparison motion beside it. Out: the first place of this kind, and errors that name it.
//! Never here: singular configurations of the motion itself.

use super::Propagator;
use super::trial::Trial;
use crate::system::{Form, MotionError, MotionErrorKind};

/// The number of times a step is halved around a place where the directions of the constraints are reversed. Directions that
/// are reversed within such a part of a step jump there: they turn at no rate that the step would resolve.
const HALVINGS: u32 = 20;

/// A motion is continued if it can be followed for this part of the time since its last regular step.
const BEYOND: f64 = 0.05;

impl Propagator {
    /// The time of the first singular configuration that the comparison motion passed, and its coordinates there.
    pub fn comparison_passage(&self) -> Option<(f64, Vec<(String, f64)>)> {
        let (time, place) = self.watch.comparison.first.as_ref()?;
        (*time <= self.state.time).then(|| (*time, self.of_comparison(place)))
    }

    /// Restarts from the current state, which does not continue the motion before.
    pub(super) fn watch_comparison_from_here(&mut self) {
        self.watch.comparison.seen = match (self.system.comparison_place(), &mut self.projector) {
            (Some(first), Some(projector)) if self.state.form == Form::Velocity => projector
                .directions_at(&self.state, first, None)
                .map(|seen| (self.state.time, seen)),
            _ => None,
        };
    }

    /// Checks whether the comparison motion passes a singular configuration in the last step.
    pub(super) fn watch_comparison(&mut self) {
        let (Some(place), Some(projector)) = (self.system.comparison_place(), &mut self.projector)
        else {
            return;
        };
        let (begin, end) = self.stepper.interval();
        let state = self.stepper.state();
        let record = &mut self.watch.comparison;
        if state.form != Form::Velocity || record.first.is_some() {
            return;
        }
        let seen = record.seen.take();
        let like = seen.as_ref().map(|(_, directions)| directions);
        let Some(here) = projector.directions_at(state, place, like) else { return };
        record.seen = Some((end, here.clone()));
        let Some((_, before)) = seen.filter(|(_, before)| before.cosine(&here) < 0.0) else {
            return;
        };
        let (mut low, mut high) = ((begin, before), (end, here));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low.0 + high.0);
            if middle <= low.0 || middle >= high.0 {
                break;
            }
            let sampled = self.stepper.at(middle, &mut self.before).is_ok();
            let there = sampled
                .then(|| projector.directions_at(&self.before, place, Some(&low.1)))
                .flatten();
            // it is not known where it lies on either side
            let Some(there) = there else { break };
            if low.1.cosine(&there) < 0.0 {
                high = (middle, there);
            } else if there.cosine(&high.1) < 0.0 {
                low = (middle, there);
            } else {
                return;
            }
        }
        let time = 0.5 * (low.0 + high.0);
        if self.stepper.at(time, &mut self.before).is_ok() {
            let coordinates = place..place + self.system.degrees();
            record.first = Some((time, self.before.values[coordinates].to_vec()));
        }
    }

    /// Explains an error: one caused by a singular configuration is reported as such, one at a place that another method passes
    /// with that method, and one of the comparison motion alone with the place of that motion.
    pub fn explained(&mut self, error: MotionError) -> MotionError {
        let alone = self.place_of_comparison_alone(&error);
        let error = self.with_cause(error);
        match alone {
            Some(place) => {
                let kind = MotionErrorKind::OfComparison(Box::new(error.kind));
                MotionError { kind, place, ..error }
            }
            None => error,
        }
    }

    /// Where the comparison motion is, if it alone stops the motion: with it begun anew nearby, where the motion itself is, the
    /// same method continues.
    fn place_of_comparison_alone(&mut self, error: &MotionError) -> Option<Vec<(String, f64)>> {
        let first = self.system.comparison_place()?;
        let may_be = matches!(
            error.kind,
            MotionErrorKind::SingularConstraints(None)
                | MotionErrorKind::NotFinite(_)
                | MotionErrorKind::StepUnderflow(_)
                | MotionErrorKind::ClockStands(_)
                | MotionErrorKind::Rough
                | MotionErrorKind::NoSide
        );
        let other = self.stepper.state().values.get(first..first + self.system.degrees())?.to_vec();
        let mut from = self.watch.regular.clone().filter(|_| may_be)?;
        if from.form != self.system.form() || error.time < from.time {
            return None;
        }
        // no farther, since the motion itself may come to such a place soon
        let beyond = trial_length(error.time - from.time, self.stepper.step_size().abs());
        let until = error.time + beyond;
        self.system.begin_auxiliary(&mut from, &self.parameters).ok()?;
        match self.trial(self.method, self.settings, &from, until) {
            Trial::Passed(_) => Some(self.of_comparison(&other)),
            Trial::Stopped | Trial::Unfinished => None,
        }
    }

    fn of_comparison(&self, values: &[f64]) -> Vec<(String, f64)> {
        let names =
            self.system.channels().iter().map(|channel| format!("{} (wrong)", channel.shown));
        names.zip(values.iter().copied()).filter(|(_, x)| x.is_finite()).take(4).collect()
    }
}

/// How far a motion is tried beyond an error, so long after its last regular step and with steps of this size.
fn trial_length(since: f64, step: f64) -> f64 {
    (BEYOND * since).max(step)
}

#[cfg(test)]
mod tests {
    use super::trial_length;

    #[test]
    fn a_motion_is_tried_for_a_twentieth_of_the_time_since_its_last_regular_step() {
        assert!((0.04..0.06).contains(&trial_length(1.0, 1e-9)), "{}", trial_length(1.0, 1e-9));
        assert_eq!(trial_length(1.0, 0.5), 0.5);
    }
}
