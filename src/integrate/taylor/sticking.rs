//! Rest under dry friction in more than one direction: −μ v/|v| has no value at v = 0, where it is
//! any vector up to its strength.
//!
//! In: a state where all velocities have come to zero. Out: whether the motion stays there, or the
//! rates with which it sets out. It stays where a small velocity in whatever direction loses
//! energy; that is asked of many directions, and of the one in which everything else pulls.

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

/// What comes of rest.
pub(super) enum Sticking {
    /// It stays so, in this state; with the rates of what is carried along.
    Stays(State, Vec<DoubleDouble>),
    /// It sets out from this state, with these rates.
    SetsOut(State, Vec<DoubleDouble>),
    /// Not at rest, or not to be said.
    Unknown,
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
    if state.form != Form::Velocity || n > MOST || rates.depends_on_time() || n == 0 {
        return Ok(Sticking::Unknown);
    }
    let mut still = state.clone();
    for i in n..2 * n {
        still.set(i, DoubleDouble::ZERO);
    }
    let mut asked = Asked { system, rates, parameters, still, n, size: 1.0 };
    // the strength of what acts there, asked at some direction
    let mut some = vec![0.0; n];
    some[0] = 1.0;
    let fastest = state.values[n..2 * n].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    asked.size = if fastest > 0.0 { fastest } else { 1e-9 };
    let Some(pull) = asked.accelerations(&some)? else { return Ok(Sticking::Unknown) };
    let strength = pull.iter().fold(0.0_f64, |m, a| m.max(a.high.abs()));
    if strength == 0.0 || fastest > SLOW * strength * stride {
        return Ok(Sticking::Unknown);
    }
    asked.size = TRIAL * strength * stride;
    // friction is odd in the direction: the mean is everything else
    let Some(there) = asked.accelerations(&some)? else { return Ok(Sticking::Unknown) };
    let back: Vec<f64> = some.iter().map(|x| -x).collect();
    let Some(back) = asked.accelerations(&back)? else { return Ok(Sticking::Unknown) };
    let others: Vec<f64> = there.iter().zip(&back).map(|(a, b)| (*a + *b).high * 0.5).collect();
    let mut directions = all_directions(n);
    if others.iter().any(|x| x.abs() > 1e-14 * strength) {
        directions.push(others.clone());
    }
    let mut stays = true;
    for direction in &directions {
        match asked.gains(direction)? {
            Some(gain) => stays &= gain < 0.0,
            None => return Ok(Sticking::Unknown),
        }
    }
    if stays {
        return asked.carried(&some);
    }
    if fastest > NOTHING * strength * stride {
        return Ok(Sticking::Unknown);
    }
    // it sets out in the direction in which it is then accelerated
    let mut direction = others;
    for _ in 0..ROUNDS {
        let Some(found) = asked.accelerations(&direction)? else { return Ok(Sticking::Unknown) };
        let next: Vec<f64> = found.iter().map(|x| x.high).collect();
        if next.iter().zip(&direction).map(|(a, b)| a * b).sum::<f64>() <= 0.0 {
            return Ok(Sticking::Unknown);
        }
        direction = next;
    }
    let Some(accelerations) = asked.accelerations(&direction)? else {
        return Ok(Sticking::Unknown);
    };
    let mut toward = vec![DoubleDouble::ZERO; state.values.len()];
    toward[n..2 * n].copy_from_slice(&accelerations);
    Ok(Sticking::SetsOut(asked.still, toward))
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

    /// The end of a motion: the rates of what is carried along, at rest or as velocities go to
    /// zero.
    fn carried(mut self, some: &[f64]) -> Result<Sticking, MotionError> {
        let moving = self.system.moving();
        let len = self.still.values.len();
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
        Ok(if known { Sticking::Stays(self.still, rates) } else { Sticking::Unknown })
    }

    /// How a small velocity in a direction gains kinetic energy, up to a factor.
    fn gains(&mut self, direction: &[f64]) -> Result<Option<f64>, MotionError> {
        let Some(accelerations) = self.accelerations(direction)? else { return Ok(None) };
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
