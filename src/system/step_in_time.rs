//! A step in time of the momenta of L, as where a mass changes at an instant: p = ∂L/∂q̇ keeps its value, since no force acts at the
//! instant itself, and the velocities are those that belong to it afterwards.
//!
//! In: a state at an instant. Out: the states just before and after it, where p as a function of the velocities jumps there. Never
//! here: how the instant is located.
//!
//! ∂L/∂q̇ is continuous along an extremal where L jumps in time (the condition of Weierstrass and Erdmann; I. M. Gelfand, S. V. Fomin,
//! Calculus of Variations, §15).

use super::discontinuities::CompiledEvent;
use super::{Form, MotionError, State, System};
use crate::model::EventAction;
use crate::num::DoubleDouble;

/// How far beside the instant the law is evaluated, as parts of the time: as close as the instant is known.
const BESIDE: [f64; 3] = [1e-27, 1e-20, 1e-14];

/// A momentum that changes by more than so many times that part of it may jump.
const JUMPS: f64 = 1e4;

/// A momentum jumps that changes by at least half as much in an interval shorter by this factor, in which a steep slope changes it by that much
/// less.
const NEARER: f64 = 64.0;

impl System {
    /// Whether a momentum, as a function of the velocities, jumps at some times.
    pub fn momenta_jump(&self) -> bool {
        self.shared.momenta_jump
    }

    /// Whether motions keep the momenta at these times. Impulses and releases of constraints, which may happen at the same
    /// instant, are not told apart from the step.
    pub fn keeps_momenta_at_steps(&self) -> bool {
        let discontinuities = self.discontinuities();
        let acts = |event: &CompiledEvent| {
            matches!(event.action, EventAction::Release(_) | EventAction::Impulse(_))
        };
        self.momenta_jump()
            && discontinuities.impulses.is_empty()
            && !discontinuities.events.iter().any(acts)
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
        if !self.keeps_momenta_at_steps() || state.form != Form::Velocity {
            return Ok(None);
        }
        let scale = state.time.abs().max(step.abs());
        for part in BESIDE {
            let beside = |part: f64, sign: f64| {
                let mut beside = state.clone();
                let apart = (sign * part * scale).copysign(sign * step);
                beside.set_time(state.exact_time() + DoubleDouble::from(apart));
                beside
            };
            let momenta_at = |state: &State| self.convert(state, Form::Momentum, parameters);
            let (before, after) = (beside(part, -1.0), beside(part, 1.0));
            let momenta = momenta_at(&before)?;
            let changes = self.changes(&momenta, &momenta_at(&after)?);
            if changes.iter().all(|&[change, size]| change <= JUMPS * part * size) {
                continue;
            }
            let [near, ahead] = [-1.0, 1.0].map(|sign| beside(part / NEARER, sign));
            let nearer = self.changes(&momenta_at(&near)?, &momenta_at(&ahead)?);
            let jumps = |([change, size], [nearer, _]): (&[f64; 2], &[f64; 2])| {
                *change > JUMPS * part * size && *nearer >= 0.5 * change
            };
            if changes.iter().zip(&nearer).any(jumps) {
                let after = self.with_momenta(&after, &momenta, parameters)?;
                let after = self.with_work((&before, after), parameters)?;
                return Ok(Some((before, after)));
            }
        }
        Ok(None)
    }

    /// The state a moment later, so short that its cube is nothing, by the mean of the rates at both ends (K. Heun's method).
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
        let moment = DoubleDouble::from(moment);
        let first: Vec<DoubleDouble> = (0..numbers.len()).map(|i| rates.rate(i)).collect();
        let ahead = |slope: &dyn Fn(usize) -> DoubleDouble| -> Vec<DoubleDouble> {
            numbers.iter().enumerate().map(|(i, &x)| x + slope(i) * moment).collect()
        };
        let time = state.exact_time() + moment;
        rates.evaluate(time, &ahead(&|i| first[i]))?;
        let mut later = state.clone();
        let means = ahead(&|i| (first[i] + rates.rate(i)) * 0.5);
        means.into_iter().enumerate().for_each(|(i, x)| later.set(i, x));
        later.set_time(time);
        Ok(later)
    }

    /// By how much the momenta of two states differ, and how large they are.
    fn changes(&self, one: &State, other: &State) -> Vec<[f64; 2]> {
        let n = self.degrees();
        let change = |i: usize| {
            let size = one.values[i].abs().max(other.values[i].abs());
            [(one.exact(i) - other.exact(i)).high.abs(), size]
        };
        (n..2 * n).map(change).collect()
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
