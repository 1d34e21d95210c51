//! Functions of events that are zero all along a motion but for rounding, as x² + y² − 1 on the unit circle: all changes of
//! their signs are rounding, or the error of the orbit.
//!
//! In: a state at which the motion begins or was changed. Out: the functions that are zero from there on. Never here: crossings.
//!
//! Where the law is analytic a function is zero along the motion if it is zero on any part of it. That part is a step by
//! Taylor series, whichever method follows the motion: its error is that of rounding.

use super::EventLocator;
use crate::integrate::method::Settings;
use crate::integrate::stepper::Stepper;
use crate::integrate::{initial_step, taylor};
use crate::system::{MotionError, State, System};

/// A function is zero but for rounding where it is less than this many times the change that the last digits of the numbers
/// it depends on make in it: they are rounded in each of the operations that lead to them.
const ROUNDINGS: f64 = 64.0;

/// A function whose rate is more than this part of its terms', over that of the numbers it depends on, leaves its
/// zero at once.
const RATE: f64 = 1e-3;

/// The part by which the numbers are displaced to see that.
const DISPLACED: f64 = 1e-5;

/// The parts of a step at which a function is evaluated: no multiples of each other, so that no period hides it.
const PARTS: [f64; 8] = [0.0, 0.1271, 0.2693, 0.4127, 0.5411, 0.7039, 0.8573, 1.0];

/// The step is at most this many times the time scale of the motion.
const SCALES: f64 = 4.0;

/// A function is no longer taken for zero where it is more than this part of its terms, which no error of an orbit by
/// steps chosen by their error is.
const LEFT: f64 = 1e-9;

/// A function is no longer taken for zero either where it is more than this many times its tolerance.
const TOLERANCES: f64 = 1e4;

/// The part of its terms above which a function is no longer taken for zero where steps are equal.
const LEFT_BY_EQUAL_STEPS: f64 = 1e-2;

impl EventLocator {
    /// Finds the functions that are zero from a state in the native form on.
    pub(in crate::integrate) fn find_vanishing(
        &mut self,
        system: &System,
        state: &State,
        parameters: &[f64],
    ) {
        for (event, _) in std::mem::take(&mut self.vanishing) {
            self.may_cross[event] = true;
        }
        let all = 0..self.sides.len();
        let mut doubtful: Vec<usize> =
            all.filter(|&event| self.may_cross[event] && self.is_rounding(event, state)).collect();
        if doubtful.is_empty() {
            return;
        }
        if let Some(rates) = rates(system, state, parameters) {
            doubtful.retain(|&event| !self.leaves_at_once(event, state, &rates));
        }
        if doubtful.is_empty() {
            return;
        }
        let Some(mut motion) = step_by_series(system, state, parameters) else { return };
        let (begin, end) = motion.interval();
        let mut there = state.clone();
        for part in PARTS {
            let time = if part == 1.0 { end } else { begin + part * (end - begin) };
            if begin >= end || motion.at(time, &mut there).is_err() {
                return;
            }
            doubtful.retain(|&event| self.is_rounding(event, &there));
        }
        for event in doubtful {
            self.may_cross[event] = false;
            self.sides[event] = 0.0;
            self.vanishing.push((event, state.time));
        }
    }

    /// The events whose functions are zero all along, and since when.
    pub(in crate::integrate) fn vanishing(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.vanishing.iter().copied()
    }

    /// Follows those that are zero no more at a state, as after a kink of the law. `tolerance` is that of the method, if it has one.
    pub(in crate::integrate) fn note_departures(&mut self, state: &State, tolerance: Option<f64>) {
        let part =
            tolerance.map_or(LEFT_BY_EQUAL_STEPS, |tolerance| LEFT.max(TOLERANCES * tolerance));
        for (event, since) in std::mem::take(&mut self.vanishing) {
            match self.value_and_rounding(event, state) {
                Ok((value, rounding)) if value.abs() > part / f64::EPSILON * rounding => {
                    self.may_cross[event] = true;
                    self.sides[event] = value.signum();
                    self.last[event] = f64::NAN;
                }
                _ => self.vanishing.push((event, since)),
            }
        }
    }

    /// Whether a function is zero at a state but for rounding.
    fn is_rounding(&mut self, event: usize, state: &State) -> bool {
        self.value_and_rounding(event, state)
            .is_ok_and(|(value, rounding)| value.abs() <= ROUNDINGS * rounding)
    }

    /// The value of a function at a state, and by how much the last digits of the state's numbers change it.
    fn value_and_rounding(
        &mut self,
        event: usize,
        state: &State,
    ) -> Result<(f64, f64), MotionError> {
        let value = self.probe.exactly_of(event, state)?;
        let mut moved = state.clone();
        let mut rounding = 0.0;
        for i in 0..state.values.len() {
            moved.values[i] *= 1.0 + f64::EPSILON;
            let change = self.probe.exactly_of(event, &moved)? - value;
            rounding += change.high.abs();
            moved.values[i] = state.values[i];
        }
        Ok((value.high, rounding))
    }

    /// Whether a function that is zero at a state has a rate there that is no rounding.
    fn leaves_at_once(&mut self, event: usize, state: &State, rates: &[f64]) -> bool {
        let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let (size, speed) = (largest(&state.values), largest(rates));
        if !(speed > 0.0 && size > 0.0 && speed.is_finite()) {
            return false;
        }
        let interval = DISPLACED * size / speed;
        let mut at = |after: f64| {
            let mut there = state.clone();
            there.time += after;
            for (x, rate) in there.values.iter_mut().zip(rates) {
                *x += after * rate;
            }
            self.probe.exactly_of(event, &there).ok()
        };
        let (Some(later), Some(earlier)) = (at(interval), at(-interval)) else { return false };
        let change = 0.5 * (later - earlier).high.abs();
        let Ok((_, rounding)) = self.value_and_rounding(event, state) else { return false };
        change > RATE * DISPLACED * rounding / f64::EPSILON
    }
}

fn rates(system: &System, state: &State, parameters: &[f64]) -> Option<Vec<f64>> {
    let mut rates = system.native_rates();
    rates.set_parameters(parameters);
    rates.begin_near(state);
    let mut out = vec![0.0; state.values.len()];
    rates.evaluate(state.time, &state.values, &mut out).ok()?;
    Some(out)
}

/// The motion from a state after a step by Taylor series, on the time scale of the motion.
fn step_by_series(system: &System, state: &State, parameters: &[f64]) -> Option<Box<dyn Stepper>> {
    let mut motion = (taylor::METHOD.make)(system, &Settings::default()).ok()?;
    motion.start(state, parameters).ok()?;
    let limit = state.time + SCALES * initial_step::of(system, state, parameters);
    motion.step(limit).ok()?;
    Some(motion)
}
