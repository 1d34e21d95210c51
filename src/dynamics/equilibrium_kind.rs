//! What a potential does at an equilibrium, by the signs of its second derivative.
//!
//! In: the second derivative, and the error of each of its entries. Out: in how many directions it grows, falls and does neither, as
//! far as these errors allow. Never here: the motion.
//!
//! Signs do not depend on the units of the coordinates (J. J. Sylvester's law of inertia): they are taken in units in which the
//! entries are as large as each other, so that what is soft is seen beside what is stiff.

use nalgebra::{DMatrix, DVector};

/// The number of times that rows and columns are brought to one size.
const BALANCINGS: usize = 12;

/// The error of an entry of a product, and of an eigenvalue of entries no larger than 1, per row.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The kind of an equilibrium as a critical point of the effective potential.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EquilibriumKind {
    /// It grows in all directions.
    Minimum,
    /// It grows in some and falls in others.
    Saddle,
    /// It falls in all directions.
    Maximum,
    /// It changes by less than a square in some direction.
    Degenerate,
}

impl EquilibriumKind {
    /// Its name in reports.
    pub fn word(self) -> &'static str {
        match self {
            EquilibriumKind::Minimum => "minimum",
            EquilibriumKind::Saddle => "saddle",
            EquilibriumKind::Maximum => "maximum",
            EquilibriumKind::Degenerate => "degenerate",
        }
    }
}

/// In how many directions a potential grows, falls, or does neither by a square.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Signature {
    pub(super) growing: usize,
    pub(super) falling: usize,
    pub(super) flat: usize,
}

impl Signature {
    /// That of the second derivative of a potential, whose entries are known to these errors.
    pub(super) fn of(second: &DMatrix<f64>, error: &DMatrix<f64>) -> Signature {
        let n = second.nrows();
        let mut scale = DVector::from_element(n, 1.0);
        let symmetric = (second + second.transpose()) * 0.5;
        let scaled = |m: &DMatrix<f64>, scale: &DVector<f64>| {
            DMatrix::from_fn(n, n, |i, j| m[(i, j)] * scale[i] * scale[j])
        };
        for _ in 0..BALANCINGS {
            let balanced = scaled(&symmetric, &scale);
            for (size, row) in scale.iter_mut().zip(balanced.row_iter()) {
                if row.amax() > 0.0 {
                    *size /= row.amax().sqrt();
                }
            }
        }
        let errors = scaled(&error.abs(), &scale);
        let error = errors.row_iter().map(|row| row.sum()).fold(ROUNDING * n as f64, f64::max);
        let values = scaled(&symmetric, &scale).symmetric_eigenvalues();
        let growing = values.iter().filter(|value| **value > error).count();
        let falling = values.iter().filter(|value| **value < -error).count();
        Signature { growing, falling, flat: n - growing - falling }
    }

    /// That by ∂(q̇, ṗ)/∂(q, p), with its errors: of the least energy at fixed coordinates.
    pub(super) fn of_canonical(df: &DMatrix<f64>, error: &DMatrix<f64>) -> Signature {
        let n = df.nrows() / 2;
        let parts = |of: &DMatrix<f64>| {
            [(0, 0), (0, 1), (1, 0), (1, 1)]
                .map(|(i, j)| of.view((i * n, j * n), (n, n)).into_owned())
        };
        let ([a, b, c, d], [da, _, dc, dd]) = (parts(df), parts(error));
        let inertia = (&b + b.transpose()) * 0.5;
        let positive = inertia.clone().cholesky().is_some();
        if let Some(mass) = b.try_inverse().filter(|_| positive) {
            let size = mass.abs();
            let error = dc
                + c.abs() * ROUNDING
                + (&dd + d.abs() * ROUNDING) * &size * a.abs()
                + d.abs() * &size * da;
            return Signature::of(&-(c - d * mass * a), &error);
        }
        // no kinetic energy that is positive: the energy itself decides
        Signature::of_energy(df, error)
    }

    /// That of the energy itself by ∂(q̇, ṗ)/∂(q, p) of Hamilton's equations, with its errors.
    pub(super) fn of_energy(df: &DMatrix<f64>, error: &DMatrix<f64>) -> Signature {
        let n = df.nrows() / 2;
        let ordered = |of: &DMatrix<f64>, sign: f64| {
            DMatrix::from_fn(2 * n, 2 * n, |i, j| {
                if i < n { of[(n + i, j)] * sign } else { of[(i - n, j)] }
            })
        };
        Signature::of(&ordered(df, -1.0), &ordered(error, 1.0))
    }

    pub(super) fn kind(self) -> EquilibriumKind {
        match (self.growing, self.falling, self.flat) {
            (_, 0, 0) => EquilibriumKind::Minimum,
            (0, _, 0) => EquilibriumKind::Maximum,
            (_, _, 0) => EquilibriumKind::Saddle,
            _ => EquilibriumKind::Degenerate,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(rows: [[f64; 2]; 2], error: f64) -> EquilibriumKind {
        let second = DMatrix::from_fn(2, 2, |i, j| rows[i][j]);
        Signature::of(&second, &DMatrix::from_element(2, 2, error)).kind()
    }

    /// By determinant and trace.
    #[test]
    fn a_soft_direction_counts_beside_a_stiff_one() {
        assert_eq!(of([[1e12, 0.0], [0.0, 1.0]], 1e-16), EquilibriumKind::Minimum);
        assert_eq!(of([[8.0, 6e-5], [6e-5, 1e-9]], 1e-13), EquilibriumKind::Minimum);
        assert_eq!(of([[8.0, 6e-5], [6e-5, 1e-10]], 1e-13), EquilibriumKind::Saddle);
        assert_eq!(of([[0.0, 1e-9], [1e-9, 1e9]], 0.0), EquilibriumKind::Saddle);
        // det = ±1e-7 − 1e-18 has no sign
        assert_eq!(of([[0.0, 1e-9], [1e-9, 1e9]], 1e-16), EquilibriumKind::Degenerate);
    }

    #[test]
    fn what_is_no_more_than_its_error_is_flat() {
        assert_eq!(of([[8.0, 0.0], [0.0, 1e-13]], 2e-13), EquilibriumKind::Degenerate);
        assert_eq!(of([[0.9, 0.3], [0.3, 0.1]], 1e-16), EquilibriumKind::Degenerate);
        assert_eq!(of([[1.0, 0.0], [0.0, 0.0]], 0.0), EquilibriumKind::Degenerate);
    }
}
