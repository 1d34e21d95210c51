//! Dense linear equations, factored with pivoting: `P M = L U` with rows of comparable scale (Golub
//! & Van Loan, Matrix Computations, 3.4) and columns scaled by the units of their unknowns.

use crate::num::Real;

/// A pivot smaller than this, relative to its row, counts as zero.
const SMALLEST_PIVOT: f64 = 1e-13;

/// The factored matrix of one block.
#[derive(Clone, Debug)]
pub struct Factored<R> {
    size: usize,
    entries: Vec<R>,
    rows: Vec<usize>,
    /// The unit of each unknown, and the size of each row in these units.
    units: Vec<f64>,
    scales: Vec<f64>,
    scratch: Vec<R>,
}

impl<R: Real> Factored<R> {
    pub(super) fn new(size: usize) -> Factored<R> {
        Factored {
            size,
            entries: vec![R::ZERO; size * size],
            rows: (0..size).collect(),
            units: vec![1.0; size],
            scales: vec![0.0; size],
            scratch: vec![R::ZERO; size],
        }
    }

    /// Factors the matrix whose entries `entry` gives by row and column. Returns false if it is
    /// singular; a matrix with an entry that is not finite counts as regular and propagates it.
    #[must_use]
    pub(super) fn factor(&mut self, mut entry: impl FnMut(usize, usize) -> R) -> bool {
        let n = self.size;
        let mut finite = true;
        for i in 0..n {
            self.rows[i] = i;
            for j in 0..n {
                let x = entry(i, j);
                finite &= x.value().is_finite();
                self.entries[i * n + j] = x;
            }
        }
        if !finite {
            return true;
        }
        self.measure();
        for k in 0..n {
            let unit = self.units[k];
            let size = |i: &usize| self.entries[i * n + k].value().abs() * unit / self.scales[*i];
            let Some(best) =
                (k..n).max_by(|&a, &b| size(&self.rows[a]).total_cmp(&size(&self.rows[b])))
            else {
                return false;
            };
            self.rows.swap(k, best);
            let pivot_row = self.rows[k];
            // a row of zeros has no scale, so its quotient is NaN
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

    /// Finds units in which the diagonal is 1: in a mass matrix 1/√Mᵢᵢ, whatever the units of the
    /// masses (van der Sluis, Numer. Math. 14, 1969: nearly the best scaling of a symmetric
    /// matrix). An unknown without a diagonal entry, as a constraint or a coordinate without mass,
    /// takes its unit from the largest entry that couples it to one that has.
    fn measure(&mut self) {
        let n = self.size;
        let at = |i: usize, j: usize| self.entries[i * n + j].value().abs();
        let unit = |size: f64| Some(1.0 / size).filter(|x| x.is_normal());
        let mut all = true;
        for i in 0..n {
            let own = unit(at(i, i).sqrt());
            self.units[i] = own.unwrap_or(1.0);
            all &= own.is_some();
        }
        let mut units: Vec<Option<f64>> = Vec::new();
        if !all {
            units.extend((0..n).map(|i| unit(at(i, i).sqrt())));
        }
        while units.contains(&None) {
            let known = units.clone();
            for i in (0..n).filter(|&i| known[i].is_none()) {
                let ties = (0..n).filter_map(|j| known[j].map(|c| at(i, j) * c));
                units[i] = unit(ties.fold(0.0, f64::max));
            }
            if units == known {
                break;
            }
        }
        for (own, found) in self.units.iter_mut().zip(&units) {
            *own = found.unwrap_or(1.0);
        }
        for i in 0..n {
            self.scales[i] = (0..n).map(|j| at(i, j) * self.units[j]).fold(0.0, f64::max);
        }
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
