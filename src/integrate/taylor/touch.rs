//! A motion that touches rest against dry friction in more than one direction: its speed falls to zero together with its
//! acceleration, and the motion goes on the same way.
//!
//! There |v| ≈ j s²/2 a time s before and after, and friction −μ v/|v| holds the direction of so small a velocity with the
//! rate μ/|v|, so that the steps of a series shrink with s² and end nowhere; or one of them lands on the touch, where |v| has
//! a zero beside rounding. The motion itself is smooth there, and its equations are solved over all of it, as those of an
//! onset are.
//!
//! In: the series before the touch, the step it allows. Out: the motion across, or nothing where it does not touch rest.
//! Never here: what comes to rest, or begins to move.

use super::onset::{Onset, points};
use super::static_friction::RestUnderFriction;
use super::trial_velocities::TrialVelocities;
use super::{StepCourse, Taylor};
use crate::num::DoubleDouble;
use crate::system::{Form, MotionError, State};

/// A step shorter than this part of those before it may approach rest.
const SHORT: f64 = 1e-2;

/// The next attempt is at a step shorter by this factor.
const AGAIN: f64 = 0.5;

/// The speed at its least may be this part of what it is, on either side of zero.
const TOUCHES: f64 = 0.05;

/// The part of the time to the touch that is crossed in one go.
const ACROSS: f64 = 3.0;

impl Taylor {
    /// Continues across a point in which the motion touches rest, where steps as short as this lead to one. Returns false
    /// where they do not.
    pub(super) fn cross_near_touch(&mut self, step: f64, limit: f64) -> Result<bool, MotionError> {
        if step >= SHORT * self.history.stride {
            self.history.touch_tried = f64::INFINITY;
            return Ok(false);
        }
        if step >= AGAIN * self.history.touch_tried {
            return Ok(false);
        }
        self.cross_touch(step, limit)
    }

    /// The same by however long a step.
    pub(super) fn cross_touch(&mut self, step: f64, limit: f64) -> Result<bool, MotionError> {
        let n = self.system.degrees();
        let is_due = self.state.form != Form::Variables;
        let Some(time) = is_due.then(|| self.time_to_touch(n)).flatten() else { return Ok(false) };
        self.history.touch_tried = step;
        let mut still = self.state.clone();
        for i in n..2 * n {
            still.set(i, DoubleDouble::ZERO);
        }
        if still.form == Form::Momentum {
            // the momenta that belong to zero velocity
            let resting = State { form: Form::Velocity, ..still };
            let Ok(found) = self.system.convert(&resting, Form::Momentum, &self.parameters) else {
                return Ok(false);
            };
            still = found;
        }
        let size = (n..2 * n).fold(0.0_f64, |m, i| m.max(self.state.values[i].abs()));
        let (system, parameters) = (&self.system, &self.parameters);
        let rates = &mut self.rates;
        let has_friction = TrialVelocities {
            system,
            rates: &mut *rates,
            parameters,
            still: still.clone(),
            n,
            size,
        }
        .has_friction()?;
        if !has_friction {
            return Ok(false);
        }
        let scale = self.series.scale();
        let across = |part: f64| -> Vec<Vec<f64>> {
            let slope = |i: usize, x: f64| {
                let c = |k: usize| self.series.coefficient(i, k) * self.series.unit(i);
                (c(1) + 2.0 * c(2) * x + 3.0 * c(3) * x * x) / scale
            };
            let place = |point: f64| time * part * point / scale;
            points().map(|point| (n..2 * n).map(|i| slope(i, place(point))).collect()).to_vec()
        };
        let [whole, half] = [ACROSS, 0.5 * ACROSS].map(|part| (part * time, across(part)));
        let whole = Onset::new(rates, (&self.state, &still), n, whole.0, &whole.1)?;
        let half = Onset::new(rates, (&self.state, &still), n, half.0, &half.1)?;
        let (Some(whole), Some(half)) = (whole, half) else { return Ok(false) };
        if !whole.agrees(&half, n) {
            return Ok(false);
        }
        let none = vec![DoubleDouble::ZERO; self.state.values.len()];
        let from = self.state.clone();
        let mut still = RestUnderFriction::new(
            from.clone(),
            none,
            (n, self.system.moving()),
            (size, time.abs()),
        );
        self.state = still.begin(rates, (Some(whole), from), limit)?;
        self.begin = still.step_begin().high;
        self.course = StepCourse::Rest(still);
        self.history.touch_tried = f64::INFINITY;
        Ok(true)
    }

    /// The time to the point in which the speed is least, if it touches zero there.
    fn time_to_touch(&self, n: usize) -> Option<f64> {
        let c = |i: usize, k: usize| self.series.coefficient(i, k) * self.series.unit(i);
        let speed = (n..2 * n).map(|i| c(i, 0) * c(i, 0)).sum::<f64>().sqrt();
        // the speed as a parabola in the unit of the series
        let along = |k: usize| (n..2 * n).map(|i| c(i, 0) / speed * c(i, k)).sum::<f64>();
        let (slope, curve) = (along(1), along(2));
        let least = speed - 0.25 * slope * slope / curve;
        let touches = slope < 0.0 && curve > 0.0 && least.abs() <= TOUCHES * speed;
        touches.then(|| -0.5 * slope / curve * self.series.scale())
    }
}
