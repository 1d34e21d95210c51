//! A motion that carries tangent vectors in canonical variables.
//!
//! In: a phase space, a method, a state with vectors. Out: the state and the vectors later on.
//! Never here: which vectors to carry, what becomes of them.
//!
//! Where impulses act or constraints hold, the motion is that of a [`Propagator`]. Each impulse carries the vectors on by its
//! [`Saltation`]; the projection of states onto their constraints leaves vectors that the constraints allow as they are.

use nalgebra::{DMatrix, DVector};

use super::bare_motion::BareMotion;
use super::error::DynamicsError;
use super::phase_space::PhaseSpace;
use super::regular_step::RegularStep;
use super::tangent_step::{TangentStates, TangentStep, vectors_of};
use crate::integrate::{
    Method, OccurrenceKind, Propagator, Reached, Settings, Stepper, Stepping, StoppedMotion,
    spacing,
};
use crate::num::math;
use crate::system::{MotionError, MotionErrorKind, Saltation, State, System};

/// A motion changes within as many steps as these, also where they are short.
const STEPS: f64 = 100.0;

/// A vanishing step may lead over a singular place where it moves the clock, or every number of the motion, by at most so many
/// of its last digits.
const DIGITS: f64 = 1024.0;

/// The vectors alone make steps vanish where those of the bare motion are longer by this factor.
const LONGER: f64 = 1e3;

/// A step of at most so many digits of the time is limited by these.
const COARSE: f64 = 64.0;

/// A motion with tangent vectors, in steps of a method. Under a method of fixed step the vectors
/// are those of the method's own map.
pub struct Carrier {
    space: PhaseSpace,
    system: System,
    states: TangentStates,
    method: &'static Method,
    settings: Settings,
    stepper: Box<dyn Stepper>,
    /// The motion where impulses act or constraints hold, in place of the stepper.
    jumping: Option<Jumping>,
    /// Where the motion began: its vectors may have been renewed since.
    begun: Option<State>,
    steps: u64,
    regular_step: RegularStep,
    /// Whether steps vanish, and it is known that those of the motion itself do.
    is_singular: bool,
}

/// A motion with impulses, or under constraints.
struct Jumping {
    motion: Propagator,
    /// The derivatives of the impulses; `None` where none act.
    saltation: Option<Saltation>,
    begun: bool,
    /// The times at which the last step began and ended.
    span: (f64, f64),
    /// The time of the last impulse, and whether an event caused it.
    last: Option<(f64, bool)>,
    /// The time from which the motion is smooth.
    since: f64,
    /// The size of the last step.
    step: f64,
    /// Whether more may happen at the time that was reached.
    pending: bool,
    /// Whether something happened at the end of the last step.
    is_cut: bool,
    /// The product of the determinants of all impulses, and the logarithm of its size, which leaves no range.
    determinant: f64,
    logarithm: f64,
}

impl Carrier {
    /// A motion with `count` vectors, which must then be started.
    ///
    /// # Errors
    /// Returns an error if the method does not suit the system, if an impulse has no derivative, or if steps of fixed size end
    /// with a projection onto constraints, which their map would have to be differentiated with.
    pub fn new(
        space: &PhaseSpace,
        method: &'static Method,
        settings: Settings,
        count: usize,
    ) -> Result<Carrier, DynamicsError> {
        if space.is_constrained() && method.stepping == Stepping::Fixed {
            let why = format!(
                "each step of {} ends with a projection onto the constraints, whose derivative is not taken: use a method \
                 with error control",
                method.name
            );
            return Err(DynamicsError::Unsuited(why));
        }
        let system = space.system().with_tangents(count);
        let stepper = (method.make)(&system, &settings)?;
        let mut jumping = None;
        if space.has_jumps() || space.is_constrained() {
            let parameters = space.parameters();
            let unsuited = |why: &str| DynamicsError::Unsuited(why.to_owned());
            let saltation = space.has_jumps().then(|| Saltation::new(&system, parameters));
            jumping = Some(Jumping {
                motion: Propagator::new(&system, method, settings, parameters)?,
                saltation: saltation.transpose().map_err(unsuited)?,
                begun: false,
                span: (0.0, 0.0),
                last: None,
                since: 0.0,
                step: 0.0,
                pending: false,
                is_cut: false,
                determinant: 1.0,
                logarithm: 0.0,
            });
        }
        let states = TangentStates::new(space, &system);
        Ok(Carrier {
            space: space.clone(),
            system,
            states,
            method,
            settings,
            stepper,
            jumping,
            begun: None,
            steps: 0,
            regular_step: RegularStep::default(),
            is_singular: false,
        })
    }

    /// Starts at a state of the space, with the columns of `vectors`.
    ///
    /// # Errors
    /// Returns an error if the motion cannot begin there.
    pub fn start(&mut self, state: &State, vectors: &DMatrix<f64>) -> Result<(), DynamicsError> {
        let full = self.states.join(state, vectors);
        if self.method.stepping == Stepping::Fixed && self.settings.step.is_none() {
            self.stepper.start(&full, self.space.parameters())?;
            // the same step from now on, wherever the motion is started again
            self.settings.step = Some(self.stepper.step_size().abs());
            self.stepper = (self.method.make)(&self.system, &self.settings)?;
        }
        let continues = self.begun.is_some() && full.time == self.time();
        let Some(jumping) = &mut self.jumping else {
            self.stepper.start(&full, self.space.parameters())?;
            if !continues {
                self.begin_at(full);
            }
            return Ok(());
        };
        if jumping.begun && full.time == jumping.span.1 {
            // the events of before stay known, and the impulses keep their times
            return Ok(jumping.motion.continue_from(&full, self.space.parameters())?);
        }
        if let Some(step) = self.settings.step {
            let settings = Settings { step: Some(step), ..self.settings };
            jumping.motion.change_method(self.method, settings)?;
        }
        jumping.motion.begin(&full, self.space.parameters())?;
        jumping.begun = true;
        jumping.span = (full.time, full.time);
        jumping.pending = false;
        jumping.since = full.time;
        self.begin_at(full);
        Ok(())
    }

    /// A motion that does not continue the one before has steps of its own.
    fn begin_at(&mut self, full: State) {
        self.begun = Some(full);
        self.regular_step = RegularStep::default();
        self.is_singular = false;
    }

    /// Takes one step towards `limit`.
    ///
    /// # Errors
    /// Returns an error if the motion cannot continue, was cancelled, or has passed where its vectors have no limit.
    pub fn step(&mut self, limit: f64) -> Result<(), MotionError> {
        if self.system.cancel().is_cancelled() {
            let state = self.stepper.state();
            return Err(self.system.error(MotionErrorKind::Cancelled, state.time, &state.values));
        }
        self.steps += 1;
        let outcome = match &mut self.jumping {
            None => self.stepper.step(limit),
            Some(jumping) => jumping.step(&self.space, &self.system, limit),
        };
        match outcome {
            Ok(()) => self.check_vectors(limit),
            Err(error) => Err(self.explained(error)),
        }
    }

    /// An error where a motion stops: one whose vectors alone stop it is reported as such, and one that reaches infinity.
    fn explained(&mut self, error: MotionError) -> MotionError {
        let is_vanishing = matches!(
            error.kind,
            MotionErrorKind::StepUnderflow(_) | MotionErrorKind::ClockStands(_)
        );
        if is_vanishing && let Some(step) = self.bare().and_then(|bare| bare.step_over(error.time))
        {
            let digits = spacing(error.time);
            let kind = if step <= COARSE * digits {
                MotionErrorKind::ClockStands(digits)
            } else {
                MotionErrorKind::NoDerivative
            };
            return MotionError { kind, ..error };
        }
        if let Some(jumping) = &mut self.jumping {
            return jumping.motion.explained(error);
        }
        let stopped = StoppedMotion {
            system: &self.system,
            method: self.method,
            stepper: self.stepper.as_ref(),
            parameters: self.space.parameters(),
            begun: self.begun.as_ref(),
        };
        let cause = stopped.blow_up(&error).or_else(|| stopped.beyond_the_clock(&error));
        cause.unwrap_or(error)
    }

    /// Returns an error if the last step has led over a place where the vectors have no limit, as a pole of spherical
    /// coordinates: it is shorter than rounding lets anything be known there, while the motion itself has long steps.
    fn check_vectors(&mut self, limit: f64) -> Result<(), MotionError> {
        if self.method.stepping == Stepping::Fixed {
            return Ok(());
        }
        let (begin, end) = self.interval();
        let is_cut = self.jumping.as_ref().is_some_and(|jumping| jumping.is_cut);
        let step = self.last_step();
        if end == limit || end == begin || is_cut || self.awaits_occurrence() {
            return Ok(());
        }
        let is_vanishing = self.regular_step.vanishes_with(step);
        if !is_vanishing {
            self.is_singular = false;
        }
        if !is_vanishing || self.is_singular || !self.is_within_digits(begin, end)? {
            return Ok(());
        }
        let over = self.bare().and_then(|bare| bare.step_over(begin));
        if over.is_some_and(|over| over > LONGER * step) {
            let state = self.inside(begin)?;
            return Err(self.system.error(MotionErrorKind::NoDerivative, begin, &state.values));
        }
        self.is_singular = true;
        Ok(())
    }

    /// The length of the last step: the rest of one in which something happened is shorter.
    fn last_step(&self) -> f64 {
        let (begin, end) = self.interval();
        let size = match &self.jumping {
            None => self.stepper.step_size(),
            Some(jumping) => jumping.motion.step_size(),
        };
        (end - begin).abs().max(size.abs())
    }

    /// Whether the last step moves the clock or every number of the motion by a few of its last digits only.
    fn is_within_digits(&mut self, begin: f64, end: f64) -> Result<bool, MotionError> {
        if (end - begin).abs() <= DIGITS * spacing(end) {
            return Ok(true);
        }
        let (before, after) = (self.inside(begin)?, self.inside(end)?);
        let moving = self.system.moving();
        let mut pairs = before.values.iter().zip(&after.values).take(moving);
        Ok(pairs.all(|(x, y)| (x - y).abs() <= DIGITS * spacing(x.abs().max(y.abs()))))
    }

    /// The same motion without its vectors.
    fn bare(&self) -> Option<BareMotion<'_>> {
        Some(BareMotion {
            space: &self.space,
            method: (self.method, self.settings),
            begun: self.begun.as_ref()?,
            carried_by: &self.system,
            jumps: self.jumping.is_some(),
            steps: 2 * self.steps,
        })
    }

    /// The product of the determinants of the derivatives of all impulses since the start.
    pub fn jump_determinant(&self) -> f64 {
        self.jumping.as_ref().map_or(1.0, |jumping| jumping.determinant)
    }

    /// The settings in use: the step is known after the start.
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// Whether all steps are equal.
    pub fn is_fixed(&self) -> bool {
        self.method.stepping == Stepping::Fixed
    }

    /// The number of steps taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The time at the end of the last step.
    pub fn time(&self) -> f64 {
        self.jumping.as_ref().map_or_else(|| self.stepper.time(), |jumping| jumping.span.1)
    }

    /// Whether a time has not been reached yet, or something that happens there has not happened yet.
    pub fn is_before(&self, until: f64, forwards: bool) -> bool {
        let time = self.time();
        if time == until {
            return self.jumping.as_ref().is_some_and(|jumping| jumping.pending);
        }
        (time < until) == forwards
    }

    /// Whether an event or an impulse is to happen where the last step ended, so that the motion cannot be started again from
    /// there.
    pub fn awaits_occurrence(&self) -> bool {
        self.jumping.as_ref().is_some_and(|jumping| jumping.motion.awaits_occurrence())
    }

    /// The times at which the last step began and ended.
    pub fn interval(&self) -> (f64, f64) {
        self.jumping.as_ref().map_or_else(|| self.stepper.interval(), |jumping| jumping.span)
    }

    /// The state and the vectors, as columns, at a time within the last step.
    ///
    /// # Errors
    /// Returns an error if they cannot be evaluated.
    pub fn at(&mut self, time: f64) -> Result<(State, DMatrix<f64>), MotionError> {
        let full = self.inside(time)?;
        self.states.part(&full)
    }

    /// The state with its vectors, as they are carried, at a time within the last step.
    fn inside(&mut self, time: f64) -> Result<State, MotionError> {
        let mut state = match &self.jumping {
            None => self.stepper.state().clone(),
            Some(jumping) => jumping.motion.computed().clone(),
        };
        if time != state.time {
            match &mut self.jumping {
                None => self.stepper.at(time, &mut state)?,
                Some(jumping) => jumping.motion.inside(time, &mut state)?,
            }
        }
        Ok(state)
    }
}

impl TangentStep for Carrier {
    fn interval(&self) -> (f64, f64) {
        Carrier::interval(self)
    }

    fn at(&mut self, time: f64) -> Result<(State, DMatrix<f64>), MotionError> {
        Carrier::at(self, time)
    }

    fn vector(&mut self, vector: usize, time: f64) -> Result<DVector<f64>, MotionError> {
        let full = self.inside(time)?;
        self.states.vector(vector, full)
    }

    fn awaits_occurrence(&self) -> bool {
        Carrier::awaits_occurrence(self)
    }

    fn jump_logarithm(&self) -> f64 {
        self.jumping.as_ref().map_or(0.0, |jumping| jumping.logarithm)
    }
}

impl Jumping {
    /// Takes one step towards `limit`, or up to the first occurrence before it.
    fn step(&mut self, space: &PhaseSpace, system: &System, limit: f64) -> Result<(), MotionError> {
        let begin = self.span.1;
        let reached = self.motion.reach_unexplained(limit, limit, &mut 1)?;
        self.pending = reached != Reached::Arrived;
        self.is_cut = matches!(reached, Reached::Occurred(_));
        let ended = |name: String, state: &State| {
            Err(system.error(MotionErrorKind::Ended(name), state.time, &state.values))
        };
        match reached {
            Reached::Arrived | Reached::OutOfBudget => self.step = self.motion.step_size(),
            Reached::Occurred(found) => match found.kind {
                // momenta are carried, which no step in time changes
                OccurrenceKind::Mark | OccurrenceKind::Crossing(_) | OccurrenceKind::StepInTime => {
                }
                OccurrenceKind::Impulse { .. } => self.jump(space, system, &found.name)?,
                OccurrenceKind::Stop | OccurrenceKind::Release(_) => {
                    return ended(found.name, self.motion.state());
                }
            },
            Reached::Ended => return ended("an event".to_owned(), self.motion.computed()),
        }
        self.span = (begin, self.motion.undisturbed().1);
        Ok(())
    }

    /// Carries the vectors through the impulse that has just acted on the state.
    fn jump(&mut self, space: &PhaseSpace, system: &System, name: &str) -> Result<(), MotionError> {
        let (Some(impulse), Some(saltation)) = (self.motion.last_impulse(), &mut self.saltation)
        else {
            return Ok(());
        };
        let (before, after) = (self.motion.before().clone(), self.motion.state().clone());
        let caused = impulse.1.is_some();
        if self.last.is_some_and(|(time, by_event)| time == after.time && (by_event || caused)) {
            let kind = MotionErrorKind::Coincides(name.to_owned());
            return Err(system.error(kind, after.time, &after.values));
        }
        self.last = Some((after.time, caused));
        let plain = space.system();
        let [own_before, own_after] = [&before, &after].map(|s| plain.extended(s, system));
        // a time in which the motion changes
        let scale = (after.time - self.since).min(STEPS * self.step.abs());
        self.since = after.time;
        let rows = saltation.matrix(impulse, (&own_before, &own_after), scale)?;
        let n = space.dimension();
        let matrix = DMatrix::from_row_slice(n, n, &rows);
        let determinant = matrix.determinant();
        self.determinant *= determinant;
        self.logarithm += math::ln(determinant.abs());
        let before = system.convert(&before, space.form(), space.parameters())?;
        let vectors = matrix * vectors_of(system, &before);
        let mut full = system.convert(&after, space.form(), space.parameters())?;
        let first = system.tangent_place(0);
        for (i, &x) in vectors.iter().enumerate() {
            full.set(first + i, x.into());
        }
        self.motion.continue_from(&full, space.parameters())
    }
}
