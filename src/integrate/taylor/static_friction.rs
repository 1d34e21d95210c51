//! A motion at rest under static friction, until it starts to move.
//!
//! In: a state at rest, the time up to which it continues. Out: the states at rest, with the auxiliary
//! numbers carried on, and the beginning of the motion once the forces exceed friction. How far the forces
//! are followed in time at once is found by what they are in between. Never: whether a motion comes to
//! rest.

use super::onset::{Onset, POINTS};
use super::trial_velocities::TrialVelocities;
use crate::num::DoubleDouble;
use crate::system::{ExactRates, MotionError, State, System};

/// The number of checks of a motion at rest within a typical step.
const CHECKS: u32 = 32;

/// The maximal number of times a step is divided by four so that the forces are followed.
const QUARTERINGS: u32 = 24;

/// The first step of a motion that starts, as a part of a typical one: what it neglects is of third
/// order.
pub(super) const FIRST: f64 = 1e-8;

/// What is left of the rates with two small velocities, less what is proportional to these, is their rounding below this part of them:
/// the work of a friction that does none.
const CANCELLED: f64 = 1e-20;

#[derive(Debug)]
pub(super) struct RestUnderFriction {
    /// The state at the beginning of the last step.
    from: State,
    /// The rates of all numbers at rest, zero except for the auxiliary numbers and integrals.
    rates: Vec<DoubleDouble>,
    degrees: usize,
    /// The place of the first auxiliary number.
    moving: usize,
    size: f64,
    /// The length of a step within which the forces are followed in time.
    stride: f64,
    next: f64,
    /// The beginning of the motion after rest.
    onset: Option<Onset>,
    over: bool,
}

impl RestUnderFriction {
    /// A motion at rest at a state, with the rates of its auxiliary numbers; the number of degrees of
    /// freedom and the place of the first auxiliary number, the size of trial velocities, the length of a
    /// typical step.
    pub(super) fn new(
        from: State,
        rates: Vec<DoubleDouble>,
        (degrees, moving): (usize, usize),
        (size, stride): (f64, f64),
    ) -> RestUnderFriction {
        RestUnderFriction {
            from,
            rates,
            degrees,
            moving,
            size,
            stride,
            next: stride,
            onset: None,
            over: false,
        }
    }

    /// Whether the motion has started at the end of the last step.
    pub(super) fn is_over(&self) -> bool {
        self.over
    }

    /// The time at the beginning of the last step.
    pub(super) fn step_begin(&self) -> DoubleDouble {
        self.from.exact_time()
    }

    /// Continues at rest from a state up to a time, or until it starts moving. Returns the state
    /// there.
    pub(super) fn advance(
        &mut self,
        system: &System,
        rates: &mut ExactRates,
        parameters: &[f64],
        (from, limit): (&State, f64),
    ) -> Result<State, MotionError> {
        self.from = from.clone();
        if self.onset.is_some() {
            return self.set_out(rates, limit);
        }
        let (n, time) = (system.degrees(), from.time);
        let mut end = limit;
        if rates.depends_on_time() {
            let (size, still) = (self.size, from.clone());
            let mut trial =
                TrialVelocities { system, rates: &mut *rates, parameters, still, n, size };
            end = self.resolved(&mut trial, limit)?;
            let step = (self.stride / f64::from(CHECKS)).copysign(limit - time);
            if let Some(breaks) = trial.end_of_rest(time, end, step)? {
                let until = self.at(rates, DoubleDouble::from(breaks))?;
                let still = until.clone();
                let mut trial =
                    TrialVelocities { system, rates: &mut *rates, parameters, still, n, size };
                let onset = trial.onset(self.stride.copysign(step))?;
                let first = if onset.is_none() {
                    let first = (FIRST * self.stride).copysign(step);
                    trial.first_step(first)?.unwrap_or(until)
                } else {
                    until
                };
                return self.begin(rates, (onset, first), limit);
            }
        }
        self.at(rates, DoubleDouble::from_decimal(end))
    }

    /// The end of a step so short that the forces are followed in time, which the next may exceed.
    fn resolved(
        &mut self,
        trial: &mut TrialVelocities<'_>,
        limit: f64,
    ) -> Result<f64, MotionError> {
        let time = self.from.time;
        let mut reach = self.next.min((limit - time).abs());
        for _ in 0..QUARTERINGS {
            if trial.follows(time, reach.copysign(limit - time), CHECKS)? {
                break;
            }
            reach *= 0.25;
        }
        // beyond the last digit of the time
        let reach = reach.max(4.0 * f64::EPSILON * time.abs());
        let end = time + reach.copysign(limit - time);
        let last = reach >= (limit - time).abs();
        self.stride = reach;
        self.next = 2.0 * reach;
        Ok(if last { limit } else { end })
    }

    /// Begins the motion after rest: with a polynomial, or at the state after a first step.
    pub(super) fn begin(
        &mut self,
        rates: &mut ExactRates,
        (onset, first): (Option<Onset>, State),
        limit: f64,
    ) -> Result<State, MotionError> {
        self.onset = onset;
        if self.onset.is_some() {
            return self.set_out(rates, limit);
        }
        self.over = true;
        Ok(first)
    }

    /// Continues along the beginning of the motion, up to its end or a limit.
    fn set_out(&mut self, rates: &mut ExactRates, limit: f64) -> Result<State, MotionError> {
        let limit = DoubleDouble::from_decimal(limit);
        let end = self.onset.as_ref().map_or(limit, Onset::end);
        let begin = self.from.exact_time();
        self.over = (end - begin).high.abs() <= (limit - begin).high.abs();
        self.at(rates, if self.over { end } else { limit })
    }

    /// The state at a time within the last step.
    pub(super) fn at(
        &self,
        rates: &mut ExactRates,
        time: DoubleDouble,
    ) -> Result<State, MotionError> {
        let moves = |onset: &&Onset| {
            let after = (time - onset.begin()).high;
            after != 0.0 && (after > 0.0) == (onset.end() - onset.begin()).high.is_sign_positive()
        };
        if let Some(onset) = self.onset.as_ref().filter(moves) {
            return Ok(onset.at(time));
        }
        let mut state = self.from.clone();
        let after = time - self.from.exact_time();
        let carried = self.moving..self.rates.len();
        if !rates.depends_on_time() {
            for i in carried {
                state.set(i, state.exact(i) + self.rates[i] * after);
            }
        } else if !carried.is_empty() {
            // also what has no rate where the rest began: the work of a force that is zero there
            let pieces = (after.high.abs() / self.stride * f64::from(CHECKS)).ceil().max(1.0);
            let half = after * (0.5 / pieces);
            for k in 0..pieces as u32 {
                let middle = self.from.exact_time() + half * f64::from(2 * k + 1);
                for (place, weight) in POINTS {
                    let sums = self.rates_at_rest(rates, middle + half * place)?;
                    for (i, rate) in carried.clone().zip(sums) {
                        state.set(i, state.exact(i) + half * weight * rate);
                    }
                }
            }
        }
        (state.time, state.time_carry) = (time.high, time.low);
        Ok(state)
    }

    /// The rates of the auxiliary numbers at rest, at a time: those of two small velocities, less what is
    /// proportional to these, since friction has no value at rest.
    fn rates_at_rest(
        &self,
        rates: &mut ExactRates,
        time: DoubleDouble,
    ) -> Result<Vec<DoubleDouble>, MotionError> {
        let mut at = |size: f64| -> Result<Vec<DoubleDouble>, MotionError> {
            rates.evaluate(time, &self.barely_moving(size))?;
            Ok((self.moving..self.rates.len()).map(|i| rates.rate(i)).collect())
        };
        let (faster, slower) = (at(self.size)?, at(0.5 * self.size)?);
        let at_rest = |(fast, slow): (DoubleDouble, DoubleDouble)| {
            let left = slow + slow - fast;
            if is_cancelled(left.high, fast.high) { DoubleDouble::ZERO } else { left }
        };
        Ok(faster.into_iter().zip(slower).map(at_rest).collect())
    }

    /// The numbers at rest, except for one small velocity.
    fn barely_moving(&self, size: f64) -> Vec<DoubleDouble> {
        let mut numbers: Vec<DoubleDouble> =
            (0..self.from.values.len()).map(|i| self.from.exact(i)).collect();
        numbers[self.degrees] = numbers[self.degrees] + DoubleDouble::from(size);
        numbers
    }
}

/// Whether what is left of rates of this size is their rounding.
fn is_cancelled(left: f64, rate: f64) -> bool {
    left.abs() <= CANCELLED * rate.abs()
}

#[cfg(test)]
mod tests {
    use super::is_cancelled;

    #[test]
    fn what_is_left_at_rest_is_rounding_below_1e_20() {
        assert!(is_cancelled(1.9e-20, -2.0) && !is_cancelled(2.1e-20, -2.0));
    }
}
