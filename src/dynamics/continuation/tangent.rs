//! The direction of a family of periodic orbits at a point of it.
//!
//! In: a point, and the equations of its orbit linearised. Out: a unit vector in (z, T, μ); how fast what changes along the
//! family grows on it. Never here: the step.

use nalgebra::DVector;

use super::super::error::DynamicsError;
use super::super::family::Along;
use super::super::linear;
use super::{Continuation, FamilyEquations, FamilyPoint};

/// What the equations take to less than this part of the most is a direction to other orbits.
const KERNEL: f64 = 1e-7;

impl Continuation<'_> {
    /// The unit direction of the family at a point with these equations, along that of the point `before` if it is given,
    /// and how many there are on all of the family. Of several it is the one along which the value changes most.
    pub(super) fn direction(
        &self,
        point: &FamilyPoint,
        found: &FamilyEquations,
        before: Option<&FamilyPoint>,
    ) -> Result<(DVector<f64>, usize), DynamicsError> {
        // the last column does not exist where no parameter changes
        let missing = usize::from(!matches!(self.along, Along::Parameter(_)));
        let columns = found.matrix.ncols() - missing;
        let kernel = linear::kernel(&found.matrix.columns(0, columns).into_owned(), KERNEL);
        let directions = match before {
            Some(before) => before.directions.min(kernel.len()),
            None if point.unit().is_some() => 1,
            None => kernel.len(),
        };
        let guide = match before {
            // others that are there at one orbit are those of families that branch off
            Some(before) if directions == 1 || directions < kernel.len() => before.tangent.clone(),
            _ => self.guide(point)?,
        };
        let guide = found.within(&guide).rows(0, columns).into_owned();
        let mut direction = DVector::zeros(columns);
        for vector in &kernel {
            direction.axpy(vector.dot(&guide), vector, 1.0);
        }
        let Some(unit) = direction.try_normalize(1e-9 * guide.norm()) else {
            let error = point.orbit.rounding.unwrap_or(0.0);
            if error > KERNEL * found.matrix.amax() {
                return Err(DynamicsError::Unsuited(format!(
                    "the family cannot be followed from this orbit: it passes close to a singularity of its law, or of its \
                     coordinates, and rounding changes the matrix of its multipliers by {error:.0e}"
                )));
            }
            return Err(DynamicsError::Unsuited(
                "the family cannot be followed from this orbit: it turns back right here"
                    .to_owned(),
            ));
        };
        let mut unit = found.outside(&unit.resize_vertically(columns + missing, 0.0));
        if before.is_some_and(|before| before.tangent.dot(&unit) < 0.0) {
            unit.neg_mut();
        }
        Ok((unit, directions))
    }

    /// The gradient of what changes along the family, in (z, T, μ).
    fn guide(&self, point: &FamilyPoint) -> Result<DVector<f64>, DynamicsError> {
        let n = self.space.dimension();
        let mut guide = DVector::zeros(n + 2);
        match self.along {
            Along::Parameter(_) => guide[n + 1] = 1.0,
            Along::Period => guide[n] = 1.0,
            Along::Energy => guide.rows_mut(0, n).copy_from(&self.gradient(point)?),
        }
        Ok(guide)
    }

    fn gradient(&self, point: &FamilyPoint) -> Result<DVector<f64>, DynamicsError> {
        self.space_at(point.parameter).energy_gradient(&point.state)
    }

    /// How fast the value grows along the tangent.
    pub(super) fn slope(&self, point: &FamilyPoint) -> Result<f64, DynamicsError> {
        Ok(self.guide(point)?.dot(&point.tangent))
    }
}
