//! Rest under dry friction in more than one direction: −μ v/|v| has no value at v = 0, where it is
//! any vector up to its strength.
//!
//! In: a state where all velocities have come to zero. Out: whether the motion stays there, and
//! until when, or the rates with which it sets out. It stays where a small velocity in whatever
//! direction loses energy; that is asked of many directions, and of those in which everything else
//! pulls. Where the forces depend on the time it is asked again and again.

use crate::num::{DoubleDouble, Real};
use crate::system::{ExactRates, Form, MotionError, MotionErrorKind, State, System};

/// Velocities below this part of what a typical step changes them by count as zero where friction
/// takes away even more.
const SLOW: f64 = 1e-9;

/// Below this part they are nothing but rounding.
const NOTHING: f64 = 1e-15;

/// The velocity with which directions are tried, in the same measure.
const TRIAL: f64 = 1e-12;

/// How much smaller the second look at what is carried along is.
const SMALLER: f64 = 1e-3;

/// More degrees of freedom are not tried in all directions.
const MOST: usize = 12;

/// How many directions there are between any two velocities.
const BETWEEN: usize = 16;

/// Rounds in which the direction of a motion that sets out is found.
const ROUNDS: usize = 200;

/// How often a motion at rest is looked at within a typical step.
const LOOKS: u32 = 32;

/// A motion sets out by a first step of this part of a typical one: what it neglects is of the
/// third order.
const FIRST: f64 = 1e-8;

/// What turns round with the velocity is friction where it is this part of all that acts.
const FRICTION: f64 = 0.01;

/// Halvings of the time in which rest ends; each golden section finds less than one.
const HALVINGS: u32 = 60;
const SECTIONS: u32 = 40;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Gauss's five points on [−1, 1], and their weights.
const POINTS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// What comes of rest.
pub(super) enum Sticking {
    /// It stays so.
    Stays(Still),
    /// It sets out from this state, with these rates.
    SetsOut(State, Vec<DoubleDouble>),
    /// Not at rest, or not to be said.
    Unknown,
}

/// A motion at rest.
#[derive(Debug)]
pub(super) struct Still {
    /// The state at the beginning of the last step.
    from: State,
    /// The rates of all numbers at rest; zero but for what is carried along.
    rates: Vec<DoubleDouble>,
    degrees: usize,
    /// The size of the velocities with which directions are tried.
    size: f64,
    /// The length of a typical step of the motion before.
    stride: f64,
    over: bool,
}

impl Still {
    /// Whether it has set out at the end of the last step.
    pub(super) fn is_over(&self) -> bool {
        self.over
    }

    /// Rests on from a state up to a time, or until it sets out; gives the state there.
    pub(super) fn go_on(
        &mut self,
        system: &System,
        rates: &mut ExactRates,
        parameters: &[f64],
        (from, limit): (&State, f64),
    ) -> Result<State, MotionError> {
        self.from = from.clone();
        let (n, time) = (system.degrees(), from.time);
        let mut end = limit;
        if rates.depends_on_time() {
            let (step, size) = ((self.stride / f64::from(LOOKS)).copysign(limit - time), self.size);
            let still = from.clone();
            let mut asked = Asked { system, rates: &mut *rates, parameters, still, n, size };
            let reach = (limit - time).abs().min(self.stride);
            end = if reach < self.stride { limit } else { time + self.stride.copysign(step) };
            if let Some(breaks) = asked.end_of_rest(time, end, step)? {
                let until = self.at(rates, DoubleDouble::from(breaks))?;
                let still = until.clone();
                let mut asked = Asked { system, rates, parameters, still, n, size };
                let first = (FIRST * self.stride).copysign(step);
                self.over = true;
                return Ok(asked.first_step(first)?.unwrap_or(until));
            }
        }
        self.at(rates, DoubleDouble::written(end))
    }

    /// The state at a time within the last step.
    pub(super) fn at(
        &self,
        rates: &mut ExactRates,
        time: DoubleDouble,
    ) -> Result<State, MotionError> {
        let mut state = self.from.clone();
        let after = time - self.from.exact_time();
        let carried: Vec<usize> =
            (0..self.rates.len()).filter(|&i| self.rates[i] != DoubleDouble::ZERO).collect();
        if !rates.depends_on_time() {
            for &i in &carried {
                state.set(i, state.exact(i) + self.rates[i] * after);
            }
        } else if !carried.is_empty() {
            let pieces = (after.high.abs() / self.stride * f64::from(LOOKS)).ceil().max(1.0);
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

    /// The numbers at rest, but for one velocity: at rest friction has no value.
    fn barely_moving(&self) -> Vec<DoubleDouble> {
        let mut numbers: Vec<DoubleDouble> =
            (0..self.from.values.len()).map(|i| self.from.exact(i)).collect();
        numbers[self.degrees] = numbers[self.degrees] + DoubleDouble::from(self.size);
        numbers
    }
}

/// Asks what comes of a state; `stride` is the length of a typical step.
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
        // the momenta that belong to no velocity
        let resting = State { form: Form::Velocity, ..still.clone() };
        let Ok(found) = system.convert(&resting, Form::Momentum, parameters) else {
            return Ok(Sticking::Unknown);
        };
        still = found;
    }
    let moved = |i: usize| (state.exact(i) - still.exact(i)).high.abs();
    let fastest = (n..2 * n).map(moved).fold(0.0, f64::max);
    let mut asked = Asked { system, rates, parameters, still, n, size: 1.0 };
    // the strength of what acts there, asked at some direction
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

/// A first step out of rest, for a motion that no collocation leads out of it.
pub(super) fn set_out(
    system: &System,
    rates: &mut ExactRates,
    parameters: &[f64],
    still: &State,
    stride: f64,
) -> Result<Option<(Still, State)>, MotionError> {
    let n = system.degrees();
    let size = TRIAL * stride;
    let mut asked = Asked { system, rates, parameters, still: still.clone(), n, size };
    if !asked.has_friction()? {
        return Ok(None);
    }
    let Some(state) = asked.first_step(FIRST * stride)? else { return Ok(None) };
    let rates = vec![DoubleDouble::ZERO; still.values.len()];
    let (from, stride) = (still.clone(), stride.abs());
    Ok(Some((Still { from, rates, degrees: n, size, stride, over: true }, state)))
}

struct Asked<'a> {
    system: &'a System,
    rates: &'a mut ExactRates,
    parameters: &'a [f64],
    still: State,
    n: usize,
    size: f64,
}

impl Asked<'_> {
    /// The still state with a small velocity in a direction.
    fn moving(&self, direction: &[f64]) -> State {
        let length = direction
            .iter()
            .map(|x| DoubleDouble::product(*x, *x))
            .fold(DoubleDouble::ZERO, |a, b| a + b);
        let length = Real::sqrt(length);
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

    /// The most that a small velocity in whatever direction gains of kinetic energy, for its size;
    /// below zero the motion stays at rest.
    fn margin(&mut self) -> Result<Option<f64>, MotionError> {
        let mut some = vec![0.0; self.n];
        some[0] = 1.0;
        // friction is odd in the direction: the mean is everything else
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

    /// Whether accelerations turn round with the velocity, by a part that counts.
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

    /// The direction in which a motion out of rest is accelerated, and how.
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
            // with a part of the old one, as friction pulls strongly aside
            let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
            let kept = strength / length;
            direction = found.iter().zip(&direction).map(|(a, d)| a.high + kept * d).collect();
        }
        Ok(None)
    }

    /// When rest ends between two times, if it does, looked at in such steps.
    fn end_of_rest(&mut self, time: f64, end: f64, step: f64) -> Result<Option<f64>, MotionError> {
        let mut looks = [(time, f64::NEG_INFINITY); 3];
        let count = ((end - time) / step).ceil();
        for k in 0..=count as u32 {
            let at = if f64::from(k) >= count { end } else { time + step * f64::from(k) };
            let margin = self.margin_at(at)?;
            let [_, b, c] = looks;
            looks = [b, c, (at, margin)];
            let [first, middle, last] = looks;
            let mut rests = middle;
            let mut moves = (last.1 >= 0.0).then_some(last);
            if moves.is_none() && k > 1 && middle.1 > first.1 && middle.1 > last.1 {
                // it may be passed between two looks
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

    /// The greatest margin between two times, by golden sections.
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

    /// The margin at a time; where it has no value rest is not left.
    fn margin_at(&mut self, time: f64) -> Result<f64, MotionError> {
        (self.still.time, self.still.time_carry) = (time, 0.0);
        Ok(self.margin()?.unwrap_or(f64::NEG_INFINITY))
    }

    /// The state a short time after rest has ended: the velocities are those of the accelerations
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

    /// The end of a motion: the rates of what is carried along, at rest or as velocities go to
    /// zero.
    fn carried(mut self, some: &[f64], stride: f64) -> Result<Sticking, MotionError> {
        let moving = self.system.moving();
        let len = self.still.values.len();
        let size = self.size;
        let mut rates = vec![DoubleDouble::ZERO; len];
        let mut looks = [vec![DoubleDouble::ZERO; len], vec![DoubleDouble::ZERO; len]];
        for look in &mut looks {
            if self.accelerations(some)?.is_none() {
                return Ok(Sticking::Unknown);
            }
            for (i, x) in look.iter_mut().enumerate() {
                *x = self.rates.rate(i);
            }
            self.size *= SMALLER;
        }
        for i in moving..len {
            let (before, after) = (looks[0][i], looks[1][i]);
            // what goes to zero with the velocity is zero
            let falls = after.high.abs() <= 2.0 * SMALLER * before.high.abs();
            rates[i] = if falls { DoubleDouble::ZERO } else { after };
        }
        let known = rates.iter().all(|x| x.is_finite());
        let (from, degrees) = (self.still, self.n);
        let still = Still { from, rates, degrees, size, stride, over: false };
        Ok(if known { Sticking::Stays(still) } else { Sticking::Unknown })
    }

    /// The momenta of a velocity in a direction, without those of rest; they point where a force
    /// does that accelerates so.
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

    /// How a small velocity in a direction gains kinetic energy, up to a factor.
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

/// Along every velocity, and around the circle of any two.
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
