//! A step in time of the momenta of L, as where a mass changes at an instant: p = ∂L/∂q̇ keeps its value, since no force acts at the
//! instant itself, and the velocities are those that belong to it afterwards.
//!
//! In: a state at an instant. Out: the states just before and after it, where p as a function of the velocities jumps there. Never
//! here: how the instant is located.
//!
//! ∂L/∂q̇ is continuous along an extremal where L jumps in time (the condition of Weierstrass and Erdmann; I. M. Gelfand, S. V. Fomin,
//! Calculus of Variations, §15).

use super::{Form, MotionError, State, System};
use crate::num::DoubleDouble;

/// How far beside the instant the law is evaluated, as parts of the time: as close as the instant is known.
const BESIDE: [f64; 3] = [1e-27, 1e-20, 1e-14];

/// A momentum that changes by more than so many times that part of it jumps.
const JUMPS: f64 = 1e4;

impl System {
    /// Whether a momentum, as a function of the velocities, jumps at some times.
    pub fn has_steps_in_time(&self) -> bool {
        self.shared.momenta_jump
    }

    /// The states just before an instant and after it, if the momenta jump there at unchanged velocities. `step` is the one that has
    /// led there.
    ///
    /// # Errors
    /// Returns an error if no velocities belong to the momenta.
    pub fn across_step_in_time(
        &self,
        state: &State,
        parameters: &[f64],
        step: f64,
    ) -> Result<Option<(State, State)>, MotionError> {
        if !self.has_steps_in_time() || state.form != Form::Velocity {
            return Ok(None);
        }
        let scale = state.time.abs().max(step.abs());
        for part in BESIDE {
            let beside = |sign: f64| {
                let mut beside = state.clone();
                let apart = (sign * part * scale).copysign(sign * step);
                beside.set_time(state.exact_time() + DoubleDouble::from(apart));
                beside
            };
            let (before, after) = (beside(-1.0), beside(1.0));
            let momenta = self.convert(&before, Form::Momentum, parameters)?;
            if self.differ(&momenta, &self.convert(&after, Form::Momentum, parameters)?, part) {
                let after = self.with_momenta(&after, &momenta, parameters)?;
                let after = self.with_work((&before, after), parameters)?;
                return Ok(Some((before, after)));
            }
        }
        Ok(None)
    }

    /// The state a moment later, so short that its square is nothing, by the rates of now.
    ///
    /// # Errors
    /// Returns an error if it has none.
    pub fn a_moment_later(
        &self,
        state: &State,
        parameters: &[f64],
        moment: f64,
    ) -> Result<State, MotionError> {
        let mut rates = self.exact_rates();
        rates.set_parameters(&self.inputs(parameters));
        let numbers: Vec<DoubleDouble> = (0..state.values.len()).map(|i| state.exact(i)).collect();
        rates.evaluate(state.exact_time(), &numbers)?;
        let mut later = state.clone();
        let moment = DoubleDouble::from(moment);
        for (i, &x) in numbers.iter().enumerate() {
            later.set(i, x + rates.rate(i) * moment);
        }
        later.set_time(state.exact_time() + moment);
        Ok(later)
    }

    fn differ(&self, one: &State, other: &State, part: f64) -> bool {
        let n = self.degrees();
        (n..2 * n).any(|i| {
            let size = one.values[i].abs().max(other.values[i].abs());
            (one.exact(i) - other.exact(i)).high.abs() > JUMPS * part * size
        })
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
