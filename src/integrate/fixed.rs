//! The common part of all methods of fixed step: counting of time, direction, dense output, default
//! step and stability. A method itself is a [`Scheme`].

use super::dense_output::DenseOutput;
use super::equal_steps::EqualSteps;
use super::method::{MethodError, Settings};
use super::stability::{self, Modes, Unstable};
use super::step_block::StepBlock;
use super::stepper::Stepper;
use crate::num::{Analytic, BATCH, Batch, DoubleDouble, accumulate};
use crate::system::{Form, KinkSides, MotionError, MotionErrorKind, State, StepsInTime, System};

/// Stability is checked after 1, 2, 4, … steps, and then at intervals of this many steps.
const STEPS_PER_CHECK: u64 = 256;

/// The longest step: multiples of it and their parts are counted in double-double, whose products do not reach the
/// end of `f64`.
const LONGEST: f64 = 1e290;

/// Why a step cannot be counted.
fn unusable(step: f64) -> Option<String> {
    if !(step > 0.0 && step.is_finite()) {
        Some(format!("the step {step} is not above zero"))
    } else if step > LONGEST {
        Some(format!("the step {step:e} is longer than {LONGEST:e}"))
    } else {
        None
    }
}

pub(super) trait Scheme: Clone + Send {
    fn form(&self) -> Form;

    /// Sets the parameters and [forgets](Scheme::forget) the motion so far.
    fn begin(&mut self, parameters: &[f64]);

    /// Moves the numbers of `state` by one step. The time of `state` is that of the beginning of
    /// the step and is not changed.
    fn advance(&mut self, step: f64, state: &mut State) -> Result<(), MotionError>;

    fn forget(&mut self) {}

    /// Moves the numbers of a state by as many steps, with the same result as one by one. Returns
    /// false, with the state unchanged, if they must be taken one by one.
    fn advance_many(&mut self, _step: f64, _count: u64, _states: ManySteps<'_>) -> bool {
        false
    }

    /// Begins the motion at a state in the system's native form, which may contain more information
    /// than the scheme's form.
    fn begin_near(&mut self, _native: &State) {}

    /// Continues from the last solution of another scheme, which is at the same state.
    fn continue_from(&mut self, _other: &Self) {}

    /// How it amplifies modes; `None` if every step is stable.
    fn modes(&self) -> Option<Modes<'_>> {
        None
    }

    /// The rates of change at the numbers of a state.
    fn rates(&mut self, time: f64, numbers: &[f64], out: &mut [f64]) -> Result<(), MotionError>;

    /// On which sides of the kinks the rates were last evaluated, for a scheme that has [modes](Scheme::modes).
    fn sides(&mut self) -> Vec<KinkSides> {
        Vec::new()
    }
}

/// What many steps begin with and write.
pub(super) struct ManySteps<'a> {
    pub(super) state: &'a mut State,
    /// The state before the last step.
    pub(super) before: &'a mut State,
    /// The numbers at the end of each, a step in each lane.
    pub(super) seen: Option<&'a mut [Batch]>,
}

/// A motion in equal steps.
pub(super) struct FixedStep<S> {
    system: System,
    scheme: S,
    /// Takes the shorter steps of dense output, so that `scheme` keeps what it remembers of its
    /// last step.
    inner: S,
    parameters: Vec<f64>,
    asked: Option<f64>,
    steps: EqualSteps,
    steps_in_time: Option<StepsInTime>,
    /// Where the motion begins beside a step in time of the law: when, and a time at which the law in `f64` is the one on its side.
    begun: Option<(f64, f64)>,
    /// The number of steps since the start, and an instability found on the way.
    taken: u64,
    /// Whether steps may be taken many at once, until it is seen that they may not.
    in_batches: bool,
    unstable: Option<Unstable>,
    before: State,
    state: State,
    next: State,
    /// The state before the last of many steps, until it is known that they could be taken.
    earlier: State,
}

impl<S: Scheme> FixedStep<S> {
    pub(super) fn new(
        method: &'static str,
        system: &System,
        settings: &Settings,
        scheme: S,
    ) -> Result<FixedStep<S>, MethodError> {
        if let Some(reason) = settings.step.and_then(unusable) {
            return Err(MethodError { method, reason });
        }
        let state = State::new(0.0, scheme.form(), vec![0.0; system.state_len()]);
        Ok(FixedStep {
            system: system.clone(),
            inner: scheme.clone(),
            scheme,
            parameters: Vec::new(),
            asked: settings.step,
            steps_in_time: None,
            begun: None,
            steps: EqualSteps::new(DoubleDouble::ZERO, DoubleDouble::ZERO),
            taken: 0,
            in_batches: true,
            unstable: None,
            before: state.clone(),
            next: state.clone(),
            earlier: state.clone(),
            state,
        })
    }

    /// Restarts the count at the current time with another step.
    fn count_from_here(&mut self, step: DoubleDouble) {
        self.steps = EqualSteps::new(self.state.exact_time(), step);
        self.scheme.begin(&self.parameters);
        self.inner.begin(&self.parameters);
        self.in_batches = true;
    }

    /// Where the current state lies beside a step in time of the law: its time, and one at which the law in `f64` is the one there.
    fn begun_beside_step(&mut self, step: f64) -> Result<Option<(f64, f64)>, MotionError> {
        let time = self.state.exact_time();
        let Some(steps) = &mut self.steps_in_time else { return Ok(None) };
        let Some(beside) = steps.beside(time, step)? else { return Ok(None) };
        let Some(sides) = steps.beside_in_f64(time, step)? else { return Ok(None) };
        let is_behind = steps.is_behind(time, beside)?;
        Ok(Some((time.high, sides[usize::from(is_behind)])))
    }

    /// When a step begins by the clock of the law, and how long it is, so that the law is that of one side at both its ends where one
    /// of them is a step in time, which a clock in `f64` does not see from its sides.
    fn on_one_side(
        &mut self,
        begin: DoubleDouble,
        end: DoubleDouble,
        step: f64,
    ) -> Result<(DoubleDouble, f64), MotionError> {
        let Some(steps) = self.steps_in_time.as_mut().filter(|_| step > 0.0) else {
            return Ok((begin, step));
        };
        let first = self.begun.filter(|(time, _)| *time == begin.high).map(|(_, clock)| clock);
        let last = steps.beside_in_f64(end, step)?;
        let last = last.map(|[before, _]| before).filter(|before| *before > begin.high);
        Ok(match (first, last) {
            (None, None) => (begin, step),
            (Some(first), None) => (DoubleDouble::from(first), step),
            (None, Some(last)) => (DoubleDouble::from(last) - DoubleDouble::from(step), step),
            (Some(first), Some(last)) if last > first => (DoubleDouble::from(first), last - first),
            // within the digits of the clock
            (Some(first), Some(_)) => (DoubleDouble::from(first), step),
        })
    }

    /// The number of steps before the next check of stability; zero if it is due.
    fn unchecked(&self) -> u64 {
        match self.taken {
            0 => 0,
            n if n < STEPS_PER_CHECK => n.next_power_of_two() - n,
            n => n.next_multiple_of(STEPS_PER_CHECK) - n,
        }
    }

    /// Checks occasionally whether the step is stable at the current state, until it is not.
    fn check_stability(&mut self) {
        let due = self.unchecked() == 0;
        self.taken += 1;
        if !due || self.unstable.is_some() {
            return;
        }
        let Some(modes) = self.scheme.modes() else { return };
        let (time, step, moving) = (self.state.time, self.steps.step.high, self.system.moving());
        let scheme = &mut self.inner;
        let rates = |numbers: &[f64], out: &mut [f64]| {
            let outcome = scheme.rates(time, numbers, out);
            outcome.is_ok().then(|| scheme.sides())
        };
        let limit = stability::limit(modes, (&self.state.values, moving), step, rates);
        self.unstable = limit.map(|limit| Unstable { time, step: step.abs(), limit });
    }

    /// Takes many steps at once: until `time` is reached or passed, at most `most`, up to the next
    /// check of stability. Returns their number, which is zero if the next step must be taken by
    /// itself.
    fn batch(&mut self, time: f64, most: u64, seen: Option<&mut StepBlock>) -> u64 {
        let forwards = time > self.state.time;
        let most = most.min(self.unchecked());
        if most == 0 || !self.in_batches || (self.steps.step.high > 0.0) != forwards {
            return 0;
        }
        let count = self.steps.to(time, most);
        if !self.steps.are_distinct(count, self.state.time) {
            return 0;
        }
        self.next.copy_from(&self.state);
        let FixedStep { scheme, next: state, earlier: before, .. } = self;
        let (mut block, mut numbers) = (seen, None);
        if let Some(block) = &mut block {
            numbers = Some(block.numbers.as_mut_slice());
        }
        let states = ManySteps { state, before, seen: numbers };
        if !scheme.advance_many(self.steps.step.high, count, states) {
            self.in_batches = false;
            return 0;
        }
        if let Some(block) = block {
            block.begin = self.state.time;
            block.count = count as usize;
            for (lane, after) in (1..=count).enumerate() {
                block.times.0[lane] = self.steps.time_after(after).high;
            }
        }
        self.next.set_time(self.steps.time_after(count));
        if count > 1 {
            self.earlier.set_time(self.steps.time_after(count - 1));
        }
        std::mem::swap(&mut self.state, &mut self.next);
        std::mem::swap(&mut self.before, &mut self.earlier);
        self.steps.take(count);
        self.taken += count;
        count
    }

    /// Returns an error on cancellation, or if there are more steps to the limit than can be
    /// counted.
    fn may_step(&self, limit: f64) -> Result<(), MotionError> {
        let kind = if self.system.cancel().is_cancelled() {
            MotionErrorKind::Cancelled
        } else if self.steps.are_too_many(limit) {
            MotionErrorKind::TooManySteps(self.steps.step.high.abs(), limit)
        } else {
            return Ok(());
        };
        Err(self.system.error(kind, self.state.time, &self.state.values))
    }
}

impl<S: Scheme> Stepper for FixedStep<S> {
    fn start(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        self.state = self.system.convert(state, self.scheme.form(), parameters)?;
        self.before.copy_from(&self.state);
        self.parameters.clear();
        self.parameters.extend_from_slice(parameters);
        let step = EqualSteps::step_of(self.asked, &self.system, state, parameters);
        self.steps_in_time = self.system.steps_in_time(parameters);
        self.begun = self.begun_beside_step(step.high)?;
        self.count_from_here(step);
        self.scheme.begin_near(state);
        self.taken = 0;
        Ok(())
    }

    fn start_with_step(
        &mut self,
        state: &State,
        parameters: &[f64],
        step: f64,
    ) -> Result<(), MotionError> {
        let asked = self.asked.replace(step);
        let outcome = self.start(state, parameters);
        self.asked = asked;
        outcome
    }

    fn step(&mut self, limit: f64) -> Result<(), MotionError> {
        if self.state.time == limit {
            return Ok(());
        }
        if (limit > self.state.time) != (self.steps.step.high > 0.0) {
            self.count_from_here(-self.steps.step);
        }
        self.may_step(limit)?;
        self.check_stability();
        self.next.copy_from(&self.state);
        let time = self.steps.time_after(1);
        let (clock, step) =
            self.on_one_side(self.state.exact_time(), time, self.steps.step.high)?;
        self.next.set_time(clock);
        self.scheme.advance(step, &mut self.next)?;
        self.next.set_time(time);
        if time.high == self.state.time {
            let kind = MotionErrorKind::StepUnderflow(self.steps.step.high);
            return Err(self.system.error(kind, time.high, &self.state.values));
        }
        self.system.check_finite(&self.next)?;
        self.steps.take(1);
        std::mem::swap(&mut self.before, &mut self.state);
        std::mem::swap(&mut self.state, &mut self.next);
        Ok(())
    }

    fn steps(&mut self, time: f64, limit: f64, budget: &mut u64) -> Result<(), MotionError> {
        let forwards = time > self.state.time;
        while *budget > 0 && self.state.time != time && (self.state.time < time) == forwards {
            let many = self.batch(time, *budget, None);
            *budget -= many.max(1);
            if many == 0 {
                self.step(limit)?;
            }
        }
        Ok(())
    }

    fn steps_seen(&mut self, time: f64, most: u64, block: &mut StepBlock) -> u64 {
        if self.state.time == time {
            return 0;
        }
        block.numbers.resize(self.state.values.len(), Batch::ZERO);
        self.batch(time, most.min(BATCH as u64), Some(block))
    }

    fn replace_state(&mut self, state: &State) {
        self.state.copy_from(state);
    }

    fn state(&self) -> &State {
        &self.state
    }

    fn step_size(&self) -> f64 {
        self.steps.step.high
    }

    fn unstable(&self) -> Option<Unstable> {
        self.unstable
    }
}

impl<S: Scheme> DenseOutput for FixedStep<S> {
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
        self.inner.forget();
        self.inner.continue_from(&self.scheme);
        let end = DoubleDouble::from_decimal(time);
        let begin = self.before.exact_time();
        let (clock, step) = self.on_one_side(begin, end, (end - begin).high)?;
        out.set_time(clock);
        self.inner.advance(step, out)?;
        (out.time, out.time_carry) = (time, 0.0);
        self.system.check_finite(out)
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
