//! A real number known to within a radius, with a separate power of two. Evaluation with balls
//! cannot overflow or underflow, whatever the units, and bounds the rounding error.
//!
//! In: numbers. Out: enclosures: the true value of every operation lies in the result; `None` if
//! there is no value, or no bound. Never here: expressions.

mod elementary;

use crate::num::Number;

/// Half a unit in the last place of an `f64`, with a margin for the rounding of the radius.
const ROUNDING: f64 = 1.2 * f64::EPSILON;

/// The relative uncertainty of a coefficient without an exact form, which results from several
/// operations.
const INEXACT: f64 = 64.0 * f64::EPSILON;

/// The largest exponent that is tracked.
const MOST: i64 = 1 << 40;

/// Every number from `(middle − radius) · 2^exponent` to `(middle + radius) · 2^exponent`; the
/// larger of |middle| and radius is in [½, 1), or both are 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    middle: f64,
    radius: f64,
    exponent: i64,
}

/// `x · 2^by` for an x of ordinary size; a result too small for an `f64` is 0.
fn shifted(x: f64, by: i64) -> f64 {
    if by < -1000 {
        0.0
    } else if by > 1000 {
        f64::INFINITY
    } else {
        x * f64::from_bits(((by + 1023) as u64) << 52)
    }
}

/// The power of two that brings a positive normal number into [½, 1).
fn exponent_of(x: f64) -> i64 {
    (x.to_bits() >> 52 & 0x7ff) as i64 - 1022
}

impl Ball {
    pub(super) const ZERO: Ball = Ball { middle: 0.0, radius: 0.0, exponent: 0 };

    /// An `f64`, exactly.
    pub(super) fn exact(x: f64) -> Option<Ball> {
        if x != 0.0 && x.abs() < f64::MIN_POSITIVE {
            // a subnormal number, scaled into the normal range
            return Ball::of(x * shifted(1.0, 200), 0.0, -200);
        }
        Ball::of(x, 0.0, 0)
    }

    /// A coefficient of an expression.
    pub(super) fn number(n: Number) -> Option<Ball> {
        let exact = |k: i64| k.unsigned_abs() < 1 << 53;
        let x = Ball::exact(n.value())?;
        match n {
            Number::Rational(n, d) if exact(n) && exact(d) && (d as u64).is_power_of_two() => {
                Some(x)
            }
            Number::Rational(..) => x.widened(ROUNDING),
            Number::Real(_) => x.widened(INEXACT),
        }
    }

    /// Normalises `(middle ± radius) · 2^exponent`.
    fn of(middle: f64, radius: f64, exponent: i64) -> Option<Ball> {
        let size = middle.abs().max(radius);
        if size == 0.0 {
            return Some(Ball::ZERO);
        }
        if !size.is_finite() || exponent.abs() > MOST {
            return None;
        }
        let by = exponent_of(size);
        let (middle, radius) = (shifted(middle, -by), shifted(radius, -by));
        Some(Ball { middle, radius, exponent: exponent + by })
    }

    /// The ball with its radius increased by a fraction of the middle.
    pub(super) fn widened(self, part: f64) -> Option<Ball> {
        Ball::of(self.middle, self.radius + part * self.middle.abs(), self.exponent)
    }

    /// Returns whether 0 lies outside the ball.
    pub(super) fn excludes_zero(self) -> bool {
        self.middle.abs() > self.radius
    }

    /// Returns whether it is exactly 0.
    pub(super) fn is_zero(self) -> bool {
        self.middle == 0.0 && self.radius == 0.0
    }

    /// The common sign of all its numbers, if they have one.
    fn sign(self) -> Option<f64> {
        match (self.is_zero(), self.excludes_zero()) {
            (true, _) => Some(0.0),
            (_, true) => Some(self.middle.signum()),
            _ => None,
        }
    }

    /// log₂ of the largest magnitude in the ball, roughly; `None` for 0.
    pub(super) fn magnitude(self) -> Option<i64> {
        (!self.is_zero()).then_some(self.exponent)
    }

    /// log₂ of the radius, roughly; `None` if it is 0.
    pub(super) fn uncertainty(self) -> Option<i64> {
        (self.radius > f64::MIN_POSITIVE).then(|| self.exponent + exponent_of(self.radius))
    }

    pub(super) fn add(self, other: Ball) -> Option<Ball> {
        if self.is_zero() {
            return Some(other);
        }
        if other.is_zero() {
            return Some(self);
        }
        let (big, small) =
            if self.exponent >= other.exponent { (self, other) } else { (other, self) };
        let by = small.exponent - big.exponent;
        let (middle, radius) = (shifted(small.middle, by), shifted(small.radius, by));
        // what the shift has cut off
        let lost = if by < -900 { 1e-270 } else { 0.0 };
        let total = big.middle + middle;
        let radius = (big.radius + radius + lost) * (1.0 + ROUNDING);
        // The sum of two f64 is off by half a unit of its own last place at most, and is exact if
        // both are integer multiples of that unit.
        let rounded = if big.middle + middle - big.middle == middle
            && total - middle == big.middle
            && lost == 0.0
        {
            0.0
        } else {
            ROUNDING * total.abs().max(f64::MIN_POSITIVE)
        };
        Ball::of(total, radius + rounded, big.exponent)
    }

    pub(super) fn mul(self, other: Ball) -> Option<Ball> {
        let middle = self.middle * other.middle;
        let radius =
            (self.middle.abs() + self.radius) * other.radius + self.radius * other.middle.abs();
        let radius = radius * (1.0 + 4.0 * ROUNDING) + ROUNDING * middle.abs();
        Ball::of(middle, radius, self.exponent + other.exponent)
    }

    /// `1 / self`.
    pub(super) fn recip(self) -> Option<Ball> {
        if !self.excludes_zero() {
            return None;
        }
        let middle = 1.0 / self.middle;
        let least = self.middle.abs() - self.radius;
        let radius = self.radius / (least * self.middle.abs()) * (1.0 + 8.0 * ROUNDING);
        Ball::of(middle, radius + ROUNDING * middle.abs(), -self.exponent)
    }

    pub(super) fn negated(self) -> Ball {
        Ball { middle: -self.middle, ..self }
    }

    /// The absolute value.
    pub(super) fn abs(self) -> Ball {
        Ball { middle: self.middle.abs(), ..self }
    }

    /// `self ^ n` for a numeric exponent.
    pub(super) fn power(self, n: Number) -> Option<Ball> {
        match n {
            Number::Rational(n, 1) if n.abs() <= 4096 => self.raised(n),
            Number::Rational(n, 2) if n.abs() <= 4096 => self.sqrt()?.raised(n),
            _ => self.real_power(Ball::number(n)?, n.is_negative()),
        }
    }

    /// `self ^ exponent` for a nonnegative base.
    pub(super) fn real_power(self, exponent: Ball, pole_at_zero: bool) -> Option<Ball> {
        if self.is_zero() && !pole_at_zero && exponent.sign() == Some(1.0) {
            return Some(Ball::ZERO);
        }
        self.logarithm()?.mul(exponent)?.exponential()
    }

    fn raised(self, n: i64) -> Option<Ball> {
        if n < 0 {
            return self.raised(-n)?.recip();
        }
        let mut result = Ball::exact(1.0)?;
        let (mut base, mut n) = (self, n);
        while n > 0 {
            if n & 1 == 1 {
                result = result.mul(base)?;
            }
            n >>= 1;
            if n > 0 {
                base = base.mul(base)?;
            }
        }
        Some(result)
    }

    pub(super) fn sqrt(self) -> Option<Ball> {
        if self.is_zero() {
            return Some(self);
        }
        // a number that may be negative may have no root
        if self.sign()? < 0.0 {
            return None;
        }
        let odd = self.exponent.rem_euclid(2);
        let (middle, radius) = (shifted(self.middle, odd), shifted(self.radius, odd));
        let root = middle.sqrt();
        let radius = radius / root * (1.0 + 8.0 * ROUNDING) + ROUNDING * root;
        Ball::of(root, radius, (self.exponent - odd) / 2)
    }
}
