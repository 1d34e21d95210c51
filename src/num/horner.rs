//! Polynomials evaluated with twice the digits of `f64` in the terms of low order.
//!
//! Source: S. Graillat, P. Langlois, N. Louvet, Japan J. Indust. Appl. Math. 26 (2009) 191,
//! algorithm 4 (the compensated scheme of Horner): the rounding errors of all products and sums are
//! a polynomial themselves, which is evaluated beside the first.

use super::double_double::DoubleDouble;
use super::instruction_set::{Kernel, vectorized};

/// `Σ_j low_j x^j + Σ_j high_j x^{j + n}`, where n is the number of `low`. The terms of `low` are as
/// exact as double-double, those of `high` as `f64`.
pub fn polynomial(low: &[DoubleDouble], high: &[f64], x: DoubleDouble) -> DoubleDouble {
    vectorized(Polynomial { low, high, x })
}

/// The kernel of [`polynomial`].
pub struct Polynomial<'a> {
    /// The terms of low order.
    pub low: &'a [DoubleDouble],
    /// Those after them.
    pub high: &'a [f64],
    /// The argument.
    pub x: DoubleDouble,
}

/// The sums of the terms after those of low order of several polynomials of the same length, each
/// over the power of the first of them. None waits for another.
#[inline(always)]
pub fn tails<const N: usize>(high: [&[f64]; N], x: f64) -> [f64; N] {
    let (high, length) = of_one_length(high);
    let mut sums = [0.0; N];
    for j in (0..length).rev() {
        for lane in 0..N {
            sums[lane] = sums[lane] * x + high[lane][j];
        }
    }
    sums
}

/// The same of the slopes of these polynomials, whose term of order `first` is the first of `high`.
#[inline(always)]
pub fn slope_tails<const N: usize>(high: [&[f64]; N], first: usize, x: f64) -> [f64; N] {
    let (high, length) = of_one_length(high);
    let mut sums = [0.0; N];
    for j in (0..length).rev() {
        let order = (first + j) as f64;
        for lane in 0..N {
            sums[lane] = sums[lane] * x + high[lane][j] * order;
        }
    }
    sums
}

/// Series cut to their common length, and that.
#[inline(always)]
fn of_one_length<const N: usize>(mut series: [&[f64]; N]) -> ([&[f64]; N], usize) {
    let mut length = usize::MAX;
    for lane in 0..N {
        length = length.min(series[lane].len());
    }
    for lane in 0..N {
        series[lane] = &series[lane][..length];
    }
    (series, length)
}

impl Polynomial<'_> {
    /// The sum of the terms after those of low order, over the power of the first of them.
    #[inline(always)]
    fn tail(&self) -> f64 {
        let [tail] = tails([self.high], self.x.high);
        tail
    }

    /// The polynomial, from that sum. `high` is read only where the argument is no `f64`.
    #[inline(always)]
    pub fn with_tail<const FUSED: bool>(self, tail: f64) -> DoubleDouble {
        let [slope] = if self.x.low == 0.0 {
            [0.0]
        } else {
            slope_tails([self.high], self.low.len(), self.x.high)
        };
        self.with_tails::<FUSED>(tail, slope)
    }

    /// The polynomial, from that sum and the one of its slope, which is read only where the argument
    /// is no `f64`.
    #[inline(always)]
    pub fn with_tails<const FUSED: bool>(self, tail: f64, slope: f64) -> DoubleDouble {
        let x = self.x.high;
        let (mut sum, mut errors) = (tail, 0.0);
        for c in self.low.iter().rev() {
            let product = DoubleDouble::product_by::<FUSED>(sum, x);
            let next = DoubleDouble::sum(product.high, c.high);
            sum = next.high;
            errors = errors * x + (product.low + next.low + c.low);
        }
        if self.x.low != 0.0 {
            let low = self.low.iter().enumerate().skip(1).rev();
            let slope = low.fold(slope, |sum, (j, c)| sum * x + c.high * j as f64);
            errors += self.x.low * slope;
        }
        DoubleDouble::sum(sum, errors)
    }
}

impl Kernel for Polynomial<'_> {
    type Output = DoubleDouble;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> DoubleDouble {
        let tail = self.tail();
        self.with_tail::<FUSED>(tail)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By Horner's scheme in double-double throughout.
    fn direct(low: &[DoubleDouble], high: &[f64], x: DoubleDouble) -> DoubleDouble {
        let high = high.iter().map(|&c| DoubleDouble::from(c));
        let all: Vec<DoubleDouble> = low.iter().copied().chain(high).collect();
        all.iter().rev().fold(DoubleDouble::ZERO, |sum, &c| sum * x + c)
    }

    #[test]
    fn the_terms_of_low_order_have_twice_the_digits() {
        let third = DoubleDouble::ONE / 3.0;
        let low: Vec<DoubleDouble> =
            (0..8).map(|j| (third - DoubleDouble::from(f64::from(j))) * third).collect();
        for x in [0.0, 0.3, -0.7, 1.0, 1.9] {
            for x in [DoubleDouble::from(x), DoubleDouble::from(x) + third * 1e-16] {
                let off = polynomial(&low, &[], x) - direct(&low, &[], x);
                assert!(off.high.abs() < 1e-28, "{x:?} {off:?}");
                // what the rest adds is as exact as its own size
                let high = [1e-6, -2e-6, 1e-7];
                let off = polynomial(&low, &high, x) - direct(&low, &high, x);
                assert!(off.high.abs() < 1e-19, "{x:?} {off:?}");
            }
        }
    }

    #[test]
    fn an_empty_polynomial_is_zero() {
        assert_eq!(polynomial(&[], &[], DoubleDouble::ONE), DoubleDouble::ZERO);
    }
}
