//! Sums, products and quotients of numbers with a separate exponent.
//!
//! In and out: [`ExtendedRange`]. Never here: functions of them.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::ExtendedRange;
use crate::num::double_double::DoubleDouble;
use crate::num::real::Analytic;

impl Add for ExtendedRange {
    type Output = ExtendedRange;
    fn add(self, other: ExtendedRange) -> ExtendedRange {
        let (a, b) = (self.mantissa.high, other.mantissa.high);
        if !a.is_finite() || !b.is_finite() {
            return ExtendedRange::moderate(DoubleDouble::from(a + b));
        }
        if a == 0.0 && b == 0.0 {
            return ExtendedRange::ZERO;
        }
        let larger = self.larger(other);
        ExtendedRange::new(self.in_units_of(larger) + other.in_units_of(larger), larger.exponent)
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
        ExtendedRange::new(self.mantissa * other.mantissa, self.exponent.plus(other.exponent))
    }
}

impl Div for ExtendedRange {
    type Output = ExtendedRange;
    fn div(self, other: ExtendedRange) -> ExtendedRange {
        if other.mantissa.high.is_infinite() && self.mantissa.high.is_finite() {
            return ExtendedRange::ZERO;
        }
        ExtendedRange::new(self.mantissa / other.mantissa, self.exponent.minus(other.exponent))
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
