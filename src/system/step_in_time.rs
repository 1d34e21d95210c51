//! A step in time of the momenta of L, as where a mass changes at an instant: p = ∂L/∂q̇ keeps its value, since no force acts at the
//! instant itself, and the velocities are those that belong to it afterwards.
//!
//! In: a state at an instant. Out: the states just before and after it, where p as a function of the velocities jumps there. Never
//! here: which instants these are.
//!
//! ∂L/∂q̇ is continuous along an extremal where L jumps in time (the condition of Weierstrass and Erdmann; I. M. Gelfand, S. V. Fomin,
//! Calculus of Variations, §15).

use super::{Form, MotionError, State, System};
use crate::num::DoubleDouble;

impl System {
    /// A time, or where it is exactly that of a step in time of the law, one so shortly after it that nothing but the law differs.
    ///
    /// # Errors
    /// Returns an error if the functions that have a step there have no value.
    pub fn after_step_in_time(
        &self,
        time: DoubleDouble,
        parameters: &[f64],
    ) -> Result<DoubleDouble, MotionError> {
        self.steps_in_time(parameters).map_or(Ok(time), |mut steps| steps.after(time))
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
        let Some(mut steps) = self.steps_in_time(parameters) else { return Ok(None) };
        let Some([before_it, after_it]) = steps.beside(state.exact_time(), step)? else {
            return Ok(None);
        };
        let mut before = state.clone();
        before.set_time(before_it);
        let before = self.convert(&before, self.form(), parameters)?;
        let mut after = before.clone();
        after.set_time(after_it);
        if self.discontinuities().momenta_jump {
            let momenta = self.convert(&before, Form::Momentum, parameters)?;
            after = self.with_momenta(&after, &momenta, parameters)?;
        }
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

    /// The second state with the work that has changed the energy of the first one to its own.
    ///
    /// # Errors
    /// Returns an error if they have no energy.
    pub(crate) fn with_work(
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
