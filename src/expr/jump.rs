//! Jumps of a function where something that it divides by vanishes: arctan(1/x) has one at x = 0, and so has 1/(1 + e^{1/x});
//! x arctan(1/x) has none, and 1/x has a pole.
//!
//! In: a function and a divisor in it. Out: whether the function has two limits at a zero of the divisor. Never here: jumps of
//! functions that have names, as sign.

use std::convert::Infallible;

use super::evaluate::Repeated;
use super::node::Expr;
use super::pool::Pool;
use super::sample::sample;
use super::symbol::Symbol;
use super::vanishing::on_lines;
use crate::num::bisect;

/// The distances from a zero at which both sides are compared, in units of its place and 1: with the digits of an `f64` a zero is
/// known to 1e-16 of these, and of whatever is steeper by a million both limits are seen.
const DISTANCES: [f64; 3] = [1e-7, 1e-8, 1e-9];

/// A jump is a difference of both sides that is more than this part of the values.
const SEEN: f64 = 1e-6;

/// A difference that changes by less than this part of it from one distance to the next is a jump: at a pole it grows
/// by ten, beside the tip of a root it falls by three.
const SETTLED: f64 = 0.1;

/// Places beyond those where functions are looked at closely.
const FAR: [f64; 12] = [1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// The halvings between two places down to neighbouring numbers.
const HALVINGS: u32 = 120;

impl Pool {
    /// Whether a function of the `moving` symbols jumps where a divisor in it changes its sign.
    pub fn jumps_at_zeros(&self, function: Expr, divisor: Expr, moving: &[Symbol]) -> bool {
        if !self.depends_on_any(divisor, moving) {
            return false;
        }
        let (function, divisor) = (Repeated::of(self, function), Repeated::of(self, divisor));
        let at_rest = |symbol: Symbol| sample(symbol, 0);
        on_lines(moving, &at_rest, &mut |along, places| {
            let below = |place: f64| divisor.at(&|symbol| along(symbol, place));
            let value = |place: f64| function.at(&|symbol| along(symbol, place));
            let far = FAR.map(|place| -place).into_iter().rev();
            let places: Vec<f64> = far.chain(places.iter().copied()).chain(FAR).collect();
            let mut pairs = places.windows(2);
            pairs.any(|pair| {
                if !are_opposite(below(pair[0]), below(pair[1])) {
                    return false;
                }
                let place = change_of_sign(&below, pair[0], pair[1]);
                // far away what swings is not resolved
                let is_far = pair[0].abs().max(pair[1].abs()) >= FAR[0];
                (!is_far || is_straight(&below, place)) && jumps(&value, place)
            })
        })
    }
}

/// Whether one is above zero and one below, also where their product is none.
fn are_opposite(a: f64, b: f64) -> bool {
    a > 0.0 && b < 0.0 || a < 0.0 && b > 0.0
}

/// Where a function changes its sign between two places.
fn change_of_sign(at: &dyn Fn(f64) -> f64, left: f64, right: f64) -> f64 {
    let side = at(left);
    let is_left = |place| Ok::<_, Infallible>(at(place) * side > 0.0);
    let Ok([_, right]) = bisect([left, right], HALVINGS, is_left);
    right
}

/// Whether a function passes its zero at a place in a straight line, as far as jumps are searched for.
fn is_straight(at: &dyn Fn(f64) -> f64, place: f64) -> bool {
    [-1.0, 1.0].into_iter().all(|side| {
        let slopes = DISTANCES.map(|distance| {
            let offset = side * distance * (1.0 + place.abs());
            at(place + offset) / offset
        });
        slopes.iter().all(|slope| (slope - slopes[0]).abs() <= SETTLED * slopes[0].abs())
    })
}

/// Whether a function has two limits at a place.
fn jumps(at: &dyn Fn(f64) -> f64, place: f64) -> bool {
    let beside = DISTANCES.map(|distance| {
        let offset = distance * (1.0 + place.abs());
        (at(place - offset), at(place + offset))
    });
    let differences = beside.map(|(before, after)| after - before);
    let is_seen =
        |(before, after): (f64, f64)| (after - before).abs() > SEEN * (before.abs() + after.abs());
    beside.into_iter().all(is_seen)
        && differences.windows(2).all(|pair| (pair[1] - pair[0]).abs() <= SETTLED * pair[1].abs())
}

#[cfg(test)]
mod tests {
    use super::{is_straight, jumps};
    use crate::num::math;

    #[test]
    fn two_limits_are_a_jump_and_a_pole_or_a_root_is_none() {
        assert!(jumps(&|x| math::atan(1.0 / x), 0.0));
        assert!(jumps(&|x| 5.0 + math::tanh(1e-3 / (x - 2.0)), 2.0));
        assert!(jumps(&|x| 1.0 / (1.0 + math::exp(1.0 / x)), 0.0));
        assert!(!jumps(&|x| x * math::atan(1.0 / x), 0.0));
        assert!(!jumps(&|x| 1.0 / x, 0.0));
        assert!(!jumps(&|x| math::cbrt(x), 0.0));
        assert!(!jumps(&|x| math::atan(1.0 / (x * x)), 0.0));
    }

    #[test]
    fn what_swings_far_away_is_not_straight_there() {
        assert!(is_straight(&|x| 3.0 * (x - 1e6), 1e6));
        assert!(!is_straight(&math::sin, std::f64::consts::PI * 1e9));
    }

    #[test]
    fn a_millionth_of_the_values_is_where_jumps_are_seen() {
        assert!(jumps(&|x| 1.0 + 1.1e-6 * x.signum(), 0.0));
        assert!(!jumps(&|x| 1.0 + 0.9e-6 * x.signum(), 0.0));
    }
}
