//! Intervals: sets of numbers that hold the true value of every operation on numbers of their operands.
//!
//! In: intervals. Out: intervals, rounded outwards. A bound that is not a number is none: the interval is then unbounded on that side.
//! Never here: functions of expressions.
//!
//! Source: R. E. Moore, R. B. Kearfott, M. J. Cloud, Introduction to Interval Analysis (SIAM, 2009).

use super::{DoubleDouble, math};

/// All numbers from `low` to `high`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Interval {
    /// The least; −∞ where there is none.
    pub low: f64,
    /// The largest; +∞ where there is none.
    pub high: f64,
}

/// By how much an elementary function may be off, in last digits.
const ELEMENTARY: f64 = 4.0;

impl Interval {
    /// Every number.
    pub const ALL: Interval = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };
    /// Zero, exactly.
    pub const ZERO: Interval = Interval { low: 0.0, high: 0.0 };

    /// One number, exactly.
    pub const fn point(x: f64) -> Interval {
        Interval { low: x, high: x }
    }

    /// A number in double-double.
    pub fn of(x: DoubleDouble) -> Interval {
        if x.low == 0.0 { Interval::point(x.high) } else { Interval::between(x.high, x.high, 1.0) }
    }

    /// The numbers between two, which may be rounded by `digits` last digits.
    pub fn between(a: f64, b: f64, digits: f64) -> Interval {
        if a.is_nan() || b.is_nan() {
            return Interval::ALL;
        }
        Interval { low: below(a.min(b), digits), high: above(a.max(b), digits) }
    }

    /// The values of a rising elementary function.
    #[must_use]
    pub fn rising(self, f: impl Fn(f64) -> f64) -> Interval {
        Interval::between(f(self.low), f(self.high), ELEMENTARY)
    }

    /// Whether it is zero, exactly.
    pub fn is_zero(self) -> bool {
        self.low == 0.0 && self.high == 0.0
    }

    /// Whether zero is one of its numbers.
    pub fn has_zero(self) -> bool {
        self.low <= 0.0 && self.high >= 0.0
    }

    /// The largest size of its numbers.
    pub fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// The least size of its numbers.
    pub fn mignitude(self) -> f64 {
        if self.has_zero() { 0.0 } else { self.low.abs().min(self.high.abs()) }
    }

    /// The difference of its bounds.
    pub fn width(self) -> f64 {
        self.high - self.low
    }

    /// The least interval that holds two.
    #[must_use]
    pub fn hull(self, other: Interval) -> Interval {
        Interval { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The part of it that lies in another; the other where there is none.
    #[must_use]
    pub fn within(self, other: Interval) -> Interval {
        let both = Interval { low: self.low.max(other.low), high: self.high.min(other.high) };
        if both.low <= both.high { both } else { other }
    }

    /// The square.
    #[must_use]
    pub fn square(self) -> Interval {
        let (least, most) = (self.mignitude(), self.magnitude());
        if least == most && (most == 0.0 || most == 1.0) {
            return Interval::point(most);
        }
        Interval { low: below(least * least, 1.0).max(0.0), high: above(most * most, 1.0) }
    }

    /// The reciprocal.
    #[must_use]
    pub fn recip(self) -> Interval {
        match (self.low, self.high) {
            (0.0, 0.0) => Interval::ALL,
            (0.0, high) => Interval { low: below(1.0 / high, 1.0).max(0.0), high: f64::INFINITY },
            (low, 0.0) => Interval { low: f64::NEG_INFINITY, high: above(1.0 / low, 1.0).min(0.0) },
            _ if self.has_zero() => Interval::ALL,
            (low, high) => {
                let Interval { low: least, high: most } =
                    Interval::between(1.0 / high, 1.0 / low, 1.0);
                let is_positive = low > 0.0;
                Interval {
                    low: if is_positive { least.max(0.0) } else { least },
                    high: if is_positive { most } else { most.min(0.0) },
                }
            }
        }
    }

    /// The square root of what is not negative in it.
    #[must_use]
    pub fn root(self) -> Interval {
        let root = |x: f64| x.max(0.0).sqrt();
        Interval { low: below(root(self.low), 1.0).max(0.0), high: above(root(self.high), 1.0) }
    }

    /// The power with a real exponent: of all numbers where it is an integer, else of what is not negative.
    #[must_use]
    pub fn power(self, exponent: f64) -> Interval {
        if exponent == 0.0 {
            return Interval::point(1.0);
        }
        if exponent < 0.0 {
            return self.power(-exponent).recip();
        }
        let power = |x: f64| math::powf(x.abs(), exponent);
        // the digits of ln x are multiplied by those of the exponent
        let digits = ELEMENTARY * (1.0 + exponent);
        let (low, high) = (power(self.low), power(self.high));
        if exponent.fract() == 0.0 && exponent % 2.0 == 0.0 {
            let least = power(self.mignitude());
            Interval { low: below(least, digits).max(0.0), high: above(low.max(high), digits) }
        } else if exponent.fract() == 0.0 {
            Interval::between(low.copysign(self.low), high.copysign(self.high), digits)
        } else {
            let least = power(self.low.max(0.0));
            Interval {
                low: below(least, digits).max(0.0),
                high: above(power(self.high.max(0.0)), digits),
            }
        }
    }
}

impl std::ops::Add for Interval {
    type Output = Interval;

    fn add(self, other: Interval) -> Interval {
        if self.is_zero() {
            return other;
        }
        if other.is_zero() {
            return self;
        }
        // a sum without rounding has its bounds exactly, as the zero at the beginning of a ramp
        let bound = |a: f64, b: f64, rounded: fn(f64, f64) -> f64, none: f64| match a + b {
            sum if sum.is_nan() => none,
            sum if sum.is_finite() && DoubleDouble::sum(a, b).low == 0.0 => sum,
            sum => rounded(sum, 1.0),
        };
        Interval {
            low: bound(self.low, other.low, below, f64::NEG_INFINITY),
            high: bound(self.high, other.high, above, f64::INFINITY),
        }
    }
}

impl std::ops::Mul for Interval {
    type Output = Interval;

    fn mul(self, other: Interval) -> Interval {
        if self.is_zero() || other.is_zero() {
            return Interval::ZERO;
        }
        for (one, x) in [(self, other), (other, self)] {
            if one.low == one.high && one.low.abs() == 1.0 {
                return if one.low > 0.0 { x } else { Interval { low: -x.high, high: -x.low } };
            }
        }
        // a bound that is zero times one that is none is zero: the numbers are all finite
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let all = [
            product(self.low, other.low),
            product(self.low, other.high),
            product(self.high, other.low),
            product(self.high, other.high),
        ];
        let low = all.into_iter().fold(f64::INFINITY, f64::min);
        let high = all.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let signs =
            (self.low >= 0.0 && other.low >= 0.0) || (self.high <= 0.0 && other.high <= 0.0);
        let low = below(low, 1.0);
        Interval { low: if signs { low.max(0.0) } else { low }, high: above(high, 1.0) }
    }
}

/// A number below one that may be rounded by so many last digits. What has overflowed is beyond the largest number.
fn below(x: f64, digits: f64) -> f64 {
    if x == f64::INFINITY {
        f64::MAX
    } else {
        x - (x.abs() * (digits * f64::EPSILON) + f64::MIN_POSITIVE)
    }
}

/// A number above one that may be rounded by so many last digits.
fn above(x: f64, digits: f64) -> f64 {
    -below(-x, digits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Analytic;

    /// Whether a number in double-double lies in an interval.
    fn holds(interval: Interval, x: DoubleDouble) -> bool {
        let Interval { low, high } = interval;
        let is_above = low == f64::NEG_INFINITY || (x - DoubleDouble::from(low)).high >= 0.0;
        is_above && (high == f64::INFINITY || (DoubleDouble::from(high) - x).high >= 0.0)
    }

    #[test]
    fn results_contain_the_values_of_all_numbers_of_the_operands() {
        let bounds = [(-3.0, -1.0), (-2.0, 0.0), (-0.7, 1.9), (0.0, 0.3), (0.1, 7.0), (1e9, 1e10)];
        let numbers = |(low, high): (f64, f64)| {
            (0..=8).map(move |k| DoubleDouble::from(low + (high - low) * f64::from(k) / 8.0))
        };
        let pairs = bounds.iter().flat_map(|&a| bounds.map(|b| (a, b)));
        let mut checks = Vec::new();
        for (a, b) in pairs {
            let one = Interval { low: a.0, high: a.1 };
            let other = Interval { low: b.0, high: b.1 };
            for (p, q) in numbers(a).flat_map(|p| numbers(b).map(move |q| (p, q))) {
                checks.push(holds(one + other, p + q) && holds(one * other, p * q));
                checks.push(q.high == 0.0 || holds(one * other.recip(), p / q));
            }
            for p in numbers(a) {
                checks.push(holds(one.square(), p * p) && holds(one.power(2.0), p * p));
                checks.push(holds(one.power(3.0), p * p * p));
                let root =
                    p.high < 0.0 || holds(one.root(), p.sqrt()) && holds(one.power(0.5), p.sqrt());
                checks.push(root);
            }
        }
        let missed = checks.iter().position(|holds| !holds);
        assert!(checks.len() > 5000 && missed.is_none(), "{missed:?} of {}", checks.len());
    }

    #[test]
    fn bounds_are_close_and_zero_is_exact() {
        let three = Interval { low: 2.0, high: 3.0 };
        let square = three * three;
        assert!(square.low > 3.999_999 && square.high < 9.000_001);
        assert_eq!(three * Interval::ZERO, Interval::ZERO);
        assert_eq!(Interval::ALL * Interval::ZERO, Interval::ZERO);
        // beyond the range there is a bound on one side
        let far = Interval::point(1e200).square();
        assert!(far.low > 1e300 && far.high == f64::INFINITY);
        assert!(far.recip().low >= 0.0 && far.recip().high < 1e-300);
        assert_eq!(Interval { low: -1.0, high: 1.0 }.recip(), Interval::ALL);
        // what is saturated cancels
        let one = Interval::point(-1.0);
        assert_eq!(Interval::point(1.0) + one * one.square(), Interval::ZERO);
    }
}
