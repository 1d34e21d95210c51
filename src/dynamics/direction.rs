//! The direction of a motion in its phase space, also where constraints hold it.
//!
//! In: a state. Out: its rates of change, in the variables of the space, and whether it moves at all. Never here: steps.

use nalgebra::{DMatrix, DVector};

use super::phase_space::{PhaseSpace, VectorField};
use crate::system::{Form, MotionError, Rates, State, System};

/// A motion slower than this, relative to its size and to its linear rates, is at rest.
const AT_REST: f64 = 1e-13;

/// The rates of change of the variables of a phase space.
pub(super) struct Direction {
    space: PhaseSpace,
    source: Source,
}

/// Where rates come from.
enum Source {
    /// The variables are independent.
    Free(VectorField),
    /// Constraints hold them. Rates are those of (q, q̇), carried to (q, p) as a displacement of the state, which they are
    /// where the momenta do not depend on the time.
    Constrained { rates: Rates, carrying: System },
}

impl Direction {
    pub(super) fn new(space: &PhaseSpace) -> Direction {
        let source = if space.is_constrained() {
            let mut rates = space.system().native_rates();
            rates.set_parameters(space.parameters());
            Source::Constrained { rates, carrying: space.system().with_tangents(1) }
        } else {
            Source::Free(space.vector_field())
        };
        Direction { space: space.clone(), source }
    }

    /// The rates at a state of the space.
    pub(super) fn at(&mut self, state: &State) -> Result<DVector<f64>, MotionError> {
        let (space, n) = (&self.space, self.space.dimension());
        match &mut self.source {
            Source::Free(field) => {
                field.evaluate(state.time, space.variables(state))?;
                Ok(field.rate())
            }
            Source::Constrained { rates, carrying } => {
                let (system, parameters) = (space.system(), space.parameters());
                let native = system.convert(state, Form::Velocity, parameters)?;
                let mut out = vec![0.0; system.state_len()];
                rates.evaluate(native.time, &native.values, &mut out)?;
                let mut full = carrying.extended(&native, system);
                let first = carrying.tangent_place(0);
                full.values[first..first + n].copy_from_slice(&out[..n]);
                let full = carrying.convert(&full, space.form(), parameters)?;
                Ok(DVector::from_column_slice(&full.values[first..first + n]))
            }
        }
    }

    /// Whether the motion through a state moves: faster than rounding would explain, by the linear rates or, under
    /// constraints, over this length of time.
    pub(super) fn moves(&mut self, state: &State, length: f64) -> Result<bool, MotionError> {
        let size = DVector::from_column_slice(self.space.variables(state)).norm().max(1.0);
        let speed = self.at(state)?.norm();
        let rates = match &self.source {
            Source::Free(field) => field.derivative().norm(),
            Source::Constrained { .. } => 1.0 / length,
        };
        Ok(speed > AT_REST * size * rates)
    }
}

/// An orthonormal basis of the range of a matrix, whose rank is known.
pub(super) fn basis_of_range(matrix: &DMatrix<f64>, rank: usize) -> DMatrix<f64> {
    matrix.clone().col_piv_qr().q().columns(0, rank).into_owned()
}
