//! The branch of velocities that a motion is on, where several velocities give the same momenta.
//!
//! In: states (q, q̇). Out: whether they lie on the branch of the first. Two branches meet where
//! det ∂²L/∂q̇² vanishes, and its sign differs between them. Never here: finding velocities from
//! momenta.

use std::sync::Arc;

use super::value::Evaluator;
use super::{Form, State, System};

/// The branch of one state. It owns its registers.
#[derive(Clone, Debug)]
pub struct Branch {
    momenta: Evaluator<f64>,
    degrees: usize,
    numbers: Vec<f64>,
    positive: bool,
}

impl System {
    /// Returns the branch of a state (q, q̇), or `None` if each momentum has only one velocity or
    /// the branch cannot be determined.
    pub fn branch(&self, state: &State, parameters: &[f64]) -> Option<Branch> {
        if !self.has_branches() || state.form != Form::Velocity {
            return None;
        }
        let mut momenta = Evaluator::new(Arc::clone(&self.shared.legendre));
        momenta.set_parameters(&self.inputs(parameters));
        let degrees = self.degrees();
        let numbers = vec![0.0; 2 * degrees];
        let mut branch = Branch { momenta, degrees, numbers, positive: true };
        let determinant = branch.determinant(state)?;
        branch.positive = determinant > 0.0;
        (determinant != 0.0).then_some(branch)
    }
}

impl Branch {
    /// Whether a state lies on the branch. Always true for a state given by momenta.
    pub fn holds(&mut self, state: &State) -> bool {
        state.form != Form::Velocity
            || self.determinant(state).is_none_or(|x| x == 0.0 || (x > 0.0) == self.positive)
    }

    /// Returns det ∂²L/∂q̇², by elimination.
    fn determinant(&mut self, state: &State) -> Option<f64> {
        let n = self.degrees;
        self.numbers.copy_from_slice(&state.values[..2 * n]);
        self.momenta.evaluate(state.time, &self.numbers).ok()?;
        let entry = |i: usize, j: usize| self.momenta.output(n + i * n + j);
        let matrix = nalgebra::DMatrix::from_fn(n, n, entry);
        Some(matrix.determinant()).filter(|x| x.is_finite())
    }
}
