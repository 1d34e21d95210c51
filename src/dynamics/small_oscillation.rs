//! Small oscillations about an equilibrium.
//!
//! In: the derivative of the rates of the variables that rest. Out: modes, a verdict on stability. Never here: where the equilibrium is.

use nalgebra::{Complex, DMatrix, DVector};

use super::eigenvalue_error::eigenvalue_errors;
use super::linear::{self, EQUAL};
use crate::num::math;

/// The rounding error of the square of an eigenvalue, as a part of that of the largest.
const ROUNDING: f64 = 1e3 * f64::EPSILON;

/// A part of a mode below this is rounding, which equal frequencies leave half the digits of.
const REAL: f64 = 1e-7;

/// A normal mode of small oscillations about an equilibrium.
#[derive(Clone, PartialEq, Debug)]
pub struct Mode {
    /// Its angular frequency.
    pub frequency: f64,
    /// The displacement of each coordinate, the largest is 1: its part in phase with that.
    pub in_phase: Vec<f64>,
    /// The part of each displacement a quarter of a period earlier.
    pub quadrature: Vec<f64>,
}

/// What neighbours do in a linear motion.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum LinearMotion {
    /// Some grow exponentially: so they do in the full motion.
    Grows,
    /// All are damped: so they are in the full motion (A. M. Lyapunov's first method).
    Damped,
    /// None grows and some oscillate without end: this says nothing about the full motion.
    Bounded,
    /// Eigenvalues that are zero leave it open; or equal frequencies have fewer modes than there are of them, so that some grow in
    /// proportion to time; or the eigenvalues are not known.
    Open,
}

/// What neighbours do in the linear motion x′ = `matrix` x, by its eigenvalues, of whose real parts the errors are given.
pub(super) fn linear_motion(
    matrix: &DMatrix<f64>,
    eigenvalues: &[[f64; 2]],
    errors: &[f64],
) -> LinearMotion {
    let known = || eigenvalues.iter().zip(errors);
    if known().any(|(z, error)| z[0] > *error) {
        return LinearMotion::Grows;
    }
    if eigenvalues.is_empty() || rests(eigenvalues) {
        return LinearMotion::Open;
    }
    if known().all(|(z, error)| z[0] < -*error) {
        return LinearMotion::Damped;
    }
    let whole =
        frequencies(eigenvalues, errors).chunk_by(|&one, &other| equal(one, other)).all(|equal| {
            equal.len() == 1 || linear::null_vectors(matrix, equal[0]).len() >= equal.len()
        });
    if whole { LinearMotion::Bounded } else { LinearMotion::Open }
}

/// Whether something neither moves nor grows in some direction: an eigenvalue is zero.
pub(super) fn rests(eigenvalues: &[[f64; 2]]) -> bool {
    eigenvalues.contains(&[0.0; 2])
}

/// The errors of the real parts of the eigenvalues of a matrix whose entries are known to `error`: to first order, but no more than
/// where that has no bound. A pair that is slow beside the fastest differs by the root of what rounding leaves of its square, and so does
/// one of two equal ones.
pub(super) fn growth_errors(
    matrix: &DMatrix<f64>,
    error: &DMatrix<f64>,
    eigenvalues: &[[f64; 2]],
) -> Vec<f64> {
    let scale = largest(eigenvalues);
    let most = |[re, im]: [f64; 2]| {
        let size = math::hypot(re, im);
        if size > 0.0 { (EQUAL * size).max(ROUNDING * scale * (scale / size)) } else { 0.0 }
    };
    let errors = eigenvalue_errors(matrix, error, eigenvalues);
    eigenvalues.iter().zip(errors).map(|(z, error)| error.min(most(*z))).collect()
}

/// The frequencies of what neither grows nor is damped, the slowest first.
fn frequencies(eigenvalues: &[[f64; 2]], errors: &[f64]) -> Vec<f64> {
    let oscillates =
        |(z, error): &(&[f64; 2], &f64)| z[1] > 0.0 && z[1] > z[0].abs() && z[0].abs() <= **error;
    let oscillating = eigenvalues.iter().zip(errors).filter(oscillates);
    let mut frequencies: Vec<f64> = oscillating.map(|(z, _)| z[1]).collect();
    frequencies.sort_by(f64::total_cmp);
    frequencies
}

/// Whether two frequencies are equal but for rounding.
fn equal(one: f64, other: f64) -> bool {
    (one - other).abs() <= EQUAL * other
}

/// The modes of a linear motion x′ = `matrix` x. `displacements` are the coordinates, in their `units`, of each variable x. Modes of
/// one frequency are orthogonal by the kinetic energy, whose matrix in these units is `mass`, where they can be real.
pub(super) fn modes(
    matrix: &DMatrix<f64>,
    (eigenvalues, errors): (&[[f64; 2]], &[f64]),
    displacements: &DMatrix<f64>,
    (units, mass): (&[f64], Option<&DMatrix<f64>>),
) -> Vec<Mode> {
    let complex = displacements.map(|x| Complex::new(x, 0.0));
    let mut modes: Vec<Mode> = Vec::new();
    for equal in frequencies(eigenvalues, errors).chunk_by(|&one, &other| equal(one, other)) {
        let vectors = linear::null_vectors(matrix, equal[0]);
        let vectors = vectors.iter().take(equal.len()).map(|vector| &complex * vector);
        let mut moved: Vec<DVector<Complex<f64>>> = vectors.collect();
        if moved.len() > 1 {
            moved = real_basis(&moved, mass).unwrap_or(moved);
        }
        for (moved, &frequency) in moved.iter().zip(equal) {
            let size = |i: usize| moved[i].norm() * units[i];
            let places = 0..moved.len();
            let Some(largest) = places.max_by(|&a, &b| size(a).total_cmp(&size(b))) else {
                continue;
            };
            let clean = |x: f64| if x.abs() < 1e-12 { 0.0 } else { x };
            let part = |i: usize| moved[i] / moved[largest] * (units[i] / units[largest]);
            let in_phase = (0..moved.len()).map(|i| clean(part(i).re)).collect();
            let quadrature = (0..moved.len()).map(|i| clean(part(i).im)).collect();
            modes.push(Mode { frequency, in_phase, quadrature });
        }
    }
    modes
}

/// Real displacements that span the same as these, if there are as many: the projections of single coordinates onto what they span,
/// each made orthogonal by `mass` to those before it.
fn real_basis(
    moved: &[DVector<Complex<f64>>],
    mass: Option<&DMatrix<f64>>,
) -> Option<Vec<DVector<Complex<f64>>>> {
    let (n, count) = (moved[0].len(), moved.len());
    let parts = DMatrix::from_fn(n, 2 * count, |i, j| {
        if j < count { moved[j][i].re } else { moved[j - count][i].im }
    });
    let found = parts.svd(true, false);
    let (left, sizes) = (found.u?, found.singular_values);
    let largest = sizes.max();
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by(|&a, &b| sizes[b].total_cmp(&sizes[a]));
    let is_real = sizes.iter().filter(|size| **size > REAL * largest).count() == count;
    if !is_real {
        return None;
    }
    let space = left.select_columns(&order[..count]);
    let weighted = |v: &DVector<f64>| mass.map_or_else(|| v.clone(), |mass| mass * v);
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for column in (&space * space.transpose()).column_iter() {
        let mut v = column.into_owned();
        for _ in 0..2 {
            for one in &basis {
                let along = weighted(one);
                v.axpy(-along.dot(&v) / along.dot(one), one, 1.0);
            }
        }
        let size = v.amax();
        if size > REAL && basis.len() < count {
            basis.push(v.map(|x| if x.abs() <= REAL * size { 0.0 } else { x }));
        }
    }
    Some(basis.into_iter().map(|v| v.map(|x| Complex::new(x, 0.0))).collect())
}

fn largest(eigenvalues: &[[f64; 2]]) -> f64 {
    eigenvalues.iter().map(|z| math::hypot(z[0], z[1])).fold(0.0, f64::max)
}
