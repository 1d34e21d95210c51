//! The functions of the time alone at whose zeros a law has steps in time, and the times beside such a zero.
//!
//! In: a time. Out: times so close to it that only the law differs. Never here: the states there.

use super::value::Evaluator;
use super::{MotionError, System};
use crate::num::DoubleDouble;

/// How far beside an instant a step is searched for, as parts of the time; it is then located to the first of these.
const BESIDE: [f64; 4] = [1e-30, 1e-27, 1e-20, 1e-14];

/// At the time zero, of which parts are nothing: numbers so small that nothing changes in so long a time in any unit.
const BESIDE_ZERO: [f64; 4] = [1e-200, 1e-150, 1e-100, 1e-60];

/// The instant that the date of a state stands for: one so shortly beside the time zero is 0.
pub fn instant_of(date: f64) -> f64 {
    let [.., farthest] = BESIDE_ZERO;
    if date.abs() <= farthest { 0.0 } else { date }
}

/// How far beside an instant numbers of 53 bits are on its sides, as parts of the time: for a law that rounds little, and at most.
const BESIDE_IN_F64: [f64; 2] = [4.0 * f64::EPSILON, 1e-12];

/// The steps in time of a law at some parameters. It owns its registers.
#[derive(Clone, Debug)]
pub struct StepsInTime {
    system: System,
    exact: Evaluator<DoubleDouble>,
    in_f64: Evaluator<f64>,
}

impl System {
    /// The steps in time of the law, at which its value, or velocities beside momenta that do not, jump; `None` if it has none.
    pub fn steps_in_time(&self, parameters: &[f64]) -> Option<StepsInTime> {
        let program = &self.discontinuities().steps;
        if program.outputs() == 0 {
            return None;
        }
        let inputs = self.inputs(parameters);
        let mut exact = Evaluator::new(program.clone());
        exact.set_parameters(&inputs);
        let mut in_f64 = Evaluator::new(program.clone());
        in_f64.set_parameters(&inputs);
        Some(StepsInTime { system: self.clone(), exact, in_f64 })
    }
}

impl StepsInTime {
    /// The times just before a step in time and just after it, if a time is that of one, to which a step of this size of the motion
    /// has led.
    ///
    /// # Errors
    /// Returns an error if the functions that have a step there have no value.
    pub fn beside(
        &mut self,
        time: DoubleDouble,
        step: f64,
    ) -> Result<Option<[DoubleDouble; 2]>, MotionError> {
        let length = time.high.abs().max(step.abs());
        let is_zero = length <= BESIDE_ZERO[1];
        let (parts, scale) = if is_zero { (BESIDE_ZERO, 1.0) } else { (BESIDE, length) };
        for part in parts {
            let beside = beside(time, part * scale);
            let Some((k, sign)) = self.change_between(beside)? else { continue };
            if is_zero || part == parts[0] {
                return Ok(Some(beside));
            }
            let mut nearest = parts[0] * scale;
            let is_before = |time| Ok(are_opposite(self.signs(time)?[k], -sign));
            let located = halved(beside, nearest, is_before)?;
            // beside rounding
            while nearest < part * scale {
                let beside = self::beside(located, nearest);
                if self.change_between(beside)?.is_some() {
                    return Ok(Some(beside));
                }
                nearest *= 10.0;
            }
            return Ok(Some(beside));
        }
        Ok(None)
    }

    /// Times just before a step in time and just after it, as [`StepsInTime::beside`], at which a law that is evaluated in `f64` is
    /// that before and that after.
    ///
    /// # Errors
    /// Returns an error if the functions that have a step there have no value.
    pub fn beside_in_f64(
        &mut self,
        time: DoubleDouble,
        step: f64,
    ) -> Result<Option<[f64; 2]>, MotionError> {
        let Some([before, after]) = self.beside(time, step)? else {
            return Ok(None);
        };
        let signs = [self.signs(before)?, self.signs(after)?];
        let length = time.high.abs().max(step.abs());
        let [nearest, farthest] = BESIDE_IN_F64;
        let mut part = nearest;
        loop {
            let beside = [before.high - part * length, after.high + part * length];
            let mut agrees = true;
            for (time, signs) in beside.into_iter().zip(&signs) {
                let found = self.signs_in_f64(time)?;
                agrees &= !found.iter().zip(signs).any(|(&a, &b)| a == 0.0 || are_opposite(a, b));
            }
            if agrees || part > farthest {
                return Ok(Some(beside));
            }
            part *= 2.0;
        }
    }

    /// Whether the law at a time is that just after a step, between these times just before it and just after it.
    ///
    /// # Errors
    /// Returns an error if the functions that have a step there have no value.
    pub fn is_behind(
        &mut self,
        time: DoubleDouble,
        [before, after]: [DoubleDouble; 2],
    ) -> Result<bool, MotionError> {
        let Some((k, sign)) = self.change_between([before, after])? else {
            return Ok(false);
        };
        Ok(are_opposite(self.signs(time)?[k], sign))
    }

    /// A time, or where it is exactly that of a step, one so shortly after it that nothing but the law differs.
    ///
    /// # Errors
    /// Returns an error if the functions that have a step there have no value.
    pub fn after(&mut self, time: DoubleDouble) -> Result<DoubleDouble, MotionError> {
        if !self.signs(time)?.contains(&0.0) {
            return Ok(time);
        }
        Ok(self.beside(time, 0.0)?.map_or(time, |[_, after]| after))
    }

    /// The first of the functions that has another sign at the second time than at the first.
    ///
    /// # Errors
    /// Returns an error if the functions that have a step there have no value.
    pub fn changed_between(
        &mut self,
        beside: [DoubleDouble; 2],
    ) -> Result<Option<usize>, MotionError> {
        Ok(self.change_between(beside)?.map(|(k, _)| k))
    }

    /// A function that has another sign at the second time than at the first, with the sign at the first.
    fn change_between(
        &mut self,
        [before, after]: [DoubleDouble; 2],
    ) -> Result<Option<(usize, f64)>, MotionError> {
        let (before, after) = (self.signs(before)?, self.signs(after)?);
        let mut pairs = before.iter().zip(&after);
        let changed = pairs.position(|(&before, &after)| are_opposite(before, after));
        Ok(changed.map(|k| (k, before[k].signum())))
    }

    /// Numbers with the signs of the functions.
    fn signs(&mut self, time: DoubleDouble) -> Result<Vec<f64>, MotionError> {
        let found = self.exact.evaluate(time, &[]);
        let program = &self.system.discontinuities().steps;
        found.map_err(|why| self.system.singular(program, why, time.high, &[]))?;
        Ok(self.exact.outputs().map(|x| x.high).collect())
    }

    /// The same in `f64`.
    fn signs_in_f64(&mut self, time: f64) -> Result<Vec<f64>, MotionError> {
        let found = self.in_f64.evaluate(time, &[]);
        let program = &self.system.discontinuities().steps;
        found.map_err(|why| self.system.singular(program, why, time, &[]))?;
        Ok(self.in_f64.outputs().collect())
    }
}

/// Whether one is above zero and one below, also where their product is none.
fn are_opposite(a: f64, b: f64) -> bool {
    a > 0.0 && b < 0.0 || a < 0.0 && b > 0.0
}

/// The times so long before another and after it.
fn beside(time: DoubleDouble, apart: f64) -> [DoubleDouble; 2] {
    let apart = DoubleDouble::from(apart);
    [time - apart, time + apart]
}

/// A time within `nearest` of a change between two.
fn halved(
    [mut before, mut after]: [DoubleDouble; 2],
    nearest: f64,
    mut is_before: impl FnMut(DoubleDouble) -> Result<bool, MotionError>,
) -> Result<DoubleDouble, MotionError> {
    while (after - before).high > nearest {
        let middle = before + (after - before) * 0.5;
        if is_before(middle)? {
            before = middle;
        } else {
            after = middle;
        }
    }
    Ok(before + (after - before) * 0.5)
}
