//! The eigenvalues of small matrices.

use nalgebra::linalg::{Schur, balancing};
use nalgebra::{DMatrix, DVector};

use super::math;

/// The maximal number of iterations of the decomposition, and of balancing by sums.
const SWEEPS: usize = 2_000;
const BALANCINGS: usize = 100;

/// The decomposition, which has no exceptional shifts, stands still at matrices whose blocks repeat: it is begun again after so
/// many reflections at the most.
const REFLECTIONS: u32 = 8;

/// So many entries may be summed.
const ROOM: f64 = 1024.0;

/// The squares of entries in this range neither overflow nor vanish.
const SQUARED: std::ops::Range<f64> = 1e-140..1e140;

/// The eigenvalues of a matrix as real and imaginary parts; empty if they cannot be found.
///
/// The matrix is balanced first (B. N. Parlett, C. Reinsch, Numer. Math. 13 (1969) 293), which removes
/// the effect of different units.
pub fn eigenvalues(mut matrix: DMatrix<f64>) -> Vec<[f64; 2]> {
    if matrix.is_empty() || matrix.iter().any(|x| !x.is_finite()) {
        return Vec::new();
    }
    // squares the entries, and does not end where a square overflows
    let unit = if has_squares(&matrix) { 1.0 } else { brought_near_one(&mut matrix) };
    balancing::balance_parlett_reinsch(&mut matrix);
    let found = (0..=REFLECTIONS).find_map(|k| {
        if k > 0 {
            reflect(&mut matrix, k);
        }
        Schur::try_new(matrix.clone(), f64::EPSILON, SWEEPS)
    });
    let values = found.map(|schur| schur.complex_eigenvalues());
    values.iter().flat_map(|values| values.iter().map(|z| [z.re * unit, z.im * unit])).collect()
}

/// Whether the squares of all entries neither overflow nor vanish.
pub fn has_squares(matrix: &DMatrix<f64>) -> bool {
    matrix.iter().all(|x| *x == 0.0 || SQUARED.contains(&x.abs()))
}

/// The same linear map after a reflection of the axes, R A R with R = 1 − 2 v vᵀ, whose direction differs with `k`: the
/// eigenvalues stay.
fn reflect(matrix: &mut DMatrix<f64>, k: u32) {
    let direction = |i: usize, _| math::sin(f64::from(k) + (2.0 + i as f64).sqrt());
    let normal = DVector::from_fn(matrix.nrows(), direction).normalize();
    let rows = matrix.tr_mul(&normal);
    *matrix -= &normal * rows.transpose() * 2.0;
    let columns = &*matrix * &normal;
    *matrix -= columns * normal.transpose() * 2.0;
}

/// Balances by the sums of absolute values, and divides by a power of two near the largest entry, which
/// is returned.
fn brought_near_one(matrix: &mut DMatrix<f64>) -> f64 {
    let power_of_two = |exponent: f64| math::powi(2.0, exponent.clamp(-1000.0, 1000.0) as i32);
    // so that no sum overflows
    *matrix /= ROOM;
    for _ in 0..BALANCINGS {
        let mut settled = true;
        for i in 0..matrix.nrows() {
            let own = matrix[(i, i)].abs();
            let column = matrix.column(i).iter().map(|x| x.abs()).sum::<f64>() - own;
            let row = matrix.row(i).iter().map(|x| x.abs()).sum::<f64>() - own;
            if !(column > 0.0 && row > 0.0) {
                continue;
            }
            let exponent = ((math::log2(row) - math::log2(column)) / 2.0).round();
            if exponent != 0.0 {
                settled = false;
                matrix.column_mut(i).scale_mut(power_of_two(exponent));
                matrix.row_mut(i).scale_mut(power_of_two(-exponent));
            }
        }
        if settled {
            break;
        }
    }
    let largest = matrix.amax();
    let unit = if largest > 0.0 { power_of_two(math::log2(largest).floor()) } else { 1.0 };
    *matrix /= unit;
    unit * ROOM
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalues_are_found_however_large_or_small_the_entries() {
        for unit in [1.0, 1e160, 1e300, 1e-160, 1e-300] {
            let matrix = DMatrix::from_row_slice(2, 2, &[0.0, unit, -4.0 * unit, 0.0]);
            let values = eigenvalues(matrix);
            assert_eq!(values.len(), 2, "{unit:e}");
            for [re, im] in values {
                assert!(re.abs() <= 1e-14 * unit, "{unit:e}: {re:e}");
                assert!((im.abs() / unit - 2.0).abs() < 1e-14, "{unit:e}: {im:e}");
            }
        }
    }

    #[test]
    fn entries_far_apart_are_balanced() {
        // x′ = 1e200 v, v′ = −1e−200 x turns once in a unit
        let values = eigenvalues(DMatrix::from_row_slice(2, 2, &[0.0, 1e200, -1e-200, 0.0]));
        assert!(
            values.iter().all(|[re, im]| *re == 0.0 && (im.abs() - 1.0).abs() < 1e-12),
            "{values:?}"
        );
    }

    /// Two equal oscillators in a plane that turns, z″ + 2 i g z′ + k z = 0 for each: λ = i (−g ± √(g² + k)). The decomposition
    /// stands still at some of them, and at one where k < −g² they grow.
    #[test]
    fn equal_blocks_have_their_eigenvalues() {
        let mut grown = 0;
        for step in 0..200 {
            let (g, k) = (0.1 + 0.013 * f64::from(step), 0.7 - 0.03 * f64::from(step));
            let coupled = [[k, 0.3, 0.0, 0.0], [0.3, k, 0.0, 0.0]];
            let mut matrix = DMatrix::zeros(8, 8);
            for i in 0..4 {
                matrix[(i, 4 + i)] = 1.0;
            }
            // places x, X, y, Y; a force −K (x, X), −K (y, Y) and 2 g (y′, −x′)
            for i in 0..2 {
                for j in 0..2 {
                    matrix[(4 + i, j)] = -coupled[i][j];
                    matrix[(6 + i, 2 + j)] = -coupled[i][j];
                }
                matrix[(4 + i, 6 + i)] = 2.0 * g;
                matrix[(6 + i, 4 + i)] = -2.0 * g;
            }
            let values = eigenvalues(matrix);
            assert_eq!(values.len(), 8, "g = {g}, k = {k}");
            for square in [g * g + k + 0.3, g * g + k - 0.3] {
                let root = square.abs().sqrt();
                let expected = if square > 0.0 { [0.0, g + root] } else { [root, g] };
                let near = |z: &&[f64; 2]| {
                    (z[0] - expected[0]).abs() < 1e-7 && (z[1] - expected[1]).abs() < 1e-7
                };
                assert!(values.iter().any(|z| near(&z)), "{expected:?} in {values:?}");
                grown += u32::from(square < 0.0);
            }
        }
        assert!(grown > 0);
    }

    #[test]
    fn what_is_not_finite_has_none() {
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(eigenvalues(DMatrix::from_element(2, 2, bad)).is_empty());
        }
        assert_eq!(eigenvalues(DMatrix::zeros(1, 1)), [[0.0, 0.0]]);
    }
}
