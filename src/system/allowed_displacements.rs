//! The displacements of a state that its constraints allow.
//!
//! A state displaced by (δq, δp) at a fixed time still satisfies f(q, t) = 0 and A q̇ + A₀ = 0 if
//!
//! ```text
//! ∂f/∂q δq = 0,   A δq̇ + B δq = 0,   B = ∂(A q̇ + A₀)/∂q,   δp = M δq̇ + (∂p/∂q) δq.
//! ```
//!
//! Any other displacement is moved onto the nearest of these, coordinates by the least amount in the metric of M, momenta
//! along the reactions: δq + M⁻¹(∂f/∂q)ᵀμ, δp + Aᵀν. That is the derivative of the projection of states
//! (`projection`), and a constraint on the velocities leaves δq as it is, holonomic or not.
//!
//! In: a state (q, q̇) on the constraints. Out: the matrix P of this projection in (q, p), and its rank. Never here: how
//! displacements are carried along.

use std::sync::Arc;

use super::constraint_programs::VALUES;
use super::error::MotionError;
use super::projection::ProjectionError;
use super::solve::Factored;
use super::tangent::TangentLayout;
use super::value::Evaluator;
use super::{Form, State, System};
use crate::num::DoubleDouble;

/// The projection of displacements onto those that the constraints allow.
#[derive(Clone, Debug)]
pub struct AllowedDisplacements {
    /// P, row by row: the displacement (δq, δp) allowed that is nearest to each unit displacement is a column.
    pub matrix: Vec<f64>,
    /// The dimension of the allowed displacements: the rank of P.
    pub dimension: usize,
}

impl System {
    /// The displacements (δq, δp) of a state that the enforced constraints allow; all of them where there are none.
    ///
    /// # Errors
    /// Returns an error if the state has no velocities, or where the constraints or the mass matrix are singular.
    pub fn allowed_displacements(
        &self,
        state: &State,
        parameters: &[f64],
    ) -> Result<AllowedDisplacements, MotionError> {
        let n = self.degrees();
        let (Some(constrained), Some(conditions)) =
            (self.constrained(), self.conditions(parameters, state))
        else {
            let size = self.moving();
            let matrix = (0..size * size).map(|k| f64::from(u8::from(k / size == k % size)));
            return Ok(AllowedDisplacements { matrix: matrix.collect(), dimension: size });
        };
        let native = self.convert(state, Form::Velocity, parameters)?;
        let numbers: Vec<DoubleDouble> = (0..2 * n).map(|i| native.exact(i)).collect();
        let singular = || self.lost(ProjectionError::Singular, state);

        let enforced = &self.active_set().enforced;
        let rows: Vec<usize> = (0..self.constraints()).filter(|&k| enforced[k]).collect();
        let holonomic: Vec<usize> =
            rows.iter().copied().filter(|&k| constrained.programs.holonomic[k]).collect();
        let slopes = self.slopes_of_constraints(&native, parameters, &rows)?;
        let momenta = self.slopes_of_momenta(&native, &numbers, parameters)?;
        let mass = |i: usize, j: usize| momenta.output(n + i * n + j);
        let by_position = |i: usize, j: usize| momenta.output(n + n * n + j * n + i);

        let matrix_with = |rows: &[usize]| {
            let mut factored = Factored::new(n + rows.len());
            let regular = factored.factor(|i, j| match (i < n, j < n) {
                (true, true) => mass(i, j),
                (true, false) => -conditions.entry(rows[j - n], i),
                (false, true) => conditions.entry(rows[i - n], j),
                (false, false) => DoubleDouble::ZERO,
            });
            regular.then_some(factored)
        };
        let mut positions = matrix_with(&holonomic).ok_or_else(singular)?;
        let mut velocities = matrix_with(&rows).ok_or_else(singular)?;

        let size = 2 * n;
        let mut matrix = vec![0.0; size * size];
        for column in 0..size {
            let unit = |i: usize| if i == column { DoubleDouble::ONE } else { DoubleDouble::ZERO };
            let mut step = vec![DoubleDouble::ZERO; n + holonomic.len()];
            for (j, &k) in holonomic.iter().enumerate() {
                step[n + j] = -sum((0..n).map(|i| conditions.entry(k, i) * unit(i)));
            }
            positions.solve(&mut step);
            let moved: Vec<DoubleDouble> = (0..n).map(|i| unit(i) + step[i]).collect();
            let carried: Vec<DoubleDouble> =
                (0..n).map(|i| sum((0..n).map(|j| by_position(i, j) * moved[j]))).collect();
            let mut rates: Vec<DoubleDouble> = (0..n).map(|i| unit(n + i) - carried[i]).collect();
            rates.extend(slopes.iter().map(|row| -sum((0..n).map(|j| row[j] * moved[j]))));
            velocities.solve(&mut rates);
            for i in 0..n {
                let momentum = carried[i] + sum((0..n).map(|j| mass(i, j) * rates[j]));
                matrix[i * size + column] = moved[i].high;
                matrix[(n + i) * size + column] = momentum.high;
            }
        }
        Ok(AllowedDisplacements { matrix, dimension: size - rows.len() - holonomic.len() })
    }

    /// Whether all constraints that are enforced were written as f(q, t) = 0.
    pub fn is_holonomic(&self) -> bool {
        let enforced = &self.active_set().enforced;
        self.constrained().is_none_or(|constrained| {
            constrained.programs.holonomic.iter().zip(enforced).all(|(&own, &on)| own || !on)
        })
    }

    /// B = ∂(A q̇ + A₀)/∂q at a state (q, q̇), for these constraints.
    fn slopes_of_constraints(
        &self,
        state: &State,
        parameters: &[f64],
        rows: &[usize],
    ) -> Result<Vec<Vec<DoubleDouble>>, MotionError> {
        let n = self.degrees();
        let Some(constrained) = self.constrained() else { return Ok(Vec::new()) };
        let program = constrained.programs.values.with_tangents(n);
        let mut values: Evaluator<DoubleDouble> = Evaluator::new(Arc::clone(&program));
        values.set_parameters(&self.inputs(parameters));
        let numbers = with_units((0..n).map(|i| state.exact(i)).collect(), n, n);
        values
            .evaluate(state.exact_time(), &numbers)
            .map_err(|why| self.singular(&program, why, state.time, &state.values))?;
        let outputs = constrained.programs.values.outputs();
        // of each constraint A and what stands behind it, once more along each coordinate
        let slope = |k: usize, entry: usize, along: usize| {
            values.output(outputs * (1 + along) + k * (n + VALUES) + entry)
        };
        let along = |k: usize, j: usize| {
            slope(k, n, j) + sum((0..n).map(|i| slope(k, i, j) * state.exact(n + i)))
        };
        Ok(rows.iter().map(|&k| (0..n).map(|j| along(k, j)).collect()).collect())
    }

    /// The momenta, M, and the derivatives of the momenta along each coordinate.
    fn slopes_of_momenta(
        &self,
        state: &State,
        numbers: &[DoubleDouble],
        parameters: &[f64],
    ) -> Result<Evaluator<DoubleDouble>, MotionError> {
        let n = self.degrees();
        let moving = self.moving();
        let layout = TangentLayout { count: n, moving, first: moving, outputs: n, last: 0 };
        let program = self.shared.legendre.tangent(layout);
        let mut values = Evaluator::new(Arc::clone(&program));
        values.set_parameters(&self.inputs(parameters));
        values
            .evaluate(state.exact_time(), &with_units(numbers.to_vec(), n, 2 * n))
            .map_err(|why| self.singular(&program, why, state.time, &state.values))?;
        Ok(values)
    }
}

/// Numbers with the first `count` unit vectors of this length behind them.
fn with_units(mut numbers: Vec<DoubleDouble>, count: usize, length: usize) -> Vec<DoubleDouble> {
    for vector in 0..count {
        numbers.extend(
            (0..length).map(|i| if i == vector { DoubleDouble::ONE } else { DoubleDouble::ZERO }),
        );
    }
    numbers
}

fn sum(terms: impl Iterator<Item = DoubleDouble>) -> DoubleDouble {
    terms.fold(DoubleDouble::ZERO, |sum, x| sum + x)
}
