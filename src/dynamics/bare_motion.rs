//! A motion without the vectors that another one carries.
//!
//! In: where the motion began, a time. Out: the step that leads over it. Never here: vectors.

use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Propagator, Reached, Settings};
use crate::system::{State, System};

/// A motion is continued beyond a time if it can be followed for this part of the time that it has lasted.
const BEYOND: f64 = 1e-2;

/// A motion that was carried with vectors.
pub(super) struct BareMotion<'a> {
    pub(super) space: &'a PhaseSpace,
    pub(super) method: (&'static Method, Settings),
    /// Where it began, as a state of the system that carries the vectors.
    pub(super) begun: &'a State,
    pub(super) carried_by: &'a System,
    /// Whether impulses act or constraints hold.
    pub(super) jumps: bool,
    /// The most steps: without vectors they are no shorter.
    pub(super) steps: u64,
}

impl BareMotion<'_> {
    /// The length of the step that contains a time; `None` where the motion cannot be continued beyond it.
    pub(super) fn step_over(&self, time: f64) -> Option<f64> {
        let lasted = time - self.begun.time;
        if lasted == 0.0 {
            return None;
        }
        let start = self.space.system().extended(self.begun, self.carried_by);
        let beyond = time + BEYOND * lasted;
        if self.jumps {
            self.by_propagator(&start, time, beyond)
        } else {
            self.by_steps(&start, time, beyond)
        }
    }

    fn by_steps(&self, start: &State, time: f64, beyond: f64) -> Option<f64> {
        let (method, settings) = self.method;
        let mut stepper = (method.make)(self.space.system(), &settings).ok()?;
        stepper.start(start, self.space.parameters()).ok()?;
        let mut over = None;
        for _ in 0..=self.steps {
            stepper.step(beyond).ok()?;
            over = over.or_else(|| containing(stepper.interval(), time));
            if stepper.time() == beyond {
                return over;
            }
        }
        None
    }

    fn by_propagator(&self, start: &State, time: f64, beyond: f64) -> Option<f64> {
        let (method, settings) = self.method;
        let parameters = self.space.parameters();
        let mut motion = Propagator::new(self.space.system(), method, settings, parameters).ok()?;
        motion.begin(start, parameters).ok()?;
        let mut over = None;
        for _ in 0..=self.steps {
            let begin = motion.undisturbed().1;
            let reached = motion.reach_unexplained(beyond, beyond, &mut 1).ok()?;
            over = over.or_else(|| containing((begin, motion.undisturbed().1), time));
            match reached {
                Reached::Arrived => return over,
                Reached::OutOfBudget | Reached::Occurred(_) => {}
                Reached::Ended => return None,
            }
        }
        None
    }
}

/// The length of an interval that contains a time.
fn containing((begin, end): (f64, f64), time: f64) -> Option<f64> {
    let contains = (begin.min(end)..=begin.max(end)).contains(&time);
    (contains && begin != end).then(|| (end - begin).abs())
}
