//! Small oscillations about an equilibrium, and what its potential does there.
//!
//! In: the derivative of the rates of the variables that rest, or the second derivative of a potential. Out: modes, a kind, a
//! verdict on stability. Never here: where the equilibrium is.

use nalgebra::DMatrix;

use super::linear;
use crate::num::math;

/// An eigenvalue counts as zero up to this part of the largest.
const VANISHES: f64 = 1e-8;

/// What the effective potential does at an equilibrium.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// It grows in all directions.
    Minimum,
    /// It grows in some and falls in others.
    Saddle,
    /// It falls in all directions.
    Maximum,
    /// It changes by less than a square in some direction.
    Degenerate,
}

/// A small oscillation.
#[derive(Clone, PartialEq, Debug)]
pub struct Mode {
    /// Its angular frequency.
    pub frequency: f64,
    /// The displacement of each coordinate, the largest is 1: its part in phase with that …
    pub in_phase: Vec<f64>,
    /// … and the part a quarter of a period earlier.
    pub quadrature: Vec<f64>,
}

impl Kind {
    /// The kind by the second derivative of the potential.
    pub(super) fn of(second: &DMatrix<f64>) -> Kind {
        let symmetric = (second + second.transpose()) * 0.5;
        let values = symmetric.symmetric_eigenvalues();
        let largest = values.amax();
        if largest == 0.0 || values.iter().any(|x| x.abs() <= VANISHES * largest) {
            return Kind::Degenerate;
        }
        match (values.min() > 0.0, values.max() < 0.0) {
            (true, _) => Kind::Minimum,
            (_, true) => Kind::Maximum,
            _ => Kind::Saddle,
        }
    }

    /// The kind by ∂(q̇, ṗ)/∂(q, p): that of the least energy at fixed coordinates.
    pub(super) fn of_canonical(df: &DMatrix<f64>) -> Kind {
        let n = df.nrows() / 2;
        let part = |i: usize, j: usize| df.view((i * n, j * n), (n, n)).into_owned();
        let (a, b, c, d) = (part(0, 0), part(0, 1), part(1, 0), part(1, 1));
        let inertia = (&b + b.transpose()) * 0.5;
        let positive = inertia.clone().cholesky().is_some();
        match b.try_inverse() {
            Some(mass) if positive => Kind::of(&-(c - d * mass * a)),
            // no kinetic energy that is positive: the energy itself decides
            _ => {
                let mut hessian = DMatrix::zeros(2 * n, 2 * n);
                hessian.view_mut((0, 0), (n, n)).copy_from(&(-part(1, 0)));
                hessian.view_mut((0, n), (n, n)).copy_from(&(-part(1, 1)));
                hessian.view_mut((n, 0), (n, n)).copy_from(&part(0, 0));
                hessian.view_mut((n, n), (n, n)).copy_from(&part(0, 1));
                Kind::of(&hessian)
            }
        }
    }
}

/// Whether nothing grows by these eigenvalues; `None` where some that are zero leave it open.
pub(super) fn stable(eigenvalues: &[[f64; 2]]) -> Option<bool> {
    let scale = largest(eigenvalues);
    if eigenvalues.iter().any(|z| z[0] > VANISHES.sqrt() * scale) {
        return Some(false);
    }
    let rests = eigenvalues.iter().any(|z| math::hypot(z[0], z[1]) <= VANISHES.sqrt() * scale);
    (!rests).then_some(true)
}

/// The modes of a linear motion x′ = `matrix` x. `displacements` are the coordinates, in their `units`, of each variable x.
pub(super) fn modes(
    matrix: &DMatrix<f64>,
    eigenvalues: &[[f64; 2]],
    displacements: &DMatrix<f64>,
    units: &[f64],
) -> Vec<Mode> {
    let scale = largest(eigenvalues);
    let oscillates =
        |z: &&[f64; 2]| z[1] > VANISHES.sqrt() * scale && z[0].abs() <= VANISHES.sqrt() * scale;
    let mut frequencies: Vec<f64> = eigenvalues.iter().filter(oscillates).map(|z| z[1]).collect();
    frequencies.sort_by(f64::total_cmp);
    let complex = displacements.map(|x| nalgebra::Complex::new(x, 0.0));
    let mut modes: Vec<Mode> = Vec::new();
    for (k, &frequency) in frequencies.iter().enumerate() {
        let equal = |other: &&f64| (frequency - **other).abs() <= 1e-7 * frequency;
        let rank = frequencies[..k].iter().filter(equal).count();
        let Some(vector) = linear::null_vector(matrix, frequency, rank) else { continue };
        let moved = &complex * nalgebra::DVector::from_vec(vector);
        let size = |i: usize| moved[i].norm() * units[i];
        let Some(largest) = (0..moved.len()).max_by(|&a, &b| size(a).total_cmp(&size(b))) else {
            continue;
        };
        let clean = |x: f64| if x.abs() < 1e-12 { 0.0 } else { x };
        let part = |i: usize| moved[i] / moved[largest] * (units[i] / units[largest]);
        let in_phase = (0..moved.len()).map(|i| clean(part(i).re)).collect();
        let quadrature = (0..moved.len()).map(|i| clean(part(i).im)).collect();
        modes.push(Mode { frequency, in_phase, quadrature });
    }
    modes
}

/// The largest modulus.
fn largest(eigenvalues: &[[f64; 2]]) -> f64 {
    eigenvalues.iter().map(|z| math::hypot(z[0], z[1])).fold(0.0, f64::max)
}
