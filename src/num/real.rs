//! The arithmetic in which an expression is evaluated: `f64`, [`DoubleDouble`] for twice its
//! digits, [`ExtendedRange`](super::ExtendedRange) for values outside the range of both, or a
//! [`Batch`](super::Batch) of the numbers of several orbits. Every rule that is written for an
//! [`Analytic`] number serves all four; what decides by the size of a number needs a [`Real`].

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::convolution::{InnerProducts, LANES};
use super::double_double::DoubleDouble;
use super::instruction_set::Kernel;
use crate::num::math;

/// A number of some precision, or several side by side, with the functions that an expression may
/// call. Nothing depends on its size but through masks.
pub trait Analytic:
    Copy
    + Send
    + Sync
    + std::fmt::Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + 'static
{
    /// The number that changes no sum.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// Whether a number is that of several orbits side by side.
    const OF_SEVERAL: bool = false;
    /// A unit of time, a power of two.
    type Unit: Copy + Send + Sync + std::fmt::Debug;
    /// The operands of [`Analytic::SIDE`] inner products side by side.
    type Lanes: Copy + Send + Sync + std::fmt::Debug;
    /// Zeros side by side.
    const ZEROS: Self::Lanes;
    /// The number of inner products that are computed side by side.
    const SIDE: usize;

    /// The number nearest to a [`DoubleDouble`].
    fn of(x: DoubleDouble) -> Self;

    /// Division by an integer from 1 to 64, not renormalized, with a fused multiply-add where that gives the same bits; so are
    /// the products and quotients below.
    #[must_use]
    #[inline(always)]
    fn over<const FUSED: bool>(self, n: usize) -> Self {
        self / n as f64
    }
    /// An integer multiple, not renormalized.
    #[must_use]
    #[inline(always)]
    fn multiple<const FUSED: bool>(self, n: usize) -> Self {
        self * n as f64
    }
    /// Multiplication by a power of two.
    #[must_use]
    fn scaled(self, power_of_two: Self::Unit) -> Self;
    /// The n-th coefficient of a series, in a unit of time that is a power of two, of whose rate of change this is the coefficient before.
    #[must_use]
    #[inline(always)]
    fn integrated<const FUSED: bool>(self, unit: Self::Unit, n: usize) -> Self {
        self.scaled(unit).over::<FUSED>(n).renormalized()
    }
    /// The product.
    #[must_use]
    #[inline(always)]
    fn times<const FUSED: bool>(self, other: Self) -> Self {
        self * other
    }
    /// The product as a term of a sum that is [renormalized](Analytic::renormalized) in the end.
    #[must_use]
    #[inline(always)]
    fn times_unnormalized<const FUSED: bool>(self, other: Self) -> Self {
        self.times::<FUSED>(other)
    }
    /// The same of a sum.
    #[must_use]
    #[inline(always)]
    fn plus_unnormalized(self, other: Self) -> Self {
        self + other
    }
    /// A number whose parts are as small beside one another as they can be.
    #[must_use]
    #[inline(always)]
    fn renormalized(self) -> Self {
        self
    }
    /// The quotient.
    #[must_use]
    #[inline(always)]
    fn divided_by<const FUSED: bool>(self, other: Self) -> Self {
        self / other
    }
    /// The quotient by a number that others are divided by as well: where a quotient costs much more than a product, the
    /// product with its reciprocal, which has twice the error and is not renormalized.
    #[must_use]
    #[inline(always)]
    fn divided_by_shared<const FUSED: bool>(self, divisor: Self) -> Self {
        self.divided_by::<FUSED>(divisor)
    }
    /// Puts [`Analytic::SIDE`] numbers side by side.
    fn side_by_side(number: impl Fn(usize) -> Self) -> Self::Lanes;
    /// Writes `Σ_j a_j b_j` of each lane, for series of equal length. To be inlined into a
    /// [`Kernel`].
    fn inner_products<const FUSED: bool>(
        left: &[Self::Lanes],
        right: &[Self::Lanes],
        out: &mut [Self],
    );

    /// The same numbers as `f64`, where they are.
    #[inline(always)]
    fn floats(_: &mut [Self]) -> Option<&mut [f64]> {
        None
    }

    /// `a` where this number is positive, else `b`.
    #[must_use]
    fn where_positive(self, a: Self, b: Self) -> Self;
    /// This number, or zero where all terms of a series are zero.
    #[must_use]
    fn unless_vanishing(self, series: impl Iterator<Item = Self>) -> Self;

    /// The square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// The exponential function.
    #[must_use]
    fn exp(self) -> Self;
    /// The natural logarithm.
    #[must_use]
    fn ln(self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// The tangent.
    #[must_use]
    fn tan(self) -> Self;
    /// Hyperbolic sine and cosine.
    fn sinh_cosh(self) -> (Self, Self);
    /// The hyperbolic tangent.
    #[must_use]
    fn tanh(self) -> Self;
    /// The angle of the point with ordinate `self` and abscissa `x`.
    #[must_use]
    fn atan2(self, x: Self) -> Self;
    /// The inverse sine.
    #[must_use]
    fn asin(self) -> Self;
    /// The inverse cosine.
    #[must_use]
    fn acos(self) -> Self;
    /// This number raised to a fixed real power.
    #[must_use]
    fn power(self, exponent: DoubleDouble) -> Self;
    /// This number raised to a power of its own kind.
    #[must_use]
    fn raised(self, exponent: Self) -> Self;
}

/// One number, which has a value.
pub trait Real: Analytic<Unit = f64> {
    /// Whether its range is practically unlimited.
    const UNBOUNDED: bool = false;
    /// The relative error of an operation, as for a double-double.
    const ROUNDING: f64 = f64::EPSILON * f64::EPSILON;

    /// The nearest `f64`.
    fn value(self) -> f64;
    /// The number as a [`DoubleDouble`].
    fn double(self) -> DoubleDouble;
    /// Whether it is a finite [`DoubleDouble`].
    fn is_finite(self) -> bool {
        self.double().is_finite()
    }
}

impl Real for f64 {
    const ROUNDING: f64 = f64::EPSILON;

    fn value(self) -> f64 {
        self
    }
    #[inline(always)]
    fn double(self) -> DoubleDouble {
        DoubleDouble::from(self)
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
}

impl Analytic for f64 {
    const ZERO: f64 = 0.0;
    const ONE: f64 = 1.0;
    type Unit = f64;
    type Lanes = [f64; LANES];
    const ZEROS: [f64; LANES] = [0.0; LANES];
    const SIDE: usize = LANES;

    #[inline(always)]
    fn scaled(self, power_of_two: f64) -> f64 {
        self * power_of_two
    }
    /// By one division, as every order waits for the one before.
    #[inline(always)]
    fn integrated<const FUSED: bool>(self, unit: f64, n: usize) -> f64 {
        self / (n as f64 / unit)
    }
    #[inline(always)]
    fn side_by_side(number: impl Fn(usize) -> f64) -> [f64; LANES] {
        let mut numbers = [0.0; LANES];
        for lane in 0..LANES {
            numbers[lane] = number(lane);
        }
        numbers
    }
    #[expect(
        clippy::manual_memcpy,
        reason = "is inlined into a kernel, which a copy of slices may not be"
    )]
    #[inline(always)]
    fn inner_products<const FUSED: bool>(
        left: &[[f64; LANES]],
        right: &[[f64; LANES]],
        out: &mut [f64],
    ) {
        let products = InnerProducts { left, right }.run::<FUSED>();
        for lane in 0..LANES {
            out[lane] = products[lane];
        }
    }

    #[inline(always)]
    fn floats(numbers: &mut [f64]) -> Option<&mut [f64]> {
        Some(numbers)
    }
    #[inline(always)]
    fn where_positive(self, a: f64, b: f64) -> f64 {
        if self.value() > 0.0 { a } else { b }
    }
    #[inline(always)]
    fn unless_vanishing(self, mut series: impl Iterator<Item = f64>) -> f64 {
        if series.all(|x| x.value() == 0.0) { f64::ZERO } else { self }
    }
    fn raised(self, exponent: f64) -> f64 {
        self.power(exponent.double())
    }

    fn of(x: DoubleDouble) -> f64 {
        x.high
    }
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    fn exp(self) -> f64 {
        math::exp(self)
    }
    fn ln(self) -> f64 {
        math::ln(self)
    }
    fn sin_cos(self) -> (f64, f64) {
        math::sin_cos(self)
    }
    fn tan(self) -> f64 {
        math::tan(self)
    }
    fn sinh_cosh(self) -> (f64, f64) {
        (math::sinh(self), math::cosh(self))
    }
    fn tanh(self) -> f64 {
        math::tanh(self)
    }
    fn atan2(self, x: f64) -> f64 {
        math::atan2(self, x)
    }
    fn asin(self) -> f64 {
        math::asin(self)
    }
    fn acos(self) -> f64 {
        math::acos(self)
    }
    fn power(self, exponent: DoubleDouble) -> f64 {
        let n = exponent.high;
        match (n.fract() == 0.0, (2.0 * n).fract() == 0.0) {
            _ if exponent.low != 0.0 || n.abs() > 1024.0 => math::powf(self, n),
            (true, _) => math::powi(self, n as i32),
            (_, true) if n < 0.0 => 1.0 / (f64::sqrt(self) * math::powi(self, -(n + 0.5) as i32)),
            (_, true) => f64::sqrt(self) * math::powi(self, (n - 0.5) as i32),
            _ => math::powf(self, n),
        }
    }
}
