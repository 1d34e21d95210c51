//! The elementary functions of double-double numbers, to at least 27 digits: series after argument
//! reduction for exp, sin and cos; one correction of the `f64` value for their inverses.

use super::DoubleDouble;
use crate::num::convolution::{Double, Row};
use crate::num::instruction_set::vectorized;
use crate::num::math;
use crate::num::real::Real;

/// ln 2.
const LN_2: DoubleDouble =
    DoubleDouble { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 };

/// π/2 in three pieces.
const HALF_PI: [f64; 3] =
    [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33];

/// Above this, sine and cosine are those of `f64`, because the argument has no more digits.
const LARGE_ANGLE: f64 = 1e9;

/// The exponential reduces its argument by this power of two.
const HALVINGS: i32 = 8;

/// 1/n, for n up to 64. The second part is the remainder of the first over n, which is exact.
const RECIPROCALS: [DoubleDouble; 65] = {
    let mut table = [DoubleDouble::ZERO; 65];
    let mut n = 1;
    while n < table.len() {
        let high = 1.0 / n as f64;
        // n · high in two exact products, since the halves of high have 26 bits and n has 7
        let t = 134_217_729.0 * high;
        let upper = t - (t - high);
        let lower = high - upper;
        let rest = (1.0 - n as f64 * upper) - n as f64 * lower;
        table[n] = DoubleDouble { high, low: rest / n as f64 };
        n += 1;
    }
    table
};

impl DoubleDouble {
    /// `self · 2^n`.
    fn scaled(self, n: i32) -> DoubleDouble {
        let (a, b) = (math::powi(2.0, n / 2), math::powi(2.0, n - n / 2));
        DoubleDouble { high: self.high * a * b, low: self.low * a * b }
    }

    /// `e^self − 1` for a small argument, without cancellation: a short series at `self / 2^8`,
    /// then `s ← 2 s + s²` eight times.
    fn exp_minus_one_reduced(self) -> DoubleDouble {
        let r = self.scaled(-HALVINGS);
        let (mut term, mut s) = (r, r);
        for n in 2..10 {
            term = term * r / f64::from(n);
            s = s + term;
        }
        for _ in 0..HALVINGS {
            s = s * 2.0 + s * s;
        }
        s
    }

    /// `e^self − 1`.
    fn exp_minus_one(self) -> DoubleDouble {
        if self.high.abs() < 0.35 {
            self.exp_minus_one_reduced()
        } else {
            self.exp() - DoubleDouble::ONE
        }
    }

    /// Sine and cosine of an argument up to π/4, by their series.
    fn sin_cos_reduced(self) -> (DoubleDouble, DoubleDouble) {
        let square = -(self * self);
        let (mut sine, mut cosine) = (self, DoubleDouble::ONE);
        let (mut odd, mut even) = (self, DoubleDouble::ONE);
        for n in 1..15 {
            let n = f64::from(2 * n);
            even = even * square / (n * (n - 1.0));
            odd = odd * square / (n * (n + 1.0));
            cosine = cosine + even;
            sine = sine + odd;
            if even.high.abs() < 1e-34 {
                break;
            }
        }
        (sine, cosine)
    }
}

impl Real for DoubleDouble {
    const ZERO: DoubleDouble = DoubleDouble::ZERO;
    const ONE: DoubleDouble = DoubleDouble::ONE;

    #[inline]
    fn over(self, n: usize) -> DoubleDouble {
        self * RECIPROCALS[n]
    }
    #[inline]
    fn scaled(self, power_of_two: f64) -> DoubleDouble {
        DoubleDouble { high: self.high * power_of_two, low: self.low * power_of_two }
    }
    #[inline(always)]
    fn times<const FUSED: bool>(self, other: DoubleDouble) -> DoubleDouble {
        let p = DoubleDouble::product_by::<FUSED>(self.high, other.high);
        DoubleDouble::ordered_sum(p.high, p.low + (self.high * other.low + self.low * other.high))
    }
    #[inline]
    fn inner_products(
        forward: &[DoubleDouble],
        reversed: &[DoubleDouble],
        rows: &[Row],
        (shift, n): (usize, usize),
        out: &mut [DoubleDouble],
    ) {
        vectorized(Double { forward, reversed, rows, shift, n, out });
    }

    fn of(x: DoubleDouble) -> DoubleDouble {
        x
    }

    fn value(self) -> f64 {
        self.high
    }

    fn double(self) -> DoubleDouble {
        self
    }

    fn sqrt(self) -> DoubleDouble {
        self.root()
    }

    fn exp(self) -> DoubleDouble {
        if !(-700.0..=700.0).contains(&self.high) {
            return DoubleDouble::from(math::exp(self.high));
        }
        let n = (self.high / LN_2.high).round();
        let r = self - LN_2 * n;
        (r.exp_minus_one_reduced() + DoubleDouble::ONE).scaled(n as i32)
    }

    fn ln(self) -> DoubleDouble {
        let y = math::ln(self.high);
        if !y.is_finite() || y.abs() > 690.0 {
            return DoubleDouble::from(y);
        }
        // ln x = y + ln(x e^−y), where the second part is tiny
        let e = self * (-DoubleDouble::from(y)).exp() - DoubleDouble::ONE;
        DoubleDouble::from(y) + (e - e * e * 0.5)
    }

    fn sin_cos(self) -> (DoubleDouble, DoubleDouble) {
        if self.high.abs().partial_cmp(&LARGE_ANGLE) != Some(std::cmp::Ordering::Less) {
            let (sine, cosine) = math::sin_cos(self.high);
            return (DoubleDouble::from(sine), DoubleDouble::from(cosine));
        }
        let quarters = (self.high / HALF_PI[0]).round();
        let mut r = self;
        for piece in HALF_PI {
            r = r - DoubleDouble::product(quarters, piece);
        }
        let (sine, cosine) = r.sin_cos_reduced();
        match (quarters as i64).rem_euclid(4) {
            0 => (sine, cosine),
            1 => (cosine, -sine),
            2 => (-sine, -cosine),
            _ => (-cosine, sine),
        }
    }

    fn tan(self) -> DoubleDouble {
        let (sine, cosine) = self.sin_cos();
        sine / cosine
    }

    fn sinh_cosh(self) -> (DoubleDouble, DoubleDouble) {
        if self.high.abs() > 300.0 {
            return (
                DoubleDouble::from(math::sinh(self.high)),
                DoubleDouble::from(math::cosh(self.high)),
            );
        }
        let s = self.exp_minus_one();
        let e = s + DoubleDouble::ONE;
        ((s + s / e) * 0.5, (e + DoubleDouble::ONE / e) * 0.5)
    }

    fn tanh(self) -> DoubleDouble {
        if self.high.abs() > 40.0 {
            return DoubleDouble::from(self.high.signum());
        }
        let s = (self * 2.0).exp_minus_one();
        s / (s + DoubleDouble::from(2.0))
    }

    fn atan2(self, x: DoubleDouble) -> DoubleDouble {
        let angle = math::atan2(self.high, x.high);
        if (self.high == 0.0 && x.high == 0.0) || !self.is_finite() || !x.is_finite() {
            return DoubleDouble::from(angle);
        }
        // rotate the point back by the angle; the remaining angle is tiny
        let (sine, cosine) = DoubleDouble::from(angle).sin_cos();
        let rest = (self * cosine - x * sine) / (x * cosine + self * sine);
        DoubleDouble::from(angle) + rest
    }

    fn asin(self) -> DoubleDouble {
        self.atan2(((DoubleDouble::ONE - self) * (DoubleDouble::ONE + self)).root())
    }

    fn acos(self) -> DoubleDouble {
        ((DoubleDouble::ONE - self) * (DoubleDouble::ONE + self)).root().atan2(self)
    }

    fn power(self, exponent: DoubleDouble) -> DoubleDouble {
        let n = exponent.high;
        if exponent.low == 0.0 && n.abs() < 1024.0 && (2.0 * n).fract() == 0.0 {
            let size = n.abs();
            let mut result = if size.fract() == 0.0 { DoubleDouble::ONE } else { self.root() };
            let (mut base, mut left) = (self, size as u32);
            while left > 0 {
                if left & 1 == 1 {
                    result = result * base;
                }
                base = base * base;
                left >>= 1;
            }
            return if n < 0.0 { DoubleDouble::ONE / result } else { result };
        }
        if self.high <= 0.0 {
            return DoubleDouble::from(math::powf(self.high, n));
        }
        (self.ln() * exponent).exp()
    }
}
