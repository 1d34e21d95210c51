//! Double-double arithmetic: a real number as the unevaluated sum of two `f64`, with about 31
//! decimal digits. It is used where rounding must not be visible: the lowest orders of a Taylor
//! step, constants and parameters, displayed values of a state. A fused
//! multiply-add serves only to find the rounding error of a product, which Dekker's splitting finds
//! as well: results are the same on every machine, but for the ends of the range.
//!
//! Sources: T. J. Dekker, Numer. Math. 18 (1971) 224 (products); D. E. Knuth, The Art of Computer
//! Programming 2, 4.2.2 (sums); Y. Hida, X. S. Li, D. H. Bailey, 15th IEEE Symposium on Computer
//! Arithmetic (2001) 155 (division, root).

mod elementary;

use std::io::Write as _;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `high + low`, with `low` at most half a unit in the last place of `high`. It is accurate for
/// magnitudes below 1e290.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
#[repr(C)]
pub struct DoubleDouble {
    /// The nearest `f64`.
    pub high: f64,
    /// The remainder.
    pub low: f64,
}

impl DoubleDouble {
    /// 0 without a sign.
    pub const ZERO: DoubleDouble = DoubleDouble { high: 0.0, low: 0.0 };
    /// One.
    pub const ONE: DoubleDouble = DoubleDouble { high: 1.0, low: 0.0 };
    /// The number π.
    pub const PI: DoubleDouble =
        DoubleDouble { high: std::f64::consts::PI, low: 1.224_646_799_147_353_2e-16 };

    /// `a + b` exactly.
    #[inline(always)]
    pub fn sum(a: f64, b: f64) -> DoubleDouble {
        let high = a + b;
        let part = high - a;
        DoubleDouble { high, low: (a - (high - part)) + (b - part) }
    }

    /// `a + b` exactly, for `|a| ≥ |b|`.
    #[inline(always)]
    fn ordered_sum(a: f64, b: f64) -> DoubleDouble {
        let high = a + b;
        DoubleDouble { high, low: b - (high - a) }
    }

    /// `a · b` exactly.
    #[inline]
    pub fn product(a: f64, b: f64) -> DoubleDouble {
        DoubleDouble::product_by::<FUSED>(a, b)
    }

    /// `a · b` exactly, by a fused multiply-add or without: the bits are the same, as either gives
    /// the rounding error exactly, of factors below 1e300 and a product above 1e−290.
    #[inline(always)]
    pub(super) fn product_by<const FUSED: bool>(a: f64, b: f64) -> DoubleDouble {
        let high = a * b;
        if FUSED {
            return DoubleDouble { high, low: a.mul_add(b, -high) };
        }
        let ((a1, a2), (b1, b2)) = (split(a), split(b));
        DoubleDouble { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
    }

    /// An integer, converted exactly.
    pub fn integer(n: i64) -> DoubleDouble {
        let low = n & 0xFFFF_FFFF;
        DoubleDouble::sum((n - low) as f64, low as f64)
    }

    /// The decimal number that the shortest literal for `x` denotes: what a user means by 0.1,
    /// which no `f64` equals. `x` is the nearest `f64` to it.
    pub fn from_decimal(x: f64) -> DoubleDouble {
        if (x.fract() == 0.0 && x.abs() < 9e15) || !x.is_finite() {
            return DoubleDouble::from(x);
        }
        match decimal(x) {
            Some((digits, exponent)) if exponent.abs() < 250 => {
                let (mantissa, power) =
                    (DoubleDouble::integer(digits), power_of_ten(exponent.abs()));
                if exponent < 0 { mantissa / power } else { mantissa * power }
            }
            _ => DoubleDouble::from(x),
        }
    }

    /// Returns whether it is finite.
    pub fn is_finite(self) -> bool {
        self.high.is_finite() && self.low.is_finite()
    }

    /// Whether its reciprocal has all digits, so that a quotient by it can be a product.
    pub fn has_reciprocal(self) -> bool {
        (1e-250..1e250).contains(&self.high.abs())
    }

    /// The square root.
    fn root(self) -> DoubleDouble {
        if self.high <= 0.0 {
            return DoubleDouble::from(self.high.sqrt());
        }
        let x = 1.0 / self.high.sqrt();
        let y = self.high * x;
        let rest = (self - DoubleDouble::product(y, y)).high;
        DoubleDouble::sum(y, rest * (x * 0.5))
    }
}

/// The digits and the exponent of the shortest decimal that reads back to `x`, which has a
/// fractional part.
fn decimal(x: f64) -> Option<(i64, i32)> {
    // Of few digits: no other integer is as close to x · 10ᵏ as the rounding of that product and
    // half a unit in the last place of x, which are below 3/16 together, and the quotient of two
    // exact numbers is rounded as a literal is.
    for (k, power) in (1..).zip(&POWERS[1..16]) {
        let digits = (x * power).round();
        if digits.abs() >= FEW {
            break;
        }
        if digits / power == x {
            return Some((digits as i64, -k));
        }
    }
    let mut text = [0_u8; 32];
    let mut rest = &mut text[..];
    write!(rest, "{x:e}").ok()?;
    let left = rest.len();
    let length = text.len() - left;
    let (mut digits, mut behind_point, mut fraction) = (0_i64, 0, false);
    let mut bytes = text[..length].iter();
    for byte in bytes.by_ref() {
        match byte {
            b'-' => {}
            b'.' => fraction = true,
            b'e' => break,
            digit => {
                digits = 10 * digits + i64::from(digit - b'0');
                behind_point += i32::from(fraction);
            }
        }
    }
    let exponent: i32 = std::str::from_utf8(bytes.as_slice()).ok()?.parse().ok()?;
    Some((if x < 0.0 { -digits } else { digits }, exponent - behind_point))
}

/// An integer below this times a power of ten is rounded by less than 1/16.
const FEW: f64 = (1_u64 << 50) as f64;

/// The powers of ten that an `f64` holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// A power of ten, accurate to the last digits.
fn power_of_ten(n: i32) -> DoubleDouble {
    if let Some(&exact) = POWERS.get(n as usize) {
        return DoubleDouble::from(exact);
    }
    let (mut result, mut base, mut n) = (DoubleDouble::ONE, DoubleDouble::from(10.0), n);
    while n > 0 {
        if n & 1 == 1 {
            result = result * base;
        }
        base = base * base;
        n >>= 1;
    }
    result
}

/// Splits `a` into two halves of 26 bits each (Veltkamp).
#[inline]
fn split(a: f64) -> (f64, f64) {
    let t = 134_217_729.0 * a;
    let high = t - (t - a);
    (high, a - high)
}

impl From<f64> for DoubleDouble {
    #[inline(always)]
    fn from(high: f64) -> DoubleDouble {
        DoubleDouble { high, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = DoubleDouble;
    #[inline(always)]
    fn add(self, other: DoubleDouble) -> DoubleDouble {
        let (s, t) =
            (DoubleDouble::sum(self.high, other.high), DoubleDouble::sum(self.low, other.low));
        let v = DoubleDouble::ordered_sum(s.high, s.low + t.high);
        DoubleDouble::ordered_sum(v.high, t.low + v.low)
    }
}

impl Sub for DoubleDouble {
    type Output = DoubleDouble;
    #[inline(always)]
    fn sub(self, other: DoubleDouble) -> DoubleDouble {
        self + -other
    }
}

impl Neg for DoubleDouble {
    type Output = DoubleDouble;
    #[inline(always)]
    fn neg(self) -> DoubleDouble {
        DoubleDouble { high: -self.high, low: -self.low }
    }
}

/// Whether the instructions that the program was built for have a fused multiply-add.
const FUSED: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

/// Operations by a fused multiply-add or without: the bits are the same, as those of
/// [`DoubleDouble::product_by`].
impl DoubleDouble {
    #[inline(always)]
    fn times_double<const FUSED: bool>(self, other: DoubleDouble) -> DoubleDouble {
        let p = DoubleDouble::product_by::<FUSED>(self.high, other.high);
        DoubleDouble::ordered_sum(p.high, p.low + (self.high * other.low + self.low * other.high))
    }

    #[inline(always)]
    fn times_f64<const FUSED: bool>(self, other: f64) -> DoubleDouble {
        let p = DoubleDouble::product_by::<FUSED>(self.high, other);
        DoubleDouble::ordered_sum(p.high, p.low + self.low * other)
    }

    #[inline(always)]
    fn quotient<const FUSED: bool>(self, other: DoubleDouble) -> DoubleDouble {
        let first = self.high / other.high;
        if !first.is_finite() || !other.high.is_finite() {
            return DoubleDouble::from(first);
        }
        let rest = self - other.times_f64::<FUSED>(first);
        let second = rest.high / other.high;
        let third = (rest - other.times_f64::<FUSED>(second)).high / other.high;
        let quotient = DoubleDouble::ordered_sum(first, second);
        DoubleDouble::ordered_sum(quotient.high, quotient.low + third)
    }
}

impl Mul for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn mul(self, other: DoubleDouble) -> DoubleDouble {
        self.times_double::<FUSED>(other)
    }
}

impl Mul<f64> for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn mul(self, other: f64) -> DoubleDouble {
        self.times_f64::<FUSED>(other)
    }
}

impl Div for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn div(self, other: DoubleDouble) -> DoubleDouble {
        self.quotient::<FUSED>(other)
    }
}

impl Div<f64> for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn div(self, other: f64) -> DoubleDouble {
        let first = self.high / other;
        let rest = self - DoubleDouble::product(first, other);
        DoubleDouble::ordered_sum(first, (rest.high + rest.low) / other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Analytic;

    #[test]
    fn a_fused_multiply_add_changes_no_bit() {
        let number =
            |k: i64| DoubleDouble::integer(k * k - 40 * k + 3) / DoubleDouble::integer(7 * k + 1);
        let bits = |x: DoubleDouble| (x.high.to_bits(), x.low.to_bits());
        for k in 0..100 {
            let (a, b) = (number(k), number(k + 17));
            assert_eq!(bits(a.times_double::<true>(b)), bits(a.times_double::<false>(b)));
            assert_eq!(bits(a.times_f64::<true>(b.high)), bits(a.times_f64::<false>(b.high)));
            assert_eq!(bits(a.quotient::<true>(b)), bits(a.quotient::<false>(b)));
            let rest = a.quotient::<true>(b) * b - a;
            assert!(rest.high.abs() <= 1e-30 * a.high.abs(), "{a:?} / {b:?}");
            let quotient = a.divided_by_shared::<true>(b);
            assert_eq!(bits(quotient), bits(a.divided_by_shared::<false>(b)));
            let error = (quotient - a / b).high.abs();
            assert!(error <= 1e-31 * (a / b).high.abs(), "{a:?} / {b:?}: {error:e}");
        }
    }

    #[test]
    fn what_is_not_renormalized_loses_no_digits_of_its_terms() {
        let number =
            |k: i64| DoubleDouble::integer(k * k - 40 * k + 3) / DoubleDouble::integer(7 * k + 1);
        let bits = |x: DoubleDouble| (x.high.to_bits(), x.low.to_bits());
        for k in 0..100 {
            // the second and the third nearly cancel
            let (a, b) = (number(k), number(k + 17));
            let c = DoubleDouble::ZERO - b * DoubleDouble { high: 1.0, low: 1e-20 };
            let product = a.times_unnormalized::<true>(b);
            assert_eq!(bits(product), bits(a.times_unnormalized::<false>(b)));
            assert_eq!(bits(a.multiple::<true>(7)), bits(a.multiple::<false>(7)));
            assert_eq!(bits(a.over::<true>(7)), bits(a.over::<false>(7)));
            let terms = [a.multiple::<true>(7), a.over::<true>(7), product, b, c];
            let exact = [a * 7.0, a / 7.0, a * b, b, c];
            let (mut sum, mut size) = (DoubleDouble::ZERO, 0.0);
            for n in 0..terms.len() {
                sum = sum.plus_unnormalized(terms[n]);
                size += terms[n].high.abs();
                let right = exact[..=n].iter().fold(DoubleDouble::ZERO, |sum, &x| sum + x);
                let found = sum.renormalized();
                assert!((found - right).high.abs() <= 1e-31 * size, "{found:?} {right:?}");
                assert_eq!(found.high, found.high + found.low);
            }
        }
    }

    #[test]
    fn a_reciprocal_has_all_digits_within_two_hundred_and_fifty_powers_of_ten() {
        for (x, has) in [
            (0.99e250, true),
            (1.01e250, false),
            (-1.01e-250, true),
            (-0.99e-250, false),
            (0.0, false),
            (f64::INFINITY, false),
            (f64::NAN, false),
        ] {
            assert_eq!(DoubleDouble::from(x).has_reciprocal(), has, "{x:e}");
            // the quotient itself where it has none
            let (one, x) = (DoubleDouble::from(3.0), DoubleDouble::from(x));
            let bits = |x: DoubleDouble| (x.high.to_bits(), x.low.to_bits());
            if !has {
                let found = one.divided_by_shared::<true>(x);
                assert_eq!(bits(found), bits(one.divided_by::<true>(x)));
            }
        }
    }
}
