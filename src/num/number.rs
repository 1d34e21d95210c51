//! A constant in an expression: an exact rational if it fits 64 bits, else an `f64`. Arithmetic is
//! exact as long as possible and falls back to `f64` on overflow.

use std::cmp::Ordering;
use std::hash::{Hash, Hasher};
use std::ops::{Add, Mul, Neg};

use super::double_double::DoubleDouble;
use crate::num::math;

/// A sum of two reals below this fraction of them counts as rounding error of 0, because each went
/// through several operations.
const CANCELLED: f64 = 32.0 * f64::EPSILON;

/// An exact rational `numerator / denominator` (in lowest terms, with positive denominator) or a
/// real.
#[derive(Clone, Copy, Debug)]
pub enum Number {
    /// `numerator / denominator`, in lowest terms, with a positive denominator.
    Rational(i64, i64),
    /// A number that does not fit a 64-bit rational.
    Real(f64),
}

impl Number {
    /// 0, an exact integer.
    pub const ZERO: Number = Number::Rational(0, 1);
    /// One.
    pub const ONE: Number = Number::Rational(1, 1);
    /// −1, an exact integer.
    pub const MINUS_ONE: Number = Number::Rational(-1, 1);
    /// ½, an exact ratio.
    pub const HALF: Number = Number::Rational(1, 2);

    /// The integer `n`.
    pub fn integer(n: i64) -> Number {
        Number::Rational(n, 1)
    }

    /// `numerator / denominator`; NaN if the denominator is zero.
    pub fn ratio(numerator: i128, denominator: i128) -> Number {
        if let (Ok(n), Ok(d @ 1..)) = (i64::try_from(numerator), i64::try_from(denominator))
            && n != i64::MIN
        {
            let divisor = gcd_of_words(n.unsigned_abs(), d.unsigned_abs()) as i64;
            return Number::Rational(n / divisor, d / divisor);
        }
        if denominator == 0 {
            return Number::Real(f64::NAN);
        }
        let divisor = gcd(numerator.unsigned_abs(), denominator.unsigned_abs()) as i128;
        let sign = denominator.signum();
        let (n, d) = (sign * numerator / divisor, sign * denominator / divisor);
        match (i64::try_from(n), i64::try_from(d)) {
            (Ok(n), Ok(d)) if n != i64::MIN => Number::Rational(n, d),
            _ => Number::Real(n as f64 / d as f64),
        }
    }

    /// Reads a literal of the file syntax (`3`, `.5`, `1.`, `2.5e-3`), exactly if it fits. Returns
    /// `None` if it is not such a literal or overflows an `f64`.
    pub fn from_literal(text: &str) -> Option<Number> {
        let real: f64 = text.parse().ok()?;
        if !real.is_finite() {
            return None;
        }
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((m, e)) => (m, e.parse::<i32>().ok()?),
            None => (text, 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let digits = format!("{whole}{fraction}");
        let scale = exponent - i32::try_from(fraction.len()).ok()?;
        let exact = (|| {
            let digits = digits.trim_start_matches('0');
            let n: i128 = if digits.is_empty() { 0 } else { digits.parse().ok()? };
            if n == 0 {
                return Some(Number::ZERO);
            }
            let power = 10_i128.checked_pow(scale.unsigned_abs())?;
            let (n, d) = if scale >= 0 { (n.checked_mul(power)?, 1) } else { (n, power) };
            match Number::ratio(n, d) {
                // beyond 2^53 the quotient would be rounded twice
                Number::Rational(n, d) if n.max(d) < 1 << 53 => Some(Number::Rational(n, d)),
                _ => None,
            }
        })();
        Some(exact.unwrap_or(Number::Real(real)))
    }

    /// Converts a real that equals a short decimal literal to that rational, so that every number
    /// has one form.
    #[must_use]
    pub fn canonical(self) -> Number {
        match self {
            Number::Real(x) if x.is_finite() => {
                let size = Number::from_literal(&x.abs().to_string()).unwrap_or(self);
                if x < 0.0 { -size } else { size }
            }
            _ => self,
        }
    }

    /// Whether it has so many digits that the products of a few such numbers are no longer exact.
    pub fn is_long(self) -> bool {
        const LONGEST: u128 = 1 << 40;
        match self {
            Number::Rational(n, d) => {
                u128::from(n.unsigned_abs()) * u128::from(d.unsigned_abs()) > LONGEST
            }
            Number::Real(_) => true,
        }
    }

    /// The quotient of two reals as a fraction of small numbers, if it is one to rounding.
    pub fn short_ratio(a: f64, b: f64) -> Option<Number> {
        const LARGEST: f64 = 64.0;
        (1..=LARGEST as i64).find_map(|d| {
            let n = a / b * d as f64;
            let whole = n.round();
            let close = (n - whole).abs() <= 4.0 * f64::EPSILON * n.abs();
            let short = (1.0..=LARGEST).contains(&whole.abs());
            (close && short).then(|| Number::ratio(whole as i128, i128::from(d)))
        })
    }

    /// The nearest `f64`.
    pub fn value(self) -> f64 {
        match self {
            Number::Rational(n, d) => n as f64 / d as f64,
            Number::Real(x) => x,
        }
    }

    /// The number with twice the digits of an `f64`; a real stands for the decimal it is read from.
    pub fn double(self) -> DoubleDouble {
        match self {
            Number::Rational(n, d) => DoubleDouble::integer(n) / DoubleDouble::integer(d),
            Number::Real(x) => DoubleDouble::from_decimal(x),
        }
    }

    /// The number as an integer, if it is one.
    pub fn as_integer(self) -> Option<i64> {
        match self {
            Number::Rational(n, 1) => Some(n),
            _ => None,
        }
    }

    /// Returns whether it is exactly zero.
    pub fn is_zero(self) -> bool {
        match self {
            Number::Rational(n, _) => n == 0,
            Number::Real(x) => x == 0.0,
        }
    }

    /// Returns whether it is exactly one.
    pub fn is_one(self) -> bool {
        self == Number::ONE
    }

    /// Returns whether it is negative.
    pub fn is_negative(self) -> bool {
        match self {
            Number::Rational(n, _) => n < 0,
            Number::Real(x) => x < 0.0,
        }
    }

    /// The absolute value.
    #[must_use]
    pub fn abs(self) -> Number {
        if self.is_negative() { -self } else { self }
    }

    /// `1 / self`; NaN for zero.
    #[must_use]
    pub fn recip(self) -> Number {
        match self {
            Number::Rational(n, d) => Number::ratio(i128::from(d), i128::from(n)),
            Number::Real(x) => Number::Real(1.0 / x),
        }
    }

    /// `self ^ n` for an integer `n`.
    #[must_use]
    pub fn powi(self, n: i64) -> Number {
        if n < 0 {
            return self.recip().powi(-n);
        }
        if n > 4096 || matches!(self, Number::Real(_)) {
            return match (self, self.value()) {
                (Number::Rational(..), 1.0) => Number::ONE,
                (Number::Rational(..), 0.0) => Number::ZERO,
                (_, x) => Number::Real(math::powf(x, n as f64)),
            };
        }
        let (mut result, mut base, mut n) = (Number::ONE, self, n);
        while n > 0 {
            if n & 1 == 1 {
                result = result * base;
            }
            n >>= 1;
            if n > 0 {
                base = base * base;
            }
        }
        result
    }

    /// `self ^ exponent`, if the result is an exact rational: integer exponents, and perfect powers
    /// such as `(4/9)^(1/2)`.
    pub fn exact_power(self, exponent: Number) -> Option<Number> {
        let (Number::Rational(n, d), Number::Rational(en, ed)) = (self, exponent) else {
            return None;
        };
        if ed == 1 {
            return match self.powi(en) {
                exact @ Number::Rational(..) => Some(exact),
                Number::Real(_) => None,
            };
        }
        if n <= 0 || ed > 64 {
            return None;
        }
        let root = Number::Rational(exact_root(n, ed)?, exact_root(d, ed)?);
        root.exact_power(Number::integer(en))
    }

    /// The greatest common divisor of two rationals (positive), or 1 if either is real or zero.
    #[must_use]
    pub fn common_divisor(self, other: Number) -> Number {
        match (self, other) {
            (Number::Rational(a, 1), Number::Rational(c, 1)) if a != 0 && c != 0 => {
                let divisor = gcd_of_words(a.unsigned_abs(), c.unsigned_abs());
                Number::ratio(i128::from(divisor), 1)
            }
            (Number::Rational(a, b), Number::Rational(c, d)) if a != 0 && c != 0 => {
                let n = gcd(u128::from(a.unsigned_abs()), u128::from(c.unsigned_abs()));
                let m = gcd(b as u128, d as u128);
                Number::ratio(n as i128, i128::from(b) / m as i128 * i128::from(d))
            }
            _ => Number::ONE,
        }
    }

    /// Returns whether it is finite.
    pub fn is_finite(self) -> bool {
        self.value().is_finite()
    }
}

/// The greatest common divisor, and 1 for two zeros.
pub fn gcd(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        if let (Ok(a), Ok(b)) = (u64::try_from(a), u64::try_from(b)) {
            return u128::from(gcd_of_words(a, b));
        }
        (a, b) = (b, a % b);
    }
    a.max(1)
}

/// The greatest common divisor, and 1 for two zeros, by subtraction and shifts (Stein).
fn gcd_of_words(a: u64, b: u64) -> u64 {
    if a == 0 || b == 0 {
        return (a | b).max(1);
    }
    let shift = (a | b).trailing_zeros();
    let (mut a, mut b) = (a >> a.trailing_zeros(), b);
    while b != 0 {
        b >>= b.trailing_zeros();
        (a, b) = (a.min(b), a.max(b) - a.min(b));
    }
    a << shift
}

/// The integer `r` with `r^degree = n`, if there is one.
fn exact_root(n: i64, degree: i64) -> Option<i64> {
    let guess = math::powf(n as f64, 1.0 / degree as f64).round() as i64;
    (guess.max(1) - 1..=guess + 1).find(|&r| Number::integer(r).powi(degree) == Number::integer(n))
}

/// An integer that fits, as a number.
fn whole(n: Option<i64>) -> Option<Number> {
    n.filter(|&n| n != i64::MIN).map(Number::integer)
}

impl Add for Number {
    type Output = Number;
    fn add(self, other: Number) -> Number {
        if let (Number::Rational(a, 1), Number::Rational(c, 1)) = (self, other)
            && let Some(sum) = whole(a.checked_add(c))
        {
            return sum;
        }
        match (self, other) {
            (Number::Rational(a, b), Number::Rational(c, d)) => {
                let (a, b, c, d) = (i128::from(a), i128::from(b), i128::from(c), i128::from(d));
                Number::ratio(a * d + c * b, b * d)
            }
            (Number::Real(a), Number::Real(b)) => {
                let total = a + b;
                // the rounding error of two terms that cancel
                let noise = total.abs() <= CANCELLED * f64::max(a.abs(), b.abs());
                if noise && total.is_finite() { Number::ZERO } else { Number::Real(total) }
            }
            _ => Number::Real(self.value() + other.value()),
        }
    }
}

impl Mul for Number {
    type Output = Number;
    fn mul(self, other: Number) -> Number {
        if let (Number::Rational(a, 1), Number::Rational(c, 1)) = (self, other)
            && let Some(product) = whole(a.checked_mul(c))
        {
            return product;
        }
        match (self, other) {
            (Number::Rational(a, b), Number::Rational(c, d)) => {
                Number::ratio(i128::from(a) * i128::from(c), i128::from(b) * i128::from(d))
            }
            _ => Number::Real(self.value() * other.value()),
        }
    }
}

impl Neg for Number {
    type Output = Number;
    fn neg(self) -> Number {
        match self {
            Number::Rational(n, d) => Number::Rational(-n, d),
            Number::Real(x) => Number::Real(-x),
        }
    }
}

impl PartialEq for Number {
    fn eq(&self, other: &Number) -> bool {
        match (self, other) {
            (Number::Rational(a, b), Number::Rational(c, d)) => (a, b) == (c, d),
            (Number::Real(x), Number::Real(y)) => x.to_bits() == y.to_bits(),
            _ => false,
        }
    }
}

impl Eq for Number {}

impl PartialOrd for Number {
    fn partial_cmp(&self, other: &Number) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Number {
    /// Compares by value; a rational and a real of the same value are distinct.
    fn cmp(&self, other: &Number) -> Ordering {
        match (self, other) {
            (Number::Rational(a, b), Number::Rational(c, d)) if b == d => a.cmp(c),
            (Number::Rational(a, b), Number::Rational(c, d)) => {
                (i128::from(*a) * i128::from(*d)).cmp(&(i128::from(*c) * i128::from(*b)))
            }
            (Number::Real(_), Number::Rational(..)) => {
                self.value().total_cmp(&other.value()).then(Ordering::Greater)
            }
            (Number::Rational(..), Number::Real(_)) => {
                self.value().total_cmp(&other.value()).then(Ordering::Less)
            }
            (Number::Real(x), Number::Real(y)) => x.total_cmp(y),
        }
    }
}

impl Hash for Number {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match self {
            Number::Rational(n, d) => (0_u8, n, d).hash(state),
            Number::Real(x) => (1_u8, x.to_bits()).hash(state),
        }
    }
}
