//! Motions that stop where their mass matrix vanishes with the velocities or the time.
//!
//! In: the error of a method. Out: the same error with this cause, if it is so. Never here: chart singularities, where the
//! matrix vanishes with the coordinates and a collision may be the cause.

use super::Propagator;
use crate::system::{MotionError, MotionErrorKind};

/// A mass matrix whose determinant is less than this part of that with the velocities at the beginning is singular.
const SINGULAR: f64 = 1e-6;

impl Propagator {
    /// Names a singular mass matrix in place of steps that became too small.
    pub(super) fn with_singular_mass(&self, error: MotionError) -> MotionError {
        let is_singular = matches!(error.kind, MotionErrorKind::StepUnderflow(_))
            && self.mass_left().is_some_and(is_singular);
        if is_singular {
            let values = &self.stepper.state().values;
            return self.system.error(MotionErrorKind::SingularMass, error.time, values);
        }
        error
    }

    /// The determinant of the mass matrix, as a part of that at the same place with the velocities and the time at which the
    /// motion began.
    fn mass_left(&self) -> Option<f64> {
        let (here, begun) = (self.stepper.state(), self.watch.begun.as_ref()?);
        let n = self.system.degrees();
        if here.form != begun.form || self.system.constraints() > 0 {
            return None;
        }
        let mut there = begun.clone();
        (0..n).for_each(|i| there.set(i, here.exact(i)));
        let now = self.system.mass_determinant(here, &self.parameters)?;
        let then = self.system.mass_determinant(&there, &self.parameters)?;
        Some((now / then).abs())
    }
}

/// Whether a mass matrix is singular of whose determinant this part is left.
fn is_singular(left: f64) -> bool {
    left < SINGULAR
}

#[cfg(test)]
mod tests {
    use super::is_singular;

    #[test]
    fn a_mass_matrix_is_singular_below_a_millionth_of_its_determinant() {
        assert!(is_singular(0.9e-6) && !is_singular(1.1e-6));
        assert!(!is_singular(f64::NAN));
    }
}
