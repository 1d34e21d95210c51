//! The same number of several orbits, side by side.
//!
//! In and out: [`Batch`]es. Each operation does in every lane what it does with one `f64`, bit for
//! bit, so that an orbit does not depend on its neighbours; the simple ones become vector
//! instructions. Never here: which orbits.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::convolution::InnerProducts;
use super::double_double::DoubleDouble;
use super::instruction_set::Kernel;
use super::real::{Analytic, Real};

/// The number of orbits side by side.
pub const BATCH: usize = 8;

/// One number of each of [`BATCH`] orbits.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(align(64))]
pub struct Batch(pub [f64; BATCH]);

/// An operation on each lane by itself. A loop becomes vector instructions where the combinators of
/// arrays, or a closure, may not be inlined.
macro_rules! lanes {
    ($lane:ident => $x:expr) => {{
        let mut lanes = [0.0; BATCH];
        for $lane in 0..BATCH {
            lanes[$lane] = $x;
        }
        Batch(lanes)
    }};
}

impl Batch {
    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(x: f64) -> Batch {
        Batch([x; BATCH])
    }

    /// The absolute values.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Batch {
        lanes!(i => self.0[i].abs())
    }

    /// The larger of two numbers in each lane, the first where the second is NaN.
    #[inline(always)]
    #[must_use]
    pub fn larger(self, other: Batch) -> Batch {
        lanes!(i => if other.0[i] > self.0[i] { other.0[i] } else { self.0[i] })
    }

    /// The smaller of two numbers in each lane, the first where the second is NaN.
    #[inline(always)]
    #[must_use]
    pub fn smaller(self, other: Batch) -> Batch {
        lanes!(i => if other.0[i] < self.0[i] { other.0[i] } else { self.0[i] })
    }

    /// `a` where this is the number `x`, else `b`.
    #[inline(always)]
    #[must_use]
    pub fn where_equal(self, x: f64, a: Batch, b: Batch) -> Batch {
        lanes!(i => if self.0[i] == x { a.0[i] } else { b.0[i] })
    }

    /// `a` where this is below `x`, else `b`.
    #[inline(always)]
    #[must_use]
    pub fn where_below(self, x: f64, a: Batch, b: Batch) -> Batch {
        lanes!(i => if self.0[i] < x { a.0[i] } else { b.0[i] })
    }

    /// One where this is at most another number, else zero.
    #[inline(always)]
    #[must_use]
    pub fn is_at_most(self, other: Batch) -> Batch {
        lanes!(i => if self.0[i] <= other.0[i] { 1.0 } else { 0.0 })
    }

    /// One where this is above another number, else zero.
    #[inline(always)]
    #[must_use]
    pub fn is_above(self, other: Batch) -> Batch {
        lanes!(i => if self.0[i] > other.0[i] { 1.0 } else { 0.0 })
    }

    /// Whether no number is below that of another batch in its lane; NaN is.
    #[inline(always)]
    pub fn all_reach(self, other: Batch) -> bool {
        let mut all = true;
        for lane in 0..BATCH {
            all &= self.0[lane] >= other.0[lane];
        }
        all
    }

    /// The sum and its rounding error: [`DoubleDouble::sum`] in each lane.
    #[inline(always)]
    pub fn sum_with_error(self, other: Batch) -> (Batch, Batch) {
        let sum = self + other;
        let part = sum - self;
        (sum, (self - (sum - part)) + (other - part))
    }

    /// The product and its rounding error: that of [`DoubleDouble`] in each lane.
    #[inline(always)]
    pub fn product_with_error<const FUSED: bool>(self, other: Batch) -> (Batch, Batch) {
        let product = self * other;
        let error = lanes!(i => DoubleDouble::product_by::<FUSED>(self.0[i], other.0[i]).low);
        (product, error)
    }

    fn each(self, f: impl Fn(f64) -> f64) -> Batch {
        Batch(self.0.map(f))
    }

    fn with(self, other: Batch, f: impl Fn(f64, f64) -> f64) -> Batch {
        lanes!(i => f(self.0[i], other.0[i]))
    }

    fn pairs(self, f: impl Fn(f64) -> (f64, f64)) -> (Batch, Batch) {
        let pairs = self.0.map(f);
        (Batch(pairs.map(|pair| pair.0)), Batch(pairs.map(|pair| pair.1)))
    }
}

macro_rules! operator {
    ($operator:ident, $name:ident, $sign:tt) => {
        impl $operator for Batch {
            type Output = Batch;
            #[inline(always)]
            fn $name(self, other: Batch) -> Batch {
                lanes!(i => self.0[i] $sign other.0[i])
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl Neg for Batch {
    type Output = Batch;
    #[inline(always)]
    fn neg(self) -> Batch {
        lanes!(i => -self.0[i])
    }
}

impl Add<f64> for Batch {
    type Output = Batch;
    #[inline(always)]
    fn add(self, other: f64) -> Batch {
        lanes!(i => self.0[i] + other)
    }
}

impl Mul<f64> for Batch {
    type Output = Batch;
    #[inline(always)]
    fn mul(self, factor: f64) -> Batch {
        lanes!(i => self.0[i] * factor)
    }
}

impl Div<f64> for Batch {
    type Output = Batch;
    #[inline(always)]
    fn div(self, divisor: f64) -> Batch {
        lanes!(i => self.0[i] / divisor)
    }
}

impl Analytic for Batch {
    const ZERO: Batch = Batch([0.0; BATCH]);
    const ONE: Batch = Batch([1.0; BATCH]);
    const OF_SEVERAL: bool = true;
    type Unit = Batch;
    type Lanes = [f64; BATCH];
    const ZEROS: [f64; BATCH] = [0.0; BATCH];
    const SIDE: usize = 1;

    fn of(x: DoubleDouble) -> Batch {
        Batch::splat(x.high)
    }

    #[inline(always)]
    fn scaled(self, power_of_two: Batch) -> Batch {
        self * power_of_two
    }

    #[inline(always)]
    fn side_by_side(number: impl Fn(usize) -> Batch) -> [f64; BATCH] {
        number(0).0
    }

    #[inline(always)]
    fn inner_products<const FUSED: bool>(
        left: &[[f64; BATCH]],
        right: &[[f64; BATCH]],
        out: &mut [Batch],
    ) {
        out[0] = Batch(InnerProducts { left, right }.run::<FUSED>());
    }

    #[inline(always)]
    fn where_positive(self, a: Batch, b: Batch) -> Batch {
        lanes!(i => if self.0[i] > 0.0 { a.0[i] } else { b.0[i] })
    }

    fn unless_vanishing(self, series: impl Iterator<Item = Batch>) -> Batch {
        let mut vanishing = [true; BATCH];
        for term in series {
            for (vanishing, x) in vanishing.iter_mut().zip(term.0) {
                *vanishing &= x == 0.0;
            }
            if vanishing == [false; BATCH] {
                return self;
            }
        }
        lanes!(i => if vanishing[i] { 0.0 } else { self.0[i] })
    }

    #[inline(always)]
    fn sqrt(self) -> Batch {
        lanes!(i => self.0[i].sqrt())
    }

    fn exp(self) -> Batch {
        self.each(Analytic::exp)
    }

    fn ln(self) -> Batch {
        self.each(Analytic::ln)
    }

    fn sin_cos(self) -> (Batch, Batch) {
        self.pairs(Analytic::sin_cos)
    }

    fn tan(self) -> Batch {
        self.each(Analytic::tan)
    }

    fn sinh_cosh(self) -> (Batch, Batch) {
        self.pairs(Analytic::sinh_cosh)
    }

    fn tanh(self) -> Batch {
        self.each(Analytic::tanh)
    }

    fn atan2(self, x: Batch) -> Batch {
        self.with(x, Analytic::atan2)
    }

    fn asin(self) -> Batch {
        self.each(Analytic::asin)
    }

    fn acos(self) -> Batch {
        self.each(Analytic::acos)
    }

    fn power(self, exponent: DoubleDouble) -> Batch {
        self.each(|x| x.power(exponent))
    }

    fn raised(self, exponent: Batch) -> Batch {
        self.with(exponent, |x, exponent| x.power(exponent.double()))
    }
}
