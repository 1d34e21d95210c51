//! The values of the Casimirs at a state, and the gradient of the energy in any variables.
//!
//! In: a phase space, a state of it. Out: numbers. Never here: how these functions are compiled (`levels`).

use nalgebra::DVector;

use super::error::DynamicsError;
use super::flow_direction::FlowDirection;
use super::phase_space::PhaseSpace;
use crate::system::State;

impl PhaseSpace {
    /// The values of the Casimirs at a state; none where variables are canonical.
    pub(super) fn casimirs(&self, state: &State) -> Result<Vec<f64>, DynamicsError> {
        let Some(levels) = self.levels() else { return Ok(Vec::new()) };
        let all = levels.at(state, self.parameters())?;
        Ok(all.iter().skip(usize::from(levels.has_energy())).map(|level| level.value).collect())
    }

    /// ∇H at a state: −𝕁 ż in canonical variables.
    pub(super) fn energy_gradient(&self, state: &State) -> Result<DVector<f64>, DynamicsError> {
        if let Some(levels) = self.levels().filter(|levels| levels.has_energy()) {
            return Ok(levels.at(state, self.parameters())?.swap_remove(0).gradient);
        }
        let rate = FlowDirection::new(self).at(state)?;
        let half = rate.len() / 2;
        let slope = |i: usize| if i < half { -rate[half + i] } else { rate[i - half] };
        Ok(DVector::from_fn(rate.len(), |i, _| slope(i)))
    }
}
