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
        self.watch.regular = self.projector.as_ref().map(|_| self.state.clone());
        self.watch.pace = 0.0;
    }

    /// Looks whether the step just taken passes a singular configuration.
    pub(super) fn watch_step(&mut self) {
        let Some(projector) = &mut self.projector else { return };
        let (begin, end) = self.stepper.interval();
        let state = self.stepper.state();
        if state.form != Form::Velocity {
            return;
        }
        let Watch { seen, ahead, regular, pace, .. } = &mut self.watch;
        if end - begin >= REGULAR * *pace {
            regular.get_or_insert_with(|| state.clone()).copy_from(state);
            *pace = end - begin;
        } else {
            *pace *= FORGETTING;
        }
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

    /// A fault that a singular configuration explains is reported as that, and with what leads past it.
    pub(super) fn explained(&mut self, fault: MotionError) -> MotionError {
        let may_be = matches!(
            fault.kind,
            MotionErrorKind::SingularConstraints(None)
                | MotionErrorKind::SingularMass
                | MotionErrorKind::ConstraintLost(_)
                | MotionErrorKind::NoConvergence(_)
                | MotionErrorKind::NotFinite(_)
                | MotionErrorKind::StepUnderflow(_)
                | MotionErrorKind::ClockStands(_)
        );
        let Some(projector) = self.projector.as_mut().filter(|_| may_be) else { return fault };
        let singular = matches!(fault.kind, MotionErrorKind::SingularConstraints(_));
        let state = self.stepper.state();
        if !singular && !projector.is_nearly_singular(state, self.watch.regular.as_ref()) {
            return fault;
        }
        let passage = self.way_past(fault.time);
        MotionError { kind: MotionErrorKind::SingularConstraints(passage), ..fault }
    }

    /// A fixed step with which the motion is led past a time, if there is one.
    fn way_past(&mut self, time: f64) -> Option<Passage> {
        if self.method.stepping == Stepping::Fixed {
            return None;
        }
        let from = self.watch.regular.clone()?;
        let way = time - from.time;
        if way <= 0.0 || !way.is_finite() {
            return None;
        }
        let method = method_named("rk4")?;
        let step = math::powi(10.0, math::log10(way / STEPS_THERE).floor() as i32);
        let coarse = self.lead_past(method, &from, time + way, step)?;
        let fine = self.lead_past(method, &from, time + way, 0.5 * step)?;
        let agree = |((a, b), c): ((&f64, &f64), &f64)| {
            (a - b).abs() <= AGREES * (a - c).abs().max(b.abs())
        };
        let all = coarse.values.iter().zip(&fine.values).zip(&from.values).all(agree);
        all.then_some(Passage { method: method.name, step })
    }

    /// The motion led from a state to a time by a method of fixed step.
    fn lead_past(
        &mut self,
        method: &'static crate::integrate::Method,
        from: &State,
        until: f64,
        step: f64,
    ) -> Option<State> {
        let settings = Settings { step: Some(step), tolerance: None };
        let mut stepper = (method.make)(&self.system, &settings).ok()?;
        stepper.start(from, &self.parameters).ok()?;
        let mut state = from.clone();
        for _ in 0..MOST_STEPS {
            if stepper.time() >= until {
                return Some(state);
            }
            stepper.step(until).ok()?;
            state.copy_from(stepper.state());
            self.projector.as_mut()?.project(&mut state).ok()?;
            stepper.replace_state(&state);
        }
        None
    }
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
