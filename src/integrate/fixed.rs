//! The common part of all methods of fixed step: counting of time, direction, dense output, default
//! step and stability. A method itself is a [`Scheme`].

use super::clock::spacing;
use super::initial_step;
use super::method::{MethodError, Settings};
use super::stability::{self, Modes, Unstable};
use super::stepper::Stepper;
use crate::num::{DoubleDouble, accumulate};
use crate::system::{Form, MotionError, MotionErrorKind, State, System};

/// The default step, as a part of the motion's [time scale](super::initial_step::of).
const PART_OF_PACE: f64 = 1.0 / 10.0;

/// The largest number of steps that can be counted.
const MOST_STEPS: f64 = 9_007_199_254_740_992.0;

/// Stability is checked after 1, 2, 4, … steps, and then at intervals of this many steps.
const STEPS_PER_CHECK: u64 = 256;

/// The steps in a row that must change the time by more than this many of its last digits.
const DIGITS_PER_STEP: f64 = 4.0;

/// One step of a method.
pub(super) trait Scheme: Clone + Send {
    /// The form of its states.
    fn form(&self) -> Form;

    /// Sets the parameters and forgets the motion so far.
    fn begin(&mut self, parameters: &[f64]);

    /// Moves the numbers of `state` by one step. The time of `state` is that of the beginning of
    /// the step and is not changed.
    fn advance(&mut self, step: f64, state: &mut State) -> Result<(), MotionError>;

    /// Moves the numbers of `state` by as many steps, with the same result as one by one. Returns
    /// false, with the state unchanged, if they must be taken one by one.
    fn advance_many(&mut self, _step: f64, _count: u64, _state: &mut State) -> bool {
        false
    }

    /// Begins the motion at a state in the system's native form, which may contain more information
    /// than the scheme's form.
    fn begin_near(&mut self, _native: &State) {}

    /// Continues from the last solution of another scheme, which is at the same state.
    fn go_on_from(&mut self, _other: &Self) {}

    /// How it amplifies modes; `None` if every step is stable.
    fn modes(&self) -> Option<Modes<'_>> {
        None
    }

    /// The rates of change at the numbers of a state.
    fn rates(&mut self, time: f64, numbers: &[f64], out: &mut [f64]) -> Result<(), MotionError>;
}

/// A motion in equal steps.
pub(super) struct FixedStep<S> {
    system: System,
    scheme: S,
    /// Takes the shorter steps of dense output, so that `scheme` keeps what it remembers of its
    /// last step.
    aside: S,
    parameters: Vec<f64>,
    asked: Option<f64>,
    /// The step; negative if the motion runs backwards.
    step: DoubleDouble,
    /// The time at which counting began, and the steps since: time is counted, not summed.
    origin: DoubleDouble,
    count: f64,
    /// The number of steps since the start, and an instability found on the way.
    taken: u64,
    /// Whether steps may be taken many at once, until it is seen that they may not.
    in_batches: bool,
    unstable: Option<Unstable>,
    before: State,
    state: State,
    next: State,
}

impl<S: Scheme> FixedStep<S> {
    pub(super) fn new(
        method: &'static str,
        system: &System,
        settings: &Settings,
        scheme: S,
    ) -> Result<FixedStep<S>, MethodError> {
        if let Some(step) = settings.step.filter(|&h| !(h > 0.0 && h.is_finite())) {
            return Err(MethodError {
                method,
                reason: format!("the step {step} is not above zero"),
            });
        }
        let state = State::new(0.0, scheme.form(), vec![0.0; system.state_len()]);
        Ok(FixedStep {
            system: system.clone(),
            aside: scheme.clone(),
            scheme,
            parameters: Vec::new(),
            asked: settings.step,
            step: DoubleDouble::ZERO,
            origin: DoubleDouble::ZERO,
            count: 0.0,
            taken: 0,
            in_batches: true,
            unstable: None,
            before: state.clone(),
            next: state.clone(),
            state,
        })
    }

    /// Restarts the count at the current time with another step.
    fn count_from_here(&mut self, step: DoubleDouble) {
        self.step = step;
        self.origin = self.state.exact_time();
        self.count = 0.0;
        self.scheme.begin(&self.parameters);
        self.in_batches = true;
    }

    /// Checks occasionally whether the step is stable at the current state, until it is not.
    fn check_stability(&mut self) {
        let n = self.taken;
        let due = n.is_multiple_of(STEPS_PER_CHECK) || (n < STEPS_PER_CHECK && n.is_power_of_two());
        self.taken += 1;
        if !due || self.unstable.is_some() || self.scheme.modes().is_none() {
            return;
        }
        let (time, step, moving) = (self.state.time, self.step.high, self.system.moving());
        self.aside.begin(&self.parameters);
        let rates = |numbers: &[f64], out: &mut [f64]| self.aside.rates(time, numbers, out).is_ok();
        let z = stability::eigenvalues(&self.state.values, moving, step, rates);
        let limit = self.scheme.modes().and_then(|modes| modes.limit(&z, step));
        self.unstable = limit.map(|limit| Unstable { time, step: step.abs(), limit });
    }

    /// Takes many steps at once: all before the last one to `time`, at most `most`, up to the next
    /// check of stability. Returns their number, which is zero if the next step must be taken by
    /// itself.
    fn batch(&mut self, time: f64, most: u64) -> u64 {
        let way = (time - self.origin.high) / self.step.high - self.count - 2.0;
        let unchecked = STEPS_PER_CHECK - self.taken % STEPS_PER_CHECK;
        let begins = self.taken.is_multiple_of(STEPS_PER_CHECK) || self.taken < STEPS_PER_CHECK;
        // a quotient that is negative or not a number counts as zero
        let count = (way as u64).min(most).min(unchecked);
        let last = self.origin + self.step * (self.count + count as f64);
        let digits = DIGITS_PER_STEP * spacing(last.high.abs().max(self.state.time.abs()));
        if begins || count < 2 || self.step.high.abs() < digits {
            return 0;
        }
        self.next.copy_from(&self.state);
        if !self.scheme.advance_many(self.step.high, count, &mut self.next) {
            self.in_batches = false;
            return 0;
        }
        (self.next.time, self.next.time_carry) = (last.high, last.low);
        std::mem::swap(&mut self.state, &mut self.next);
        self.before.copy_from(&self.state);
        self.count += count as f64;
        self.taken += count;
        count
    }

    /// Returns an error on cancellation, or if there are more steps to the limit than can be
    /// counted.
    fn may_step(&self, limit: f64) -> Result<(), MotionError> {
        let way = (limit - self.origin.high).abs() / self.step.high.abs();
        let kind = if self.system.cancel().is_cancelled() {
            MotionErrorKind::Cancelled
        } else if limit.is_finite() && way > MOST_STEPS {
            MotionErrorKind::TooManySteps(self.step.high.abs(), limit)
        } else {
            return Ok(());
        };
        Err(self.system.fault(kind, self.state.time, &self.state.values))
    }
}

impl<S: Scheme> Stepper for FixedStep<S> {
    fn start(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        self.state = self.system.convert(state, self.scheme.form(), parameters)?;
        self.before.copy_from(&self.state);
        self.parameters.clear();
        self.parameters.extend_from_slice(parameters);
        let step = match self.asked {
            Some(step) => DoubleDouble::written(step),
            None => {
                let pace = initial_step::of(&self.system, state, parameters) * PART_OF_PACE;
                // two digits are enough, and times are then short decimals
                DoubleDouble::written(format!("{pace:.1e}").parse().unwrap_or(pace))
            }
        };
        self.count_from_here(step);
        self.scheme.begin_near(state);
        self.taken = 0;
        Ok(())
    }

    fn step(&mut self, limit: f64) -> Result<(), MotionError> {
        if self.state.time == limit {
            return Ok(());
        }
        if (limit > self.state.time) != (self.step.high > 0.0) {
            self.count_from_here(-self.step);
        }
        self.may_step(limit)?;
        self.check_stability();
        self.next.copy_from(&self.state);
        self.scheme.advance(self.step.high, &mut self.next)?;
        let time = self.origin + self.step * (self.count + 1.0);
        (self.next.time, self.next.time_carry) = (time.high, time.low);
        if time.high == self.state.time {
            let kind = MotionErrorKind::StepUnderflow(self.step.high);
            return Err(self.system.fault(kind, time.high, &self.state.values));
        }
        self.system.check_finite(&self.next)?;
        self.count += 1.0;
        std::mem::swap(&mut self.before, &mut self.state);
        std::mem::swap(&mut self.state, &mut self.next);
        Ok(())
    }

    fn steps(&mut self, time: f64, limit: f64, budget: &mut u64) -> Result<(), MotionError> {
        let forwards = time > self.state.time;
        while *budget > 0 && self.state.time != time && (self.state.time < time) == forwards {
            // the last step of all is taken by itself
            if self.in_batches && (self.step.high > 0.0) == forwards {
                *budget -= self.batch(time, *budget - 1);
            }
            *budget -= 1;
            self.step(limit)?;
        }
        Ok(())
    }

    fn replace_state(&mut self, state: &State) {
        self.state.copy_from(state);
    }

    fn state(&self) -> &State {
        &self.state
    }

    fn interval(&self) -> (f64, f64) {
        (self.before.time, self.state.time)
    }

    fn at(&mut self, time: f64, out: &mut State) -> Result<(), MotionError> {
        if time == self.state.time {
            out.copy_from(&self.state);
            return Ok(());
        }
        out.copy_from(&self.before);
        if time == self.before.time {
            return Ok(());
        }
        self.aside.begin(&self.parameters);
        self.aside.go_on_from(&self.scheme);
        let step = DoubleDouble::written(time) - self.before.exact_time();
        self.aside.advance(step.high, out)?;
        (out.time, out.time_carry) = (time, 0.0);
        self.system.check_finite(out)
    }

    fn step_size(&self) -> f64 {
        self.step.high
    }

    fn unstable(&self) -> Option<Unstable> {
        self.unstable
    }
}

/// Adds `factor · rates` to the numbers of a state, with compensated summation.
pub(super) fn add(state: &mut State, factor: f64, rates: &[f64]) {
    let numbers = state.values.iter_mut().zip(&mut state.carry);
    for ((value, carry), &rate) in numbers.zip(rates) {
        if rate != 0.0 {
            accumulate(value, carry, factor * rate);
        }
    }
}
