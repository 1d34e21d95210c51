//! Linear algebra of small matrices: eigenvalues, least squares.

use nalgebra::linalg::SymmetricEigen;
use nalgebra::{Complex, DMatrix, DVector};

use crate::num;

/// The maximal number of iterations of a decomposition.
pub(super) const SWEEPS: usize = 10_000;

/// What is less than this part of the largest eigenvalue is rounding of a small matrix.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Two eigenvalues are equal up to this part: a pair without two eigenvectors differs by the root of rounding.
pub(super) const EQUAL: f64 = 1e-6;

/// Singular values up to this part of the largest entry are rounding of a matrix in balanced units.
const KERNEL: f64 = 1e-12;

/// The eigenvalues of a matrix as real and imaginary parts, by falling modulus, of a pair the
/// positive imaginary part first; empty if they cannot be found.
pub(super) fn eigenvalues(matrix: &DMatrix<f64>) -> Vec<[f64; 2]> {
    let mut values = num::eigenvalues(matrix.clone());
    sort(&mut values);
    values
}

/// Sorts eigenvalues by falling modulus, of a pair the positive imaginary part first.
fn sort(values: &mut [[f64; 2]]) {
    let modulus = |z: &[f64; 2]| z[0] * z[0] + z[1] * z[1];
    values.sort_by(|a, b| {
        let (x, y) = (modulus(a), modulus(b));
        // of a pair rounding must not decide
        if (x - y).abs() <= 1e-12 * x.max(y) {
            b[0].total_cmp(&a[0]).then(b[1].total_cmp(&a[1]))
        } else {
            y.total_cmp(&x)
        }
    });
}

/// The same of a matrix of rates, whose eigenvalues all are in one unit: real and imaginary parts that are rounding of the
/// largest are 0. Rounding stays among variables that act on each other, so that what is slow beside something fast on which it does
/// not act is known as well as that.
pub(super) fn rates(matrix: &DMatrix<f64>) -> Vec<[f64; 2]> {
    let parts = coupled(matrix);
    let mut values: Vec<[f64; 2]> = Vec::new();
    for part in &parts {
        let own = DMatrix::from_fn(part.len(), part.len(), |i, j| matrix[(part[i], part[j])]);
        let own = num::eigenvalues(own);
        if own.len() < part.len() {
            return Vec::new();
        }
        let largest = own.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        let known = |x: f64| if x.abs() <= ROUNDING * largest { 0.0 } else { x };
        values.extend(own.into_iter().map(|z| z.map(known)));
    }
    sort(&mut values);
    values
}

/// The variables of a matrix in groups that act on each other, directly or by way of others: the matrix is block triangular with
/// a block for each.
pub(super) fn coupled(matrix: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let n = matrix.nrows();
    let mut acts = DMatrix::from_fn(n, n, |i, j| i == j || matrix[(i, j)] != 0.0);
    for k in 0..n {
        for i in (0..n).filter(|&i| i != k) {
            if acts[(i, k)] {
                for j in 0..n {
                    acts[(i, j)] |= acts[(k, j)];
                }
            }
        }
    }
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for i in 0..n {
        let own = groups.iter_mut().find(|group| acts[(i, group[0])] && acts[(group[0], i)]);
        match own {
            Some(group) => group.push(i),
            None => groups.push(vec![i]),
        }
    }
    groups
}

/// The same of a matrix with a kernel of at least this dimension that is known to be one but for rounding: without its vectors, which
/// others of a Jordan block lead to, no zero eigenvalue is the root of a rounding error.
pub(super) fn rates_beside_kernel(matrix: &DMatrix<f64>, kernel: usize) -> Option<Vec<[f64; 2]>> {
    let (mut rest, mut known, mut zeros) = (matrix.clone(), kernel, 0);
    while rest.nrows() > 0 {
        let SingularValues { sizes, right, .. } = singular_values(&rest)?;
        let count = sizes.len();
        let rounding = KERNEL * matrix.amax();
        let null = sizes.iter().filter(|size| **size <= rounding).count().max(known).min(count);
        if null == 0 {
            break;
        }
        let others = right.columns(0, count - null);
        rest = others.transpose() * &rest * others;
        (zeros, known) = (zeros + null, 0);
    }
    let mut values = if rest.nrows() > 0 { rates(&rest) } else { Vec::new() };
    values.resize(values.len() + zeros, [0.0, 0.0]);
    Some(values)
}

/// The solution of A x = b of least norm in the sense of least squares; singular values up to
/// `cut` count as zero.
pub(super) fn least_squares(a: &DMatrix<f64>, b: &DVector<f64>, cut: f64) -> Option<DVector<f64>> {
    if a.iter().chain(b.iter()).any(|x| !x.is_finite()) {
        return None;
    }
    let svd = a.clone().try_svd(true, true, f64::EPSILON, SWEEPS)?;
    let largest = svd.singular_values.max();
    svd.solve(b, cut.max(1e-12 * largest)).ok().filter(|x| x.iter().all(|x| x.is_finite()))
}

/// The singular values of a matrix, the largest first, with unit vectors as columns: A = Σ sᵢ lᵢ rᵢᵀ.
pub(super) struct SingularValues {
    pub(super) sizes: DVector<f64>,
    pub(super) left: DMatrix<f64>,
    pub(super) right: DMatrix<f64>,
}

/// The singular values of a matrix of finite entries.
pub(super) fn singular_values(matrix: &DMatrix<f64>) -> Option<SingularValues> {
    if matrix.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let svd = matrix.clone().try_svd(true, true, f64::EPSILON, SWEEPS)?;
    Some(SingularValues { sizes: svd.singular_values, left: svd.u?, right: svd.v_t?.transpose() })
}

/// Unit vectors that span what a matrix takes to zero: up to a part `cut` of what it does to others.
/// There is at least one.
pub(super) fn kernel(matrix: &DMatrix<f64>, cut: f64) -> Vec<DVector<f64>> {
    let (rows, columns) = matrix.shape();
    // as many rows as columns at least, so that all right singular vectors are there
    let full = matrix.clone().resize_vertically(rows.max(columns), 0.0);
    let Some(svd) = full.try_svd(false, true, f64::EPSILON, SWEEPS) else { return Vec::new() };
    let Some(vectors) = svd.v_t else { return Vec::new() };
    let (largest, least) = (svd.singular_values.max(), svd.singular_values.min());
    let small = |i: &usize| svd.singular_values[*i] <= (cut * largest).max(least);
    (0..columns).filter(small).map(|i| vectors.row(i).transpose()).collect()
}

/// A singular vector is a new one if this much of it lies outside those before it.
const NEW: f64 = 0.1;

/// Eigenvalues of a square below this part of its greatest belong to vectors that the matrix takes to nearly zero.
const NULL: f64 = 1e-10;

/// A vector that a matrix takes to nearly zero, with all its digits: the eigenvectors of the square have half of them.
fn refined(
    vector: &DVector<f64>,
    matrix: &DMatrix<f64>,
    square: &SymmetricEigen<f64, nalgebra::Dyn>,
) -> DVector<f64> {
    let mut vector = vector.clone();
    let least = NULL * square.eigenvalues.amax();
    if (matrix * &vector).norm_squared() > least {
        return vector;
    }
    for _ in 0..REFINEMENTS {
        let left = matrix.transpose() * (matrix * &vector);
        let others = square.eigenvalues.iter().zip(square.eigenvectors.column_iter());
        for (value, other) in others.filter(|(value, _)| **value > least) {
            vector -= other * (other.dot(&left) / value);
        }
    }
    vector
}

/// Each gains half of all digits.
const REFINEMENTS: usize = 2;

/// What the matrix minus i ω takes to zero up to this part of the largest of its entries is its eigenvector.
pub(super) const EIGENVECTOR: f64 = 1e-5;

/// Orthonormal vectors that the matrix minus i ω takes to (nearly) zero, the best first; there is one at least.
pub(super) fn null_vectors(matrix: &DMatrix<f64>, omega: f64) -> Vec<DVector<Complex<f64>>> {
    let n = matrix.nrows();
    // the power of two of the size, so that no digit changes and no square under- or overflows
    let size = f64::from_bits(matrix.amax().max(omega).to_bits() & f64::INFINITY.to_bits());
    if !size.is_normal() {
        return Vec::new();
    }
    // the matrix of real and imaginary parts, of which each right singular vector v is one as v and as i v: several equal
    // ones are mixed
    let (shift, part) = (omega / size, |i: usize, j: usize| matrix[(i, j)] / size);
    let parts = DMatrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, true) => part(i, j),
        (false, false) => part(i - n, j - n),
        (true, false) if i + n == j => shift,
        (false, true) if i == j + n => -shift,
        _ => 0.0,
    });
    let square = parts.transpose() * &parts;
    let Some(eigen) = SymmetricEigen::try_new(square, f64::EPSILON, SWEEPS) else {
        return Vec::new();
    };
    let mut order: Vec<usize> = (0..2 * n).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let mut found: Vec<DVector<Complex<f64>>> = Vec::new();
    for k in order {
        let both = refined(&eigen.eigenvectors.column(k).into_owned(), &parts, &eigen);
        if !found.is_empty() && (&parts * &both).norm() > EIGENVECTOR * both.norm() {
            break;
        }
        let mut vector = DVector::from_fn(n, |i, _| Complex::new(both[i], both[i + n]));
        for _ in 0..2 {
            for one in &found {
                let along = one.dotc(&vector);
                vector -= one * along;
            }
        }
        let length = vector.norm();
        if length >= NEW {
            found.push(vector.unscale(length));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rotation by the rate 2 beside what hardly moves: with the rows mixed, rounding of 2 is not distinguished from 0, 1e-13 is; where
    /// neither acts on the other, both are known.
    #[test]
    fn rates_that_are_rounding_of_the_largest_are_zero() {
        let of = |small: f64, mixed: bool| {
            let parts = [[0.0, 2.0, 0.0], [-2.0, 0.0, 0.0], [0.0, 0.0, small]];
            let apart = DMatrix::from_fn(3, 3, |i, j| parts[i][j]);
            let turn = [[1.0, 0.0, 0.0], [0.0, 0.6, -0.8], [0.0, 0.8, 0.6]];
            let turn = DMatrix::from_fn(3, 3, |i, j| turn[i][j]);
            rates(&if mixed { &turn * apart * turn.transpose() } else { apart })
        };
        let found = of(1e-15, true);
        assert!((found[0][1] - 2.0).abs() < 1e-14 && found[0][0] == 0.0, "{found:?}");
        assert_eq!(found[2], [0.0, 0.0]);
        let known = of(1e-13, true)[2];
        assert!((known[0] - 1e-13).abs() < 5e-15 && known[1] == 0.0, "{known:?}");
        assert_eq!(of(1e-15, false)[2], [1e-15, 0.0]);
    }
}
