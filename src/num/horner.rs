//! Polynomials evaluated with twice the digits of `f64` in the terms of low order.
//!
//! Source: S. Graillat, P. Langlois, N. Louvet, Japan J. Indust. Appl. Math. 26 (2009) 191,
//! algorithm 4 (the compensated scheme of Horner): the rounding errors of all products and sums are
//! a polynomial themselves, which is evaluated beside the first. In long series the terms of high order are summed four apart, as in
//! G. Estrin, Proc. Western Joint Computer Conference (1960) 33.

use super::batch::Batch;
use super::double_double::DoubleDouble;
use super::four_lanes::{FourLanes, LANES, ScalarLanes};
use super::instruction_set::{Kernel, vectorized};
use super::real::Analytic;

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

/// The number of sums that are kept apart: four, each of every fourth term, none of which waits for another.
const APART: usize = 4;

/// The sum of the terms after those of low order, over the power of the first of them.
#[inline(always)]
pub fn tail<L: FourLanes>(lanes: L, high: &[f64], x: f64) -> f64 {
    let square = x * x;
    let fourth = lanes.splat(square * square);
    let (chunks, rest) = high.as_chunks::<APART>();
    let mut sums = lanes.from_array(padded(rest, 0.0));
    // by places, since what is given to an iterator is not always inlined
    for i in (0..chunks.len()).rev() {
        sums = lanes.add(lanes.mul(sums, fourth), lanes.from_array(chunks[i]));
    }
    let [first, second, third, last] = lanes.to_array(sums);
    (third * square + first) + (last * square + second) * x
}

/// The same of four numbers with as many terms each.
#[inline(always)]
pub fn four_tails<L: FourLanes>(lanes: L, high: [&[f64]; LANES], x: f64) -> L::Numbers {
    let square = x * x;
    let fourth = lanes.splat(square * square);
    let [a, b, c, d] = high;
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<APART>(), b.as_chunks::<APART>());
    let ((c, c_rest), (d, d_rest)) = (c.as_chunks::<APART>(), d.as_chunks::<APART>());
    let count = a.len();
    let (b, c, d) = (&b[..count], &c[..count], &d[..count]);
    let zero = lanes.splat(0.0);
    let [mut a_sums, mut b_sums, mut c_sums, mut d_sums] = [zero; LANES];
    if !a_rest.is_empty() {
        a_sums = lanes.from_array(padded(a_rest, 0.0));
        b_sums = lanes.from_array(padded(b_rest, 0.0));
        c_sums = lanes.from_array(padded(c_rest, 0.0));
        d_sums = lanes.from_array(padded(d_rest, 0.0));
    }
    for i in (0..count).rev() {
        a_sums = lanes.add(lanes.mul(a_sums, fourth), lanes.from_array(a[i]));
        b_sums = lanes.add(lanes.mul(b_sums, fourth), lanes.from_array(b[i]));
        c_sums = lanes.add(lanes.mul(c_sums, fourth), lanes.from_array(c[i]));
        d_sums = lanes.add(lanes.mul(d_sums, fourth), lanes.from_array(d[i]));
    }
    let [first, second, third, last] = lanes.transposed([a_sums, b_sums, c_sums, d_sums]);
    let (x, square) = (lanes.splat(x), lanes.splat(square));
    let even = lanes.add(lanes.mul(third, square), first);
    let odd = lanes.add(lanes.mul(last, square), second);
    lanes.add(even, lanes.mul(odd, x))
}

/// The same of x times the slope, where the first of `high` has this order.
#[inline(always)]
fn slope_tail<L: FourLanes>(lanes: L, high: &[f64], order: usize, x: f64) -> f64 {
    let square = x * x;
    let fourth = lanes.splat(square * square);
    let ahead = lanes.from_array([0.0, 1.0, 2.0, 3.0]);
    let (chunks, rest) = high.as_chunks::<APART>();
    let orders = lanes.add(lanes.splat((order + APART * chunks.len()) as f64), ahead);
    let mut sums = lanes.mul(lanes.from_array(padded(rest, 0.0)), orders);
    for i in (0..chunks.len()).rev() {
        let orders = lanes.add(lanes.splat((order + APART * i) as f64), ahead);
        sums = lanes.add(lanes.mul(sums, fourth), lanes.mul(lanes.from_array(chunks[i]), orders));
    }
    let [first, second, third, last] = lanes.to_array(sums);
    (third * square + first) + (last * square + second) * x
}

/// The same of several orbits, with the bits of each alone.
#[inline(always)]
pub fn tails(high: &[Batch], x: Batch) -> Batch {
    let square = x * x;
    let fourth = square * square;
    let (chunks, rest) = high.as_chunks::<APART>();
    let mut sums = padded(rest, Batch::ZERO);
    for chunk in chunks.iter().rev() {
        for place in 0..APART {
            sums[place] = sums[place] * fourth + chunk[place];
        }
    }
    let [first, second, third, last] = sums;
    (third * square + first) + (last * square + second) * x
}

/// Up to three numbers, and zeros behind them.
#[inline(always)]
pub fn padded<T: Copy>(rest: &[T], zero: T) -> [T; APART] {
    match *rest {
        [a] => [a, zero, zero, zero],
        [a, b] => [a, b, zero, zero],
        [a, b, c] => [a, b, c, zero],
        _ => [zero; APART],
    }
}

impl Polynomial<'_> {
    /// The polynomial, from the sum of the terms after those of low order over the power of the first of them. `high` is read
    /// only where the argument is no `f64`.
    #[inline(always)]
    pub fn with_tail<L: FourLanes, const FUSED: bool>(self, lanes: L, tail: f64) -> DoubleDouble {
        let x = self.x.high;
        let (mut sum, mut errors) = (tail, 0.0);
        for c in self.low.iter().rev() {
            let product = DoubleDouble::product_by::<FUSED>(sum, x);
            let next = DoubleDouble::sum(product.high, c.high);
            sum = next.high;
            errors = errors * x + (product.low + next.low + c.low);
        }
        if self.x.low != 0.0 {
            let tail = slope_tail(lanes, self.high, self.low.len(), x);
            let low = self.low.iter().enumerate().skip(1).rev();
            let slope = low.fold(tail, |sum, (j, c)| sum * x + c.high * j as f64);
            errors += self.x.low * slope;
        }
        DoubleDouble::sum(sum, errors)
    }
}

impl Kernel for Polynomial<'_> {
    type Output = DoubleDouble;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> DoubleDouble {
        let tail = self.high.iter().rev().fold(0.0, |sum, c| sum * self.x.high + c);
        self.with_tail::<_, FUSED>(ScalarLanes, tail)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::math;

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
    fn several_tails_have_the_bits_of_each_alone() {
        for length in 0..31 {
            let high: Vec<Batch> = (0..length)
                .map(|j| {
                    Batch(std::array::from_fn(|lane| {
                        1.0 / (0.7 - f64::from(j) * (lane + 1) as f64)
                    }))
                })
                .collect();
            let x = Batch(std::array::from_fn(|lane| 1.9 - 0.5 * lane as f64));
            let all = tails(&high, x);
            for lane in 0..all.0.len() {
                let alone: Vec<f64> = high.iter().map(|c| c.0[lane]).collect();
                let own = tail(ScalarLanes, &alone, x.0[lane]);
                assert_eq!(all.0[lane].to_bits(), own.to_bits(), "{length}");
                let direct = alone.iter().rev().fold(0.0, |sum, c| sum * x.0[lane] + c);
                let powers = std::iter::successors(Some(1.0), |p| Some(p * x.0[lane].abs()));
                let size: f64 = alone.iter().zip(powers).map(|(c, p)| c.abs() * p).sum();
                assert!((own - direct).abs() <= 1e-14 * size, "{length} {own} {direct}");
            }
        }
    }

    #[test]
    fn a_slope_has_each_term_times_its_order() {
        let high: Vec<f64> = (0..31).map(|j| 1.0 / (0.7 - f64::from(j))).collect();
        for (length, order) in (0..31).flat_map(|length| [(length, 1), (length, 8)]) {
            for x in [-1.6, 0.0, 0.4, 1.9] {
                let terms: Vec<f64> = (0..length)
                    .map(|j| (order + j) as f64 * high[j] * math::powi(x, j as i32))
                    .collect();
                let (sum, size): (f64, f64) =
                    (terms.iter().sum(), terms.iter().map(|term| term.abs()).sum());
                let off = slope_tail(ScalarLanes, &high[..length], order, x) - sum;
                assert!(off.abs() <= 1e-14 * size, "{length} {order} {x}: {off:e}");
            }
        }
    }

    #[test]
    fn an_empty_polynomial_is_zero() {
        assert_eq!(polynomial(&[], &[], DoubleDouble::ONE), DoubleDouble::ZERO);
    }
}
