//! Dense linear equations, factored with pivoting: `P M = L U` by rows of comparable scale
//! (Golub & Van Loan, Matrix Computations, 3.4).

use crate::expr::Real;

/// A pivot smaller than this, measured by its row, is none.
const SMALLEST_PIVOT: f64 = 1e-13;

/// A factored matrix of one block.
#[derive(Clone, Debug)]
pub(super) struct Factored<R> {
    size: usize,
    entries: Vec<R>,
    rows: Vec<usize>,
    scales: Vec<f64>,
    scratch: Vec<R>,
}

impl<R: Real> Factored<R> {
    pub(super) fn new(size: usize) -> Factored<R> {
        Factored {
            size,
            entries: vec![R::ZERO; size * size],
            rows: (0..size).collect(),
            scales: vec![0.0; size],
            scratch: vec![R::ZERO; size],
        }
    }

    /// Factors the matrix whose entries `entry` gives by row and column. False where it is
    /// singular; a matrix with an entry that is not finite counts as regular and spreads it.
    #[must_use]
    pub(super) fn factor(&mut self, entry: impl Fn(usize, usize) -> R) -> bool {
        let n = self.size;
        let mut finite = true;
        for i in 0..n {
            self.rows[i] = i;
            let mut scale = 0.0_f64;
            for j in 0..n {
                let x = entry(i, j);
                finite &= x.value().is_finite();
                self.entries[i * n + j] = x;
                scale = scale.max(x.value().abs());
            }
            self.scales[i] = scale;
        }
        if !finite {
            return true;
        }
        for k in 0..n {
            let size = |i: &usize| self.entries[i * n + k].value().abs() / self.scales[*i];
            let Some(best) =
                (k..n).max_by(|&a, &b| size(&self.rows[a]).total_cmp(&size(&self.rows[b])))
            else {
                return false;
            };
            self.rows.swap(k, best);
            let pivot_row = self.rows[k];
            // a row of zeros has no scale, and its quotient is not a number
            let pivot = size(&pivot_row);
            if pivot.is_nan() || pivot <= SMALLEST_PIVOT || self.scales[pivot_row] == 0.0 {
                return false;
            }
            let pivot = self.entries[pivot_row * n + k];
            for &row in &self.rows[k + 1..] {
                let factor = self.entries[row * n + k] / pivot;
                self.entries[row * n + k] = factor;
                for j in k + 1..n {
                    let product = factor * self.entries[pivot_row * n + j];
                    self.entries[row * n + j] = self.entries[row * n + j] - product;
                }
            }
        }
        true
    }

    /// Solves for a right-hand side, in place.
    pub(super) fn solve(&mut self, right: &mut [R]) {
        let n = self.size;
        for k in 0..n {
            let row = self.rows[k];
            let mut sum = right[row];
            for j in 0..k {
                sum = sum - self.entries[row * n + j] * self.scratch[j];
            }
            self.scratch[k] = sum;
        }
        for k in (0..n).rev() {
            let row = self.rows[k];
            let mut sum = self.scratch[k];
            for j in k + 1..n {
                sum = sum - self.entries[row * n + j] * right[j];
            }
            right[k] = sum / self.entries[row * n + k];
        }
    }
}
