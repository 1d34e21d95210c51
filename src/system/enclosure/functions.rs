//! Bounds of functions over intervals of their arguments, and of their slopes.
//!
//! Source: R. E. Moore, R. B. Kearfott, M. J. Cloud, Introduction to Interval Analysis (SIAM, 2009).

use crate::expr::FunctionId;
use crate::num::{Interval, math};

/// Beyond the first of these arguments a hyperbolic tangent is 1 to all digits; below the negative of the second an exponential is
/// nothing beside the inverse of anything.
const LIMITS: (f64, f64) = (40.0, 1e4);

/// The values of a function and of its companion.
pub(super) fn of_function(function: FunctionId, u: Interval, v: Interval) -> (Interval, Interval) {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};
    const ONE: Interval = Interval { low: -1.0, high: 1.0 };
    let within = |x: Interval| x.within(ONE);
    // the sine between angles: it is largest at π/2 after any turns, and least at −π/2
    let sine = |u: Interval| {
        if u.width().is_nan() || u.width() >= TAU || u.magnitude() > 1e15 {
            return ONE;
        }
        let ends = Interval::between(math::sin(u.low), math::sin(u.high), 4.0);
        let reaches = |at: f64| {
            let turns = ((u.low - at) / TAU).ceil();
            at + turns * TAU <= u.high + 1e-14 * u.magnitude()
        };
        let low = if reaches(-FRAC_PI_2) { -1.0 } else { ends.low };
        let high = if reaches(FRAC_PI_2) { 1.0 } else { ends.high };
        within(Interval { low, high })
    };
    let shifted = |by: f64| Interval::between(u.low + by, u.high + by, 1.0);
    // the tangent has a pole between two angles that are not on the same branch
    let tangent = |u: Interval| {
        let branch = |x: f64| ((x + FRAC_PI_2) / PI).floor();
        let is_one = u.magnitude() < 1e15 && branch(u.low) == branch(u.high);
        let ends = u.rising(math::tan);
        if is_one && ends.low <= ends.high && math::tan(u.low) <= math::tan(u.high) {
            ends
        } else {
            Interval::ALL
        }
    };
    match function {
        FunctionId::Sin => (sine(u), sine(shifted(FRAC_PI_2))),
        FunctionId::Cos => (sine(shifted(FRAC_PI_2)), Interval::ALL),
        FunctionId::Tan => (tangent(u), Interval::ALL),
        FunctionId::Cot => {
            let turned = Interval::between(FRAC_PI_2 - u.low, FRAC_PI_2 - u.high, 1.0);
            (tangent(turned), Interval::ALL)
        }
        FunctionId::Asin => (within(u).rising(math::asin), Interval::ALL),
        FunctionId::Acos => {
            let u = within(u);
            (Interval::between(math::acos(u.low), math::acos(u.high), 4.0), Interval::ALL)
        }
        FunctionId::Atan => (u.rising(math::atan), Interval::ALL),
        FunctionId::Atan2 if v.low > 0.0 => {
            let corners = [(u.low, v.low), (u.low, v.high), (u.high, v.low), (u.high, v.high)];
            let angle = |(y, x)| Interval::between(math::atan2(y, x), math::atan2(y, x), 4.0);
            let all = corners.into_iter().map(angle).reduce(Interval::hull);
            (all.unwrap_or(Interval::ALL), Interval::ALL)
        }
        FunctionId::Atan2 => (Interval { low: -4.0, high: 4.0 }, Interval::ALL),
        FunctionId::Sinh => (u.rising(math::sinh), cosine(u)),
        FunctionId::Cosh => (cosine(u), Interval::ALL),
        FunctionId::Tanh => {
            let value = match u {
                _ if u.low > LIMITS.0 => Interval::point(1.0),
                _ if u.high < -LIMITS.0 => Interval::point(-1.0),
                _ => within(u.rising(math::tanh)),
            };
            (value, Interval::ALL)
        }
        FunctionId::Exp if u.high < -LIMITS.1 => (Interval::ZERO, Interval::ALL),
        FunctionId::Exp => {
            let value = u.rising(math::exp);
            (Interval { low: value.low.max(0.0), ..value }, Interval::ALL)
        }
        FunctionId::Ln => {
            let positive = Interval { low: u.low.max(0.0), high: u.high.max(0.0) };
            (positive.rising(math::ln), Interval::ALL)
        }
        FunctionId::Sqrt => (u.root(), Interval::ALL),
        FunctionId::Abs | FunctionId::Sign | FunctionId::Min | FunctionId::Max => {
            (Interval::ALL, Interval::ALL)
        }
    }
}

/// The hyperbolic cosine.
fn cosine(u: Interval) -> Interval {
    let (least, most) = (u.mignitude(), u.magnitude());
    let value = Interval::between(math::cosh(least), math::cosh(most), 4.0);
    Interval { low: value.low.max(1.0), ..value }
}

/// The largest slope of a function, and of its companion, in its arguments.
pub(super) fn largest_slope(
    function: FunctionId,
    u: Interval,
    v: Interval,
    value: Interval,
) -> f64 {
    match function {
        FunctionId::Sin | FunctionId::Cos | FunctionId::Atan => 1.0,
        FunctionId::Tan | FunctionId::Cot => 1.0 + value.square().high,
        FunctionId::Asin | FunctionId::Acos => {
            1.0 / (1.0 - u.magnitude() * u.magnitude()).max(0.0).sqrt()
        }
        FunctionId::Atan2 => 1.0 / u.mignitude().max(v.mignitude()),
        FunctionId::Sinh | FunctionId::Cosh => cosine(u).high,
        // 1 − tanh² u ≤ 4 exp(−2 |u|)
        FunctionId::Tanh => (4.0 * math::exp(-2.0 * u.mignitude())).min(1.0),
        FunctionId::Exp => value.high,
        FunctionId::Ln => 1.0 / u.mignitude(),
        FunctionId::Sqrt
        | FunctionId::Abs
        | FunctionId::Sign
        | FunctionId::Min
        | FunctionId::Max => f64::INFINITY,
    }
}
