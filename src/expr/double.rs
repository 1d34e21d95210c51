//! Double-double arithmetic: a real number as the unevaluated sum of two `f64`, some 31 decimal
//! digits. Where rounding must not be seen: the lowest orders of a Taylor step, constants and
//! parameters, what is shown of a state. No fused multiply-add, so every machine agrees.
//!
//! Sources: T. J. Dekker, Numer. Math. 18 (1971) 224 (products); D. E. Knuth, The Art of Computer
//! Programming 2, 4.2.2 (sums); Y. Hida, X. S. Li, D. H. Bailey, 15th IEEE Symposium on Computer
//! Arithmetic (2001) 155 (division, root).

mod elementary;

use std::ops::{Add, Div, Mul, Neg, Sub};

/// `high + low`, with `low` at most half a unit in the last place of `high`. Good for magnitudes
/// below 1e290.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Double {
    /// The nearest `f64`.
    pub high: f64,
    /// What it leaves over.
    pub low: f64,
}

impl Double {
    /// Zero.
    pub const ZERO: Double = Double { high: 0.0, low: 0.0 };
    /// One.
    pub const ONE: Double = Double { high: 1.0, low: 0.0 };
    /// The circle constant.
    pub const PI: Double = Double { high: std::f64::consts::PI, low: 1.224_646_799_147_353_2e-16 };

    /// `a + b` exactly.
    pub fn sum(a: f64, b: f64) -> Double {
        let high = a + b;
        let part = high - a;
        Double { high, low: (a - (high - part)) + (b - part) }
    }

    /// `a + b` exactly, for `|a| ≥ |b|`.
    fn ordered_sum(a: f64, b: f64) -> Double {
        let high = a + b;
        Double { high, low: b - (high - a) }
    }

    /// `a · b` exactly.
    pub fn product(a: f64, b: f64) -> Double {
        let high = a * b;
        let ((a1, a2), (b1, b2)) = (split(a), split(b));
        Double { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
    }

    /// An integer, exactly.
    pub fn integer(n: i64) -> Double {
        let low = n & 0xFFFF_FFFF;
        Double::sum((n - low) as f64, low as f64)
    }

    /// The number that the shortest decimal which reads as `x` stands for: what a user meant by
    /// 0.1, which no `f64` is. `x` itself is its nearest `f64`.
    pub fn written(x: f64) -> Double {
        if (x.fract() == 0.0 && x.abs() < 9e15) || !x.is_finite() {
            return Double::from(x);
        }
        let text = format!("{x:e}");
        let parts = text.split_once('e').and_then(|(mantissa, exponent)| {
            let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
            let digits: i64 = format!("{whole}{fraction}").parse().ok()?;
            let exponent: i32 = exponent.parse().ok()?;
            Some((digits, exponent - fraction.len() as i32))
        });
        match parts {
            Some((digits, exponent)) if exponent.abs() < 250 => {
                let (mantissa, power) = (Double::integer(digits), power_of_ten(exponent.abs()));
                if exponent < 0 { mantissa / power } else { mantissa * power }
            }
            _ => Double::from(x),
        }
    }

    /// The absolute value.
    #[must_use]
    pub fn abs(self) -> Double {
        if self.high < 0.0 { -self } else { self }
    }

    /// Whether it is finite.
    pub fn is_finite(self) -> bool {
        self.high.is_finite() && self.low.is_finite()
    }

    /// `self²`.
    #[must_use]
    pub fn squared(self) -> Double {
        self * self
    }

    /// The square root.
    fn root(self) -> Double {
        if self.high <= 0.0 {
            return Double::from(self.high.sqrt());
        }
        let x = 1.0 / self.high.sqrt();
        let y = self.high * x;
        let rest = (self - Double::product(y, y)).high;
        Double::sum(y, rest * (x * 0.5))
    }
}

/// Ten to a power, to the last digits.
fn power_of_ten(n: i32) -> Double {
    let (mut result, mut base, mut n) = (Double::ONE, Double::from(10.0), n);
    while n > 0 {
        if n & 1 == 1 {
            result = result * base;
        }
        base = base * base;
        n >>= 1;
    }
    result
}

/// Two halves of 26 bits each whose sum is `a` (Veltkamp).
fn split(a: f64) -> (f64, f64) {
    let t = 134_217_729.0 * a;
    let high = t - (t - a);
    (high, a - high)
}

impl From<f64> for Double {
    fn from(high: f64) -> Double {
        Double { high, low: 0.0 }
    }
}

impl Add for Double {
    type Output = Double;
    fn add(self, other: Double) -> Double {
        let (s, t) = (Double::sum(self.high, other.high), Double::sum(self.low, other.low));
        let v = Double::ordered_sum(s.high, s.low + t.high);
        Double::ordered_sum(v.high, t.low + v.low)
    }
}

impl Sub for Double {
    type Output = Double;
    fn sub(self, other: Double) -> Double {
        self + -other
    }
}

impl Neg for Double {
    type Output = Double;
    fn neg(self) -> Double {
        Double { high: -self.high, low: -self.low }
    }
}

impl Mul for Double {
    type Output = Double;
    fn mul(self, other: Double) -> Double {
        let p = Double::product(self.high, other.high);
        Double::ordered_sum(p.high, p.low + (self.high * other.low + self.low * other.high))
    }
}

impl Mul<f64> for Double {
    type Output = Double;
    fn mul(self, other: f64) -> Double {
        let p = Double::product(self.high, other);
        Double::ordered_sum(p.high, p.low + self.low * other)
    }
}

impl Div for Double {
    type Output = Double;
    fn div(self, other: Double) -> Double {
        let first = self.high / other.high;
        if !first.is_finite() || !other.high.is_finite() {
            return Double::from(first);
        }
        let rest = self - other * first;
        let second = rest.high / other.high;
        let third = (rest - other * second).high / other.high;
        let quotient = Double::ordered_sum(first, second);
        Double::ordered_sum(quotient.high, quotient.low + third)
    }
}

impl Div<f64> for Double {
    type Output = Double;
    fn div(self, other: f64) -> Double {
        let first = self.high / other;
        let rest = self - Double::product(first, other);
        Double::ordered_sum(first, (rest.high + rest.low) / other)
    }
}
