//! Pair arithmetic: a number as two `f64` whose sum is never brought into the form of a double-double.
//!
//! In and out: [`Analytic`] numbers for the lowest orders of a series. Never here: elementary functions of its own.
//!
//! The first part of every result is what `f64` has, and the second the rounding errors so far, carried on to first order:
//!
//! ```text
//!   a + b    s = fl(a₁ + b₁)    (a₂ + b₂) + (a₁ + b₁ − s)
//!   a · b    p = fl(a₁ b₁)      (a₁ b₁ − p) + (a₁ b₂ + a₂ b₁)
//!   a / b    q = fl(a₁ / b₁)    ((a₁ − q b₁) + (a₂ − q b₂)) / b₁      of a double-double b
//! ```
//!
//! What is left out, and the rounding of the second part, is 2⁻¹⁰⁶ of the terms each time, as in a double-double; of the
//! terms, where these cancel, and not of their sum. So a sum takes 8 operations and not 20, a product 6 and not 9, and no
//! first part waits for a second one. Where a number is compared, divided by or given to a function, its parts are added up first.
//!
//! Source: M. Lange, S. M. Rump, "Faithfully rounded floating-point computations", ACM Transactions on Mathematical Software 46
//! (2020) 21.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::convolution::{DoubleLanes, InnerProducts, LANES};
use super::double_double::DoubleDouble;
use super::instruction_set::{Kernel, vectorized};
use super::real::{Analytic, Real};

/// `high + low`, of which `low` is small beside the terms that `high` was added up from.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
#[repr(C)]
pub struct FloatPair {
    /// The number as `f64` computes it.
    pub high: f64,
    /// Its error, with the other sign.
    pub low: f64,
}

impl From<DoubleDouble> for FloatPair {
    #[inline(always)]
    fn from(DoubleDouble { high, low }: DoubleDouble) -> FloatPair {
        FloatPair { high, low }
    }
}

impl FloatPair {
    /// Whether its reciprocal has all digits: [`DoubleDouble::has_reciprocal`].
    pub fn has_reciprocal(self) -> bool {
        self.double().has_reciprocal()
    }

    #[inline(always)]
    fn product<const FUSED: bool>(self, other: FloatPair) -> FloatPair {
        let DoubleDouble { high, low } = DoubleDouble::product_by::<FUSED>(self.high, other.high);
        FloatPair { high, low: low + (self.high * other.low + self.low * other.high) }
    }

    #[inline(always)]
    fn times_f64<const FUSED: bool>(self, factor: f64) -> FloatPair {
        let DoubleDouble { high, low } = DoubleDouble::product_by::<FUSED>(self.high, factor);
        FloatPair { high, low: low + self.low * factor }
    }

    #[inline(always)]
    fn quotient<const FUSED: bool>(self, divisor: FloatPair) -> FloatPair {
        let divisor = divisor.double();
        let high = self.high / divisor.high;
        if !high.is_finite() || !divisor.high.is_finite() {
            return FloatPair { high, low: 0.0 };
        }
        let part = DoubleDouble::product_by::<FUSED>(high, divisor.high);
        let rest = (self.high - part.high) - part.low;
        let rest = rest + (self.low - high * divisor.low);
        FloatPair { high, low: rest / divisor.high }
    }

    fn by(self, function: impl Fn(DoubleDouble) -> DoubleDouble) -> FloatPair {
        function(self.double()).into()
    }
}

impl Add for FloatPair {
    type Output = FloatPair;
    #[inline(always)]
    fn add(self, other: FloatPair) -> FloatPair {
        let DoubleDouble { high, low } = DoubleDouble::sum(self.high, other.high);
        FloatPair { high, low: (self.low + other.low) + low }
    }
}

impl Sub for FloatPair {
    type Output = FloatPair;
    #[inline(always)]
    fn sub(self, other: FloatPair) -> FloatPair {
        self + -other
    }
}

impl Neg for FloatPair {
    type Output = FloatPair;
    #[inline(always)]
    fn neg(self) -> FloatPair {
        FloatPair { high: -self.high, low: -self.low }
    }
}

/// Whether the instructions that the program was built for have a fused multiply-add.
const FUSED: bool = super::instruction_set::FUSED_PLAINLY;

impl Mul for FloatPair {
    type Output = FloatPair;
    #[inline]
    fn mul(self, other: FloatPair) -> FloatPair {
        self.product::<FUSED>(other)
    }
}

impl Mul<f64> for FloatPair {
    type Output = FloatPair;
    #[inline]
    fn mul(self, factor: f64) -> FloatPair {
        self.times_f64::<FUSED>(factor)
    }
}

impl Div for FloatPair {
    type Output = FloatPair;
    #[inline]
    fn div(self, divisor: FloatPair) -> FloatPair {
        self.quotient::<FUSED>(divisor)
    }
}

impl Div<f64> for FloatPair {
    type Output = FloatPair;
    #[inline]
    fn div(self, divisor: f64) -> FloatPair {
        self / FloatPair { high: divisor, low: 0.0 }
    }
}

impl Real for FloatPair {
    /// The sum of both parts, without the sign of a zero.
    #[inline(always)]
    fn value(self) -> f64 {
        self.high + (self.low + 0.0)
    }

    #[inline(always)]
    fn double(self) -> DoubleDouble {
        DoubleDouble::sum(self.high, self.low + 0.0)
    }
}

impl Analytic for FloatPair {
    const ZERO: FloatPair = FloatPair { high: 0.0, low: 0.0 };
    const ONE: FloatPair = FloatPair { high: 1.0, low: 0.0 };
    type Unit = f64;
    type Lanes = DoubleLanes<LANES>;
    const ZEROS: DoubleLanes<LANES> = DoubleLanes::ZERO;
    const SIDE: usize = LANES;

    #[inline(always)]
    fn of(x: DoubleDouble) -> FloatPair {
        x.into()
    }
    #[inline(always)]
    fn over<const FUSED: bool>(self, n: usize) -> FloatPair {
        self.product::<FUSED>(DoubleDouble::reciprocal(n).into())
    }
    #[inline(always)]
    fn multiple<const FUSED: bool>(self, n: usize) -> FloatPair {
        self.times_f64::<FUSED>(n as f64)
    }
    #[inline(always)]
    fn scaled(self, power_of_two: f64) -> FloatPair {
        FloatPair { high: self.high * power_of_two, low: self.low * power_of_two }
    }
    #[inline(always)]
    fn times<const FUSED: bool>(self, other: FloatPair) -> FloatPair {
        self.product::<FUSED>(other)
    }
    #[inline(always)]
    fn divided_by<const FUSED: bool>(self, divisor: FloatPair) -> FloatPair {
        self.quotient::<FUSED>(divisor)
    }
    #[inline(always)]
    fn divided_by_shared<const FUSED: bool>(self, divisor: FloatPair) -> FloatPair {
        if divisor.has_reciprocal() {
            self.product::<FUSED>(FloatPair::ONE.quotient::<FUSED>(divisor))
        } else {
            self.quotient::<FUSED>(divisor)
        }
    }
    #[inline(always)]
    fn side_by_side(number: impl Fn(usize) -> FloatPair) -> DoubleLanes<LANES> {
        let mut numbers = [FloatPair::ZERO; LANES];
        for lane in 0..LANES {
            numbers[lane] = number(lane);
        }
        DoubleLanes::of(numbers)
    }
    #[expect(
        clippy::manual_memcpy,
        reason = "is inlined into a kernel, which a copy of slices may not be"
    )]
    #[inline(always)]
    fn inner_products<const FUSED: bool>(
        left: &[DoubleLanes<LANES>],
        right: &[DoubleLanes<LANES>],
        out: &mut [FloatPair],
    ) {
        let products = InnerProducts { left, right }.run::<FUSED>();
        for lane in 0..LANES {
            out[lane] = products[lane];
        }
    }

    #[inline(always)]
    fn where_positive(self, a: FloatPair, b: FloatPair) -> FloatPair {
        if self.value() > 0.0 { a } else { b }
    }
    #[inline(always)]
    fn unless_vanishing(self, mut series: impl Iterator<Item = FloatPair>) -> FloatPair {
        if series.all(|x| x.value() == 0.0) { FloatPair::ZERO } else { self }
    }
    fn raised(self, exponent: FloatPair) -> FloatPair {
        self.power(exponent.double())
    }

    fn sqrt(self) -> FloatPair {
        self.by(Analytic::sqrt)
    }
    fn exp(self) -> FloatPair {
        self.by(Analytic::exp)
    }
    fn ln(self) -> FloatPair {
        self.by(Analytic::ln)
    }
    fn sin_cos(self) -> (FloatPair, FloatPair) {
        let (sine, cosine) = self.double().sin_cos();
        (sine.into(), cosine.into())
    }
    fn tan(self) -> FloatPair {
        self.by(Analytic::tan)
    }
    fn sinh_cosh(self) -> (FloatPair, FloatPair) {
        let (sine, cosine) = self.double().sinh_cosh();
        (sine.into(), cosine.into())
    }
    fn tanh(self) -> FloatPair {
        self.by(Analytic::tanh)
    }
    fn atan2(self, x: FloatPair) -> FloatPair {
        self.by(|y| y.atan2(x.double()))
    }
    fn asin(self) -> FloatPair {
        self.by(Analytic::asin)
    }
    fn acos(self) -> FloatPair {
        self.by(Analytic::acos)
    }
    fn power(self, exponent: DoubleDouble) -> FloatPair {
        let n = exponent.high;
        if exponent.low == 0.0 && n.abs() < 1024.0 && (2.0 * n).fract() == 0.0 {
            return vectorized(HalfIntegerPower { base: self, exponent: n });
        }
        self.by(|x| x.power(exponent))
    }
}

/// The kernel of a power whose exponent is an integer or one half beside one.
struct HalfIntegerPower {
    base: FloatPair,
    exponent: f64,
}

impl Kernel for HalfIntegerPower {
    type Output = FloatPair;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> FloatPair {
        let HalfIntegerPower { mut base, exponent } = self;
        let size = exponent.abs();
        let mut power = if size.fract() == 0.0 { FloatPair::ONE } else { base.sqrt() };
        let mut left = size as u32;
        while left > 0 {
            if left & 1 == 1 {
                power = power.product::<FUSED>(base);
            }
            base = base.product::<FUSED>(base);
            left >>= 1;
        }
        if exponent < 0.0 { FloatPair::ONE.quotient::<FUSED>(power) } else { power }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(k: i64) -> DoubleDouble {
        DoubleDouble::integer(k * k - 40 * k + 3) / DoubleDouble::integer(7 * k + 1)
    }

    fn bits(x: FloatPair) -> (u64, u64) {
        (x.high.to_bits(), x.low.to_bits())
    }

    #[test]
    fn a_fused_multiply_add_changes_no_bit() {
        for k in 0..100 {
            let (a, b) = (FloatPair::of(number(k)), FloatPair::of(number(k + 17)));
            assert_eq!(bits(a.product::<true>(b)), bits(a.product::<false>(b)));
            assert_eq!(bits(a.times_f64::<true>(b.high)), bits(a.times_f64::<false>(b.high)));
            assert_eq!(bits(a.quotient::<true>(b)), bits(a.quotient::<false>(b)));
            let shared = a.divided_by_shared::<true>(b);
            assert_eq!(bits(shared), bits(a.divided_by_shared::<false>(b)));
            let power = |fused: bool| {
                let power = HalfIntegerPower { base: a * a, exponent: -3.5 };
                if fused { power.run::<true>() } else { power.run::<false>() }
            };
            assert_eq!(bits(power(true)), bits(power(false)));
        }
    }

    /// Each operation against the same in double-double, also of numbers whose parts have cancelled.
    #[test]
    fn operations_have_the_digits_of_double_double() {
        let pairs = |k: i64| {
            let (x, third) = (number(k), number(k + 5) * 1e-17);
            // the same number in three forms
            let far = FloatPair { high: 1.0, low: 0.0 };
            [
                FloatPair::of(x + third),
                FloatPair::of(x) + FloatPair::of(third),
                (FloatPair::of(x + third) + far) - far,
            ]
        };
        for (k, m) in (0..60).flat_map(|k| (61..75).map(move |m| (k, m))) {
            for (a, b) in pairs(k).into_iter().flat_map(|a| pairs(m).map(|b| (a, b))) {
                let (x, y) = (a.double(), b.double());
                let size = (1.0 + x.high.abs()) * (1.0 + y.high.abs());
                let check = |found: FloatPair, right: DoubleDouble, size: f64| {
                    let off = (found.double() - right).high.abs();
                    assert!(off <= 1e-31 * size, "{a:?} {b:?}: {found:?} {right:?}");
                };
                check(a + b, x + y, size);
                check(a - b, x - y, size);
                check(a * b, x * y, size);
                check(a * 7.0, x * 7.0, 7.0 * size);
                check(a.over::<false>(7), x / 7.0, size);
                check(a / b, x / y, size / (y.high * y.high));
                check(a.divided_by_shared::<false>(b), x / y, size / (y.high * y.high));
            }
        }
    }

    #[test]
    fn what_cancels_is_compared_by_both_parts() {
        // 1 + u − 1 is u to all digits, though as `f64` it is not
        let small = FloatPair::of(DoubleDouble::from(1e-20));
        let left = (FloatPair::ONE + small) - FloatPair::ONE;
        assert_eq!((left.high, left.value()), (0.0, 1e-20));
        assert_eq!(left.where_positive(FloatPair::ONE, FloatPair::ZERO), FloatPair::ONE);
        let quotient = (FloatPair::ONE / left).value();
        assert!((quotient * 1e-20 - 1.0).abs() < 1e-15, "{quotient}");
        assert_eq!((-FloatPair::ZERO).value().to_bits(), 0);
    }
}
