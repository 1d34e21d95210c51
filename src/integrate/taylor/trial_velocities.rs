//! Trial velocities at a state at rest: what small velocities in all directions do against dry friction,
//! −μ v/|v|, which has no value at rest.
//!
//! In: a state in which all velocities are zero, the rates, the size of the velocities to try. Out: the
//! accelerations in a direction, the largest gain of kinetic energy in any, the direction in which a
//! motion begins and its first step, and the time at which the forces exceed friction. Never: whether the
//! motion had come to rest, or what is carried on while it rests.

use super::onset::{self, Onset};
use crate::num::{Analytic, DoubleDouble, GOLDEN, golden_section};
use crate::system::{ExactRates, Form, MotionError, MotionErrorKind, State, System};

/// The number of directions between any two velocities.
const BETWEEN: usize = 16;

/// The maximal number of iterations for the direction of a motion that starts.
const ROUNDS: usize = 200;

/// The first step of a motion that starts with a polynomial, in the same measure, and the maximal number
/// of halvings of it.
const LONGEST: f64 = 0.25;
const SHORTER: u32 = 24;

/// A force that reverses with the velocity counts as friction if it is at least this part of all
/// forces.
const FRICTION: f64 = 0.01;

/// The forces are followed in time where they are predicted to this part of them.
const FOLLOWED: f64 = 0.02;

/// The number of iterations for the time at which rest ends; each golden section contributes less
/// than one halving.
const HALVINGS: u32 = 60;
const SECTIONS: u32 = 40;

/// A state at rest whose small velocities are tested.
pub(super) struct TrialVelocities<'a> {
    pub(super) system: &'a System,
    pub(super) rates: &'a mut ExactRates,
    pub(super) parameters: &'a [f64],
    pub(super) still: State,
    pub(super) n: usize,
    pub(super) size: f64,
}

impl TrialVelocities<'_> {
    /// The state at rest with a small velocity in a direction.
    fn moving(&self, direction: &[f64]) -> State {
        let length = direction
            .iter()
            .map(|x| DoubleDouble::product(*x, *x))
            .fold(DoubleDouble::ZERO, |a, b| a + b);
        let length = Analytic::sqrt(length);
        let mut state = self.still.clone();
        for (i, &x) in direction.iter().enumerate() {
            state.set(self.n + i, DoubleDouble::from(x) / length * self.size);
        }
        state
    }

    /// The accelerations there, if they are finite.
    pub(super) fn accelerations(
        &mut self,
        direction: &[f64],
    ) -> Result<Option<Vec<DoubleDouble>>, MotionError> {
        let state = self.moving(direction);
        let numbers: Vec<DoubleDouble> = (0..state.values.len()).map(|i| state.exact(i)).collect();
        match self.rates.evaluate(state.exact_time(), &numbers) {
            Ok(()) => {}
            Err(error) if error.kind == MotionErrorKind::Cancelled => return Err(error),
            Err(_) => return Ok(None),
        }
        let found: Vec<DoubleDouble> = (self.n..2 * self.n).map(|i| self.rates.rate(i)).collect();
        Ok(found.iter().all(|x| x.is_finite()).then_some(found))
    }

    /// The largest gain of kinetic energy of a small velocity in any direction, relative to its
    /// size; if it is negative the motion stays at rest.
    pub(super) fn margin(&mut self) -> Result<Option<f64>, MotionError> {
        let mut some = vec![0.0; self.n];
        some[0] = 1.0;
        // friction is odd in the direction, so the mean is everything else
        let Some(there) = self.accelerations(&some)? else { return Ok(None) };
        some[0] = -1.0;
        let Some(back) = self.accelerations(&some)? else { return Ok(None) };
        let others: Vec<f64> = there.iter().zip(&back).map(|(a, b)| (*a + *b).high * 0.5).collect();
        let strength = there.iter().chain(&back).fold(0.0_f64, |m, a| m.max(a.high.abs()));
        let mut directions = all_directions(self.n);
        if others.iter().any(|x| x.abs() > 1e-14 * strength) {
            if let Some(force) = self.momenta(&others)? {
                directions.push(force);
            }
            directions.push(others);
        }
        let mut most = f64::NEG_INFINITY;
        for direction in &directions {
            match self.gains(direction)? {
                Some(gain) => most = most.max(gain / self.size),
                None => return Ok(None),
            }
        }
        Ok(Some(most))
    }

    /// Whether a significant part of the accelerations reverses with the velocity.
    pub(super) fn has_friction(&mut self) -> Result<bool, MotionError> {
        let mut some = vec![0.0; self.n];
        some[0] = 1.0;
        let Some(there) = self.accelerations(&some)? else { return Ok(false) };
        some[0] = -1.0;
        let Some(back) = self.accelerations(&some)? else { return Ok(false) };
        let strength = there.iter().chain(&back).fold(0.0_f64, |m, a| m.max(a.high.abs()));
        let odd = there.iter().zip(&back).map(|(a, b)| 0.5 * (*a - *b).high.abs());
        Ok(odd.fold(0.0, f64::max) > FRICTION * strength)
    }

    /// The direction in which a motion from rest is accelerated, and its rates.
    pub(super) fn direction(
        &mut self,
    ) -> Result<Option<(Vec<f64>, Vec<DoubleDouble>)>, MotionError> {
        let n = self.n;
        let mut direction: Vec<f64> = (0..n).map(|i| f64::from(u8::from(i == 0))).collect();
        let Some(there) = self.accelerations(&direction)? else { return Ok(None) };
        direction[0] = -1.0;
        let Some(back) = self.accelerations(&direction)? else { return Ok(None) };
        let strength = there.iter().chain(&back).fold(0.0_f64, |m, a| m.max(a.high.abs()));
        direction = there.iter().zip(&back).map(|(a, b)| (*a + *b).high * 0.5).collect();
        for round in 0..=ROUNDS {
            let Some(found) = self.accelerations(&direction)? else { return Ok(None) };
            let along: f64 = found.iter().zip(&direction).map(|(a, b)| a.high * b).sum();
            if along <= 0.0 || along.is_nan() {
                return Ok(None);
            }
            if round == ROUNDS {
                return Ok(Some((direction, found)));
            }
            // keeps a part of the old direction, since friction pulls strongly aside
            let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
            let share = strength / length;
            direction = found.iter().zip(&direction).map(|(a, d)| a.high + share * d).collect();
        }
        Ok(None)
    }

    /// Whether the accelerations in two opposite directions are followed at so many equal intervals from
    /// a time on: whether their values between them are what those at their ends predict.
    pub(super) fn follows(
        &mut self,
        time: f64,
        reach: f64,
        intervals: u32,
    ) -> Result<bool, MotionError> {
        let step = reach / f64::from(intervals);
        let mut samples = Vec::new();
        for k in 0..=intervals {
            let Some(sample) = self.both_ways(time + step * f64::from(k))? else { return Ok(true) };
            samples.push(sample);
        }
        let strength = samples.iter().flatten().fold(0.0_f64, |m, a| m.max(a.abs()));
        for (k, around) in samples.windows(4).enumerate() {
            // irregular places, which meet no period
            let x = 0.3 + 0.4 * (GOLDEN * k as f64).fract();
            let Some(there) = self.both_ways(time + step * (k as f64 + 1.0 + x))? else {
                return Ok(true);
            };
            let weights = [
                -x * (x - 1.0) * (x - 2.0) / 6.0,
                (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0,
                -x * (x + 1.0) * (x - 2.0) / 2.0,
                x * (x + 1.0) * (x - 1.0) / 6.0,
            ];
            for (i, &value) in there.iter().enumerate() {
                let predicted: f64 = around.iter().zip(weights).map(|(a, w)| a[i] * w).sum();
                if (predicted - value).abs() > FOLLOWED * strength {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    /// The accelerations of a small velocity and of its opposite at a time.
    fn both_ways(&mut self, time: f64) -> Result<Option<Vec<f64>>, MotionError> {
        (self.still.time, self.still.time_carry) = (time, 0.0);
        let mut some = vec![0.0; self.n];
        some[0] = 1.0;
        let Some(there) = self.accelerations(&some)? else { return Ok(None) };
        some[0] = -1.0;
        let Some(back) = self.accelerations(&some)? else { return Ok(None) };
        Ok(Some(there.iter().chain(&back).map(|a| a.high).collect()))
    }

    /// The time between two others at which rest ends, if it does, checked at steps of this size.
    pub(super) fn end_of_rest(
        &mut self,
        time: f64,
        end: f64,
        step: f64,
    ) -> Result<Option<f64>, MotionError> {
        let mut samples = [(time, f64::NEG_INFINITY); 3];
        let count = ((end - time) / step).ceil();
        for k in 0..=count as u32 {
            let at = if f64::from(k) >= count { end } else { time + step * f64::from(k) };
            let margin = self.margin_at(at)?;
            let [_, b, c] = samples;
            samples = [b, c, (at, margin)];
            let [first, middle, last] = samples;
            let mut rests = middle;
            let mut moves = (last.1 >= 0.0).then_some(last);
            if moves.is_none() && k > 1 && middle.1 > first.1 && middle.1 > last.1 {
                // it may end between two checks
                let top = self.top([first.0, last.0])?;
                moves = (top.1 >= 0.0).then_some(top);
                rests = first;
            }
            let Some(moves) = moves else { continue };
            let (mut rests, mut moves) = (rests.0, moves.0);
            // not `bisect`: the time asked for last is that of the trial state
            for _ in 0..HALVINGS {
                let middle = 0.5 * (rests + moves);
                if self.margin_at(middle)? < 0.0 {
                    rests = middle;
                } else {
                    moves = middle;
                }
            }
            return Ok(Some(moves));
        }
        Ok(None)
    }

    /// The greatest margin between two times, and its time.
    fn top(&mut self, ends: [f64; 2]) -> Result<(f64, f64), MotionError> {
        let mut best = (ends[0], f64::NEG_INFINITY);
        golden_section(ends, SECTIONS, |time| {
            let margin = self.margin_at(time)?;
            if margin > best.1 {
                best = (time, margin);
            }
            Ok::<_, MotionError>(-margin)
        })?;
        Ok(best)
    }

    /// The margin at a time; where it has no value, the motion stays at rest.
    fn margin_at(&mut self, time: f64) -> Result<f64, MotionError> {
        (self.still.time, self.still.time_carry) = (time, 0.0);
        Ok(self.margin()?.unwrap_or(f64::NEG_INFINITY))
    }

    /// The state a short time after rest has ended: the velocities follow from the accelerations
    /// halfway.
    pub(super) fn first_step(&mut self, first: f64) -> Result<Option<State>, MotionError> {
        let begin = self.still.exact_time();
        let halfway = begin + DoubleDouble::from(0.5 * first);
        (self.still.time, self.still.time_carry) = (halfway.high, halfway.low);
        let Some((_, accelerations)) = self.direction()? else { return Ok(None) };
        let mut state = self.still.clone();
        for (i, &a) in accelerations.iter().enumerate() {
            state.set(self.n + i, state.exact(self.n + i) + a * first);
        }
        let end = begin + DoubleDouble::from(first);
        (state.time, state.time_carry) = (end.high, end.low);
        Ok(Some(state))
    }

    /// The beginning of a motion from rest, as long as the polynomial over it agrees with that over
    /// half of it.
    pub(super) fn onset(&mut self, stride: f64) -> Result<Option<Onset>, MotionError> {
        let from = self.still.clone();
        let mut step = LONGEST * stride;
        let (mut whole, mut found) = (self.onset_over(&from, step)?, None);
        for _ in 0..SHORTER {
            step *= 0.5;
            let half = self.onset_over(&from, step)?;
            if let (Some(one), Some(other)) = (&whole, &half)
                && one.agrees(other, self.n)
            {
                found = whole;
                break;
            }
            whole = half;
        }
        self.still = from;
        Ok(found)
    }

    fn onset_over(&mut self, from: &State, step: f64) -> Result<Option<Onset>, MotionError> {
        let mut found = Vec::new();
        for part in onset::points() {
            let time = from.exact_time() + DoubleDouble::product(step, part);
            (self.still.time, self.still.time_carry) = (time.high, time.low);
            let Some((_, accelerations)) = self.direction()? else { return Ok(None) };
            found.push(accelerations.iter().map(|a| a.high).collect());
        }
        Onset::new(self.rates, (from, from), self.n, step, &found)
    }

    /// The momenta of a velocity in a direction, less those at rest. They have the direction of a
    /// force that accelerates so.
    fn momenta(&self, direction: &[f64]) -> Result<Option<Vec<f64>>, MotionError> {
        if self.still.form == Form::Momentum {
            return Ok(None);
        }
        let moving = self.moving(direction);
        let momenta = self.system.convert(&moving, Form::Momentum, self.parameters)?;
        let still = self.system.convert(&self.still, Form::Momentum, self.parameters)?;
        let n = self.n;
        Ok(Some((n..2 * n).map(|i| (momenta.exact(i) - still.exact(i)).high).collect()))
    }

    /// The gain of kinetic energy of a small velocity in a direction, up to a factor.
    fn gains(&mut self, direction: &[f64]) -> Result<Option<f64>, MotionError> {
        let Some(accelerations) = self.accelerations(direction)? else { return Ok(None) };
        if self.still.form == Form::Momentum {
            let gain = (0..self.n)
                .fold(DoubleDouble::ZERO, |sum, i| sum + self.rates.rate(i) * accelerations[i]);
            return Ok(Some(gain.high));
        }
        let moving = self.moving(direction);
        let momenta = self.system.convert(&moving, Form::Momentum, self.parameters)?;
        let still = self.system.convert(&self.still, Form::Momentum, self.parameters)?;
        let gain = (0..self.n).fold(DoubleDouble::ZERO, |sum, i| {
            sum + (momenta.exact(self.n + i) - still.exact(self.n + i)) * accelerations[i]
        });
        Ok(Some(gain.high))
    }
}

/// The directions along every velocity, and around the circle of any two.
fn all_directions(n: usize) -> Vec<Vec<f64>> {
    let mut all = Vec::new();
    for i in 0..n {
        for sign in [1.0, -1.0] {
            let mut one = vec![0.0; n];
            one[i] = sign;
            all.push(one);
        }
        for j in 0..i {
            for k in 0..BETWEEN {
                let angle = std::f64::consts::TAU * (k as f64 + 0.5) / BETWEEN as f64;
                let (sine, cosine) = crate::num::math::sin_cos(angle);
                let mut two = vec![0.0; n];
                (two[i], two[j]) = (sine, cosine);
                all.push(two);
            }
        }
    }
    all
}
