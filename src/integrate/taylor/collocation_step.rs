//! A short step away from a place where no series can be built: from the edge of a fractional
//! power, the tip of a cone, a surface where 0/0 stands for a sign.
//!
//! One-sided, the rates are continuous there, only not smooth. Gauss's collocation with three
//! stages looks at them inside the step only, never at its ends, and the step is made so small
//! that a part of it taken in two agrees with the whole to the last digit.
//!
//! In: a state, the longest step wanted. Out: the step taken and the state behind it, or nothing,
//! where the rates have no limit. Source: E. Hairer, G. Wanner, Solving Ordinary Differential
//! Equations II, IV.5.

use crate::num::{DoubleDouble, Real};
use crate::system::{ExactRates, MotionError, MotionErrorKind, State};

/// The part of the wanted step that is tried first, and the part that is left after each failure.
const FIRST: f64 = 1.0 / 64.0;
const AGAIN: f64 = 0.125;

/// How often a step is made shorter before the rates count as having no limit.
const TRIALS: u32 = 40;

/// A step found this short beside the one wanted says that the wanted one was no measure: a
/// smaller one is taken.
const SHORT: f64 = 1e-10;

/// How far two ways of taking a step may differ, in parts of the size of each number.
const AGREEMENT: f64 = 1e-18;

/// Rounds in which the stages have to settle, and what they may still move then.
const ROUNDS: u32 = 60;
const SETTLED: f64 = 1e-26;

/// The part of a step after which it is taken in two.
const PART: f64 = 0.125;

/// The three stages: their places, weights, and what each takes of each.
struct Scheme {
    at: [DoubleDouble; 3],
    weight: [DoubleDouble; 3],
    from: [[DoubleDouble; 3]; 3],
}

impl Scheme {
    fn new() -> Scheme {
        let part = |n: f64, d: f64| DoubleDouble::from(n) / d;
        let root = Real::sqrt(DoubleDouble::from(15.0));
        let half = part(1.0, 2.0);
        Scheme {
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

/// Takes such steps.
pub(super) struct CollocationStep {
    scheme: Scheme,
    stages: [Vec<DoubleDouble>; 3],
    numbers: Vec<DoubleDouble>,
    end: Vec<DoubleDouble>,
    two: Vec<DoubleDouble>,
}

impl std::fmt::Debug for CollocationStep {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Bridge")
    }
}

impl CollocationStep {
    pub(super) fn new(len: usize) -> CollocationStep {
        let blank = || vec![DoubleDouble::ZERO; len];
        CollocationStep {
            scheme: Scheme::new(),
            stages: [blank(), blank(), blank()],
            numbers: blank(),
            end: blank(),
            two: blank(),
        }
    }

    /// Goes from a state a part of `wanted` and `least` at least, into `out`; the step taken, if
    /// one could be. Rates that have no value at the state itself may be given by `toward`.
    pub(super) fn cross(
        &mut self,
        rates: &mut ExactRates,
        from: &State,
        (wanted, least): (f64, f64),
        toward: Option<&[DoubleDouble]>,
        out: &mut State,
    ) -> Result<Option<f64>, MotionError> {
        let (mut step, mut wanted) = (wanted * FIRST, wanted);
        let mut found = None;
        for _ in 0..TRIALS {
            if step.abs() <= 1e-30 * from.time.abs() || step.abs() < least.max(1e-290) {
                break;
            }
            if !self.agree(rates, from, step, wanted, toward)? {
                step *= AGAIN;
                continue;
            }
            self.put(from, DoubleDouble::from(step), out);
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

    /// Whether a step as a whole and the same in two end at the same place; the second one stays.
    fn agree(
        &mut self,
        rates: &mut ExactRates,
        from: &State,
        step: f64,
        wanted: f64,
        toward: Option<&[DoubleDouble]>,
    ) -> Result<bool, MotionError> {
        let start = numbers_of(from);
        if !self.take(rates, from.exact_time(), &start, DoubleDouble::from(step), toward)? {
            return Ok(false);
        }
        let whole = self.end.clone();
        if !self.take_two(rates, from, DoubleDouble::from(step), toward)? {
            return Ok(false);
        }
        Ok((0..whole.len()).all(|i| {
            let change = (self.two[i] - start[i]).high / step * wanted;
            let size = start[i].high.abs().max(self.two[i].high.abs()).max(change.abs());
            (self.two[i] - whole[i]).high.abs() <= AGREEMENT * size
        }))
    }

    fn take_two(
        &mut self,
        rates: &mut ExactRates,
        from: &State,
        step: DoubleDouble,
        toward: Option<&[DoubleDouble]>,
    ) -> Result<bool, MotionError> {
        let (time, first) = (from.exact_time(), step * PART);
        if !self.take(rates, time, &numbers_of(from), first, toward)? {
            return Ok(false);
        }
        let middle = self.end.clone();
        let done = self.take(rates, time + first, &middle, step - first, None)?;
        self.two.clone_from(&self.end);
        Ok(done)
    }

    /// One step from a place, into `end`; false where the stages do not settle.
    fn take(
        &mut self,
        rates: &mut ExactRates,
        time: DoubleDouble,
        start: &[DoubleDouble],
        step: DoubleDouble,
        toward: Option<&[DoubleDouble]>,
    ) -> Result<bool, MotionError> {
        let outcome = rates.evaluate(time, start);
        let known = outcome.is_ok();
        for i in 0..start.len() {
            let rate = if known { rates.rate(i) } else { DoubleDouble::ZERO };
            let rate = toward.map_or(rate, |toward| toward[i]);
            let rate = if rate.is_finite() { rate } else { DoubleDouble::ZERO };
            for stage in &mut self.stages {
                stage[i] = rate;
            }
        }
        let (at, from) = (self.scheme.at, self.scheme.from);
        let mut settled = false;
        for round in 0..ROUNDS {
            let mut moved = 0.0_f64;
            for s in 0..3 {
                for (i, &x) in start.iter().enumerate() {
                    let sum = (0..3)
                        .fold(DoubleDouble::ZERO, |sum, j| sum + from[s][j] * self.stages[j][i]);
                    self.numbers[i] = x + step * sum;
                }
                match rates.evaluate(time + step * at[s], &self.numbers) {
                    Ok(()) => {}
                    Err(fault) if fault.kind == MotionErrorKind::Cancelled => return Err(fault),
                    Err(_) => return Ok(false),
                }
                for i in 0..start.len() {
                    let new = rates.rate(i);
                    let change = (new - self.stages[s][i]).high.abs();
                    let size = start[i].high.abs().max((step * new).high.abs());
                    let part = (change * step.high).abs() / size;
                    if change > 0.0 || change.is_nan() {
                        moved = if part.is_nan() { f64::INFINITY } else { moved.max(part) };
                    }
                    self.stages[s][i] = new;
                }
            }
            if moved == f64::INFINITY && round > 2 {
                return Ok(false);
            }
            if moved <= SETTLED {
                settled = true;
                break;
            }
        }
        for (i, &x) in start.iter().enumerate() {
            let sum = (0..3)
                .fold(DoubleDouble::ZERO, |sum, s| sum + self.scheme.weight[s] * self.stages[s][i]);
            self.end[i] = x + step * sum;
        }
        Ok(settled && self.end.iter().all(|x| x.is_finite()))
    }
}

fn numbers_of(state: &State) -> Vec<DoubleDouble> {
    (0..state.values.len()).map(|i| state.exact(i)).collect()
}
