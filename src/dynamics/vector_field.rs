//! The rates of change of the variables of a phase space, and their derivatives.
//!
//! In: a time and variables. Out: f(z) and ∂f/∂z. Never here: motions along it.

use nalgebra::{DMatrix, DVector};

use super::phase_space::PhaseSpace;
use crate::system::{MotionError, Rates};

/// The rates of change f(z) of the variables z of a phase space, and their derivatives ∂f/∂z.
#[derive(Clone, Debug)]
pub struct VectorField {
    rates: Rates,
    dimension: usize,
    first: usize,
    numbers: Vec<f64>,
    out: Vec<f64>,
}

impl PhaseSpace {
    /// The rates of change of its variables, with their derivatives.
    pub fn vector_field(&self) -> VectorField {
        VectorField::new(self)
    }
}

impl VectorField {
    fn new(space: &PhaseSpace) -> VectorField {
        let dimension = space.dimension();
        let system = space.system().with_tangents(dimension);
        let mut rates = system.canonical_rates();
        rates.set_parameters(space.parameters());
        let mut numbers = vec![0.0; system.state_len()];
        for i in 0..dimension {
            numbers[system.tangent_place(i) + i] = 1.0;
        }
        let out = vec![0.0; system.state_len()];
        VectorField { rates, dimension, first: system.tangent_place(0), numbers, out }
    }

    /// Evaluates at a time and at these variables.
    ///
    /// # Errors
    /// Returns an error if there are no rates, as at a singular mass matrix.
    pub fn evaluate(&mut self, time: f64, variables: &[f64]) -> Result<(), MotionError> {
        self.numbers[..self.dimension].copy_from_slice(&variables[..self.dimension]);
        self.rates.evaluate(time, &self.numbers, &mut self.out)
    }

    /// f(z).
    pub fn rate(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.out[..self.dimension])
    }

    /// ∂f/∂z.
    pub fn derivative(&self) -> DMatrix<f64> {
        let n = self.dimension;
        DMatrix::from_column_slice(n, n, &self.out[self.first..self.first + n * n])
    }
}
