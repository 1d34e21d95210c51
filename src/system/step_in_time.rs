//! A step in time of the momenta of L, as where a mass changes at an instant: p = ∂L/∂q̇ keeps its value, since no force acts at the
//! instant itself, and the velocities are those that belong to it afterwards.
//!
//! In: a state at an instant. Out: the states just before and after it, where p as a function of the velocities jumps there. Never
//! here: how the instant is located.
//!
//! ∂L/∂q̇ is continuous along an extremal where L jumps in time (the condition of Weierstrass and Erdmann; I. M. Gelfand, S. V. Fomin,
//! Calculus of Variations, §15).

use super::value::Evaluator;
use super::{Form, MotionError, State, System};
use crate::num::DoubleDouble;

/// How far beside an instant a step is searched for, as parts of the time; it is then located to the first of these.
const BESIDE: [f64; 4] = [1e-30, 1e-27, 1e-20, 1e-14];

/// At the time zero, of which parts are nothing: numbers so small that nothing changes in so long a time in any unit.
const BESIDE_ZERO: [f64; 4] = [1e-200, 1e-150, 1e-100, 1e-60];

/// How far beside an instant numbers of 53 bits are on its sides, as parts of the time: for a law that rounds little, and at most.
const BESIDE_IN_F64: [f64; 2] = [4.0 * f64::EPSILON, 1e-12];

impl System {
    /// Whether a momentum, as a function of the velocities, jumps where a function of the time is zero. Motions keep the momenta there.
    pub fn momenta_jump(&self) -> bool {
        self.discontinuities().steps.outputs() > 0
    }

    /// The times just before a step in time of the law and just after it, if a time is that of one, to which a step of this size of the
    /// motion has led.
    ///
    /// # Errors
    /// Returns an error if the functions that have a step there have no value.
    pub fn beside_step(
        &self,
        time: DoubleDouble,
        step: f64,
        parameters: &[f64],
    ) -> Result<Option<[DoubleDouble; 2]>, MotionError> {
        if !self.momenta_jump() {
            return Ok(None);
        }
        let length = time.high.abs().max(step.abs());
        let is_zero = length <= BESIDE_ZERO[1];
        let (parts, scale) = if is_zero { (BESIDE_ZERO, 1.0) } else { (BESIDE, length) };
        for part in parts {
            let beside = beside(time, part * scale);
            let Some((k, sign)) = self.change_between(beside, parameters)? else { continue };
            if is_zero || part == parts[0] {
                return Ok(Some(beside));
            }
            let mut nearest = parts[0] * scale;
            let is_before = |time| Ok(are_opposite(self.steps_at(time, parameters)?[k], -sign));
            let located = halved(beside, nearest, is_before)?;
            // beside rounding
            while nearest < part * scale {
                let beside = self::beside(located, nearest);
                if self.change_between(beside, parameters)?.is_some() {
                    return Ok(Some(beside));
                }
                nearest *= 10.0;
            }
            return Ok(Some(beside));
        }
        Ok(None)
    }

    /// A function that has another sign at the second time than at the first, with the sign at the first.
    fn change_between(
        &self,
        [before, after]: [DoubleDouble; 2],
        parameters: &[f64],
    ) -> Result<Option<(usize, f64)>, MotionError> {
        let (before, after) =
            (self.steps_at(before, parameters)?, self.steps_at(after, parameters)?);
        let mut pairs = before.iter().zip(&after);
        let changed = pairs.position(|(&before, &after)| are_opposite(before, after));
        Ok(changed.map(|k| (k, before[k].signum())))
    }

    /// Times just before a step in time of the law and just after it, as [`System::beside_step`], at which a law that is evaluated in
    /// `f64` is that before and that after.
    ///
    /// # Errors
    /// Returns an error if the functions that have a step there have no value.
    pub fn beside_step_in_f64(
        &self,
        time: DoubleDouble,
        step: f64,
        parameters: &[f64],
    ) -> Result<Option<[f64; 2]>, MotionError> {
        let Some([before, after]) = self.beside_step(time, step, parameters)? else {
            return Ok(None);
        };
        let signs = [self.steps_at(before, parameters)?, self.steps_at(after, parameters)?];
        let length = time.high.abs().max(step.abs());
        let [nearest, farthest] = BESIDE_IN_F64;
        let mut part = nearest;
        loop {
            let beside = [before.high - part * length, after.high + part * length];
            let mut agrees = true;
            for (time, signs) in beside.into_iter().zip(&signs) {
                let found: Vec<f64> = self.steps_in(time, parameters)?;
                agrees &= !found.iter().zip(signs).any(|(&a, &b)| a == 0.0 || are_opposite(a, b));
            }
            if agrees || part > farthest {
                return Ok(Some(beside));
            }
            part *= 2.0;
        }
    }

    /// Whether the law at a time is that just after a step in time, between these times just before it and just after it.
    ///
    /// # Errors
    /// Returns an error if the functions that have a step there have no value.
    pub fn is_behind_step(
        &self,
        time: DoubleDouble,
        [before, after]: [DoubleDouble; 2],
        parameters: &[f64],
    ) -> Result<bool, MotionError> {
        let Some((k, sign)) = self.change_between([before, after], parameters)? else {
            return Ok(false);
        };
        Ok(are_opposite(self.steps_at(time, parameters)?[k], sign))
    }

    /// A time, or where it is exactly that of a step in time of the law, one so shortly after it that nothing but the law differs.
    ///
    /// # Errors
    /// Returns an error if the functions that have a step there have no value.
    pub fn after_step_in_time(
        &self,
        time: DoubleDouble,
        parameters: &[f64],
    ) -> Result<DoubleDouble, MotionError> {
        if !self.momenta_jump() || !self.steps_at(time, parameters)?.contains(&0.0) {
            return Ok(time);
        }
        Ok(self.beside_step(time, 0.0, parameters)?.map_or(time, |[_, after]| after))
    }

    /// The values of the functions at whose zeros the law has steps in time.
    fn steps_at(&self, time: DoubleDouble, parameters: &[f64]) -> Result<Vec<f64>, MotionError> {
        let program = &self.discontinuities().steps;
        let mut functions: Evaluator<DoubleDouble> = Evaluator::new(program.clone());
        functions.set_parameters(&self.inputs(parameters));
        let found = functions.evaluate(time, &[]);
        found.map_err(|why| self.singular(program, why, time.high, &[]))?;
        Ok(functions.outputs().map(|x| x.high).collect())
    }

    /// The same in `f64`.
    fn steps_in(&self, time: f64, parameters: &[f64]) -> Result<Vec<f64>, MotionError> {
        let program = &self.discontinuities().steps;
        let mut functions: Evaluator<f64> = Evaluator::new(program.clone());
        functions.set_parameters(&self.inputs(parameters));
        let found = functions.evaluate(time, &[]);
        found.map_err(|why| self.singular(program, why, time, &[]))?;
        Ok(functions.outputs().collect())
    }

    /// The states just before a step in time and after it, with the same momenta, in the native form; `None` if there is none at the
    /// time of the state, to which a step of this size has led.
    ///
    /// # Errors
    /// Returns an error if no velocities belong to the momenta.
    pub fn across_step_in_time(
        &self,
        state: &State,
        parameters: &[f64],
        step: f64,
    ) -> Result<Option<(State, State)>, MotionError> {
        let Some([before_it, after_it]) = self.beside_step(state.exact_time(), step, parameters)?
        else {
            return Ok(None);
        };
        let mut before = state.clone();
        before.set_time(before_it);
        let before = self.convert(&before, self.form(), parameters)?;
        let mut after = before.clone();
        after.set_time(after_it);
        let momenta = self.convert(&before, Form::Momentum, parameters)?;
        let after = self.with_momenta(&after, &momenta, parameters)?;
        let after = self.with_work((&before, after), parameters)?;
        Ok(Some((before, after)))
    }

    /// The state with the velocities that belong to these momenta, and to the constraints.
    fn with_momenta(
        &self,
        state: &State,
        momenta: &State,
        parameters: &[f64],
    ) -> Result<State, MotionError> {
        let n = self.degrees();
        if self.constraints() > 0 {
            let target: Vec<DoubleDouble> = (n..2 * n).map(|i| momenta.exact(i)).collect();
            return Ok(self.impulse_outcome(state, &target, parameters)?.0);
        }
        let mut canonical = momenta.clone();
        canonical.set_time(state.exact_time());
        self.convert_near(&canonical, state, parameters)
    }

    /// With the work that the change of the law does.
    fn with_work(
        &self,
        (before, mut after): (&State, State),
        parameters: &[f64],
    ) -> Result<State, MotionError> {
        if let Some(place) = self.work_place() {
            let work = self.energy_of(&after, parameters)? - self.energy_of(before, parameters)?;
            after.set(place, before.exact(place) + work);
        }
        self.check_finite(&after)?;
        Ok(after)
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
    is_before: impl Fn(DoubleDouble) -> Result<bool, MotionError>,
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
