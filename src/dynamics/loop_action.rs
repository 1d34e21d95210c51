//! ∮ p dq of a periodic orbit.
//!
//! In: a state on it, its period. Out: the integral, step by step; `None` where the variables are not canonical. Never here:
//! how the orbit was found.

use nalgebra::DMatrix;

use super::carrier::Carrier;
use super::error::DynamicsError;
use super::flow_direction::FlowDirection;
use super::orbit::Orbit;
use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Settings, Stepping};
use crate::num::gauss;
use crate::system::{Form, State};

impl Orbit {
    /// The same with its action, where the variables are canonical.
    ///
    /// # Errors
    /// Returns an error if the motion cannot be followed, or is cancelled.
    pub(super) fn with_action(
        self,
        space: &PhaseSpace,
        method: (&'static Method, Settings),
    ) -> Result<Orbit, DynamicsError> {
        let action = loop_action(space, method, &self.state, self.period)?;
        Ok(Orbit { action, ..self })
    }
}

/// The integral from a state over a period.
fn loop_action(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    start: &State,
    period: f64,
) -> Result<Option<f64>, DynamicsError> {
    if space.form() != Form::Momentum {
        return Ok(None);
    }
    let mut carrier = Carrier::new(space, method, settings, 0)?;
    carrier.start(start, &DMatrix::zeros(space.dimension(), 0))?;
    let rule = gauss(if method.stepping == Stepping::Fixed { 3 } else { 16 });
    let mut direction = FlowDirection::new(space);
    let (half, until) = (space.dimension() / 2, start.time + period);
    let mut sum = 0.0;
    while carrier.time() < until {
        carrier.step(until)?;
        let (begin, end) = carrier.interval();
        let end = end.min(until);
        for &(part, weight) in &rule {
            let now = begin + part * (end - begin);
            let (state, _) = carrier.at(now)?;
            let rate = direction.at(&state)?;
            let z = space.variables(&state);
            let power: f64 = (0..half).map(|i| z[half + i] * rate[i]).sum();
            sum += weight * (end - begin) * power;
        }
    }
    Ok(Some(sum))
}
