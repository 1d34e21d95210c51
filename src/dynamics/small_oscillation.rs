//! Small oscillations about an equilibrium, and what its potential does there.
//!
//! In: the derivative of the rates of the variables that rest, or the second derivative of a potential. Out: modes, a kind, a
//! verdict on stability. Never here: where the equilibrium is.

use nalgebra::{Complex, DMatrix, DVector};

use super::linear;
use crate::num::math;

/// An eigenvalue counts as zero up to this part of the largest.
const VANISHES: f64 = 1e-8;

/// Two frequencies are equal up to this part: a pair without two modes differs by the root of rounding.
const EQUAL: f64 = 1e-6;

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

/// Whether nothing grows in the linear motion x′ = `matrix` x by its eigenvalues; `None` where some that are zero leave it open,
/// where equal frequencies have fewer modes than there are of them, so that the motion grows in proportion to time, and where
/// the eigenvalues are not known.
pub(super) fn stable(matrix: &DMatrix<f64>, eigenvalues: &[[f64; 2]]) -> Option<bool> {
    let scale = largest(eigenvalues);
    if eigenvalues.iter().any(|z| z[0] > VANISHES.sqrt() * scale) {
        return Some(false);
    }
    let known = eigenvalues.len() == matrix.nrows();
    let whole = || {
        frequencies(eigenvalues).chunk_by(equal).all(|equal| {
            equal.len() == 1 || linear::null_vectors(matrix, equal[0]).len() >= equal.len()
        })
    };
    (known && !rests(eigenvalues) && whole()).then_some(true)
}

/// Whether something neither moves nor grows in some direction: an eigenvalue is zero.
pub(super) fn rests(eigenvalues: &[[f64; 2]]) -> bool {
    let scale = largest(eigenvalues);
    eigenvalues.iter().any(|z| math::hypot(z[0], z[1]) <= VANISHES.sqrt() * scale)
}

/// The frequencies of what neither grows nor is damped, the slowest first.
fn frequencies(eigenvalues: &[[f64; 2]]) -> Vec<f64> {
    let scale = largest(eigenvalues);
    let oscillates =
        |z: &&[f64; 2]| z[1] > VANISHES.sqrt() * scale && z[0].abs() <= VANISHES.sqrt() * scale;
    let mut frequencies: Vec<f64> = eigenvalues.iter().filter(oscillates).map(|z| z[1]).collect();
    frequencies.sort_by(f64::total_cmp);
    frequencies
}

/// Whether two frequencies are equal but for rounding.
fn equal(one: &f64, other: &f64) -> bool {
    (one - other).abs() <= EQUAL * other
}

/// The modes of a linear motion x′ = `matrix` x. `displacements` are the coordinates, in their `units`, of each variable x.
pub(super) fn modes(
    matrix: &DMatrix<f64>,
    eigenvalues: &[[f64; 2]],
    displacements: &DMatrix<f64>,
    units: &[f64],
) -> Vec<Mode> {
    let complex = displacements.map(|x| Complex::new(x, 0.0));
    let mut modes: Vec<Mode> = Vec::new();
    for equal in frequencies(eigenvalues).chunk_by(equal) {
        let vectors = linear::null_vectors(matrix, equal[0]);
        let moved = vectors.iter().take(equal.len()).map(|vector| &complex * vector).collect();
        for (moved, &frequency) in each_by_itself(moved, units).iter().zip(equal) {
            let largest = largest_part(moved, units);
            let clean = |x: f64| if x.abs() < 1e-12 { 0.0 } else { x };
            let part = |i: usize| moved[i] / moved[largest] * (units[i] / units[largest]);
            let in_phase = (0..moved.len()).map(|i| clean(part(i).re)).collect();
            let quadrature = (0..moved.len()).map(|i| clean(part(i).im)).collect();
            modes.push(Mode { frequency, in_phase, quadrature });
        }
    }
    modes
}

/// The coordinate that moves most, in its unit.
fn largest_part(moved: &DVector<Complex<f64>>, units: &[f64]) -> usize {
    let size = |i: usize| moved[i].norm() * units[i];
    (0..moved.len()).max_by(|&a, &b| size(a).total_cmp(&size(b))).unwrap_or(0)
}

/// Modes of one frequency, of which any sums are modes too: each moves a coordinate of its own, at which the others rest. So
/// equal oscillators come out one by one, and modes are real where they can be.
fn each_by_itself(
    mut modes: Vec<DVector<Complex<f64>>>,
    units: &[f64],
) -> Vec<DVector<Complex<f64>>> {
    if modes.len() < 2 {
        return modes;
    }
    let mut own = Vec::new();
    for k in 0..modes.len() {
        // over all that are left, so that it does not matter which these are
        let size = |i: usize| {
            let squares = modes[k..].iter().map(|mode| mode[i].norm_sqr());
            squares.sum::<f64>() * units[i] * units[i]
        };
        let most = (0..units.len()).map(size).fold(0.0, f64::max);
        let Some(row) = (0..units.len()).find(|&i| size(i) > 0.99 * most) else { break };
        let part = |of: &DVector<Complex<f64>>| of[row].norm();
        let left = (k..modes.len()).max_by(|&a, &b| part(&modes[a]).total_cmp(&part(&modes[b])));
        modes.swap(k, left.unwrap_or(k));
        let pivot = modes[k].clone() / modes[k][row];
        for (other, mode) in modes.iter_mut().enumerate() {
            if other == k {
                mode.copy_from(&pivot);
            } else {
                let along = mode[row];
                *mode -= &pivot * along;
            }
        }
        own.push(row);
    }
    let mut order: Vec<usize> = (0..own.len()).collect();
    order.sort_by_key(|&k| own[k]);
    order.into_iter().map(|k| modes[k].clone()).collect()
}

/// The largest modulus.
fn largest(eigenvalues: &[[f64; 2]]) -> f64 {
    eigenvalues.iter().map(|z| math::hypot(z[0], z[1])).fold(0.0, f64::max)
}
