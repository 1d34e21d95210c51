//! The determinant of the mass matrix M = ∂p/∂q̇ at a state, by differences of the momenta.
//!
//! In: a state with velocities. Out: det M. Never here: what follows where it vanishes.

use nalgebra::DMatrix;

use super::{Form, State, System};
use crate::num::DoubleDouble;

/// The differences of a velocity, as a part of its size: momenta have twice the digits of an `f64`.
const DIFFERENCE: f64 = 1e-8;

impl System {
    /// det ∂p/∂q̇ at a state with velocities; `None` if it has none, or no momenta near by.
    pub fn mass_determinant(&self, state: &State, parameters: &[f64]) -> Option<f64> {
        let n = self.degrees();
        if state.form != Form::Velocity || n == 0 {
            return None;
        }
        let fastest = (n..2 * n).map(|i| state.values[i].abs()).fold(0.0, f64::max);
        let mut columns = Vec::with_capacity(n * n);
        for i in n..2 * n {
            let difference = DIFFERENCE * state.values[i].abs().max(DIFFERENCE * fastest);
            let momenta = |by: f64| {
                let mut moved = state.clone();
                moved.set(i, state.exact(i) + DoubleDouble::from(by));
                self.convert(&moved, Form::Momentum, parameters).ok()
            };
            let (after, before) = (momenta(difference)?, momenta(-difference)?);
            let slope = |k: usize| ((after.exact(k) - before.exact(k)) / (2.0 * difference)).high;
            columns.extend((n..2 * n).map(slope));
        }
        Some(DMatrix::from_vec(n, n, columns).determinant()).filter(|x| x.is_finite())
    }
}
