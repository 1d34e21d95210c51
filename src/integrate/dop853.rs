//! Dormand and Prince's Runge–Kutta method of order 8 with error estimates of orders 5 and 3 and an
//! interpolant of order 7.
//!
//! The error of every number of the state is measured relative to its own size within the step, so
//! units do not matter. If a step fails, the effect of rounding on the rates is measured as well,
//! by numbers changed in their last digits and by the same rates in double-double, and no number is
//! required to be more accurate than its rounding allows: one that is zero by symmetry, up to
//! rounding, would otherwise shrink the step without end.
//!
//! Source: E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, second
//! edition, II.4 (step control), II.5 (method), II.6 (interpolant).

mod along_kink;
mod controlled_step;
mod kink_course;
mod kinks;
mod tableau;

use self::kink_course::KinkCourse;
use self::tableau::{DENSE, FIFTH, METHOD_STAGES, STAGES, THIRD, WeightedStage};
use super::dense_output::DenseOutput;
use super::method::{Method, MethodError, Preserves, Settings, Stepping};
use super::narrow_place::NarrowPlaces;
use super::stepper::Stepper;
use super::{initial_step, roundoff};
use crate::num::{DoubleDouble, math};
use crate::system::{ExactRates, MotionError, MotionErrorKind, Rates, State, System};

const TOLERANCE: f64 = 1e-13;

/// The first step as a part of the motion's [time scale](super::initial_step::of); the next ones
/// grow from there.
const FIRST: f64 = 0.05;

const SAFETY: f64 = 0.9;

/// The multiple of the measured rounding of a rate that is tolerated.
const ROUNDINGS: f64 = 4.0;

/// The rounding of any rate that is tolerated: rates below the range of normal numbers lose their digits, which changes of their inputs
/// do not show.
const UNDERFLOW: f64 = f64::MIN_POSITIVE / f64::EPSILON;

/// The part of that rounding that is kept for the next step, since one measurement may by chance be
/// too small.
const FORGETTING: f64 = 0.8;

/// A step shorter than this part of the longest one so far cannot continue: what moves in both
/// cannot be represented with the same digits.
const SHORTEST: f64 = 1e-15;

/// The maximal number of shorter steps tried if one led to a place without rates.
const TRIES: u32 = 30;

/// A step shorter than this many times the shortest is not divided for what is narrow in the law.
const SHORT: f64 = 64.0;

/// The bounds of the ratio of a step to the last one.
const SHORTER: f64 = 0.333;
const LONGER: f64 = 6.0;

pub(super) const METHOD: Method = Method {
    name: "dop853",
    title: "Dormand–Prince 8(5,3)",
    order: Some(8),
    stepping: Stepping::Adaptive,
    preserves: Preserves::Nothing,
    locates_kinks: false,
    stays_within_steps: true,
    needs: "",
    about: "The Runge–Kutta method of order 8 that many programs use, for comparison. Kinks are \
            stepped over, not located; what follows one, as a body at rest under dry friction, takes steps of `taylor`. Hairer, Nørsett & Wanner, Solving Ordinary Differential \
            Equations I, II.5.",
    fits: |_| Ok(()),
    leapfrogs: Vec::new,
    make: |system, settings| Ok(Box::new(DormandPrince::new(system, settings)?)),
};

struct DormandPrince {
    system: System,
    rates: Rates,
    exact: ExactRates,
    tolerance: f64,
    /// The size of the next step to try.
    size: f64,
    before: State,
    state: State,
    next: State,
    /// The slopes of all stages of the current step; that of the result is the first of the next
    /// one.
    slopes: Vec<Vec<f64>>,
    /// The slopes of the last step; those of the interpolant are computed on demand.
    last: Vec<Vec<f64>>,
    has_interpolant: bool,
    numbers: Vec<f64>,
    /// The effect of rounding on each rate in the attempted step, and what is kept of it from the steps before. That of an attempt
    /// that failed is not: it may have led far from the motion.
    noise: Vec<f64>,
    remembered_noise: Vec<f64>,
    fresh: Vec<f64>,
    /// The size of each number within the current step.
    sizes: Vec<f64>,
    /// Whether the state was changed after its slope was computed.
    stale: bool,
    /// The longest step since the start.
    longest: f64,
    /// The number of short steps in a row that have crossed a kink.
    crossings: u32,
    /// Where the law may have something narrow in it.
    narrow: Option<NarrowPlaces>,
    /// The switches and roots whose kink lies within the attempted step.
    differing: (Vec<usize>, Vec<usize>),
    /// Whether the motion follows a kink.
    course: KinkCourse,
    parameters: Vec<f64>,
}

impl DormandPrince {
    fn new(system: &System, settings: &Settings) -> Result<DormandPrince, MethodError> {
        let tolerance = settings.tolerance.unwrap_or(TOLERANCE);
        if !(1e-15..1.0).contains(&tolerance) {
            let reason = format!("the tolerance {tolerance:e} is not between 1e-15 and 1");
            return Err(MethodError { method: METHOD.name, reason });
        }
        let zeros = vec![0.0; system.state_len()];
        let state = State::new(0.0, system.form(), zeros.clone());
        Ok(DormandPrince {
            system: system.clone(),
            rates: system.native_rates(),
            exact: system.exact_rates(),
            tolerance,
            size: 0.0,
            before: state.clone(),
            next: state.clone(),
            state,
            slopes: vec![zeros.clone(); STAGES.len()],
            last: vec![zeros.clone(); STAGES.len()],
            has_interpolant: false,
            numbers: zeros.clone(),
            noise: zeros.clone(),
            remembered_noise: zeros.clone(),
            fresh: zeros.clone(),
            sizes: zeros,
            stale: false,
            longest: 0.0,
            crossings: 0,
            narrow: None,
            differing: Default::default(),
            course: KinkCourse::Away,
            parameters: Vec::new(),
        })
    }

    /// Computes the stages of a step of this size, and its result in `next`.
    fn attempt(&mut self, step: f64) -> Result<(), MotionError> {
        for stage in 1..METHOD_STAGES {
            let (rates, numbers) = (&mut self.rates, &mut self.numbers);
            evaluate(rates, stage, step, &self.state, &mut self.slopes, numbers)?;
        }
        self.next.copy_from(&self.state);
        // `numbers` stay those of the last stage, at which rounding may be measured
        sums(STAGES[METHOD_STAGES].from, &self.slopes, &mut self.fresh);
        for (i, sum) in self.fresh.iter().enumerate() {
            self.next.set(i, self.state.exact(i) + DoubleDouble::from(step * sum));
        }
        Ok(())
    }

    /// Measures the size of each number within the attempted step, which is not zero where the
    /// number passes zero.
    fn measure(&mut self, step: f64) {
        for (i, size) in self.sizes.iter_mut().enumerate() {
            let (begin, end) = (self.state.values[i], self.next.values[i]);
            *size = begin.abs().max(end.abs()).max((step * self.slopes[0][i]).abs());
        }
    }

    /// The error of the attempted step relative to the tolerance.
    fn error(&self, step: f64) -> f64 {
        if !self.next.is_finite() {
            return f64::INFINITY;
        }
        // tangent vectors are judged by themselves, so that they spoil no mean over the motion; the action is not judged, so
        // that it is the same motion whether it is carried or not, as the work always is where there is any
        let (motion, driven) = (self.system.motion_len(), self.system.driven_len());
        let judged = (0..motion).chain(self.system.work_place());
        self.error_of(step, judged).max(self.error_of(step, motion..driven))
    }

    /// The mean error of some of the numbers.
    fn error_of(&self, step: f64, numbers: impl Iterator<Item = usize>) -> f64 {
        let (mut fifth, mut third) = (0.0, 0.0);
        let mut count = 0.0;
        for i in numbers {
            let size = self.sizes[i];
            count += 1.0;
            let rounding = ROUNDINGS * step.abs() * (self.noise[i] + UNDERFLOW);
            let allowed = self.tolerance * size + rounding;
            if allowed > 0.0 {
                let whole = sum(STAGES[METHOD_STAGES].from, &self.slopes, i);
                fifth += math::powi(sum(FIFTH, &self.slopes, i) / allowed, 2);
                third += math::powi((whole - sum(THIRD, &self.slopes, i)) / allowed, 2);
            }
        }
        let both = fifth + 0.01 * third;
        let error = step.abs() * fifth / (both * count).sqrt();
        match both {
            0.0 => 0.0,
            _ if error.is_nan() => f64::INFINITY,
            _ => error,
        }
    }

    /// Measures the effect of rounding on the rates at the beginning of the step, since its end may
    /// be anywhere; and on those of the last stage, since at the beginning it may happen to vanish.
    fn estimate_roundoff(&mut self, step: f64) {
        let State { time, values, .. } = &self.state;
        let size = |(x, slope): (&f64, &f64)| x.abs().max((step * slope).abs());
        let sizes: Vec<f64> = values.iter().zip(&self.slopes[0]).map(size).collect();
        let place = roundoff::RatesPoint { time: *time, numbers: values, sizes: &sizes, step };
        if roundoff::measure(&mut self.rates, &place, &mut self.fresh).is_ok() {
            for (noise, fresh) in self.noise.iter_mut().zip(&self.fresh) {
                *noise = noise.max(*fresh);
            }
        }
        let begin = self.state.values.clone();
        self.compare(self.state.time, &begin);
        let reached = self.numbers.clone();
        self.compare(self.state.time + STAGES[METHOD_STAGES - 1].at * step, &reached);
    }

    /// Counts the difference between the rates somewhere and the same rates in double-double as
    /// rounding, unless they lie on two sides of a kink.
    fn compare(&mut self, time: f64, numbers: &[f64]) {
        let exact: Vec<DoubleDouble> = numbers.iter().map(|&x| DoubleDouble::from(x)).collect();
        if self.rates.evaluate(time, numbers, &mut self.fresh).is_err()
            || self.exact.evaluate(DoubleDouble::from(time), &exact).is_err()
        {
            return;
        }
        let sides = self.rates.sides();
        if (0..sides.switches()).any(|i| !sides.has_switch_at(i, self.exact.switch(i))) {
            return;
        }
        for (i, (noise, fresh)) in self.noise.iter_mut().zip(&self.fresh).enumerate() {
            let rounding = (self.exact.rate(i).high - fresh).abs();
            if rounding.is_finite() {
                *noise = noise.max(rounding);
            }
        }
    }

    /// Returns an error if a step of this size cannot continue the motion, or on cancellation. A
    /// step to the limit (`last`) may be arbitrarily short.
    fn may_try(&self, step: f64, last: bool) -> Result<(), MotionError> {
        let size = step.abs();
        let kind = if self.system.cancel().is_cancelled() {
            MotionErrorKind::Cancelled
        } else if size <= 1e-16 * self.state.time.abs()
            || size < 1e-290
            || (size < self.shortest() && !last)
        {
            MotionErrorKind::StepUnderflow(step)
        } else {
            return Ok(());
        };
        Err(self.system.error(kind, self.state.time, &self.state.values))
    }

    /// Computes the slopes that only the interpolant needs.
    fn complete(&mut self) -> Result<(), MotionError> {
        if !self.has_interpolant {
            let step = self.last_step();
            for stage in METHOD_STAGES + 1..STAGES.len() {
                let (rates, numbers) = (&mut self.rates, &mut self.numbers);
                evaluate(rates, stage, step, &self.before, &mut self.last, numbers)?;
            }
            self.has_interpolant = true;
        }
        Ok(())
    }

    /// The part of the attempted step that shows all of what exponential functions in the law do; 1 for all of it.
    fn resolved_part(&mut self, step: f64) -> f64 {
        if step.abs() <= SHORT * self.shortest() {
            return 1.0;
        }
        let Some(narrow) = &mut self.narrow else { return 1.0 };
        let begin = (&self.state, &self.slopes[0][..]);
        // the last stage lies at the end of the step
        narrow.part(step, begin, (&self.next, &self.slopes[METHOD_STAGES - 1][..]))
    }

    fn last_step(&self) -> f64 {
        (self.state.exact_time() - self.before.exact_time()).high
    }
}

/// The slope of a stage of the step from `origin`.
fn evaluate(
    rates: &mut Rates,
    stage: usize,
    step: f64,
    origin: &State,
    slopes: &mut [Vec<f64>],
    numbers: &mut [f64],
) -> Result<(), MotionError> {
    sums(STAGES[stage].from, slopes, numbers);
    for (x, (value, carry)) in numbers.iter_mut().zip(origin.values.iter().zip(&origin.carry)) {
        *x = value + (carry + step * *x);
    }
    rates.evaluate(origin.time + STAGES[stage].at * step, numbers, &mut slopes[stage])
}

/// The weighted sums of the slopes of all numbers, as [`sum`] has them: stage by stage, so that each slope is read in a row.
fn sums(terms: &[WeightedStage], slopes: &[Vec<f64>], out: &mut [f64]) {
    let Some((&(first, coefficient), others)) = terms.split_first() else { return out.fill(0.0) };
    for (sum, slope) in out.iter_mut().zip(&slopes[first]) {
        *sum = coefficient * slope;
    }
    for &(stage, coefficient) in others {
        for (sum, slope) in out.iter_mut().zip(&slopes[stage]) {
            *sum += coefficient * slope;
        }
    }
}

fn sum(terms: &[WeightedStage], slopes: &[Vec<f64>], i: usize) -> f64 {
    terms.iter().map(|&(stage, coefficient)| coefficient * slopes[stage][i]).sum()
}

impl Stepper for DormandPrince {
    fn start(&mut self, state: &State, parameters: &[f64]) -> Result<(), MotionError> {
        self.state = self.system.convert(state, self.system.form(), parameters)?;
        self.before.copy_from(&self.state);
        if self.narrow.is_none() {
            self.narrow = NarrowPlaces::of(&self.system, parameters, &self.state);
        }
        if let Some(narrow) = &mut self.narrow {
            narrow.set_parameters(parameters);
        }
        self.rates.set_parameters(parameters);
        self.exact.set_parameters(&self.system.inputs(parameters));
        self.size = initial_step::of(&self.system, state, parameters) * FIRST;
        self.longest = 0.0;
        self.crossings = 0;
        self.noise.fill(0.0);
        self.stale = false;
        self.parameters = parameters.to_vec();
        self.begin_beside_kinks()?;
        self.rates.evaluate(self.state.time, &self.state.values, &mut self.slopes[0])
    }

    fn step(&mut self, limit: f64) -> Result<(), MotionError> {
        if self.state.time == limit {
            return Ok(());
        }
        if self.is_along_kink() {
            return self.step_along_kink(limit);
        }
        match self.controlled_step(limit) {
            Err(error) if error.kind == MotionErrorKind::Sticks => {
                self.follow_kink()?;
                self.step_along_kink(limit)
            }
            Err(error) if matches!(error.kind, MotionErrorKind::StepUnderflow(_)) => {
                if self.goes_to_kink(limit)? { self.step_along_kink(limit) } else { Err(error) }
            }
            outcome => outcome,
        }
    }

    fn replace_state(&mut self, state: &State) {
        // the projection onto constraints changes the state by as much as the tolerance, which may
        // exceed rounding
        self.stale |= state.values != self.state.values;
        self.state.copy_from(state);
        self.replace_along_kink(state);
    }

    fn state(&self) -> &State {
        &self.state
    }

    fn tolerance(&self) -> Option<f64> {
        Some(self.tolerance)
    }
}

impl DenseOutput for DormandPrince {
    fn interval(&self) -> (f64, f64) {
        (self.before.time, self.state.time)
    }

    fn at(&mut self, time: f64, out: &mut State) -> Result<(), MotionError> {
        if time == self.state.time {
            out.copy_from(&self.state);
            return Ok(());
        }
        if let Some(outcome) = self.at_along_kink(time, out) {
            return outcome;
        }
        self.complete()?;
        out.copy_from(&self.before);
        let step = self.last_step();
        let part = (DoubleDouble::from_decimal(time) - self.before.exact_time()).high / step;
        let rest = 1.0 - part;
        for i in 0..self.numbers.len() {
            let change = (self.state.exact(i) - self.before.exact(i)).high;
            let (first, last) = (step * self.last[0][i], step * self.last[METHOD_STAGES][i]);
            // u = s (c₁ + (1 − s) (c₂ + s (c₃ + (1 − s) (c₄ + …))))
            let mut coefficients =
                [change, first - change, 2.0 * change - last - first, 0.0, 0.0, 0.0, 0.0];
            for (c, terms) in coefficients[3..].iter_mut().zip(DENSE) {
                *c = step * sum(terms, &self.last, i);
            }
            let mut moved = 0.0;
            for (k, c) in coefficients.iter().enumerate().rev() {
                moved = (moved + c) * if k % 2 == 0 { part } else { rest };
            }
            out.set(i, self.before.exact(i) + DoubleDouble::from(moved));
        }
        (out.time, out.time_carry) = (time, 0.0);
        self.system.check_finite(out)
    }
}
