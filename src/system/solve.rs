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
    /// The entries right of the pivots over these, once something is [solved again](Factored::solve_again).
    upper: Vec<R>,
    is_scaled: bool,
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
            upper: vec![R::ZERO; size * size],
            is_scaled: false,
            units: vec![1.0; size],
            scales: vec![0.0; size],
            scratch: vec![R::ZERO; size],
        }
    }

    /// Factors the matrix whose entries `entry` gives by row and column. Returns false if it is
    /// singular; a matrix with an entry that is not finite counts as regular and propagates it.
    #[must_use]
    pub(super) fn factor(&mut self, entry: impl FnMut(usize, usize) -> R) -> bool {
        self.factor_with::<false>(entry)
    }

    /// The same, which with `FUSED` must be inlined into a [`Kernel`](crate::num::Kernel).
    #[must_use]
    #[inline(always)]
    pub(super) fn factor_with<const FUSED: bool>(
        &mut self,
        entry: impl FnMut(usize, usize) -> R,
    ) -> bool {
        self.is_scaled = false;
        // loops of a known length are unrolled
        match self.size {
            1 => self.take_only(entry),
            2 => self.factor_of::<2, FUSED>(entry),
            3 => self.factor_of::<3, FUSED>(entry),
            4 => self.factor_of::<4, FUSED>(entry),
            _ => self.factor_of::<0, FUSED>(entry),
        }
    }

    /// The same for one number, which is singular only where it is zero.
    #[inline(always)]
    fn take_only(&mut self, mut entry: impl FnMut(usize, usize) -> R) -> bool {
        let only = entry(0, 0);
        self.entries[0] = only;
        only.value() != 0.0
    }

    /// The same for a size that is known, or for any where that is zero.
    #[inline(always)]
    fn factor_of<const SIZE: usize, const FUSED: bool>(
        &mut self,
        mut entry: impl FnMut(usize, usize) -> R,
    ) -> bool {
        let n = if SIZE == 0 { self.size } else { SIZE };
        let (entries, rows) = (&mut self.entries[..n * n], &mut self.rows[..n]);
        let mut finite = true;
        for i in 0..n {
            rows[i] = i;
            for j in 0..n {
                let x = entry(i, j);
                finite &= x.value().is_finite();
                entries[i * n + j] = x;
            }
        }
        if !finite {
            return true;
        }
        let (units, scales) = (&mut self.units[..n], &mut self.scales[..n]);
        measure(entries, units, scales);
        for k in 0..n {
            let unit = units[k];
            let size = |i: usize| entries[i * n + k].value().abs() * unit / scales[i];
            let (mut best, mut largest) = (k, size(rows[k]));
            for (at, &row) in rows.iter().enumerate().skip(k + 1) {
                let size = size(row);
                // of equal ones the last
                if size.total_cmp(&largest).is_ge() {
                    (best, largest) = (at, size);
                }
            }
            rows.swap(k, best);
            let pivot_row = rows[k];
            // a row of zeros has no scale, so its quotient is NaN
            if largest.is_nan() || largest <= SMALLEST_PIVOT || scales[pivot_row] == 0.0 {
                return false;
            }
            let pivot = entries[pivot_row * n + k];
            for at in k + 1..n {
                let row = rows[at];
                let factor = entries[row * n + k].divided_by::<FUSED>(pivot);
                entries[row * n + k] = factor;
                for j in k + 1..n {
                    let product = factor.times::<FUSED>(entries[pivot_row * n + j]);
                    entries[row * n + j] = entries[row * n + j] - product;
                }
            }
        }
        true
    }

    /// Takes the factors of a matrix in another precision.
    pub(super) fn take_over<S: Real>(&mut self, other: &Factored<S>) {
        self.is_scaled = false;
        self.rows.copy_from_slice(&other.rows);
        self.entries.iter_mut().zip(&other.entries).for_each(|(x, y)| *x = R::of(y.double()));
    }

    #[cfg(target_arch = "x86_64")]
    pub(super) fn size(&self) -> usize {
        self.size
    }

    /// The factored rows in the order of the pivots, each with its place in the matrix.
    #[cfg(target_arch = "x86_64")]
    pub(super) fn rows(&self) -> impl Iterator<Item = (usize, &[R])> {
        self.rows.iter().map(|&row| (row, &self.entries[row * self.size..][..self.size]))
    }

    /// Solves for a right-hand side, in place.
    pub(super) fn solve(&mut self, right: &mut [R]) {
        self.solve_with::<false>(right);
    }

    /// The same, which with `FUSED` must be inlined into a [`Kernel`](crate::num::Kernel).
    #[inline(always)]
    pub(super) fn solve_with<const FUSED: bool>(&mut self, right: &mut [R]) {
        match self.size {
            1 => self.solve_of::<1, FUSED>(right),
            2 => self.solve_of::<2, FUSED>(right),
            3 => self.solve_of::<3, FUSED>(right),
            4 => self.solve_of::<4, FUSED>(right),
            _ => self.solve_of::<0, FUSED>(right),
        }
    }

    #[inline(always)]
    fn solve_of<const SIZE: usize, const FUSED: bool>(&mut self, right: &mut [R]) {
        let n = if SIZE == 0 { self.size } else { SIZE };
        self.eliminate::<SIZE, FUSED>(right);
        let (entries, rows, scratch) = (&self.entries[..n * n], &self.rows[..n], &self.scratch);
        let right = &mut right[..n];
        for k in (0..n).rev() {
            let row = rows[k];
            let mut sum = scratch[k];
            for j in k + 1..n {
                sum = sum - entries[row * n + j].times::<FUSED>(right[j]);
            }
            right[k] = sum.divided_by::<FUSED>(entries[row * n + k]);
        }
    }

    /// The same for one of many right-hand sides, with a way to divide by a pivot. All divisions come before the first unknown is
    /// known, so that none waits for another: `P M = L D U` with ones on both diagonals. With `FUSED` it must be inlined into a
    /// [`Kernel`](crate::num::Kernel).
    #[inline(always)]
    pub(super) fn solve_again<const FUSED: bool>(
        &mut self,
        right: &mut [R],
        over: impl Fn(R, R) -> R,
    ) {
        match self.size {
            1 => self.solve_again_of::<1, FUSED>(right, over),
            2 => self.solve_again_of::<2, FUSED>(right, over),
            3 => self.solve_again_of::<3, FUSED>(right, over),
            4 => self.solve_again_of::<4, FUSED>(right, over),
            _ => self.solve_again_of::<0, FUSED>(right, over),
        }
    }

    #[inline(always)]
    fn solve_again_of<const SIZE: usize, const FUSED: bool>(
        &mut self,
        right: &mut [R],
        over: impl Fn(R, R) -> R,
    ) {
        let n = if SIZE == 0 { self.size } else { SIZE };
        self.eliminate::<SIZE, FUSED>(right);
        let (entries, rows) = (&self.entries[..n * n], &self.rows[..n]);
        let upper = &mut self.upper[..n * n];
        if !self.is_scaled {
            self.is_scaled = true;
            for k in 0..n {
                let row = &entries[rows[k] * n..][..n];
                for j in k + 1..n {
                    upper[k * n + j] = over(row[j], row[k]);
                }
            }
        }
        let right = &mut right[..n];
        for k in 0..n {
            right[k] = over(self.scratch[k], entries[rows[k] * n + k]);
        }
        for k in (0..n).rev() {
            let mut sum = right[k];
            // the one that was found last comes last
            for j in (k + 1..n).rev() {
                let product = upper[k * n + j].times_unnormalized::<FUSED>(right[j]);
                sum = sum.plus_unnormalized(-product);
            }
            right[k] = sum.renormalized();
        }
    }

    /// Solves `L y = P right` into the scratch numbers.
    #[inline(always)]
    fn eliminate<const SIZE: usize, const FUSED: bool>(&mut self, right: &[R]) {
        let n = if SIZE == 0 { self.size } else { SIZE };
        let (entries, rows) = (&self.entries[..n * n], &self.rows[..n]);
        let (right, scratch) = (&right[..n], &mut self.scratch[..n]);
        for k in 0..n {
            let row = rows[k];
            let mut sum = right[row];
            for j in 0..k {
                let product = entries[row * n + j].times_unnormalized::<FUSED>(scratch[j]);
                sum = sum.plus_unnormalized(-product);
            }
            scratch[k] = sum.renormalized();
        }
    }
}

/// Finds units in which the diagonal is 1: in a mass matrix 1/√Mᵢᵢ, whatever the units of the
/// masses (van der Sluis, Numer. Math. 14, 1969: nearly the best scaling of a symmetric
/// matrix). An unknown without a diagonal entry, as a constraint or a coordinate without mass,
/// takes its unit from the largest entry that couples it to one that has.
#[inline]
fn measure<R: Real>(entries: &[R], units: &mut [f64], scales: &mut [f64]) {
    let n = units.len();
    let at = |i: usize, j: usize| entries[i * n + j].value().abs();
    let unit = |size: f64| Some(1.0 / size).filter(|x| x.is_normal());
    let mut all = true;
    for i in 0..n {
        let own = unit(at(i, i).sqrt());
        units[i] = own.unwrap_or(1.0);
        all &= own.is_some();
    }
    if !all {
        measure_by_couplings(n, at, units);
    }
    for i in 0..n {
        let mut largest = 0.0_f64;
        for j in 0..n {
            largest = largest.max(at(i, j) * units[j]);
        }
        scales[i] = largest;
    }
}

/// The units where some diagonal entry gives none.
#[inline(never)]
fn measure_by_couplings(n: usize, at: impl Fn(usize, usize) -> f64, out: &mut [f64]) {
    let unit = |size: f64| Some(1.0 / size).filter(|x| x.is_normal());
    let mut units: Vec<Option<f64>> = (0..n).map(|i| unit(at(i, i).sqrt())).collect();
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
    for (own, found) in out.iter_mut().zip(&units) {
        *own = found.unwrap_or(1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::{DoubleDouble, Kernel, vectorized};

    /// Whether a matrix is regular that has 1 in its corners and on its diagonal, but a little more at the end.
    fn is_regular(size: usize, more: f64) -> bool {
        let last = size - 1;
        Factored::<f64>::new(size).factor(|i, j| match (i, j) {
            _ if (i, j) == (last, last) => 1.0 + more,
            (i, j) => f64::from(u8::from(i == j || (i, j) == (0, last) || (i, j) == (last, 0))),
        })
    }

    #[test]
    fn what_is_solved_again_has_the_same_solution() {
        for size in 1..=6 {
            // the largest entries are beside the diagonal
            let entry = |i: usize, j: usize| {
                let large = if (i + 1) % size == j { 2.0 } else { 0.0 };
                large + 1.0 / (1.0 + i as f64 + 2.0 * j as f64)
            };
            let mut factored = Factored::<f64>::new(size);
            let unknown = |j: usize| 1.5 - j as f64;
            // each matrix has its own scaled rows
            for sign in [1.0, -1.0] {
                assert!(factored.factor(|i, j| sign * entry(i, j)));
                for _ in 0..2 {
                    let row =
                        |i: usize| (0..size).map(|j| sign * entry(i, j) * unknown(j)).sum::<f64>();
                    let mut right: Vec<f64> = (0..size).map(row).collect();
                    factored.solve_again::<false>(&mut right, |x, pivot| x / pivot);
                    for (j, x) in right.iter().enumerate() {
                        assert!((x - unknown(j)).abs() < 1e-12, "{size}: {right:?}");
                    }
                }
            }
        }
    }

    /// The solution for 1, 1/2, 1/3, … of a matrix with entries of all digits.
    struct Solution(usize);

    impl Kernel for Solution {
        type Output = Vec<DoubleDouble>;

        #[inline(always)]
        fn run<const FUSED: bool>(self) -> Vec<DoubleDouble> {
            let part = |n: usize| DoubleDouble::ONE / n as f64;
            let mut factored = Factored::<DoubleDouble>::new(self.0);
            assert!(factored.factor_with::<FUSED>(|i, j| part(1 + (7 * i + 3 * j) % 11)));
            let mut right: Vec<DoubleDouble> = (1..=self.0).map(part).collect();
            factored.solve_with::<FUSED>(&mut right);
            right
        }
    }

    #[test]
    fn fused_multiply_adds_change_no_bit_of_a_solution() {
        for size in 1..=6 {
            assert_eq!(vectorized(Solution(size)), Solution(size).run::<false>(), "{size}");
        }
    }

    #[test]
    fn a_pivot_vanishes_below_1e_13_of_its_row() {
        // sizes of which loops are unrolled, and others
        for size in [2, 3, 4, 5, 6] {
            assert!(is_regular(size, 1.2e-13), "{size}");
            assert!(!is_regular(size, 0.8e-13), "{size}");
        }
    }
}
