//! The functions that an expression may call, evaluated on balls.

use super::{Ball, ROUNDING, shifted};
use crate::expr::node::FunctionId;
use crate::num::math;

/// The relative accuracy of an elementary function of `math`.
const ELEMENTARY: f64 = 8.0 * f64::EPSILON;

/// Below 2^this, sin x, tan x, atan x, … equal x to the last place.
const SMALL: i64 = -30;

/// Above 2^this, a sine has no useful bound.
const LARGE: i64 = 40;

impl Ball {
    pub(in crate::expr) fn call(function: FunctionId, arguments: &[Ball]) -> Option<Ball> {
        let u = arguments[0];
        match function {
            FunctionId::Sin if u.is_small() => u.nearly(),
            FunctionId::Sin => u.wave(math::sin),
            FunctionId::Cos => u.wave(math::cos),
            FunctionId::Tan if u.is_small() => u.nearly(),
            FunctionId::Tan => u.wave(math::sin)?.mul(u.wave(math::cos)?.recip()?),
            FunctionId::Cot => {
                Ball::call(FunctionId::Cos, &[u])?.mul(Ball::call(FunctionId::Sin, &[u])?.recip()?)
            }
            FunctionId::Asin if u.is_small() => u.nearly(),
            FunctionId::Asin => u.between(math::asin, 1.0),
            FunctionId::Acos => u.between(math::acos, 1.0),
            FunctionId::Atan if u.is_small() => u.nearly(),
            FunctionId::Atan => u.between(math::atan, f64::INFINITY),
            FunctionId::Atan2 => u.angle(arguments[1]),
            FunctionId::Sinh if u.is_small() => u.nearly(),
            FunctionId::Sinh => {
                let two = u.exponential()?.add(u.negated().exponential()?.negated())?;
                two.mul(Ball::exact(0.5)?)
            }
            FunctionId::Cosh => {
                u.exponential()?.add(u.negated().exponential()?)?.mul(Ball::exact(0.5)?)
            }
            FunctionId::Tanh if u.is_small() => u.nearly(),
            FunctionId::Tanh => u.between(math::tanh, f64::INFINITY),
            FunctionId::Exp => u.exponential(),
            FunctionId::Ln => u.logarithm(),
            FunctionId::Sqrt => u.sqrt(),
            FunctionId::Abs => Some(u.abs()),
            FunctionId::Sign => match u.sign() {
                Some(sign) => Ball::exact(sign),
                None => Ball::of(0.0, 1.0, 0),
            },
            FunctionId::Min => Some(u.negated().larger(arguments[1].negated())?.negated()),
            FunctionId::Max => u.larger(arguments[1]),
        }
    }

    fn is_small(self) -> bool {
        self.is_zero() || self.exponent < SMALL
    }

    /// The value of a function that is x (1 ± x²) near 0.
    fn nearly(self) -> Option<Ball> {
        self.widened(ROUNDING)
    }

    /// The middle and the radius as `f64`; a number too small for one becomes 0.
    fn plain(self) -> (f64, f64) {
        (shifted(self.middle, self.exponent), shifted(self.radius, self.exponent))
    }

    /// A sine or cosine: its slope is at most 1.
    fn wave(self, f: fn(f64) -> f64) -> Option<Ball> {
        if self.exponent > LARGE {
            return Ball::of(0.0, 1.0, 0);
        }
        let (x, radius) = self.plain();
        let value = f(x);
        Ball::of(value, radius.min(2.0) + ELEMENTARY * value.abs(), 0)
    }

    /// A monotone function from its values at both ends, bounded by ±`most`.
    fn between(self, f: fn(f64) -> f64, most: f64) -> Option<Ball> {
        let (x, radius) = self.plain();
        let (x, radius) = if x.is_finite() { (x, radius) } else { (f64::MAX * x.signum(), 0.0) };
        if x.abs() > most {
            return None;
        }
        let value = f(x);
        let below = f((x - radius).max(-most));
        let above = f((x + radius).min(most));
        let spread = (value - below).abs().max((above - value).abs());
        Ball::of(value, spread * (1.0 + ROUNDING) + ELEMENTARY * value.abs(), 0)
    }

    fn angle(self, x: Ball) -> Option<Ball> {
        if self.is_zero() && x.is_zero() {
            return None;
        }
        let common = match (self.is_zero(), x.is_zero()) {
            (true, _) => x.exponent,
            (_, true) => self.exponent,
            _ => self.exponent.max(x.exponent),
        };
        let (b, a) =
            (shifted(self.middle, self.exponent - common), shifted(x.middle, x.exponent - common));
        let radius = shifted(self.radius, self.exponent - common)
            + shifted(x.radius, x.exponent - common)
            + 1e-290;
        let distance = math::hypot(a, b);
        // near the origin and across the cut, any angle is possible
        if distance <= 4.0 * radius || a < radius && self.sign().is_none() {
            return Ball::of(0.0, 3.2, 0);
        }
        let value = math::atan2(b, a);
        Ball::of(value, 1.5 * radius / distance + ELEMENTARY * value.abs(), 0)
    }

    fn larger(self, other: Ball) -> Option<Ball> {
        let difference = self.add(other.negated())?;
        match difference.sign() {
            Some(sign) if sign >= 0.0 => Some(self),
            Some(_) => Some(other),
            // |max| varies no more than its arguments
            None => Ball::of(self.middle, self.radius, self.exponent)?.add(Ball::of(
                0.0,
                difference.radius + difference.middle.abs(),
                difference.exponent,
            )?),
        }
    }

    pub(in crate::expr) fn exponential(self) -> Option<Ball> {
        if self.exponent > 39 {
            return None;
        }
        let (x, radius) = self.plain();
        if radius > 30.0 {
            return None;
        }
        let k = (x / std::f64::consts::LN_2).round();
        // ln 2 in two parts, the first with trailing zeros, so that k times it is exact
        let rest = (x - k * 6.931_471_803_691_238e-1) - k * 1.908_214_929_270_587_7e-10;
        let value = math::exp(rest);
        let spread = math::exp(radius) - 1.0 + radius * ELEMENTARY;
        let off = ELEMENTARY * (1.0 + x.abs());
        Ball::of(value, value * (spread * (1.0 + 16.0 * ROUNDING) + 2.0 * off), k as i64)
    }

    pub(in crate::expr) fn logarithm(self) -> Option<Ball> {
        if self.sign()? <= 0.0 {
            return None;
        }
        let value = math::ln(self.middle) + self.exponent as f64 * std::f64::consts::LN_2;
        let off = self.radius / (self.middle - self.radius) * (1.0 + 8.0 * ROUNDING);
        let size = 1.0 + (self.exponent as f64).abs();
        // near 1 the logarithm of a single f64 is accurate to its own last place
        let rounding =
            if self.exponent == 0 { ELEMENTARY * value.abs() } else { ELEMENTARY * size };
        Ball::of(value, off + rounding, 0)
    }
}
