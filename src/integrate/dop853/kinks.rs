//! Kinks in the way of steps whose size is chosen by their error alone.
//!
//! In: an attempted step. Out: whether it passes a kink that no shorter one would pass, or the motion follows the kink. Never
//! here: where a kink lies within a step.
//!
//! A motion follows a switching surface where the law on each side leads towards it (A. F. Filippov, Differential Equations
//! with Discontinuous Righthand Sides, Kluwer 1988, §4), as it does by Taylor series.

use super::{DormandPrince, SHORTEST};
use crate::num::DoubleDouble;
use crate::system::{MotionError, MotionErrorKind, State};

/// A kink may lie within a step that is this many times as long as the shortest one: it moves nothing but by rounding,
/// whatever jumps within it.
const OVER_A_KINK: f64 = 8.0;

/// The part of a step that crosses a kink over which the law of either side is followed, to see where it leads.
const AHEAD: f64 = 1e-6;

/// A step below this part of the longest one hardly changes anything but by what jumps within it: both its ends show the law
/// beside the kink. So many of them in a row make no way, whatever the law.
const ALONG_A_KINK: f64 = 1e-8;
const MOST_CROSSINGS: u32 = 64;

impl DormandPrince {
    /// The size below which no step can continue the motion.
    pub(super) fn shortest(&self) -> f64 {
        (1e-16 * self.state.time.abs()).max(1e-290).max(SHORTEST * self.longest)
    }

    /// Whether the attempted step is as short as a step can be and a kink lies within it. No shorter one would have less
    /// of an error relative to a number that was zero before the kink. Before the first step no size is known to continue with.
    /// Returns an error if the motion follows the kink.
    pub(super) fn passes_kink(&mut self, step: f64) -> Result<bool, MotionError> {
        if self.longest == 0.0 || step.abs() > OVER_A_KINK * self.shortest() {
            return Ok(false);
        }
        if self.crosses_kink(step)? {
            self.refuse_to_slide(step)?;
            return Ok(true);
        }
        // where the law beyond the kink leads back the step may end on this side; a straight line does not
        for i in 0..self.numbers.len() {
            let change = DoubleDouble::from(step * self.slopes[0][i]);
            self.next.set(i, self.state.exact(i) + change);
        }
        if self.crosses_kink(step)? {
            self.refuse_to_slide(step)?;
        }
        Ok(false)
    }

    /// Whether the ends of the attempted step lie on two sides of a kink.
    fn crosses_kink(&mut self, step: f64) -> Result<bool, MotionError> {
        let State { time, values, .. } = &self.state;
        self.rates.evaluate(*time, values, &mut self.fresh)?;
        let before = self.rates.sides();
        self.rates.evaluate(time + step, &self.next.values, &mut self.fresh)?;
        let after = self.rates.sides();
        self.differing = after.differences(&before);
        Ok(!after.agrees(&before))
    }

    /// Counts the short steps that cross a kink. Returns an error if the motion follows it, or if there are too many without
    /// a longer one.
    pub(super) fn count_crossings(&mut self, step: f64) -> Result<(), MotionError> {
        if !self.system.has_kinks() || step.abs() > ALONG_A_KINK * self.longest {
            self.crossings = 0;
        } else if self.crosses_kink(step)? {
            self.refuse_to_slide(step)?;
            self.crossings += 1;
        }
        if self.crossings <= MOST_CROSSINGS { Ok(()) } else { Err(self.sticks()) }
    }

    /// Returns an error if the laws at both ends of a step lead towards a kink between them. That it lies between them is seen in
    /// double-double: to the rates, which round the time and the numbers, a kink may seem to lie within a step that ends before it.
    fn refuse_to_slide(&mut self, step: f64) -> Result<(), MotionError> {
        let before = self.state.clone();
        let mut after = self.next.clone();
        after.set_time(before.exact_time() + DoubleDouble::from(step));
        let lies_between = self.lies_between(&before, &after);
        let towards = [self.approach(&before, step), self.approach(&after, step)];
        let slides = |k: usize| lies_between[k] && towards.iter().all(|towards| towards[k]);
        if (0..lies_between.len()).any(slides) { Err(self.sticks()) } else { Ok(()) }
    }

    fn sticks(&self) -> MotionError {
        self.system.error(MotionErrorKind::Sticks, self.state.time, &self.state.values)
    }

    /// Whether each of the kinks that the attempted step seems to cross lies between its ends: a switch has another sign there, and
    /// a root is left by who goes on in a straight line.
    fn lies_between(&mut self, before: &State, after: &State) -> Vec<bool> {
        let on =
            |from: DoubleDouble, to: DoubleDouble| to + (to - from) * DoubleDouble::from(AHEAD);
        let ends = [numbers_of(before), numbers_of(after)];
        let beyond: Vec<DoubleDouble> =
            ends[0].iter().zip(&ends[1]).map(|(&from, &to)| on(from, to)).collect();
        let times = [before.exact_time(), after.exact_time()];
        let seen = [
            self.kinks_at(times[0], &ends[0]),
            self.kinks_at(times[1], &ends[1]),
            self.kinks_at(on(times[0], times[1]), &beyond),
        ];
        let [Some(before), Some(after), Some(beyond)] = seen else {
            return vec![false; self.differing.0.len() + self.differing.1.len()];
        };
        let is_switch = |k: usize| k < self.differing.0.len();
        let parts = |k: usize| {
            if is_switch(k) {
                before[k] * after[k].signum() < 0.0
            } else {
                beyond[k].abs() > after[k].abs()
            }
        };
        (0..before.len()).map(parts).collect()
    }

    /// Whether the law at a state leads towards each of the kinks that the attempted step crosses.
    fn approach(&mut self, from: &State, step: f64) -> Vec<bool> {
        let after = DoubleDouble::from(AHEAD * step);
        let numbers = numbers_of(from);
        let nowhere = vec![false; self.differing.0.len() + self.differing.1.len()];
        let Some(here) = self.kinks_at(from.exact_time(), &numbers) else { return nowhere };
        let rates = (0..numbers.len()).map(|i| self.exact.rate(i));
        let ahead: Vec<DoubleDouble> =
            numbers.iter().zip(rates).map(|(&x, rate)| x + rate * after).collect();
        let Some(ahead) = self.kinks_at(from.exact_time() + after, &ahead) else { return nowhere };
        here.iter().zip(ahead).map(|(here, ahead)| ahead.abs() < here.abs()).collect()
    }

    /// The values of the switches, and of the functions under roots, whose kinks the attempted step seems to cross.
    fn kinks_at(&mut self, time: DoubleDouble, numbers: &[DoubleDouble]) -> Option<Vec<f64>> {
        self.exact.evaluate(time, numbers).ok()?;
        let (switches, roots) = &self.differing;
        let switches = switches.iter().map(|&i| self.exact.switch(i));
        Some(switches.chain(roots.iter().map(|&i| self.exact.guard(i))).collect())
    }
}

fn numbers_of(state: &State) -> Vec<DoubleDouble> {
    (0..state.values.len()).map(|i| state.exact(i)).collect()
}
