//! Units of displacements of a motion, in which a growth is that of the motion and not one of units.
//!
//! In: a start and a duration, vectors. Out: the units, vectors in them. Never here: how vectors move.

use nalgebra::{DMatrix, DVector};

use super::phase_space::PhaseSpace;
use crate::num::math;
use crate::system::{Form, State};

/// A momentum over its displacement that differs from 1 by no more than this factor needs no units.
const ORDINARY: f64 = 1e3;

/// Units of displacements, in which a momentum is as large as the velocity that it causes moves its coordinate in the time
/// of the motion: else a growth that is one of the units, as of a vector from p to q, hides that of the motion. The product of
/// the units of a pair is 1, so that symplectic frames stay symplectic, and they are powers of two, so that no digit changes.
pub(super) fn displacement_units(space: &PhaseSpace, start: &State, duration: f64) -> DVector<f64> {
    let n = space.dimension();
    let mut units = DVector::from_element(n, 1.0);
    let mut field = space.vector_field();
    let is_plain = space.form() == Form::Momentum && !space.is_constrained();
    if !is_plain || field.evaluate(start.time, space.variables(start)).is_err() {
        return units;
    }
    let (derivative, degrees) = (field.derivative(), n / 2);
    let mobility = |i: usize| derivative[(i, degrees + i)].abs();
    // the fastest oscillation about the start, or the whole time where nothing pulls
    let squares = (0..degrees).map(|i| mobility(i) * derivative[(degrees + i, i)].abs());
    let rate = squares.fold(0.0, f64::max).sqrt().max(1.0 / duration);
    for i in 0..degrees {
        let impedance = rate / mobility(i);
        if impedance.is_normal() && !(1.0 / ORDINARY..=ORDINARY).contains(&impedance) {
            let power = math::powi(2.0, (0.5 * math::log2(impedance)).round() as i32);
            (units[i], units[degrees + i]) = (1.0 / power, power);
        }
    }
    units
}

/// Columns with each row multiplied by a factor.
pub(super) fn scaled(vectors: &DMatrix<f64>, factors: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(vectors.nrows(), vectors.ncols(), |i, j| vectors[(i, j)] * factors[i])
}
