//! The energy of a state.
//!
//! In: a state in the native form. Out: its energy, or that it has none. Never here: what it exchanges with what acts on it.

use super::error::{MotionError, MotionErrorKind};
use super::{State, System};
use crate::num::DoubleDouble;

impl System {
    /// The energy of a state in the system's native form.
    pub(super) fn energy_of(
        &self,
        state: &State,
        parameters: &[f64],
    ) -> Result<DoubleDouble, MotionError> {
        Ok(self.evaluated(&self.shared.energy, state, parameters)?.output(0))
    }

    /// Returns an error if a state in the system's native form has no finite energy, that is where
    /// its Lagrangian or Hamiltonian has no value, though its derivatives may have one.
    pub(crate) fn check_energy(
        &self,
        state: &State,
        parameters: &[f64],
    ) -> Result<(), MotionError> {
        if self.energy_of(state, parameters)?.is_finite() {
            return Ok(());
        }
        let kind = MotionErrorKind::NotFinite("the energy".to_owned());
        Err(self.error(kind, state.time, &state.values))
    }
}
