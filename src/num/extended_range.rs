//! A double-double with a separate exponent: numbers far beyond the range of `f64`, for moderate
//! results whose intermediate values overflow or underflow, such as `exp(x)` in `1/(1 + exp(x))`
//! for large `x`.
//!
//! In and out: [`Real`]. It is slower than both other precisions and meant for what they cannot do.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::convolution::LANES;
use super::double_double::DoubleDouble;
use super::math;
use super::real::{Analytic, Real};

/// `mantissa · 2^exponent`, with the mantissa in [1, 2) or (−2, −1], or zero, or not finite.
#[derive(Clone, Copy, Debug)]
pub struct ExtendedRange {
    mantissa: DoubleDouble,
    exponent: i128,
}

/// ln 2.
const LN_2: DoubleDouble =
    DoubleDouble { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 };

/// Adding numbers whose exponents differ by more than this leaves the larger one unchanged.
const DIGITS: i128 = 220;

/// Exponents beyond this count as infinity, or zero: e^x has an exponent for every |x| below 9e35.
const LARGEST: i128 = 1 << 120;

/// What the exponent of zero counts as in sums.
const LOWEST: i128 = i128::MIN / 4;

/// For an argument of this size e^−x is negligible against e^x, to all digits.
const LOPSIDED: f64 = 80.0;

/// The exponent below which x and sin x agree to all digits.
const TINY: i128 = -120;

/// `2^n` for |n| ≤ 1022.
fn power_of_two(n: i128) -> f64 {
    f64::from_bits(((1023 + n) as u64) << 52)
}

/// `x · 2^n`, in steps that do not overflow before the result does.
fn scaled(x: f64, n: i128) -> f64 {
    let (mut x, mut n) = (x, n.clamp(-4000, 4000));
    while n != 0 {
        let part = n.clamp(-1000, 1000);
        x *= power_of_two(part);
        n -= part;
    }
    x
}

impl ExtendedRange {
    fn new(mantissa: DoubleDouble, exponent: i128) -> ExtendedRange {
        let high = mantissa.high;
        if high == 0.0 || !high.is_finite() {
            return ExtendedRange { mantissa: DoubleDouble::from(high), exponent: 0 };
        }
        let field = i128::from(high.to_bits() >> 52 & 0x7FF);
        if field == 0 {
            let raised = DoubleDouble {
                high: high * power_of_two(200),
                low: mantissa.low * power_of_two(200),
            };
            return ExtendedRange::new(raised, exponent - 200);
        }
        let n = field - 1023;
        let exponent = exponent + n;
        if exponent > LARGEST {
            return ExtendedRange {
                mantissa: DoubleDouble::from(f64::INFINITY.copysign(high)),
                exponent: 0,
            };
        }
        if exponent < -LARGEST {
            return ExtendedRange { mantissa: DoubleDouble::ZERO, exponent: 0 };
        }
        if n == 0 {
            return ExtendedRange { mantissa, exponent };
        }
        let mantissa = DoubleDouble { high: scaled(high, -n), low: scaled(mantissa.low, -n) };
        ExtendedRange { mantissa, exponent }
    }

    /// The exponent, or for zero one lower than that of any other number.
    fn order(self) -> i128 {
        if self.mantissa.high == 0.0 { LOWEST } else { self.exponent }
    }

    /// The number in units of `2^exponent`.
    fn in_units(self, exponent: i128) -> DoubleDouble {
        let shift = self.order() - exponent;
        if shift < -DIGITS && self.mantissa.high.is_finite() {
            return DoubleDouble::ZERO;
        }
        let high = scaled(self.mantissa.high, shift);
        let low = if high.is_finite() { scaled(self.mantissa.low, shift) } else { 0.0 };
        DoubleDouble { high, low }
    }

    /// Applies a function that accepts moderate numbers only.
    fn by(self, function: impl Fn(DoubleDouble) -> DoubleDouble) -> ExtendedRange {
        ExtendedRange::new(function(self.double()), 0)
    }

    /// Returns whether it is so small that odd functions of slope 1 leave it unchanged.
    fn is_tiny(self) -> bool {
        self.order() < TINY
    }

    fn whole_power(self, n: u32) -> ExtendedRange {
        let (mut result, mut base, mut left) = (ExtendedRange::ONE, self, n);
        while left > 0 {
            if left & 1 == 1 {
                result = result * base;
            }
            base = base * base;
            left >>= 1;
        }
        result
    }
}

impl Add for ExtendedRange {
    type Output = ExtendedRange;
    fn add(self, other: ExtendedRange) -> ExtendedRange {
        let (a, b) = (self.mantissa.high, other.mantissa.high);
        if !a.is_finite() || !b.is_finite() {
            return ExtendedRange { mantissa: DoubleDouble::from(a + b), exponent: 0 };
        }
        let unit = self.order().max(other.order());
        if unit == LOWEST {
            return ExtendedRange::ZERO;
        }
        ExtendedRange::new(self.in_units(unit) + other.in_units(unit), unit)
    }
}

impl Sub for ExtendedRange {
    type Output = ExtendedRange;
    fn sub(self, other: ExtendedRange) -> ExtendedRange {
        self + -other
    }
}

impl Neg for ExtendedRange {
    type Output = ExtendedRange;
    fn neg(self) -> ExtendedRange {
        ExtendedRange { mantissa: -self.mantissa, exponent: self.exponent }
    }
}

impl Mul for ExtendedRange {
    type Output = ExtendedRange;
    fn mul(self, other: ExtendedRange) -> ExtendedRange {
        ExtendedRange::new(self.mantissa * other.mantissa, self.exponent + other.exponent)
    }
}

impl Div for ExtendedRange {
    type Output = ExtendedRange;
    fn div(self, other: ExtendedRange) -> ExtendedRange {
        if other.mantissa.high.is_infinite() && self.mantissa.high.is_finite() {
            return ExtendedRange::ZERO;
        }
        ExtendedRange::new(self.mantissa / other.mantissa, self.exponent - other.exponent)
    }
}

impl Mul<f64> for ExtendedRange {
    type Output = ExtendedRange;
    fn mul(self, other: f64) -> ExtendedRange {
        self * ExtendedRange::of(DoubleDouble::from(other))
    }
}

impl Div<f64> for ExtendedRange {
    type Output = ExtendedRange;
    fn div(self, other: f64) -> ExtendedRange {
        self / ExtendedRange::of(DoubleDouble::from(other))
    }
}

impl Real for ExtendedRange {
    const UNBOUNDED: bool = true;

    fn value(self) -> f64 {
        scaled(self.mantissa.high, self.exponent)
    }

    fn double(self) -> DoubleDouble {
        let high = self.value();
        let low = if high.is_finite() { scaled(self.mantissa.low, self.exponent) } else { 0.0 };
        DoubleDouble { high, low }
    }
}

impl Analytic for ExtendedRange {
    const ZERO: ExtendedRange = ExtendedRange { mantissa: DoubleDouble::ZERO, exponent: 0 };
    const ONE: ExtendedRange = ExtendedRange { mantissa: DoubleDouble::ONE, exponent: 0 };
    type Unit = f64;
    type Lanes = [ExtendedRange; LANES];
    const ZEROS: [ExtendedRange; LANES] = [ExtendedRange::ZERO; LANES];
    const SIDE: usize = LANES;

    fn of(x: DoubleDouble) -> ExtendedRange {
        ExtendedRange::new(x, 0)
    }

    fn sqrt(self) -> ExtendedRange {
        let odd = self.exponent.rem_euclid(2);
        let mantissa = Analytic::sqrt(self.mantissa * if odd == 1 { 2.0 } else { 1.0 });
        ExtendedRange::new(mantissa, (self.exponent - odd) / 2)
    }

    fn scaled(self, power_of_two: f64) -> ExtendedRange {
        self * power_of_two
    }

    fn side_by_side(number: impl Fn(usize) -> ExtendedRange) -> [ExtendedRange; LANES] {
        std::array::from_fn(number)
    }

    fn inner_products<const FUSED: bool>(
        left: &[[ExtendedRange; LANES]],
        right: &[[ExtendedRange; LANES]],
        out: &mut [ExtendedRange],
    ) {
        for (lane, out) in out.iter_mut().enumerate() {
            let pairs = left.iter().zip(right);
            *out = pairs.fold(ExtendedRange::ZERO, |sum, (a, b)| sum + a[lane] * b[lane]);
        }
    }

    #[inline(always)]
    fn where_positive(self, a: ExtendedRange, b: ExtendedRange) -> ExtendedRange {
        if self.value() > 0.0 { a } else { b }
    }
    #[inline(always)]
    fn unless_vanishing(self, mut series: impl Iterator<Item = ExtendedRange>) -> ExtendedRange {
        if series.all(|x| x.value() == 0.0) { ExtendedRange::ZERO } else { self }
    }
    fn raised(self, exponent: ExtendedRange) -> ExtendedRange {
        self.power(exponent.double())
    }

    fn exp(self) -> ExtendedRange {
        let x = self.double();
        if x.high.abs() < 600.0 {
            return ExtendedRange::new(x.exp(), 0);
        }
        let n = (x.high / LN_2.high).round();
        if n.abs() >= LARGEST as f64 || n.is_nan() {
            return ExtendedRange::new(DoubleDouble::from(math::exp(x.high)), 0);
        }
        let rest = x - LN_2 * n;
        // beyond 2⁵³ the nearest whole number is known to the digits of `f64` only
        let more = (rest.high / LN_2.high).round();
        let rest = rest - LN_2 * more;
        // beyond 1e30 no digit of the mantissa is known
        let mantissa = if rest.high.abs() < 1.0 { rest.exp() } else { DoubleDouble::ONE };
        ExtendedRange::new(mantissa, n as i128 + more as i128)
    }

    fn ln(self) -> ExtendedRange {
        let high = self.mantissa.high;
        if high <= 0.0 || !high.is_finite() {
            return ExtendedRange::new(DoubleDouble::from(math::ln(high)), 0);
        }
        let high = self.exponent as f64;
        let low = (self.exponent - high as i128) as f64;
        ExtendedRange::new(self.mantissa.ln() + LN_2 * high + LN_2 * low, 0)
    }

    fn sin_cos(self) -> (ExtendedRange, ExtendedRange) {
        if self.is_tiny() {
            return (self, ExtendedRange::ONE);
        }
        let (sine, cosine) = self.double().sin_cos();
        (ExtendedRange::new(sine, 0), ExtendedRange::new(cosine, 0))
    }

    fn tan(self) -> ExtendedRange {
        let (sine, cosine) = self.sin_cos();
        sine / cosine
    }

    fn sinh_cosh(self) -> (ExtendedRange, ExtendedRange) {
        if self.is_tiny() {
            return (self, ExtendedRange::ONE);
        }
        if self.value().abs() < LOPSIDED {
            let (sine, cosine) = self.double().sinh_cosh();
            return (ExtendedRange::new(sine, 0), ExtendedRange::new(cosine, 0));
        }
        let negative = self.mantissa.high < 0.0;
        let half = (if negative { -self } else { self }).exp() * 0.5;
        (if negative { -half } else { half }, half)
    }

    fn tanh(self) -> ExtendedRange {
        if self.is_tiny() { self } else { self.by(Analytic::tanh) }
    }

    fn atan2(self, x: ExtendedRange) -> ExtendedRange {
        let unit = self.order().max(x.order());
        if unit == LOWEST {
            return ExtendedRange::new(Analytic::atan2(self.mantissa, x.mantissa), 0);
        }
        if x.mantissa.high > 0.0 && self.order() < x.order() + TINY {
            return self / x;
        }
        ExtendedRange::new(Analytic::atan2(self.in_units(unit), x.in_units(unit)), 0)
    }

    fn asin(self) -> ExtendedRange {
        if self.is_tiny() { self } else { self.by(Analytic::asin) }
    }

    fn acos(self) -> ExtendedRange {
        self.by(Analytic::acos)
    }

    fn power(self, exponent: DoubleDouble) -> ExtendedRange {
        let n = exponent.high;
        if exponent.low == 0.0 && n.abs() < 1024.0 && (2.0 * n).fract() == 0.0 {
            let size = n.abs();
            let whole = self.whole_power(size as u32);
            let result = if size.fract() == 0.0 { whole } else { whole * self.sqrt() };
            return if n < 0.0 { ExtendedRange::ONE / result } else { result };
        }
        let high = self.mantissa.high;
        if high <= 0.0 || !high.is_finite() {
            return ExtendedRange::new(DoubleDouble::from(math::powf(high, n)), 0);
        }
        (self.ln() * ExtendedRange::of(exponent)).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wide(x: f64) -> ExtendedRange {
        ExtendedRange::of(DoubleDouble::from(x))
    }

    fn close(a: ExtendedRange, b: f64) {
        assert!((a.value() - b).abs() <= 4e-16 * b.abs(), "{a:?} and {b}");
    }

    #[test]
    fn what_leaves_the_range_of_f64_comes_back() {
        for x in [400.0, 1e3, 1e5, 1e10, 8e17, 1e25, 1e35] {
            let (e, one) = (wide(x).exp(), ExtendedRange::ONE);
            assert_eq!((e / (one + e)).value(), 1.0);
            assert_eq!((one / (one + e)).value(), 0.0_f64.max(math::exp(-x)));
            close((one + e).ln(), x);
            close((e * wide(-x).exp()).sqrt(), 1.0);
            let (s, c) = wide(-x).sinh_cosh();
            assert_eq!((s / c).value(), -1.0);
            close((c * c * 4.0).ln() / 2.0, x);
        }
        close(wide(1e300) * wide(1e300) / wide(1e301), 1e299);
        close(wide(1e-300) * wide(1e-300) / wide(1e-301), 1e-299);
        close(wide(5e-324) * wide(1e300) * 1e24, 5e-324 * 1e300 * 1e24);
        close((wide(1e200) * wide(1e200)).power(DoubleDouble::from(0.25)), 1e100);
        // powers of two, which are exact: 2^−1200 to the power −5/4
        let (small, large) = (power_of_two(-600), power_of_two(750));
        let power = (wide(small) * wide(small)).power(DoubleDouble::from(-1.25));
        close(power / large / large, 1.0);
    }

    #[test]
    fn moderate_numbers_are_those_of_double_double() {
        for x in [-3.7, -1.0, -0.3, 1e-30, 0.4, 0.9, 2.5, 70.0] {
            let d = DoubleDouble::from(x);
            close(wide(x).exp(), d.exp().high);
            close(wide(x).sinh_cosh().0, d.sinh_cosh().0.high);
            close(wide(x).tanh(), d.tanh().high);
            close(wide(x).sin_cos().0, d.sin_cos().0.high);
            close(wide(x).tan(), Analytic::tan(d).high);
            close(wide(x) - wide(0.7), x - 0.7);
            close(wide(x).atan2(wide(-0.2)), math::atan2(x, -0.2));
            if x > 0.0 {
                close(wide(x).ln(), d.ln().high);
                close(wide(x).sqrt(), x.sqrt());
                close(wide(x).power(DoubleDouble::from(1.7)), math::powf(x, 1.7));
            }
        }
        close(wide(0.3).asin(), math::asin(0.3));
        close(wide(0.3).acos(), math::acos(0.3));
    }

    #[test]
    fn zero_and_infinity_keep_their_meaning() {
        assert_eq!((wide(0.0) + wide(0.0)).value(), 0.0);
        assert_eq!((wide(2.0) - wide(2.0)).value(), 0.0);
        assert_eq!((ExtendedRange::ONE / wide(0.0)).value(), f64::INFINITY);
        assert!((wide(0.0) / wide(0.0)).value().is_nan());
        assert!(wide(-1.0).ln().value().is_nan() && wide(-1.0).sqrt().value().is_nan());
        assert!((wide(f64::NAN) + ExtendedRange::ONE).value().is_nan());
        assert!((wide(f64::INFINITY) - wide(f64::INFINITY)).value().is_nan());
        assert_eq!(wide(1e30).exp().value(), f64::INFINITY);
        assert_eq!(wide(-1e30).exp().value(), 0.0);
        for x in [1e40, 1e300, f64::INFINITY] {
            assert_eq!((ExtendedRange::ONE / (ExtendedRange::ONE + wide(x).exp())).value(), 0.0);
        }
        assert_eq!(wide(0.0).sqrt().value(), 0.0);
        assert_eq!((ExtendedRange::ONE + wide(1e-300)).value(), 1.0);
    }
}
