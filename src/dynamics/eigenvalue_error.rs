//! How far the eigenvalues of a matrix are known whose entries are known to some errors.
//!
//! In: a matrix, the errors of its entries, its eigenvalues. Out: the error of each, to first order. Never here: what follows.
//!
//! An eigenvalue with the right and left eigenvectors x and y moves by no more than |y|ᵀ E |x| / |yᴴ x| where the entries of the
//! matrix move by E (J. H. Wilkinson, The Algebraic Eigenvalue Problem, Oxford 1965, ch. 2); equal ones by what the same
//! makes of their eigenspaces. Where there are fewer eigenvectors than equal eigenvalues, |yᴴ x| is 0, and the error to first
//! order has no bound.

use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix};

use super::linear::{EIGENVECTOR, EQUAL, SWEEPS, coupled};
use crate::num::{has_squares, math};

/// What the decomposition adds to each entry of a balanced matrix, as a part of the largest.
const DECOMPOSED: f64 = 8.0 * f64::EPSILON;

/// First-order errors are given this many times: they are estimates.
const TIMES: f64 = 8.0;

/// The error of each of these eigenvalues of a matrix whose entries are known to `error`; infinite where first order gives none.
pub(super) fn eigenvalue_errors(
    matrix: &DMatrix<f64>,
    error: &DMatrix<f64>,
    eigenvalues: &[[f64; 2]],
) -> Vec<f64> {
    let unknown = || vec![f64::INFINITY; eigenvalues.len()];
    if matrix.is_empty() || !has_squares(matrix) {
        return unknown();
    }
    let n = matrix.nrows();
    let mut balanced = matrix.clone();
    let units = balance_parlett_reinsch(&mut balanced);
    let mut error = DMatrix::from_fn(n, n, |i, j| error[(i, j)].abs() * units[j] / units[i]);
    for group in coupled(matrix) {
        let places = || group.iter().flat_map(|&i| group.iter().map(move |&j| (i, j)));
        let largest = places().map(|at| balanced[at].abs()).fold(0.0, f64::max);
        places().for_each(|at| error[at] += DECOMPOSED * largest);
    }
    if error.iter().any(|x| !x.is_finite()) {
        return unknown();
    }
    let of = |&z: &[f64; 2]| {
        let near = |w: &&[f64; 2]| {
            math::hypot(w[0] - z[0], w[1] - z[1]) <= EQUAL * math::hypot(z[0], z[1])
        };
        let count = eigenvalues.iter().filter(near).count().max(1);
        first_order(&balanced, &error, z, count).map_or(f64::INFINITY, |found| TIMES * found)
    };
    eigenvalues.iter().map(of).collect()
}

/// The error of an eigenvalue that is there so many times; `None` where it has no bound to first order.
fn first_order(
    matrix: &DMatrix<f64>,
    error: &DMatrix<f64>,
    [re, im]: [f64; 2],
    count: usize,
) -> Option<f64> {
    let n = matrix.nrows();
    let shifted = DMatrix::from_fn(n, n, |i, j| {
        let (own, turned) = if i == j { (re, im) } else { (0.0, 0.0) };
        Complex::new(matrix[(i, j)] - own, -turned)
    });
    let svd = shifted.try_svd(true, true, f64::EPSILON, SWEEPS)?;
    let (left, right, sizes) = (svd.u?, svd.v_t?, svd.singular_values);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| sizes[a].total_cmp(&sizes[b]));
    let largest = matrix.amax().max(math::hypot(re, im));
    let count = if sizes[*order.get(count - 1)?] <= EIGENVECTOR * largest { count } else { 1 };
    let left = DMatrix::from_fn(n, count, |i, k| left[(i, order[k])]);
    let right = DMatrix::from_fn(n, count, |i, k| right[(order[k], i)].conj());
    let sizes = |m: &DMatrix<Complex<f64>>| m.map(Complex::norm);
    let overlap = (left.adjoint() * &right).try_inverse()?;
    let moved = sizes(&overlap) * sizes(&left).transpose() * error * sizes(&right);
    let most = moved.row_iter().map(|row| row.sum()).fold(0.0, f64::max);
    most.is_finite().then_some(most)
}

#[cfg(test)]
mod tests {
    use super::super::linear;
    use super::*;

    /// The errors of the eigenvalues of a matrix of two rows whose entries are known to a part of the largest, with the
    /// eigenvalues.
    fn of(rows: [[f64; 2]; 2], part: f64) -> Vec<([f64; 2], f64)> {
        let matrix = DMatrix::from_fn(2, 2, |i, j| rows[i][j]);
        let error = DMatrix::from_element(2, 2, part * matrix.amax());
        let values = linear::eigenvalues(&matrix);
        let errors = eigenvalue_errors(&matrix, &error, &values);
        values.into_iter().zip(errors).collect()
    }

    /// λ = 1, 1 + g, and the row above moves them by some E/g: to first order the error of a simple eigenvalue grows as the
    /// distance to the next one falls, and where they are one with one vector there is no bound.
    #[test]
    fn an_error_is_that_of_the_entries_over_the_overlap_of_the_vectors() {
        let errors = |rows: [[f64; 2]; 2]| -> [f64; 2] {
            let found = of(rows, 1e-12);
            [found[0].1, found[1].1]
        };
        for gap in [1e-1, 1e-2, 1e-3] {
            let expected = TIMES * 1e-12 / gap;
            for error in [errors([[1.0, 1.0], [0.0, 1.0 + gap]])].as_flattened() {
                assert!((0.5 * expected..3.0 * expected).contains(error), "{gap} {error:e}");
            }
        }
        let defective = errors([[1.0, 1.0], [0.0, 1.0]]);
        assert!(defective[0] > 1e-6 && defective[1] > 1e-6, "{defective:?}");
        // equal eigenvalues with as many vectors move by no more than the entries
        let equal = errors([[1.0, 0.0], [0.0, 1.0]]);
        assert!(equal.iter().all(|error| (4e-12..4e-11).contains(error)), "{equal:?}");
    }

    /// What the entries really do to the eigenvalues stays below the error, and reaches a hundredth of it.
    #[test]
    fn eigenvalues_move_by_less_than_their_errors() {
        let rows = [[0.0, 1.0, 0.0, 0.0], [-2.0, -1e-9, 0.3, 0.1]];
        let others = [[0.0, 0.0, 0.0, 1.0], [0.4, -0.1, -1.5, 1e-7]];
        let matrix =
            DMatrix::from_fn(4, 4, |i, j| if i < 2 { rows[i][j] } else { others[i - 2][j] });
        let size = 1e-8;
        let error = DMatrix::from_element(4, 4, size);
        let values = linear::eigenvalues(&matrix);
        let errors = eigenvalue_errors(&matrix, &error, &values);
        let mut most = 0.0_f64;
        for k in 0..40 {
            let sign = |i: usize, j: usize| math::sin((3 * i + 5 * j + 7 * k + 1) as f64).signum();
            let moved = &matrix + DMatrix::from_fn(4, 4, |i, j| size * sign(i, j));
            for w in linear::eigenvalues(&moved) {
                let off = |z: &[f64; 2]| math::hypot(z[0] - w[0], z[1] - w[1]);
                let nearest = (0..4).min_by(|&a, &b| off(&values[a]).total_cmp(&off(&values[b])));
                let nearest = nearest.expect("there are four");
                let part = off(&values[nearest]) / errors[nearest];
                assert!(part < 1.0, "{w:?} {part}");
                most = most.max(part);
            }
        }
        assert!(most > 0.01, "{most}");
    }

    /// A mode of 1e-7 beside one of 1e7 that does not act on it is known to its own digits, and to those of the other where it
    /// does.
    #[test]
    fn what_is_slow_is_known_beside_what_is_fast() {
        let (slow, fast) = (1e-7, 1e7);
        let matrix = |coupled: f64| {
            DMatrix::from_row_slice(
                3,
                3,
                &[0.0, fast, 0.0, -fast, 0.0, coupled, coupled, 0.0, slow],
            )
        };
        let none = DMatrix::zeros(3, 3);
        let alone = eigenvalue_errors(&matrix(0.0), &none, &[[slow, 0.0]])[0];
        assert!(alone < 1e-12 * slow, "{alone:e}");
        let beside = eigenvalue_errors(&matrix(1e-3), &none, &[[slow, 0.0]])[0];
        assert!((1e-9..1e-6).contains(&beside), "{beside:e}");
    }
}
