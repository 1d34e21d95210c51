//! Static friction in more than one direction: −μ v/|v| is undefined at v = 0, where it may be any
//! vector up to its strength.
//!
//! In: a state in which all velocities have reached zero. Out: whether the motion stays there, or the
//! rates with which it starts to move, and when a rest ends. It stays if a small velocity in any
//! direction loses energy. This is tested in many directions, including those in which all other
//! forces pull. How far the forces are followed in time at once is found by what they are in between.

use super::onset::{self, Onset, POINTS};
use crate::num::{Analytic, DoubleDouble};
use crate::system::{ExactRates, Form, MotionError, MotionErrorKind, State, System};

/// Velocities below this part of their change in a typical step count as zero where friction
/// removes even more.
const SLOW: f64 = 1e-9;

/// Velocities below this part are nothing but rounding.
const NOTHING: f64 = 1e-15;

/// The trial velocity, in the same measure.
const TRIAL: f64 = 1e-12;

/// The ratio of the second trial velocity to the first, for the auxiliary numbers.
const SMALLER: f64 = 1e-3;

/// The maximal number of degrees of freedom that are tested in all directions.
const MOST: usize = 12;

/// The number of directions between any two velocities.
const BETWEEN: usize = 16;

/// The maximal number of iterations for the direction of a motion that starts.
const ROUNDS: usize = 200;

/// The number of checks of a motion at rest within a typical step.
const CHECKS: u32 = 32;

/// The maximal number of times a step is divided by four so that the forces are followed.
const QUARTERINGS: u32 = 24;

/// The first step of a motion that starts, as a part of a typical one: what it neglects is of third
/// order.
const FIRST: f64 = 1e-8;

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
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The result of the test.
pub(super) enum Sticking {
    /// The motion stays at rest.
    Stays(Still),
    /// The motion starts from this state, with these rates.
    SetsOut(State, Vec<DoubleDouble>),
    /// The motion is not at rest, or the test is inconclusive.
    Unknown,
}

/// A motion at rest.
#[derive(Debug)]
pub(super) struct Still {
    /// The state at the beginning of the last step.
    from: State,
    /// The rates of all numbers at rest, zero except for the auxiliary numbers and integrals.
    rates: Vec<DoubleDouble>,
    degrees: usize,
    /// The size of the trial velocities.
    size: f64,
    /// The length of a step within which the forces are followed in time.
    stride: f64,
    /// That of the next one to try.
    next: f64,
    /// The beginning of the motion after rest.
    onset: Option<Onset>,
    over: bool,
}

impl Still {
    /// A motion at rest at a state, with the rates of its auxiliary numbers; the number of degrees of
    /// freedom, the size of trial velocities, the length of a typical step.
    fn new(
        from: State,
        rates: Vec<DoubleDouble>,
        (degrees, size, stride): (usize, f64, f64),
    ) -> Still {
        Still { from, rates, degrees, size, stride, next: stride, onset: None, over: false }
    }

    /// Whether the motion has started at the end of the last step.
    pub(super) fn is_over(&self) -> bool {
        self.over
    }

    /// Continues at rest from a state up to a time, or until it starts moving. Returns the state
    /// there.
    pub(super) fn go_on(
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
            let mut asked = Asked { system, rates: &mut *rates, parameters, still, n, size };
            end = self.resolved(&mut asked, limit)?;
            let step = (self.stride / f64::from(CHECKS)).copysign(limit - time);
            if let Some(breaks) = asked.end_of_rest(time, end, step)? {
                let until = self.at(rates, DoubleDouble::from(breaks))?;
                let still = until.clone();
                let mut asked = Asked { system, rates: &mut *rates, parameters, still, n, size };
                let onset = asked.onset(self.stride.copysign(step))?;
                let first = if onset.is_none() {
                    let first = (FIRST * self.stride).copysign(step);
                    asked.first_step(first)?.unwrap_or(until)
                } else {
                    until
                };
                return self.begin(rates, (onset, first), limit);
            }
        }
        self.at(rates, DoubleDouble::written(end))
    }

    /// The end of a step so short that the forces are followed in time, which the next may exceed.
    fn resolved(&mut self, asked: &mut Asked<'_>, limit: f64) -> Result<f64, MotionError> {
        let time = self.from.time;
        let mut reach = self.next.min((limit - time).abs());
        for _ in 0..QUARTERINGS {
            if asked.follows(time, reach.copysign(limit - time), CHECKS)? {
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
    fn begin(
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
        let limit = DoubleDouble::written(limit);
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
        let carried: Vec<usize> =
            (0..self.rates.len()).filter(|&i| self.rates[i] != DoubleDouble::ZERO).collect();
        if !rates.depends_on_time() {
            for &i in &carried {
                state.set(i, state.exact(i) + self.rates[i] * after);
            }
        } else if !carried.is_empty() {
            let pieces = (after.high.abs() / self.stride * f64::from(CHECKS)).ceil().max(1.0);
            let half = after * (0.5 / pieces);
            for k in 0..pieces as u32 {
                let middle = self.from.exact_time() + half * f64::from(2 * k + 1);
                for (place, weight) in POINTS {
                    let there = self.barely_moving();
                    rates.evaluate(middle + half * place, &there)?;
                    for &i in &carried {
                        state.set(i, state.exact(i) + half * weight * rates.rate(i));
                    }
                }
            }
        }
        (state.time, state.time_carry) = (time.high, time.low);
        Ok(state)
    }

    /// The numbers at rest, except for one small velocity, since friction has no value at rest.
    fn barely_moving(&self) -> Vec<DoubleDouble> {
        let mut numbers: Vec<DoubleDouble> =
            (0..self.from.values.len()).map(|i| self.from.exact(i)).collect();
        numbers[self.degrees] = numbers[self.degrees] + DoubleDouble::from(self.size);
        numbers
    }
}

/// Tests a state; `stride` is the length of a typical step.
pub(super) fn of(
    system: &System,
    rates: &mut ExactRates,
    parameters: &[f64],
    state: &State,
    stride: f64,
) -> Result<Sticking, MotionError> {
    let n = system.degrees();
    if state.form == Form::Variables || n > MOST || n == 0 {
        return Ok(Sticking::Unknown);
    }
    let mut still = state.clone();
    for i in n..2 * n {
        still.set(i, DoubleDouble::ZERO);
    }
    if state.form == Form::Momentum {
        // the momenta that belong to zero velocity
        let resting = State { form: Form::Velocity, ..still.clone() };
        let Ok(found) = system.convert(&resting, Form::Momentum, parameters) else {
            return Ok(Sticking::Unknown);
        };
        still = found;
    }
    let moved = |i: usize| (state.exact(i) - still.exact(i)).high.abs();
    let fastest = (n..2 * n).map(moved).fold(0.0, f64::max);
    let mut asked = Asked { system, rates, parameters, still, n, size: 1.0 };
    // the strength of the forces, sampled in one direction
    let mut some = vec![0.0; n];
    some[0] = 1.0;
    asked.size = if fastest > 0.0 { fastest } else { 1e-9 };
    let Some(pull) = asked.accelerations(&some)? else { return Ok(Sticking::Unknown) };
    let strength = pull.iter().fold(0.0_f64, |m, a| m.max(a.high.abs()));
    if strength == 0.0 || fastest > SLOW * strength * stride {
        return Ok(Sticking::Unknown);
    }
    asked.size = TRIAL * strength * stride;
    let Some(margin) = asked.margin()? else { return Ok(Sticking::Unknown) };
    if margin < 0.0 {
        return asked.carried(&some, stride);
    }
    if fastest > NOTHING * strength * stride {
        return Ok(Sticking::Unknown);
    }
    if !asked.has_friction()? {
        return Ok(Sticking::Unknown);
    }
    let Some((_, accelerations)) = asked.direction()? else { return Ok(Sticking::Unknown) };
    let mut toward = vec![DoubleDouble::ZERO; state.values.len()];
    toward[n..2 * n].copy_from_slice(&accelerations);
    Ok(Sticking::SetsOut(asked.still, toward))
}

/// Takes a first step from rest, for a motion that no collocation step starts.
pub(super) fn set_out(
    system: &System,
    rates: &mut ExactRates,
    parameters: &[f64],
    still: &State,
    (stride, limit): (f64, f64),
) -> Result<Option<(Still, State)>, MotionError> {
    let n = system.degrees();
    let size = TRIAL * stride;
    let mut asked = Asked { system, rates: &mut *rates, parameters, still: still.clone(), n, size };
    if !asked.has_friction()? {
        return Ok(None);
    }
    let onset = asked.onset(stride)?;
    let Some(state) = asked.first_step(FIRST * stride)? else { return Ok(None) };
    let none = vec![DoubleDouble::ZERO; still.values.len()];
    let (from, length) = (still.clone(), stride.abs());
    let mut still = Still::new(from, none, (n, size, length));
    let state = still.begin(rates, (onset, state), limit)?;
    Ok(Some((still, state)))
}

/// A state at rest whose small velocities are tested.
struct Asked<'a> {
    system: &'a System,
    rates: &'a mut ExactRates,
    parameters: &'a [f64],
    still: State,
    n: usize,
    /// The size of these velocities.
    size: f64,
}

impl Asked<'_> {
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
    fn accelerations(
        &mut self,
        direction: &[f64],
    ) -> Result<Option<Vec<DoubleDouble>>, MotionError> {
        let state = self.moving(direction);
        let numbers: Vec<DoubleDouble> = (0..state.values.len()).map(|i| state.exact(i)).collect();
        match self.rates.evaluate(state.exact_time(), &numbers) {
            Ok(()) => {}
            Err(fault) if fault.kind == MotionErrorKind::Cancelled => return Err(fault),
            Err(_) => return Ok(None),
        }
        let found: Vec<DoubleDouble> = (self.n..2 * self.n).map(|i| self.rates.rate(i)).collect();
        Ok(found.iter().all(|x| x.is_finite()).then_some(found))
    }

    /// The largest gain of kinetic energy of a small velocity in any direction, relative to its
    /// size; if it is negative the motion stays at rest.
    fn margin(&mut self) -> Result<Option<f64>, MotionError> {
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
    fn has_friction(&mut self) -> Result<bool, MotionError> {
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
    fn direction(&mut self) -> Result<Option<(Vec<f64>, Vec<DoubleDouble>)>, MotionError> {
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
    fn follows(&mut self, time: f64, reach: f64, intervals: u32) -> Result<bool, MotionError> {
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
    fn end_of_rest(&mut self, time: f64, end: f64, step: f64) -> Result<Option<f64>, MotionError> {
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
                let top = self.top((first.0, last.0))?;
                moves = (top.1 >= 0.0).then_some(top);
                rests = first;
            }
            let Some(moves) = moves else { continue };
            let (mut rests, mut moves) = (rests.0, moves.0);
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

    /// The greatest margin between two times, by golden-section search.
    fn top(&mut self, (mut a, mut b): (f64, f64)) -> Result<(f64, f64), MotionError> {
        let mut best = (a, f64::NEG_INFINITY);
        for _ in 0..SECTIONS {
            let (c, d) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
            let (at_c, at_d) = (self.margin_at(c)?, self.margin_at(d)?);
            let (time, margin) = if at_c > at_d { (c, at_c) } else { (d, at_d) };
            if margin > best.1 {
                best = (time, margin);
            }
            (a, b) = if at_c > at_d { (a, d) } else { (c, b) };
        }
        Ok(best)
    }

    /// The margin at a time; where it has no value, the motion stays at rest.
    fn margin_at(&mut self, time: f64) -> Result<f64, MotionError> {
        (self.still.time, self.still.time_carry) = (time, 0.0);
        Ok(self.margin()?.unwrap_or(f64::NEG_INFINITY))
    }

    /// The state a short time after rest has ended: the velocities follow from the accelerations
    /// halfway.
    fn first_step(&mut self, first: f64) -> Result<Option<State>, MotionError> {
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
    fn onset(&mut self, stride: f64) -> Result<Option<Onset>, MotionError> {
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
        Onset::new(self.rates, from, self.n, step, &found)
    }

    /// The end of a motion: the rates of the auxiliary numbers and integrals, at rest or in the
    /// limit of zero velocities.
    fn carried(mut self, some: &[f64], stride: f64) -> Result<Sticking, MotionError> {
        let moving = self.system.moving();
        let len = self.still.values.len();
        let size = self.size;
        let mut rates = vec![DoubleDouble::ZERO; len];
        let mut samples = [vec![DoubleDouble::ZERO; len], vec![DoubleDouble::ZERO; len]];
        for sample in &mut samples {
            if self.accelerations(some)?.is_none() {
                return Ok(Sticking::Unknown);
            }
            for (i, x) in sample.iter_mut().enumerate() {
                *x = self.rates.rate(i);
            }
            self.size *= SMALLER;
        }
        for i in moving..len {
            let (before, after) = (samples[0][i], samples[1][i]);
            // a rate that goes to zero with the velocity is zero
            let falls = after.high.abs() <= 2.0 * SMALLER * before.high.abs();
            rates[i] = if falls { DoubleDouble::ZERO } else { after };
        }
        let known = rates.iter().all(|x| x.is_finite());
        let (from, degrees) = (self.still, self.n);
        let still = Still::new(from, rates, (degrees, size, stride));
        Ok(if known { Sticking::Stays(still) } else { Sticking::Unknown })
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
