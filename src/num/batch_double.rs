//! Double-double numbers side by side.
//!
//! In and out: sums of two [`Batch`]es. Each operation does in every lane what it does with one [`DoubleDouble`], bit for
//! bit. Never here: elementary functions.

use std::ops::Add;

use super::batch::Batch;
use super::double_double::DoubleDouble;
use super::real::Analytic;

/// `high + low` in every lane.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct BatchDouble<const N: usize> {
    /// The nearest numbers.
    pub high: Batch<N>,
    /// The remainders.
    pub low: Batch<N>,
}

impl<const N: usize> BatchDouble<N> {
    /// Zero in every lane.
    pub const ZERO: BatchDouble<N> = BatchDouble { high: Batch::ZERO, low: Batch::ZERO };

    /// A number for each lane.
    #[inline(always)]
    pub fn each(number: impl Fn(usize) -> DoubleDouble) -> BatchDouble<N> {
        let mut all = BatchDouble::ZERO;
        for lane in 0..N {
            let number = number(lane);
            (all.high.0[lane], all.low.0[lane]) = (number.high, number.low);
        }
        all
    }

    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(x: DoubleDouble) -> BatchDouble<N> {
        BatchDouble { high: Batch::splat(x.high), low: Batch::splat(x.low) }
    }

    /// The number in a lane.
    pub fn lane(&self, lane: usize) -> DoubleDouble {
        DoubleDouble { high: self.high.0[lane], low: self.low.0[lane] }
    }

    /// The product with a factor for each lane.
    #[inline(always)]
    #[must_use]
    pub fn times<const FUSED: bool>(self, factor: Batch<N>) -> BatchDouble<N> {
        let (product, error) = self.high.product_with_error::<FUSED>(factor);
        ordered_sum(product, error + self.low * factor)
    }
}

/// `a + b` exactly, for `|a| ≥ |b|`.
#[inline(always)]
fn ordered_sum<const N: usize>(a: Batch<N>, b: Batch<N>) -> BatchDouble<N> {
    let high = a + b;
    BatchDouble { high, low: b - (high - a) }
}

impl<const N: usize> Add for BatchDouble<N> {
    type Output = BatchDouble<N>;
    #[inline(always)]
    fn add(self, other: BatchDouble<N>) -> BatchDouble<N> {
        let (sum, error) = self.high.sum_with_error(other.high);
        let (low, rest) = self.low.sum_with_error(other.low);
        let first = ordered_sum(sum, error + low);
        ordered_sum(first.high, rest + first.low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lane_is_a_double_double() {
        let number = |k: usize| DoubleDouble::integer(3 + k as i64) / 7.0;
        let a: BatchDouble<4> = BatchDouble::each(number);
        let b = BatchDouble::each(|lane| number(lane + 11) / -3.0);
        let factor = Batch([0.1, -1e20, 3.0, 0.7]);
        for lane in 0..4 {
            let (x, y) = (number(lane), number(lane + 11) / -3.0);
            assert_eq!((a + b).lane(lane), x + y);
            assert_eq!(a.times::<false>(factor).lane(lane), x * factor.0[lane]);
            assert_eq!(a.times::<true>(factor).lane(lane), x * factor.0[lane]);
        }
    }
}
