//! A double-double with a separate exponent: numbers far beyond the range of `f64`, for moderate
//! results whose intermediate values overflow or underflow, such as `exp(x)` in `1/(1 + exp(x))`
//! for large `x`.
//!
//! In and out: [`Real`]. It is slower than both other precisions and meant for what they cannot do.

mod arithmetic;

use super::convolution::LANES;
use super::double_double::DoubleDouble;
use super::exponent::{Exponent, FAR_UNIT};
use super::math;
use super::real::{Analytic, Real};

/// `mantissa · 2^exponent`, with the mantissa in [1, 2) or (−2, −1], or zero, or not finite.
#[derive(Clone, Copy, Debug)]
pub struct ExtendedRange {
    mantissa: DoubleDouble,
    exponent: Exponent,
}

const LN_2: DoubleDouble =
    DoubleDouble { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 };

/// Adding numbers whose exponents differ by more than this leaves the larger one unchanged.
const DIGITS: i128 = 220;

/// Beyond this exponent of e^x no digit of the mantissa is known.
const LARGEST: f64 = (1_i128 << 120) as f64;

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
    fn new(mantissa: DoubleDouble, exponent: Exponent) -> ExtendedRange {
        let high = match exponent.beyond() {
            _ if mantissa.high == 0.0 => mantissa.high,
            0.0 => mantissa.high,
            f64::NEG_INFINITY if mantissa.high.is_finite() => 0.0,
            beyond => mantissa.high * beyond,
        };
        if high == 0.0 || !high.is_finite() {
            return ExtendedRange::moderate(DoubleDouble::from(high));
        }
        let field = i128::from(high.to_bits() >> 52 & 0x7FF);
        if field == 0 {
            let raised = DoubleDouble {
                high: high * power_of_two(200),
                low: mantissa.low * power_of_two(200),
            };
            return ExtendedRange::new(raised, exponent.plus(Exponent::of(-200)));
        }
        let n = field - 1023;
        if n == 0 {
            return ExtendedRange { mantissa, exponent };
        }
        let mantissa = DoubleDouble { high: scaled(high, -n), low: scaled(mantissa.low, -n) };
        ExtendedRange { mantissa, exponent: exponent.plus(Exponent::of(n)) }
    }

    /// A number within the range of `f64`, or zero, or one that is not finite.
    fn moderate(number: DoubleDouble) -> ExtendedRange {
        if number.high == 0.0 || !number.high.is_finite() {
            let mantissa = DoubleDouble::from(number.high);
            return ExtendedRange { mantissa, exponent: Exponent::ZERO };
        }
        ExtendedRange::new(number, Exponent::ZERO)
    }

    /// By how much its exponent is above that of another, neither of which is zero; not known of enormous exponents that are nearly
    /// the same.
    fn above(self, other: ExtendedRange) -> Option<i128> {
        let difference = self.exponent.minus(other.exponent);
        (!difference.is_unknown()).then(|| difference.moderate())
    }

    /// The number in units of the power of two in another one that is not zero.
    fn in_units_of(self, other: ExtendedRange) -> DoubleDouble {
        let Some(shift) = self.above(other) else { return DoubleDouble::from(f64::NAN) };
        let negligible = self.mantissa.high == 0.0 || shift < -DIGITS;
        if negligible && self.mantissa.high.is_finite() {
            return DoubleDouble::ZERO;
        }
        let high = scaled(self.mantissa.high, shift);
        let low = if high.is_finite() { scaled(self.mantissa.low, shift) } else { 0.0 };
        DoubleDouble { high, low }
    }

    /// Applies a function that accepts moderate numbers only.
    fn by(self, function: impl Fn(DoubleDouble) -> DoubleDouble) -> ExtendedRange {
        ExtendedRange::moderate(function(self.double()))
    }

    /// Returns whether it is so small that odd functions of slope 1 leave it unchanged.
    fn is_tiny(self) -> bool {
        self.mantissa.high == 0.0 || self.exponent.moderate() < TINY
    }

    /// The one of two numbers whose exponent is larger, or that is not zero.
    fn larger(self, other: ExtendedRange) -> ExtendedRange {
        let own = other.mantissa.high == 0.0
            || (self.mantissa.high != 0.0 && self.above(other) >= Some(0));
        if own { self } else { other }
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

/// x/ln 2 for a large x. The parts of a product are found by splitting, which overflows before the product does.
fn quotient_by_ln_2(x: DoubleDouble) -> DoubleDouble {
    (x.scaled(FAR_UNIT.recip()) / LN_2).scaled(FAR_UNIT)
}

impl Real for ExtendedRange {
    const UNBOUNDED: bool = true;

    fn value(self) -> f64 {
        scaled(self.mantissa.high, self.exponent.moderate())
    }

    fn double(self) -> DoubleDouble {
        let high = self.value();
        let low = if high.is_finite() {
            scaled(self.mantissa.low, self.exponent.moderate())
        } else {
            0.0
        };
        DoubleDouble { high, low }
    }
}

impl Analytic for ExtendedRange {
    const ZERO: ExtendedRange =
        ExtendedRange { mantissa: DoubleDouble::ZERO, exponent: Exponent::ZERO };
    const ONE: ExtendedRange =
        ExtendedRange { mantissa: DoubleDouble::ONE, exponent: Exponent::ZERO };
    type Unit = f64;
    type Lanes = [ExtendedRange; LANES];
    const ZEROS: [ExtendedRange; LANES] = [ExtendedRange::ZERO; LANES];
    const SIDE: usize = LANES;

    fn of(x: DoubleDouble) -> ExtendedRange {
        ExtendedRange::moderate(x)
    }

    fn sqrt(self) -> ExtendedRange {
        let (half, odd) = self.exponent.halved();
        let mantissa = Analytic::sqrt(self.mantissa * if odd == 1 { 2.0 } else { 1.0 });
        ExtendedRange::new(mantissa, half)
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
            return ExtendedRange::moderate(x.exp());
        }
        let n = (x.high / LN_2.high).round();
        if !n.is_finite() && self.mantissa.high.is_finite() {
            let exponent = Exponent::beyond_range(self.mantissa.high / LN_2.high, self.exponent);
            return ExtendedRange::new(DoubleDouble::ONE, exponent);
        }
        if !n.is_finite() {
            return ExtendedRange::moderate(DoubleDouble::from(math::exp(x.high)));
        }
        if n.abs() >= LARGEST {
            return ExtendedRange::new(DoubleDouble::ONE, Exponent::nearest(quotient_by_ln_2(x)));
        }
        let rest = x - LN_2 * n;
        // beyond 2⁵³ the nearest whole number is known to the digits of `f64` only
        let more = (rest.high / LN_2.high).round();
        let rest = rest - LN_2 * more;
        // beyond 1e30 no digit of the mantissa is known
        let mantissa = if rest.high.abs() < 1.0 { rest.exp() } else { DoubleDouble::ONE };
        ExtendedRange::new(mantissa, Exponent::of(n as i128 + more as i128))
    }

    fn ln(self) -> ExtendedRange {
        let high = self.mantissa.high;
        if high <= 0.0 || !high.is_finite() {
            return ExtendedRange::moderate(DoubleDouble::from(math::ln(high)));
        }
        let rest = ExtendedRange::moderate(self.mantissa.ln());
        let (exponent, unit) = self.exponent.value();
        rest + ExtendedRange::new(LN_2 * exponent, unit)
    }

    fn sin_cos(self) -> (ExtendedRange, ExtendedRange) {
        if self.is_tiny() {
            return (self, ExtendedRange::ONE);
        }
        let (sine, cosine) = self.double().sin_cos();
        (ExtendedRange::moderate(sine), ExtendedRange::moderate(cosine))
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
            return (ExtendedRange::moderate(sine), ExtendedRange::moderate(cosine));
        }
        let negative = self.mantissa.high < 0.0;
        let half = (if negative { -self } else { self }).exp() * 0.5;
        (if negative { -half } else { half }, half)
    }

    fn tanh(self) -> ExtendedRange {
        if self.is_tiny() { self } else { self.by(Analytic::tanh) }
    }

    fn atan2(self, x: ExtendedRange) -> ExtendedRange {
        if self.mantissa.high == 0.0 && x.mantissa.high == 0.0 {
            return ExtendedRange::moderate(Analytic::atan2(self.mantissa, x.mantissa));
        }
        if x.mantissa.high > 0.0
            && (self.mantissa.high == 0.0 || self.above(x).is_some_and(|above| above < TINY))
        {
            return self / x;
        }
        let larger = self.larger(x);
        let (ordinate, abscissa) = (self.in_units_of(larger), x.in_units_of(larger));
        ExtendedRange::moderate(Analytic::atan2(ordinate, abscissa))
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
            return ExtendedRange::moderate(DoubleDouble::from(math::powf(high, n)));
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
        for x in [1e36, 1e40, 1e300] {
            let (e, one) = (wide(x).exp(), ExtendedRange::ONE);
            assert_eq!((e / (one + e)).value(), 1.0, "{x:e}");
            assert_eq!((e / (one + e) / (one + e)).value(), 0.0, "{x:e}");
            let (s, c) = wide(-x).sinh_cosh();
            assert_eq!((s / c).value(), -1.0, "{x:e}");
            assert_eq!((one / c.power(DoubleDouble::from(2.0))).value(), 0.0, "{x:e}");
            close((one + e).ln(), x);
            // the slope of ln(1 + e^u)
            close(e * wide(0.7) / (one + e), 0.7);
        }
        for x in [1e40, 1e300, f64::INFINITY] {
            assert_eq!((ExtendedRange::ONE / (ExtendedRange::ONE + wide(x).exp())).value(), 0.0);
        }
        assert_eq!(wide(0.0).sqrt().value(), 0.0);
        assert_eq!((ExtendedRange::ONE + wide(1e-300)).value(), 1.0);
    }
}
