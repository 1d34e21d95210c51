//! The equations of a periodic orbit at a point of its family, linearised.
//!
//! In: what is missing from closing up, its derivatives, and the displacements that constraints allow. Out: changes of
//! (z, T, μ) in coordinates of those displacements, and back. Never here: how the equations are solved (`continuation`).

use nalgebra::{DMatrix, DVector};

use super::super::newton::NewtonIterate;

/// The equations of an orbit at a point, and their derivatives.
pub(super) struct FamilyEquations {
    pub(super) missing: DVector<f64>,
    pub(super) matrix: DMatrix<f64>,
    pub(super) here: NewtonIterate,
}

impl FamilyEquations {
    /// A change of (z, T, μ) in coordinates of the displacements of z that are allowed.
    pub(super) fn within(&self, change: &DVector<f64>) -> DVector<f64> {
        let (basis, n) = (&self.here.circuit.basis, change.len() - 2);
        let allowed = basis.transpose() * change.rows(0, n);
        let mut within = allowed.resize_vertically(basis.ncols() + 2, 0.0);
        within.rows_mut(basis.ncols(), 2).copy_from(&change.rows(n, 2));
        within
    }

    /// The same back.
    pub(super) fn outside(&self, within: &DVector<f64>) -> DVector<f64> {
        let basis = &self.here.circuit.basis;
        let (n, allowed) = (basis.nrows(), basis.ncols());
        let mut change = (basis * within.rows(0, allowed)).resize_vertically(n + 2, 0.0);
        change.rows_mut(n, 2).copy_from(&within.rows(allowed, 2));
        change
    }
}
