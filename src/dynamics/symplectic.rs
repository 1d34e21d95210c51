//! Symplectic matrices: their inverse, and how far a matrix is from being one.
//!
//! In: the derivative of a map of canonical variables (q, p). Out: a matrix, or numbers. Never here: where it comes from.

use nalgebra::DMatrix;

use super::phase_space::PhaseSpace;
use crate::num::math;

impl PhaseSpace {
    /// M⁻¹ = −𝕁 Mᵀ 𝕁 of a symplectic matrix.
    pub fn symplectic_inverse(matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let size = matrix.nrows();
        let n = size / 2;
        DMatrix::from_fn(size, size, |i, j| {
            let sign = if (i < n) == (j < n) { 1.0 } else { -1.0 };
            sign * matrix[((j + n) % size, (i + n) % size)]
        })
    }

    /// The largest entry of |M𝕁Mᵀ − 𝕁|, and what rounding may leave of that entry: ε times its entry of |M| |𝕁| |M|ᵀ, by the
    /// rounding of M, and what earlier steps have `left` of it. Entries of two coordinates, of two momenta and of one of each
    /// have units of their own.
    pub fn symplectic_residual(matrix: &DMatrix<f64>, left: &DMatrix<f64>) -> (f64, f64) {
        let size = matrix.nrows();
        let n = size / 2;
        let unit = DMatrix::from_fn(size, size, |i, j| {
            f64::from(i8::from(j == i + n) - i8::from(i == j + n))
        });
        let residual = (matrix * &unit * matrix.transpose() - &unit).abs();
        let rounding = matrix.abs() * unit.abs() * matrix.abs().transpose() * f64::EPSILON;
        let rounding = rounding.zip_map(left, math::hypot);
        let largest = residual.amax();
        let of_the_largest = residual.iter().zip(&rounding).filter(|(entry, _)| **entry == largest);
        (largest, of_the_largest.map(|(_, &bound)| bound).fold(f64::INFINITY, f64::min))
    }
}
