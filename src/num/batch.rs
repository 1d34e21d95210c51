//! The same number of several orbits, or of several stages of a step, side by side.
//!
//! In and out: [`Batch`]es. Each operation does in every lane what it does with one `f64`, bit for
//! bit, so that an orbit does not depend on its neighbours; the simple ones become vector
//! instructions. Never here: which orbits.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::convolution::InnerProducts;
use super::double_double::DoubleDouble;
use super::four_lanes::{FourLanes, LANES};
use super::instruction_set::Kernel;
use super::real::{Analytic, Real};

/// The number of orbits side by side.
pub const BATCH: usize = 8;

/// One number of each of [`BATCH`] orbits, or of as many lanes as are said.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(align(64))]
pub struct Batch<const N: usize = BATCH>(pub [f64; N]);

/// An operation on each lane by itself. A loop becomes vector instructions where the combinators of
/// arrays, or a closure, may not be inlined.
macro_rules! lanes {
    ($lane:ident => $x:expr) => {{
        let mut lanes = [0.0; N];
        for $lane in 0..N {
            lanes[$lane] = $x;
        }
        Batch(lanes)
    }};
}

impl Batch {
    /// The numbers of one half of the lanes, 0 or 1.
    #[inline(always)]
    pub fn half<L: FourLanes>(&self, lanes: L, at: usize) -> L::Numbers {
        lanes.from_array(self.0.as_chunks::<LANES>().0[at])
    }
}

impl<const N: usize> Batch<N> {
    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(x: f64) -> Batch<N> {
        Batch([x; N])
    }

    /// The absolute values.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Batch<N> {
        lanes!(i => self.0[i].abs())
    }

    /// The larger of two numbers in each lane, the first where the second is NaN.
    #[inline(always)]
    #[must_use]
    pub fn larger(self, other: Batch<N>) -> Batch<N> {
        lanes!(i => if other.0[i] > self.0[i] { other.0[i] } else { self.0[i] })
    }

    /// The smaller of two numbers in each lane, the first where the second is NaN.
    #[inline(always)]
    #[must_use]
    pub fn smaller(self, other: Batch<N>) -> Batch<N> {
        lanes!(i => if other.0[i] < self.0[i] { other.0[i] } else { self.0[i] })
    }

    /// `a` where this is the number `x`, else `b`.
    #[inline(always)]
    #[must_use]
    pub fn where_equal(self, x: f64, a: Batch<N>, b: Batch<N>) -> Batch<N> {
        lanes!(i => if self.0[i] == x { a.0[i] } else { b.0[i] })
    }

    /// `a` where this is below `x`, else `b`.
    #[inline(always)]
    #[must_use]
    pub fn where_below(self, x: f64, a: Batch<N>, b: Batch<N>) -> Batch<N> {
        lanes!(i => if self.0[i] < x { a.0[i] } else { b.0[i] })
    }

    /// One where this is at most another number, else zero.
    #[inline(always)]
    #[must_use]
    pub fn is_at_most(self, other: Batch<N>) -> Batch<N> {
        lanes!(i => if self.0[i] <= other.0[i] { 1.0 } else { 0.0 })
    }

    /// One where this is above another number, else zero.
    #[inline(always)]
    #[must_use]
    pub fn is_above(self, other: Batch<N>) -> Batch<N> {
        lanes!(i => if self.0[i] > other.0[i] { 1.0 } else { 0.0 })
    }

    /// Whether no number is below that of another batch in its lane; NaN is.
    #[inline(always)]
    pub fn all_reach(self, other: Batch<N>) -> bool {
        let mut all = true;
        for lane in 0..N {
            all &= self.0[lane] >= other.0[lane];
        }
        all
    }

    /// The sum and its rounding error: [`DoubleDouble::sum`] in each lane.
    #[inline(always)]
    pub fn sum_with_error(self, other: Batch<N>) -> (Batch<N>, Batch<N>) {
        let sum = self + other;
        let part = sum - self;
        (sum, (self - (sum - part)) + (other - part))
    }

    /// The product and its rounding error: that of [`DoubleDouble`] in each lane.
    #[inline(always)]
    pub fn product_with_error<const FUSED: bool>(self, other: Batch<N>) -> (Batch<N>, Batch<N>) {
        let product = self * other;
        let error = lanes!(i => DoubleDouble::product_by::<FUSED>(self.0[i], other.0[i]).low);
        (product, error)
    }

    fn each(self, f: impl Fn(f64) -> f64) -> Batch<N> {
        lanes!(i => f(self.0[i]))
    }

    fn with(self, other: Batch<N>, f: impl Fn(f64, f64) -> f64) -> Batch<N> {
        lanes!(i => f(self.0[i], other.0[i]))
    }

    fn pairs(self, f: impl Fn(f64) -> (f64, f64)) -> (Batch<N>, Batch<N>) {
        let (mut first, mut second) = ([0.0; N], [0.0; N]);
        for lane in 0..N {
            (first[lane], second[lane]) = f(self.0[lane]);
        }
        (Batch(first), Batch(second))
    }
}

macro_rules! operator {
    ($operator:ident, $name:ident, $sign:tt) => {
        impl<const N: usize> $operator for Batch<N> {
            type Output = Batch<N>;
            #[inline(always)]
            fn $name(self, other: Batch<N>) -> Batch<N> {
                lanes!(i => self.0[i] $sign other.0[i])
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl<const N: usize> Neg for Batch<N> {
    type Output = Batch<N>;
    #[inline(always)]
    fn neg(self) -> Batch<N> {
        lanes!(i => -self.0[i])
    }
}

impl<const N: usize> Add<f64> for Batch<N> {
    type Output = Batch<N>;
    #[inline(always)]
    fn add(self, other: f64) -> Batch<N> {
        lanes!(i => self.0[i] + other)
    }
}

impl<const N: usize> Mul<f64> for Batch<N> {
    type Output = Batch<N>;
    #[inline(always)]
    fn mul(self, factor: f64) -> Batch<N> {
        lanes!(i => self.0[i] * factor)
    }
}

impl<const N: usize> Div<f64> for Batch<N> {
    type Output = Batch<N>;
    #[inline(always)]
    fn div(self, divisor: f64) -> Batch<N> {
        lanes!(i => self.0[i] / divisor)
    }
}

impl<const N: usize> Analytic for Batch<N> {
    const ZERO: Batch<N> = Batch([0.0; N]);
    const ONE: Batch<N> = Batch([1.0; N]);
    const OF_SEVERAL: bool = true;
    type Unit = Batch<N>;
    type Lanes = [f64; N];
    const ZEROS: [f64; N] = [0.0; N];
    const SIDE: usize = 1;

    fn of(x: DoubleDouble) -> Batch<N> {
        Batch::splat(x.high)
    }

    #[inline(always)]
    fn scaled(self, power_of_two: Batch<N>) -> Batch<N> {
        self * power_of_two
    }

    #[inline(always)]
    fn integrated<const FUSED: bool>(self, unit: Batch<N>, n: usize) -> Batch<N> {
        self / (Batch::splat(n as f64) / unit)
    }

    #[inline(always)]
    fn side_by_side(number: impl Fn(usize) -> Batch<N>) -> [f64; N] {
        number(0).0
    }

    #[inline(always)]
    fn inner_products<const FUSED: bool>(
        left: &[[f64; N]],
        right: &[[f64; N]],
        out: &mut [Batch<N>],
    ) {
        out[0] = Batch(InnerProducts { left, right }.run::<FUSED>());
    }

    #[inline(always)]
    fn where_positive(self, a: Batch<N>, b: Batch<N>) -> Batch<N> {
        lanes!(i => if self.0[i] > 0.0 { a.0[i] } else { b.0[i] })
    }

    fn unless_vanishing(self, series: impl Iterator<Item = Batch<N>>) -> Batch<N> {
        let mut vanishing = [true; N];
        for term in series {
            for (vanishing, x) in vanishing.iter_mut().zip(term.0) {
                *vanishing &= x == 0.0;
            }
            if vanishing == [false; N] {
                return self;
            }
        }
        lanes!(i => if vanishing[i] { 0.0 } else { self.0[i] })
    }

    #[inline(always)]
    fn sqrt(self) -> Batch<N> {
        lanes!(i => self.0[i].sqrt())
    }

    fn exp(self) -> Batch<N> {
        self.each(Analytic::exp)
    }

    fn ln(self) -> Batch<N> {
        self.each(Analytic::ln)
    }

    fn sin_cos(self) -> (Batch<N>, Batch<N>) {
        self.pairs(Analytic::sin_cos)
    }

    fn tan(self) -> Batch<N> {
        self.each(Analytic::tan)
    }

    fn sinh_cosh(self) -> (Batch<N>, Batch<N>) {
        self.pairs(Analytic::sinh_cosh)
    }

    fn tanh(self) -> Batch<N> {
        self.each(Analytic::tanh)
    }

    fn atan2(self, x: Batch<N>) -> Batch<N> {
        self.with(x, Analytic::atan2)
    }

    fn asin(self) -> Batch<N> {
        self.each(Analytic::asin)
    }

    fn acos(self) -> Batch<N> {
        self.each(Analytic::acos)
    }

    fn power(self, exponent: DoubleDouble) -> Batch<N> {
        self.each(|x| x.power(exponent))
    }

    fn raised(self, exponent: Batch<N>) -> Batch<N> {
        self.with(exponent, |x, exponent| x.power(exponent.double()))
    }
}
