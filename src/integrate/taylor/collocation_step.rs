//! A short step away from a point where no series can be built: from the branch point of a
//! fractional power, the tip of a cone, a surface where 0/0 stands for a sign.
//!
//! On one side, the rates are continuous there, though not smooth, or they grow without bound but
//! more slowly than 1/t. Gauss's collocation with three stages evaluates them only inside the step,
//! never at its ends, and the step is so small that taking a part of it in two agrees with the
//! whole to the last digit. The step is also tried with another time variable, t = h s^k, in which
//! a fractional power of t becomes an integer one.
//!
//! In: a state, the longest step wanted. Out: the step taken and the state after it, or nothing if
//! the rates have no limit. Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations
//! II, IV.5.

use crate::num::{Analytic, DoubleDouble, math};
use crate::system::{ExactRates, MotionError, MotionErrorKind, State};

/// The part of the wanted step that is tried first, and the factor after each failure.
const FIRST: f64 = 1.0 / 64.0;
const AGAIN: f64 = 0.125;

/// The number of trials before the rates count as having no limit.
const TRIALS: u32 = 40;

/// A step this short relative to the wanted one shows that the latter was no measure; a smaller one
/// is taken.
const SHORT: f64 = 1e-10;

/// The tolerated difference between two ways of taking a step, relative to the size of each number.
const AGREEMENT: f64 = 1e-18;

/// The difference tolerated where the first part of a step is taken by itself.
const MISSED: f64 = 1e-15;

/// The maximal number of iterations of the stages, and the movement tolerated then.
const ROUNDS: u32 = 60;
const SETTLED: f64 = 1e-26;

/// A movement that no longer shrinks is rounding where it is below this: a force that depends on the
/// small difference of large numbers has fewer digits than its velocity.
const ROUNDING: f64 = 1e-20;

/// The part of a step at which it is divided in two, in its time variable.
const PART: f64 = 0.125;

/// The greatest power of the time with which an integral is taken to grow.
const MOST_GROWTH: f64 = 8.0;

/// The time variables, by their power k: those of square, cube and fourth roots, and of both of the
/// first two.
const POWERS: [i32; 5] = [1, 2, 3, 4, 6];

/// If a step is at least this part of the wanted one, no other time variable is tried.
const LONG: f64 = 1e-6;

/// The three stages: their nodes, weights and coefficients.
struct CollocationScheme {
    at: [DoubleDouble; 3],
    weight: [DoubleDouble; 3],
    from: [[DoubleDouble; 3]; 3],
}

impl CollocationScheme {
    fn new() -> CollocationScheme {
        let part = |n: f64, d: f64| DoubleDouble::from(n) / d;
        let root = Analytic::sqrt(DoubleDouble::from(15.0));
        let half = part(1.0, 2.0);
        CollocationScheme {
            at: [half - root / 10.0, half, half + root / 10.0],
            weight: [part(5.0, 18.0), part(4.0, 9.0), part(5.0, 18.0)],
            from: [
                [part(5.0, 36.0), part(2.0, 9.0) - root / 15.0, part(5.0, 36.0) - root / 30.0],
                [part(5.0, 36.0) + root / 24.0, part(2.0, 9.0), part(5.0, 36.0) - root / 24.0],
                [part(5.0, 36.0) + root / 30.0, part(2.0, 9.0) + root / 15.0, part(5.0, 36.0)],
            ],
        }
    }
}

/// A part of a step, from `begin` to `end` in its time variable.
struct SubStep {
    step: DoubleDouble,
    begin: f64,
    end: f64,
}

/// Takes such steps and evaluates states inside them.
pub(super) struct CollocationStep {
    scheme: CollocationScheme,
    /// The number of dynamical variables of a state; the rest is integrated along with them.
    moving: usize,
    /// The power k of the time variable of the last step.
    power: i32,
    stages: [Vec<DoubleDouble>; 3],
    numbers: Vec<DoubleDouble>,
    end: Vec<DoubleDouble>,
    /// The numbers where the last step was divided in two, and at its end.
    middle: Vec<DoubleDouble>,
    two: Vec<DoubleDouble>,
}

impl std::fmt::Debug for CollocationStep {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("CollocationStep")
    }
}

impl CollocationStep {
    pub(super) fn new(len: usize, moving: usize) -> CollocationStep {
        let blank = || vec![DoubleDouble::ZERO; len];
        CollocationStep {
            scheme: CollocationScheme::new(),
            moving,
            power: 1,
            stages: [blank(), blank(), blank()],
            numbers: blank(),
            end: blank(),
            middle: blank(),
            two: blank(),
        }
    }

    /// Steps from a state by a part of `wanted`, but at least `least`, into `out`. Returns the step
    /// taken, if one was possible. Rates that are undefined at the state itself may be given by
    /// `toward`.
    pub(super) fn cross(
        &mut self,
        rates: &mut ExactRates,
        from: &State,
        (wanted, least): (f64, f64),
        toward: Option<&[DoubleDouble]>,
        out: &mut State,
    ) -> Result<Option<f64>, MotionError> {
        let mut longest: Option<(f64, i32)> = None;
        // powers of time are meaningful only from a point that was reached
        let powers = if least > 0.0 { &POWERS[..1] } else { &POWERS[..] };
        for &power in powers {
            let Some(step) = self.longest(rates, from, (wanted, least), toward, power)? else {
                continue;
            };
            if longest.is_none_or(|(best, _)| step.abs() > best.abs()) {
                longest = Some((step, power));
            }
            if step.abs() >= LONG * wanted.abs() {
                break;
            }
        }
        let Some((step, power)) = longest else { return Ok(None) };
        self.power = power;
        self.inside(rates, from, DoubleDouble::from(step), toward, out)?;
        Ok(Some(step))
    }

    /// Whether the last step ends elsewhere if a first part of its time is taken by itself.
    pub(super) fn misses(
        &mut self,
        rates: &mut ExactRates,
        from: &State,
        step: f64,
        part: f64,
    ) -> Result<bool, MotionError> {
        let (start, step) = (numbers_of(from), DoubleDouble::from(step));
        if !self.take_two(rates, from, step, None)? {
            return Ok(true);
        }
        let two = self.two.clone();
        let part = math::powf(part, 1.0 / f64::from(self.power));
        let mut numbers = start.clone();
        for (begin, end) in [(0.0, part), (part, PART), (PART, 1.0)] {
            let piece = SubStep { step, begin, end };
            if !self.take(rates, from.exact_time(), &numbers, &piece, None)? {
                return Ok(true);
            }
            numbers.clone_from(&self.end);
        }
        let is_reached = |i: usize| {
            let size = start[i].high.abs().max(two[i].high.abs());
            is_reached(numbers[i] - two[i], size)
        };
        Ok(!(0..self.moving).all(is_reached))
    }

    /// The longest step possible with one time variable.
    fn longest(
        &mut self,
        rates: &mut ExactRates,
        from: &State,
        (wanted, least): (f64, f64),
        toward: Option<&[DoubleDouble]>,
        power: i32,
    ) -> Result<Option<f64>, MotionError> {
        self.power = power;
        let (mut step, mut wanted) = (wanted * FIRST, wanted);
        let mut found = None;
        for _ in 0..TRIALS {
            if step.abs() <= 1e-30 * from.time.abs() || step.abs() < least.max(1e-290) {
                break;
            }
            let jumps = least > 0.0 && !self.begins_inside(rates, from, step);
            if jumps || !self.agree(rates, from, step, wanted, toward)? {
                step *= AGAIN;
                continue;
            }
            found = Some(step);
            if step.abs() >= SHORT * wanted.abs() {
                break;
            }
            wanted *= FIRST;
        }
        Ok(found)
    }

    /// The state a time `after` one from which a step was taken.
    pub(super) fn inside(
        &mut self,
        rates: &mut ExactRates,
        from: &State,
        after: DoubleDouble,
        toward: Option<&[DoubleDouble]>,
        out: &mut State,
    ) -> Result<(), MotionError> {
        self.take_two(rates, from, after, toward)?;
        self.put(from, after, out);
        Ok(())
    }

    fn put(&self, from: &State, after: DoubleDouble, out: &mut State) {
        out.copy_from(from);
        for (i, &x) in self.two.iter().enumerate() {
            out.set(i, x);
        }
        let time = from.exact_time() + after;
        (out.time, out.time_carry) = (time.high, time.low);
    }

    /// Whether a step as a whole and the same step in two parts end at the same point; the latter
    /// is kept.
    fn agree(
        &mut self,
        rates: &mut ExactRates,
        from: &State,
        step: f64,
        wanted: f64,
        toward: Option<&[DoubleDouble]>,
    ) -> Result<bool, MotionError> {
        let start = numbers_of(from);
        let whole = SubStep { step: DoubleDouble::from(step), begin: 0.0, end: 1.0 };
        if !self.take(rates, from.exact_time(), &start, &whole, toward)? {
            return Ok(false);
        }
        let whole = self.end.clone();
        if !self.take_two(rates, from, DoubleDouble::from(step), toward)? {
            return Ok(false);
        }
        Ok((0..whole.len()).all(|i| {
            let change = (self.two[i] - start[i]).high / step * wanted;
            let mut size = start[i].high.abs().max(self.two[i].high.abs()).max(change.abs());
            if i >= self.moving {
                size = size.max(self.integral_after(&start, i, wanted / step));
            }
            is_same(self.two[i] - whole[i], size)
        }))
    }

    /// How far an integral will have grown so many steps on, by the power of the time with which it
    /// grew in the step: the work of friction on what begins to move is next to nothing at first, and
    /// its error acts on nothing.
    fn integral_after(&self, start: &[DoubleDouble], i: usize, steps: f64) -> f64 {
        let whole = (self.two[i] - start[i]).high.abs();
        let part = (self.middle[i] - start[i]).high.abs();
        let time = f64::from(self.power) * math::ln(PART);
        let power = math::ln(part / whole) / time;
        if power > 1.0 { whole * math::powf(steps, power.min(MOST_GROWTH)) } else { 0.0 }
    }

    /// Whether the rates at the beginning of a step change no velocity by more than the fastest in
    /// it. Otherwise the stages would step over something there.
    fn begins_inside(&self, rates: &mut ExactRates, from: &State, step: f64) -> bool {
        let start = numbers_of(from);
        if rates.evaluate(from.exact_time(), &start).is_err() {
            return true;
        }
        let (moving, half) = (self.moving, self.moving / 2);
        let fastest = start[half..moving].iter().fold(0.0_f64, |m, v| m.max(v.high.abs()));
        let changes = (half..moving).map(|i| (rates.rate(i).high * step).abs());
        let largest = changes.filter(|x| x.is_finite()).fold(0.0, f64::max);
        fastest == 0.0 || largest <= fastest
    }

    fn take_two(
        &mut self,
        rates: &mut ExactRates,
        from: &State,
        step: DoubleDouble,
        toward: Option<&[DoubleDouble]>,
    ) -> Result<bool, MotionError> {
        let time = from.exact_time();
        let first = SubStep { step, begin: 0.0, end: PART };
        if !self.take(rates, time, &numbers_of(from), &first, toward)? {
            return Ok(false);
        }
        let middle = self.end.clone();
        let second = SubStep { step, begin: PART, end: 1.0 };
        let done = self.take(rates, time, &middle, &second, None)?;
        self.middle = middle;
        self.two.clone_from(&self.end);
        Ok(done)
    }

    /// Takes one piece of a step that begins at a time, from the numbers at its beginning, and
    /// writes those at its end into `end`. Returns false if the stages do not converge.
    fn take(
        &mut self,
        rates: &mut ExactRates,
        time: DoubleDouble,
        start: &[DoubleDouble],
        piece: &SubStep,
        toward: Option<&[DoubleDouble]>,
    ) -> Result<bool, MotionError> {
        let SubStep { step, begin, end } = *piece;
        let width = end - begin;
        let power =
            |s: DoubleDouble, n: i32| (0..n).fold(DoubleDouble::ONE, |product, _| product * s);
        let places = self.scheme.at.map(|c| DoubleDouble::from(begin) + c * width);
        let times = places.map(|s| time + step * power(s, self.power));
        // dt/ds, times the length of the piece
        let lengths =
            places.map(|s| step * power(s, self.power - 1) * f64::from(self.power) * width);
        let outcome =
            rates.evaluate(time + step * power(DoubleDouble::from(begin), self.power), start);
        let known = outcome.is_ok();
        for i in 0..start.len() {
            let rate = if known { rates.rate(i) } else { DoubleDouble::ZERO };
            let rate = toward.map_or(rate, |toward| toward[i]);
            let rate = if rate.is_finite() { rate } else { DoubleDouble::ZERO };
            for stage in &mut self.stages {
                stage[i] = rate;
            }
        }
        let from = self.scheme.from;
        let (mut settled, mut before) = (false, f64::INFINITY);
        for round in 0..ROUNDS {
            let mut moved = 0.0_f64;
            for s in 0..3 {
                for (i, &x) in start.iter().enumerate() {
                    let part = |j: usize| from[s][j] * lengths[j] * self.stages[j][i];
                    self.numbers[i] = x + (0..3).fold(DoubleDouble::ZERO, |sum, j| sum + part(j));
                }
                match rates.evaluate(times[s], &self.numbers) {
                    Ok(()) => {}
                    Err(error) if error.kind == MotionErrorKind::Cancelled => return Err(error),
                    Err(_) => return Ok(false),
                }
                for i in 0..start.len() {
                    let new = rates.rate(i);
                    let change = (new - self.stages[s][i]).high.abs();
                    let size = start[i].high.abs().max((lengths[s] * new).high.abs());
                    let part = (change * lengths[s].high).abs() / size;
                    if change > 0.0 || change.is_nan() {
                        moved = if part.is_nan() { f64::INFINITY } else { moved.max(part) };
                    }
                    self.stages[s][i] = new;
                }
            }
            if moved == f64::INFINITY && round > 2 {
                return Ok(false);
            }
            if moved <= SETTLED || (moved <= ROUNDING && moved >= before) {
                settled = true;
                break;
            }
            before = moved;
        }
        for (i, &x) in start.iter().enumerate() {
            let part = |s: usize| self.scheme.weight[s] * lengths[s] * self.stages[s][i];
            self.end[i] = x + (0..3).fold(DoubleDouble::ZERO, |sum, s| sum + part(s));
        }
        Ok(settled && self.end.iter().all(|x| x.is_finite()))
    }
}

fn numbers_of(state: &State) -> Vec<DoubleDouble> {
    (0..state.values.len()).map(|i| state.exact(i)).collect()
}

/// Whether two ways of taking a step differ by nothing that counts beside a number of this size.
fn is_same(difference: DoubleDouble, size: f64) -> bool {
    difference.high.abs() <= AGREEMENT * size
}

/// Whether a step ends where it does with a first part of it taken by itself, beside a number of this size.
fn is_reached(difference: DoubleDouble, size: f64) -> bool {
    difference.high.abs() <= MISSED * size
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_misses_nothing_that_moves_its_end_by_1e_15_of_each_number() {
        for size in [1e-30, 1.0, 1e12] {
            for (part, reached) in
                [(0.9e-15, true), (-0.9e-15, true), (1.1e-15, false), (-1.1e-15, false)]
            {
                let off = DoubleDouble::from(part * size);
                assert_eq!(is_reached(off, size), reached, "{part:e} of {size:e}");
            }
        }
    }

    #[test]
    fn two_ways_of_taking_a_step_agree_to_1e_18_of_each_number() {
        for size in [1e-30, 1.0, 1e12] {
            for (part, same) in
                [(0.9e-18, true), (-0.9e-18, true), (1.1e-18, false), (-1.1e-18, false)]
            {
                assert_eq!(
                    is_same(DoubleDouble::from(part * size), size),
                    same,
                    "{part:e} of {size:e}"
                );
            }
        }
    }
}
