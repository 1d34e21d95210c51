//! A point of a family of periodic orbits.
//!
//! In: an orbit, and where on its family it lies. Out: what changes its sign at a bifurcation. Never here: how the next
//! point is found (`continuation`).

use nalgebra::{DMatrix, DVector};

use super::super::orbit::Orbit;
use crate::system::State;

/// A point of a family.
#[derive(Clone)]
pub(super) struct FamilyPoint {
    pub(super) state: State,
    pub(super) period: f64,
    pub(super) parameter: f64,
    /// The direction of the family, in (z, T, μ), for a step onwards.
    pub(super) tangent: DVector<f64>,
    pub(super) value: f64,
    pub(super) orbit: Orbit,
}

impl FamilyPoint {
    /// What changes its sign at a period doubling: Π (μᵢ + 1) of the transverse multipliers.
    pub(super) fn doubling(&self) -> f64 {
        let n = self.orbit.transverse.nrows();
        (&self.orbit.transverse + DMatrix::identity(n, n)).determinant()
    }

    /// What changes its sign where a multiplier passes 1: Π (μᵢ − 1).
    pub(super) fn unit(&self) -> f64 {
        let n = self.orbit.transverse.nrows();
        (&self.orbit.transverse - DMatrix::identity(n, n)).determinant()
    }
}
