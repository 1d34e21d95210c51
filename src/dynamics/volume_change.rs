//! By how much the law of motion changes the volume that a full set of tangent vectors spans: d ln V/dt = div f (Liouville), and at
//! each impulse by the determinant of its derivative.
//!
//! In: the steps of a motion. Out: the logarithm of the change so far. Never here: the vectors, or what they span.

use super::error::DynamicsError;
use super::phase_space::{PhaseSpace, VectorField};
use super::tangent_step::TangentStep;
use crate::num::math;

/// Gauss's three points on [−1, 1], and their weights.
const POINTS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// The change of volumes along a motion.
pub(super) struct VolumeChange {
    /// The rates, where their divergence is not zero everywhere.
    field: Option<VectorField>,
    /// The logarithm of the change by the flow.
    flow: f64,
}

impl VolumeChange {
    /// That of a motion in a space.
    pub(super) fn new(space: &PhaseSpace) -> VolumeChange {
        VolumeChange { field: (!space.is_hamiltonian()).then(|| space.vector_field()), flow: 0.0 }
    }

    /// Continues over a step.
    ///
    /// # Errors
    /// Returns an error if the states in it, or the rates there, cannot be evaluated.
    pub(super) fn follow(
        &mut self,
        space: &PhaseSpace,
        step: &mut dyn TangentStep,
    ) -> Result<(), DynamicsError> {
        let Some(field) = &mut self.field else { return Ok(()) };
        let (begin, end) = step.interval();
        let half = 0.5 * (end - begin);
        for (place, weight) in POINTS {
            let (state, _) = step.at(begin + half * (1.0 + place))?;
            field.evaluate(state.time, space.variables(&state))?;
            self.flow += half * weight * field.derivative().trace();
        }
        Ok(())
    }

    /// The logarithm of the change so far, with that by impulses of this determinant.
    pub(super) fn logarithm(&self, impulses: f64) -> f64 {
        self.flow + math::ln(impulses.abs())
    }
}
