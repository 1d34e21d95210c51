//! Inner products of many pairs of series at once: the bulk of the work of a Taylor step.
//!
//! The k-th coefficient of a product of two series is `Σ a_j b_{k−j}`. With the second series stored
//! in reverse it is a plain inner product of two stretches of memory, and all pairs that are needed
//! at one order have the same length.

use super::double_double::DoubleDouble;
use super::instruction_set::Kernel;

/// The places where the two stretches of a pair begin.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// In the series stored forwards.
    pub forward: u32,
    /// In the series stored in reverse.
    pub reversed: u32,
}

/// Inner products in `f64` of the pairs of `rows`, `n` terms each, the second stretch of each
/// starting `shift` further on.
pub(super) struct Single<'a> {
    pub(super) forward: &'a [f64],
    pub(super) reversed: &'a [f64],
    pub(super) rows: &'a [Row],
    pub(super) shift: usize,
    pub(super) n: usize,
    pub(super) out: &'a mut [f64],
}

impl Kernel for Single<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        for (out, row) in self.out.iter_mut().zip(self.rows) {
            let a = &self.forward[row.forward as usize..][..self.n];
            let b = &self.reversed[row.reversed as usize + self.shift..][..self.n];
            let (a_chunks, a_rest) = a.as_chunks::<4>();
            let (b_chunks, b_rest) = b.as_chunks::<4>();
            let mut sums = [0.0; 4];
            for (x, y) in a_chunks.iter().zip(b_chunks) {
                for lane in 0..4 {
                    sums[lane] += x[lane] * y[lane];
                }
            }
            let rest = a_rest.iter().zip(b_rest).fold(0.0, |sum, (x, y)| sum + x * y);
            *out = ((sums[0] + sums[2]) + (sums[1] + sums[3])) + rest;
        }
    }
}

/// The same in double-double. The errors of products and sums are added up beside the sum (T.
/// Ogita, S. M. Rump, S. Oishi, SIAM J. Sci. Comput. 26 (2005) 1955, algorithm 5.3), which leaves an
/// error of n² 2⁻¹⁰⁴ of the sum of the absolute terms.
pub(super) struct Double<'a> {
    pub(super) forward: &'a [DoubleDouble],
    pub(super) reversed: &'a [DoubleDouble],
    pub(super) rows: &'a [Row],
    pub(super) shift: usize,
    pub(super) n: usize,
    pub(super) out: &'a mut [DoubleDouble],
}

impl Kernel for Double<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        for (out, row) in self.out.iter_mut().zip(self.rows) {
            let a = &self.forward[row.forward as usize..][..self.n];
            let b = &self.reversed[row.reversed as usize + self.shift..][..self.n];
            let (mut sum, mut errors) = (0.0, 0.0);
            for (x, y) in a.iter().zip(b) {
                let product = DoubleDouble::product_by::<FUSED>(x.high, y.high);
                let next = DoubleDouble::sum(sum, product.high);
                sum = next.high;
                errors += next.low + (product.low + (x.high * y.low + x.low * y.high));
            }
            *out = DoubleDouble::sum(sum, errors);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::instruction_set::{run_plainly, vectorized};

    /// Numbers without a pattern.
    fn noise(n: usize, seed: u64) -> Vec<f64> {
        let next =
            |x: &u64| Some(x.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407));
        let bits = std::iter::successors(Some(seed), next).skip(1);
        bits.map(|x| (x >> 11) as f64 / (1_u64 << 52) as f64 - 1.0).take(n).collect()
    }

    fn rows() -> Vec<Row> {
        (0..5).map(|i| Row { forward: 7 * i, reversed: 3 * i }).collect()
    }

    #[test]
    fn sums_have_the_same_bits_with_and_without_wide_instructions() {
        let (a, b) = (noise(80, 1), noise(80, 2));
        for n in 0..40 {
            let mut out = [[0.0; 5]; 2];
            let [wide, plain] = &mut out;
            let (forward, reversed, rows) = (&a[..], &b[..], &rows()[..]);
            vectorized(Single { forward, reversed, rows, shift: 1, n, out: wide });
            run_plainly(Single { forward, reversed, rows, shift: 1, n, out: plain });
            assert_eq!(wide.map(f64::to_bits), plain.map(f64::to_bits), "{n} terms");
            let direct: f64 = (0..n).map(|j| a[7 + j] * b[4 + j]).sum();
            assert!((wide[1] - direct).abs() < 1e-14, "{} {direct}", wide[1]);
        }
    }

    #[test]
    fn double_sums_have_the_same_bits_and_twice_the_digits() {
        let double = |high: Vec<f64>, low: Vec<f64>| -> Vec<DoubleDouble> {
            high.iter().zip(low).map(|(&x, y)| DoubleDouble::sum(x, y * 1e-17)).collect()
        };
        let (a, b) = (double(noise(80, 3), noise(80, 4)), double(noise(80, 5), noise(80, 6)));
        for n in 0..40 {
            let mut out = [[DoubleDouble::ZERO; 5]; 2];
            let [wide, plain] = &mut out;
            let (forward, reversed, rows) = (&a[..], &b[..], &rows()[..]);
            vectorized(Double { forward, reversed, rows, shift: 1, n, out: wide });
            run_plainly(Double { forward, reversed, rows, shift: 1, n, out: plain });
            let bits = |x: DoubleDouble| (x.high.to_bits(), x.low.to_bits());
            assert_eq!(wide.map(bits), plain.map(bits), "{n} terms");
            let direct = (0..n).fold(DoubleDouble::ZERO, |sum, j| sum + a[7 + j] * b[4 + j]);
            assert!((wide[1] - direct).high.abs() < 1e-29, "{:?} {direct:?}", wide[1]);
        }
    }
}
