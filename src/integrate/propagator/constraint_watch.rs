//! Singular configurations of the constraints on the way of a motion: told where they are passed,
//! and named where they stop it.
//!
//! At such a place the directions of the constraints depend on each other, and several motions may
//! meet. One that runs through it smoothly leaves it with the orientation of these directions
//! reversed: that is how a passage is seen, however long the step. Never here: which constraints hold.

use super::Propagator;
use crate::integrate::{Settings, Stepper, Stepping, method_named};
use crate::num::math;
use crate::system::{
    ConstraintProjector, Directions, Form, MotionError, MotionErrorKind, Passage, State,
};

/// Between two looks whose directions are closer than this cosine nothing has been passed.
const CLOSE: f64 = 0.5;

/// How often the time between two looks is halved to tell a passage from a fast turn.
const HALVINGS: u32 = 60;

/// A step shorter than this part of the regular ones does not count as one of them, …
const REGULAR: f64 = 0.1;

/// … though these become shorter with each: a motion may become faster for good.
const FORGETTING: f64 = 0.9999;

/// A method that may lead past a singular configuration is tried with about so many steps to it, …
const STEPS_THERE: f64 = 50.0;

/// … at most with so many, …
const MOST_STEPS: u32 = 4000;

/// … and once more with half the step: the results may differ by this part.
const AGREES: f64 = 1e-3;

/// From where the motion began it is followed beyond the place by this part of the way to it.
const BEYOND: f64 = 0.05;

/// A number that changes by less than this part of the largest of its kind is not looked at.
const NEGLIGIBLE: f64 = 1e-6;

/// So many steps are tried, each a tenth of the one before.
const STEPS_TRIED: u32 = 3;

/// What is watched of one motion.
#[derive(Clone, Debug, Default)]
pub(super) struct Watch {
    /// When the directions were looked at last, and what they were.
    seen: Option<(f64, Directions)>,
    /// Passages that lie before the end of the last step and are still to come.
    ahead: Vec<f64>,
    passed: u64,
    first: Option<f64>,
    /// A state before steps became much shorter, and the step then.
    regular: Option<State>,
    pace: f64,
    /// Where it last began, or went on anew.
    begun: Option<State>,
}

impl Propagator {
    /// How often the motion has passed a singular configuration of its constraints, and when first.
    pub fn singular_passages(&self) -> (u64, Option<f64>) {
        (self.watch.passed, self.watch.first)
    }

    /// Goes on from the present state, which nothing has led to.
    pub(super) fn watch_from_here(&mut self) {
        self.watch.ahead.clear();
        self.watch.seen = match (&mut self.projector, self.state.form) {
            (Some(projector), Form::Velocity) => {
                projector.directions(&self.state, None).map(|seen| (self.state.time, seen))
            }
            _ => None,
        };
        self.watch.regular = Some(self.state.clone());
        self.watch.begun = Some(self.state.clone());
        self.watch.pace = 0.0;
    }

    /// Notes the state from which the next step is taken, if the last one was not much shorter than
    /// those before.
    pub(super) fn note_regular(&mut self) {
        let (begin, end) = self.stepper.interval();
        let Watch { regular, pace, .. } = &mut self.watch;
        let step = (end - begin).abs();
        if step >= REGULAR * *pace {
            let state = self.stepper.state();
            regular.get_or_insert_with(|| state.clone()).copy_from(state);
            *pace = step;
        } else {
            *pace *= FORGETTING;
        }
    }

    /// Looks whether the step just taken passes a singular configuration.
    pub(super) fn watch_step(&mut self) {
        let Some(projector) = &mut self.projector else { return };
        let (begin, end) = self.stepper.interval();
        let state = self.stepper.state();
        if state.form != Form::Velocity {
            return;
        }
        let Watch { seen, ahead, .. } = &mut self.watch;
        let like = seen.as_ref().map(|(_, directions)| directions);
        let Some(here) = projector.directions(state, like) else { return };
        if let Some((_, before)) = seen {
            let mut look =
                Look { projector, stepper: self.stepper.as_mut(), scratch: &mut self.before };
            look.passages((begin, before), (end, &here), HALVINGS, ahead);
        }
        *seen = Some((end, here));
    }

    /// The motion has come to a time: passages before it have taken place.
    pub(super) fn note_passages(&mut self, time: f64) {
        let Watch { ahead, passed, first, .. } = &mut self.watch;
        ahead.retain(|&passage| {
            if passage <= time {
                *passed += 1;
                first.get_or_insert(passage);
            }
            passage > time
        });
    }

    /// Forgets what was passed.
    pub(super) fn forget_passages(&mut self) {
        self.watch = Watch::default();
    }

    /// A fault that a singular configuration explains is reported as that; and any fault at a place that
    /// another method passes with what passes it.
    pub fn explained(&mut self, fault: MotionError) -> MotionError {
        let may_be_passed = matches!(
            fault.kind,
            MotionErrorKind::SingularConstraints(None)
                | MotionErrorKind::SingularMass
                | MotionErrorKind::ConstraintLost(_)
                | MotionErrorKind::NoConvergence(_)
                | MotionErrorKind::NoVelocities
                | MotionErrorKind::NotFinite(_)
                | MotionErrorKind::StepUnderflow(_)
                | MotionErrorKind::ClockStands(_)
                | MotionErrorKind::Rough
                | MotionErrorKind::Sticks
        );
        if !may_be_passed || self.system.cancel().is_cancelled() {
            return fault;
        }
        let held = self.projector.as_mut().is_some_and(|projector| {
            let state = self.stepper.state();
            matches!(fault.kind, MotionErrorKind::SingularConstraints(_))
                || projector.is_nearly_singular(state, self.watch.regular.as_ref())
        });
        if held {
            let passage = if self.method.stepping == Stepping::Fixed {
                None
            } else {
                self.fixed_past(fault.time)
            };
            return MotionError { kind: MotionErrorKind::SingularConstraints(passage), ..fault };
        }
        match self.way_past(fault.time) {
            Some(passage) => MotionError {
                kind: MotionErrorKind::Passable(Box::new(fault.kind), passage),
                ..fault
            },
            None => fault,
        }
    }

    /// Where a motion that stops at a time is followed from, and until when to be past it: from
    /// nearby, and from where it began.
    fn around(&self, time: f64) -> Vec<(State, f64)> {
        let mut ways = Vec::new();
        for (from, part) in [(&self.watch.regular, 1.0), (&self.watch.begun, BEYOND)] {
            let Some(from) = from else { continue };
            let way = (part * (time - from.time)).max(2.0 * self.stepper.step_size());
            if way > 0.0 && time >= from.time && (time + way).is_finite() {
                ways.push((from.clone(), time + way));
            }
        }
        ways
    }

    /// Another method that leads past a time, if there is one.
    fn way_past(&mut self, time: f64) -> Option<Passage> {
        let (from, until) = self.around(time).into_iter().next()?;
        let settings = Settings { step: None, tolerance: None };
        for name in ["taylor", "dop853"] {
            let method = method_named(name).filter(|method| method.name != self.method.name);
            let Some(method) = method else { continue };
            if self.lead_past(method, settings, &from, until).is_some() {
                return Some(Passage { method: method.name, step: None });
            }
        }
        if self.method.stepping == Stepping::Fixed { None } else { self.fixed_past(time) }
    }

    /// A fixed step with which the motion is led past a time, if there is one.
    fn fixed_past(&mut self, time: f64) -> Option<Passage> {
        let method = method_named("rk4")?;
        for (from, until) in self.around(time) {
            let steps = (time - from.time) / STEPS_THERE;
            let mut step = math::powi(10.0, math::log10(steps).floor() as i32);
            for _ in 0..STEPS_TRIED {
                let settings = |step| Settings { step: Some(step), tolerance: None };
                let coarse = self.lead_past(method, settings(step), &from, until);
                let fine = self.lead_past(method, settings(0.5 * step), &from, until);
                if let (Some(coarse), Some(fine)) = (coarse, fine)
                    && agree(&from, &coarse, &fine, self.system.degrees())
                {
                    return Some(Passage { method: method.name, step: Some(step) });
                }
                step *= 0.1;
            }
        }
        None
    }

    /// The motion led from a state to a time by a method.
    fn lead_past(
        &mut self,
        method: &'static crate::integrate::Method,
        settings: Settings,
        from: &State,
        until: f64,
    ) -> Option<State> {
        let mut stepper = (method.make)(&self.system, &settings).ok()?;
        stepper.start(from, &self.parameters).ok()?;
        let mut state = from.clone();
        for _ in 0..MOST_STEPS {
            if stepper.time() >= until {
                stepper.at(until, &mut state).ok()?;
                return Some(state);
            }
            stepper.step(until).ok()?;
            state.copy_from(stepper.state());
            if let Some(projector) = &mut self.projector {
                projector.project(&mut state).ok()?;
                stepper.replace_state(&state);
            }
        }
        None
    }
}

/// Whether two ways from a state end at the same place. Numbers are measured by what they change,
/// and by the largest of their kind: one may be nothing but rounding.
fn agree(from: &State, coarse: &State, fine: &State, degrees: usize) -> bool {
    let kinds = [0..degrees, degrees..(2 * degrees).min(from.values.len())];
    kinds.into_iter().all(|kind| {
        let apart = |x: &State, y: &State, i: usize| (x.values[i] - y.values[i]).abs();
        let largest = kind.clone().map(|i| apart(fine, from, i)).fold(0.0, f64::max);
        kind.clone().all(|i| {
            let size = apart(fine, from, i).max(NEGLIGIBLE * largest);
            apart(coarse, fine, i) <= AGREES * size
        })
    })
}

/// What looks at the directions within a step.
struct Look<'a> {
    projector: &'a mut ConstraintProjector,
    stepper: &'a mut dyn Stepper,
    scratch: &'a mut State,
}

impl Look<'_> {
    /// When the directions are reversed between two looks: at least once halfway, then wherever they
    /// are far apart.
    fn passages(
        &mut self,
        (begin, before): (f64, &Directions),
        (end, after): (f64, &Directions),
        halvings: u32,
        found: &mut Vec<f64>,
    ) {
        let cosine = before.cosine(after);
        if cosine > CLOSE && halvings < HALVINGS {
            return;
        }
        let middle = 0.5 * (begin + end);
        if halvings == 0 || middle <= begin || middle >= end {
            if cosine < 0.0 {
                found.push(middle);
            }
            return;
        }
        let seen = self.stepper.at(middle, self.scratch).is_ok();
        let there = if seen { self.projector.directions(self.scratch, Some(before)) } else { None };
        let Some(there) = there else { return found.push(middle) };
        self.passages((begin, before), (middle, &there), halvings - 1, found);
        self.passages((middle, &there), (end, after), halvings - 1, found);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(values: [f64; 4]) -> State {
        State::new(0.0, Form::Velocity, values.to_vec())
    }

    #[test]
    fn two_ways_agree_to_a_thousandth_of_what_moves() {
        let from = state([0.0; 4]);
        let agrees = |off: f64| {
            let fine = state([1.0, 1.0, 2.0, 1.0]);
            agree(&from, &state([1.0, 1.0, 2.0 * (1.0 + off), 1.0]), &fine, 2)
        };
        assert!(agrees(0.8e-3));
        assert!(!agrees(1.2e-3));
    }

    #[test]
    fn a_number_that_moves_by_less_than_a_millionth_is_noise() {
        let from = state([0.0; 4]);
        let agrees = |noise: f64| {
            agree(&from, &state([1.0, noise, 1.0, 0.0]), &state([1.0, 0.0, 1.0, 0.0]), 2)
        };
        assert!(agrees(0.8e-9));
        assert!(!agrees(1.2e-9));
    }
}
