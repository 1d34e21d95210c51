//! Motions that reach infinity in a finite time, as those of ẍ = 6 x² do.
//!
//! In: the state at which a motion stopped. Out: which coordinate grows without bound, and when it has done so. Never
//! here: collisions, where velocities grow without bound and coordinates do not.
//!
//! With τ, the time that is left, the speed of such a motion is like τ^−β, with β ≥ 1, since ∫ τ^−β dτ has no bound; in a
//! collision β < 1. From speed v, its rate v̇ and the rate of that, v̈, follow β/(β + 1) = v̇²/(v v̈) and τ = β v/v̇. These
//! are taken from the law at the place where the motion stopped.

use super::{Method, Settings, Stepper, Stepping, method_named, spacing};
use crate::num::{self, Analytic, DoubleDouble, math};
use crate::system::{ExactRates, Form, MotionError, MotionErrorKind, State, System};

/// The least v̇²/(v v̈) of a motion to infinity, which is that of ẍ = e^x, where x grows like −2 ln τ.
const LEAST: f64 = 0.5;

/// How far v̇²/(v v̈) may lie below that.
const MARGIN: f64 = 1e-3;

/// The greatest: a motion that grows like e^t, with 1, never reaches infinity.
const GREATEST: f64 = 0.995;

/// Below this a coordinate comes to a place while its velocity grows without bound.
const CONVERGING: f64 = 0.45;

/// The parts of the time in which the speeds change, and of the last step, between the speeds that are compared.
const PART_OF_CHANGE: f64 = 1e-3;
const PART_OF_STEP: f64 = 0.1;

/// The motion stops because of what happens within so many times its last step.
const STEPS_LEFT: f64 = 1e6;

/// The most steps of the trial that finds out when a motion with fixed steps should have stopped.
const MOST_STEPS: u32 = 4000;

/// A step below this part of the spacing of times is that of a motion at a singular place.
const VANISHING: f64 = 1e-9;

/// The digits of the time that are not shown, of those that the tolerance stands for.
const UNCERTAIN: f64 = 2.0;

/// A coordinate and the time at which it reaches infinity.
struct BlowUp {
    coordinate: usize,
    time: DoubleDouble,
}

/// A motion that cannot continue.
#[derive(Clone, Copy)]
pub struct StoppedMotion<'a> {
    /// Its law.
    pub system: &'a System,
    /// The method that followed it.
    pub method: &'static Method,
    /// Where it stopped.
    pub stepper: &'a dyn Stepper,
    /// Those that it moved at, in the order of the model.
    pub parameters: &'a [f64],
    /// Where it began, or continued after an impulse.
    pub begun: Option<&'a State>,
}

impl StoppedMotion<'_> {
    /// The error of a motion that reaches infinity where it stopped, in place of the one that its method met there.
    pub fn blow_up(&self, error: &MotionError) -> Option<MotionError> {
        let (begin, end) = self.stepper.interval();
        let found = match (&error.kind, self.method.stepping) {
            (MotionErrorKind::StepUnderflow(step), Stepping::Adaptive) => {
                let step = if end < begin { -step.abs() } else { step.abs() };
                self.blow_up_from(self.stepper.state(), step)
            }
            // events may come ever faster on the way
            (
                MotionErrorKind::NotFinite(_) | MotionErrorKind::EventsAccumulate(_),
                Stepping::Adaptive,
            ) => self.blow_up_from(self.stepper.state(), end - begin),
            (
                MotionErrorKind::NotFinite(_) | MotionErrorKind::NoConvergence(_),
                Stepping::Fixed,
            ) => self.blow_up_before(error.time),
            _ => None,
        }?;
        let name = self.system.channels().get(found.coordinate)?.shown.clone();
        let digits = match (self.method.stepping, self.stepper.tolerance()) {
            (Stepping::Adaptive, Some(tolerance)) => known_digits(tolerance),
            _ => f64::INFINITY,
        };
        let kind = MotionErrorKind::BlowsUp(name);
        Some(MotionError { time: rounded(found.time.high, digits), kind, place: Vec::new() })
    }

    /// The error of a motion that begins at a time with too few digits for its first step, in place of the one that a singular place
    /// gives, towards which steps vanish.
    pub fn beyond_the_clock(&self, error: &MotionError) -> Option<MotionError> {
        let MotionErrorKind::StepUnderflow(step) = error.kind else { return None };
        let digits = spacing(error.time);
        let begins = self.begun.is_some_and(|begun| begun.time == error.time);
        (begins && is_ordinary(step, digits)).then(|| MotionError {
            kind: MotionErrorKind::ClockStands(digits),
            place: Vec::new(),
            time: error.time,
        })
    }

    /// Follows the motion from its beginning by series to near a time that fixed steps have come to.
    fn blow_up_before(&self, time: f64) -> Option<BlowUp> {
        let from = self.begun?;
        let settings = Settings { step: None, tolerance: None };
        let mut stepper = (method_named("taylor")?.make)(self.system, &settings).ok()?;
        stepper.start(from, self.parameters).ok()?;
        let until = time + 2.0 * self.stepper.step_size();
        for _ in 0..MOST_STEPS {
            if stepper.time() == until {
                return None;
            }
            if let Err(error) = stepper.step(until) {
                let MotionErrorKind::StepUnderflow(step) = error.kind else { return None };
                return self.blow_up_from(stepper.state(), step.abs().copysign(until - from.time));
            }
        }
        None
    }

    /// Whether a motion that stopped at a state, over a step of this size, reaches infinity.
    fn blow_up_from(&self, state: &State, step: f64) -> Option<BlowUp> {
        if state.form != self.system.form() || step == 0.0 || !state.is_finite() {
            return None;
        }
        let mut rates = self.system.exact_rates();
        rates.set_parameters(&self.system.inputs(self.parameters));
        let start: Vec<DoubleDouble> = (0..state.values.len()).map(|i| state.exact(i)).collect();
        let moving = self.system.moving();
        let mut motion = LawfulMotion { rates, time: state.exact_time(), numbers: start, moving };
        let all = if state.form == Form::Variables { moving } else { self.system.degrees() };
        let channels = self.system.channels();
        // an angle that turns ever faster goes nowhere
        let places: Vec<usize> = (0..all).filter(|&i| !channels[i].periodic).collect();
        let part = PART_OF_STEP * step;
        let before = motion.clone();
        let first = motion.speeds(&places)?;
        let near = PART_OF_CHANGE * part;
        motion.advance(near)?;
        let change = (motion.speeds(&places)?.size - first.size).high;
        let interval = compared_after(first.size.high * near / change, part).copysign(step);
        motion = before;
        let mut samples = vec![first];
        for _ in 0..2 {
            motion.advance(interval)?;
            samples.push(motion.speeds(&places)?);
        }
        let speed = SpeedGrowth::of([0, 1, 2].map(|k| samples[k].size))?;
        if !is_blow_up(speed.ratio) {
            return None;
        }
        let component =
            |i: usize| SpeedGrowth::of([0, 1, 2].map(|k: usize| samples[k].components[i]));
        let fastest = |i: &usize| samples[2].components[*i].high.abs();
        let fastest = (0..places.len()).max_by(|i, j| fastest(i).total_cmp(&fastest(j)))?;
        // an angle may turn without bound on the way to a centre
        let mut others = (0..places.len()).filter(|&i| i != fastest).filter_map(component);
        if is_nearly_collision(speed.ratio) && others.any(|other| converges(other.ratio)) {
            return None;
        }
        let left = speed.ratio / (1.0 - speed.ratio) / speed.rate * interval;
        let time = motion.time + DoubleDouble::from(left - interval);
        is_near(left, step).then_some(BlowUp { coordinate: places[fastest], time })
    }
}

/// Whether a coordinate whose speed has this v̇²/(v v̈) reaches infinity in a finite time.
fn is_blow_up(ratio: f64) -> bool {
    (LEAST - MARGIN..=GREATEST).contains(&ratio)
}

/// Whether that may as well be a collision.
fn is_nearly_collision(ratio: f64) -> bool {
    ratio < LEAST + MARGIN
}

/// Whether a coordinate whose velocity has this v̇²/(v v̈) comes to a place.
fn converges(ratio: f64) -> bool {
    ratio < CONVERGING
}

/// Whether what happens after a time that is left is why a motion stopped over a step of this size.
fn is_near(left: f64, step: f64) -> bool {
    left.abs() < STEPS_LEFT * step.abs()
}

/// Whether a step is below the spacing of times, and not that of a motion at a singular place.
fn is_ordinary(step: f64, spacing: f64) -> bool {
    step.abs() > VANISHING * spacing && step.abs() <= spacing
}

fn known_digits(tolerance: f64) -> f64 {
    -math::log10(tolerance) - UNCERTAIN
}

/// How a speed grows from one of three samples at equal intervals to the next, at the second of them.
struct SpeedGrowth {
    /// v̇/v, per interval.
    rate: f64,
    /// v̇²/(v v̈).
    ratio: f64,
}

impl SpeedGrowth {
    /// `None` for one that does not grow ever faster.
    fn of([before, now, after]: [DoubleDouble; 3]) -> Option<SpeedGrowth> {
        let slope = ((after - before) * 0.5 / now).high;
        let bend = ((after - now - (now - before)) / now).high;
        (slope > 0.0 && bend > 0.0)
            .then(|| SpeedGrowth { rate: slope, ratio: slope * slope / bend })
    }
}

/// The velocities of some coordinates, and the root of the sum of their squares.
struct Speeds {
    components: Vec<DoubleDouble>,
    size: DoubleDouble,
}

/// A motion continued from a state by its law, over times in which it hardly changes.
#[derive(Clone)]
struct LawfulMotion {
    rates: ExactRates,
    time: DoubleDouble,
    numbers: Vec<DoubleDouble>,
    moving: usize,
}

impl LawfulMotion {
    /// The rates at the numbers moved by a part of other rates.
    fn slopes(&mut self, along: &[DoubleDouble], after: f64) -> Option<Vec<DoubleDouble>> {
        let mut numbers = self.numbers.clone();
        for (x, &slope) in numbers.iter_mut().zip(along) {
            *x = *x + slope * after;
        }
        self.rates.evaluate(self.time + DoubleDouble::from(after), &numbers).ok()?;
        let slopes: Vec<DoubleDouble> = (0..self.moving).map(|i| self.rates.rate(i)).collect();
        slopes.iter().all(|x| x.is_finite()).then_some(slopes)
    }

    /// Takes a step of the classical Runge–Kutta method.
    fn advance(&mut self, step: f64) -> Option<()> {
        let first = self.slopes(&[], 0.0)?;
        let second = self.slopes(&first, 0.5 * step)?;
        let third = self.slopes(&second, 0.5 * step)?;
        let fourth = self.slopes(&third, step)?;
        for i in 0..self.moving {
            let sum = first[i] + (second[i] + third[i]) * 2.0 + fourth[i];
            self.numbers[i] = self.numbers[i] + sum * step / 6.0;
        }
        self.time = self.time + DoubleDouble::from(step);
        Some(())
    }

    fn speeds(&mut self, places: &[usize]) -> Option<Speeds> {
        let slopes = self.slopes(&[], 0.0)?;
        let components: Vec<DoubleDouble> = places.iter().map(|&i| slopes[i]).collect();
        let largest = components.iter().map(|v| v.high.abs()).fold(0.0, f64::max);
        let unit = DoubleDouble::from(largest);
        let squares = components.iter().map(|&v| (v / unit) * (v / unit));
        let sum = squares.fold(DoubleDouble::ZERO, |sum, square| sum + square);
        (largest > 0.0).then(|| Speeds { components, size: Analytic::sqrt(sum) * unit })
    }
}

fn rounded(number: f64, digits: f64) -> f64 {
    if digits > f64::from(f64::DIGITS) {
        return number;
    }
    num::rounded(number, digits as usize)
}

/// The time between the speeds that are compared, where they change in this time, and no more than a part of a step.
fn compared_after(change: f64, part: f64) -> f64 {
    (PART_OF_CHANGE * change).abs().min(part.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// v = τ^−β has β/(β + 1): 1/2 for x = −2 ln τ, 2/3 for 1/τ and 3/4 for 1/τ², 2/5 for a collision of two bodies with β = 2/3 and
    /// 1 for e^t.
    #[test]
    fn speeds_are_compared_after_a_thousandth_of_the_time_in_which_they_change() {
        let time = compared_after(-2.0, 1.0);
        assert!((1.5e-3..2.5e-3).contains(&time), "{time}");
        assert_eq!(compared_after(2.0, -1e-4), 1e-4);
    }

    #[test]
    fn a_speed_that_grows_at_least_as_that_of_a_logarithm_and_less_than_exponentially_blows_up() {
        let of = |beta: f64| beta / (beta + 1.0);
        for (ratio, is_one) in [
            (of(2.0), true),
            (of(3.0), true),
            (of(2.0 / 3.0), false),
            (0.4991, true),
            (0.4989, false),
            (0.9949, true),
            (0.9951, false),
            (1.0, false),
        ] {
            assert_eq!(is_blow_up(ratio), is_one, "{ratio}");
        }
    }

    #[test]
    fn next_to_a_logarithm_another_coordinate_shows_a_collision() {
        assert!(is_nearly_collision(0.5009) && !is_nearly_collision(0.5011));
        assert!(converges(0.449) && !converges(0.451));
    }

    #[test]
    fn a_motion_stops_within_a_million_steps_of_infinity() {
        assert!(is_near(-1.9e6, 2.0) && !is_near(-2.1e6, 2.0));
    }

    #[test]
    fn a_step_below_the_spacing_of_times_is_ordinary_down_to_a_billionth_of_it() {
        for (step, is_one) in [(-2.0, true), (2.01, false), (2.1e-9, true), (1.9e-9, false)] {
            assert_eq!(is_ordinary(step, 2.0), is_one, "{step}");
        }
    }

    #[test]
    fn two_digits_of_a_tolerance_are_not_shown() {
        assert!((known_digits(1e-12) - 10.0).abs() < 1e-9);
    }
}
