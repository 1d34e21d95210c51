//! Whether a determinant vanishes, by its values at points.
//!
//! In: a matrix of expressions, or of numbers. Out: the size of the determinant with all rows and columns in units of their
//! largest entries. Never here: what the matrix means.

use nalgebra::DMatrix;

use super::valuation::Valuation;
use crate::expr::{Expr, Pool};

/// A determinant counts as zero up to this part of its terms.
const DEPENDENT: f64 = 1e-10;

/// Whether the determinant of a square matrix vanishes at all points where it has a value: to rounding of the terms of its
/// entries, each row relative to its largest.
pub(super) fn singular(pool: &Pool, matrix: &[Vec<Expr>], points: &[Valuation]) -> bool {
    let n = matrix.len();
    let determinants = points.iter().map(|at| {
        let entry = |i: usize, j: usize| {
            let (value, size) = pool.evaluate_with_size(matrix[i][j], &|s| at.at(s));
            if value.abs() <= DEPENDENT * size { 0.0 } else { value }
        };
        scaled_determinant(DMatrix::from_fn(n, n, entry))
    });
    let known: Vec<f64> = determinants.filter(|size| size.is_finite()).collect();
    !known.is_empty() && known.iter().all(|size| *size <= DEPENDENT)
}

/// The size of the determinant of a square matrix with its rows, then its columns, divided by their largest entries.
pub(super) fn scaled_determinant(mut values: DMatrix<f64>) -> f64 {
    for k in 0..values.nrows() {
        let largest = values.row(k).amax();
        if largest > 0.0 {
            values.row_mut(k).unscale_mut(largest);
        }
    }
    for k in 0..values.ncols() {
        let largest = values.column(k).amax();
        if largest > 0.0 {
            values.column_mut(k).unscale_mut(largest);
        }
    }
    values.determinant().abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Number;

    #[test]
    fn a_determinant_vanishes_to_1e_10_of_its_terms() {
        for (off, vanishes) in [(0.9e-10, true), (1.1e-10, false)] {
            let mut pool = Pool::new();
            // the terms of the last entry are off, −1 and 1, or the rows differ by it
            let x = pool.symbol("x");
            let symbol = pool.variable(x);
            let number = pool.number(Number::Real(1.0 + off));
            let one = pool.number(Number::ONE);
            let matrix = vec![vec![symbol, symbol], vec![one, number]];
            for size in [1e-20, 1.0, 1e20] {
                let at = Valuation::default().with([(x, size)]);
                assert_eq!(singular(&pool, &matrix, &[at]), vanishes, "{off} {size}");
            }
        }
    }
}
