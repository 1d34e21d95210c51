//! The space spanned by rows of constraints: an orthonormal basis, its volume and its orientation.
//!
//! In: rows. Out: angles and volumes. Never here: where the rows come from.

/// The orientation of rows is not trusted if an orthogonal component is smaller than this: the rounding of
/// an entry may be 1e-15 of its row.
const SPANS: f64 = 1e-12;

/// Rows orthonormalised one after the other.
#[derive(Clone, Debug)]
pub(super) struct Basis {
    pub(super) rows: Vec<Vec<f64>>,
    /// The volume spanned by the rows before normalisation.
    pub(super) volume: f64,
}

impl Basis {
    /// Adds a row. Returns the sine of its angle to the span of those before it, or `None` if the
    /// row vanishes.
    pub(super) fn add(&mut self, mut rest: Vec<f64>) -> Option<f64> {
        let size = norm(&rest);
        if size == 0.0 || !size.is_finite() {
            self.rows.push(vec![0.0; rest.len()]);
            return None;
        }
        for x in &mut rest {
            *x /= size;
        }
        // two passes are enough (Golub & Van Loan, Matrix Computations, 5.2.9)
        for other in self.rows.iter().chain(&self.rows) {
            let part: f64 = rest.iter().zip(other).map(|(x, y)| x * y).sum();
            rest.iter_mut().zip(other).for_each(|(x, y)| *x -= part * y);
        }
        let left = norm(&rest);
        self.volume *= size * left;
        let scale = if left > 0.0 { 1.0 / left } else { 0.0 };
        self.rows.push(rest.iter().map(|x| x * scale).collect());
        Some(left)
    }

    /// The basis of the span of rows, or `None` if they are dependent.
    pub(super) fn spanned_by(rows: impl Iterator<Item = Vec<f64>>) -> Option<Basis> {
        let mut basis = Basis { rows: Vec::new(), volume: 1.0 };
        for row in rows {
            basis.add(row).filter(|&left| left > SPANS)?;
        }
        Some(basis)
    }

    pub(super) fn drop_last(&mut self) {
        self.rows.pop();
    }
}

/// The space spanned by the rows of constraints, with its orientation.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct ConstraintSpan {
    /// Orthonormal rows, with the orientation of the constraints' own rows.
    pub(super) rows: Vec<Vec<f64>>,
    /// The volume spanned by the constraints' own rows.
    pub(super) volume: f64,
    pub(super) units: Vec<f64>,
}

impl ConstraintSpan {
    /// The units of the coordinates the span was computed in.
    pub(super) fn units(&self) -> &[f64] {
        &self.units
    }

    /// The volume that the rows of the constraints span, in these units.
    pub(super) fn volume(&self) -> f64 {
        self.volume
    }

    /// The cosine of the angle between two such spaces: 1 if they are equal, −1 if they are equal
    /// with the opposite orientation. It is the determinant of the rows' inner products.
    pub(super) fn cosine(&self, other: &ConstraintSpan) -> f64 {
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let mut matrix: Vec<Vec<f64>> =
            self.rows.iter().map(|a| other.rows.iter().map(|b| product(a, b)).collect()).collect();
        let n = matrix.len();
        let mut determinant = 1.0;
        for k in 0..n {
            let largest = (k..n).max_by(|&a, &b| matrix[a][k].abs().total_cmp(&matrix[b][k].abs()));
            let Some(best) = largest.filter(|&best| matrix[best][k] != 0.0) else { return 0.0 };
            if best != k {
                matrix.swap(best, k);
                determinant = -determinant;
            }
            determinant *= matrix[k][k];
            for i in k + 1..n {
                let factor = matrix[i][k] / matrix[k][k];
                for j in k..n {
                    let product = factor * matrix[k][j];
                    matrix[i][j] -= product;
                }
            }
        }
        determinant
    }
}

/// The Euclidean norm.
pub(super) fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_directions_a_trillionth_apart_span_a_plane() {
        let spans = |angle: f64| {
            let rows = [vec![1.0, 0.0], vec![3.0, 3.0 * angle]];
            Basis::spanned_by(rows.into_iter()).map(|basis| basis.volume)
        };
        assert_eq!(spans(0.0), None);
        assert_eq!(spans(0.9e-12), None);
        assert_eq!(spans(1.1e-12), Some(3.0 * 1.1e-12));
    }
}
