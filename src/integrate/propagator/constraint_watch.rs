//! Singular configurations of the constraints along a motion: reported where they are passed, and
//! given as the reason where they stop it.
//!
//! At such a configuration the directions of the constraints are dependent, and several motions may
//! meet. A motion that passes it smoothly leaves it with the orientation of these directions
//! reversed; this detects a passage, however long the step. Never here: which constraints are
//! enforced.

use super::Propagator;
use super::singularity_record::SingularityRecord;
use crate::integrate::{Stepper, Stepping, StoppedMotion};
use crate::num::math;
use crate::system::{
    ConstraintDirections, ConstraintProjector, Form, MotionError, MotionErrorKind, State, System,
};

/// Between two samples whose directions have at least this cosine nothing has been passed.
const CLOSE: f64 = 0.5;

/// The number of times the interval between two samples is halved to distinguish a passage from a
/// fast rotation.
const HALVINGS: u32 = 60;

/// A rotation within a part of the step that is as small as this multiple of the tolerance counts as a passage: the
/// states in between keep the constraints no better than that.
const BLURRED: f64 = 100.0;

/// Numbers and times above this have left all that a motion is about: they overflow soon after.
const VAST: f64 = 1e100;

/// In a step shorter than this part of the regular ones velocities do not change by half of their size.
const SUDDEN: f64 = 1e-4;

/// Rounding noise of velocities has less than this part in the kinetic energy.
const NOISE: f64 = 1e-20;

/// A step shorter than this part of the regular ones is not regular.
const REGULAR: f64 = 0.1;

/// The length of regular steps shrinks by this factor with each step, as a motion may become faster for good.
const FORGETTING: f64 = 0.9999;

impl Propagator {
    /// The number of singular configurations passed, and the time of the first.
    pub fn singular_passages(&self) -> (u64, Option<f64>) {
        (self.watch.passed, self.watch.first)
    }

    /// Restarts from the current state, which does not continue the motion before.
    pub(super) fn watch_from_here(&mut self) {
        self.watch.ahead.clear();
        self.watch.corner = None;
        self.watch.seen = match (&mut self.projector, self.state.form) {
            (Some(projector), Form::Velocity) => {
                projector.directions(&self.state, None).map(|seen| (self.state.time, seen))
            }
            _ => None,
        };
        self.watch_comparison_from_here();
        self.watch.left = Some(self.state.clone());
        self.watch.regular = Some(self.state.clone());
        self.watch.begun = Some(self.state.clone());
        self.watch.regular_step = 0.0;
        self.watch.fastest.clear();
    }

    /// Records the state from which the next step is taken, if the last one was not much shorter
    /// than those before.
    pub(super) fn note_regular(&mut self) {
        let (begin, end) = self.stepper.interval();
        let SingularityRecord { regular, regular_step, .. } = &mut self.watch;
        let step = (end - begin).abs();
        if step >= REGULAR * *regular_step {
            let state = self.stepper.state();
            regular.get_or_insert_with(|| state.clone()).copy_from(state);
            *regular_step = step;
        } else {
            *regular_step *= FORGETTING;
        }
    }

    /// Returns an error if the velocities have changed at once: at a singular configuration rounding may lead on another of
    /// the motions that meet there, with the same energy.
    pub(super) fn check_course(&mut self) -> Result<(), MotionError> {
        let (begin, end) = self.stepper.interval();
        let state = self.stepper.state();
        if state.form != Form::Velocity || self.projector.is_none() {
            return Ok(());
        }
        let n = self.system.degrees();
        let SingularityRecord { regular_step, fastest, left, .. } = &mut self.watch;
        let Some(was) = left else {
            *left = Some(state.clone());
            return Ok(());
        };
        let [now, before] = [state, &*was].map(|state| &state.values[n..2 * n]);
        let step = (end - begin).abs();
        if step >= REGULAR * *regular_step {
            fastest.resize(n, 0.0);
            fastest.iter_mut().zip(now).for_each(|(most, v)| *most = most.max(v.abs()));
        }
        if step < SUDDEN * *regular_step
            && has_jumped((before, now), fastest)
            && is_felt(&self.system, (&*was, state), (fastest, &self.parameters))
        {
            let kind = MotionErrorKind::SingularConstraints(None);
            return Err(self.system.error(kind, begin, &was.values));
        }
        was.copy_from(state);
        Ok(())
    }

    /// Checks whether the last step passes a singular configuration.
    pub(super) fn watch_step(&mut self) {
        let Some(projector) = &mut self.projector else { return };
        let (begin, end) = self.stepper.interval();
        let state = self.stepper.state();
        if state.form != Form::Velocity {
            return;
        }
        let SingularityRecord { seen, ahead, .. } = &mut self.watch;
        let like = seen.as_ref().map(|(_, directions)| directions);
        let Some(here) = projector.directions(state, like) else { return };
        if let Some((_, before)) = seen {
            let resolved =
                |tolerance: f64| -math::log10(BLURRED * tolerance) / std::f64::consts::LOG10_2;
            let halvings = self.stepper.tolerance().map_or(f64::INFINITY, resolved);
            let most = halvings.clamp(1.0, HALVINGS.into()) as u32;
            let mut sampler = DirectionSampler {
                projector,
                stepper: self.stepper.as_mut(),
                scratch: &mut self.before,
                most,
            };
            sampler.passages((begin, before), (end, &here), most, ahead);
        }
        *seen = Some((end, here));
    }

    /// Records the passages before a time that the motion has reached.
    pub(super) fn note_passages(&mut self, time: f64) {
        let SingularityRecord { ahead, passed, first, .. } = &mut self.watch;
        ahead.retain(|&passage| {
            if passage <= time {
                *passed += 1;
                first.get_or_insert(passage);
            }
            passage > time
        });
    }

    pub(super) fn forget_passages(&mut self) {
        self.watch = SingularityRecord::default();
    }

    /// Explains an error: one caused by a singular configuration is reported as such, and one at a
    /// place that another method passes is reported with that method.
    pub(super) fn with_cause(&mut self, error: MotionError) -> MotionError {
        let stopped = StoppedMotion {
            system: &self.system,
            method: self.method,
            stepper: self.stepper.as_ref(),
            parameters: &self.parameters,
            begun: self.watch.begun.as_ref(),
        };
        if let Some(known) = stopped.blow_up(&error).or_else(|| stopped.beyond_the_clock(&error)) {
            return known;
        }
        if let Some(kind) = self.out_of_range(&error) {
            let kind = self.of_step(kind, error.time);
            return MotionError { kind, place: Vec::new(), ..error };
        }
        if let MotionErrorKind::ConstraintContradicts(_) = error.kind {
            return self.at_the_beginning_of_the_step(error);
        }
        let may_be_passed = matches!(
            error.kind,
            MotionErrorKind::SingularConstraints(None)
                | MotionErrorKind::SingularMass
                | MotionErrorKind::ConstraintLost(_)
                | MotionErrorKind::NoConvergence(_)
                | MotionErrorKind::NoVelocities
                | MotionErrorKind::NotFinite(_)
                | MotionErrorKind::StepUnderflow(_)
                | MotionErrorKind::ClockStands(_)
                | MotionErrorKind::Rough
                | MotionErrorKind::NoSide
                | MotionErrorKind::Sticks
        );
        // trials leave impulses out
        let of_impulse = matches!(error.kind, MotionErrorKind::NoVelocities)
            && !self.system.discontinuities().impulses.is_empty();
        if !may_be_passed || of_impulse || self.system.cancel().is_cancelled() {
            return error;
        }
        let is_singular = self.projector.as_mut().is_some_and(|projector| {
            let state = self.stepper.state();
            // steps follow a row that vanishes slowly
            let is_lost = matches!(error.kind, MotionErrorKind::ConstraintLost(_));
            matches!(error.kind, MotionErrorKind::SingularConstraints(_))
                || projector.is_nearly_singular(state, self.watch.regular.as_ref())
                || is_lost && projector.is_nearly_singular(state, self.watch.begun.as_ref())
        });
        if is_singular {
            let passage = if self.method.stepping == Stepping::Fixed {
                None
            } else {
                self.fixed_past(error.time)
            };
            return MotionError { kind: MotionErrorKind::SingularConstraints(passage), ..error };
        }
        // a method that does not locate kinks may stop so at one
        let steep = self.method.locates_kinks && self.is_steep(&error.kind);
        let passage = if steep { None } else { self.way_past(error.time) };
        match passage {
            Some(passage) => MotionError {
                kind: MotionErrorKind::Passable(Box::new(error.kind), passage),
                ..error
            },
            None if self.method.stepping == Stepping::Fixed => {
                let kind = match error.kind {
                    MotionErrorKind::NotFinite(name) => MotionErrorKind::NotFiniteInStep(name),
                    MotionErrorKind::NoVelocities => MotionErrorKind::NoVelocitiesInStep,
                    MotionErrorKind::SingularMass if error.time != self.stepper.time() => {
                        MotionErrorKind::SingularMassInStep
                    }
                    MotionErrorKind::ConstraintLost(name) => {
                        MotionErrorKind::ConstraintLostInStep(name)
                    }
                    kind => kind,
                };
                MotionError { kind, ..error }
            }
            None if !steep && self.has_unbounded_force(&error.kind) => match error.kind {
                MotionErrorKind::StepUnderflow(step) => {
                    MotionError { kind: MotionErrorKind::ForceUnbounded(step), ..error }
                }
                _ => error,
            },
            None => self.with_singular_mass(error),
        }
    }

    /// The same error at the beginning of the step, where all constraints were still satisfied.
    fn at_the_beginning_of_the_step(&mut self, error: MotionError) -> MotionError {
        let (begin, _) = self.stepper.interval();
        let mut state = self.state.clone();
        match self.stepper.at(begin, &mut state) {
            Ok(()) => self.system.error(error.kind, begin, &state.values),
            Err(_) => error,
        }
    }

    /// What has grown beyond the range of numbers by the fault of a fixed step: the motion itself does not grow so.
    fn of_step(&mut self, kind: MotionErrorKind, time: f64) -> MotionErrorKind {
        match kind {
            MotionErrorKind::OutOfRange(Some(name)) if self.method.stepping == Stepping::Fixed => {
                match self.stays_in_range(time, is_vast) {
                    Some(true) => {
                        MotionErrorKind::OutOfRangeInStep(name, self.stepper.step_size().abs())
                    }
                    Some(false) | None => MotionErrorKind::OutOfRange(Some(name)),
                }
            }
            kind => kind,
        }
    }

    /// Whether a number that is not finite, or momenta without velocities, have only grown beyond the range of numbers, far from all
    /// singularities.
    fn out_of_range(&mut self, error: &MotionError) -> Option<MotionErrorKind> {
        let is_far = |at: &&(String, f64)| at.1.abs() > VAST;
        let name = match &error.kind {
            MotionErrorKind::NotFinite(name) => name,
            MotionErrorKind::NoVelocities => &error.place.iter().find(is_far)?.0,
            _ => return None,
        };
        if error.time.abs() > VAST {
            return Some(MotionErrorKind::OutOfRange(None));
        }
        let (begin, _) = self.stepper.interval();
        let mut origin = self.state.clone();
        let before = self.stepper.at(begin, &mut origin).is_ok().then_some(origin);
        let last = self.stepper.state().clone();
        let grown = [Some(last), before]
            .into_iter()
            .flatten()
            .any(|state| is_vast(&state) || state.is_finite() && self.has_run_away(&state));
        // the series of the last step may have no values
        let grown = grown || error.place.iter().any(|at| is_far(&at));
        grown.then(|| MotionErrorKind::OutOfRange(Some(name.clone())))
    }
}

/// Whether a number of a state is far beyond all that motions reach.
fn is_vast(state: &State) -> bool {
    state.is_finite() && state.values.iter().any(|value| value.abs() > VAST)
}

/// Whether velocities have changed by more than half of their size, of which some are near the greatest so far: where a motion turns
/// back, small ones change by much of themselves. Each is measured by the greatest of its own, whatever its unit.
fn has_jumped((before, now): (&[f64], &[f64]), greatest: &[f64]) -> bool {
    let size = |part: &dyn Fn(usize) -> f64| {
        let parts = greatest.iter().enumerate().filter(|(_, most)| **most > 0.0);
        parts.map(|(i, most)| part(i).abs() / most).fold(0.0, f64::max)
    };
    let (was, change) = (size(&|i| before[i]), size(&|i| now[i] - before[i]));
    was > 0.5 && change > 0.5 * was
}

/// Whether the velocities that have changed by more than half of their own greatest have a part in the kinetic energy: the
/// velocity of a coordinate that is at rest is rounding noise, which changes by all of itself.
fn is_felt(
    system: &System,
    (before, now): (&State, &State),
    (greatest, parameters): (&[f64], &[f64]),
) -> bool {
    let n = system.degrees();
    let momenta = |state| system.convert(state, Form::Momentum, parameters);
    let (Ok(p), Ok(p_now)) = (momenta(before), momenta(now)) else { return true };
    let terms = |i: usize| {
        let (v, p) = (before.values[n + i], p.values[n + i]);
        let (dv, dp) = (now.values[n + i] - v, p_now.values[n + i] - p);
        let jumps = dv.abs() > 0.5 * greatest[i];
        [(p * v).abs(), if jumps { (dp * dv).abs() } else { 0.0 }]
    };
    let all =
        (0..n).map(terms).fold([0.0, 0.0], |sum, [of, change]| [sum[0] + of, sum[1] + change]);
    is_above_noise(all)
}

/// Whether what has changed of an energy is more than the rounding noise of velocities makes.
fn is_above_noise([energy, change]: [f64; 2]) -> bool {
    change > NOISE * energy
}

/// Samples the directions within a step.
struct DirectionSampler<'a> {
    projector: &'a mut ConstraintProjector,
    stepper: &'a mut dyn Stepper,
    scratch: &'a mut State,
    /// The number of halvings of the whole interval.
    most: u32,
}

impl DirectionSampler<'_> {
    /// The times at which the directions are reversed between two samples. Samples at least
    /// halfway, then wherever the directions are far apart.
    fn passages(
        &mut self,
        (begin, before): (f64, &ConstraintDirections),
        (end, after): (f64, &ConstraintDirections),
        halvings: u32,
        found: &mut Vec<f64>,
    ) {
        let cosine = before.cosine(after);
        if cosine > CLOSE && halvings < self.most {
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
    use super::{has_jumped, is_above_noise};

    /// A velocity of metres a second and one of radians a second, in these units and in others.
    #[test]
    fn a_jump_is_one_in_any_units() {
        for unit in [1e-9, 1.0, 1e9] {
            let jumped = |before: [f64; 2], now: [f64; 2]| {
                let scaled = |[v, w]: [f64; 2]| [v * unit, w];
                has_jumped((&scaled(before), &scaled(now)), &scaled([1.0, 2.0]))
            };
            assert!(jumped([0.1, 1.8], [0.1, -1.8]), "{unit}");
            assert!(jumped([0.9, 0.1], [-0.9, 0.1]), "{unit}");
            assert!(!jumped([0.9, 1.8], [0.8, 1.7]), "{unit}");
            // it turns back
            assert!(!jumped([0.1, 0.2], [-0.1, -0.2]), "{unit}");
        }
        assert!(!has_jumped((&[0.0], &[0.0]), &[0.0]) && !has_jumped((&[1.0], &[3.0]), &[]));
    }

    /// The energy goes with the square of the velocity.
    #[test]
    fn a_change_is_felt_beyond_a_ten_billionth_of_the_velocities() {
        for energy in [1e-30, 1.0, 1e30] {
            let felt = |part: f64| is_above_noise([energy, energy * part * part]);
            assert!(felt(2e-10), "{energy}");
            assert!(!felt(0.5e-10), "{energy}");
        }
        assert!(!is_above_noise([0.0, 0.0]));
    }
}
