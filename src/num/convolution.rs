//! Inner products of many pairs of series at once: the bulk of the work of a Taylor step.
//!
//! The k-th coefficient of a product of two series is `Σ a_j b_{k−j}`. All pairs that are needed at
//! one order have the same length, so [`LANES`] of them are computed side by side: a series of
//! lanes has the coefficients of one order of that many series next to each other.
//!
//! ```text
//!              lane 0   1   2   3                lane 0   1   2   3
//!   order 1        a1  c1  e1  g1     ·     k−1     b   d   f   h
//!   order 2        a2  c2  e2  g2     ·     k−2     b   d   f   h      the sum of each column
//!   …                                       …
//! ```

use super::double_double::DoubleDouble;
use super::instruction_set::Kernel;

/// The number of pairs computed side by side.
pub(super) const LANES: usize = 4;

/// Numbers side by side.
#[derive(Clone, Copy, Debug)]
struct Vector<const N: usize>([f64; N]);

impl<const N: usize> Vector<N> {
    const ZERO: Vector<N> = Vector([0.0; N]);

    // loops, which become vector instructions where the combinators of arrays may not be inlined

    #[inline(always)]
    fn plus(mut self, other: Vector<N>) -> Vector<N> {
        for lane in 0..N {
            self.0[lane] += other.0[lane];
        }
        self
    }

    #[inline(always)]
    fn minus(mut self, other: Vector<N>) -> Vector<N> {
        for lane in 0..N {
            self.0[lane] -= other.0[lane];
        }
        self
    }

    #[inline(always)]
    fn times(mut self, other: Vector<N>) -> Vector<N> {
        for lane in 0..N {
            self.0[lane] *= other.0[lane];
        }
        self
    }

    /// The rounding errors of a sum: [`DoubleDouble::sum`].
    #[inline(always)]
    fn error_of_sum(self, other: Vector<N>, sum: Vector<N>) -> Vector<N> {
        let part = sum.minus(self);
        self.minus(sum.minus(part)).plus(other.minus(part))
    }

    /// The rounding errors of a product: [`DoubleDouble::product_by`].
    #[inline(always)]
    fn error_of_product<const FUSED: bool>(mut self, other: Vector<N>) -> Vector<N> {
        for lane in 0..N {
            self.0[lane] = DoubleDouble::product_by::<FUSED>(self.0[lane], other.0[lane]).low;
        }
        self
    }
}

/// Inner products of N pairs of series of equal length, both read forwards.
pub(super) struct InnerProducts<'a, T> {
    pub(super) left: &'a [T],
    pub(super) right: &'a [T],
}

impl<const N: usize> Kernel for InnerProducts<'_, [f64; N]> {
    type Output = [f64; N];

    /// Four sums are kept apart, so that none waits for the one before.
    #[inline(always)]
    fn run<const FUSED: bool>(self) -> [f64; N] {
        const APART: usize = 4;
        // cut to one length, so that it is compared once and not for each chunk
        let length = self.left.len().min(self.right.len());
        let (left, left_rest) = self.left[..length].as_chunks::<APART>();
        let (right, right_rest) = self.right[..length].as_chunks::<APART>();
        let mut sums = [Vector::ZERO; APART];
        // by places, since iterators over two lists are not always inlined
        for chunk in 0..left.len() {
            let (a, b) = (&left[chunk], &right[chunk]);
            for i in 0..APART {
                sums[i] = sums[i].plus(Vector(a[i]).times(Vector(b[i])));
            }
        }
        let mut rest = Vector::ZERO;
        for place in 0..left_rest.len() {
            rest = rest.plus(Vector(left_rest[place]).times(Vector(right_rest[place])));
        }
        sums[0].plus(sums[2]).plus(sums[1].plus(sums[3])).plus(rest).0
    }
}

/// [`DoubleDouble`]s side by side.
#[derive(Clone, Copy, Debug)]
pub struct DoubleLanes<const N: usize> {
    high: [f64; N],
    low: [f64; N],
}

impl<const N: usize> DoubleLanes<N> {
    pub(super) const ZERO: DoubleLanes<N> = DoubleLanes { high: [0.0; N], low: [0.0; N] };

    #[inline(always)]
    pub(super) fn of(x: [DoubleDouble; N]) -> DoubleLanes<N> {
        let mut lanes = DoubleLanes::ZERO;
        for lane in 0..N {
            (lanes.high[lane], lanes.low[lane]) = (x[lane].high, x[lane].low);
        }
        lanes
    }
}

/// The errors of products and sums are added up beside the sum (T. Ogita, S. M. Rump, S. Oishi, SIAM
/// J. Sci. Comput. 26 (2005) 1955, algorithm 5.3), which leaves an error of n² 2⁻¹⁰⁴ of the sum of
/// the absolute terms.
impl<const N: usize> Kernel for InnerProducts<'_, DoubleLanes<N>> {
    /// Sums that are not renormalized.
    type Output = [DoubleDouble; N];

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> [DoubleDouble; N] {
        let (mut sum, mut errors) = (Vector::ZERO, Vector::ZERO);
        let length = self.left.len().min(self.right.len());
        let (left, right) = (&self.left[..length], &self.right[..length]);
        for place in 0..length {
            let (a, b) = (&left[place], &right[place]);
            let (a_high, a_low) = (Vector(a.high), Vector(a.low));
            let (b_high, b_low) = (Vector(b.high), Vector(b.low));
            let product = a_high.times(b_high);
            let next = sum.plus(product);
            let lost = sum.error_of_sum(product, next);
            let low = a_high.times(b_low).plus(a_low.times(b_high));
            let low = a_high.error_of_product::<FUSED>(b_high).plus(low);
            errors = errors.plus(lost.plus(low));
            sum = next;
        }
        let mut sums = [DoubleDouble::ZERO; N];
        for lane in 0..N {
            sums[lane] = DoubleDouble { high: sum.0[lane], low: errors.0[lane] };
        }
        sums
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

    fn side_by_side<T: Copy>(x: &[T]) -> Vec<[T; LANES]> {
        x.as_chunks::<LANES>().0.to_vec()
    }

    #[test]
    fn sums_have_the_same_bits_with_and_without_wide_instructions() {
        for n in 0..40 {
            let (left, right) = (side_by_side(&noise(4 * n, 1)), side_by_side(&noise(4 * n, 2)));
            let kernel = || InnerProducts { left: &left, right: &right };
            let (wide, plain) = (vectorized(kernel()), run_plainly(kernel()));
            assert_eq!(wide.map(f64::to_bits), plain.map(f64::to_bits), "{n} terms");
            for lane in 0..LANES {
                let direct: f64 = (0..n).map(|j| left[j][lane] * right[j][lane]).sum();
                assert!((wide[lane] - direct).abs() < 1e-14, "{} {direct}", wide[lane]);
            }
        }
    }

    #[test]
    fn double_sums_have_the_same_bits_and_twice_the_digits() {
        let double = |n: usize, seed: u64| -> Vec<[DoubleDouble; LANES]> {
            let pairs = noise(4 * n, seed).into_iter().zip(noise(4 * n, seed + 1));
            let numbers: Vec<_> = pairs.map(|(x, y)| DoubleDouble::sum(x, y * 1e-17)).collect();
            side_by_side(&numbers)
        };
        for n in 0..40 {
            let (left, right) = (double(n, 3), double(n, 5));
            let lanes =
                |x: &[[DoubleDouble; LANES]]| x.iter().map(|&x| DoubleLanes::of(x)).collect();
            let (a, b): (Vec<_>, Vec<_>) = (lanes(&left), lanes(&right));
            let kernel = || InnerProducts { left: &a, right: &b };
            let (wide, plain) = (vectorized(kernel()), run_plainly(kernel()));
            let bits = |x: DoubleDouble| (x.high.to_bits(), x.low.to_bits());
            assert_eq!(wide.map(bits), plain.map(bits), "{n} terms");
            for lane in 0..LANES {
                let direct =
                    (0..n).fold(DoubleDouble::ZERO, |sum, j| sum + left[j][lane] * right[j][lane]);
                let off = wide[lane] - direct;
                assert!(off.high.abs() < 1e-29, "{:?} {direct:?}", wide[lane]);
            }
        }
    }
}
