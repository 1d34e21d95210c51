//! A step of a motion with tangent vectors, seen in the variables of a phase space.
//!
//! In: states of a system with tangent vectors, in its native form. Out: states of the space, their vectors as columns, and
//! back. Never here: steps.

use nalgebra::{DMatrix, DVector};

use super::phase_space::PhaseSpace;
use crate::system::{Converter, MotionError, State, System};

/// The last step of a motion with tangent vectors.
pub(super) trait TangentStep {
    /// The times at which it began and ended.
    fn interval(&self) -> (f64, f64);

    /// The state and the vectors, as columns, at a time within it.
    ///
    /// # Errors
    /// Returns an error if they cannot be evaluated.
    fn at(&mut self, time: f64) -> Result<(State, DMatrix<f64>), MotionError>;

    /// One of the vectors at a time within it.
    ///
    /// # Errors
    /// Returns an error if it cannot be evaluated.
    fn vector(&mut self, vector: usize, time: f64) -> Result<DVector<f64>, MotionError>;

    /// Whether something is to happen where it ended, so that the motion cannot be started again from there.
    fn awaits_occurrence(&self) -> bool;

    /// The logarithm of the factor by which all impulses since the start have changed the volume of phase space.
    fn jump_logarithm(&self) -> f64 {
        0.0
    }
}

/// Reads and writes states with tangent vectors.
pub(super) struct TangentStates {
    system: System,
    /// That of the space, without them.
    plain: System,
    converter: Converter,
}

impl TangentStates {
    /// Those of a space, carried by its system with tangent vectors.
    pub(super) fn new(space: &PhaseSpace, system: &System) -> TangentStates {
        TangentStates {
            system: system.clone(),
            plain: space.system().clone(),
            converter: system.converter(space.form(), space.parameters()),
        }
    }

    /// A state of the space with the columns of `vectors`.
    pub(super) fn join(&self, state: &State, vectors: &DMatrix<f64>) -> State {
        let mut full = self.system.extended(state, &self.plain);
        for (j, column) in vectors.column_iter().enumerate() {
            let first = self.system.tangent_place(j);
            for (i, &x) in column.iter().enumerate() {
                full.values[first + i] = x;
            }
        }
        full
    }

    /// A state of the space and its vectors, as columns.
    ///
    /// # Errors
    /// Returns an error where the state has no momenta.
    pub(super) fn part(&mut self, full: &State) -> Result<(State, DMatrix<f64>), MotionError> {
        let full = self.converter.convert(full)?;
        let vectors = vectors_of(&self.system, &full);
        Ok((self.plain.extended(&full, &self.system), vectors))
    }

    /// One of the vectors of a state.
    ///
    /// # Errors
    /// Returns an error where the state has no momenta.
    pub(super) fn vector(
        &mut self,
        vector: usize,
        mut full: State,
    ) -> Result<DVector<f64>, MotionError> {
        Ok(DVector::from_column_slice(self.converter.tangent(&mut full, vector)?))
    }
}

pub(super) fn vectors_of(system: &System, state: &State) -> DMatrix<f64> {
    let (n, count) = (system.moving(), system.tangents());
    let first = system.tangent_place(0);
    DMatrix::from_column_slice(n, count, &state.values[first..first + n * count])
}
